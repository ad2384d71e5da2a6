//! A graph on a model: opening, checking, evaluating, previewing, rendering and baking, for the command line and the editor.
//!
//! [`bake`], [`preview`] and [`render`] do their work in one call. [`Evaluator`] plans and runs a graph on a model, [`Live`] does
//! so while the graph is edited, and [`Session`] holds the edited graph with its history and its file.
//!
//! Invariants:
//! * The same graph, model, options and adapter give the same files, byte for byte.
//! * Files that belong together are replaced together: all of them, or none where one is refused, fails or is canceled.
//! * No model is loaded for a graph whose wanted results have a fault.
//! * Caches are looked up by the content that a result depends on: a cache changes the time that work takes, and no result.
//! * A result that a window received is never written again.
//! * Errors and warnings are sentences with remedies as values: nothing here names a flag or a button.
//! * Nothing here knows the command line, standard output or how progress is shown.
//!
//! ```
//! use std::path::Path;
//!
//! use sabi_engine::{Kinds, check, describe_nodes};
//!
//! let nodes = describe_nodes(&Kinds::builtin());
//! assert!(nodes.iter().any(|node| node.id == "noise/simplex"));
//!
//! // A check needs neither a model nor an adapter.
//! let graph = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../graphs/examples/army-paint.sabi");
//! let report = check(&graph)?;
//! assert_eq!((report.errors, report.warnings), (Vec::<String>::new(), Vec::<String>::new()));
//! # Ok::<(), sabi_engine::EngineError>(())
//! ```

mod baking;
mod batch;
pub mod catalog;
#[cfg(test)]
mod documented;
mod effect_library;
mod error;
mod evaluating;
mod faults;
mod graph_info;
mod live;
mod opening;
mod packing;
mod phases;
mod picked_gradient;
mod program;
mod program_cache;
mod remedy;
mod rendering;
mod session;
mod source;
mod stroke_chores;
mod warning;

// Progress, times, errors, warnings and what helps against them.
pub use error::{EngineError, ErrorKind};
pub use phases::{Activity, NoProgress, Phase, PhaseTime, PhaseTimes, Progress, SharedActivity};
pub use remedy::{Remedy, advised};
pub use warning::Warning;

// Opening graphs, models and environments.
pub use effect_library::{effect_library, group_digest, group_picture};
pub use opening::cache_dir::default_cache_dir;
pub use opening::document::OpenGraph;
pub use opening::environment::{built_in_environments, load_environment, read_panorama};
pub use opening::kinds::Kinds;
pub use opening::linked_model::{FittedModel, LinkedModel, ModelOptions, Overlap, SavedReading, Unwrapping};
pub use opening::set_file::SetFile;
pub use opening::setting::read_setting;
pub use picked_gradient::PickedPicture;
pub use source::paint::without_paint;
pub use source::pictures::Pictures;
pub use source::strokes::{FlattenedFile, Strokes, paint_folder};

// Evaluating a graph on a model.
pub use evaluating::evaluator::{Evaluator, EvaluatorOptions, RaySettings};
pub use evaluating::looks::{LooksIdentity, ModelLooks, evaluate_looks};
pub use evaluating::texture_sets::TextureSet;
pub use evaluating::texture_space::{PlaneKind, ResultPlane};
pub use evaluating::thumbnail::{load_thumbnail, store_thumbnail, thumbnail_of};

// Evaluating a graph while it is edited.
pub use live::{
    BlockedNode, Faults, GraphUpdate, Inspected, Live, LiveEvent, LiveModel, LiveOptions, LiveRequest, LiveTimes,
    NodeFault, Precedence, THUMBNAIL_VERSION, ViewSubject,
};

// Baking texture sets.
pub use baking::bake::{bake, bake_graph, needs_force};
pub use baking::bake_request::{
    BakeRequest, DEFAULT_PRESET, default_padding, export_channels, mesh_map_names, name_pattern_fault,
};
pub use baking::preset_description::{PresetDescription, PresetDocument, PresetFile, describe_preset};
pub use baking::preset_pictures::{PicturePart, PresetPicture, preset_pictures};
pub use baking::presets::{ListedPreset, default_preset_folder, export_presets, find_preset, preset_text};
pub use baking::report::{
    BakeAdapter, BakeReport, BakedMesh, Conventions, CopiedFileReport, ModelCopyReport, REPORT_VERSION,
};
pub use baking::seams::Seams;

// What sets of maps were made of: making them again, and checking them.
pub use baking::made_of::inputs::InputRecord;
pub use baking::made_of::recipe::{ModelRecipe, Recipe, SetRecipe};
pub use baking::recorded::manifest::{FinishedBake, finished_bake};
pub use baking::recorded::recorded_bake::RecordedBake;
pub use baking::recorded::verification::{Finding, FindingKind, Verification, verify_folder};
pub use program::Build;

// Baking many sets: a matrix, the plan that it becomes, and its items.
pub use batch::{BakeItem, BakePlan, InputHashes, ItemInput, ItemMachine, PlannedBakes, plan_bakes};

// Rendering pictures.
pub use rendering::density::Softness;
pub use rendering::displace::Triangles;
pub use rendering::preview::{PreviewRequest, preview, preview_graph};
pub use rendering::render::{RenderRequest, Turns, encode_picture, render, render_graph};
pub use rendering::stamp_square::{StampSquare, stamp_square};

// Describing graphs, node kinds, models and this machine.
pub use catalog::check::{CheckReport, CheckedGraph, check, check_graph};
pub use catalog::description::{
    InputDescription, NodeDescription, OutputDescription, ParamDescription, describe_nodes,
};
pub use catalog::diagnosis::{AdapterDescription, Diagnosis, diagnose};
pub use catalog::node_file::{
    NodeDraft, NodeTextFault, check_node, new_node_folder, new_node_text, node_id_fault, read_node,
};
pub use graph_info::graph_description::{
    GraphDescription, GraphOutput, GroupDescription, KnobDescription, VariantDescription, describe_graph,
};
pub use graph_info::graph_files::FileDescription;
pub use opening::memory::default_memory_bytes;
pub use opening::mesh_report::{DecodedUvs, MeshReport, UnwrappingReport, describe_mesh};
pub use opening::overlap::{MaterialOverlap, OverlapReport, SetOverlap, SetReport, SharedPairs};
pub use opening::stroke_report::{StrokeReport, VersionReport, describe_strokes};

// Sessions: edits, files and what watches them.
pub use session::watch::{Changes, Watched, Watcher};
pub use session::{
    BACKUPS, FileState, Keeping, Recovery, Session, document_with_paths, free_graph_file, is_open_in_a_window,
    recoveries, recoveries_in_use, relocate_paths, with_absolute_paths,
};
pub use stroke_chores::{FlattenReport, LostStroke, ReprojectReport, flatten_strokes, reproject_strokes};

// Packing: a graph with its files in one archive.
pub use packing::{PackReport, PackRequest, PackedFile, PackedModel, UnpackReport, pack_graph, unpack_graph};

// Types of other crates that stand in this interface.
/// Curves through points.
pub use sabi_curve as curve;
pub use sabi_export::{
    ConstantRecord, CopyOptions, DocumentRecord, DocumentedMaterial, LookChange, OutputRecord, SetKey, Treatment,
};
pub use sabi_files::{
    Disk, Fault, FileError, NotText, PathBase, Refusal, TrustedPaths, Unread, WholeFile, absolute, canonical,
    io_reason, is_invisible, path_from_stored, path_text, read_plain, stored, stored_path, sweep, write_whole,
};
pub use sabi_gpu::{
    AdapterChoice, AdapterKind, CasterChoice, DEFAULT_BUDGET_BYTES, Gpu, Hits, choose_adapter, device_descriptor,
};
pub use sabi_graph::{Fit, NodeRef, Overrides, Value, nearest};
pub use sabi_nodes::arithmetic;
/// Strokes of a brush.
pub use sabi_paint as paint;
pub use sabi_surface::atlas::Udim;
pub use sabi_surface::load::{ENDINGS as MODEL_ENDINGS, PartChoice, Up};
pub use sabi_surface::model::FilePart;
/// Viewport: cameras, lights, environments and the renderer.
pub use sabi_view as view;
