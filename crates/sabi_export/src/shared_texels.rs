//! Texels that share a pixel of the maps with others, or have none, and the pixels that are shown in their place.

use sabi_surface::atlas::Atlas;

use crate::layout::{Cover, MappedTexel, NONE, PixelGrid, SetLayout, claim};

/// Atlas texels that show the values of other texels in an exported map. A map has one value for each pixel, even where
/// several charts overlap. Charts that share no pixel are not included.
///
/// Texels are numbered page by page and row by row, and form groups: each target of a group shows the mean of its sources.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SharedTexels {
    /// End of each group's sources and of its targets in `texels`.
    ends: Vec<[usize; 2]>,
    texels: Vec<u32>,
}

impl SharedTexels {
    /// Returns true if nothing is shared.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The sources and the targets of each group; neither is empty.
    pub fn groups(&self) -> impl Iterator<Item = [&[u32]; 2]> {
        let starts = std::iter::once(0).chain(self.ends.iter().map(|[_, end]| *end));
        let groups = starts.zip(&self.ends);
        groups.map(|(start, &[middle, end])| [&self.texels[start..middle], &self.texels[middle..end]])
    }

    /// Adds the shared texels of one texture set of an atlas.
    ///
    /// If a chart shares a pixel, all of its texels show the map's values, including those of its rings, which filtering
    /// reads.
    pub fn add(&mut self, atlas: &Atlas, layout: &SetLayout) {
        if layout.collisions == 0 {
            return;
        }
        let grid = PixelGrid::new(atlas, layout.key);
        let mut on_map: Vec<[usize; 2]> = Vec::new();
        for_each_lost(&grid, layout, |lost, shows| match shows {
            Shows::Pixel => on_map.push([lost.pixel, lost.texel]),
            Shows::Texels(sources) => self.push(&sources, [lost.texel as u32]),
        });
        on_map.sort_unstable();
        for of_pixel in on_map.chunk_by(|[a, _], [b, _]| a == b) {
            let sources: Vec<u32> = layout.sources(of_pixel[0][0]).map(|texel| texel as u32).collect();
            self.push(&sources, of_pixel.iter().map(|[_, texel]| *texel as u32));
        }
    }

    /// Adds a group, unless nothing would change.
    fn push(&mut self, sources: &[u32], targets: impl IntoIterator<Item = u32>) {
        let start = self.texels.len();
        self.texels.extend(sources);
        let middle = self.texels.len();
        self.texels
            .extend(targets.into_iter().filter(|target| sources != [*target]));
        if start == middle || middle == self.texels.len() {
            self.texels.truncate(start);
        } else {
            self.ends.push([middle, self.texels.len()]);
        }
    }
}

/// Which values are shown in place of a texel's own.
pub(crate) enum Shows {
    /// Value of its pixel.
    Pixel,
    /// Mean of these texels, for a ghost that claims no pixel because it is outside of its chart's tile.
    Texels(Vec<u32>),
}

/// Visits the texels whose pixel has another value, and the ghosts that claim no pixel but show one; both only of charts in UV that
/// share a pixel of an owned texel.
pub(crate) fn for_each_lost(grid: &PixelGrid<'_>, layout: &SetLayout, mut visit: impl FnMut(&MappedTexel, Shows)) {
    let charts = &grid.atlas.charts;
    let is_lost = |mapped: &MappedTexel| mapped.is_here && !layout.sources(mapped.pixel).eq([mapped.texel]);
    let mut is_sharing = vec![false; charts.len()];
    grid.for_each(|mapped| {
        if mapped.cover == Cover::Owned && is_lost(&mapped) {
            is_sharing[charts[mapped.chart as usize].uv_chart as usize] = true;
        }
    });
    grid.for_each(|mapped| {
        let chart = mapped.chart as usize;
        if !is_sharing[charts[chart].uv_chart as usize] {
            return;
        }
        let is_beside = !mapped.is_here && mapped.cover == Cover::Ghost && layout.key.is_home_of(&charts[chart]);
        if is_lost(&mapped) {
            visit(&mapped, Shows::Pixel);
        } else if is_beside && let Some(shows) = ghost_source(grid, layout, &mapped) {
            visit(&mapped, shows);
        }
    });
}

/// Returns the source of a ghost beyond the border of its tile, where the exported map has no pixel, and the value that a
/// renderer reads depends on its wrap mode. Such ghosts have the value of the ring of the chart whose pixels are shown;
/// `None` where there is no such value.
fn ghost_source(grid: &PixelGrid<'_>, layout: &SetLayout, ghost: &MappedTexel) -> Option<Shows> {
    let atlas = grid.atlas;
    let at = place_of(atlas, ghost.texel);
    let steps = (0..25).map(|index| [index % 5 - 2, index / 5 - 2]);
    let owned = steps.filter_map(|step| {
        let near = grid.map_texel(moved(atlas, at, step)?)?;
        let is_own = near.chart == ghost.chart && near.cover == Cover::Owned;
        is_own.then_some((step, near))
    });
    let ([x, y], near) = owned.min_by_key(|([x, y], _)| x * x + y * y)?;
    if !grid.is_of_several() && near.tile == ghost.tile && layout.source[ghost.pixel] != NONE {
        // The chart spans several tiles, and ends within this one.
        return Some(Shows::Pixel);
    }
    let neighbor_of = |source: usize| {
        let chart = |texel: usize| claim(atlas, texel).map(|(chart, _)| chart);
        let beside = moved(atlas, place_of(atlas, source), [-x, -y]).map(|place| texel_at(atlas, place));
        let beside = beside.filter(|&texel| chart(texel) == chart(source));
        // Without such a texel in the same chart, the source itself is closest.
        beside.unwrap_or(source) as u32
    };
    let sources = near.is_here.then(|| layout.sources(near.pixel).map(neighbor_of));
    Some(Shows::Texels(sources?.collect()))
}

/// Column, row and page of a texel.
fn place_of(atlas: &Atlas, texel: usize) -> [u32; 3] {
    let [width, height] = atlas.page_size.map(|side| side as usize);
    [texel % width, texel / width % height, texel / width / height].map(|at| at as u32)
}

fn texel_at(atlas: &Atlas, [x, y, page]: [u32; 3]) -> usize {
    let [width, height] = atlas.page_size.map(|side| side as usize);
    (page as usize * height + y as usize) * width + x as usize
}

/// Returns the texel at an offset of columns and rows; `None` outside of the page.
fn moved(atlas: &Atlas, [x, y, page]: [u32; 3], [columns, rows]: [i32; 2]) -> Option<[u32; 3]> {
    let [width, height] = atlas.page_size;
    let x = x.checked_add_signed(columns).filter(|x| *x < width)?;
    let y = y.checked_add_signed(rows).filter(|y| *y < height)?;
    Some([x, y, page])
}

#[cfg(test)]
mod tests;
