//! Points spread over the surface as a level that kernels run on.
//!
//! Points lie side by side in a texture, in no order. The table that holds the links of ghosts on a level of texels holds
//! the flow between points here; see `shaders/lib/surface.wgsl`, which reads it.

use std::sync::OnceLock;

use sabi_surface::atlas::{Atlas, EMPTY, GHOST_BIT, TILE};
use sabi_surface::points::{CellTexel, Flow, Lists, SurfacePoint, SurfacePoints};

use crate::device::Gpu;
use crate::error::GpuError;
use crate::links::GhostLinks;
use crate::pool::Extent;
use crate::surface::{GpuSurface, Measures};
use crate::tables::{FRAME_ROWS, GEOMETRY_ROWS, SurfaceTables};
use crate::tile_set::{TileSet, tile_number};
use crate::uploads::{storage_buffer, table_texture, texel_texture};

/// Points on the device.
pub struct PointSurface {
    pub(crate) surface: GpuSurface,
    /// Number of the level of texels that the cells of the points consist of.
    pub(super) cells_level: u32,
    /// Texels of the finest level along a side of one texel of that level.
    pub(super) factor: u32,
    /// Triangles on that level.
    pub(super) cell_frames: wgpu::TextureView,
    /// The point of each texel of that level.
    pub(super) point_of_texel: wgpu::TextureView,
    /// The texels of each cell.
    pub(super) cells: wgpu::TextureView,
    /// The points around each.
    pub(super) around: wgpu::TextureView,
}

/// Level of texels that the cells of points consist of.
#[derive(Clone, Copy)]
pub struct CellLevel<'l> {
    /// Its number.
    pub number: u32,
    /// Its atlas.
    pub atlas: &'l Atlas,
    /// Its tables.
    pub tables: &'l SurfaceTables,
}

impl PointSurface {
    /// Uploads points that were spread over a level of texels. `working_from_model` scales their positions.
    pub fn upload(
        gpu: &Gpu,
        points: &SurfacePoints,
        level: CellLevel<'_>,
        working_from_model: f64,
        measures: Measures,
    ) -> Result<PointSurface, GpuError> {
        let surface = surface_of_points(gpu, points, level, working_from_model, measures)?;
        let rows = cell_rows(points);
        let near = around_rows(points, working_from_model);
        let extent = [level.atlas.page_size[0], level.atlas.page_size[1], level.atlas.pages];
        let format = wgpu::TextureFormat::R32Uint;
        let labels = labels(points, level.atlas);
        let labels = bytemuck::cast_slice(&labels);
        let made = PointSurface {
            surface,
            cells_level: level.number,
            factor: 1 << level.number,
            cell_frames: table_texture(gpu, "the tangent frames", bytemuck::cast_slice(&level.tables.frames))?,
            point_of_texel: texel_texture(gpu, "the points of texels", format, extent, labels)?,
            cells: table_texture(gpu, "the cells of points", bytemuck::cast_slice(&rows))?,
            around: table_texture(gpu, "the points around points", bytemuck::cast_slice(&near))?,
        };
        gpu.wait()?;
        Ok(made)
    }
}

/// The points as texels of a surface.
fn surface_of_points(
    gpu: &Gpu,
    points: &SurfacePoints,
    level: CellLevel<'_>,
    working_from_model: f64,
    measures: Measures,
) -> Result<GpuSurface, GpuError> {
    let extent = extent(points.points.len());
    let [width, height, _] = extent;
    let tiles: Vec<u32> = (0..height / TILE)
        .flat_map(|row| (0..width / TILE).map(move |column| tile_number([column, row, 0])))
        .collect();
    let owners: Vec<u32> = (0..width * height)
        .map(|index| {
            if (index as usize) < points.points.len() {
                index
            } else {
                EMPTY
            }
        })
        .collect();
    let limit = gpu.device.limits().max_storage_buffer_binding_size;
    let buffer = |what: &'static str, bytes: &[u8]| {
        let buffer = storage_buffer(gpu, what, bytes.len() as u64, limit)?;
        gpu.queue.write_buffer(&buffer, 0, bytes);
        Ok::<_, GpuError>(buffer)
    };
    let tables = point_tables(points, level, width, working_from_model);
    let no_leaps = vec![0; owners.len()];
    Ok(GpuSurface {
        extent,
        tile_count: tiles.len() as u32,
        tiles: buffer("the tile list", bytemuck::cast_slice(&tiles))?,
        ghost_tiles: TileSet::default(),
        tile_numbers: tiles,
        owners: texel_texture(
            gpu,
            "the owner map",
            wgpu::TextureFormat::R32Uint,
            extent,
            bytemuck::cast_slice(&owners),
        )?,
        leaps: texel_texture(gpu, "the leap map", wgpu::TextureFormat::R8Uint, extent, &no_leaps)?,
        geometry: table_texture(gpu, "the points", bytemuck::cast_slice(&tables.geometry))?,
        frames: table_texture(gpu, "the tangent frames", bytemuck::cast_slice(&tables.frames))?,
        pieces: buffer("the pieces", bytemuck::cast_slice(&tables.pieces))?,
        ghosts: GhostLinks::none_beside(gpu, &flow_rows(points))?,
        stencils: OnceLock::new(),
        size: 1,
        measures,
        area: 0.0,
        bytes: owners.len() as u64 * 5,
    })
}

/// Returns the size of the texture of `count` points: nearly square, and a multiple of the tile size.
fn extent(count: usize) -> Extent {
    let width = ((count as f64).sqrt().ceil() as u32).next_multiple_of(TILE).max(TILE);
    let height = (count as u32).div_ceil(width).next_multiple_of(TILE).max(TILE);
    [width, height, 1]
}

/// Returns the rows of the points in the form in which kernels read those of triangles: each point is a plane as wide as the spacing.
fn point_tables(points: &SurfacePoints, level: CellLevel<'_>, width: u32, working_from_model: f64) -> SurfaceTables {
    let mut tables = SurfaceTables {
        pieces: level.tables.pieces.clone(),
        ..SurfaceTables::default()
    };
    let spacing = (points.spacing * working_from_model) as f32;
    for (index, point) in (0_u32..).zip(&points.points) {
        let center = [index % width, index / width].map(|at| at as f32 + 0.5);
        let (geometry, frames) = point_rows(point, center, level, [spacing, working_from_model as f32]);
        tables.geometry.extend(geometry);
        tables.frames.extend(frames);
    }
    tables
}

fn point_rows(
    point: &SurfacePoint,
    [x, y]: [f32; 2],
    level: CellLevel<'_>,
    [spacing, working_from_model]: [f32; 2],
) -> ([[f32; 4]; GEOMETRY_ROWS], [[f32; 4]; FRAME_ROWS]) {
    // The texel in the middle of a cell is owned, so the point has the part, piece, material and tangent of its triangle.
    let triangle = level.atlas.owners[point.texel as usize] as usize;
    let geometry = &level.tables.geometry[triangle * GEOMETRY_ROWS..][..GEOMETRY_ROWS];
    let frames = &level.tables.frames[triangle * FRAME_ROWS..][..FRAME_ROWS];
    let row = |[x, y, z]: [f32; 3], w: f32| [x, y, z, w];
    let scaled = |v: [f32; 3], factor: f32| v.map(|x| x * factor);
    let page_width = level.atlas.page_size[0];
    let page_texel = [
        point.texel % page_width,
        point.texel / page_width % level.atlas.page_size[1],
    ];
    let [chart_x, chart_y, chart, piece] = frames[3];
    let uv = |texel: u32, offset: f32| (texel as f32 + 0.5 - offset) / level.atlas.size as f32;
    let uv = [uv(page_texel[0], chart_x), uv(page_texel[1], chart_y)];
    let [tangent_x, tangent_y, tangent_z, uv_chart] = frames[0];
    let bitangent_bit = frames[1][3].to_bits() & 1;
    let rows = [
        row(scaled(point.position, working_from_model), x),
        row(scaled(point.axes[0], spacing), y),
        row(scaled(point.axes[1], spacing), spacing),
        row(point.normal, geometry[3][3]),
        row([0.0; 3], geometry[4][3]),
        row([0.0; 3], geometry[5][3]),
    ];
    let frame_rows = [
        row([tangent_x, tangent_y, tangent_z], uv_chart),
        // There is one page.
        row([0.0; 3], f32::from_bits(bitangent_bit)),
        row([0.0; 3], frames[2][3]),
        [x - uv[0], y - uv[1], chart, piece],
    ];
    (rows, frame_rows)
}

/// Returns a table of lists. Each list has a first row, which `head` builds from the index of its first entry and the
/// number of its entries. The rows of all entries follow.
fn rows_of<T, const N: usize>(
    lists: &Lists<T>,
    head: impl Fn(usize, u32, u32) -> [u32; 4],
    entries: impl Fn(Option<&T>) -> [u32; N],
) -> Vec<[u32; 4]> {
    let side_by_side = 4 / N;
    let count = |list: usize| lists.of(list).len();
    let mut rows = Vec::new();
    let mut first = lists.len() as u32;
    for list in 0..lists.len() {
        rows.push(head(list, first, count(list) as u32));
        first += (count(list) as u32).div_ceil(side_by_side as u32);
    }
    for list in 0..lists.len() {
        for chunk in lists.of(list).chunks(side_by_side) {
            let mut row = [0; 4];
            for at in 0..side_by_side {
                row[at * N..][..N].copy_from_slice(&entries(chunk.get(at)));
            }
            rows.push(row);
        }
    }
    rows
}

/// Rows of `surface_flow` in `shaders/lib/surface.wgsl`.
fn flow_rows(points: &SurfacePoints) -> Vec<[u32; 4]> {
    let entry = |flow: Option<&Flow>| flow.map_or([0; 2], |flow| [flow.to, flow.rate.to_bits()]);
    rows_of(&points.flows, |_, first, count| [first, count, 0, 0], entry)
}

/// Rows of `cells` in `shaders/surface/to_points.wgsl`.
fn cell_rows(points: &SurfacePoints) -> Vec<[u32; 4]> {
    let entry = |cell: Option<&CellTexel>| cell.map_or([0; 2], |cell| [cell.texel, cell.share.to_bits()]);
    rows_of(&points.cells, |_, first, count| [first, count, 0, 0], entry)
}

/// Rows of `around` in `shaders/surface/from_points.wgsl`.
fn around_rows(points: &SurfacePoints, working_from_model: f64) -> Vec<[u32; 4]> {
    // Each list ends with a number that is not a point.
    let ended = Lists {
        starts: points
            .around
            .starts
            .iter()
            .zip(0..)
            .map(|(start, list)| start + list)
            .collect(),
        entries: (0..points.around.len())
            .flat_map(|list| points.around.of(list).iter().copied().chain([EMPTY]))
            .collect(),
    };
    let place = |list: usize, first: u32| {
        let [x, y, z] = points.points[list]
            .position
            .map(|x| ((f64::from(x) * working_from_model) as f32).to_bits());
        [x, y, z, first]
    };
    rows_of(
        &ended,
        |list, first, _| place(list, first),
        |point: Option<&u32>| [point.copied().unwrap_or(EMPTY)],
    )
}

/// Returns the point of each texel of an atlas. A ghost has the point of the texel that it reads.
fn labels(points: &SurfacePoints, atlas: &Atlas) -> Vec<u32> {
    let [width, height] = atlas.page_size;
    let of_ghost = |ghost: u32| {
        let ghost = &atlas.ghosts[ghost as usize];
        let [x, y] = ghost.read_texel.map(|value| value.max(0.0) as u32);
        let page = atlas.charts[atlas.triangle_chart[ghost.read_triangle as usize] as usize].page;
        let index = (page as usize * height as usize + y as usize) * width as usize + x as usize;
        points.point_of_texel.get(index).copied().unwrap_or(EMPTY)
    };
    let owners = atlas.owners.iter().zip(&points.point_of_texel);
    owners
        .map(|(owner, point)| match *owner {
            EMPTY => EMPTY,
            owner if owner & GHOST_BIT != 0 => of_ghost(owner & !GHOST_BIT),
            _ => *point,
        })
        .collect()
}
