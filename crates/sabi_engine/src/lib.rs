//! A graph on a model: opening, checking, evaluating, previewing, rendering and baking, for the command line and the editor.
//!
//! [`baking::bake`], [`rendering::preview`] and [`rendering::render`] do their work in one call. [`Evaluator`] plans and runs a graph on
//! a model, [`Live`] does so while the graph is edited, and [`Session`] holds the edited graph with its history and its file.
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
//! use sabi_engine::Kinds;
//! use sabi_engine::catalog::check::check;
//! use sabi_engine::catalog::description::describe_nodes;
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

pub mod baking;
pub mod catalog;
pub mod effect_library;
mod error;
pub mod evaluating;
pub mod faults;
pub mod graph_info;
pub mod live;
pub mod opening;
pub mod packing;
pub mod phases;
pub mod picked_gradient;
pub mod program;
mod program_cache;
pub mod remedy;
pub mod rendering;
pub mod session;
pub mod source;
pub mod stroke_maintenance;
mod warning;

pub use error::{EngineError, ErrorKind};
pub use evaluating::evaluator::Evaluator;
pub use live::Live;
pub use opening::document::OpenGraph;
pub use opening::kinds::Kinds;
pub use remedy::Remedy;
pub use session::Session;
pub use warning::Warning;
