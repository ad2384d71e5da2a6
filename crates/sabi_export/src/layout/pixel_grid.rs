//! Map from atlas texels to the pixels of a texture set.

use std::collections::BTreeSet;

use sabi_surface::atlas::{Atlas, TILE};

use super::{Cover, SetKey, claim, set_keys};

/// Map from the texels of an atlas to the pixels of a texture set.
pub(crate) struct PixelGrid<'a> {
    pub(crate) atlas: &'a Atlas,
    key: SetKey,
    /// UV tiles of the same material that have sets of their own; empty where the material has one set.
    siblings: BTreeSet<[i32; 2]>,
}

/// A texel of an atlas with the pixel that it maps to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MappedTexel {
    /// The texel, page by page and row by row.
    pub(crate) texel: usize,
    /// Its chart.
    pub(crate) chart: u32,
    /// Cover of the texel: owned by the chart, or a ghost of it.
    pub(crate) cover: Cover,
    /// UV tile that it lies in, v downward.
    pub(crate) tile: [i32; 2],
    /// Pixel there, row by row from the top.
    pub(crate) pixel: usize,
    /// True if the pixel belongs to the set and the texel claims it.
    pub(crate) is_here: bool,
}

impl<'a> PixelGrid<'a> {
    pub(crate) fn new(atlas: &'a Atlas, key: SetKey) -> PixelGrid<'a> {
        let siblings = match key.udim {
            Some(_) => set_keys(atlas),
            None => Vec::new(),
        };
        let siblings = siblings.iter().filter(|other| other.material == key.material);
        PixelGrid {
            atlas,
            key,
            siblings: siblings.map(|other| other.uv_tile).collect(),
        }
    }

    /// Returns true if the set is one of several of its material.
    pub(crate) fn is_of_several(&self) -> bool {
        self.key.udim.is_some()
    }

    /// Visits all texels of the set's charts, tile by tile of the atlas.
    pub(crate) fn for_each(&self, mut visit: impl FnMut(MappedTexel)) {
        let [width, height] = self.atlas.page_size;
        for tile in &self.atlas.tiles {
            let (first_x, first_y) = (tile.column * TILE, tile.row * TILE);
            for y in first_y..(first_y + TILE).min(height) {
                for x in first_x..(first_x + TILE).min(width) {
                    if let Some(mapped) = self.map_texel([x, y, tile.page]) {
                        visit(mapped);
                    }
                }
            }
        }
    }

    /// Maps the texel at a column, row and page; `None` where it belongs to no chart of the set's sheet.
    pub(crate) fn map_texel(&self, [x, y, page]: [u32; 3]) -> Option<MappedTexel> {
        let [width, height] = self.atlas.page_size.map(|side| side as usize);
        let texel = (page as usize * height + y as usize) * width + x as usize;
        let (chart_index, cover) = claim(self.atlas, texel)?;
        let chart = self.atlas.charts.get(chart_index as usize)?;
        if chart.sheet != self.key.material {
            return None;
        }
        let size = i64::from(self.atlas.size);
        let [left, top] = chart.texel_from_uv.map(i64::from);
        let plane = [i64::from(x) - left, i64::from(y) - top];
        let tile = plane.map(|at| at.div_euclid(size) as i32);
        let inside = plane.map(|at| at.rem_euclid(size) as usize);
        let is_here = if cover == Cover::Ghost {
            // Ghosts outside of their chart's tile are dropped.
            tile == chart.uv_tile && (!self.is_of_several() || tile == self.key.uv_tile)
        } else if self.is_of_several() && self.siblings.contains(&tile) {
            tile == self.key.uv_tile
        } else {
            // Texels outside wrap onto the set of their chart.
            self.key.is_home_of(chart)
        };
        Some(MappedTexel {
            texel,
            chart: chart_index,
            cover,
            tile,
            pixel: inside[1] * self.atlas.size as usize + inside[0],
            is_here,
        })
    }
}
