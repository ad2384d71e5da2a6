//! The linked atlas: UV charts on pages of texels, with ghost texels that are linked to the surface point beyond the seam.
//!
//! Texel coordinates: the center of texel `(x, y)` lies at `(x + 0.5, y + 0.5)`; `y` grows downward like `v`.
//!
//! The steps from a mesh to an atlas, one file each: `topology` (half-edges and their twins), `charts` (connected in UV),
//! `raster` and `mask` (texel centers that a chart covers), `chart_split`, `gaps` and `division` (charts that overlap
//! themselves or have narrow gaps), `chart_placement` and `pack` (positions of charts), `owners`, `ring` (ghosts),
//! `walk` and `links` (surface points of ghosts), `leap`, `overlap` and `report`. `build` runs them in order. `repeats`
//! finds repeating UVs that take more texels than they show, `udim` finds tiles with maps of their own, `level` builds
//! coarser levels, and `width` limits their number.

mod build;
mod build_inputs;
mod cache;
mod chart_placement;
mod chart_split;
pub(crate) mod charts;
mod codec;
mod division;
mod error;
pub(crate) mod fixed_point_uvs;
mod gaps;
mod leap;
mod level;
mod links;
pub(crate) mod mask;
mod overlap;
mod owners;
pub(crate) mod pack;
pub(crate) mod raster;
mod repeats;
mod report;
mod ring;
#[cfg(test)]
mod tests;
pub(crate) mod topology;
mod udim;
mod walk;
mod width;

use std::collections::BTreeSet;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use cache::{atlas_key, cached};
pub use error::AtlasError;
pub use level::{AtlasLevel, Orphan};
pub use repeats::{Repeats, repeats};
pub use udim::udim_number;

/// Value of a texel that belongs to nothing.
pub const EMPTY: u32 = u32::MAX;
/// Bit that marks a ghost in [`Atlas::owners`]. The other bits are then the ghost's index in [`Atlas::ghosts`].
pub const GHOST_BIT: u32 = 1 << 31;
/// Side length, in texels, of the square tiles into which work is divided.
pub const TILE: u32 = 8;

/// Rings of ghost texels around a chart.
pub const RINGS: u32 = 2;

/// Maximum number of pairs of overlapping charts that a report lists.
pub const PAIRS_LIMIT: usize = 10_000;

/// Treatment of UVs in several tiles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Udim {
    /// UDIM, unless something indicates a repeating texture.
    #[default]
    Auto,
    /// UDIM: each tile has its own maps.
    On,
    /// A repeating texture: one set of maps for all tiles.
    Off,
}

/// Options of building an atlas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AtlasOptions {
    /// Texels for one unit of UV, 16 to 16384.
    pub size: u32,
    /// Maximum width and height of a page in texels, a multiple of [`TILE`], 32 to 16384.
    pub page_limit: u32,
    /// Treatment of UVs in several tiles.
    pub udim: Udim,
    /// Maximum memory of the atlas in bytes. An atlas that would need more is refused before it is allocated.
    pub memory_bytes: u64,
}

/// Largest side of a page that every adapter supports, texels.
const ORDINARY_PAGE: u32 = 8192;
/// Largest side of a page, texels.
const LARGEST_PAGE: u32 = 16_384;

impl AtlasOptions {
    /// Creates options for `size` texels per unit of UV. Pages are small enough for every adapter, unless one chart of the
    /// whole unit square needs a larger page.
    pub fn new(size: u32) -> AtlasOptions {
        let largest_chart = size.next_multiple_of(TILE) + 2 * TILE;
        AtlasOptions {
            size,
            page_limit: largest_chart.clamp(ORDINARY_PAGE, LARGEST_PAGE),
            udim: Udim::Auto,
            memory_bytes: u64::MAX,
        }
    }
}

/// Content of a texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// Neither surface nor ghost.
    Empty,
    /// Surface; the number of the triangle.
    Triangle(u32),
    /// Ghost; its index in [`Atlas::ghosts`].
    Ghost(u32),
}

impl Atlas {
    /// Bytes that it takes for its texels and ghosts.
    pub fn memory_bytes(&self) -> u64 {
        let texels = size_of_val(self.owners.as_slice()) + size_of_val(self.leap.as_slice());
        (texels + size_of_val(self.ghosts.as_slice())) as u64
    }

    /// Returns the content of texel `(x, y)` of `page`; [`Owner::Empty`] outside of the pages.
    pub fn owner(&self, x: u32, y: u32, page: u32) -> Owner {
        let [width, height] = self.page_size;
        if x >= width || y >= height || page >= self.pages {
            return Owner::Empty;
        }
        let row = page as usize * height as usize + y as usize;
        match self.owners.get(row * width as usize + x as usize) {
            None | Some(&EMPTY) => Owner::Empty,
            Some(&value) if value & GHOST_BIT != 0 => Owner::Ghost(value & !GHOST_BIT),
            Some(&value) => Owner::Triangle(value),
        }
    }

    /// Returns the number of the chart in UV that a triangle of the mesh belongs to.
    pub fn uv_chart(&self, triangle: usize) -> u32 {
        self.charts[self.triangle_chart[triangle] as usize].uv_chart
    }

    /// Returns the charts in UV by their numbers.
    pub fn uv_charts(&self) -> Vec<UvChart<'_>> {
        let mut parts: Vec<Vec<&Chart>> = Vec::new();
        for chart in &self.charts {
            let number = chart.uv_chart as usize;
            parts.resize(parts.len().max(number + 1), Vec::new());
            parts[number].push(chart);
        }
        parts.into_iter().map(|parts| UvChart { parts }).collect()
    }
}

/// The linked atlas of one model at one size.
#[derive(Clone, Debug, PartialEq)]
pub struct Atlas {
    /// Texels for one unit of UV.
    pub size: u32,
    /// Width and height of every page, multiples of [`TILE`], at most [`AtlasOptions::page_limit`].
    pub page_size: [u32; 2],
    /// Number of pages.
    pub pages: u32,
    /// For each texel, page by page and row by row: [`EMPTY`], the owning triangle, or [`GHOST_BIT`] and a ghost's index.
    pub owners: Vec<u32>,
    /// Sheets whose UV tiles have separate maps. The textures of other sheets repeat.
    pub udim_sheets: BTreeSet<u32>,
    /// Charts in a fixed order: by material, then by first triangle.
    pub charts: Vec<Chart>,
    /// Chart of each triangle.
    pub triangle_chart: Vec<u32>,
    /// Corners of each triangle in texel coordinates of its chart's page. For the affine map of a triangle that is small
    /// compared to a texel, use the differences of `uv × size` instead, since these corners are rounded to f32 on the page.
    pub triangle_texels: Vec<[[f32; 2]; 3]>,
    /// Ghosts in the order of their texels.
    pub ghosts: Vec<Ghost>,
    /// Tiles with at least one owned or ghost texel, sorted by page, tile row and tile column.
    pub tiles: Vec<TileRef>,
    /// For each texel the radius, in texels, within which a straight step stays inside the chart and reaches no texel whose
    /// metric differs by more than 5 % from its neighbor's. 0 outside of charts and beside such a jump.
    pub leap: Vec<u8>,
    /// Measurements and warnings of the build.
    pub report: AtlasReport,
}

/// A chart in UV as the user sees it: triangles connected through edges that are not seams, or a part of these triangles
/// that does not overlap itself.
#[derive(Clone, Debug, PartialEq)]
pub struct UvChart<'a> {
    /// Charts of the atlas: more than one if the chart lies too close to itself to be placed as a whole. They have the same
    /// material, sheet, tile and winding.
    pub parts: Vec<&'a Chart>,
}

impl UvChart<'_> {
    /// Number of owned texels.
    pub fn texels(&self) -> u64 {
        self.parts.iter().map(|part| u64::from(part.texels)).sum()
    }

    /// Width and height in texels.
    pub fn extent(&self) -> [u32; 2] {
        [0, 1].map(|axis| {
            let owning = self.parts.iter().filter(|part| part.texels > 0);
            let ends = owning.map(|part| {
                let ends = [part.bounds[axis], part.bounds[axis + 2]];
                ends.map(|end| i64::from(end) - i64::from(part.texel_from_uv[axis]))
            });
            let both = ends.reduce(|[low, high], [start, end]| [low.min(start), high.max(end)]);
            both.map_or(0, |[low, high]| (high - low) as u32)
        })
    }
}

/// A chart of the atlas: a chart in UV or a part of one, placed at an offset of whole texels.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Number of the chart in UV.
    pub uv_chart: u32,
    /// Page of the chart.
    pub page: u32,
    /// Offset that is added to `uv × size` to get texel coordinates on the page.
    pub texel_from_uv: [i32; 2],
    /// Owned texels' bounding box on the page: `[x0, y0, x1, y1]`, upper ends excluded.
    pub bounds: [u32; 4],
    /// Material, an index into the model's materials.
    pub material: u32,
    /// Sheet of texture coordinates: the chart's material, or 0 for all charts if all materials share one sheet
    /// ([`crate::model::Mesh::is_one_sheet`]). Charts of different sheets never overlap.
    pub sheet: u32,
    /// UV tile, `[floor(u), floor(v)]` of the center of the chart in UV; `[0, 0]` is the unit square.
    pub uv_tile: [i32; 2],
    /// True if its texture coordinates are mirrored.
    pub mirrored: bool,
    /// Number of triangles.
    pub triangles: u32,
    /// Number of owned texels.
    pub texels: u32,
}

/// Texel just outside a chart, with the surface point that a straight walk over the seam reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ghost {
    /// Column, row, page.
    pub texel: [u32; 3],
    /// Chart whose ring it belongs to.
    pub chart: u32,
    /// Triangle of the surface point.
    pub target_triangle: u32,
    /// The surface point, in texel coordinates of the chart of that triangle.
    pub target_texel: [f32; 2],
    /// Matrix from texel vectors of the ghost's chart to texel vectors of the target's chart.
    pub target_from_own: [[f32; 2]; 2],
    /// Triangle of the chart in which stored values are read: the target's chart, or the chart on the other side of the
    /// seam if the target's chart owns no texel near the target.
    pub read_triangle: u32,
    /// Texel coordinates of the point to read, on the page of that chart.
    pub read_texel: [f32; 2],
}

/// Place of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct TileRef {
    /// Page.
    pub page: u32,
    /// Tile row.
    pub row: u32,
    /// Tile column.
    pub column: u32,
}

/// Measurements and warnings of a build, for reports.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AtlasReport {
    /// Owned texels of all charts divided by the texels of the unit squares in use, one for each sheet, or for each tile of a sheet whose
    /// tiles have maps of their own.
    pub coverage: f32,
    /// Owned texels whose place in the unit square of their sheet is claimed by another chart, too. UV tiles are wrapped
    /// onto one square, as by a repeating texture.
    pub overlap_texels: u64,
    /// Pairs of overlapping charts in UV, lower number first, with the number of texels that they share. At most 10 000 pairs are listed.
    pub overlapping_charts: Vec<(u32, u32, u64)>,
    /// Charts that coincide in UV with an earlier one (stacked or mirrored copies).
    pub stacked_charts: u32,
    /// Charts with mirrored texture coordinates.
    pub mirrored_charts: u32,
    /// Triangles without area in UV, which own no texels.
    pub degenerate_uv_triangles: u32,
    /// Triangles without area in space.
    pub degenerate_triangles: u32,
    /// Edges shared by more than two triangles. Two of these triangles stay linked if they are the only ones of one part,
    /// or the only ones that share the edge's vertices. The others have a border there.
    pub nonmanifold_edges: u32,
    /// Edges of only one triangle.
    pub border_edges: u32,
    /// Charts thinner than two texels.
    pub thin_charts: u32,
    /// Charts that are not at their place in the user's UV layout.
    pub moved_charts: u32,
    /// Ghosts without a link. They read their anchor texel.
    pub unlinked_ghosts: u32,
    /// Links whose end was moved by less than two texels towards the next owned texel, because bilinear sampling would not
    /// have reached one. This happens at the tips of charts and in thin charts.
    pub pulled_ghosts: u32,
    /// Sentences for the artist.
    pub warnings: Vec<String>,
}
