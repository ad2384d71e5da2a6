//! The linked atlas: UV charts on pages of texels, with ghost texels that know the surface point over the seam.
//!
//! Texel coordinates: the center of texel `(x, y)` lies at `(x + 0.5, y + 0.5)`; `y` grows downward like `v`.

/// A texel that nothing owns.
pub const EMPTY: u32 = u32::MAX;
/// Set in [`Atlas::owners`] when the texel is a ghost; the other bits are then its index in [`Atlas::ghosts`].
pub const GHOST_BIT: u32 = 1 << 31;
/// Side of the square tiles that work is cut into, texels.
pub const TILE: u32 = 8;

/// The linked atlas of one model at one size.
#[derive(Clone, Debug, PartialEq)]
pub struct Atlas {
    /// Texels for one unit of UV.
    pub size: u32,
    /// Width and height of every page, multiples of [`TILE`], at most 8192.
    pub page_size: [u32; 2],
    /// Number of pages.
    pub pages: u32,
    /// For each texel, page by page and row by row: [`EMPTY`], the owning triangle, or [`GHOST_BIT`] and a ghost's index.
    pub owners: Vec<u32>,
    /// Charts in a fixed order: by material, then by first triangle.
    pub charts: Vec<Chart>,
    /// Chart of each triangle.
    pub triangle_chart: Vec<u32>,
    /// Corners of each triangle in texel coordinates of its chart's page.
    pub triangle_texels: Vec<[[f32; 2]; 3]>,
    /// Ghosts in the order of their texels.
    pub ghosts: Vec<Ghost>,
    /// Tiles with at least one owned or ghost texel: page, tile row, tile column, in that order of sorting.
    pub tiles: Vec<TileRef>,
    /// For each texel the radius in texels within which a straight step stays inside the chart; 0 outside.
    pub leap: Vec<u8>,
    /// What was found and done.
    pub report: AtlasReport,
}

/// A chart: triangles connected through edges that are not seams, placed at a whole-texel offset.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Page it lies on.
    pub page: u32,
    /// Add to `uv × size` to get texel coordinates on the page.
    pub texel_from_uv: [i32; 2],
    /// Owned texels' bounding box on the page: `[x0, y0, x1, y1]`, upper ends excluded.
    pub bounds: [u32; 4],
    /// Material, an index into the model's materials.
    pub material: u32,
    /// UV tile, `[floor(u), floor(v)]` of the chart's center; `[0, 0]` is the unit square.
    pub uv_tile: [i32; 2],
    /// Whether its texture coordinates are mirrored.
    pub mirrored: bool,
    /// Number of triangles.
    pub triangles: u32,
    /// Number of owned texels.
    pub texels: u32,
}

/// A texel just outside a chart, and the surface point one reaches by walking straight over the seam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ghost {
    /// Column, row, page.
    pub texel: [u32; 3],
    /// Chart whose ring it belongs to.
    pub chart: u32,
    /// Triangle of the point reached.
    pub target_triangle: u32,
    /// The point reached, in texel coordinates of that triangle's chart.
    pub target_texel: [f32; 2],
    /// Columns carry the own chart's texel axes to texel vectors of the target's chart.
    pub target_from_own: [[f32; 2]; 2],
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

/// What was found while building, for `sabi mesh` and the report file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AtlasReport {
    /// Owned texels of all charts divided by the texels of the unit squares in use.
    pub coverage: f32,
    /// Owned texels whose place in the unit square another chart claims as well.
    pub overlap_texels: u64,
    /// Pairs of overlapping charts, lower index first, with the number of texels they share.
    pub overlapping_charts: Vec<(u32, u32, u64)>,
    /// Charts that coincide in UV with an earlier one (stacked or mirrored copies).
    pub stacked_charts: u32,
    /// Charts with mirrored texture coordinates.
    pub mirrored_charts: u32,
    /// Triangles without area in UV: they own nothing.
    pub degenerate_uv_triangles: u32,
    /// Triangles without area in space.
    pub degenerate_triangles: u32,
    /// Edges shared by more than two triangles, treated as borders.
    pub nonmanifold_edges: u32,
    /// Edges with one triangle.
    pub border_edges: u32,
    /// Charts thinner than two texels.
    pub thin_charts: u32,
    /// Charts that were moved from their place in the user's layout.
    pub moved_charts: u32,
    /// Links that gave up and point to their anchor texel.
    pub unlinked_ghosts: u32,
    /// Sentences for the artist.
    pub warnings: Vec<String>,
}
