//! Sets of tiles of a surface, for example of those in which results differ from earlier results.

use std::sync::Arc;

use rayon::prelude::*;
use sabi_surface::atlas::{GHOST_BIT, TILE, TileRef};

use crate::device::Gpu;
use crate::error::GpuError;
use crate::uploads::storage_buffer;

/// Number of bits for the column and for the row of a tile. The page uses the remaining bits, as `texel_of` unpacks them.
const PLACE_BITS: u32 = 11;

/// Set of tiles of 8 × 8 texels of the finest level, sorted by page, row and column.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TileSet {
    tiles: Arc<Vec<u32>>,
}

/// Number of a tile for the device.
pub(crate) fn tile_number([column, row, page]: [u32; 3]) -> u32 {
    column | (row << PLACE_BITS) | (page << (2 * PLACE_BITS))
}

/// Returns column, row and page of the tile of a texel. The texel is given by its index, counted page by page and row by row.
pub fn tile_of(texel: u32, [width, height]: [u32; 2]) -> [u32; 3] {
    let (column, row) = (texel % width, texel / width);
    [column / TILE, row % height / TILE, row / height]
}

/// Size of a tile.
pub(crate) const TILE_EXTENT: wgpu::Extent3d = wgpu::Extent3d {
    width: TILE,
    height: TILE,
    depth_or_array_layers: 1,
};

/// Returns a tile of a texture as the source or target of a copy.
pub(crate) fn copied_tile(texture: &wgpu::Texture, [column, row, page]: [u32; 3]) -> wgpu::TexelCopyTextureInfo<'_> {
    wgpu::TexelCopyTextureInfo {
        origin: wgpu::Origin3d {
            x: TILE * column,
            y: TILE * row,
            z: page,
        },
        ..texture.as_image_copy()
    }
}

impl TileSet {
    /// Creates a set of tiles, given by column, row and page in any order.
    pub fn new(tiles: impl IntoIterator<Item = [u32; 3]>) -> TileSet {
        TileSet::of_numbers(tiles.into_iter().map(tile_number).collect())
    }

    /// Tiles of these numbers.
    pub(crate) fn all(numbers: &[u32]) -> TileSet {
        TileSet::of_numbers(numbers.to_vec())
    }

    fn of_numbers(mut tiles: Vec<u32>) -> TileSet {
        tiles.sort_unstable();
        tiles.dedup();
        TileSet { tiles: Arc::new(tiles) }
    }

    /// Returns the tiles that have a ghost among their texels or next to them.
    pub(crate) fn with_ghosts(tiles: &[TileRef], owners: &[u32], page_size: [u32; 2]) -> TileSet {
        let [width, height] = page_size.map(|side| side as usize);
        let tile = TILE as usize;
        let around = |first: u32, end: usize| {
            let first = first as usize * tile;
            first.saturating_sub(1)..(first + tile + 1).min(end)
        };
        let has_ghost = |of: &&TileRef| {
            let (rows, columns) = (around(of.row, height), around(of.column, width));
            rows.into_iter().any(|row| {
                let first = (of.page as usize * height + row) * width;
                let texels = &owners[first + columns.start..first + columns.end];
                texels.iter().any(|owner| owner & GHOST_BIT != 0)
            })
        };
        let found: Vec<&TileRef> = tiles.par_iter().filter(has_ghost).collect();
        TileSet::new(found.into_iter().map(|tile| [tile.column, tile.row, tile.page]))
    }

    /// Returns column, row and page of each tile.
    pub fn places(&self) -> impl ExactSizeIterator<Item = [u32; 3]> {
        let low = (1 << PLACE_BITS) - 1;
        let place = move |tile: &u32| [tile & low, (tile >> PLACE_BITS) & low, tile >> (2 * PLACE_BITS)];
        self.tiles.iter().map(place)
    }

    /// Number of tiles.
    pub fn count(&self) -> u32 {
        self.tiles.len() as u32
    }

    /// Returns true if a tile, by column, row and page, is in the set.
    pub fn contains(&self, tile: [u32; 3]) -> bool {
        self.tiles.binary_search(&tile_number(tile)).is_ok()
    }

    /// Returns the tiles that are in at least one of the two sets.
    pub(crate) fn and(&self, other: &TileSet) -> TileSet {
        match (self.tiles.is_empty(), other.tiles.is_empty()) {
            (true, _) => other.clone(),
            (_, true) => self.clone(),
            _ => TileSet::of_numbers(self.tiles.iter().chain(&*other.tiles).copied().collect()),
        }
    }

    /// Returns the tiles that are in both sets.
    pub(crate) fn within(&self, other: &TileSet) -> TileSet {
        let is_there = |tile: &&u32| other.tiles.binary_search(tile).is_ok();
        TileSet {
            tiles: Arc::new(self.tiles.iter().filter(is_there).copied().collect()),
        }
    }

    /// Returns the tiles and those around them that exist on the surface. `all` has the numbers of all tiles of the surface, ascending.
    pub(crate) fn grown(&self, all: &[u32]) -> TileSet {
        let around = self.places().flat_map(|[column, row, page]| {
            let near = |at: u32| at.saturating_sub(1)..=at + 1;
            near(row).flat_map(move |row| near(column).map(move |column| [column, row, page]))
        });
        let grown = TileSet::new(around);
        let own = |tile: &&u32| all.binary_search(tile).is_ok();
        TileSet::of_numbers(grown.tiles.iter().filter(own).copied().collect())
    }

    /// Returns the indices of the tiles in `all`, the ascending numbers of all tiles of a surface.
    pub(crate) fn indices(&self, all: &[u32]) -> Vec<usize> {
        let index = |tile: &u32| all.binary_search(tile).ok();
        self.tiles.iter().filter_map(index).collect()
    }

    /// Uploads the tiles to the device.
    pub(crate) fn upload(&self, gpu: &Gpu) -> Result<wgpu::Buffer, GpuError> {
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        let bytes: &[u8] = bytemuck::cast_slice(&self.tiles);
        let buffer = storage_buffer(gpu, "a list of tiles", bytes.len() as u64, limit)?;
        if !bytes.is_empty() {
            gpu.queue.write_buffer(&buffer, 0, bytes);
        }
        Ok(buffer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sabi_surface::atlas::EMPTY;

    #[test]
    fn a_set_has_each_tile_once_in_the_order_of_a_surface() {
        let set = TileSet::new([[3, 1, 0], [0, 0, 1], [2, 1, 0], [3, 1, 0]]);
        let places: Vec<[u32; 3]> = set.places().collect();
        assert_eq!(places, [[2, 1, 0], [3, 1, 0], [0, 0, 1]]);
        let both = set.and(&TileSet::new([[1, 1, 0]]));
        assert_eq!((set.count(), both.count()), (3, 4));
        assert_eq!(both.within(&set), set);
        assert_eq!(
            set.within(&TileSet::new([[2, 1, 0], [1, 1, 0]])),
            TileSet::new([[2, 1, 0]])
        );
    }

    #[test]
    fn a_tile_has_a_ghost_if_one_is_in_it_or_one_texel_around() {
        let tile = |column, row| TileRef { column, row, page: 0 };
        let tiles = [tile(0, 0), tile(1, 0), tile(2, 0), tile(0, 1), tile(1, 1), tile(2, 1)];
        let mut owners = vec![0; 24 * 16];
        let found = |owners: &[u32]| TileSet::with_ghosts(&tiles, owners, [24, 16]);
        assert_eq!(found(&owners).count(), 0);
        // A texel in the last column of the first tile, in the row above the lower tiles.
        owners[7 * 24 + 7] = GHOST_BIT | 3;
        let places: Vec<[u32; 3]> = found(&owners).places().collect();
        assert_eq!(places, [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]);
        owners[15 * 24 + 23] = EMPTY;
        assert_eq!(found(&owners).count(), 5, "outside of charts as well");
    }
}
