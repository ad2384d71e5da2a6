//! Example graphs: each has no faults, bakes on the model it was made for, and looks different in every variant.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;

use serde_json::Value as Json;

use crate::cli_folder::CliFolder;

fn examples() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../graphs");
    let folders = [folder.clone(), folder.join("thesis")];
    let files = folders
        .iter()
        .flat_map(|folder| fs::read_dir(folder).unwrap())
        .map(|entry| entry.unwrap().path());
    let mut graphs: Vec<PathBuf> = files
        .filter(|path| path.extension().is_some_and(|ending| ending == "sabi"))
        .collect();
    graphs.sort();
    assert!(graphs.len() >= 9, "only {} example graphs were found", graphs.len());
    graphs
}

#[test]
fn every_example_is_good() {
    let place = CliFolder::new();
    for graph in examples() {
        let run = place.sabi(&["check", graph.to_str().unwrap()]).good();
        assert!(run.stdout.contains(": good, ") && run.stderr.is_empty(), "{run:?}");
    }
}

#[test]
fn every_variant_of_an_example_bakes_without_a_warning_and_looks_different() {
    // The driver compiles on one core for most of the time: without a second thread, this test would end long after all others.
    let graphs = examples();
    thread::scope(|scope| {
        for some in graphs.chunks(graphs.len().div_ceil(2)) {
            scope.spawn(|| variants_look_different(some));
        }
    });
}

/// Bakes all variants of some graphs.
fn variants_look_different(graphs: &[PathBuf]) {
    let place = CliFolder::new();
    for graph in graphs {
        let text = fs::read_to_string(graph).unwrap();
        let document: Json = serde_json::from_str(&text).unwrap();
        let mesh = graph
            .parent()
            .unwrap()
            .join(document["preview"]["mesh"].as_str().unwrap());
        let variants = document["variants"].as_object().unwrap().keys();
        let looks: Vec<Option<&String>> = std::iter::once(None).chain(variants.map(Some)).collect();
        let mut seen = BTreeSet::new();
        for look in &looks {
            // A map that another variant has and this one does not have would be reported as a warning.
            if place.path("out").exists() {
                fs::remove_dir_all(place.path("out")).unwrap();
            }
            let mut more = vec!["--force", "--all-maps"];
            if let Some(variant) = look {
                more.extend(["--variant", variant]);
            }
            let run = place
                .bake(graph.to_str().unwrap(), mesh.to_str().unwrap(), &more)
                .good();
            // Warnings about small maps and about UVs that cover little of the sheet are not faults of the graph.
            let is_of_model = |line: &str| line.contains("UV chart") || line.contains("of its maps, so that");
            let warnings = run
                .stderr
                .lines()
                .filter(|line| line.starts_with("warning") && !is_of_model(line));
            assert_eq!(warnings.count(), 0, "{}", run.stderr);
            let maps = run.stdout.lines().filter(|path| path.ends_with(".png"));
            let bytes: Vec<u8> = maps.flat_map(|path| fs::read(place.path(path)).unwrap()).collect();
            seen.insert(bytes);
        }
        assert_eq!(seen.len(), looks.len(), "variants of {} look the same", graph.display());
    }
}
