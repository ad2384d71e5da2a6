//! A session: open, evaluate, preview, bake, watch; what the command line and the editor call.
//!
//! [`Evaluator::open`] brings a graph and a model together; [`bake`] and [`preview`] are what is done with them.

mod baking;
pub mod catalog;
#[cfg(test)]
mod documented;
mod error;
mod evaluating;
mod live;
mod opening;
mod phases;
mod remedy;
mod rendering;
mod session;
mod source;
mod warning;

// Progress, times, errors, warnings and what helps against them.
pub use error::{EngineError, ErrorKind};
pub use phases::{NoProgress, Phase, PhaseTime, PhaseTimes, Progress};
pub use remedy::{Remedy, advised};
pub use warning::Warning;

// Opening graphs, models and environments.
pub use opening::cache_dir::default_cache_dir;
pub use opening::document::OpenGraph;
pub use opening::environment::{built_in_environments, load_environment, read_panorama};
pub use opening::kinds::Kinds;
pub use opening::linked_model::{FittedModel, LinkedModel, ModelOptions, Overlap, Unwrapping};
pub use opening::setting::read_setting;
pub use source::pictures::Pictures;

// Evaluating a graph on a model.
pub use evaluating::evaluator::{Evaluator, EvaluatorOptions, RaySettings};
pub use evaluating::looks::{ModelLooks, evaluate_looks};
pub use evaluating::texture_sets::TextureSet;
pub use evaluating::texture_space::{PlaneKind, ResultPlane};
pub use evaluating::thumbnail::{find_thumbnail, keep_thumbnail, thumbnail_of};

// Evaluating a graph while it is edited.
pub use live::{
    BlockedNode, Faults, Inspected, Live, LiveEvent, LiveModel, LiveOptions, LiveRequest, LiveTimes, NodeFault,
    ViewSubject,
};

// Baking texture sets.
pub use baking::bake::{bake, bake_graph, needs_force};
pub use baking::bake_request::{
    BakeRequest, DEFAULT_NAMES, default_padding, export_channels, export_presets, why_no_names,
};
pub use baking::report::{BakeAdapter, BakeReport, BakedMesh, CopiedFileReport, ModelCopyReport};
pub use baking::seams::Seams;

// Rendering pictures.
pub use rendering::displace::Triangles;
pub use rendering::preview::{PreviewRequest, preview};
pub use rendering::render::{RenderRequest, Turns, render};

// Describing node kinds, models and this machine.
pub use catalog::check::{CheckReport, check};
pub use catalog::description::{
    InputDescription, NodeDescription, OutputDescription, ParamDescription, describe_nodes,
};
pub use catalog::diagnosis::{AdapterDescription, Diagnosis, diagnose};
pub use catalog::node_file::{
    NodeDraft, NodeTextFault, check_node, new_node_folder, node_text_like, read_node, why_no_node_id,
};
pub use opening::mesh_report::{MeshReport, UnwrappingReport, describe_mesh};
pub use opening::overlap::{MaterialOverlap, OverlapReport, SharedPairs};

// Sessions: edits, files and what watches them.
pub use session::watch::{Changes, Watched, Watcher};
pub use session::{FileState, Recovery, Session, free_graph_file, moved_to, recoveries, with_whole_paths};

// Types of other crates that stand in this interface.
pub use sabi_export::{ConstantRecord, OutputRecord, SetKey};
pub use sabi_files::{
    FileError, NotText, PathBase, WholeFile, canonical, io_reason, path_from_stored, path_text, stored, stored_path,
    write_whole,
};
pub use sabi_gpu::{
    AdapterChoice, AdapterKind, CasterChoice, DEFAULT_BUDGET_BYTES, Gpu, Hits, choose_adapter, device_descriptor,
};
pub use sabi_graph::{Fit, NodeRef, Overrides, Value, nearest};
pub use sabi_nodes::arithmetic;
pub use sabi_surface::load::Up;
/// Viewport: cameras, lights, environments and the renderer.
pub use sabi_view as view;
