//! Files outside of the folder and project of what names them: they are neither read nor sent on, unless they are trusted.

use std::fs;

use serde_json::json;

use crate::cli_folder::{CliFolder, RunOutput};

/// A folder with `private/secret.txt`, and `shared/` for what came from elsewhere.
fn with_secret() -> CliFolder {
    let place = CliFolder::new();
    for folder in ["private", "shared"] {
        fs::create_dir(place.path(folder)).unwrap();
    }
    // 60 bytes: as positions and coordinates of a triangle.
    let numbers = [
        0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0,
    ];
    place.write("private/secret.txt", numbers.map(f32::to_le_bytes).concat());
    place
}

/// A triangle whose vertex data, and picture, are in these files.
fn model(buffer: &str, picture: &str) -> String {
    let view = |offset: u32, length: u32| json!({ "buffer": 0, "byteOffset": offset, "byteLength": length });
    let accessor = |view: u32, ty: &str| json!({ "bufferView": view, "componentType": 5126, "count": 3, "type": ty });
    json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0] }], "scene": 0, "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "material": 0 }] }],
        "materials": [{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
        "textures": [{ "source": 0 }], "images": [{ "uri": picture }],
        "buffers": [{ "byteLength": 60, "uri": buffer }],
        "bufferViews": [view(0, 36), view(36, 24)],
        "accessors": [accessor(0, "VEC3"), accessor(1, "VEC2")],
    })
    .to_string()
}

/// A graph that shows a picture.
fn shows(picture: &str) -> String {
    let nodes = json!({
        "photo": { "kind": "source/image", "params": { "file": picture } },
        "out": { "kind": "output/mask", "inputs": { "source": "photo.mask" } },
    });
    json!({ "format": "sabi", "version": 1, "nodes": nodes }).to_string()
}

/// The canonical path of a file, as sentences show it.
fn shown(place: &CliFolder, name: &str) -> String {
    place.path(name).canonicalize().unwrap().display().to_string()
}

fn outside(place: &CliFolder, name: &str) -> String {
    format!(
        "{} is outside of the folder of the file that names it and of the folders that you trust",
        shown(place, name)
    )
}

#[track_caller]
fn says(done: &RunOutput, words: &str) {
    assert!(done.stderr.contains(words), "{words}\n{}", done.stderr);
}

#[test]
fn vertex_data_of_a_model_is_not_read_from_elsewhere() {
    let place = with_secret();
    place.write("shared/model.gltf", model("../private/secret.txt", "none.png"));
    let done = place
        .sabi(&["mesh", "shared/model.gltf", "--size", "64", "--no-cache"])
        .fails(66);
    assert_eq!(
        done.stderr.trim_end(),
        format!(
            "error: shared/model.gltf: its vertex data is in `../private/secret.txt`, which is not read: {}; trust it or its folder with \
             --trust",
            outside(&place, "private/secret.txt")
        )
    );
    for trusted in ["private", "private/secret.txt", "."] {
        let mesh = [
            "mesh",
            "shared/model.gltf",
            "--size",
            "64",
            "--no-cache",
            "--trust",
            trusted,
        ];
        place.sabi(&mesh).good();
    }
    let gone = place
        .sabi(&["mesh", "shared/model.gltf", "--trust", "nowhere"])
        .fails(2);
    says(&gone, "--trust: there is no file or folder nowhere; check the path");
    place.write("sabi.toml", "");
    place
        .sabi(&["mesh", "shared/model.gltf", "--size", "64", "--no-cache"])
        .good();
}

#[test]
fn a_model_is_read_without_pictures_from_elsewhere() {
    let place = with_secret();
    fs::copy(place.path("private/secret.txt"), place.path("shared/model.bin")).unwrap();
    place.write("shared/model.gltf", model("model.bin", "../private/secret.txt"));
    let done = place
        .sabi(&["mesh", "shared/model.gltf", "--size", "64", "--no-cache"])
        .good();
    says(
        &done,
        &format!(
            "the model was read without a file that it names: {}; trust it or its folder with --trust",
            outside(&place, "private/secret.txt")
        ),
    );
    for address in ["//host/share/a.png", r"\\host\share\a.png"] {
        place.write("shared/model.gltf", model("model.bin", address));
        let mesh = [
            "mesh",
            "shared/model.gltf",
            "--size",
            "64",
            "--no-cache",
            "--trust",
            "/",
        ];
        says(
            &place.sabi(&mesh).good(),
            &format!("{address} is on another computer, and files never open such paths"),
        );
    }
}

#[test]
fn a_material_library_is_not_read_from_elsewhere() {
    let place = with_secret();
    place.write("private/secret.mtl", "newmtl secret\nKd 1 0 0\n");
    place.write(
        "shared/model.obj",
        "mtllib ../private/secret.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl secret\nf 1/1 2/2 3/3\n",
    );
    let mesh = ["mesh", "shared/model.obj", "--size", "64", "--no-cache"];
    says(
        &place.sabi(&mesh).good(),
        &format!(
            "The material library ../private/secret.mtl cannot be read: {}.",
            outside(&place, "private/secret.mtl")
        ),
    );
}

#[test]
fn a_graph_opens_no_picture_from_elsewhere() {
    let place = with_secret();
    place.write("private/photo.bmp", crate::packing::bmp(30));
    place.write("shared/worn.sabi", shows("../private/photo.bmp"));
    let refused = format!(
        "parameter 'file' of node 'photo' (source/image): {}",
        outside(&place, "private/photo.bmp")
    );
    let bake = |more: &[&str]| place.bake("shared/worn.sabi", "shared/../cube.glb", more);
    // The folder of the model is the one above both.
    bake(&[]).good();
    fs::copy(place.path("cube.glb"), place.path("shared/cube.glb")).unwrap();
    let bake = |more: &[&str]| place.bake("shared/worn.sabi", "shared/cube.glb", more);
    let done = bake(&["-o", "other"]).fails(66);
    says(&done, &format!("{refused}; trust it or its folder with --trust\n"));
    assert!(!place.path("other").exists());
    bake(&["-o", "other", "--trust", "private"]).good();
    says(&place.sabi(&["check", "shared/worn.sabi"]).fails(65), &refused);
    place
        .sabi(&["check", "shared/worn.sabi", "--trust", "private/photo.bmp"])
        .good();
    // A value of the command line names it, too.
    place.write("shared/other.sabi", shows("none.bmp"));
    let arguments = ["-o", "third", "--set", "photo.file=../private/photo.bmp"];
    place.bake("shared/other.sabi", "shared/cube.glb", &arguments).good();
}

#[test]
fn a_graph_opens_no_group_from_elsewhere() {
    let place = with_secret();
    fs::copy(place.path("clouds.sabi"), place.path("private/own.sabi")).unwrap();
    let group = |file: &str| {
        json!({ "format": "sabi", "version": 1, "nodes": { "g": { "kind": "graph/group", "group": file } } })
            .to_string()
    };
    place.write("shared/worn.sabi", group("../private/own.sabi"));
    let refused = outside(&place, "private/own.sabi");
    says(&place.sabi(&["check", "shared/worn.sabi"]).fails(66), &refused);
    place.sabi(&["check", "shared/worn.sabi", "--trust", "private"]).good();
    let packed = ["pack", "shared/worn.sabi", "--no-mesh", "-o", "sent.zip"];
    says(&place.sabi(&packed).fails(66), &refused);
    assert!(!place.path("sent.zip").exists());
    let told = place.sabi(&["info", "shared/worn.sabi"]).good();
    says(&told, &refused);
    for address in ["//host/share/a.sabi", "https://host/a.sabi"] {
        place.write("shared/worn.sabi", group(address));
        place.sabi(&["check", "shared/worn.sabi", "--trust", "/"]).fails(66);
    }
}

#[test]
fn nothing_from_elsewhere_is_packed() {
    let place = with_secret();
    place.write("private/photo.bmp", crate::packing::bmp(30));
    place.write("shared/worn.sabi", shows("../private/photo.bmp"));
    let pack = ["pack", "shared/worn.sabi", "--no-mesh", "-o", "sent.zip"];
    let done = place.sabi(&pack).fails(65);
    says(
        &done,
        &format!(
            "{}; trust it or its folder with --trust",
            outside(&place, "private/photo.bmp")
        ),
    );
    assert!(!place.path("sent.zip").exists());
    let trusting = [pack.as_slice(), &["--trust", "private"]].concat();
    place.sabi(&trusting).good();
}

#[cfg(unix)]
#[test]
fn a_link_beside_a_graph_leads_no_further() {
    let place = with_secret();
    place.write("private/photo.bmp", crate::packing::bmp(30));
    std::os::unix::fs::symlink(place.path("private/photo.bmp"), place.path("shared/innocent.bmp")).unwrap();
    place.write("shared/worn.sabi", shows("innocent.bmp"));
    let refused = outside(&place, "private/photo.bmp");
    says(&place.sabi(&["check", "shared/worn.sabi"]).fails(65), &refused);
    // Nor does one beside its strokes, which are packed as they are.
    place.write(
        "shared/worn.sabi",
        r#"{ "format": "sabi", "version": 1, "nodes": { "hand": { "kind": "source/paint" } } }"#,
    );
    fs::create_dir(place.path("shared/worn.paint")).unwrap();
    std::os::unix::fs::symlink(
        place.path("private/secret.txt"),
        place.path("shared/worn.paint/cube.strokes"),
    )
    .unwrap();
    let pack = ["pack", "shared/worn.sabi", "--no-mesh", "-o", "sent.zip"];
    says(
        &place.sabi(&pack).fails(66),
        &format!("cube.strokes is a link: {}", outside(&place, "private/secret.txt")),
    );
    assert!(!place.path("sent.zip").exists());
    place.write("shared/worn.sabi", shows("/dev/zero"));
    let device = place.sabi(&["check", "shared/worn.sabi", "--trust", "/"]).fails(65);
    says(&device, "/dev/zero is a device or a pipe, which files never open");
}
