//! Constants of the kernels of sources, as their uniform buffers hold them.

use sabi_nodes::wgsl_struct;

use crate::source_shader::TEXTURES;

/// Number of rows of a table of a picture that precede its pixels.
pub const COPY_ROWS: u32 = 32;
/// Rows of a triangle in a table of coordinates.
pub const COORDINATE_ROWS: u32 = 2;
/// Rows of a triangle in a table of coordinates that includes tangents.
pub const COORDINATE_ROWS_WITH_TANGENTS: u32 = 5;
/// Rows of a triangle in a table of corners.
pub const CORNER_ROWS: u32 = 2;
/// Number that means that a component reads no channel of a texture.
pub const NO_CHANNEL: u32 = 16;

wgsl_struct! {
    "source/picture" Picture:
    /// Constants for reading a picture.
    #[derive(Default)]
    pub struct PictureConstants {
        /// Number of the smallest copy.
        pub last: u32,
        /// 1 if the weight of a color in averages is its alpha.
        pub by_alpha: u32,
        /// Pixels beyond the borders along u and v: repeated, the pixel at the border, or mirrored and repeated.
        pub wrap: [u32; 2],
    }
}

wgsl_struct! {
    "source/projection" Projection:
    /// Projection of a picture onto the surface; lengths and positions in working units, directions in model space.
    #[derive(Default)]
    pub struct ProjectionConstants {
        /// Width of a tile, or of the decal.
        pub size: f32,
        /// Height of a tile divided by its width.
        pub aspect: f32,
        /// Cosine and sine of the rotation, counter-clockwise as seen.
        pub turn: [f32; 2],
        /// Offset to the right and upward, in tiles.
        pub offset: [f32; 2],
        /// Repeats of the texture coordinates.
        pub tiles: [f32; 2],
        /// Columns and rows of pictures in the file.
        pub cells: [f32; 2],
        /// Half a pixel of the file, in texture coordinates.
        pub half_pixel: [f32; 2],
        /// Middle of a decal.
        pub middle: [f32; 3],
        /// Largest angle between the normal of the surface and that of a decal, radians.
        pub facing: f32,
        /// Direction to the right of a decal.
        pub right: [f32; 3],
        /// Exponent of the weights of the three sides.
        pub sharpness: f32,
        /// Direction to the top of a decal.
        pub up: [f32; 3],
        /// Distance to which a decal reaches in front of its middle and behind it.
        pub depth: f32,
        /// Direction that a decal faces.
        pub toward: [f32; 3],
        /// Unused.
        pub pad: f32,
    }
}

wgsl_struct! {
    "source/image" Image:
    /// Constants for showing a picture on the surface.
    pub struct ImageConstants {
        /// Its projection.
        pub projection: ProjectionConstants,
        /// Mean of the picture.
        pub mean: [f32; 4],
        /// Constants for reading it.
        pub picture: PictureConstants,
        /// Displayed value: color, luminance, alpha, red, green or blue.
        pub shown: u32,
        /// 1 if values are limited to the range from 0 to 1.
        pub is_limited: u32,
        /// Number of the arrangement of random patches.
        pub seed: u32,
        /// Largest rotation of a patch, radians.
        pub most_turned: f32,
        /// Sign of green in a normal map; 0 where the picture is gray.
        pub green: f32,
        /// 1 if the input that selects one of several pictures is connected.
        pub has_cell: u32,
        /// Unused.
        pub pad: [u32; 2],
    }
}

wgsl_struct! {
    "source/coordinates" Texture:
    /// A texture of a material.
    #[derive(Default)]
    pub struct TextureConstants {
        /// First row of the transform of texture coordinates.
        pub u: [f32; 3],
        /// Rows of a triangle in the table of the texture's own coordinates; 0 if it uses those of the atlas.
        pub coordinate_rows: u32,
        /// Second row of the transform.
        pub v: [f32; 3],
        /// Unused.
        pub pad: u32,
        /// Constants for reading it.
        pub picture: PictureConstants,
    }
}

wgsl_struct! {
    "source/textures" Textures:
    /// Channels of the textures of a material.
    pub struct TexturesConstants {
        /// Material whose triangles are filled.
        pub material: u32,
        /// Value from which a component that is cut is 1, and below which it is 0.
        pub cutoff: f32,
        /// Components that are cut, a bit for each.
        pub is_cut: u32,
        /// Unused.
        pub pad: u32,
        /// Channels that are multiplied to get each component: four channels for each texture in turn.
        pub first: [u32; 4],
        /// Second channel of each product.
        pub second: [u32; 4],
        /// Factors of the products.
        pub factor: [f32; 4],
        /// Added to the product.
        pub addend: [f32; 4],
        /// The textures.
        pub used: [TextureConstants; TEXTURES],
    }
}

wgsl_struct! {
    "source/directions" Directions:
    /// Directions that a texture of a material gives.
    pub struct DirectionConstants {
        /// Material whose triangles are filled.
        pub material: u32,
        /// Factor of a slope, or of the strength of scratches.
        pub factor: f32,
        /// Cosine and sine of a rotation of the scratches.
        pub turn: [f32; 2],
        /// The texture.
        pub used: TextureConstants,
    }
}
