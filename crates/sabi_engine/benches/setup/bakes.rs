//! Graphs and bakes that benches measure.

use std::fs;
use std::path::{Path, PathBuf};

use sabi_engine::baking::{BakeRequest, Seams};
use sabi_engine::opening::linked_model::ModelOptions;
use sabi_gpu::AdapterChoice;

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
pub(crate) fn request(folder: &Path, graph: &Path, model: ModelOptions, adapter: AdapterChoice) -> BakeRequest {
    let mut request = BakeRequest {
        output: folder.join("out"),
        padding: None,
        seams: Seams::Erase,
        force: true,
        ..BakeRequest::plain(graph, &model.path, model.size)
    };
    request.evaluator.model = model;
    request.evaluator.adapter = adapter;
    request
}
