//! Whole bakes, requested as by the command line.

use std::fs;
use std::path::{Path, PathBuf};

use sabi_engine::baking::{BakeReport, BakeRequest, Seams, bake};
use sabi_engine::opening::linked_model::ModelOptions;
use sabi_engine::phases::NoProgress;
use serde_json::Value as Json;
use tempfile::TempDir;

use crate::device::adapter;

/// Output of a bake; its files are deleted when this is dropped.
pub struct BakeOutput {
    // Removed when this is dropped.
    _folder: TempDir,
    output: PathBuf,
    /// The report.
    pub report: Json,
}

impl BakeOutput {
    /// Bakes a graph of built-in kinds on a model, on the adapter of all tests, with padding everywhere.
    ///
    /// # Panics
    /// If it fails.
    pub fn new(graph: &str, mesh: &Path, size: u32) -> BakeOutput {
        BakeOutput::with_seams(graph, mesh, size, Seams::Erase)
    }

    /// The same, with the differences at seams erased or kept.
    ///
    /// # Panics
    /// If it fails.
    pub fn with_seams(graph: &str, mesh: &Path, size: u32, seams: Seams) -> BakeOutput {
        BakeOutput::of(graph, ModelOptions::new(mesh, size), seams)
    }

    /// The same on a model that is taken in a certain way.
    ///
    /// # Panics
    /// If it fails.
    pub fn of(graph: &str, model: ModelOptions, seams: Seams) -> BakeOutput {
        let folder = tempfile::tempdir().expect("a folder for maps");
        let (path, output) = (folder.path().join("test.sabi"), folder.path().join("out"));
        fs::write(&path, graph).expect("the graph's file");
        let mut request = BakeRequest {
            output: output.clone(),
            padding: None,
            seams,
            ..BakeRequest::plain(&path, &model.path, model.size)
        };
        request.evaluator.model = model;
        request.evaluator.adapter = adapter();
        let baked = bake(&request, &NoProgress).unwrap_or_else(|error| panic!("{error}\n{graph}"));
        BakeOutput {
            _folder: folder,
            output,
            report: report_file(&baked),
        }
    }

    /// Returns the bytes of a map, given its channel and extension: `roughness.png`.
    ///
    /// # Panics
    /// If it was not written.
    pub fn map(&self, name: &str) -> Vec<u8> {
        let files = fs::read_dir(&self.output).expect("the output folder").flatten();
        let ending = format!("_{name}");
        let found = files
            .map(|file| file.path())
            .find(|path| path.to_string_lossy().ends_with(&ending));
        let path = found.unwrap_or_else(|| panic!("no map '{name}' among {}", self.report["outputs"]));
        fs::read(path).expect("a map")
    }
}

/// Returns the report of a bake as it is in its file.
///
/// # Panics
/// If it cannot be written as JSON.
pub fn report_file(report: &BakeReport) -> Json {
    let text = serde_json::to_string(report).expect("plain data");
    serde_json::from_str(&text).expect("JSON")
}
