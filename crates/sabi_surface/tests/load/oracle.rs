//! Khronos's own verdicts on odd files, where they are at hand: what its validator calls an error is refused or said.

use std::path::{Path, PathBuf};

use sabi_surface::load::{LoadOptions, load_bytes};
use sabi_surface::model::Model;
use serde_json::{Value, json};

use crate::builder::floats;
use crate::promises;
use crate::shared_data::{data, files_under};

/// Errors of the validator that leave nothing out here: code, a piece of the pointer, and why nothing has to be said.
const UNREAD: &[(&str, &str, &str)] = &[
    ("", "/animations/", "animations are not read"),
    ("", "/cameras/", "cameras are not read"),
    ("", "/camera", "cameras are not read"),
    (
        "",
        "/accessors/0/sparse/",
        "no vertex has numbers of that kind; our own files hold sparse ones to the rules",
    ),
    ("NODE_LOOP", "", "a loop that no root leads to is not reached"),
    ("IO_ERROR", "/buffers/", "a buffer that nothing reads is not missed"),
    ("INVALID_URI", "/buffers/", "a buffer that nothing reads is not missed"),
    (
        "VALUE_NOT_IN_RANGE",
        "/byteLength",
        "what is empty holds nothing, and nothing reads it",
    ),
    (
        "UNSATISFIED_DEPENDENCY",
        "/byteOffset",
        "an offset into nothing changes nothing",
    ),
    (
        "UNSATISFIED_DEPENDENCY",
        "/images/",
        "the kind of a picture is told from its content",
    ),
    ("UNSATISFIED_DEPENDENCY", "/weights", "morph weights are not read"),
    ("UNSATISFIED_DEPENDENCY", "/skin", "a skin of nothing bends nothing"),
    ("UNRESOLVED_REFERENCE", "/skin", "a skin of nothing bends nothing"),
    (
        "IMAGE_DATA_INVALID",
        "",
        "pictures are decoded later, by sabi_image, which says it then",
    ),
    (
        "BUFFER_VIEW_TOO_BIG_BYTE_STRIDE",
        "",
        "every element is held against the view's length",
    ),
    (
        "MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE",
        "",
        "elements without a stride are side by side",
    ),
    (
        "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT",
        "/_",
        "attributes of a program's own are not read",
    ),
    (
        "MESH_PRIMITIVE_INVALID_ATTRIBUTE",
        "",
        "attributes that are not known are not read",
    ),
    (
        "MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH",
        "",
        "joints and weights are not read",
    ),
    ("SKIN_NO_COMMON_ROOT", "", "where the joints are is all that counts"),
    (
        "ACCESSOR_INVALID_IBM",
        "",
        "the last row of an inverse bind matrix is not read",
    ),
    ("", "KHR_lights_punctual", "lights are not read"),
    (
        "",
        "KHR_materials_variants",
        "the material that a primitive has without variants is taken",
    ),
    (
        "",
        "KHR_materials_anisotropy",
        "not among the channels of a material here",
    ),
    (
        "",
        "KHR_materials_dispersion",
        "not among the channels of a material here",
    ),
    ("", "KHR_materials_ior", "not among the channels of a material here"),
    (
        "",
        "KHR_materials_specular",
        "not among the channels of a material here",
    ),
    ("", "KHR_materials_volume", "not among the channels of a material here"),
    (
        "UNEXPECTED_EXTENSION_OBJECT",
        "",
        "an extension where it has no meaning changes nothing",
    ),
    (
        "ACCESSOR_MIN_MISMATCH",
        "",
        "bounds are measured, the file's are not read",
    ),
    (
        "ACCESSOR_MAX_MISMATCH",
        "",
        "bounds are measured, the file's are not read",
    ),
    (
        "ACCESSOR_ELEMENT_OUT_OF_",
        "",
        "bounds are measured, the file's are not read",
    ),
    (
        "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS",
        "",
        "bounds are measured, the file's are not read",
    ),
    (
        "ACCESSOR_NORMALIZED_INVALID",
        "",
        "a float is what it is, marked or not",
    ),
    ("EMPTY_ENTITY", "", "an empty list is a list without members"),
    ("NODE_MATRIX_NON_TRS", "", "a sheared placement is applied as it is"),
    ("DUPLICATE_ELEMENTS", "/extensions", "an extension named twice is named"),
    (
        "TYPE_MISMATCH",
        "/extensions/",
        "extensions of the whole file are not read",
    ),
];

/// Parts of the messages for files that are valid according to Khronos's validator and refused all the same.
const REFUSED: &[&str] = &["it has no triangles", "names no file and is not the binary chunk"];

/// Every input that has a verdict, and the verdict.
fn judged(folder: &Path) -> Vec<(PathBuf, Value)> {
    let mut files = Vec::new();
    files_under(folder, &mut files);
    let input = |file: &PathBuf| Some(PathBuf::from(file.to_str()?.strip_suffix(".report.json")?));
    let verdict = |file: &PathBuf| serde_json::from_slice(&std::fs::read(file).unwrap()).unwrap();
    files
        .iter()
        .filter_map(|file| Some((input(file)?, verdict(file))))
        .collect()
}

/// The file with a triangle of our own, and with all that is in it put to use: every mesh in a node, every skin, every
/// picture in a texture, every texture in a material, every material and every row of three floats on a primitive. So no
/// fault hides because nothing reaches it. Files whose JSON is no glTF to begin with stay as they are.
fn put_to_use(file: Vec<u8>) -> Vec<u8> {
    let Ok(mut root) = serde_json::from_slice::<Value>(&file) else {
        return file;
    };
    let [meshes, skins, images] = ["meshes", "skins", "images"].map(|list| count(&root, list));
    let Some(nodes) = add_users(&mut root, [meshes, skins, images]) else {
        return file;
    };
    for scene in root
        .get_mut("scenes")
        .and_then(Value::as_array_mut)
        .into_iter()
        .flatten()
    {
        let Some(scene) = scene.as_object_mut() else { continue };
        if let Some(shown) = scene.entry("nodes").or_insert(json!([])).as_array_mut() {
            shown.extend(nodes.iter().map(|node| json!(node)));
        }
    }
    root.to_string().into_bytes()
}

fn count(root: &Value, list: &str) -> usize {
    root.get(list).and_then(Value::as_array).map_or(0, Vec::len)
}

/// Adds what uses the file's own meshes, skins and pictures; gives the new nodes.
fn add_users(root: &mut Value, [meshes, skins, images]: [usize; 3]) -> Option<Vec<usize>> {
    let accessors = root
        .get("accessors")
        .and_then(Value::as_array)
        .cloned()
        .unwrap_or_default();
    let bytes = floats(&[
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0,
    ]);
    let hexadecimal: String = bytes.iter().map(|byte| format!("%{byte:02x}")).collect();
    let buffer = json!({ "byteLength": 60, "uri": format!("data:application/octet-stream,{hexadecimal}") });
    let buffer = push(root, "buffers", buffer)?;
    // Views that the file names and does not have must not be found in ours.
    for _ in 0..4 {
        push(root, "bufferViews", json!({ "buffer": 9999, "byteLength": 1 }))?;
    }
    let view = push(root, "bufferViews", json!({ "buffer": buffer, "byteLength": 60 }))?;
    let accessor = |offset: usize, shape: &str| json!({ "bufferView": view, "byteOffset": offset, "componentType": 5126, "type": shape, "count": 3 });
    let position = push(root, "accessors", accessor(0, "VEC3"))?;
    let uv = push(root, "accessors", accessor(36, "VEC2"))?;
    for image in 0..images {
        push(root, "textures", json!({ "source": image }))?;
    }
    for texture in 0..count(root, "textures") {
        push(root, "materials", json!({ "emissiveTexture": { "index": texture } }))?;
    }
    let mut primitives = vec![json!({ "attributes": { "POSITION": position, "TEXCOORD_0": uv } })];
    for material in 0..count(root, "materials") {
        let mut primitive = primitives[0].clone();
        primitive["material"] = json!(material);
        primitives.push(primitive);
    }
    for (index, accessor) in accessors.iter().enumerate() {
        if accessor["type"] == "VEC3" && accessor["componentType"] == 5126 {
            primitives.push(json!({ "attributes": { "POSITION": index } }));
        }
    }
    let mesh = push(root, "meshes", json!({ "primitives": primitives }))?;
    let mut nodes = vec![json!({ "mesh": mesh })];
    nodes.extend((0..meshes).map(|mesh| json!({ "mesh": mesh })));
    nodes.extend((0..skins).map(|skin| json!({ "mesh": mesh, "skin": skin })));
    nodes
        .into_iter()
        .map(|node| push(root, "nodes", node))
        .collect::<Option<Vec<usize>>>()
}

/// Adds a member to a list and gives its index; `None` where the file has no list there.
fn push(root: &mut Value, list: &str, member: Value) -> Option<usize> {
    let list = root.as_object_mut()?.entry(list).or_insert(json!([])).as_array_mut()?;
    list.push(member);
    Some(list.len() - 1)
}

fn read(input: &Path) -> Result<Model, String> {
    let bytes = put_to_use(std::fs::read(input).unwrap());
    let folder = input.parent().unwrap();
    let mut beside = |uri: &str| std::fs::read(folder.join(uri)).map_err(|_| "there is no such file".to_string());
    let name = input.file_name().unwrap().to_string_lossy();
    let loaded = load_bytes(&name, &bytes, &mut beside, &LoadOptions::default());
    loaded.map_err(|error| error.fault.to_string())
}

/// The validator's errors on a file: code and place.
fn errors(verdict: &Value) -> impl Iterator<Item = (&str, &str)> {
    let messages = verdict["issues"]["messages"].as_array().into_iter().flatten();
    messages.filter(|message| message["severity"] == 0).map(|message| {
        (
            message["code"].as_str().unwrap_or(""),
            message["pointer"].as_str().unwrap_or(""),
        )
    })
}

#[test]
#[ignore = "reads files that SABI_TEST_DATA names"]
fn what_khronos_calls_an_error_is_refused_or_said() {
    let folder = data().join("hostile/gltf-validator");
    let inputs = judged(&folder);
    let mut silent = Vec::new();
    for (input, verdict) in &inputs {
        let name = input.strip_prefix(&folder).unwrap().display();
        let model = match read(input) {
            Ok(model) => model,
            Err(sentence) => {
                println!("{name}: refused, {sentence}");
                let is_fair = errors(verdict).next().is_some();
                if !is_fair && !REFUSED.iter().any(|known| sentence.contains(known)) {
                    silent.push(format!(
                        "{name} is refused and Khronos has nothing against it: {sentence}"
                    ));
                }
                continue;
            }
        };
        promises::check(&model);
        println!("{name}: {:?}", model.warnings);
        if !model.warnings.is_empty() {
            continue;
        }
        for (code, place) in errors(verdict) {
            let is_unread = UNREAD
                .iter()
                .any(|(known, part, _)| code.starts_with(known) && place.contains(part));
            if !is_unread {
                silent.push(format!("{name}: {code} at {place} passes without a word"));
            }
        }
    }
    assert!(inputs.len() > 100, "the verdicts are gone");
    assert!(silent.is_empty(), "\n{}", silent.join("\n"));
}
