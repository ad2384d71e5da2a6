//! Errors of building an atlas.

/// Reason why an atlas could not be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AtlasError {
    /// The model has no triangles.
    #[error("the model has no triangles, so there is no surface to work on; choose a model with faces")]
    NoTriangles,
    /// The model has no UVs.
    #[error(
        "the model has no texture coordinates, and the maps need a place for every part of it; unwrap it in your \
         modeling program and export it with UVs"
    )]
    NoUvs,
    /// The UVs cover no texel.
    #[error(
        "the model's texture coordinates cover no texel at {size} texels for the unit square: they have no area, or \
         next to none; unwrap it in your modeling program or bake at a larger size"
    )]
    NoArea {
        /// Requested number of texels.
        size: u32,
    },
    /// The mesh contradicts itself.
    #[error("the mesh is damaged: {what}; export the model again")]
    BrokenMesh {
        /// Contradiction that was found.
        what: String,
    },
    /// Size outside of what is supported.
    #[error("a size of {size} texels was asked for, but it has to be between 16 and 16384")]
    SizeOutOfRange {
        /// Requested number of texels.
        size: u32,
    },
    /// Page limit outside of what is supported.
    #[error("a page limit of {limit} texels was asked for, but it has to be a multiple of 8 between 32 and 16384")]
    PageLimitOutOfRange {
        /// Requested number of texels.
        limit: u32,
    },
    /// UVs are too far from the unit square for texel numbers.
    #[error(
        "the texture coordinate ({u}, {v}) of vertex {vertex} lies too far from the unit square to be placed at \
         {size} texels"
    )]
    UvTooFar {
        /// Vertex number.
        vertex: u32,
        /// Its u, as text.
        u: String,
        /// Its v, as text.
        v: String,
        /// Texels for the unit square.
        size: u32,
    },
    /// UDIM was requested and a chart lies in a tile without a UDIM number.
    #[error(
        "a UV chart (the one with triangle {triangle}) lies in the UV tile with u from {u} to {} and v, counted upward, from {v} to {}, \
         which has no UDIM number: those have u from 0 to 10, and v from 0 to 900",
        u + 1,
        v + 1
    )]
    NoUdimNumber {
        /// One of its triangles.
        triangle: u32,
        /// Column of the tile.
        u: i32,
        /// Row of the tile, counted upward.
        v: i32,
    },
    /// A chart does not fit on a page.
    #[error(
        "a UV chart (the one with triangle {triangle}) is {width} × {height} texels large at size {size}, but a page \
         holds {limit} × {limit}"
    )]
    ChartTooLarge {
        /// One of its triangles.
        triangle: u32,
        /// Texels across.
        width: u64,
        /// Texels down.
        height: u64,
        /// Texels for the unit square.
        size: u32,
        /// Largest chart a page takes, texels.
        limit: u32,
    },
    /// The charts need more texels than an atlas can have.
    #[error("at size {size} the model's {charts} UV charts need {needed}, but at most {limit} can be held")]
    TooManyTexels {
        /// Texels for the unit square.
        size: u32,
        /// Number of charts.
        charts: usize,
        /// Required amount, with its unit.
        needed: String,
        /// Available amount, with its unit.
        limit: String,
    },
    /// The atlas needs more memory than is allowed.
    #[error(
        "at size {size} the layout of the model's {charts} UV charts needs {needed_mib} MiB of memory, and there are {limit_mib} for it"
    )]
    Memory {
        /// Texels for the unit square.
        size: u32,
        /// Number of charts.
        charts: usize,
        /// Memory that the atlas needs, MiB.
        needed_mib: u64,
        /// Memory that the atlas may use, MiB.
        limit_mib: u64,
    },
    /// A level that would be too small to be useful.
    #[error("level {level} of an atlas of {size} texels would be {level_size} texels, but it has to keep at least 8")]
    LevelTooSmall {
        /// Level asked for.
        level: u32,
        /// Size of the finest level.
        size: u32,
        /// Size the level would have.
        level_size: u32,
    },
    /// Mesh and atlas do not belong together.
    #[error("the mesh has {triangles} triangles but the atlas was built for {expected}; build the atlas of this mesh")]
    WrongMesh {
        /// Triangles of the mesh.
        triangles: usize,
        /// Triangles of the atlas.
        expected: usize,
    },
}
