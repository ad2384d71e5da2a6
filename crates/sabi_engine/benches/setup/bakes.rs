//! Graphs and bakes that benches measure.

use std::fs;
use std::path::{Path, PathBuf};

use sabi_engine::baking::{BakeRequest, Seams};
use sabi_engine::evaluating::EvaluatorOptions;
use sabi_engine::opening::linked_model::ModelOptions;
use sabi_files::Disk;
use sabi_gpu::{AdapterChoice, CasterChoice, DEFAULT_BUDGET_BYTES};
use sabi_graph::Overrides;

/// Writes a graph of some nodes.
pub(crate) fn graph(folder: &Path, name: &str, nodes: &str) -> PathBuf {
    let path = folder.join(name);
    fs::write(
        &path,
        format!(r#"{{ "format": "sabi", "version": 1, "name": "bench", "nodes": {{ {nodes} }} }}"#),
    )
    .unwrap();
    path
}

/// A bake into `out` of a folder, without options.
pub(crate) fn request(folder: &Path, graph: PathBuf, model: ModelOptions, adapter: AdapterChoice) -> BakeRequest {
    BakeRequest {
        graph,
        evaluator: EvaluatorOptions {
            model,
            overrides: Overrides::default(),
            fit: None,
            adapter,
            caster: CasterChoice::Auto,
            budget_bytes: DEFAULT_BUDGET_BYTES,
        },
        output: folder.join("out"),
        report: None,
        disk: Disk::default(),
        presets: Vec::new(),
        preset_folder: None,
        names: None,
        channels: Vec::new(),
        mesh_maps: Vec::new(),
        material: None,
        all_maps: false,
        padding: None,
        seams: Seams::Erase,
        fuse: true,
        force: true,
        model: None,
    }
}
