//! A session: open, evaluate, preview, bake, watch; what the command line and the editor call.
//!
//! [`Workpiece::open`] brings a graph and a model together; [`bake`] and [`preview`] are what is done with them.

mod bake;
mod bake_request;
mod cache_dir;
pub mod catalog;
mod check;
mod describe;
mod displace;
mod document;
mod environment;
mod error;
mod folder;
mod kept_rays;
mod kinds;
mod levels;
mod live;
mod looks;
mod maps;
mod mixing;
mod model_copy;
mod modelless;
mod node_file;
mod outputs;
mod overlap;
mod overridden;
mod picture_file;
mod pictures;
mod prepare;
mod preview;
mod render;
mod report;
mod seams;
mod seen_node;
mod session;
mod sets;
mod setting;
mod sharing;
mod sheet;
mod solidity;
mod source;
mod stages;
mod thumbnail;
mod watch;
mod whole_file;
mod workpiece;

pub use bake::{bake, bake_graph, needs_force};
pub use bake_request::{BakeRequest, DEFAULT_NAMES, default_padding, export_channels, export_presets, why_no_names};
pub use cache_dir::default_cache_dir;
pub use check::{CheckReport, check};
pub use describe::{describe_mesh, describe_nodes, diagnose};
pub use displace::Triangles;
pub use document::OpenGraph;
pub use environment::{built_in_environments, load_environment, read_panorama};
pub use error::{EngineError, ErrorKind};
pub use kinds::Kinds;
pub use live::{
    Faults, Inspected, Live, LiveModel, LiveOptions, LiveTimes, News, NodeFault, Seen, Waiting, Warning, Wish,
};
pub use looks::{Shown, show};
pub use node_file::{NodeDraft, NodeTextFault, check_node, new_node_folder, node_text_like, read_node, why_no_node_id};
pub use pictures::Pictures;
pub use prepare::{ModelOptions, Overlap, Prepared, Unwrapping};
pub use preview::{PreviewRequest, preview};
pub use render::{RenderRequest, Turns, render};
pub use report::{BakeReport, StageTime, StageTimes};
pub use seams::Seams;
pub use session::{FileState, Recovery, Session, moved_to, recoveries, with_whole_paths};
pub use sets::TextureSet;
pub use setting::read_setting;
pub use sheet::{PlaneHolds, SheetPlane};
pub use stages::{Progress, Silent, Stage};
pub use thumbnail::{find_thumbnail, keep_thumbnail, thumbnail_of};
pub use watch::{Changes, Watched, Watcher};
pub use workpiece::{Workpiece, WorkpieceOptions};

pub use sabi_export::SetKey;
pub use sabi_gpu::{
    AdapterChoice, AdapterKind, CasterChoice, DEFAULT_BUDGET_BYTES, Gpu, Hits, choose_adapter, device_descriptor,
};
pub use sabi_graph::{Fit, NodeRef, Overrides, nearest};
pub use sabi_surface::load::Up;
/// What is seen of a model, and how.
pub use sabi_view as view;
pub use whole_file::{canonical, free_graph_file, write_whole};
