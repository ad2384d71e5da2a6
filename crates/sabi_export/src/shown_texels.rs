//! Tiles of an atlas whose own values are shown.

use sabi_surface::atlas::{Atlas, EMPTY, TILE};

use crate::layout::{PixelGrid, SetLayout};
use crate::shared_texels::{Shows, for_each_lost};

/// Texels of an atlas whose own values are shown by the exported maps or in the viewport, counted by tiles.
///
/// All others are those of charts that lost their pixels to other charts, and show the values of these; see
/// [`crate::SharedTexels`].
pub struct ShownTexels<'a> {
    atlas: &'a Atlas,
    /// Tiles in a row, and rows of tiles of a page.
    across: [usize; 2],
    /// Number of texels of each tile that show the values of others, page by page and row by row.
    hidden: Vec<u8>,
    /// Tiles with texels that others show.
    is_read: Vec<bool>,
}

impl<'a> ShownTexels<'a> {
    /// Creates a count in which all texels show their own values.
    pub fn new(atlas: &'a Atlas) -> ShownTexels<'a> {
        let across = atlas.page_size.map(|side| side.div_ceil(TILE) as usize);
        let tiles = across[0] * across[1] * atlas.pages as usize;
        ShownTexels {
            atlas,
            across,
            hidden: vec![0; tiles],
            is_read: vec![false; tiles],
        }
    }

    /// Hides the texels of a texture set that show the values of others.
    pub fn hide(&mut self, layout: &SetLayout) {
        if layout.collisions == 0 {
            return;
        }
        let grid = PixelGrid::new(self.atlas, layout.key);
        for_each_lost(&grid, layout, |lost, shows| {
            let tile = self.tile(lost.texel);
            let shows_itself = match shows {
                // The sources of a pixel that have it show their own values, and so are not hidden.
                Shows::Pixel => layout.sources(lost.pixel).any(|source| source == lost.texel),
                Shows::Texels(sources) => {
                    for source in &sources {
                        let of_source = self.tile(*source as usize);
                        self.is_read[of_source] = true;
                    }
                    sources.is_empty() || sources.contains(&(lost.texel as u32))
                }
            };
            self.hidden[tile] += u8::from(!shows_itself);
        });
    }

    /// Column, row and page of each tile with texels whose own values are shown.
    pub fn tiles(&self) -> Vec<[u32; 3]> {
        let places = self.atlas.tiles.iter().map(|tile| [tile.column, tile.row, tile.page]);
        places.filter(|place| self.is_shown(*place)).collect()
    }

    fn is_shown(&self, [column, row, page]: [u32; 3]) -> bool {
        let tile = self.index([column, row, page].map(|at| at as usize));
        self.is_read[tile] || self.owners_in([column, row, page]) > usize::from(self.hidden[tile])
    }

    /// Number of texels of a tile that are not empty.
    fn owners_in(&self, [column, row, page]: [u32; 3]) -> usize {
        let [width, height] = self.atlas.page_size;
        let columns = column * TILE..(column * TILE + TILE).min(width);
        let rows = row * TILE..(row * TILE + TILE).min(height);
        let first_row = page as usize * height as usize;
        let of_row = |y: u32| {
            let start = (first_row + y as usize) * width as usize;
            let texels = start + columns.start as usize..start + columns.end as usize;
            let owners = self.atlas.owners.get(texels).into_iter().flatten();
            owners.filter(|owner| **owner != EMPTY).count()
        };
        rows.map(of_row).sum()
    }

    /// Index of the tile of a texel.
    fn tile(&self, texel: usize) -> usize {
        let [width, height] = self.atlas.page_size.map(|side| side as usize);
        let side = TILE as usize;
        self.index([
            texel % width / side,
            texel / width % height / side,
            texel / width / height,
        ])
    }

    fn index(&self, [column, row, page]: [usize; 3]) -> usize {
        (page * self.across[1] + row) * self.across[0] + column
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::tests::atlas;
    use crate::{SetKey, set_keys};

    /// Columns of the shown tiles in a row of tiles of an atlas with one set.
    fn shown(atlas: &Atlas, layout: impl Fn(SetKey) -> SetLayout, row: u32) -> Vec<u32> {
        let mut shown = ShownTexels::new(atlas);
        for key in set_keys(atlas) {
            shown.hide(&layout(key));
        }
        let tiles = shown.tiles().into_iter();
        tiles.filter(|tile| tile[1] == row).map(|[column, ..]| column).collect()
    }

    #[test]
    fn a_stacked_chart_is_hidden_but_for_the_tiles_in_which_it_has_pixels() {
        // All three at uv texels 1..7 of two tiles; the third one reaches into another tile.
        let three = atlas(
            16,
            48,
            &[
                (0, [0, 0], [0, 0], 1..7, 1..7),
                (0, [16, 0], [0, 0], 17..23, 1..7),
                (0, [32, 0], [0, 0], 33..43, 1..7),
            ],
        );
        assert_eq!(shown(&three, |key| SetLayout::new(&three, key), 0), [0, 4, 5]);
        assert_eq!(
            shown(&three, |key| SetLayout::merged(&three, key), 0),
            [0, 2, 4, 5],
            "a mean is taken of all of them"
        );
    }

    #[test]
    fn charts_with_places_of_their_own_are_shown() {
        let two = atlas(
            16,
            32,
            &[(0, [0, 0], [0, 0], 1..7, 1..7), (0, [16, 0], [0, 0], 25..31, 1..7)],
        );
        assert_eq!(shown(&two, |key| SetLayout::new(&two, key), 0), [0, 3]);
    }
}
