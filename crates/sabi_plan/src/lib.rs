//! Converts a graph and its kinds to a list of passes: plain data that can be printed and compared.
//!
//! [`Planner::plan`] resolves the wanted part of a graph, computes a key for the content of every result, fuses connected
//! regions of point nodes, and assigns slots from a pool to stored results. `docs/design/planner.md` explains the steps.
//!
//! Invariants:
//! * The same inputs give the same plan; no order of a hash map, no clock and no device takes part.
//! * A result's key changes with everything that can change the result, and with nothing else.
//! * A step reads only slots that an earlier step wrote and that no step in between has written again.
//! * A faulty node only affects the nodes that depend on it: the rest of the graph is planned.
//!
//! ```
//! use std::collections::BTreeMap;
//!
//! use sabi_graph::{Document, Overrides, flatten};
//! use sabi_nodes::Library;
//! use sabi_plan::{FileContents, Lengths, LevelWidths, Limits, Mode, Planner, Target};
//!
//! let document = Document::from_json(
//! r#"{ "format": "sabi", "version": 1, "nodes": {
//! "clouds": { "kind": "noise/simplex" },
//! "dark": { "kind": "adjust/invert", "inputs": { "source": "clouds" } } } }"#,
//! )?;
//! let graph = flatten(&document, &Overrides::default(), &mut |_| Err("no group files".to_owned()))?;
//! let planner = Planner {
//! graph: &graph,
//! library: &Library::builtin(),
//! sources: &BTreeMap::new(),
//! sinks: &BTreeMap::new(),
//! files: &FileContents::new(),
//! lengths: Lengths { working_from: &|_| 1.0, largest_piece: 1.0, extent: &|_| [0.0, 1.0] },
//! level_widths: LevelWidths::of_texels(0.001, 0),
//! surface_key: [0; 32],
//! mode: Mode::Bake { fuse: true },
//! most_rays: None,
//! limits: Limits::default(),
//! };
//! let node = graph.nodes.iter().position(|node| node.id == "dark").ok_or("no such node")?;
//! let (plan, errors) = planner.plan(&[Target { node, port: None }]);
//! assert!(errors.is_empty());
//! // Both are point nodes: one pass, and one texture.
//! assert_eq!((plan.steps.len(), plan.slots.len()), (1, 1));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod assign;
mod channels;
mod error;
mod field;
mod fuse;
mod group_order;
mod inputs;
mod kernel_builder;
mod keys;
mod level;
mod memory_use;
mod muting;
mod order;
mod own_slots;
mod packing;
mod parameter_values;
mod plan;
mod ray_steps;
mod rays;
mod request;
mod resolve;
mod resolved_graph;
mod resources;
mod schedule;
mod seeds;
mod slots;
mod source_values;
mod step_builder;
mod survey;

pub use error::{PlanError, Problem};
pub use level::{Level, LevelWidths};
pub use packing::pack_params;
pub use plan::{
    BlockValues, Feedback, Grouping, KernelStep, MoveStep, Plan, PlannedResult, Reach, Slot, SlotExtent, SlotRef,
    SourceStep, Step, StepRays, SurveyStep,
};
pub use request::{
    FileContents, FileFault, FileFaultKind, Lengths, Limits, Mode, Planner, Sinks, SourceKind, SourcePort, Target,
};
pub use resolved_graph::{Behavior, ResolvedGraph, ResolvedInput, ResolvedNode};
pub use seeds::pcg;
pub use source_values::{NoSuchValue, SourceValues};

#[cfg(test)]
mod tests;
