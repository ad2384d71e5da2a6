//! Untrusted files: their paths, sizes and texts cannot reach other files, control the terminal or exhaust the memory.
#![cfg(target_os = "linux")]

use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read as _};
use std::os::unix::fs::symlink;
use std::process::{Command, Stdio};

use serde_json::{Value, json};

use crate::cli_folder::{CLOUDS, CliFolder, RunOutput, done, graph, software_adapter};

/// Returns the binary with a limit on its address space, in KiB.
fn within(place: &CliFolder, most_kib: u64, arguments: &[&str]) -> RunOutput {
    let plain = place.command(arguments);
    let mut limited = Command::new("sh");
    limited
        .args(["-c", &format!("ulimit -v {most_kib}; exec \"$0\" \"$@\"")])
        .arg(plain.get_program())
        .args(plain.get_args())
        .current_dir(place.path("."))
        .stdin(Stdio::null());
    for (name, value) in plain.get_envs() {
        match value {
            Some(value) => limited.env(name, value),
            None => limited.env_remove(name),
        };
    }
    // Each thread needs address space for its stack.
    done(limited.env("RAYON_NUM_THREADS", "2").output().unwrap())
}

/// A GLB file of a document with the vertex data of one triangle.
fn glb(document: &Value) -> Vec<u8> {
    let numbers = [
        0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0,
    ];
    let binary = numbers.map(f32::to_le_bytes).concat();
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let chunk = |kind: &[u8; 4], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes(), &kind[..], bytes].concat();
    let chunks = [chunk(b"JSON", &text), chunk(b"BIN\0", &binary)].concat();
    let length = (12 + chunks.len()) as u32;
    [b"glTF", &2u32.to_le_bytes()[..], &length.to_le_bytes(), &chunks].concat()
}

/// Returns a triangle that this many nodes place, in this many primitives of its mesh.
fn triangles(nodes: usize, primitives: usize) -> Vec<u8> {
    let view = |offset: u32, length: u32| json!({ "buffer": 0, "byteOffset": offset, "byteLength": length });
    let accessor = |view: u32, ty: &str| json!({ "bufferView": view, "componentType": 5126, "count": 3, "type": ty });
    let primitive = json!({ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 } });
    let places: Vec<Value> = (0..nodes)
        .map(|node| json!({ "mesh": 0, "translation": [node % 1000, node / 1000, 0] }))
        .collect();
    glb(&json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": (0..nodes).collect::<Vec<_>>() }], "scene": 0,
        "nodes": places,
        "meshes": [{ "primitives": vec![primitive; primitives] }],
        "buffers": [{ "byteLength": 60 }],
        "bufferViews": [view(0, 36), view(36, 24)],
        "accessors": [accessor(0, "VEC3"), accessor(1, "VEC2")],
    }))
}

/// Returns an OBJ file of this many faces with this many corners each, all on one circle.
fn polygons(faces: usize, corners: usize) -> String {
    let angle = |corner: usize| corner as f32 * std::f32::consts::TAU / corners as f32;
    let mut text: String = (0..corners)
        .map(|corner| angle(corner).sin_cos())
        .map(|(y, x)| format!("v {x} {y} 0\n"))
        .collect();
    let face: String = (1..=corners).map(|corner| format!(" {corner}")).collect();
    (0..faces).for_each(|_| text += &format!("f{face}\n"));
    text
}

#[test]
fn a_model_that_takes_more_memory_than_it_may_is_refused_by_a_sentence() {
    let place = CliFolder::new();
    place.write("nodes.glb", triangles(50_000, 1));
    place.write("primitives.glb", triangles(1, 200_000));
    place.write("large.glb", triangles(100, 1));
    place.write("polygons.obj", polygons(8000, 1000));
    // A bracket of a file becomes a material of a kilobyte.
    place.write(
        "empty.glb",
        glb(&json!({ "asset": { "version": "2.0" }, "materials": vec![json!({}); 300_000] })),
    );
    let tree = "<COLLADA>".to_owned() + &"<a/>".repeat(1_000_000) + "</COLLADA>";
    place.write("tree.dae", tree);
    for (model, size, sentence) in [
        ("nodes.glb", "64", "of memory, and there are 128 for it"),
        ("primitives.glb", "64", "MiB"),
        ("large.glb", "2048", "of memory, and there are 128 for it"),
        ("polygons.obj", "64", "MiB"),
        ("empty.glb", "64", "MiB"),
        ("tree.dae", "64", "MiB"),
    ] {
        let arguments = ["mesh", model, "--size", size, "--memory", "128", "--no-cache"];
        let refused = within(&place, 1_200_000, &arguments).fails(65);
        assert!(
            refused.stderr.contains(sentence) && refused.stderr.contains("--memory"),
            "{model}: {}",
            refused.stderr
        );
    }
}

#[test]
fn a_picture_that_takes_more_memory_than_it_may_is_refused_by_a_sentence() {
    let place = CliFolder::new();
    // A compressed bitmap (RLE8) whose few bytes claim 16384 × 16384 pixels.
    let mut bytes = b"BM".to_vec();
    for word in [1078, 0, 1078, 40, 16384, 16384, 1 | 8 << 16, 1, 0, 0, 0, 256, 0] {
        bytes.extend(u32::to_le_bytes(word));
    }
    bytes.resize(1078, 0);
    bytes.extend([0, 1]);
    place.write("huge.bmp", bytes);
    let nodes = r#"    "clouds": { "kind": "source/image", "params": { "file": "huge.bmp" } },
    "out": { "kind": "output/mask", "inputs": { "source": "clouds.mask" } }"#;
    let text = format!(r#"{{ "format": "sabi", "version": 1, "nodes": {{ {nodes} }} }}"#);
    place.write("picture.sabi", text);
    software_adapter();
    let arguments = [
        "bake",
        "picture.sabi",
        "--mesh",
        "cube.glb",
        "-o",
        "out",
        "--size",
        "16",
        "--adapter",
        "cpu",
        "--memory",
        "512",
    ];
    let refused = place.sabi(&arguments).fails(65);
    let told = &refused.stderr;
    assert!(
        told.contains("huge.bmp takes ") && told.contains("MiB are for pictures") && told.contains("with --memory"),
        "{told}"
    );
}

#[test]
fn very_many_faults_of_a_file_are_told_in_part() {
    let place = CliFolder::new();
    let keys: String = (0..100_000).map(|key| format!("\"k{key}\": 1, ")).collect();
    let head = r#""format": "sabi", "version": 1"#;
    let out = r#""a": { "kind": "noise/simplex" }, "out": { "kind": "output/mask", "inputs": { "source": "a" } }"#;
    place.write("keys.sabi", format!("{{ {head}, {keys} \"nodes\": {{ {out} }} }}"));
    let told = place.sabi(&["check", "keys.sabi"]).good();
    let told = told.stdout + &told.stderr;
    assert!(told.contains("99900 more keys that nothing reads are left out"));
    assert!(told.lines().count() < 300);
    let nodes: String = (0..20_000)
        .map(|node| format!("\"n{node}\": {{ \"kind\": \"none/n{node}\" }}, "))
        .collect();
    place.write("kinds.sabi", format!("{{ {head}, \"nodes\": {{ {nodes} {out} }} }}"));
    let told = place.sabi(&["check", "kinds.sabi"]).fails(65);
    assert!(told.stderr.lines().count() + told.stdout.lines().count() < 500);
    let told = place.sabi(&["info", "kinds.sabi"]).good().stderr;
    assert!(told.lines().count() < 300 && told.contains(" more warnings are left out"));
}

#[test]
fn groups_in_a_name_that_are_in_each_other_end_in_a_sentence() {
    let place = CliFolder::new();
    let names = format!("{}$map{}", "(".repeat(100_000), ")".repeat(100_000));
    let map = "[[map]]\nname = \"M\"\ngray = \"roughness\"\nformat = \"png8\"\n";
    let preset = format!("version = 1\nname = \"deep\"\nabout = \"Deep.\"\nnames = \"{names}\"\n{map}");
    place.write("deep.toml", preset);
    let told = place.sabi(&["presets", "check", "deep.toml"]).fails(65).stderr;
    assert!(told.contains("groups are in each other more than 16 deep"), "{told}");
}

#[test]
fn a_face_of_many_corners_without_coordinates_is_laid_flat() {
    let place = CliFolder::new();
    place.write("round.obj", polygons(1, 30_000));
    let arguments = ["mesh", "round.obj", "--size", "64", "--no-cache", "--json"];
    let read = within(&place, 4_000_000, &arguments).good();
    let report: Value = serde_json::from_str(&read.stdout).unwrap();
    // Most of its triangles are thinner than the precision of its positions, and are counted as left out.
    let triangles = report["triangles"].as_u64().unwrap();
    let thin = format!("{} triangles without an area", 29_998 - triangles);
    assert!(
        triangles > 5000 && read.stderr.contains(&thin),
        "{triangles}: {}",
        read.stderr
    );
}

#[test]
fn node_files_that_are_links_are_neither_shown_nor_packed() {
    let place = CliFolder::new();
    fs::create_dir_all(place.path("graph/nodes/own")).unwrap();
    fs::create_dir_all(place.path("private/own")).unwrap();
    place.write("private/key", "BEGIN SECRET KEY");
    let half = "//! Half\n//! Halves.\n\n/// M.\nfn mask(at: Surface) -> f32 { return 0.5; }\n";
    place.write("private/own/half.wgsl", half);
    let nodes = r#""half": { "kind": "own/half" }, "out": { "kind": "output/mask", "inputs": { "source": "half" } }"#;
    let text = json!({ "format": "sabi", "version": 1 }).to_string();
    let text = format!("{}, \"nodes\": {{ {nodes} }} }}", text.trim_end_matches('}'));
    place.write("graph/graph.sabi", text);
    symlink(place.path("private/key"), place.path("graph/nodes/own/key.wgsl")).unwrap();
    symlink("/proc/self/environ", place.path("graph/nodes/own/environ.wgsl")).unwrap();
    let check = || place.sabi(&["check", "graph/graph.sabi"]);
    let told = check().fails(65).stderr;
    assert!(!told.contains("SECRET") && !told.contains("SABI_CACHE_DIR"), "{told}");
    assert!(told.contains("key.wgsl: The file is not read, because "), "{told}");
    assert!(told.contains("is outside of the folder"), "{told}");
    // The folder of nodes itself may be a link, which leads nowhere.
    fs::remove_dir_all(place.path("graph/nodes")).unwrap();
    symlink(place.path("private"), place.path("graph/nodes")).unwrap();
    check().fails(65);
    let pack = ["pack", "graph/graph.sabi", "--no-mesh", "-o", "graph.zip"];
    place.sabi(&pack).fails(66);
    let private = place.path("private").display().to_string();
    place.sabi(&["check", "graph/graph.sabi", "--trust", &private]).good();
    place.sabi(&[&pack[..], &["--trust", &private]].concat()).good();
}

#[test]
fn text_from_files_neither_controls_a_terminal_nor_speaks_for_the_program() {
    let place = CliFolder::new();
    let evil = "\u{1b}[2J\r\nopenjd_env: PATH=/evil\n::error::forged ##vso[task.x] \u{202e}gnp";
    let nodes = json!({
        (evil): { "kind": evil, "params": { (evil): evil } },
        "out": { "kind": "output/mask", "inputs": { "source": evil } },
    });
    let text = json!({
        "format": "sabi", "version": 1, "name": evil, "about": evil, "nodes": nodes,
        "variants": { (evil): { (evil): evil } },
    });
    place.write("evil.sabi", text.to_string());
    let name = "a\nopenjd_env: x=y\n::warning::\u{1b}[2J.sabi";
    place.write(name, graph(CLOUDS));
    place.write("preset.toml", format!("name = \"{}\"\n", evil.escape_unicode()));
    for arguments in [
        &["check", "evil.sabi"][..],
        &["check", "--json", "evil.sabi"],
        &["info", "evil.sabi"],
        &["info", "--json", "evil.sabi"],
        &["bake", "evil.sabi", "--mesh", "cube.glb", "-o", "out"],
        &["pack", "evil.sabi", "--no-mesh", "-o", "a.zip"],
        &["check", name],
        &["info", name],
        &["mesh", name],
        &["verify", name],
        &["unpack", name],
        &["presets", "check", "preset.toml"],
        &[
            "preview",
            "evil.sabi",
            "--mesh",
            "cube.glb",
            "--node",
            evil,
            "-o",
            "x.png",
        ],
        &["plan", name],
        &["run", name],
        &["bake", "evil.sabi", "--mesh", "cube.glb", "-o", "out", "--log", "debug"],
        &["no-such-command", name],
    ] {
        let run = place.sabi(arguments);
        for (stream, text) in [("stdout", &run.stdout), ("stderr", &run.stderr)] {
            let odd = text
                .chars()
                .find(|c| *c != '\n' && (c.is_control() || *c == '\u{202e}'));
            assert_eq!(odd, None, "{arguments:?} {stream}: {text}");
            for line in text.lines() {
                let start = line.trim_start();
                assert!(
                    !start.starts_with("openjd_") && !start.starts_with("::") && !line.contains("##vso["),
                    "{arguments:?} {stream}: {text}"
                );
            }
        }
    }
}

#[test]
fn links_and_pipes_in_an_output_folder_lead_nowhere() {
    let place = CliFolder::new();
    fs::create_dir_all(place.path("elsewhere")).unwrap();
    let refused = |what: &str, words: &str| {
        let run = place.bake("clouds.sabi", "cube.glb", &[]).fails(73);
        let sentence = format!("error: cannot write into out: {what} is {words}; remove it");
        assert!(run.stderr.starts_with(&sentence), "{}", run.stderr);
        assert!(place.listing("elsewhere").is_empty());
        fs::remove_dir_all(place.path("out")).unwrap();
    };
    fs::create_dir(place.path("out")).unwrap();
    symlink(place.path("elsewhere"), place.path("out/.sabi")).unwrap();
    refused("out/.sabi", "no folder but a link or a file");
    fs::create_dir_all(place.path("out/.sabi")).unwrap();
    let made = Command::new("mkfifo")
        .arg(place.path("out/.sabi/lock"))
        .status()
        .unwrap();
    assert!(made.success());
    refused("out/.sabi/lock", "no ordinary file but a link or a pipe");
    fs::create_dir_all(place.path("out/.sabi")).unwrap();
    symlink(place.path("elsewhere/lock"), place.path("out/.sabi/lock")).unwrap();
    refused("out/.sabi/lock", "no ordinary file but a link or a pipe");
    // The list of bakes is replaced, and its link is not followed.
    fs::create_dir_all(place.path("out/.sabi")).unwrap();
    symlink(place.path("elsewhere/bakes.json"), place.path("out/.sabi/bakes.json")).unwrap();
    place.bake("clouds.sabi", "cube.glb", &[]).good();
    assert!(place.listing("elsewhere").is_empty());
    assert!(
        fs::symlink_metadata(place.path("out/.sabi/bakes.json"))
            .unwrap()
            .is_file()
    );
}

#[test]
fn a_bake_says_that_it_waits_for_another_one_and_hears_a_signal_then() {
    software_adapter();
    let place = CliFolder::new();
    fs::create_dir_all(place.path("out/.sabi")).unwrap();
    let lock = File::create(place.path("out/.sabi/lock")).unwrap();
    lock.lock().unwrap();
    let arguments = [
        "bake",
        "clouds.sabi",
        "--mesh",
        "cube.glb",
        "-o",
        "out",
        "--size",
        "64",
        "--adapter",
        "cpu",
        "--force",
    ];
    let mut command = place.command(&arguments);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut words = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains("waiting for another bake, which writes into out") {
        line.clear();
        assert_ne!(words.read_line(&mut line).unwrap(), 0, "it ended without waiting");
    }
    let sent = Command::new("kill").args(["-TERM", &child.id().to_string()]).status();
    assert!(sent.unwrap().success());
    let mut said = String::new();
    words.read_to_string(&mut said).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(143), "{said}");
    assert_eq!(place.listing("out/.sabi"), ["lock"]);
    assert_eq!(place.listing("out"), [".sabi"], "no map is left");
}

#[test]
fn a_record_that_names_another_computer_is_not_followed() {
    let place = CliFolder::new();
    place.bake("clouds.sabi", "cube.glb", &[]).good();
    let good = String::from_utf8(place.read("out/.sabi/bakes.json")).unwrap();
    place.sabi(&["verify", "out"]).good();
    let mut forged: Value = serde_json::from_str(&good).unwrap();
    forged["bakes"][0]["inputs"][0]["path"] = json!(r"\\host\share\cube.glb");
    place.write("out/.sabi/bakes.json", forged.to_string());
    let told = place.sabi(&["verify", "out"]).fails(65).stderr;
    assert!(told.contains("on another computer and is not looked for"), "{told}");
    let mut forged: Value = serde_json::from_str(&good).unwrap();
    forged["bakes"][0]["outputs"][0]["path"] = json!("../cube.glb");
    place.write("out/.sabi/bakes.json", forged.to_string());
    let told = place.sabi(&["verify", "out"]).fails(65).stderr;
    assert!(
        told.contains("it names the map ../cube.glb, which is in another folder"),
        "{told}"
    );
}

#[test]
fn a_name_with_a_line_break_is_no_second_command() {
    let place = CliFolder::new();
    place.write(
        "matrix.toml",
        "version = 1\nout = \"out\"\n[[bake]]\nmodels = \"cube.glb\"\ngraphs = \"clouds.sabi\"\n",
    );
    let before = place.listing(".");
    for name in ["a\ntouch evil\n.jsonl", "a\nopenjd_env: X=y.jsonl", "lnosj.\u{202e}a"] {
        for format in ["commands", "slurm", "openjd"] {
            let refused = place
                .sabi(&["plan", "matrix.toml", "-o", name, "--format", format])
                .fails(73);
            let why = "its name has a line break or another character that is not shown; name another file";
            assert!(refused.stdout.is_empty() && refused.stderr.contains(why), "{refused:?}");
        }
    }
    assert_eq!(place.listing("."), before);
}

#[test]
fn a_pattern_that_names_the_whole_disk_again_and_again_is_walked_once() {
    let place = CliFolder::new();
    fs::create_dir_all(place.path("models/deep/deeper")).unwrap();
    fs::copy(place.path("cube.glb"), place.path("models/deep/deeper/cube.glb")).unwrap();
    symlink("..", place.path("models/deep/up")).unwrap();
    let matrix = |pattern: &str| {
        format!("version = 1\nout = \"out\"\n[[bake]]\nmodels = \"{pattern}\"\ngraphs = \"clouds.sabi\"\n")
    };
    let pattern = format!("models/{}*.glb", "**/".repeat(200));
    place.write("matrix.toml", matrix(&pattern));
    let planned = place.sabi(&["plan", "matrix.toml", "-o", "-"]).good();
    assert_eq!(planned.stdout.lines().count(), 1, "{}", planned.stdout);
}
