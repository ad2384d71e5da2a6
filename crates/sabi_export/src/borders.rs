//! Borders of charts: ghosts that repeat their own chart where the data of the surface jumps.
//!
//! A ghost holds the value beyond its seam. That is right for filters, and for maps whose data continues over the seam, since a renderer
//! then reads the same on both sides. Where the data jumps, at the border of a material, a part or a color, a renderer that interpolates
//! near the border would read the neighbor's value, and padding and mip levels would spread it. In that case a ghost repeats the nearest
//! texel of its own chart. A jump is detected by comparison with the variation beside it, as in limiters of finite volume schemes (after
//! Cockburn and Shu 1989, "TVB Runge-Kutta local projection discontinuous Galerkin finite element method").

use std::ops::Range;

use rayon::prelude::*;
use sabi_surface::atlas::{Atlas, EMPTY, GHOST_BIT, Ghost};

use crate::layout::{Cover, NONE, SetLayout};
use crate::{Channel, ChannelPixels, MeshMap};

/// Number of texels on each side of a place that belong to its neighborhood: the number of rings of ghosts.
const REACH: i64 = sabi_surface::atlas::RINGS as i64;
/// Texels along a side of a neighborhood.
const SIDE: usize = 2 * REACH as usize + 1;
/// Limit for the difference between a ghost and its anchor, for each texel of distance, as a multiple of the largest step
/// between neighboring texels of the chart. It is 2, since smooth data may be steeper at the ghost.
pub const STEEPER: f32 = 2.0;

/// Ghosts of a texture set, with the texels of their charts around them.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartBorders {
    /// Pixels of the map across and down, the pages of an atlas below each other.
    size: [usize; 2],
    ghosts: Vec<BorderGhost>,
}

/// Ghost that provides the value of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BorderGhost {
    /// Its index among the ghosts of the atlas.
    pub index: u32,
    /// Its pixel.
    pub pixel: u32,
    /// Pixel of the nearest texel that its chart owns.
    anchor: u32,
    /// Texels from the anchor to the ghost, across and down.
    pub step: [i8; 2],
    /// Neighborhood of the anchor, a bit a texel, row by row: set where the chart owns the texel and its pixel shows it.
    pub own: u32,
}

/// Treatment of the ghosts of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BorderRule {
    /// Ghosts beyond a jump repeat the nearest texel of their chart.
    AtJumps,
    /// Like [`BorderRule::AtJumps`], except for ghosts directly beside the chart, since both sides of a seam must have the same values.
    Meet,
    /// All ghosts repeat the nearest texel of their chart. For numbers such as ids, which must not be interpolated.
    Always,
}

impl BorderRule {
    /// Returns the rule for a channel. For heights, different values on both sides of a seam would cause a crack.
    pub fn of(channel: &Channel) -> BorderRule {
        match channel {
            Channel::Height => BorderRule::Meet,
            Channel::Mesh(MeshMap::Id | MeshMap::MaterialId) => BorderRule::Always,
            _ => BorderRule::AtJumps,
        }
    }
}

impl ChartBorders {
    /// Finds the ghosts of a set. `layout` must be made from `atlas`.
    pub fn new(atlas: &Atlas, layout: &SetLayout) -> ChartBorders {
        let pages = BorderPages {
            atlas,
            layout: Some(layout),
        };
        let pixels = layout.cover.par_iter().enumerate();
        let ghosts = pixels
            .filter(|(_, cover)| **cover == Cover::Ghost)
            .filter_map(|(pixel, _)| pages.ghost(*layout.source.get(pixel)? as usize, pixel))
            .collect();
        ChartBorders {
            size: [layout.size as usize; 2],
            ghosts,
        }
    }

    /// Finds the ghosts of an atlas that is shown itself: its pixels are its texels, page by page and row by row.
    pub fn of_atlas(atlas: &Atlas) -> ChartBorders {
        let pages = BorderPages { atlas, layout: None };
        let [width, height] = atlas.page_size.map(|side| side as usize);
        let texels = atlas.ghosts.par_iter().map(|ghost| {
            let [x, y, page] = ghost.texel.map(|at| at as usize);
            (page * height + y) * width + x
        });
        let ghosts = texels.filter_map(|texel| pages.ghost(texel, texel)).collect();
        ChartBorders {
            size: [width, height * atlas.pages as usize],
            ghosts,
        }
    }

    /// The ghosts, for those that apply [`ChartBorders::repeat_values`] elsewhere.
    pub fn ghosts(&self) -> &[BorderGhost] {
        &self.ghosts
    }

    /// Lets the ghosts of a channel repeat their own charts, and returns whether any changed. Padding is not touched; see
    /// [`crate::PaddingMap::pad`].
    pub fn repeat_charts(&self, channel: &Channel, pixels: &mut ChannelPixels) -> bool {
        let ChannelPixels { components, data } = pixels;
        self.repeat_values(BorderRule::of(channel), *components, 0..*components, data)
    }

    /// Repeats charts like [`ChartBorders::repeat_charts`], for some components of pixels, which are changed together.
    pub fn repeat_values(&self, rule: BorderRule, components: usize, parts: Range<usize>, data: &mut [f32]) -> bool {
        let values = |pixel: usize| &data[pixel * components..][parts.clone()];
        let ghosts = self.ghosts.par_iter();
        let changed: Vec<&BorderGhost> = ghosts.filter(|ghost| self.is_changed(ghost, rule, &values)).collect();
        for ghost in &changed {
            let from = ghost.anchor as usize * components;
            let to = ghost.pixel as usize * components;
            data.copy_within(from + parts.start..from + parts.end, to + parts.start);
        }
        !changed.is_empty()
    }

    /// Returns whether a ghost repeats its chart instead of its own value.
    fn is_changed<'v>(&self, ghost: &BorderGhost, rule: BorderRule, values: &impl Fn(usize) -> &'v [f32]) -> bool {
        let (own, nearest) = (values(ghost.pixel as usize), values(ghost.anchor as usize));
        let is_beside = ghost.step.iter().all(|step| step.abs() <= 1);
        if own == nearest || (rule == BorderRule::Meet && is_beside) {
            return false;
        }
        let distance = f32::from(ghost.step[0]).hypot(f32::from(ghost.step[1]));
        // A jump in one component is enough. NaN never counts as a jump.
        let jumps = || {
            let steps = self.steepest(ghost, values);
            let mut parts = own.iter().zip(nearest).zip(steps);
            parts.any(|((own, nearest), step)| (own - nearest).abs() > STEEPER * distance * step)
        };
        rule == BorderRule::Always || jumps()
    }

    /// Returns the largest differences between adjacent texels of the chart around the anchor of a ghost.
    fn steepest<'v>(&self, ghost: &BorderGhost, values: &impl Fn(usize) -> &'v [f32]) -> [f32; MOST_PARTS] {
        let mut steepest = [0.0_f32; MOST_PARTS];
        for [x, y] in offsets().filter(|offset| ghost.is_own(*offset)) {
            let here = values(self.pixel(ghost, [x, y]));
            for next in [[x + 1, y], [x, y + 1]].into_iter().filter(|next| ghost.is_own(*next)) {
                let pairs = here.iter().zip(values(self.pixel(ghost, next)));
                for (most, (one, other)) in steepest.iter_mut().zip(pairs) {
                    *most = most.max((one - other).abs());
                }
            }
        }
        steepest
    }

    /// Returns the pixel of a texel in the neighborhood of a ghost's anchor.
    fn pixel(&self, ghost: &BorderGhost, offset: [i64; 2]) -> usize {
        wrapped(ghost.anchor as usize, offset, self.size)
    }
}

/// Maximum number of components of a pixel that are changed together.
const MOST_PARTS: usize = 4;

impl BorderGhost {
    /// Returns whether the pixel at an offset from the anchor shows a texel that the chart owns.
    fn is_own(&self, [x, y]: [i64; 2]) -> bool {
        let is_near = x.abs() <= REACH && y.abs() <= REACH;
        is_near && self.own >> bit([x, y]) & 1 == 1
    }
}

/// Atlas and layout of a set; none where the atlas itself is shown.
struct BorderPages<'a> {
    atlas: &'a Atlas,
    layout: Option<&'a SetLayout>,
}

impl BorderPages<'_> {
    /// Returns the ghost that provides the value of a pixel; `None` if no texel of its chart is shown near it.
    fn ghost(&self, texel: usize, pixel: usize) -> Option<BorderGhost> {
        let owner = *self.atlas.owners.get(texel)?;
        let index = owner & !GHOST_BIT;
        let ghost = self.atlas.ghosts.get(index as usize)?;
        if self.shows_own_border(ghost) {
            return None;
        }
        let chart = ghost.chart;
        // Of texels that are equally near the first one is taken, as when ghosts are anchored.
        let near = offsets().filter(|offset| self.is_own(chart, texel, pixel, *offset));
        let nearest = near.min_by_key(|[x, y]| (x * x + y * y, *y, *x))?;
        let anchor_texel = self.moved(texel, nearest)?;
        let anchor = self.pixel(pixel, anchor_texel, nearest);
        let own = offsets().filter(|offset| self.is_own(chart, anchor_texel, anchor, *offset));
        Some(BorderGhost {
            index,
            pixel: pixel as u32,
            anchor: anchor as u32,
            step: nearest.map(|step| -step as i8),
            own: own.fold(0, |bits, offset| bits | 1 << bit(offset)),
        })
    }

    /// Returns whether a ghost lies beyond an open edge of the surface, so that it continues its own chart and shows no
    /// neighbor.
    fn shows_own_border(&self, ghost: &Ghost) -> bool {
        let near = [0, 1].map(|axis| (ghost.target_texel[axis] - ghost.texel[axis] as f32 - 0.5).abs());
        self.atlas.triangle_chart.get(ghost.target_triangle as usize) == Some(&ghost.chart)
            && near.iter().all(|distance| *distance <= REACH as f32 + 1.0)
    }

    /// Returns whether the texel at an offset from another texel is owned by the chart and shown by its pixel.
    fn is_own(&self, chart: u32, texel: usize, pixel: usize, offset: [i64; 2]) -> bool {
        let Some(own_texel) = self.moved(texel, offset) else {
            return false;
        };
        let owner = self.atlas.owners[own_texel];
        let is_owned = owner != EMPTY && owner & GHOST_BIT == 0;
        let is_shown = |layout: &SetLayout| {
            let shown = layout.source[self.pixel(pixel, own_texel, offset)];
            shown != NONE && shown as usize == own_texel
        };
        is_owned && self.atlas.triangle_chart.get(owner as usize) == Some(&chart) && self.layout.is_none_or(is_shown)
    }

    /// Returns the pixel at an offset from another; in texture space it is the texel there.
    fn pixel(&self, pixel: usize, texel: usize, offset: [i64; 2]) -> usize {
        match self.layout {
            Some(layout) => wrapped(pixel, offset, [layout.size as usize; 2]),
            None => texel,
        }
    }

    /// Returns the texel at an offset from another on the same page.
    fn moved(&self, texel: usize, [x, y]: [i64; 2]) -> Option<usize> {
        let [width, height] = self.atlas.page_size.map(i64::from);
        let (column, row) = (texel as i64 % width + x, texel as i64 / width % height + y);
        let is_on_page = (0..width).contains(&column) && (0..height).contains(&row);
        is_on_page.then(|| (texel as i64 + y * width + x) as usize)
    }
}

/// Offsets of a neighborhood, row by row.
fn offsets() -> impl Iterator<Item = [i64; 2]> {
    (-REACH..=REACH).flat_map(|y| (-REACH..=REACH).map(move |x| [x, y]))
}

/// Index of an offset in a neighborhood.
fn bit([x, y]: [i64; 2]) -> usize {
    (y + REACH) as usize * SIDE + (x + REACH) as usize
}

/// Returns the pixel at an offset from another pixel, in a map that repeats.
fn wrapped(pixel: usize, [x, y]: [i64; 2], size: [usize; 2]) -> usize {
    let [width, height] = size.map(|side| side as i64);
    let at = pixel as i64;
    ((at / width + y).rem_euclid(height) * width + (at % width + x).rem_euclid(width)) as usize
}

#[cfg(test)]
mod tests;
