//! Report of a bake, for people and for scripts.

use std::collections::BTreeMap;

use sabi_export::{ConstantRecord, EngineMemory, LookChange, OutputRecord};
use serde::Serialize;

use crate::opening::mesh_report::{DecodedUvs, UnwrappingReport};
use crate::opening::overlap::OverlapReport;
use crate::phases::PhaseTimes;
use crate::warning::Warning;

/// Report of a bake; docs/report.md lists the keys of its file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BakeReport {
    /// Version of Sabi.
    pub sabi: &'static str,
    /// Path of the graph as it was given.
    pub graph: String,
    /// The model.
    pub mesh: BakedMesh,
    /// Adapter that ran the graph.
    pub adapter: BakeAdapter,
    /// Texels along a side of the maps.
    pub size: u32,
    /// Nodes that results depend on, after groups are inlined.
    pub nodes: usize,
    /// Kernels of the graph.
    pub passes: usize,
    /// Kernels that only exports need.
    pub finish_passes: usize,
    /// Ids of nodes that share a kernel, a list for each kernel of more than one.
    pub fused: Vec<Vec<String>>,
    /// Most bytes that textures took at a time.
    pub peak_texture_bytes: u64,
    /// True if the atlas was read from the cache.
    pub atlas_cached: bool,
    /// Ids of nodes whose rays were read from the cache.
    pub rays_cached: Vec<String>,
    /// True if the unwrapping was read from the cache; `None` where the model's own UVs are used.
    pub unwrapping_cached: Option<bool>,
    /// Times of the phases.
    #[serde(rename = "stages_ms")]
    pub times: PhaseTimes,
    /// Milliseconds by node.
    pub nodes_ms: BTreeMap<String, f64>,
    /// Maps that were written.
    pub outputs: Vec<OutputRecord>,
    /// Memory of the maps in an engine.
    pub engine: EngineMemory,
    /// Channels without a map because they are the same everywhere.
    pub constants: Vec<ConstantRecord>,
    /// Warnings for the artist, as sentences with their remedies.
    pub warnings: Vec<Warning>,
    /// Copy of the model that uses the maps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub model: Option<ModelCopyReport>,
    /// Names of all files that were written.
    #[serde(skip)]
    pub files: Vec<String>,
}

/// The model of a bake.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BakedMesh {
    /// Path of the model as it was given.
    pub file: String,
    /// Triangles of all parts.
    pub triangles: usize,
    /// Charts of the atlas.
    pub charts: usize,
    /// Share of the atlas that charts cover.
    pub coverage: f64,
    /// Lowest and highest place of the model along its axes, in the units of its file.
    pub bounds: [[f32; 3]; 2],
    /// Charts that share places on the maps.
    pub overlap: OverlapReport,
    /// Results of unwrapping the model; `None` where its own UVs are used.
    pub unwrapped: Option<UnwrappingReport>,
    /// UVs that the file stores under a transform.
    pub decoded_uvs: Vec<DecodedUvs>,
    /// Angle between faces up to which the shading was smoothed, degrees; `None` for the normals of the file.
    pub smooth_degrees: Option<f32>,
}

/// The adapter of a bake.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BakeAdapter {
    /// Name as the driver gives it.
    pub name: String,
    /// `cpu`, `integrated` or `discrete`.
    pub kind: String,
}

/// The copy of the model that uses the maps, with the files it needs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ModelCopyReport {
    /// The model's file.
    #[serde(flatten)]
    pub copy: CopiedFileReport,
    /// Files beside it.
    pub files: Vec<CopiedFileReport>,
    /// Changes of the looks of the materials that got maps.
    pub changes: Vec<LookChange>,
}

/// A file of a model's copy.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct CopiedFileReport {
    /// The file, relative to the output folder.
    pub path: String,
    /// BLAKE3 of the file's bytes, hexadecimal.
    pub blake3: String,
}
