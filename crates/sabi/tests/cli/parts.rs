//! Choice of the parts of a model, and turned faces, in every command that names a model.

use std::fmt::Write as _;

use serde_json::Value as Json;

use crate::cli_folder::{CLOUDS, CliFolder, graph, software_adapter};

/// Squares of side 1 beside each other, each a part with a material of its own; the hull is a hundred times as large.
const PARTS: [&str; 4] = ["Rock_LOD0", "Rock_LOD1", "UCX_Rock", "Moss"];

fn rock() -> String {
    let mut text = String::from("vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n");
    for (number, name) in PARTS.iter().enumerate() {
        let (left, side) = (number as f32, if *name == "UCX_Rock" { 100.0 } else { 1.0 });
        let right = left + side;
        writeln!(
            text,
            "v {left} 0 0\nv {right} 0 0\nv {right} {side} 0\nv {left} {side} 0"
        )
        .unwrap();
        let corner = |corner: usize| format!("{}/{}", 4 * number + corner, corner);
        writeln!(
            text,
            "o {name}\nusemtl {name}\nf {} {} {} {}",
            corner(1),
            corner(2),
            corner(3),
            corner(4)
        )
        .unwrap();
    }
    text
}

/// Cube of triangles, each square in a cell of its own on the UVs, with the triangles of these squares inside out.
fn cube(turned: &[usize]) -> String {
    let mut text = String::new();
    for corner in 0..8 {
        let [x, y, z] = [0, 1, 2].map(|axis| corner >> axis & 1);
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    let squares = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    for (number, square) in squares.into_iter().enumerate() {
        let left = number as f32 / 6.0;
        for [u, v] in [[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.1, 0.9]] {
            writeln!(text, "vt {} {v}", left + u / 6.0).unwrap();
        }
        let corner = |at: usize| format!("{}/{}", square[at] + 1, 4 * number + at + 1);
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
            let [b, c] = if turned.contains(&number) { [c, b] } else { [b, c] };
            writeln!(text, "f {} {} {}", corner(a), corner(b), corner(c)).unwrap();
        }
    }
    text
}

fn with_models() -> CliFolder {
    let place = CliFolder::new();
    place.write("rock.obj", rock());
    place.write("cube.obj", cube(&[1, 4]));
    place
}

fn described(place: &CliFolder, model: &str, more: &[&str]) -> Json {
    let run = place.sabi(&[&["mesh", model, "--size", "64", "--json"], more].concat());
    serde_json::from_str(&run.good().stdout).unwrap()
}

#[test]
fn parts_are_left_out_by_their_names_with_a_warning_that_says_how_to_keep_them() {
    let place = with_models();
    let told = place.sabi(&["mesh", "rock.obj", "--size", "64"]).good().stderr;
    let warning = "`Rock_LOD1` and `UCX_Rock` are left out, since their names say that they are collision hulls or coarser levels of \
                   detail; take all parts with --parts '*'";
    assert!(told.contains(warning), "{told}");
    let mesh = described(&place, "rock.obj", &[]);
    assert_eq!(mesh["parts"], serde_json::json!(["Rock_LOD0", "Moss"]));
    assert_eq!(mesh["parts_left_out"], serde_json::json!(["Rock_LOD1", "UCX_Rock"]));
    assert_eq!(mesh["largest_side"], 4.0, "the hull does not count");
    let all = described(&place, "rock.obj", &["--parts", "*"]);
    assert_eq!(all["parts"], serde_json::json!(PARTS));
    let some = described(&place, "rock.obj", &["--parts", "Rock_*,Moss", "--without", "*_LOD0"]);
    assert_eq!(some["parts"], serde_json::json!(["Rock_LOD1", "Moss"]));
}

#[test]
fn a_name_that_no_part_has_is_told_with_the_nearest() {
    let place = with_models();
    let wrong = place.sabi(&["mesh", "rock.obj", "--parts", "Rok_LOD0,Mos", "--without", "Wheel"]);
    let told = wrong.fails(2).stderr;
    for sentence in [
        "rock.obj: it has no part `Rok_LOD0`; the nearest is `Rock_LOD0`",
        "rock.obj: it has no part `Mos`; the nearest is `Moss`",
        "rock.obj: it has no part `Wheel`; it has `Moss`, `Rock_LOD0`, `Rock_LOD1` and `UCX_Rock`",
    ] {
        assert!(told.contains(sentence), "{told}");
    }
}

/// Graph that is made for the rock, without its moss.
fn rust_on_rock() -> String {
    let preview = r#""preview": { "mesh": "rock.obj", "without": ["Moss"] },"#;
    graph(CLOUDS).replacen("\"nodes\"", &format!("{preview}\n  \"nodes\""), 1)
}

fn left_out(report: &[u8]) -> Json {
    let report: Json = serde_json::from_slice(report).unwrap();
    report["mesh"]["parts_left_out"].clone()
}

#[test]
fn a_graph_keeps_which_parts_of_its_own_model_count() {
    software_adapter();
    let place = with_models();
    place.write("rock.sabi", rust_on_rock());
    place.write("other.obj", rock());
    let usual = serde_json::json!(["Rock_LOD1", "UCX_Rock"]);
    let without_moss = serde_json::json!(["Rock_LOD1", "UCX_Rock", "Moss"]);
    let cases: [(&str, &[&str], &Json); 4] = [
        ("rock.obj", &[], &without_moss),
        ("other.obj", &[], &usual),
        (
            "rock.obj",
            &["--without", "Rock_LOD0"],
            &serde_json::json!(["Rock_LOD0", "Rock_LOD1", "UCX_Rock"]),
        ),
        ("rock.obj", &["--parts", "*"], &serde_json::json!([])),
    ];
    for (model, more, expected) in cases {
        let run = place.bake(
            "rock.sabi",
            model,
            &[more, &["--size", "16", "--json", "--force"]].concat(),
        );
        assert_eq!(left_out(run.good().stdout.as_bytes()), *expected, "{model} {more:?}");
    }
    // The archive names its model and the same options for it.
    let pack = |more: &[&str]| place.sabi(&[&["pack", "rock.sabi", "--force", "-o", "rock.zip"], more].concat());
    for (more, expected) in [
        (&[][..], &without_moss),
        (&["--mesh", "other.obj"], &usual),
        (&["--parts", "*"], &serde_json::json!([])),
    ] {
        pack(more).good();
        place.sabi(&["unpack", "rock.zip", "-o", "there"]).good();
        let model = if more.contains(&"other.obj") {
            "there/other.obj"
        } else {
            "there/rock.obj"
        };
        let run = place.bake("there/rock.sabi", model, &["--size", "16", "--json", "--force"]);
        assert_eq!(left_out(run.good().stdout.as_bytes()), *expected, "{more:?}");
        std::fs::remove_dir_all(place.path("there")).unwrap();
    }
    let wrong = pack(&["--without", "Mos"]).fails(2).stderr;
    assert!(wrong.contains("the nearest is `Moss`"), "{wrong}");
}

#[test]
fn a_report_and_a_matrix_have_the_choice_of_parts() {
    software_adapter();
    let place = with_models();
    let more = [
        "--without",
        "Moss",
        "--turn-faces",
        "--size",
        "16",
        "--report",
        "first.json",
    ];
    place.bake("rust.sabi", "rock.obj", &more).good();
    let again = ["bake", "--from", "first.json", "-o", "again", "--report", "again.json"];
    place.sabi(&again).good();
    assert_eq!(left_out(&place.read("again.json")), left_out(&place.read("first.json")));
    assert_eq!(
        left_out(&place.read("first.json")),
        serde_json::json!(["Rock_LOD1", "UCX_Rock", "Moss"])
    );
    let matrix = "version = 1\nout = \"maps\"\n[[bake]]\ngraphs = [\"rust.sabi\"]\nmodels = [\"rock.obj\"]\nsizes = [16]\n\
                  parts = [\"Moss\"]\nturn_faces = true\n";
    place.write("matrix.toml", matrix);
    place.sabi(&["plan", "matrix.toml"]).good();
    place.sabi(&["run", "plan.jsonl", "--adapter", "cpu"]).good();
    let record: Json = serde_json::from_slice(&place.read("maps/.sabi/bakes.json")).unwrap();
    assert_eq!(
        record["bakes"][0]["mesh"]["parts_left_out"],
        serde_json::json!(["Rock_LOD0", "Rock_LOD1", "UCX_Rock"])
    );
}

#[test]
fn faces_that_are_inside_out_are_counted_and_turned() {
    software_adapter();
    let place = with_models();
    let mesh = described(&place, "cube.obj", &[]);
    assert_eq!(
        (&mesh["inside_out_faces"], &mesh["turned_faces"]),
        (&4.into(), &0.into())
    );
    let mesh = described(&place, "cube.obj", &["--turn-faces"]);
    assert_eq!(
        (&mesh["inside_out_faces"], &mesh["turned_faces"]),
        (&0.into(), &4.into())
    );
    place.write("good.obj", cube(&[]));
    let bake = |model: &str, more: &[&str]| {
        let wanted = ["--mesh-map", "ambient_occlusion", "--size", "64", "--force"];
        place.bake("rust.sabi", model, &[&wanted[..], more].concat()).good()
    };
    let told = bake("cube.obj", &[]).stderr;
    let warning = "4 of 12 faces of the model are inside out, against the faces around them or inward, so edges and creases are \
                   swapped there and they count as enclosed; turn them around with --turn-faces";
    assert!(told.contains(warning), "{told}");
    let told = bake("cube.obj", &["--turn-faces"]).stderr;
    assert!(!told.contains("inside out"), "{told}");
    let told = bake("good.obj", &[]).stderr;
    assert!(!told.contains("inside out"), "{told}");
}

#[test]
fn the_command_line_decides_whether_faces_of_a_graphs_own_model_are_turned() {
    software_adapter();
    let place = with_models();
    let preview = r#""preview": { "mesh": "cube.obj", "turn_faces": true },"#;
    let turning = graph(CLOUDS).replacen("\"nodes\"", &format!("{preview}\n  \"nodes\""), 1);
    place.write("turning.sabi", turning);
    let turned = |report: &[u8]| {
        let report: Json = serde_json::from_slice(report).unwrap();
        report["mesh"]["turned_faces"].clone()
    };
    for (more, expected) in [(&[][..], 4), (&["--turn-faces"], 4), (&["--no-turn-faces"], 0)] {
        let more = [more, &["--size", "16", "--force", "--report", "first.json"]].concat();
        place.bake("turning.sabi", "cube.obj", &more).good();
        assert_eq!(turned(&place.read("first.json")), expected, "{more:?}");
        // The settings of a report are used again, even if the graph has others.
        let again = [
            "bake",
            "--from",
            "first.json",
            "-o",
            "again",
            "--report",
            "again.json",
            "--force",
        ];
        place.sabi(&again).good();
        assert_eq!(turned(&place.read("again.json")), expected, "{more:?}");
    }
}
