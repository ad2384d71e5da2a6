//! Layout of a texture set: the atlas texel of each pixel.

mod pixel_grid;

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

use sabi_surface::atlas::{Atlas, Chart, EMPTY, GHOST_BIT, udim_number};

pub(crate) use pixel_grid::{MappedTexel, PixelGrid};

/// Marks the absence of a texel or pixel.
pub const NONE: u32 = u32::MAX;

/// Source of a pixel's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cover {
    /// Nothing; padding may fill it.
    Empty,
    /// Ghost of a chart: the surface beyond the seam.
    Ghost,
    /// Owned texel of a chart.
    Owned,
}

/// One texture set of a model: a material, or a UV tile of a material with several tiles, or the single sheet that all materials share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SetKey {
    /// An index into the model's materials, or 0 for their one sheet.
    pub material: u32,
    /// UV tile, v downward; `[0, 0]` is the unit square.
    pub uv_tile: [i32; 2],
    /// UDIM number, when the material uses more than one tile: 1001 is the unit square, +1 to the right, +10 upward.
    pub udim: Option<u32>,
}

impl SetKey {
    /// Returns whether a chart belongs to the set: it is on the set's sheet and, if there are several tiles, in the set's tile.
    pub fn is_home_of(&self, chart: &Chart) -> bool {
        chart.sheet == self.material && (self.udim.is_none() || chart.uv_tile == self.uv_tile)
    }
}

/// Pixels of a texture set with the atlas texels that provide their values.
#[derive(Clone, Debug, PartialEq)]
pub struct SetLayout {
    /// Material and tile of the set.
    pub key: SetKey,
    /// Pixels across and down.
    pub size: u32,
    /// For each pixel, row by row from the top, the atlas texel (page by page, row by row) or [`NONE`].
    pub source: Vec<u32>,
    /// Source of each pixel's value.
    pub cover: Vec<Cover>,
    /// Further texels that claim a pixel in addition to [`SetLayout::source`]: pixel and texel, by ascending pixel. Only
    /// filled by [`SetLayout::merged`].
    pub shared: Vec<(u32, u32)>,
    /// Number of owned texels whose pixel is also claimed by another chart's owned texel: overlapping or tiling UVs.
    pub collisions: u64,
}

/// The texture sets of an atlas, by material and tile. A material whose charts lie in several UDIM tiles has a set for
/// each. Otherwise it has one, and charts outside the unit square wrap onto it as renderers repeat a texture.
pub fn set_keys(atlas: &Atlas) -> Vec<SetKey> {
    let mut tiles: BTreeMap<u32, BTreeSet<[i32; 2]>> = BTreeMap::new();
    for chart in &atlas.charts {
        let of_material = tiles.entry(chart.sheet).or_default();
        if chart.texels > 0 {
            of_material.insert(chart.uv_tile);
        }
    }
    let mut keys = Vec::new();
    for (material, tiles) in tiles {
        let numbers: Option<Vec<u32>> = tiles.iter().map(|&tile| udim_number(tile)).collect();
        match numbers {
            Some(numbers) if numbers.len() > 1 && atlas.udim_sheets.contains(&material) => {
                let of_tile = |(uv_tile, number)| SetKey {
                    material,
                    uv_tile,
                    udim: Some(number),
                };
                let mut of_material: Vec<SetKey> = tiles.into_iter().zip(numbers).map(of_tile).collect();
                of_material.sort_by_key(|key| key.udim);
                keys.extend(of_material);
            }
            _ => keys.push(SetKey {
                material,
                // A material without charts has the unit square.
                uv_tile: tiles.first().copied().unwrap_or([0, 0]),
                udim: None,
            }),
        }
    }
    keys
}

/// Builds all layouts, in the order of [`set_keys`]. Each takes five bytes a pixel: with many materials build them one by
/// one.
pub fn layouts(atlas: &Atlas) -> Vec<SetLayout> {
    let keys = set_keys(atlas).into_iter();
    keys.map(|key| SetLayout::new(atlas, key)).collect()
}

impl SetLayout {
    /// Builds the layout of one set. Owned texels have precedence over ghosts, the inner ring over the outer one, and lower
    /// charts over higher ones. Ghosts outside of the tile are dropped. An owned texel outside of it belongs to the tile in
    /// which it lies if that tile has a set; otherwise it wraps around.
    pub fn new(atlas: &Atlas, key: SetKey) -> SetLayout {
        SetLayout::gather(atlas, key, false)
    }

    /// Creates a layout like [`SetLayout::new`], with all texels of pixels that several charts claim, so that their mean can be used.
    pub fn merged(atlas: &Atlas, key: SetKey) -> SetLayout {
        let mut layout = SetLayout::gather(atlas, key, true);
        let SetLayout { shared, cover, .. } = &mut layout;
        shared.retain(|&(pixel, texel)| {
            claim(atlas, texel as usize).is_some_and(|(_, how)| how == cover[pixel as usize])
        });
        shared.sort_unstable();
        layout
    }

    /// Assigns all texels to pixels; with `shares`, texels that do not get their pixel, or lose it, are listed.
    fn gather(atlas: &Atlas, key: SetKey, shares: bool) -> SetLayout {
        let pixels = atlas.size as usize * atlas.size as usize;
        let mut layout = SetLayout {
            key,
            size: atlas.size,
            source: vec![NONE; pixels],
            cover: vec![Cover::Empty; pixels],
            shared: Vec::new(),
            collisions: 0,
        };
        PixelGrid::new(atlas, key).for_each(|mapped| {
            let loser = layout.place(atlas, &mapped);
            layout.shared.extend(loser.filter(|_| shares));
        });
        layout
    }

    /// Returns all texels that give a pixel its value, the first chart's first.
    pub fn sources(&self, pixel: usize) -> impl Iterator<Item = usize> {
        let start = self.shared.partition_point(|&(other, _)| (other as usize) < pixel);
        let more = self.shared[start..]
            .iter()
            .take_while(move |&&(other, _)| other as usize == pixel);
        let first = self.source.get(pixel).copied().filter(|&texel| texel != NONE);
        first
            .into_iter()
            .chain(more.map(|&(_, texel)| texel))
            .map(|texel| texel as usize)
    }

    /// Assigns a texel to its pixel unless a texel of lower rank has it; returns the pixel and the texel without one.
    fn place(&mut self, atlas: &Atlas, mapped: &MappedTexel) -> Option<(u32, u32)> {
        let MappedTexel {
            texel, cover, pixel, ..
        } = *mapped;
        if !mapped.is_here {
            return None;
        }
        let (before, other) = (self.cover[pixel], self.source[pixel]);
        self.collisions += u64::from(before == Cover::Owned && cover == Cover::Owned);
        let wins = match cover.cmp(&before) {
            Ordering::Greater => true,
            Ordering::Less => false,
            Ordering::Equal => rank(atlas, texel) < rank(atlas, other as usize),
        };
        let loser = if wins { other } else { texel as u32 };
        if wins {
            self.source[pixel] = texel as u32;
            self.cover[pixel] = cover;
        }
        (before != Cover::Empty).then_some((pixel as u32, loser))
    }
}

/// Returns the rank of a texel among those that claim a pixel in the same way. The lowest rank gets the pixel: the inner
/// ring, which is read at the edge of its chart, before the outer one; then the lower chart.
fn rank(atlas: &Atlas, texel: usize) -> (bool, u32) {
    match claim(atlas, texel) {
        Some((chart, Cover::Ghost)) => (!is_beside(atlas, texel, chart), chart),
        Some((chart, _)) => (false, chart),
        None => (true, u32::MAX),
    }
}

/// Returns true if one of the eight texels around a texel is owned by a chart.
fn is_beside(atlas: &Atlas, texel: usize, chart: u32) -> bool {
    let [width, height] = atlas.page_size.map(|side| (side as usize).max(1));
    let (x, y, page) = (texel % width, texel / width % height, texel / width / height);
    let rows = y.saturating_sub(1)..(y + 2).min(height);
    let around =
        rows.flat_map(|y| (x.saturating_sub(1)..(x + 2).min(width)).map(move |x| (page * height + y) * width + x));
    around
        .into_iter()
        .any(|near| claim(atlas, near) == Some((chart, Cover::Owned)))
}

/// Returns the chart of a texel, and whether it is owned or a ghost.
pub(crate) fn claim(atlas: &Atlas, texel: usize) -> Option<(u32, Cover)> {
    match *atlas.owners.get(texel)? {
        EMPTY => None,
        ghost if ghost & GHOST_BIT != 0 => Some((atlas.ghosts.get((ghost & !GHOST_BIT) as usize)?.chart, Cover::Ghost)),
        triangle => Some((*atlas.triangle_chart.get(triangle as usize)?, Cover::Owned)),
    }
}

#[cfg(test)]
pub(crate) mod tests;
