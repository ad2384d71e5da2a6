//! The open document as an artist edits it: selection, entered groups, the clipboard, history, and every edit as a named
//! undo step. It needs no window, also for tests.
//!
//! [`OpenDocument`] holds what all edits need. The edits are functions over it, in a module for each thing that is edited:
//! [`nodes`], [`wires`], [`frames`], [`groups`], [`ports`], [`exposed_knobs`], [`variants`], [`layers`]. A front end performs them
//! as values, with [`command::perform`].
//!
//! Invariants:
//! * An edit is one undo step, however many nodes it changes; undoing it restores the same text of the document.
//! * A refused edit changes nothing and leaves its reason in the notices.
//! * The shown graph exists, and all selected nodes are in it.
//! * A graph that can be evaluated can still be evaluated after every edit: instances follow what their group exposes, and
//!   no wires form a cycle.
//! * Nothing here knows a window, a device or a thread.
//!
//! ```
//! use sabi_editing::OpenDocument;
//! use sabi_editing::command::{HistoryCommand, NodeCommand, NodeSource, Outcome, perform};
//! use sabi_engine::Session;
//!
//! let mut document = OpenDocument::new(Session::new(None));
//! let add = NodeCommand::Add {
//! source: NodeSource::Kind("noise/simplex".to_owned()),
//! place: [120.0, 80.0],
//! pending: None,
//! into: None,
//! };
//! let outcome = perform(&mut document, add.into());
//! assert!(matches!(outcome, Outcome::Added(node) if document.selection().contains(&node)));
//!
//! assert_eq!(perform(&mut document, HistoryCommand::Undo.into()), Outcome::Done);
//! assert!(document.graph().is_empty());
//! ```

pub mod arrangement;
mod bundled_groups;
pub mod clipboard;
pub mod command;
pub mod connections;
mod current_interfaces;
pub mod document_settings;
mod document_trust;
pub mod dropped_layers;
pub mod duplication;
mod evaluability;
pub mod exposed_knobs;
pub mod exposed_values;
mod follow_up;
pub mod frames;
mod group_files;
mod group_import;
pub mod groups;
pub mod hand_layers;
pub mod history;
pub mod instance_variants;
mod instances;
pub mod knob_target;
pub mod layers;
pub mod library;
pub mod library_folder;
pub mod linked_groups;
pub mod missing_files;
mod names;
pub mod navigation;
mod new_ids;
mod new_nodes;
mod node_kinds;
pub mod node_paths;
pub mod node_replacement;
pub mod node_size;
pub mod nodes;
pub mod notes;
mod open_document;
pub mod painting;
mod place;
pub mod ports;
pub mod random_knobs;
mod reconnection;
mod references;
pub mod relative_paths;
pub mod selection;
pub mod shown_variant;
pub mod stack;
#[cfg(test)]
mod tests;
mod texture_map_names;
pub mod texture_sets;
pub mod trust;
pub mod variants;
pub mod wires;

pub use node_kinds::NodeKinds;
pub use open_document::OpenDocument;
