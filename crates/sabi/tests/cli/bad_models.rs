//! Models and their pictures that are missing or damaged.

use crate::cli_folder::{CliFolder, graph};

#[test]
fn a_model_that_cannot_be_read_is_a_sentence() {
    let place = CliFolder::new();
    let cube = place.read("cube.glb");
    place.write("cut.glb", &cube[..300]);
    place.write("empty.glb", "");
    place.write("text.obj", "hello\n");
    place.write("cut.fbx", "Kaydara FBX Binary");
    place.write("cube.usd", "#usda 1.0");
    // The header claims a size of four gigabytes.
    let mut huge = cube.clone();
    huge[8..12].copy_from_slice(&u32::MAX.to_le_bytes());
    place.write("huge.glb", huge);
    let cases = [
        ("none.glb", 66, "none.glb: there is no such file; check the path".to_owned()),
        (
            "cut.glb",
            65,
            format!(
                "cut.glb: the file is damaged: its header promises {} bytes and there are 300; it was cut off",
                cube.len()
            ),
        ),
        (
            "huge.glb",
            65,
            format!(
                "huge.glb: the file is damaged: its header promises 4294967295 bytes and there are {}; it was cut off",
                cube.len()
            ),
        ),
        (
            "text.obj",
            65,
            "text.obj: it has no triangles; The file has statements that are not known and are left out, the first in line 1: \
             `hello`"
                .to_owned(),
        ),
        (
            "cube.usd",
            65,
            "cube.usd: .usd files are not read here: open it in Blender (File > Import) and export it with File > Export > \
             glTF 2.0 (.glb)"
                .to_owned(),
        ),
        ("cut.fbx", 65, "cut.fbx: the file is damaged: it was cut off".to_owned()),
    ];
    for (model, code, words) in cases {
        place.refuses("clouds.sabi", model, &[], code, &words);
    }
    let empty = place.bake("clouds.sabi", "empty.glb", &[]).fails(65);
    assert!(empty.stderr.starts_with("error: empty.glb: "), "{}", empty.stderr);
    let uv = ["--uv", "3"];
    place.refuses(
        "clouds.sabi",
        "cube.glb",
        &uv,
        65,
        "cube.glb: it has no UV set 3; it has set 0",
    );
}

/// A triangle with a base color picture beside it.
const TEXTURED: &str = r#"{
  "asset": { "version": "2.0" },
  "scenes": [ { "nodes": [ 0 ] } ], "scene": 0,
  "nodes": [ { "mesh": 0 } ],
  "meshes": [ { "primitives": [ { "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "material": 0 } ] } ],
  "materials": [ { "name": "wood", "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } } ],
  "textures": [ { "source": 0 } ],
  "images": [ { "uri": "wood.png" } ],
  "buffers": [ { "byteLength": 60, "uri": "model.bin" } ],
  "bufferViews": [ { "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteOffset": 36, "byteLength": 24 } ],
  "accessors": [
    { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [ 0, 0, 0 ], "max": [ 1, 1, 0 ] },
    { "bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2" }
  ]
}"#;

#[test]
fn a_picture_that_cannot_be_read_is_a_warning_and_its_factor_is_used() {
    let place = CliFolder::new();
    let numbers: [f32; 15] = [0., 0., 0., 1., 0., 0., 0., 1., 0., 0.1, 0.9, 0.9, 0.9, 0.1, 0.1];
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    place.write("model.gltf", TEXTURED);
    place.write("model.bin", bytes);
    place.write(
        "model.sabi",
        graph(
            r#"    "clouds": { "kind": "noise/simplex" },
    "model": { "kind": "source/model" },
    "out": { "kind": "output/material", "inputs": { "material": "model" } }"#,
        ),
    );
    let missing = place.bake("model.sabi", "model.gltf", &[]).good();
    assert!(
        missing.stderr.contains("warning: ") && missing.stderr.contains("wood.png"),
        "{}",
        missing.stderr
    );
    let png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\xff\xff\xff\xff\xff\xff\xff\xff\x10\x06\0\0\0";
    for damaged in [&b"not a picture"[..], png, b""] {
        place.write("wood.png", damaged);
        let run = place.bake("model.sabi", "model.gltf", &[]).good();
        assert!(
            run.stderr.contains("warning: ") && run.stderr.contains("wood.png"),
            "{}",
            run.stderr
        );
    }
    place.write("model.bin", [0; 20]);
    place.bake("model.sabi", "model.gltf", &[]).fails(65);
    std::fs::remove_file(place.path("model.bin")).unwrap();
    let gone = place.bake("model.sabi", "model.gltf", &[]).fails(66);
    assert!(gone.stderr.contains("model.bin"), "{}", gone.stderr);
}
