//! A loaded model: plain data, checked on loading.

mod file_origins;
mod file_parts;
mod finish;
mod uv_decoding;

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use sabi_files::{Refusal, TrustedPaths};

pub use self::file_origins::{FileOrigins, PlacedPrimitive};
pub use self::file_parts::{ExclusionReason, FilePart};
pub use self::finish::{ModelFinish, TexturedFactor};
pub use self::uv_decoding::UvDecoding;

/// A model as read from its file, with all meshes in one world space.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// File name without folder and extension. It names the maps of a single unnamed material.
    pub stem: String,
    /// All triangles.
    pub mesh: Mesh,
    /// Origin of [`Model::mesh`] in the file's world. It is zero unless the model is far from the origin.
    pub middle: [f64; 3],
    /// Materials that are used, in the file's order. Never empty: a model without materials has one unnamed material.
    pub materials: Vec<ModelMaterial>,
    /// Encoded images to which the materials refer.
    pub images: Vec<ModelImage>,
    /// Names of the parts (mesh instances), indexed by [`Mesh::triangle_part`]. Connected triangles
    /// of a part are a piece: see [`crate::pieces`].
    pub parts: Vec<String>,
    /// All parts of the file in order: those of the model, and those that were left out.
    pub file_parts: Vec<FilePart>,
    /// Number of faces that were reversed because they were inside out.
    pub turned_faces: usize,
    /// Files from which the model was read: its own file, buffers, images, material libraries. Empty if it was read from memory.
    pub files: Vec<PathBuf>,
    /// Paths of missing files to which the model refers. If there are very many, only the first are listed.
    pub absent: Vec<PathBuf>,
    /// Total size of these files in bytes.
    pub file_bytes: u64,
    /// Refusals of files to which the model refers and that it may not open. If there are very many, only the first are listed.
    pub refused: Vec<Refusal>,
    /// Paths outside of its folder that the model was allowed to open.
    pub trusted: TrustedPaths,
    /// True if the file is glTF, text or binary. A copy of any other format is made from the loaded model.
    pub is_gltf: bool,
    /// Places in a glTF file from which the mesh was read; `None` for other formats.
    pub origins: Option<FileOrigins>,
    /// True if the normals are smoothed ones and not those of the file.
    pub is_smoothed: bool,
    /// Materials with triangles that lack the chosen UV set although others have it.
    pub without_uvs: BTreeSet<u32>,
    /// Warnings about repairs and omissions, as sentences for the artist.
    pub warnings: Vec<String>,
}

/// Indexed triangles in world space relative to [`Model::middle`]: right-handed, +Y up, in meters if the file declares its unit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Positions, finite.
    pub positions: Vec<[f32; 3]>,
    /// Shading normals, unit length, one for each vertex.
    pub normals: Vec<[f32; 3]>,
    /// MikkTSpace tangents for [`Mesh::uvs`], unit length, with the sign of the bitangent in `w`; one for each vertex.
    pub tangents: Vec<[f32; 4]>,
    /// Texture coordinates that the atlas and the maps use: those of the chosen set, or unwrapped ones. They follow glTF's
    /// convention (v grows downward), one for each vertex; empty if there are none.
    pub uvs: Vec<[f32; 2]>,
    /// Number of the file's set in [`Mesh::uvs`] (`TEXCOORD_n`); `None` if there are no UVs or they were unwrapped.
    pub uv_set: Option<u32>,
    /// True if all materials share one sheet of [`Mesh::uvs`], and so one set of maps. Otherwise each material has its own sheet.
    pub is_one_sheet: bool,
    /// Materials whose own textures repeat on the chosen set, so that their UVs outside of the unit square are not UDIM tiles.
    pub repeating: BTreeSet<u32>,
    /// The other sets that the model's own textures use, by ascending number.
    pub texture_uvs: Vec<TextureUvs>,
    /// Triangles that lack a set of the file while others have it. The triangles of each set are in ascending order.
    pub missing_uvs: Vec<MissingUvs>,
    /// Vertex colors, linear RGBA; empty when there are none.
    pub colors: Vec<[f32; 4]>,
    /// Corners as vertex numbers, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Material of each triangle, an index into [`Model::materials`].
    pub triangle_material: Vec<u32>,
    /// Part of each triangle, an index into [`Model::parts`].
    pub triangle_part: Vec<u32>,
}

/// A UV set of the file that textures use.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TextureUvs {
    /// Its number: `TEXCOORD_n`.
    pub set: u32,
    /// Coordinates for each vertex; zero if the file has none.
    pub uvs: Vec<[f32; 2]>,
    /// Tangents for a normal map of this set, like [`Mesh::tangents`]; empty if no normal map uses the set.
    pub tangents: Vec<[f32; 4]>,
}

/// Range of triangles whose vertices have no coordinates in a set. The stored zeros have no meaning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingUvs {
    /// The set's number: `TEXCOORD_n`.
    pub set: u32,
    /// Indices into [`Mesh::triangles`].
    pub triangles: Range<u32>,
}

/// Texture coordinates and tangents of a set, one of each for a vertex.
pub type SetView<'a> = (&'a [[f32; 2]], &'a [[f32; 4]]);

impl Mesh {
    /// Area of all triangles, square model units.
    pub fn area(&self) -> f64 {
        let areas = self.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|vertex| glam::Vec3::from(self.positions[vertex as usize]).as_dvec3());
            glam::DVec3::cross(b - a, c - a).length() * 0.5
        });
        areas.filter(|area| area.is_finite()).sum()
    }

    /// Returns the area of a triangle in UV, in tiles; 0 if a coordinate is not finite.
    pub fn uv_area(&self, triangle: u32) -> f64 {
        let corners = self.triangles[triangle as usize];
        let [a, b, c] = corners.map(|vertex| glam::DVec2::from(self.uvs[vertex as usize].map(f64::from)));
        let area = (b - a).perp_dot(c - a).abs() / 2.0;
        if area.is_finite() { area } else { 0.0 }
    }

    /// Positions of the corners of a triangle, model units.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        let corners = self.triangles[triangle as usize];
        corners.map(|vertex| DVec3::from(self.positions[vertex as usize].map(f64::from)))
    }

    /// Returns the point of a triangle with these weights of its corners, in model units.
    pub fn position(&self, triangle: u32, weights: [f64; 3]) -> DVec3 {
        let weighted = self.corners(triangle).into_iter().zip(weights);
        weighted.map(|(corner, weight)| corner * weight).sum()
    }

    /// Returns texture coordinates and tangents of a set of the file; `None` if it was not loaded.
    pub fn set(&self, set: u32) -> Option<SetView<'_>> {
        if self.uv_set == Some(set) {
            return Some((&self.uvs, &self.tangents));
        }
        let other = self.texture_uvs.iter().find(|other| other.set == set)?;
        Some((&other.uvs, &other.tangents))
    }
}

/// A material of the model: glTF's metallic-roughness factors and textures.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelMaterial {
    /// Name in the file; empty when it has none.
    pub name: String,
    /// Index among the materials of a glTF file; `None` for glTF's default material and for other formats.
    pub file_index: Option<usize>,
    /// Transform from the file's coordinates to [`Mesh::uvs`]; `None` if they are used as stored.
    pub uv_decoding: Option<UvDecoding>,
    /// Linear RGBA factor.
    pub base_color_factor: [f32; 4],
    /// True if alpha is ignored: glTF's alpha mode `OPAQUE`, with which textures may contain any alpha.
    pub ignores_alpha: bool,
    /// Alpha from which the material is opaque, and below which it is invisible: glTF's alpha mode `MASK`. `None` if alpha is an
    /// opacity.
    pub alpha_cutoff: Option<f32>,
    /// True if its back faces are visible, too; glTF states this for each material.
    pub is_double_sided: bool,
    /// Metallic factor.
    pub metallic_factor: f32,
    /// Roughness factor.
    pub roughness_factor: f32,
    /// Emission factor, linear, emissive strength included.
    pub emission_factor: [f32; 3],
    /// Scale of the normal map's tilt.
    pub normal_scale: f32,
    /// Strength of the occlusion map.
    pub occlusion_strength: f32,
    /// Base color (sRGB) and alpha.
    pub base_color: Option<TextureRef>,
    /// Roughness in G, metallic in B.
    pub metallic_roughness: Option<TextureRef>,
    /// Roughness in R, for formats with a separate image. It multiplies the roughness in [`ModelMaterial::metallic_roughness`].
    pub roughness: Option<TextureRef>,
    /// Metallic in R, like [`ModelMaterial::roughness`].
    pub metallic: Option<TextureRef>,
    /// Tangent-space normal, Y+.
    pub normal: Option<TextureRef>,
    /// Occlusion in R.
    pub occlusion: Option<TextureRef>,
    /// Emission (sRGB).
    pub emission: Option<TextureRef>,
    /// Rare properties.
    pub finish: ModelFinish,
}

impl Model {
    /// Names of the pictures of its materials that are not where the model says, each once.
    pub fn missing_pictures(&self) -> BTreeSet<&str> {
        let absent: BTreeSet<&str> = self
            .absent
            .iter()
            .filter_map(|place| place.file_name()?.to_str())
            .collect();
        let unread = self.images.iter().filter(|image| image.bytes.is_err());
        unread
            .map(|image| image.name.as_str())
            .filter(|name| absent.contains(name))
            .collect()
    }
}

impl ModelMaterial {
    /// Label in messages.
    pub fn label(&self) -> String {
        match self.file_index {
            _ if !self.name.is_empty() => format!("material `{}`", self.name),
            Some(index) => format!("material {index}"),
            None => "the unnamed material".to_owned(),
        }
    }

    /// The textures that it has.
    pub fn textures(&self) -> impl Iterator<Item = &TextureRef> {
        let all = [
            &self.base_color,
            &self.metallic_roughness,
            &self.roughness,
            &self.metallic,
            &self.normal,
            &self.occlusion,
            &self.emission,
        ];
        all.into_iter().flatten().chain(self.finish.textures())
    }

    /// The textures that it has, to be changed.
    pub(crate) fn textures_mut(&mut self) -> impl Iterator<Item = &mut TextureRef> {
        let all = [
            &mut self.base_color,
            &mut self.metallic_roughness,
            &mut self.roughness,
            &mut self.metallic,
            &mut self.normal,
            &mut self.occlusion,
            &mut self.emission,
        ];
        all.into_iter().flatten().chain(self.finish.textures_mut())
    }

    /// Linear base color of surfaces for which a file gives none, unless its format says which one they have: that of unfired
    /// clay, which shows its form in any light. White burns out where it is lit.
    pub(crate) const UNKNOWN_COLOR: [f32; 3] = [0.5; 3];

    /// Returns the material of faces without a material: neither metallic nor smooth, with the color of unknown ones.
    pub(crate) fn plain() -> ModelMaterial {
        let [red, green, blue] = ModelMaterial::UNKNOWN_COLOR;
        ModelMaterial {
            base_color_factor: [red, green, blue, 1.0],
            metallic_factor: 0.0,
            ..ModelMaterial::default()
        }
    }
}

impl Default for ModelMaterial {
    fn default() -> Self {
        ModelMaterial {
            name: String::new(),
            file_index: None,
            uv_decoding: None,
            base_color_factor: [1.0; 4],
            ignores_alpha: false,
            alpha_cutoff: None,
            is_double_sided: true,
            metallic_factor: 1.0,
            roughness_factor: 1.0,
            emission_factor: [0.0; 3],
            normal_scale: 1.0,
            occlusion_strength: 1.0,
            base_color: None,
            metallic_roughness: None,
            roughness: None,
            metallic: None,
            normal: None,
            occlusion: None,
            emission: None,
            finish: ModelFinish::default(),
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
    /// Its UV set; see [`Mesh::set`].
    pub uv_set: u32,
}

impl TextureRef {
    /// A use of an image that tiles over UV set 0.
    pub(crate) fn of(image: usize) -> TextureRef {
        TextureRef {
            image,
            wrap: [Wrap::Repeat; 2],
            transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            uv_set: 0,
        }
    }
}

/// Wrap mode outside 0..1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// Tiles.
    Repeat,
    /// Repeats the edge.
    Clamp,
    /// Tiles, every second one mirrored.
    Mirror,
}

/// An image, still encoded as in the file or beside it.
#[derive(Clone, Debug)]
pub struct ModelImage {
    /// Name for messages: the file's name or `image 3 of model.glb`.
    pub name: String,
    /// The encoded bytes, or why they could not be read, as a sentence.
    pub bytes: Result<Arc<[u8]>, String>,
}
