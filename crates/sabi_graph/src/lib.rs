//! The document: nodes, links, edits with inverses, groups and the file format.
//!
//! ```
//! use std::collections::BTreeMap;
//!
//! use sabi_graph::{Body, Document, Edit, Node, Overrides, flatten};
//!
//! let mut document = Document::new("Dust");
//! let add = Edit::AddNode {
//!     body: Body::Main,
//!     id: "grain".parse()?,
//!     node: Node::new("noise/simplex"),
//!     inputs: BTreeMap::new(),
//! };
//! let undo = document.apply(add)?;
//! let flat = flatten(&document, &Overrides::default(), &mut |_| Err("no files here".to_owned()))?;
//! assert_eq!(flat.nodes[0].kind, "noise/simplex");
//! document.apply(undo)?;
//! assert_eq!(document, Document::new("Dust"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod apply;
mod display;
mod document;
mod edit;
mod file_error;
mod flatten;
mod format;
mod graph;
mod history;
mod id;
mod id_text;
mod json;
mod knob_curve;
mod layout;
mod locate;
mod migrate;
mod name;
mod nearest;
mod order;
mod port;
mod problem;
mod read;
mod relocate;
mod save;
#[cfg(test)]
mod tests;
mod text_position;
mod validate;
mod value;
mod value_text;

pub use display::{NodeDisplay, NodeRows, Note};
pub use document::{Description, Document, Fit, GroupDef, GroupInput, LibrarySource, Preview, SavedView};
pub use edit::{Body, Edit, EditError};
pub use file_error::{FileError, FileProblem};
pub use flatten::{
    FlatGraph, FlatNode, FlatRef, FlattenError, INSTANCE_KNOBS, NodeRef, Overrides, ReadShared, ResultOrigin, flatten,
    flatten_and_find, takes_values,
};
pub use format::{FormatKey, FormatObject, UnknownKey, UnknownKeys, format_objects, format_schema, unknown_keys};
pub use graph::{ExposedParameter, Frame, Graph, Node};
pub use history::{History, UNDO_STEPS};
pub use id::{NodeId, OutputRef, SlotRef};
pub use knob_curve::KnobCurve;
pub use locate::Locator;
pub use nearest::{advice_on, nearest};
pub use port::PortType;
pub use problem::Problem;
pub use read::format_version;
pub use relocate::Relocation;
pub use value::{Value, canonical_number};

/// Kind of group instances.
pub const GROUP_KIND: &str = "graph/group";

/// Kind of reroutes, which pass on their only input, `source`.
pub const REROUTE_KIND: &str = "graph/reroute";
