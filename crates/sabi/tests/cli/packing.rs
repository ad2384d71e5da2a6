//! Packed graphs: the archive alone gives the same maps on another machine.

use std::fs;
use std::path::Path;

use serde_json::Value as Json;

use crate::cli_folder::CliFolder;

/// A picture of two by two pixels, of which the lower two are of this gray.
pub(crate) fn bmp(gray: u8) -> Vec<u8> {
    let mut bytes = b"BM".to_vec();
    for word in [70_u32, 0, 54, 40, 2, 2, 1 | 24 << 16, 0, 16, 2835, 2835, 0, 0] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend([gray; 6].iter().chain(&[0, 0]).chain(&[200; 6]).chain(&[0, 0]));
    bytes
}

fn repository(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name)
}

/// A folder `shot` with a graph that is painted by hand, and that uses a picture and a group file from other folders, an own node and its
/// library from the user's folder, one from the folder beside it, and a model from another folder.
fn shot() -> CliFolder {
    let place = CliFolder::new();
    for folder in [
        "shot/worn.paint",
        "shot/art",
        "shot/nodes/mine",
        "photos",
        "library/art",
        "models",
        ".nodes/own",
        ".nodes/lib",
    ] {
        fs::create_dir_all(place.path(folder)).unwrap();
    }
    // The folders belong to one project.
    place.write("sabi.toml", "");
    fs::copy(repository("assets/meshes/column.glb"), place.path("models/column.glb")).unwrap();
    fs::copy(
        repository("graphs/thesis/scratched-column.paint/column.strokes"),
        place.path("shot/worn.paint/column.strokes"),
    )
    .unwrap();
    place.write("photos/dirt.bmp", bmp(30));
    place.write("shot/art/near.bmp", bmp(90));
    place.write("library/art/dirt.bmp", bmp(150));
    place.write("stain.bmp", bmp(220));
    place.write(
        ".nodes/lib/halves.wgsl",
        "fn half_of(x: f32) -> f32 { return 0.5 * x; }\n",
    );
    let node = "//! Own\n//! A test.\n//! @use halves\n\n/// The mask.\nfn mask(at: Surface) -> f32 {\n    return half_of(at.uv.x);\n}\n";
    place.write(".nodes/own/ramp.wgsl", node);
    let plain = node
        .replace("//! @use halves\n", "")
        .replace("half_of(at.uv.x)", "at.uv.y");
    place.write(".nodes/own/unused.wgsl", &plain);
    place.write("shot/nodes/mine/ramp.wgsl", &plain);
    place.write(
        "library/stains.sabi",
        r#"{ "format": "sabi", "version": 1, "outputs": { "near": "near.mask", "far": "far.mask" }, "nodes": {
  "near": { "kind": "source/image", "params": { "file": "art/dirt.bmp" } },
  "far": { "kind": "source/image", "params": { "file": "../stain.bmp" } } } }"#,
    );
    place.write("shot/worn.sabi", worn(&place));
    place
}

/// The graph of [`shot`].
fn worn(place: &CliFolder) -> String {
    let painted = fs::read_to_string(repository("graphs/thesis/scratched-column.sabi")).unwrap();
    let painted: Json = serde_json::from_str(&painted).unwrap();
    let strokes = &painted["nodes"]["hand"]["params"]["strokes"];
    let absolute = place.path("photos/dirt.bmp").to_string_lossy().replace('\\', "/");
    let outs = [
        ("hand", "hand"),
        ("photo", "photo.mask"),
        ("near", "near.mask"),
        ("ramp", "ramp"),
        ("beside", "beside"),
        ("group", "stains.near"),
        ("groups", "stains.far"),
    ];
    let outs = outs.map(|(name, source)| {
        format!(r#""out_{name}": {{ "kind": "output/mask", "params": {{ "name": "{name}" }}, "inputs": {{ "source": "{source}" }} }}"#)
    });
    format!(
        r#"{{ "format": "sabi", "version": 1, "preview": {{ "mesh": "../models/column.glb" }},
  "exposed": {{ "picture": {{ "to": ["photo.file"] }} }}, "variants": {{ "other": {{ "picture": "../library/art/dirt.bmp" }} }},
  "nodes": {{
  "hand": {{ "kind": "source/paint", "params": {{ "strokes": {strokes} }} }},
  "photo": {{ "kind": "source/image", "params": {{ "file": "{absolute}" }} }},
  "near": {{ "kind": "source/image", "params": {{ "file": "./art/near.bmp" }} }},
  "ramp": {{ "kind": "own/ramp" }},
  "beside": {{ "kind": "mine/ramp" }},
  "stains": {{ "kind": "graph/group", "group": "../library/stains.sabi" }},
  {} }} }}"#,
        outs.join(",\n  ")
    )
}

/// Returns the maps of a bake, by name.
fn maps(place: &CliFolder, graph: &str, model: &str, variant: Option<&str>) -> Vec<(String, Vec<u8>)> {
    let out = format!("maps-{}", variant.unwrap_or("own"));
    let more = variant.map_or(vec![], |variant| vec!["--variant", variant]);
    let run = place
        .bake(graph, model, &[&["-o", &out, "--all-maps"], &more[..]].concat())
        .good();
    assert!(!run.stderr.contains("warning"), "{}", run.stderr);
    place
        .listing(&out)
        .into_iter()
        .map(|name| (name.clone(), place.read(&format!("{out}/{name}"))))
        .collect()
}

/// Returns all files below a folder, with their contents.
fn contents(place: &CliFolder, folder: &str) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for name in place.listing(folder) {
        let name = format!("{folder}/{name}");
        match place.path(&name).is_dir() {
            true => found.extend(contents(place, &name)),
            false => found.push((name.clone(), place.read(&name))),
        }
    }
    found
}

#[test]
fn a_packed_graph_gives_the_same_maps_elsewhere() {
    let here = shot();
    let before = contents(&here, "shot");
    let packed = here.sabi(&["pack", "shot/worn.sabi", "-o", "worn.zip"]).good();
    assert_eq!(packed.stdout, "worn.zip\n");
    assert!(!packed.stderr.contains("warning"), "{}", packed.stderr);
    assert!(
        contents(&here, "shot") == before,
        "packing writes nothing but the archive"
    );
    let there = CliFolder::new();
    there.write("worn.zip", here.read("worn.zip"));
    let model = here.read("models/column.glb");
    let own = maps(&here, "shot/worn.sabi", "models/column.glb", None);
    let other = maps(&here, "shot/worn.sabi", "models/column.glb", Some("other"));
    assert!(own != other && own.len() >= 7, "{}", own.len());
    drop(here);
    let unpacked = there.sabi(&["unpack", "worn.zip"]).good();
    assert_eq!(unpacked.stdout, "worn/worn.sabi\n");
    assert!(
        unpacked
            .stderr
            .contains("sabi bake worn/worn.sabi --mesh worn/files/column.glb -o maps"),
        "{}",
        unpacked.stderr
    );
    let names: Vec<String> = contents(&there, "worn").into_iter().map(|(name, _)| name).collect();
    let expected = [
        "art/near.bmp",
        "files/2/dirt.bmp",
        "files/column.glb",
        "files/dirt.bmp",
        "files/stain.bmp",
        "files/stains.sabi",
        "nodes/lib/halves.wgsl",
        "nodes/mine/ramp.wgsl",
        "nodes/own/ramp.wgsl",
        "pack.json",
        "worn.paint/column.strokes",
        "worn.sabi",
    ];
    assert_eq!(names, expected.map(|name| format!("worn/{name}")));
    assert!(there.read("worn/files/column.glb") == model);
    there.sabi(&["check", "worn/worn.sabi"]).good();
    assert!(maps(&there, "worn/worn.sabi", "worn/files/column.glb", None) == own);
    assert!(maps(&there, "worn/worn.sabi", "worn/files/column.glb", Some("other")) == other);
    let graph: Json = serde_json::from_slice(&there.read("worn/worn.sabi")).unwrap();
    assert_eq!(graph["preview"]["mesh"], "files/column.glb");
    assert_eq!(
        graph["nodes"]["near"]["params"]["file"], "./art/near.bmp",
        "a path that leads there is kept"
    );
}

#[test]
fn the_same_files_give_the_same_archive_and_a_packed_graph_packs_to_itself() {
    let place = shot();
    let pack = |graph: &str, to: &str| place.sabi(&["pack", graph, "-o", to, "--json"]).good();
    let report: Json = serde_json::from_str(&pack("shot/worn.sabi", "one.zip").stdout).unwrap();
    assert_eq!(
        (&report["graph"], &report["model"]),
        (&Json::from("worn.sabi"), &Json::from("files/column.glb"))
    );
    let file = report["files"]
        .as_array()
        .unwrap()
        .iter()
        .find(|file| file["name"] == "files/stain.bmp")
        .unwrap();
    assert!(
        file["from"].as_str().unwrap().ends_with("stain.bmp") && file["bytes"] == 70,
        "{file}"
    );
    pack("shot/worn.sabi", "two.zip");
    assert!(place.read("one.zip") == place.read("two.zip"));
    let unpacked = place.sabi(&["unpack", "one.zip", "--json"]).good();
    let report: Json = serde_json::from_str(&unpacked.stdout).unwrap();
    assert_eq!(report["files"].as_array().unwrap().len(), 12);
    pack("one/worn.sabi", "three.zip");
    assert!(
        place.read("one.zip") == place.read("three.zip"),
        "nothing is left to rewrite"
    );
}

#[test]
fn an_archive_replaces_a_file_only_on_demand_and_never_what_it_packs() {
    let place = shot();
    let pack = |more: &[&str]| place.sabi(&[&["pack", "shot/worn.sabi"], more].concat());
    place.write("worn.zip", "own");
    let words = "error: worn.zip exists already; replace the file with --force\n";
    assert_eq!(pack(&["-o", "worn.zip"]).fails(73).stderr, words);
    assert_eq!(place.read("worn.zip"), b"own");
    pack(&["-o", "worn.zip", "--force"]).good();
    let graph = place.read("shot/worn.sabi");
    for input in ["shot/worn.sabi", "photos/dirt.bmp", "models/column.glb"] {
        let run = pack(&["-o", input, "--force"]).fails(73);
        assert!(
            run.stderr
                .trim_end()
                .ends_with("it is packed itself; name another file"),
            "{}",
            run.stderr
        );
    }
    assert!(place.read("shot/worn.sabi") == graph);
    fs::create_dir(place.path("full")).unwrap();
    place.write("full/own", "own");
    let run = place.sabi(&["unpack", "worn.zip", "-o", "full"]).fails(73);
    assert_eq!(
        run.stderr,
        "error: the folder full has files; choose another folder with -o\n"
    );
    assert_eq!(place.listing("full"), ["own"]);
}

#[test]
fn what_is_missing_is_named_with_its_node_and_left_out_on_demand() {
    let place = shot();
    for gone in [
        "photos/dirt.bmp",
        "library/stains.sabi",
        ".nodes/own/ramp.wgsl",
        "shot/worn.paint/column.strokes",
        "models/column.glb",
    ] {
        fs::remove_file(place.path(gone)).unwrap();
    }
    let run = place.sabi(&["pack", "shot/worn.sabi", "-o", "worn.zip"]).fails(66);
    assert!(!place.path("worn.zip").exists());
    let lines: Vec<&str> = run.stderr.lines().collect();
    let told = [
        [
            "node 'stains' (graph/group) names the group file",
            "stains.sabi, which is missing",
        ],
        [
            "node 'photo' (source/image) names the picture",
            "dirt.bmp, which is missing",
        ],
        [
            "node 'ramp' (own/ramp) is of a kind",
            "whose node file is missing or has a fault",
        ],
        [
            "node 'hand' (source/paint) lacks its strokes of version",
            "which should be in",
        ],
        ["the graph is shown on the model", "column.glb, which is missing"],
    ];
    assert_eq!(lines.len(), told.len(), "{}", run.stderr);
    for (line, [first, last]) in lines.iter().zip(told) {
        assert!(
            line.starts_with("error: shot/worn.sabi: ") && line.contains(first) && line.contains(last),
            "{line}"
        );
    }
    assert!(
        run.stderr
            .ends_with("; pack without what is missing with --allow-missing\n"),
        "{}",
        run.stderr
    );
    let run = place
        .sabi(&["pack", "shot/worn.sabi", "-o", "worn.zip", "--allow-missing"])
        .good();
    assert_eq!(run.stderr.matches("warning: ").count(), told.len(), "{}", run.stderr);
    place.sabi(&["unpack", "worn.zip"]).good();
}

#[test]
fn a_file_that_is_named_as_a_picture_and_is_none_is_not_sent_along() {
    let place = shot();
    place.write("photos/dirt.bmp", "secret");
    let run = place
        .sabi(&["pack", "shot/worn.sabi", "-o", "worn.zip", "--allow-missing"])
        .fails(65);
    assert!(
        run.stderr.contains("node 'photo' (source/image): ") && run.stderr.contains("is no picture"),
        "{}",
        run.stderr
    );
}

/// A triangle with a texture in a folder beside that of the model.
const TRIANGLE: &str = r#"{ "asset": { "version": "2.0" }, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
    "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "material": 0 }] }],
    "materials": [{ "name": "m", "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
    "textures": [{ "source": 0 }], "images": [{ "uri": "../tex/base%20color.bmp" }],
    "accessors": [
        { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" },
        { "bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2" }],
    "bufferViews": [
        { "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteOffset": 36, "byteLength": 24 }],
    "buffers": [{ "uri": "triangle.bin", "byteLength": 60 }] }"#;

#[test]
fn a_model_is_packed_with_its_buffers_and_textures_as_they_lie_to_each_other() {
    let place = CliFolder::new();
    place.write("sabi.toml", "");
    for folder in ["work", "assets/models", "assets/tex"] {
        fs::create_dir_all(place.path(folder)).unwrap();
    }
    let numbers: [f32; 15] = [
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.1, 0.9, 0.9, 0.9, 0.1, 0.1,
    ];
    place.write("assets/models/triangle.gltf", TRIANGLE);
    place.write("assets/models/triangle.bin", numbers.map(f32::to_le_bytes).concat());
    place.write("assets/tex/base color.bmp", bmp(99));
    let text = r#"{ "format": "sabi", "version": 1, "nodes": { "model": { "kind": "source/model" },
        "out": { "kind": "output/material", "inputs": { "material": "model" } } } }"#;
    place.write("work/as-is.sabi", text);
    let pack = |more: &[&str]| place.sabi(&[&["pack", "work/as-is.sabi", "-o", "as-is.zip", "--force"], more].concat());
    let run = pack(&[]).fails(2);
    let words = "error: work/as-is.sabi: the graph names no model; name a model with --mesh, or pack without a model with --no-mesh\n";
    assert_eq!(run.stderr, words);
    pack(&["--no-mesh"]).good();
    place.sabi(&["unpack", "as-is.zip", "-o", "without"]).good();
    assert_eq!(
        place.read("without/as-is.sabi"),
        text.as_bytes(),
        "nothing had to be rewritten"
    );
    pack(&["--mesh", "assets/models/triangle.gltf"]).good();
    let own = maps(&place, "work/as-is.sabi", "assets/models/triangle.gltf", None);
    fs::rename(place.path("assets"), place.path("gone")).unwrap();
    fs::remove_dir_all(place.path("maps-own")).unwrap();
    place.sabi(&["unpack", "as-is.zip"]).good();
    let model = "as-is/files/triangle/model/triangle.gltf";
    assert_eq!(place.listing("as-is/files/triangle/tex"), ["base color.bmp"]);
    assert!(maps(&place, "as-is/as-is.sabi", model, None) == own);
    // A missing texture, and a model that names a file which does not belong to it.
    fs::rename(place.path("gone"), place.path("assets")).unwrap();
    let with_model = ["--mesh", "assets/models/triangle.gltf"];
    place.write("assets/tex/base color.bmp", "secret");
    let run = pack(&with_model).fails(65);
    assert!(
        run.stderr.contains("which is outside of its folder and no picture"),
        "{}",
        run.stderr
    );
    fs::remove_file(place.path("assets/tex/base color.bmp")).unwrap();
    let run = pack(&with_model).fails(66);
    assert!(run.stderr.contains("triangle.gltf names ../tex/base"), "{}", run.stderr);
    assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
}
