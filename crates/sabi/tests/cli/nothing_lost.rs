//! Tests that the results of a bake never replace files that it reads.

use crate::cli_folder::{CliFolder, graph};

/// A graph that writes `<material>_mask.png`.
const MASK: &str = r#""n": { "kind": "noise/simplex" },
    "out": { "kind": "output/mask", "inputs": { "source": "n" } }"#;

#[test]
fn a_report_never_replaces_the_graph_or_the_model() {
    let place = CliFolder::new();
    for own in ["clouds.sabi", "cube.glb"] {
        let before = place.read(own);
        let more = ["-o", ".", "--force", "--report", own];
        let run = place.bake("clouds.sabi", "cube.glb", &more).fails(73);
        assert_eq!(
            run.stderr.trim_end(),
            format!("error: cannot write the report {own}: this very bake reads it; name another file")
        );
        assert_eq!(place.read(own), before);
    }
}

#[cfg(unix)]
#[test]
fn a_report_replaces_files_only() {
    let place = CliFolder::new();
    let _listening = std::os::unix::net::UnixListener::bind(place.path("socket")).unwrap();
    let run = place.bake("clouds.sabi", "cube.glb", &["--report", "socket"]).fails(73);
    assert_eq!(
        run.stderr.trim_end(),
        "error: cannot write the report socket: it is no ordinary file; use - for standard output"
    );
}

#[test]
fn maps_never_replace_a_texture_of_the_model_being_baked() {
    let place = CliFolder::new();
    let model = r#"{ "asset": { "version": "2.0" }, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "material": 0 }] }],
        "materials": [{ "name": "m", "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
        "textures": [{ "source": 0 }], "images": [{ "uri": "m_mask.png" }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" },
            { "bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2" }],
        "bufferViews": [
            { "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteOffset": 36, "byteLength": 24 }],
        "buffers": [{ "uri": "m.bin", "byteLength": 60 }] }"#;
    let numbers: [f32; 15] = [
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.1, 0.9, 0.9, 0.9, 0.1, 0.1,
    ];
    place.write("m.gltf", model);
    place.write("m.bin", numbers.map(f32::to_le_bytes).concat());
    let texture = b"the artist's own";
    place.write("m_mask.png", texture);
    place.write("mask.sabi", graph(MASK).replace("clouds.", "n."));
    let run = place.bake("mask.sabi", "m.gltf", &["-o", ".", "--force"]).fails(73);
    let words =
        "m_mask.png is read by this very bake and would be replaced by its own result; choose another folder with -o";
    assert!(run.stderr.trim_end().ends_with(words), "{}", run.stderr);
    assert_eq!(place.read("m_mask.png"), texture);
}

#[test]
fn a_group_and_a_bend_of_a_wire_can_be_looked_at() {
    let place = CliFolder::new();
    let text = r#"{ "format": "sabi", "version": 1, "groups": { "g": {
        "outputs": { "wear": "n" }, "nodes": { "n": { "kind": "noise/simplex" } } } }, "nodes": {
        "look": { "kind": "graph/group", "group": "g" },
        "bend": { "kind": "graph/reroute", "inputs": { "source": "look.wear" } } } }"#;
    place.write("groups.sabi", text);
    let look = |node: &str, file: &str| {
        let arguments = [
            "preview",
            "groups.sabi",
            "--mesh",
            "cube.glb",
            "--size",
            "64",
            "--adapter",
            "cpu",
        ];
        place
            .sabi(&[&arguments[..], &["--node", node, "-o", file]].concat())
            .good();
        place.read(file)
    };
    let inner = look("look/n", "inner.png");
    assert_eq!(look("look.wear", "group.png"), inner);
    assert_eq!(look("bend", "bend.png"), inner);
}

#[test]
fn a_node_file_with_a_fault_is_named_where_it_is_used_and_only_counted_elsewhere() {
    let place = CliFolder::new();
    std::fs::create_dir_all(place.path("nodes/own")).unwrap();
    place.write(
        "nodes/own/bad.wgsl",
        "//! Bad\n//! Is no node.\n\n/// It.\nfn mask() -> f32 { return; }\n",
    );
    let idle = place.bake("clouds.sabi", "cube.glb", &[]).good();
    assert!(
        idle.stderr
            .contains("bad.wgsl has a fault and is left out; 'sabi check' says which"),
        "{}",
        idle.stderr
    );
    place.write(
        "used.sabi",
        graph(MASK).replace("clouds.", "n.").replace("noise/simplex", "own/bad"),
    );
    let used = place.bake("used.sabi", "cube.glb", &["-o", "two"]).fails(65);
    assert!(
        used.stderr
            .contains("node 'n' is of kind 'own/bad', whose file has a fault:"),
        "{}",
        used.stderr
    );
    assert!(used.stderr.contains("bad.wgsl:5:"), "{}", used.stderr);
    place.sabi(&["check", "clouds.sabi"]).good();
}
