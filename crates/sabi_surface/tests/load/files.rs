//! Recognition of model files, the places where files beside a model are found, and the messages for other formats.

use std::path::Path;

use sabi_surface::load::{LoadOptions, load, load_bytes};
use serde_json::json;

use crate::builder::{Gltf, nothing};
use crate::faults::said;

const WEB_PAGE: &str =
    "this is a web page instead of the model itself; download the file, not the page that shows or offers it";

/// Names and first bytes of files that are not read, and what is said.
const OTHERS: &[(&str, &[u8], &str)] = &[
    (
        "a.off",
        b"OFF",
        ".off files are not read here: convert it with Assimp (`assimp export` with its name and that of a new .glb file), or export it from its own program as glTF 2.0 (.glb), FBX, OBJ or Collada (.dae)",
    ),
    (
        "a.max",
        b"\xd0\xcf",
        ".max files are not read here: export it from its own program as glTF 2.0 (.glb), FBX, OBJ or Collada (.dae)",
    ),
    (
        "a.obj",
        b"PXR-USDC",
        "this is a .usdc file under another name: open it in Blender (File > Import) and export it with File > Export > glTF 2.0 (.glb)",
    ),
    (
        "a.glb",
        b"PK\x03\x04",
        "this is a .zip file under another name: unpack it and give the model inside",
    ),
    (
        "a.glb",
        b"version https://git-lfs.github.com/spec/v1\noid",
        "this is a Git LFS pointer instead of the model itself; run `git lfs pull` where it came from",
    ),
    ("a.stl", b"<!DOCTYPE html>\n<html lang=\"en\">", WEB_PAGE),
    ("a.obj", b"\xef\xbb\xbf\n<!doctype HTML PUBLIC>", WEB_PAGE),
    ("a.ply", b"<HTML>", WEB_PAGE),
    ("a.glb", b"<html>", WEB_PAGE),
    ("a.dae", b"<html>", WEB_PAGE),
    (
        "a.usdz",
        b"PK",
        ".usdz files are not read here: open it in Blender (File > Import) and export it with File > Export > glTF 2.0 (.glb)",
    ),
    (
        "a.blend",
        b"BLENDER",
        ".blend files are not read here: open it in Blender and export it with File > Export > glTF 2.0 (.glb)",
    ),
    (
        "a.step",
        b"ISO",
        ".step files are not read here: tessellate it in its CAD program and export it as glTF 2.0 (.glb), FBX, OBJ, STL or PLY",
    ),
    (
        "a.txt",
        b"hello",
        "this is not a model that is read here: give a .glb, .gltf, .vrm, .fbx, .obj, .dae, .ply or .stl file",
    ),
    (
        "a",
        b"hello",
        "this is not a model that is read here: give a .glb, .gltf, .vrm, .fbx, .obj, .dae, .ply or .stl file",
    ),
];

#[test]
fn other_formats_are_refused_with_the_way_to_convert_them() {
    for (name, bytes, sentence) in OTHERS {
        assert_eq!(said(name, bytes), format!("{name}: {sentence}"));
    }
    let unnamed = load_bytes("model", &Gltf::triangle().glb(), &mut nothing, &LoadOptions::default());
    assert_eq!(unnamed.unwrap().stem, "model");
    let renamed = load_bytes("a.obj", &Gltf::triangle().glb(), &mut nothing, &LoadOptions::default());
    assert_eq!(renamed.unwrap().mesh.triangles.len(), 1);
}

#[test]
fn a_missing_file_and_a_folder_are_told_apart_from_bad_data() {
    let folder = tempfile::tempdir().unwrap();
    let error = |path: &Path| load(path, &LoadOptions::default()).unwrap_err();
    let gone = folder.path().join("gone.glb");
    assert_eq!(error(&gone).fault.to_string(), "there is no such file; check the path");
    assert!(error(&gone).is_missing());
    assert!(error(&folder.path().join("gone.usd")).is_missing());
    let inside = folder.path().join("a.glb");
    std::fs::create_dir(&inside).unwrap();
    let said = error(&inside).fault.to_string();
    assert_eq!(said, "the file cannot be read: it is a folder or a device, not a file");
    let bad = folder.path().join("bad.gltf");
    std::fs::write(&bad, "{").unwrap();
    assert!(!error(&bad).is_missing());
    assert!(error(&bad).to_string().starts_with(&bad.display().to_string()));
}

#[test]
fn files_beside_the_model_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let mut file = Gltf::triangle();
    file.json["buffers"][0]["uri"] = json!("data\\leaf%20data.bin");
    std::fs::create_dir(folder.path().join("data")).unwrap();
    std::fs::write(folder.path().join("data/leaf data.bin"), &file.bytes).unwrap();
    let path = folder.path().join("leaf.gltf");
    std::fs::write(&path, file.json.to_string()).unwrap();
    let model = load(&path, &LoadOptions::default()).unwrap();
    assert_eq!((model.stem.as_str(), model.mesh.triangles.len()), ("leaf", 1));
}
