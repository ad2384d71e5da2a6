//! Reads model files: glTF, FBX, OBJ, COLLADA, PLY and STL are converted to a [`Model`] in world space.
//!
//! The readers check all numbers of a file, return a model with warnings or an error, and never panic.

mod arealess;
mod assembly;
mod blur;
mod color_codes;
mod completion;
mod dae;
mod error;
mod face_reversal;
mod faces;
mod far;
mod fbx;
mod format;
mod gltf;
mod material_images;
mod name_lists;
mod normals;
mod numbers;
mod obj;
mod opacity;
mod parts;
mod ply;
mod polygon;
mod referenced_files;
mod repeating_textures;
mod size;
mod skin_rest;
mod stl;
mod submesh;
mod tangents;
mod text;
mod unit_vector;
mod value_range;
mod warnings;

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DMat3, DMat4, DVec3};
use sabi_cancel::look;
use sabi_files::{PathBase, TrustedPaths, Unread, Uri, find_beside};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use self::error::{LoadError, ModelFault};
pub use self::format::MODEL_ENDINGS;
use self::format::{ModelFormat, format_of, refused_format};
pub use self::gltf::{UnpackedVertices, gltf_json};
pub use self::name_lists::listed;
pub use self::parts::PartChoice;
use self::referenced_files::ReferencedFiles;
use self::repeating_textures::repeating;
pub use self::size::mesh_bytes;
pub(crate) use self::submesh::Submesh;
pub(crate) use self::tangents::for_uvs as tangents_for_uvs;
use self::text::unmarked;
use crate::model::Model;

/// Maximum number of triangles of a model. More are refused before anything is allocated for them.
pub const MAX_TRIANGLES: u64 = 50_000_000;
/// Most bytes of a file: enough for the vertices and corners of [`MAX_TRIANGLES`] as text.
pub const MAX_FILE_BYTES: u64 = 32 << 30;
/// Largest smoothing angle in degrees: the angle between two faces cannot be larger.
const MOST_SMOOTH_DEGREES: f32 = 180.0;

/// Options of reading a model.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadOptions {
    /// UV set that is used for [`crate::model::Mesh::uvs`]: glTF's `TEXCOORD_n`, or the n-th set of a mesh in FBX and
    /// COLLADA. OBJ and PLY have only set 0.
    pub uv_set: u32,
    /// Axis of the file that points up. The model is rotated so that it becomes +Y. FBX and COLLADA files declare this axis
    /// and are rotated accordingly first, so that +Y is right unless the declaration is wrong.
    pub up: Up,
    /// Factor by which all lengths are multiplied; finite and above 0.
    pub scale: f32,
    /// Number of the scene in a glTF file; `None` for the file's default scene. Other formats have one scene.
    pub scene: Option<u32>,
    /// Angle between faces up to which their shading is smooth, in degrees, 0 to 180; `None` for the normals of the file.
    /// In glTF and COLLADA, the triangles of a mesh that have the same material are smoothed separately.
    pub smooth_degrees: Option<f32>,
    /// Choice of the parts to load.
    pub parts: PartChoice,
    /// True to turn faces that are inside out; see [`crate::orientation`].
    pub turns_faces: bool,
    /// Folder in which files that the model names and that are missing are searched by their names, including the
    /// folders in it.
    pub textures: Option<PathBuf>,
    /// Most bytes of memory for the files of a model together, for what they unpack to, and for its mesh, each. What would take
    /// more is refused before.
    pub memory_bytes: u64,
}

impl Default for LoadOptions {
    fn default() -> Self {
        LoadOptions {
            uv_set: 0,
            up: Up::Y,
            scale: 1.0,
            scene: None,
            smooth_degrees: None,
            parts: PartChoice::default(),
            turns_faces: false,
            textures: None,
            memory_bytes: u64::MAX,
        }
    }
}

impl LoadOptions {
    fn world_from_file(&self) -> DMat4 {
        DMat4::from_mat3(self.up.turned() * f64::from(self.scale))
    }
}

/// The axis of a file that points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Up {
    /// +Y, as in glTF.
    #[default]
    Y,
    /// +Z, as in CAD programs and some exporters.
    Z,
    /// +X.
    X,
}

impl Up {
    /// Returns the rotation that turns the axis to +Y.
    fn turned(self) -> DMat3 {
        match self {
            Up::Y => DMat3::IDENTITY,
            Up::Z => DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y),
            Up::X => DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z),
        }
    }
}

/// Reads a model file, and the files to which it refers, from its folder and below.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Model, LoadError> {
    load_trusting(path, &TrustedPaths::default(), options)
}

/// Reads a model file, and the files to which it refers, from its folder and below and from paths that the user trusts.
pub fn load_trusting(path: &Path, trusted: &TrustedPaths, options: &LoadOptions) -> Result<Model, LoadError> {
    let fault = |fault| LoadError {
        model: path.display().to_string(),
        fault,
    };
    // A path without a file name, such as `..`, is refused below; the message shows the path.
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    if let Some(sentence) = refused_format(&name) {
        // A missing file is reported as missing, even if its extension is wrong, too.
        let there = path.exists();
        return Err(fault(if there {
            ModelFault::Format(sentence)
        } else {
            ModelFault::NoFile
        }));
    }
    let (bytes, mut beside) = ReferencedFiles::of_model(path, trusted, options).map_err(fault)?;
    let loaded = load_from(&name, &bytes, &mut |uri| beside.read(uri), options);
    let mut model = loaded.map_err(|error| fault(beside.explained(error)))?;
    model.file_bytes = beside.bytes_read();
    model.files = beside.files;
    model.absent = beside.absent;
    model.refused = beside.refused;
    model.trusted = trusted.clone();
    Ok(model)
}

/// Reads a model from bytes. `name` is its file name with extension. `resolve` returns the bytes of a file beside it, or
/// the reason why it cannot be read; it is called for buffers, images and material libraries.
pub fn load_bytes(
    name: &str,
    bytes: &[u8],
    resolve: &mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
    options: &LoadOptions,
) -> Result<Model, LoadError> {
    let mut resolve = |uri: &str| resolve(uri).map(Arc::from);
    load_from(name, bytes, &mut resolve, options).map_err(|fault| LoadError {
        model: name.to_string(),
        fault,
    })
}

fn load_from(
    name: &str,
    bytes: &[u8],
    resolve: &mut gltf::Resolve,
    options: &LoadOptions,
) -> Result<Model, ModelFault> {
    if bytes.is_empty() {
        Err(ModelFault::Damaged("it is empty".into()))
    } else if let Some(degrees) = options.smooth_degrees.filter(|degrees| !is_smoothing_angle(*degrees)) {
        Err(ModelFault::Smooth(degrees))
    } else if options.scale.is_finite() && options.scale > 0.0 {
        let is_smoothed = options.smooth_degrees.is_some();
        // The bytes of a binary STL may start like the signature of another format.
        let text = if stl::has_binary_size(bytes) {
            Cow::Borrowed(bytes)
        } else {
            unmarked(bytes)
        };
        let format = format_of(name, &text);
        let is_wide = matches!(text, Cow::Owned(_));
        let bytes = &text;
        let model = match format {
            Ok(ModelFormat::Gltf) if is_wide => Err(ModelFault::Format(
                "it is text in UTF-16, and glTF is UTF-8; save it as UTF-8 or export it as .glb".into(),
            )),
            Ok(ModelFormat::Gltf) => {
                gltf::read(name, bytes, resolve, options).map(|model| Model { is_gltf: true, ..model })
            }
            Ok(ModelFormat::Obj) => obj::read(name, bytes, resolve, options),
            Ok(ModelFormat::Fbx) => fbx::read(name, bytes, resolve, options),
            Ok(ModelFormat::Dae) => dae::read(name, bytes, resolve, options),
            Ok(ModelFormat::Ply) => ply::read(name, bytes, resolve, options),
            Ok(ModelFormat::Stl) => stl::read(name, bytes, resolve, options),
            Err(fault) => Err(fault),
        };
        look();
        model.map(|mut model| {
            model.mesh.repeating = repeating(&model);
            Model { is_smoothed, ..model }
        })
    } else {
        Err(ModelFault::Scale(options.scale))
    }
}

/// Reads a file to which the glTF `model` at `path` refers by a `uri`, like [`load_trusting`]. Returns its bytes and its
/// path, or the reason why it cannot be read; `None` if the `uri` contains the bytes itself.
pub fn named_file(path: &Path, model: &Model, uri: &str) -> Option<Result<(Vec<u8>, PathBuf), String>> {
    let base = PathBase::of_file(path);
    let read = |uri: &str| {
        let read = model.trusted.read_of_model(&base, uri, MAX_FILE_BYTES);
        read.map_err(reason_beside)
    };
    match Uri::parse(uri) {
        Uri::Data(_) => None,
        Uri::Damaged(reason) | Uri::Unusable(reason) => Some(Err(reason)),
        Uri::Beside(decoded) => Some(find_beside(uri, &decoded, read)),
    }
}

/// Unpacks the packed vertices of the glTF `model` at `path`, whose file has these `bytes`. The error is a sentence.
pub fn unpacked_vertices(path: &Path, model: &Model, bytes: &[u8]) -> Result<UnpackedVertices, String> {
    let base = PathBase::of_file(path);
    let mut resolve = |uri: &str| {
        let read = model.trusted.read_of_model(&base, uri, MAX_FILE_BYTES);
        read.map(|(bytes, _)| bytes.into()).map_err(reason_beside)
    };
    gltf::unpack(bytes, &mut resolve).map_err(|fault| fault.to_string())
}

/// Returns true if an angle is allowed for [`LoadOptions::smooth_degrees`].
pub fn is_smoothing_angle(degrees: f32) -> bool {
    (0.0..=MOST_SMOOTH_DEGREES).contains(&degrees)
}

fn ending(name: &str) -> String {
    name.rsplit_once('.')
        .map_or(String::new(), |(_, ending)| ending.to_ascii_lowercase())
}

/// File name without its ending.
fn stem(name: &str) -> String {
    name.rsplit_once('.')
        .map_or(name, |(stem, _)| if stem.is_empty() { name } else { stem })
        .to_string()
}

/// Returns why a model's file was not read; `None` when it does not exist.
fn reason(unread: Unread) -> Option<String> {
    match unread {
        Unread::Missing => None,
        Unread::Folder | Unread::NotPlain => Some("it is a folder or a device, not a file".into()),
        Unread::TooLarge(_) => Some(format!("it has more than {} GiB", MAX_FILE_BYTES >> 30)),
        Unread::Refused(refusal) => Some(refusal.to_string()),
        Unread::Other(reason) => Some(reason),
    }
}

/// Returns why a file to which a model refers was not read.
fn reason_beside(unread: Unread) -> String {
    reason(unread).unwrap_or_else(|| "there is no such file".to_owned())
}
