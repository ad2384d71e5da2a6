//! Files to which a model refers: each is read once, endless ones are refused, and all must fit into the memory limit.

use std::cell::Cell;
use std::fs;
use std::path::{Path, PathBuf};

use sabi_files::TrustedPaths;
use sabi_surface::load::{LoadError, LoadOptions, load, load_bytes, load_trusting};
use sabi_surface::model::Model;
use serde_json::json;

use crate::builder::Gltf;

/// A triangle whose positions and coordinates are in these buffers, each read by a view of its own.
fn spelled(spellings: &[String]) -> (String, Vec<u8>) {
    let mut file = Gltf::triangle();
    let length = file.bytes.len();
    let buffer = |uri: &String| json!({ "byteLength": length, "uri": uri });
    file.json["buffers"] = spellings.iter().map(buffer).collect();
    for buffer in 1..spellings.len() {
        let view = file.push("bufferViews", json!({ "buffer": buffer, "byteLength": 36 }));
        let positions = file.push(
            "accessors",
            json!({ "bufferView": view, "componentType": 5126, "type": "VEC3", "count": 3 }),
        );
        file.place(
            &format!("leaf {buffer}"),
            json!({ "attributes": { "POSITION": positions } }),
        );
    }
    (file.json.to_string(), file.bytes)
}

fn written(folder: &Path, text: &str) -> PathBuf {
    let path = folder.join("leaf.gltf");
    fs::write(&path, text).unwrap();
    path
}

#[test]
fn a_buffer_under_many_spellings_is_read_once() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("sub")).unwrap();
    let spellings: Vec<String> = (0..20)
        .map(|count| format!("{}sub/../data.bin", "./".repeat(count)))
        .collect();
    let (text, bytes) = spelled(&spellings);
    fs::write(folder.path().join("data.bin"), &bytes).unwrap();
    let model = load(&written(folder.path(), &text), &LoadOptions::default()).unwrap();
    assert_eq!(model.mesh.triangles.len(), 20);
    assert_eq!(model.files.len(), 2, "{:?}", model.files);
    assert_eq!(model.file_bytes, (text.len() + bytes.len()) as u64);
}

#[test]
fn a_buffer_that_nothing_reads_is_not_opened() {
    let (text, bytes) = spelled(&["data.bin".to_owned()]);
    let mut file: serde_json::Value = serde_json::from_str(&text).unwrap();
    file["buffers"]
        .as_array_mut()
        .unwrap()
        .push(json!({ "byteLength": 9, "uri": "other.bin" }));
    let mut asked = Vec::new();
    let mut beside = |uri: &str| {
        asked.push(uri.to_owned());
        Ok(bytes.clone())
    };
    load_bytes(
        "leaf.gltf",
        file.to_string().as_bytes(),
        &mut beside,
        &LoadOptions::default(),
    )
    .unwrap();
    assert_eq!(asked, ["data.bin"]);
}

#[test]
fn what_does_not_fit_into_memory_is_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let (text, mut bytes) = spelled(&["data.bin".to_owned()]);
    bytes.resize(3 << 20, 0);
    fs::write(folder.path().join("data.bin"), &bytes).unwrap();
    let path = written(folder.path(), &text);
    let with = |memory_bytes: u64| -> Result<Model, LoadError> {
        let options = LoadOptions {
            memory_bytes,
            ..LoadOptions::default()
        };
        load(&path, &options)
    };
    let all = (text.len() + bytes.len()) as u64;
    assert!(with(all).is_ok());
    // The JSON of the file alone takes more in memory than its bytes.
    for (memory, needed, limit) in [(all - 1, 4, 3), (text.len() as u64, 1, 0), (1, 1, 0)] {
        let said = with(memory).unwrap_err().fault.to_string();
        let expected =
            format!("it takes {needed} MiB of memory, and {limit} MiB are for a model; nothing of it was read");
        assert_eq!(said, expected, "{memory}");
    }
    // An image that does not fit is left out, and the model is loaded without it.
    let mut file = Gltf::triangle();
    file.json["images"] = json!([{ "uri": "wood.png" }]);
    file.json["textures"] = json!([{ "source": 0 }]);
    file.json["materials"] = json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    file.primitive()["material"] = json!(0);
    fs::write(folder.path().join("wood.png"), &bytes).unwrap();
    let glb = folder.path().join("leaf.glb");
    fs::write(&glb, file.glb()).unwrap();
    let options = LoadOptions {
        memory_bytes: 2 << 20,
        ..LoadOptions::default()
    };
    let warnings = load(&glb, &options).unwrap().warnings;
    let expected =
        "The picture wood.png cannot be read: it has 3 MiB, and 1 of the 2 MiB of memory for a model are left.";
    assert!(warnings.iter().any(|warning| warning == expected), "{warnings:?}");
}

#[test]
fn a_mesh_that_does_not_fit_into_memory_is_refused_by_its_claim() {
    let mut file = Gltf::triangle();
    // Each triangle three times the same vertex, without any bytes for the indices.
    let indices = file.push(
        "accessors",
        json!({ "componentType": 5125, "type": "SCALAR", "count": 30_000_000 }),
    );
    file.primitive()["indices"] = json!(indices);
    let options = LoadOptions {
        memory_bytes: 64 << 20,
        ..LoadOptions::default()
    };
    let said = file.load_with(&options).unwrap_err().fault.to_string();
    // Two meshes of 44 bytes a triangle, as the file has it and placed, and 40 bytes of the atlas.
    assert_eq!(
        said,
        "it takes 1221 MiB of memory, and 64 MiB are for a model; nothing of it was read"
    );
}

#[cfg(unix)]
#[test]
fn a_file_without_end_is_no_buffer() {
    let folder = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink("/dev/zero", folder.path().join("zero.bin")).unwrap();
    let pipe = folder.path().join("pipe.bin");
    assert!(
        std::process::Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    let trusted = TrustedPaths::default().with_path(Path::new("/"));
    for (uri, words) in [
        ("/dev/zero", "/dev/zero is a device or a pipe, which files never open"),
        ("zero.bin", "/dev/zero is a device or a pipe, which files never open"),
        ("pipe.bin", "pipe.bin is a device or a pipe, which files never open"),
    ] {
        let (text, _) = spelled(&[uri.to_owned()]);
        let path = written(folder.path(), &text);
        let error = load_trusting(&path, &trusted, &LoadOptions::default()).unwrap_err();
        assert!(error.fault.to_string().contains(words), "{uri}: {error}");
    }
}

#[test]
fn a_material_library_that_is_named_again_and_again_is_read_once() {
    let text = format!(
        "{}mtllib one.mtl two.mtl one.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl wood\nf 1 2 3\n",
        "mtllib one.mtl\n".repeat(1000)
    );
    let asked = Cell::new(0);
    let mut beside = |name: &str| {
        asked.set(asked.get() + 1);
        match name.contains(' ') {
            true => Err("there is no such file".to_owned()),
            false => Ok(b"newmtl wood\nKd 1 0 0\n".to_vec()),
        }
    };
    let read = |text: &str, beside: &mut dyn FnMut(&str) -> Result<Vec<u8>, String>| {
        load_bytes("thing.obj", text.as_bytes(), beside, &LoadOptions::default()).unwrap()
    };
    assert_eq!(read(&text, &mut beside).materials[0].base_color_factor[0], 1.0);
    assert_eq!(asked.get(), 3, "one, the line as a name, two");
    let many: String = (0..5000).map(|number| format!(" {number}.mtl")).collect();
    asked.set(0);
    let model = read(&format!("mtllib{many}\n{text}"), &mut beside);
    assert_eq!(asked.get(), 1000);
    let told = "The file names more than 1000 material libraries; the others are left out.";
    assert!(
        model.warnings.iter().any(|warning| warning == told),
        "{:?}",
        model.warnings
    );
}

#[test]
fn skins_that_claim_too_many_matrices_are_not_read() {
    let mut file = Gltf::triangle();
    let matrices = file.push(
        "accessors",
        json!({ "componentType": 5126, "type": "MAT4", "count": 5_000_000 }),
    );
    file.json["skins"] = json!([{ "joints": [0], "inverseBindMatrices": matrices }]);
    let mesh = file.json["nodes"][0]["mesh"].clone();
    for name in ["second", "third"] {
        file.push("nodes", json!({ "name": name, "mesh": mesh, "skin": 0 }));
    }
    let warnings = file.load().unwrap().warnings;
    let told = "The skin of `second` cannot be read (the skins of the file have too many joints together); the mesh is taken as it \
                is stored.";
    assert!(warnings.iter().any(|warning| warning == told), "{warnings:?}");
}

#[test]
fn files_are_found_in_another_case_of_letters() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("Data")).unwrap();
    let (text, bytes) = spelled(&["DATA\\leaf.BIN".to_owned()]);
    fs::write(folder.path().join("Data/Leaf.bin"), &bytes).unwrap();
    let model = load(&written(folder.path(), &text), &LoadOptions::default()).unwrap();
    assert_eq!(model.mesh.triangles.len(), 1);
    // An address of another computer leads to its last part beside the model.
    let (text, bytes) = spelled(&["file:///D:/models/my%20leaf.bin".to_owned()]);
    fs::write(folder.path().join("my leaf.bin"), &bytes).unwrap();
    let model = load(&written(folder.path(), &text), &LoadOptions::default()).unwrap();
    assert_eq!(model.mesh.triangles.len(), 1);
}

#[test]
fn a_file_is_found_whether_its_accents_are_letters_or_marks_and_without_the_query_of_its_address() {
    for (named, there) in [
        ("t\u{f4}le.bin", "to\u{302}le.bin"),
        ("To\u{302}le.bin", "t\u{f4}le.bin"),
        ("leaf.bin?v=2", "leaf.bin"),
        ("my%20leaf.bin?v=2#top", "my leaf.bin"),
        ("c#.bin", "c#.bin"),
        ("100%.bin", "100%.bin"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let (text, bytes) = spelled(&[named.to_owned()]);
        fs::write(folder.path().join(there), &bytes).unwrap();
        let model = load(&written(folder.path(), &text), &LoadOptions::default());
        assert_eq!(model.unwrap().mesh.triangles.len(), 1, "{named}");
    }
}
