//! A loaded model: plain data, checked once at the door.

use std::path::PathBuf;
use std::sync::Arc;

/// A model as read from its file, every mesh of it in one world space.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// File name without folder and ending; names the maps of a lone unnamed material.
    pub stem: String,
    /// All triangles.
    pub mesh: Mesh,
    /// Materials in use, in the file's order. Never empty: a model without any has one unnamed.
    pub materials: Vec<ModelMaterial>,
    /// Encoded pictures that the materials name.
    pub images: Vec<ModelImage>,
    /// Names of the parts (mesh instances), indexed by [`Mesh::triangle_part`].
    pub parts: Vec<String>,
    /// Files that it was read from: the model's own, buffers, pictures, material libraries. Empty when read from memory.
    pub files: Vec<PathBuf>,
    /// What was repaired, reduced or left out, as sentences for the artist.
    pub warnings: Vec<String>,
}

/// Indexed triangles in world space: right-handed, +Y up, meters as far as the file knows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Positions, finite.
    pub positions: Vec<[f32; 3]>,
    /// Shading normals, unit length, one for each vertex.
    pub normals: Vec<[f32; 3]>,
    /// MikkTSpace tangents, unit length, `w` the sign of the bitangent; one for each vertex.
    pub tangents: Vec<[f32; 4]>,
    /// Texture coordinates of the chosen set, glTF convention (v grows downward), one for each vertex; empty when there are none.
    pub uvs: Vec<[f32; 2]>,
    /// Vertex colors, linear RGBA; empty when there are none.
    pub colors: Vec<[f32; 4]>,
    /// Corners as vertex numbers, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Material of each triangle, an index into [`Model::materials`].
    pub triangle_material: Vec<u32>,
    /// Part of each triangle, an index into [`Model::parts`].
    pub triangle_part: Vec<u32>,
}

/// A material of the model's own: glTF's metallic-roughness factors and textures.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelMaterial {
    /// Name in the file; empty when it has none.
    pub name: String,
    /// Linear RGBA factor.
    pub base_color_factor: [f32; 4],
    /// Metallic factor.
    pub metallic_factor: f32,
    /// Roughness factor.
    pub roughness_factor: f32,
    /// Emission factor, linear, emissive strength included.
    pub emission_factor: [f32; 3],
    /// How strongly the normal map tilts.
    pub normal_scale: f32,
    /// How strongly the occlusion map darkens.
    pub occlusion_strength: f32,
    /// Base color (sRGB) and alpha.
    pub base_color: Option<TextureRef>,
    /// Roughness in G, metallic in B.
    pub metallic_roughness: Option<TextureRef>,
    /// Tangent-space normal, Y+.
    pub normal: Option<TextureRef>,
    /// Occlusion in R.
    pub occlusion: Option<TextureRef>,
    /// Emission (sRGB).
    pub emission: Option<TextureRef>,
}

impl Default for ModelMaterial {
    fn default() -> Self {
        ModelMaterial {
            name: String::new(),
            base_color_factor: [1.0; 4],
            metallic_factor: 1.0,
            roughness_factor: 1.0,
            emission_factor: [0.0; 3],
            normal_scale: 1.0,
            occlusion_strength: 1.0,
            base_color: None,
            metallic_roughness: None,
            normal: None,
            occlusion: None,
            emission: None,
        }
    }
}

/// A use of an image by a material.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureRef {
    /// Index into [`Model::images`].
    pub image: usize,
    /// Wrap in u and v.
    pub wrap: [Wrap; 2],
    /// `uv_in_texture = uv_from_texture_transform × (u, v, 1)`, rows; the identity without KHR_texture_transform.
    pub transform: [[f32; 3]; 2],
    /// Whether the texture is meant for the UV set that was loaded into [`Mesh::uvs`].
    pub on_loaded_uv_set: bool,
}

/// What happens outside 0..1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// Tiles.
    Repeat,
    /// Repeats the edge.
    Clamp,
    /// Tiles, every second one mirrored.
    Mirror,
}

/// A picture still encoded as it is in the file or beside it.
#[derive(Clone, Debug)]
pub struct ModelImage {
    /// Name for messages: the file's name or `image 3 of model.glb`.
    pub name: String,
    /// The encoded bytes, or why they could not be read, as a sentence.
    pub bytes: Result<Arc<[u8]>, String>,
}
