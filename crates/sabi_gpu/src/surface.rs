//! The linked atlas on the device, in working units.

use std::ops::Range;
use std::sync::OnceLock;

use rayon::prelude::*;
use sabi_surface::atlas::{Atlas, GHOST_BIT, TILE};

use crate::device::Gpu;
use crate::error::GpuError;
use crate::layer_rows::LayerRows;
use crate::leaps::leaps;
use crate::links::{GhostLinks, Links};
use crate::pass_constants::PassConstants;
use crate::pool::Extent;
use crate::shown_tiles::ShownTiles;
use crate::tables::{SurfaceTables, texel_area_vector};
use crate::tile_set::{TileSet, tile_number};
use crate::uploads::{storage_buffer, table_texture, texel_texture};

/// Texel widths and extent of a surface, working units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// Width of a texel of this level.
    pub texel: f64,
    /// Width of a texel of the finest level.
    pub finest: f64,
    /// Largest coordinate of the model. The rounding of positions depends on it.
    pub farthest: f64,
}

impl Measures {
    /// Returns the measures of a surface with a single level and coordinates up to 1.
    pub fn single_level(texel: f64) -> Measures {
        Measures {
            texel,
            finest: texel,
            farthest: 1.0,
        }
    }
}

/// Level of the surface on a device.
pub struct GpuSurface {
    pub(crate) extent: Extent,
    pub(crate) tiles: wgpu::Buffer,
    pub(crate) tile_count: u32,
    /// The numbers in `tiles`, in the same order.
    pub(crate) tile_numbers: Vec<u32>,
    /// Tiles with a ghost among their texels or next to them.
    pub(crate) ghost_tiles: TileSet,
    pub(crate) owners: wgpu::TextureView,
    pub(crate) leaps: wgpu::TextureView,
    pub(crate) geometry: wgpu::TextureView,
    pub(crate) frames: wgpu::TextureView,
    pub(crate) pieces: wgpu::Buffer,
    /// Links of the ghosts.
    pub(crate) ghosts: GhostLinks,
    /// Map of the texels from which slopes are computed. It is created at its first use.
    pub(crate) stencils: OnceLock<wgpu::TextureView>,
    /// Texels for one unit of UV.
    pub(crate) size: u32,
    pub(crate) measures: Measures,
    /// Area of all owned texels, square working units.
    pub(crate) area: f64,
    pub(crate) bytes: u64,
}

impl GpuSurface {
    /// Uploads an atlas and its tables.
    pub fn upload(
        gpu: &Gpu,
        atlas: &Atlas,
        tables: &SurfaceTables,
        measures: Measures,
    ) -> Result<GpuSurface, GpuError> {
        let [width, height] = atlas.page_size;
        debug_assert!(width.is_multiple_of(TILE) && height.is_multiple_of(TILE));
        let extent = [width, height, atlas.pages];
        let places = atlas.tiles.iter().map(|tile| [tile.column, tile.row, tile.page]);
        let tiles: Vec<u32> = places.map(tile_number).collect();
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        let buffer = |what: &'static str, bytes: &[u8]| {
            let buffer = storage_buffer(gpu, what, bytes.len() as u64, limit)?;
            if !bytes.is_empty() {
                gpu.queue.write_buffer(&buffer, 0, bytes);
            }
            Ok::<_, GpuError>(buffer)
        };
        let owners = bytemuck::cast_slice(&atlas.owners);
        let surface = GpuSurface {
            extent,
            tile_count: tiles.len() as u32,
            tiles: buffer("the tile list", bytemuck::cast_slice(&tiles))?,
            tile_numbers: tiles,
            ghost_tiles: TileSet::with_ghosts(&atlas.tiles, &atlas.owners, atlas.page_size),
            owners: texel_texture(gpu, "the owner map", wgpu::TextureFormat::R32Uint, extent, owners)?,
            leaps: texel_texture(
                gpu,
                "the leap map",
                wgpu::TextureFormat::R8Uint,
                extent,
                &leaps(atlas, tables),
            )?,
            geometry: table_texture(gpu, "the triangles", bytemuck::cast_slice(&tables.geometry))?,
            frames: table_texture(gpu, "the tangent frames", bytemuck::cast_slice(&tables.frames))?,
            pieces: buffer("the pieces", bytemuck::cast_slice(&tables.pieces))?,
            ghosts: GhostLinks::of(gpu, atlas)?,
            stencils: OnceLock::new(),
            size: atlas.size,
            measures,
            area: covered_area(atlas, tables),
            bytes: atlas.owners.len() as u64 * 5,
        };
        // Without this, written data waits for the next submission, in memory of its own.
        gpu.queue.submit([]);
        gpu.wait()?;
        Ok(surface)
    }

    /// Returns the number of bytes of the textures of the surface. Every run includes them in its budget and its peak.
    pub fn texture_bytes(&self) -> u64 {
        self.bytes + self.stencils.get().map_or(0, |_| self.stencil_bytes())
    }

    /// Bytes of the map of stencils.
    pub(crate) fn stencil_bytes(&self) -> u64 {
        4 * self.texels()
    }

    /// Returns the number of texels of all pages.
    pub fn texels(&self) -> u64 {
        self.extent.iter().map(|side| u64::from(*side)).product()
    }

    /// Returns all pages as bands of this many rows.
    pub(crate) fn bands(&self, rows: u32) -> impl Iterator<Item = LayerRows> {
        let [_, height, pages] = self.extent;
        let of_page = move |layer: u32| {
            let firsts = (0..height).step_by(rows.max(1) as usize);
            firsts.map(move |first| LayerRows {
                layer,
                level: 0,
                rows: first..first.saturating_add(rows).min(height),
            })
        };
        (0..pages).flat_map(of_page)
    }

    /// Returns the range of the texels of some rows, counted page by page and row by row.
    pub(crate) fn texels_of_rows(&self, band: &LayerRows) -> Range<usize> {
        let [width, height, _] = self.extent.map(|side| side as usize);
        let first_row = band.layer as usize * height;
        let texel = |row: u32| (first_row + row as usize) * width;
        texel(band.rows.start)..texel(band.rows.end)
    }

    /// Returns the shown tiles in some rows, which must begin and end at tiles.
    pub(crate) fn tiles_of_rows(&self, band: &LayerRows, shown: Option<&ShownTiles>) -> TileSet {
        let rows = band.rows.start / TILE..band.rows.end.div_ceil(TILE);
        let is_here = |[_, row, page]: &[u32; 3]| *page == band.layer && rows.contains(row);
        match shown {
            Some(shown) => TileSet::new(shown.tiles().places().filter(is_here)),
            None => TileSet::new(TileSet::all(&self.tile_numbers).places().filter(is_here)),
        }
    }

    /// Number of 8 × 8 tiles that are not empty.
    pub fn tile_count(&self) -> u32 {
        self.tile_count
    }

    /// Returns the bind group of the surface with the links of all its ghosts. Its layout is [`Gpu::surface_layout`].
    pub fn bindings(&self, gpu: &Gpu) -> wgpu::BindGroup {
        self.bindings_of_links(gpu, &self.ghosts.all)
    }

    /// Returns the bind group of the surface with `links` in place of the links of all ghosts, for kernels over links.
    pub(crate) fn bindings_of_links(&self, gpu: &Gpu, links: &Links) -> wgpu::BindGroup {
        let constants = gpu.uniform(&[0; size_of::<PassConstants>()]);
        self.bindings_with(gpu, &self.tiles, links, &constants)
    }

    /// Returns the bind group of the surface with the links of some of its ghosts. It is created at its first use.
    pub(crate) fn bindings_of_ghosts<'l>(&self, gpu: &Gpu, ghosts: &'l Links) -> &'l wgpu::BindGroup {
        let bindings = &ghosts.surface_bindings;
        bindings.get_or_init(|| self.bindings_of_links(gpu, ghosts))
    }

    /// Returns the bind group of the surface with these tiles, links and constants.
    pub(crate) fn bindings_with(
        &self,
        gpu: &Gpu,
        tiles: &wgpu::Buffer,
        links: &Links,
        constants: &wgpu::Buffer,
    ) -> wgpu::BindGroup {
        let resources = [
            constants.as_entire_binding(),
            tiles.as_entire_binding(),
            wgpu::BindingResource::TextureView(&self.owners),
            wgpu::BindingResource::TextureView(&self.geometry),
            wgpu::BindingResource::TextureView(&self.frames),
            wgpu::BindingResource::TextureView(&links.rows),
            self.pieces.as_entire_binding(),
            wgpu::BindingResource::TextureView(&self.leaps),
        ];
        gpu.bind(gpu.surface_layout(), resources)
    }
}

/// Returns the area of all owned texels in square working units, summed in an order that does not depend on threads.
fn covered_area(atlas: &Atlas, tables: &SurfaceTables) -> f64 {
    let texel_area = |rows: &[[f32; 4]; 6]| {
        texel_area_vector(rows)
            .iter()
            .map(|value| value * value)
            .sum::<f64>()
            .sqrt()
    };
    let (triangles, _) = tables.geometry.as_chunks::<6>();
    let areas: Vec<f64> = triangles.par_iter().map(texel_area).collect();
    let of_row = |owners: &[u32]| {
        let owned = owners.iter().filter(|owner| **owner & GHOST_BIT == 0);
        owned.map(|owner| areas[*owner as usize]).sum::<f64>()
    };
    let rows: Vec<f64> = atlas
        .owners
        .par_chunks(atlas.page_size[0] as usize)
        .map(of_row)
        .collect();
    rows.iter().sum()
}
