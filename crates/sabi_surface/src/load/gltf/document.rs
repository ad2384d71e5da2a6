//! The container and its JSON. The JSON is parsed object by object, so that an error names the object, and objects that are
//! not used here (animations, cameras, lights) may be invalid.

use gltf::json;
use serde::Deserialize;
use serde_json::{Map, Value};

use super::tidy::gltf_json;
use crate::load::error::{ModelFault, damaged};
use crate::load::warnings::Warnings;

/// Material extensions that describe more than base color, roughness, metallic and emission.
pub(super) const FINISHES: [&str; 5] = [
    "KHR_materials_clearcoat",
    "KHR_materials_anisotropy",
    "KHR_materials_sheen",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_transmission",
];

/// Extension of primitives that are packed.
pub(super) const DRACO: &str = "KHR_draco_mesh_compression";
/// Extensions of packed buffer views. If a view has both, the first is read.
pub(super) const MESHOPT: [&str; 2] = ["KHR_meshopt_compression", "EXT_meshopt_compression"];

/// A scene of a file.
#[derive(Deserialize)]
pub(super) struct GltfScene {
    pub(super) name: Option<String>,
    /// Root nodes.
    #[serde(default)]
    pub(super) nodes: Vec<u64>,
}

/// A node of a file. Its numbers have 64 bits, since it may place a mesh far away.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct GltfNode {
    pub(super) name: Option<String>,
    pub(super) mesh: Option<usize>,
    pub(super) skin: Option<usize>,
    #[serde(default)]
    pub(super) children: Vec<u64>,
    pub(super) matrix: Option<[f64; 16]>,
    pub(super) translation: Option<[f64; 3]>,
    /// Quaternion, x y z w.
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
    #[serde(default)]
    pub(super) extensions: Map<String, Value>,
}

/// The lists of a glTF file that are used here.
#[derive(Default)]
pub(super) struct GltfDocument {
    pub(super) accessors: Vec<json::Accessor>,
    pub(super) buffers: Vec<json::Buffer>,
    pub(super) views: Vec<json::buffer::View>,
    pub(super) images: Vec<json::Image>,
    pub(super) materials: Vec<json::Material>,
    pub(super) meshes: Vec<json::Mesh>,
    pub(super) nodes: Vec<GltfNode>,
    /// Skins, not parsed yet, since an invalid skin is no reason to refuse the mesh.
    pub(super) skins: Vec<Value>,
    pub(super) samplers: Vec<json::texture::Sampler>,
    pub(super) textures: Vec<json::Texture>,
    pub(super) scenes: Vec<GltfScene>,
    pub(super) default_scene: Option<u64>,
    used: Vec<String>,
    required: Vec<String>,
}

impl GltfDocument {
    /// Splits a GLB container, if the file is one, and parses the JSON. Also returns the binary chunk.
    pub(super) fn parse<'a>(
        bytes: &'a [u8],
        memory_bytes: u64,
        warnings: &mut Warnings,
    ) -> Result<(GltfDocument, Option<&'a [u8]>), ModelFault> {
        let (text, binary) = if bytes.starts_with(b"glTF") {
            chunks(bytes, warnings)?
        } else {
            (bytes, None)
        };
        check_json(text, memory_bytes)?;
        let root = gltf_json(text).map_err(|error| ModelFault::Damaged(json_fault(text, &error)))?;
        let Value::Object(mut root) = root else {
            return damaged("its JSON is not an object");
        };
        let version = |key: &str| match root.get("asset").and_then(|asset| asset.get(key)) {
            // Some programs write the version as a number.
            Some(Value::Number(number)) => Some(number.to_string()),
            version => version.and_then(Value::as_str).map(str::to_owned),
        };
        // It comes first, and says which version a reader has to know (glTF 2.0, 3.2).
        if let Some(needed) = version("minVersion").filter(|needed| is_newer(needed)) {
            return Err(ModelFault::Format(format!(
                "this needs a reader of glTF {needed}, and glTF 2.0 is read here; export it as glTF 2.0"
            )));
        }
        match version("version")
            .as_deref()
            .map(|version| version.split_once('.').map_or(version, |(major, _)| major))
        {
            Some("2") => {}
            Some("") => return damaged("its asset does not say which version of glTF it is"),
            Some("1" | "0") => return Err(old_version()),
            Some(other) => {
                return Err(ModelFault::Format(format!(
                    "this is glTF {other}, and glTF 2 is read here"
                )));
            }
            None => return damaged("its asset does not say which version of glTF it is"),
        }
        let root = &mut root;
        let document = GltfDocument {
            accessors: list(root, "accessors", serde_json::from_value)?,
            buffers: list(root, "buffers", serde_json::from_value)?,
            views: list(root, "bufferViews", serde_json::from_value)?,
            images: list(root, "images", serde_json::from_value)?,
            materials: list(root, "materials", serde_json::from_value)?,
            meshes: list(root, "meshes", serde_json::from_value)?,
            nodes: list(root, "nodes", serde_json::from_value)?,
            skins: list(root, "skins", Ok)?,
            samplers: list(root, "samplers", serde_json::from_value)?,
            textures: list(root, "textures", serde_json::from_value)?,
            scenes: list(root, "scenes", serde_json::from_value)?,
            default_scene: match root.get("scene") {
                None => None,
                Some(scene) => match scene.as_u64() {
                    None => return damaged(format!("its scene is {scene}, which is not the number of one")),
                    index => index,
                },
            },
            used: list(root, "extensionsUsed", serde_json::from_value)?,
            required: list(root, "extensionsRequired", serde_json::from_value)?,
        };
        Ok((document, binary))
    }

    /// Refuses files that require an unsupported extension.
    pub(super) fn check_extensions(&self, warnings: &mut Warnings) -> Result<(), ModelFault> {
        for name in &self.required {
            match name.as_str() {
                "KHR_mesh_quantization" | "KHR_texture_transform" | "KHR_materials_emissive_strength" => {}
                name if FINISHES.contains(&name) => {}
                "EXT_texture_webp" | "KHR_texture_basisu" => {}
                name if name == DRACO || MESHOPT.contains(&name) => {}
                "KHR_node_visibility" => {}
                // These add something to a scene but do not change its surfaces.
                "KHR_lights_punctual" | "KHR_animation_pointer" | "KHR_xmp_json_ld" => {}
                "MSFT_texture_dds" | "EXT_texture_avif" => {
                    warnings.add(format!("The file needs {name}: pictures stored that way are left out."));
                }
                _ if name.starts_with("KHR_materials_") => {
                    warnings.add(format!("The file needs {name}, which is left out of its materials."));
                }
                _ => {
                    return Err(ModelFault::Extension {
                        extension: name.clone(),
                    });
                }
            }
        }
        for name in &self.used {
            if name == "EXT_mesh_gpu_instancing" {
                warnings.add("Copies made by EXT_mesh_gpu_instancing are left out.");
            }
        }
        Ok(())
    }

    /// Returns true if the file lists an extension as required for reading it.
    pub(super) fn requires(&self, extension: &str) -> bool {
        self.required.iter().any(|name| name == extension)
    }

    /// Returns the label of a material in messages.
    pub(super) fn material_label(&self, material: Option<usize>) -> String {
        match material {
            None => "the unnamed material".to_string(),
            Some(index) => match self.materials.get(index).and_then(|material| material.name.as_deref()) {
                Some(name) if !name.is_empty() => format!("material `{name}`"),
                _ => format!("material {index}"),
            },
        }
    }

    /// Returns the label of a scene in messages.
    pub(super) fn scene_label(&self, scene: usize) -> String {
        match self.scenes.get(scene).and_then(|scene| scene.name.as_deref()) {
            Some(name) if !name.is_empty() => format!("{scene} (`{name}`)"),
            _ => scene.to_string(),
        }
    }

    /// Returns the label of a node in messages.
    pub(super) fn node_label(&self, node: usize) -> String {
        match self.nodes.get(node).and_then(|node| node.name.as_deref()) {
            Some(name) if !name.is_empty() => format!("node `{name}`"),
            _ => format!("node {node}"),
        }
    }

    /// Returns the label of a mesh in messages.
    pub(super) fn mesh_label(&self, mesh: usize) -> String {
        match self.meshes.get(mesh).and_then(|mesh| mesh.name.as_deref()) {
            Some(name) if !name.is_empty() => format!("mesh `{name}`"),
            _ => format!("mesh {mesh}"),
        }
    }
}

/// Returns true for a version after glTF 2.0. What is no version says nothing.
fn is_newer(version: &str) -> bool {
    let (major, minor) = version.split_once('.').unwrap_or((version, "0"));
    let numbers = [major, minor].map(str::parse::<u32>);
    matches!(numbers, [Ok(major), Ok(minor)] if [major, minor] > [2, 0])
}

fn old_version() -> ModelFault {
    ModelFault::Format(
        "this is glTF 1, and glTF 2 is read here; convert it (gltf-pipeline does so) or export it anew".into(),
    )
}

/// Parses one list of the file, object by object.
fn list<T>(
    root: &mut serde_json::Map<String, Value>,
    key: &str,
    read: impl Fn(Value) -> serde_json::Result<T>,
) -> Result<Vec<T>, ModelFault> {
    match root.get_mut(key).map(Value::take) {
        None => Ok(Vec::new()),
        Some(Value::Array(values)) => values
            .into_iter()
            .enumerate()
            .map(|(index, value)| {
                read(value).map_err(|error| ModelFault::Damaged(format!("{key}[{index}] cannot be read ({error})")))
            })
            .collect(),
        Some(_) => damaged(format!("{key} is not a list")),
    }
}

/// Memory of a JSON object once it is read: its keys and values, and what is made of it, of which a material is the largest.
const OBJECT_BYTES: u64 = 1400;
/// Memory of any other value, in a list that grows.
const VALUE_BYTES: u64 = 64;

/// Checks that JSON takes no more than `memory_bytes` once it is read, by its brackets and commas: a few bytes of a file can claim
/// hundreds in memory. Those in texts count as well, which are few.
fn check_json(text: &[u8], memory_bytes: u64) -> Result<(), ModelFault> {
    let needed = text.iter().fold(0u64, |sum, byte| match byte {
        b'{' => sum + OBJECT_BYTES,
        b',' | b'[' => sum + VALUE_BYTES,
        _ => sum,
    });
    match needed > memory_bytes {
        true => Err(ModelFault::memory(needed, memory_bytes)),
        false => Ok(()),
    }
}

/// The JSON and binary chunks of a GLB container.
fn chunks<'a>(bytes: &'a [u8], warnings: &mut Warnings) -> Result<(&'a [u8], Option<&'a [u8]>), ModelFault> {
    let word = |at: usize| {
        bytes
            .get(at..at + 4)
            .and_then(|word| word.try_into().ok())
            .map(u32::from_le_bytes)
    };
    let (Some(version), Some(length)) = (word(4), word(8)) else {
        return damaged("its GLB header is cut off");
    };
    match version {
        2 => {}
        1 => return Err(old_version()),
        _ => {
            return Err(ModelFault::Format(format!(
                "this is version {version} of GLB, and version 2 is read here"
            )));
        }
    }
    let length = length as usize;
    if length > bytes.len() {
        return damaged(format!(
            "its header promises {length} bytes and there are {}; it was cut off",
            bytes.len()
        ));
    }
    let word = |at: usize| word(at).filter(|_| at + 4 <= length);
    let mut at = 12;
    let (mut text, mut binary) = (None, None);
    while at < length {
        let (Some(size), Some(kind)) = (word(at), word(at + 4)) else {
            return damaged("a chunk header is cut off");
        };
        let Some(chunk) = bytes[..length].get(at + 8..).and_then(|rest| rest.get(..size as usize)) else {
            return damaged(format!(
                "a chunk promises {size} bytes and reaches over the end of the file"
            ));
        };
        match &kind.to_le_bytes() {
            b"JSON" if text.is_none() => text = Some(chunk),
            b"BIN\0" if text.is_some() && binary.is_none() => binary = Some(chunk),
            _ if text.is_none() => return damaged("its first chunk is not JSON"),
            b"JSON" | b"BIN\0" => warnings.add("The file has more than one chunk of a kind; the first one is read."),
            // Other chunks belong to extensions (glTF 2.0, 4.4.3).
            _ => {}
        }
        at += 8 + size as usize;
    }
    match text {
        Some(text) => Ok((text, binary)),
        None => damaged("it has no JSON chunk"),
    }
}

/// Returns the sentence for JSON that cannot be parsed. Some programs write numbers into it that JSON does not have.
fn json_fault(text: &[u8], error: &serde_json::Error) -> String {
    const NO_NUMBERS: [&str; 6] = ["NaN", "nan", "Infinity", "-Infinity", "inf", "-inf"];
    let line = text.split(|byte| *byte == b'\n').nth(error.line().saturating_sub(1));
    let from = error.column().saturating_sub(2);
    let near = line.and_then(|line| line.get(from..)).map(String::from_utf8_lossy);
    let starts = |near: &str, at: usize| {
        let rest = near.get(at..)?;
        NO_NUMBERS.into_iter().find(|word| rest.starts_with(word))
    };
    match near.and_then(|near| starts(&near, 0).or_else(|| starts(&near, 1))) {
        Some(word) => {
            let place = format!("line {} column {}", error.line(), error.column());
            format!(
                "its JSON has `{word}` for a number at {place}, which JSON does not know; put a number there, or export it anew"
            )
        }
        None => format!("its JSON cannot be read ({error})"),
    }
}
