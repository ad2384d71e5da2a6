//! The linked atlas on the device, in working units.

use bytemuck::{Pod, Zeroable};
use rayon::prelude::*;
use sabi_surface::atlas::{Atlas, Ghost, TILE};
use sabi_surface::model::Mesh;
use sabi_surface::pieces::Pieces;

use crate::device::Gpu;
use crate::error::GpuError;
use crate::pool::{Extent, array_view};

/// Rows of four floats for each triangle; see `shaders/surface/place.wgsl`, which reads them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceTables {
    /// Six rows a triangle: origin, its two steps a texel, and the same of the normal. The fourth column holds the
    /// reference texel (x, y), the texel's width (negative on mirrored charts), the part's number, the piece's seed, and the
    /// material's number; numbers and seed are bit patterns.
    pub geometry: Vec<[f32; 4]>,
    /// Four rows a triangle: tangent and its two steps a texel, then the chart's place and, as a bit pattern, its number.
    /// The fourth column of the first row holds the sign of the bitangent, that of the last the piece's number.
    pub frames: Vec<[f32; 4]>,
    /// Three rows a piece: the axes of its box, longest side first, and in the fourth column the box's middle.
    pub pieces: Vec<[f32; 4]>,
}

impl SurfaceTables {
    /// The tables for a mesh and its pieces, scaled by `working_from_model`.
    pub fn new(mesh: &Mesh, pieces: &Pieces, atlas: &Atlas, working_from_model: f64, seed: u32) -> SurfaceTables {
        let rows: Vec<TriangleRows> = (0..mesh.triangles.len())
            .into_par_iter()
            .map(|triangle| {
                let piece = pieces.triangle_piece[triangle];
                triangle_rows(mesh, piece, atlas, triangle, working_from_model, seed)
            })
            .collect();
        let piece_rows = pieces.boxes.iter().flat_map(|piece| {
            let middle = piece.center.map(|x| (f64::from(x) * working_from_model) as f32);
            [0, 1, 2].map(|at| {
                let [x, y, z] = piece.axes[at];
                [x, y, z, middle[at]]
            })
        });
        let mut tables = SurfaceTables {
            pieces: piece_rows.collect(),
            ..SurfaceTables::default()
        };
        tables.geometry.reserve(6 * rows.len());
        tables.frames.reserve(4 * rows.len());
        for (geometry, frames) in rows {
            tables.geometry.extend(geometry);
            tables.frames.extend(frames);
        }
        tables
    }
}

/// Rows of one triangle: geometry and frames.
type TriangleRows = ([[f32; 4]; 6], [[f32; 4]; 4]);

/// A quantity that is linear over a triangle: its value at the first corner, and its change a texel along u and v.
fn affine(corners: [[f64; 3]; 3], inverse: [[f64; 2]; 2]) -> [[f64; 3]; 3] {
    let mut rows = [corners[0], [0.0; 3], [0.0; 3]];
    for axis in 0..3 {
        let first = corners[1][axis] - corners[0][axis];
        let second = corners[2][axis] - corners[0][axis];
        rows[1][axis] = first * inverse[0][0] + second * inverse[1][0];
        rows[2][axis] = first * inverse[0][1] + second * inverse[1][1];
    }
    rows
}

/// Inverse of the matrix whose rows are the texel vectors of the two edges at the first corner; zero without area.
fn edge_inverse(texels: [[f32; 2]; 3]) -> [[f64; 2]; 2] {
    let edge = |to: usize, axis: usize| f64::from(texels[to][axis]) - f64::from(texels[0][axis]);
    let (a, b, c, d) = (edge(1, 0), edge(1, 1), edge(2, 0), edge(2, 1));
    let determinant = a * d - b * c;
    if determinant.abs() < 1e-12 {
        return [[0.0; 2]; 2];
    }
    // Columns are the weights of the first and second edge for a step along u and along v.
    [[d / determinant, -c / determinant], [-b / determinant, a / determinant]]
}

fn triangle_rows(
    mesh: &Mesh,
    piece: u32,
    atlas: &Atlas,
    triangle: usize,
    working_from_model: f64,
    seed: u32,
) -> TriangleRows {
    let corners = mesh.triangles[triangle].map(|vertex| vertex as usize);
    let texels = atlas.triangle_texels[triangle];
    let inverse = edge_inverse(texels);
    let scaled = |v: [f32; 3]| v.map(|x| f64::from(x) * working_from_model);
    let position = affine(corners.map(|corner| scaled(mesh.positions[corner])), inverse);
    let normal = affine(corners.map(|corner| mesh.normals[corner].map(f64::from)), inverse);
    let tangent = affine(
        corners.map(|corner| {
            let [x, y, z, _] = mesh.tangents[corner].map(f64::from);
            [x, y, z]
        }),
        inverse,
    );
    let length = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let width = length(position[1]).max(length(position[2]));
    let chart = &atlas.charts[atlas.triangle_chart[triangle] as usize];
    let signed_width = if chart.mirrored { -width.max(1e-30) } else { width };
    let part = mesh.triangle_part[triangle];
    let row = |v: [f64; 3], w: f32| [v[0] as f32, v[1] as f32, v[2] as f32, w];
    let geometry = [
        row(position[0], texels[0][0]),
        row(position[1], texels[0][1]),
        row(position[2], signed_width as f32),
        row(normal[0], f32::from_bits(part)),
        row(normal[1], f32::from_bits(sabi_plan::pcg(seed ^ sabi_plan::pcg(piece)))),
        row(normal[2], f32::from_bits(mesh.triangle_material[triangle])),
    ];
    let [offset_u, offset_v] = chart.texel_from_uv;
    let frames = [
        row(tangent[0], mesh.tangents[corners[0]][3]),
        row(tangent[1], 0.0),
        row(tangent[2], 0.0),
        [
            offset_u as f32,
            offset_v as f32,
            f32::from_bits(atlas.triangle_chart[triangle]),
            f32::from_bits(piece),
        ],
    ];
    (geometry, frames)
}

/// Three rows, as `ghost_link` in `shaders/surface/place.wgsl` reads them.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct GhostRow {
    target_texel: [f32; 2],
    triangle: u32,
    texel: u32,
    page: u32,
    target_page: u32,
    chart: u32,
    pad: u32,
    target_from_own: [f32; 4],
}

fn target_page(atlas: &Atlas, ghost: &Ghost) -> u32 {
    atlas.charts[atlas.triangle_chart[ghost.target_triangle as usize] as usize].page
}

/// Textures that every kernel binds for the surface: the owner map and three tables.
pub(crate) const SURFACE_TEXTURES: usize = 4;
/// Rows of a table along its texture's side; every adapter allows as many.
const TABLE_WIDTH: usize = 8192;
const TABLE_ROW_BYTES: usize = 16;

/// The surface on a device.
pub struct GpuSurface {
    pub(crate) extent: Extent,
    pub(crate) tiles: wgpu::Buffer,
    pub(crate) tile_count: u32,
    pub(crate) owners: wgpu::TextureView,
    pub(crate) geometry: wgpu::TextureView,
    pub(crate) frames: wgpu::TextureView,
    pub(crate) ghosts: wgpu::TextureView,
    pub(crate) pieces: wgpu::Buffer,
    pub(crate) ghost_count: u32,
    /// Room for one value a ghost, on its way from where it is gathered to where it is written.
    pub(crate) ghost_values: wgpu::Buffer,
    /// Texels for one unit of UV.
    pub(crate) size: u32,
    bytes: u64,
}

impl GpuSurface {
    /// Uploads an atlas and its tables.
    pub fn upload(gpu: &Gpu, atlas: &Atlas, tables: &SurfaceTables) -> Result<GpuSurface, GpuError> {
        let [width, height] = atlas.page_size;
        let extent = [width, height, atlas.pages];
        // Eleven bits a coordinate and ten for the page, as `texel_of` unpacks them.
        let tiles: Vec<u32> = atlas
            .tiles
            .iter()
            .map(|tile| tile.column | (tile.row << 11) | (tile.page << 22))
            .collect();
        let ghosts: Vec<GhostRow> = atlas
            .ghosts
            .iter()
            .map(|ghost| GhostRow {
                target_texel: ghost.target_texel,
                triangle: ghost.target_triangle,
                texel: ghost.texel[0] | (ghost.texel[1] << 16),
                page: ghost.texel[2],
                target_page: target_page(atlas, ghost),
                chart: ghost.chart,
                pad: 0,
                target_from_own: [
                    ghost.target_from_own[0][0],
                    ghost.target_from_own[0][1],
                    ghost.target_from_own[1][0],
                    ghost.target_from_own[1][1],
                ],
            })
            .collect();
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        let buffer = |what: &'static str, bytes: &[u8]| {
            let buffer = storage_buffer(gpu, what, bytes.len() as u64, limit)?;
            if !bytes.is_empty() {
                gpu.queue.write_buffer(&buffer, 0, bytes);
            }
            Ok::<_, GpuError>(buffer)
        };
        let owners = owners_texture(gpu, atlas, extent)?;
        let surface = GpuSurface {
            extent,
            tile_count: tiles.len() as u32,
            tiles: buffer("the tile list", bytemuck::cast_slice(&tiles))?,
            owners,
            geometry: table_texture(gpu, "the triangles", bytemuck::cast_slice(&tables.geometry))?,
            frames: table_texture(gpu, "the tangent frames", bytemuck::cast_slice(&tables.frames))?,
            pieces: buffer("the pieces", bytemuck::cast_slice(&tables.pieces))?,
            ghost_count: ghosts.len() as u32,
            ghosts: table_texture(gpu, "the links over seams", bytemuck::cast_slice(&ghosts))?,
            ghost_values: storage_buffer(gpu, "the values over seams", 16 * ghosts.len() as u64, limit)?,
            size: atlas.size,
            bytes: atlas.owners.len() as u64 * 4,
        };
        gpu.wait()?;
        Ok(surface)
    }

    /// Bytes of textures that the surface itself takes; every run counts them in its budget and its peak.
    pub fn texture_bytes(&self) -> u64 {
        self.bytes
    }

    /// Texels of all pages.
    pub fn texels(&self) -> u64 {
        self.extent.iter().map(|side| u64::from(*side)).product()
    }

    /// Number of 8 × 8 tiles with something on them.
    pub fn tile_count(&self) -> u32 {
        self.tile_count
    }
}

fn storage_buffer(gpu: &Gpu, what: &'static str, bytes: u64, limit: u64) -> Result<wgpu::Buffer, GpuError> {
    let size = bytes.max(64).next_multiple_of(16);
    if size > limit {
        return Err(GpuError::TooLarge {
            what,
            needed_mib: size.div_ceil(1 << 20),
            limit_mib: limit >> 20,
        });
    }
    gpu.guarded(what, |device| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(what),
            size,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    })
}

/// The texture that holds a table, if adapters of `highest` texels a side have one.
fn table_extent(what: &'static str, rows: usize, highest: u32) -> Result<wgpu::Extent3d, GpuError> {
    let lines = rows.div_ceil(TABLE_WIDTH).max(1);
    if lines > highest as usize {
        let mib = |lines: usize| ((lines * TABLE_WIDTH * TABLE_ROW_BYTES) as u64).div_ceil(1 << 20);
        return Err(GpuError::TooLarge {
            what,
            needed_mib: mib(lines),
            limit_mib: mib(highest as usize),
        });
    }
    Ok(wgpu::Extent3d {
        width: rows.clamp(1, TABLE_WIDTH) as u32,
        height: lines as u32,
        depth_or_array_layers: 1,
    })
}

/// A table of rows of four numbers as a texture of bit patterns, see `shaders/surface/place.wgsl`.
fn table_texture(gpu: &Gpu, what: &'static str, bytes: &[u8]) -> Result<wgpu::TextureView, GpuError> {
    let rows = bytes.len() / TABLE_ROW_BYTES;
    let size = table_extent(what, rows, gpu.device.limits().max_texture_dimension_2d)?;
    let texture = gpu.guarded(what, |device| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: Some(what),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba32Uint,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        })
    })?;
    let line = TABLE_WIDTH * TABLE_ROW_BYTES;
    let whole = bytes.len() / line;
    for (first, height, part) in [(0, whole, &bytes[..whole * line]), (whole, 1, &bytes[whole * line..])] {
        if part.is_empty() {
            continue;
        }
        let mut target = texture.as_image_copy();
        target.origin.y = first as u32;
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(line as u32),
            rows_per_image: None,
        };
        let extent = wgpu::Extent3d {
            width: (part.len() / height / TABLE_ROW_BYTES) as u32,
            height: height as u32,
            depth_or_array_layers: 1,
        };
        gpu.queue.write_texture(target, part, layout, extent);
    }
    Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}

fn owners_texture(gpu: &Gpu, atlas: &Atlas, extent: Extent) -> Result<wgpu::TextureView, GpuError> {
    let [width, height, pages] = extent;
    debug_assert!(width.is_multiple_of(TILE) && height.is_multiple_of(TILE));
    let size = wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: pages,
    };
    let texture = gpu.guarded("the owner map", |device| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: Some("owners"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::R32Uint,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        })
    })?;
    gpu.queue.write_texture(
        texture.as_image_copy(),
        bytemuck::cast_slice(&atlas.owners),
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * width),
            rows_per_image: Some(height),
        },
        size,
    );
    Ok(array_view(&texture))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_takes_as_many_lines_as_it_needs_and_no_more_than_the_adapter_has() {
        let extent = |rows| table_extent("the triangles", rows, 8192).map(|size| [size.width, size.height]);
        assert_eq!(extent(0), Ok([1, 1]));
        assert_eq!(extent(8192), Ok([8192, 1]));
        assert_eq!(extent(8193), Ok([8192, 2]));
        assert_eq!(extent(8192 * 8192), Ok([8192, 8192]));
        let error = extent(8192 * 8192 + 1).expect_err("one line too many").to_string();
        assert!(
            error.contains("the triangles") && error.contains("1025") && error.contains("1024"),
            "{error}"
        );
    }
}
