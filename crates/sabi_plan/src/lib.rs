//! A graph and its kinds become a list of passes: plain data that prints and compares.
//!
//! [`Planner::plan`] resolves the wanted part of a graph, gives every result a key that names its content, fuses
//! connected regions of point nodes, and gives stored results slots from a pool.

mod assign;
mod channels;
mod draft;
mod error;
mod field;
mod fuse;
mod inputs;
mod keys;
mod muted;
mod order;
mod plan;
mod rays;
mod request;
mod resolve;
mod schedule;
mod seeds;
mod slots;
mod source_values;
mod survey;
mod values;

pub use error::{PlanError, Problem};
pub use plan::{
    BlockValues, Feedback, KernelStep, MoveStep, Plan, PlannedResult, Reach, Room, Slot, SlotRef, SourceStep, Step,
    StepRays, SurveyStep,
};
pub use request::{FileContents, FileFault, Lengths, Limits, Mode, Planner, Sinks, SourceKind, SourcePort, Target};
pub use resolve::{Behavior, Resolved, ResolvedInput, ResolvedNode};
pub use seeds::pcg;
pub use source_values::SourceValues;
pub use values::{pack_params, read_param};

#[cfg(test)]
mod tests;
