//! Tiles of a surface whose results are shown: on exported maps or in the viewport.

use std::collections::BTreeSet;

use sabi_surface::atlas::{Atlas, Ghost, Owner, TILE};

use crate::tile_set::{TileSet, tile_number};

/// Tiles of the finest level whose results are shown. All other tiles belong to charts that are covered by other charts on the maps.
#[derive(Clone, Debug)]
pub struct ShownTiles {
    /// The shown tiles, and those around them.
    pub(crate) shown: CoveredTiles,
    /// The shown tiles, and those from which their ghosts take values.
    pub(crate) linked: CoveredTiles,
    /// The linked tiles, the tiles around them, and those from which the ghosts of all these take values.
    pub(crate) around: CoveredTiles,
}

/// Tiles that a step computes.
#[derive(Clone, Debug)]
pub(crate) struct CoveredTiles {
    pub(crate) tiles: TileSet,
    /// Hash of the tiles.
    pub(crate) key: [u8; 32],
}

impl CoveredTiles {
    fn new(tiles: TileSet) -> CoveredTiles {
        let mut hash = blake3::Hasher::new();
        for place in tiles.places() {
            hash.update(place.map(u32::to_le_bytes).as_flattened());
        }
        let key = *hash.finalize().as_bytes();
        CoveredTiles { tiles, key }
    }
}

impl ShownTiles {
    /// Creates the shown tiles of an atlas from columns, rows and pages. The tiles around them are added, since normals and
    /// the viewport read a few texels beyond a shown tile.
    pub fn new(atlas: &Atlas, shown: impl IntoIterator<Item = [u32; 3]>) -> ShownTiles {
        let all = atlas.tiles.iter().map(|tile| [tile.column, tile.row, tile.page]);
        let all: Vec<u32> = all.map(tile_number).collect();
        let with_linked = |tiles: &TileSet| tiles.and(&TileSet::new(tiles_behind_ghosts(atlas, tiles)));
        let shown = TileSet::new(shown).grown(&all);
        let linked = with_linked(&shown);
        let around = with_linked(&linked.grown(&all));
        ShownTiles {
            shown: CoveredTiles::new(shown),
            linked: CoveredTiles::new(linked),
            around: CoveredTiles::new(around),
        }
    }

    /// The shown tiles, and those around them.
    pub(crate) fn tiles(&self) -> &TileSet {
        &self.shown.tiles
    }

    /// Returns the number of shown tiles, including those around them.
    pub fn count(&self) -> u32 {
        self.tiles().count()
    }
}

/// Returns the tiles of all texels from which the ghosts in some tiles take values, also by way of other ghosts.
fn tiles_behind_ghosts(atlas: &Atlas, tiles: &TileSet) -> BTreeSet<[u32; 3]> {
    let tile_of = |[x, y, page]: [u32; 3]| [x / TILE, y / TILE, page];
    let mut is_known: Vec<bool> = atlas
        .ghosts
        .iter()
        .map(|ghost| tiles.contains(tile_of(ghost.texel)))
        .collect();
    let mut ghosts: Vec<usize> = (0..is_known.len()).filter(|ghost| is_known[*ghost]).collect();
    let mut found = BTreeSet::new();
    while let Some(ghost) = ghosts.pop().and_then(|index| atlas.ghosts.get(index)) {
        for texel in texels_behind(atlas, ghost) {
            let [x, y, page] = texel;
            match atlas.owner(x, y, page) {
                Owner::Empty => {}
                Owner::Triangle(_) => {
                    found.insert(tile_of(texel));
                }
                Owner::Ghost(other) => {
                    found.insert(tile_of(texel));
                    if let Some(is_known) = is_known.get_mut(other as usize).filter(|is_known| !**is_known) {
                        *is_known = true;
                        ghosts.push(other as usize);
                    }
                }
            }
        }
    }
    found
}

/// Returns the texels from which a ghost may take its value: four by four around its point beyond the seam, and those of
/// its own chart next to it.
fn texels_behind(atlas: &Atlas, ghost: &Ghost) -> impl Iterator<Item = [u32; 3]> {
    let chart = atlas.triangle_chart.get(ghost.read_triangle as usize);
    let page = chart
        .and_then(|chart| atlas.charts.get(*chart as usize))
        .map(|chart| chart.page);
    let corner = ghost.read_texel.map(|at| (at - 0.5).floor() as i64);
    let over_seam = page.map(|page| square(corner.map(|at| at - 1), 4, page));
    let [x, y, own_page] = ghost.texel;
    let beside = square([i64::from(x) - 2, i64::from(y) - 2], 5, own_page);
    over_seam.into_iter().flatten().chain(beside)
}

/// Returns the texels of a square. Texels with negative coordinates are left out.
fn square([left, top]: [i64; 2], side: i64, page: u32) -> impl Iterator<Item = [u32; 3]> {
    let texels = (0..side * side).map(move |at| [left + at % side, top + at / side]);
    texels.filter_map(move |[x, y]| Some([u32::try_from(x).ok()?, u32::try_from(y).ok()?, page]))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that cannot make its input has failed")]

    use sabi_surface::atlas::AtlasOptions;
    use sabi_surface::model::Mesh;

    use super::*;

    /// Returns two squares that are adjacent in space and have separate charts. If `stacked`, both have the same place on the maps.
    fn two_squares(stacked: bool) -> Atlas {
        let mut mesh = Mesh::default();
        for square in 0..2_u16 {
            let first = mesh.positions.len() as u32;
            for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0_f32]] {
                mesh.positions.push([x + f32::from(square), y, 0.0]);
                let left = if stacked { 0.25 } else { 0.05 + 0.5 * f32::from(square) };
                mesh.uvs.push([left + 0.4 * x, 0.25 + 0.4 * y]);
            }
            for corners in [[0, 1, 2], [0, 2, 3]] {
                mesh.triangles.push(corners.map(|corner| first + corner));
                mesh.triangle_material.push(0);
                mesh.triangle_part.push(0);
            }
        }
        Atlas::build(&mesh, &AtlasOptions::new(256)).unwrap()
    }

    #[test]
    fn tiles_behind_ghosts_are_covered_and_each_set_of_tiles_has_its_own_key() {
        for stacked in [false, true] {
            let atlas = two_squares(stacked);
            let [left, top, right, bottom] = atlas.charts[0].bounds.map(|at| at / TILE);
            let page = atlas.charts[0].page;
            let own = (left..=right).flat_map(|column| (top..=bottom).map(move |row| [column, row, page]));
            let shown = ShownTiles::new(&atlas, own);
            let counts = [&shown.shown, &shown.linked, &shown.around].map(|covered| covered.tiles.count());
            // The ghosts add a column of the other chart's tiles along the seam, and the tiles around them one more on both sides.
            assert!(counts[0] < counts[1] && counts[1] < counts[2], "{counts:?}");
            assert!(
                counts[2] < atlas.tiles.len() as u32,
                "{counts:?} of {}",
                atlas.tiles.len()
            );
            let keys = BTreeSet::from([shown.shown.key, shown.linked.key, shown.around.key]);
            assert_eq!(keys.len(), 3);
            assert_eq!(CoveredTiles::new(shown.linked.tiles.clone()).key, shown.linked.key);
        }
    }
}
