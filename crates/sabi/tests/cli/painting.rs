//! Strokes without a window: bakes without them, removal of their history, and transfer to another model.

use std::fs;
use std::path::Path;

use serde_json::Value as Json;

use crate::cli_folder::{CliFolder, software_adapter};

fn json(text: &str) -> Json {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Creates a folder with a column, a barrel, and a graph that was painted on the column.
fn painted() -> CliFolder {
    let place = CliFolder::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for model in ["column.glb", "barrel.glb"] {
        fs::copy(root.join("assets/meshes").join(model), place.path(model)).unwrap();
    }
    let text = fs::read_to_string(root.join("graphs/thesis/scratched-column.sabi")).unwrap();
    let graph: Json = serde_json::from_str(&text).unwrap();
    let strokes = &graph["nodes"]["hand"]["params"]["strokes"];
    place.write(
        "worn.sabi",
        format!(
            r#"{{ "format": "sabi", "version": 1, "nodes": {{
  "hand": {{ "kind": "source/paint", "params": {{ "strokes": {strokes} }}, "pos": [0, 0] }},
  "none": {{ "kind": "source/paint", "params": {{ "empty": 0.25 }}, "pos": [0, 300] }}
}} }}"#
        ),
    );
    fs::create_dir(place.path("worn.paint")).unwrap();
    fs::copy(
        root.join("graphs/thesis/scratched-column.paint/column.strokes"),
        place.path("worn.paint/column.strokes"),
    )
    .unwrap();
    place
}

/// Returns the pixels of the mask of the painted node, and the messages.
fn mask(place: &CliFolder, model: &str, more: &[&str]) -> (Vec<u8>, String) {
    software_adapter();
    let usual = [
        "preview",
        "worn.sabi",
        "--mesh",
        model,
        "--node",
        "hand",
        "-o",
        "mask.png",
        "--size",
        "128",
        "--adapter",
        "cpu",
    ];
    let _ = fs::remove_file(place.path("mask.png"));
    let done = place.sabi(&[&usual[..], more].concat()).good();
    (place.read("mask.png"), done.stderr)
}

#[test]
fn paint_is_left_out_on_demand_without_a_warning() {
    let place = painted();
    let (with, _) = mask(&place, "column.glb", &[]);
    let (without, said) = mask(&place, "column.glb", &["--no-paint"]);
    assert!(with != without);
    assert_eq!(said, "");
    fs::remove_dir_all(place.path("worn.paint")).unwrap();
    let (missing, said) = mask(&place, "column.glb", &[]);
    assert!(missing == without);
    assert!(said.contains("its strokes are not in"), "{said}");
}

#[test]
fn strokes_without_their_history_give_the_same_mask() {
    let place = painted();
    let (before, _) = mask(&place, "column.glb", &[]);
    let file = "worn.paint/column.strokes";
    let (graph, strokes) = (place.read("worn.sabi"), place.read(file));
    let trial = json(
        &place
            .sabi(&["paint", "flatten", "worn.sabi", "--dry-run", "--json"])
            .good()
            .stdout,
    );
    assert!((place.read("worn.sabi"), place.read(file)) == (graph, strokes.clone()));
    let report = json(&place.sabi(&["paint", "flatten", "worn.sabi", "--json"]).good().stdout);
    assert_eq!(report, trial);
    let flattened = place.read(file);
    assert_eq!(report["files"][0]["bytes"], flattened.len());
    assert!(place.read("worn.paint/column.strokes.bak") == strokes);
    assert!(mask(&place, "column.glb", &[]) == (before, String::new()));
    place.sabi(&["paint", "flatten", "worn.sabi"]).good();
    assert!(
        place.read("worn.paint/column.strokes.bak") == strokes,
        "the first copy stays"
    );
    assert!(place.path("worn.paint/column.strokes.bak2").exists());
    place.write(file, &strokes[..strokes.len() - 9]);
    let damaged = place.sabi(&["paint", "flatten", "worn.sabi"]).fails(65);
    assert!(
        damaged.stderr.contains("is damaged") && damaged.stderr.contains("repair it from a copy"),
        "{}",
        damaged.stderr
    );
}

#[test]
fn strokes_are_laid_on_another_model_and_lost_places_are_told() {
    let place = painted();
    fs::copy(place.path("column.glb"), place.path("edited.glb")).unwrap();
    let (own, _) = mask(&place, "column.glb", &[]);
    let (_, said) = mask(&place, "edited.glb", &[]);
    assert!(
        said.contains("is empty on 'edited': it was painted on column"),
        "{said}"
    );
    let run = place
        .sabi(&["paint", "reproject", "worn.sabi", "--mesh", "edited.glb"])
        .good();
    assert!(run.stdout.ends_with("from 'column' on 'edited'\n"), "{}", run.stdout);
    assert_eq!(run.stderr, "");
    for model in ["edited.glb", "column.glb"] {
        assert!(mask(&place, model, &[]) == (own.clone(), String::new()), "{model}");
    }
    // Strokes that are already on the other model are dropped only if the user asks for it.
    let larger = [
        "paint",
        "reproject",
        "worn.sabi",
        "--mesh",
        "edited.glb",
        "--scale",
        "1.06",
        "--from",
        "column",
    ];
    let graph = place.read("worn.sabi");
    let refused = place.sabi(&larger).fails(65);
    assert!(
        refused.stderr.contains("was painted on 'edited' already") && refused.stderr.contains("--replace"),
        "{}",
        refused.stderr
    );
    assert!(place.read("worn.sabi") == graph);
    let run = place.sabi(&[&larger[..], &["--replace"]].concat()).good();
    let lost = "are lost, since 'edited' has no surface near them";
    assert!(
        run.stderr.contains("warning: node 'hand': ") && run.stderr.contains(lost),
        "{}",
        run.stderr
    );
    let wrong = [
        "paint",
        "reproject",
        "worn.sabi",
        "--mesh",
        "barrel.glb",
        "--from",
        "crate",
    ];
    let refused = place.sabi(&wrong).fails(66);
    assert_eq!(
        refused.stderr,
        "error: worn.sabi: nothing is painted on 'crate'; strokes are on column, edited\n"
    );
}

#[test]
fn a_model_on_which_all_strokes_would_be_lost_changes_nothing() {
    let place = painted();
    // The same column, a hundred times as large.
    place.write(
        "column.obj",
        "v 0 0 0\nv 100 0 0\nv 0 100 0\nv 900 900 900\nvt 0 0\nvt 1 0\nvt 0 1\nf 2/1 4/2 3/3\n",
    );
    let graph = place.read("worn.sabi");
    let refused = place
        .sabi(&["paint", "reproject", "worn.sabi", "--mesh", "column.obj"])
        .fails(65);
    assert!(
        refused.stderr.contains("would lose all of its") && refused.stderr.contains("nothing was changed"),
        "{}",
        refused.stderr
    );
    assert!(place.read("worn.sabi") == graph);
}
