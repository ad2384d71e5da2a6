//! Changes to a document, as values.

use std::collections::BTreeMap;

use crate::document::{Fit, GroupDef, GroupInput, Preview};
use crate::graph::{ExposedParameter, Frame};
use crate::problem::Problem;
use crate::{Document, Node, NodeDisplay, NodeId, Note, OutputRef, Value};

/// One of the graphs of a document.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Body {
    /// The main graph.
    #[default]
    Main,
    /// The graph of the group of that name.
    Group(String),
}

/// A change of a document; [`Document::apply`](crate::Document::apply) applies it and gives its exact inverse.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "the sentence of each edit says what its fields are")]
pub enum Edit {
    /// Adds a node with its parameters, and links its inputs.
    AddNode {
        body: Body,
        id: NodeId,
        node: Node,
        inputs: BTreeMap<String, OutputRef>,
    },
    /// Removes a node with all links from it and all its exposed parameters and ports.
    RemoveNode { body: Body, id: NodeId },
    /// Sets a parameter, or resets it (`None`).
    SetParam {
        body: Body,
        node: NodeId,
        param: String,
        value: Option<Value>,
    },
    /// Links an input. An existing link is replaced.
    Connect {
        body: Body,
        node: NodeId,
        input: String,
        from: OutputRef,
    },
    /// Unlinks an input; has no effect on an input without a link.
    Disconnect { body: Body, node: NodeId, input: String },
    /// Moves a node to a place on the canvas, in canvas points.
    Move { body: Body, node: NodeId, pos: [f32; 2] },
    /// Mutes or unmutes a node.
    SetMuted { body: Body, node: NodeId, muted: bool },
    /// Sets how a node is drawn.
    SetDisplay {
        body: Body,
        node: NodeId,
        display: NodeDisplay,
    },
    /// Sets or removes a node's display name.
    SetLabel {
        body: Body,
        node: NodeId,
        label: Option<String>,
    },
    /// Names the document.
    RenameDocument { name: String },
    /// Adds a frame, or replaces the one of that id.
    AddFrame { body: Body, id: String, frame: Frame },
    /// Removes a frame; its nodes stay.
    RemoveFrame { body: Body, id: String },
    /// Adds a note or replaces the one of that id, or removes it (`None`).
    SetNote { body: Body, id: String, note: Option<Note> },
    /// Exposes a knob, or replaces the one of that name.
    Expose {
        body: Body,
        name: String,
        knob: ExposedParameter,
    },
    /// Removes a knob from the exposed ones and from all variants.
    Unexpose { body: Body, name: String },
    /// Sets the knob values of a variant, or removes the variant (`None`).
    SetVariant {
        body: Body,
        name: String,
        values: Option<BTreeMap<String, Value>>,
    },
    /// Sets an input of a group (of a file that is used as one, for the main graph), or removes it (`None`).
    SetInput {
        body: Body,
        name: String,
        input: Option<GroupInput>,
    },
    /// Sets an output of a group (of a file that is used as one, for the main graph), or removes it (`None`).
    SetOutput {
        body: Body,
        name: String,
        output: Option<OutputRef>,
    },
    /// Defines a group.
    AddGroup { name: String, group: Box<GroupDef> },
    /// Replaces a group that is defined; its instances stay as they are.
    SetGroup { name: String, group: Box<GroupDef> },
    /// Removes a group that has no instances.
    RemoveGroup { name: String },
    /// Renames a group and its references in all instances, and sets its display name where that differs.
    RenameGroup {
        name: String,
        to: String,
        shown: Option<String>,
    },
    /// Sets the preview.
    SetPreview { preview: Option<Preview> },
    /// Sets the length that counts as 1.
    SetFit { fit: Fit },
    /// Sets the document's seed.
    SetSeed { seed: u32 },
    /// Replaces the whole document.
    Replace { document: Box<Document> },
    /// Several edits as one: all are applied, or none.
    Batch(Vec<Edit>),
}

impl Edit {
    /// Returns true if the edit may contain whole graphs, so that a copy of it can be as large as a document.
    pub fn replaces_graphs(&self) -> bool {
        match self {
            Edit::AddGroup { .. } | Edit::SetGroup { .. } | Edit::Replace { .. } => true,
            Edit::Batch(edits) => edits.iter().any(Edit::replaces_graphs),
            _ => false,
        }
    }

    /// Returns false if the edit only changes how the graph is drawn on the canvas, so that no result depends on it.
    pub fn affects_results(&self) -> bool {
        match self {
            Edit::Move { .. }
            | Edit::SetDisplay { .. }
            | Edit::AddFrame { .. }
            | Edit::RemoveFrame { .. }
            | Edit::SetNote { .. } => false,
            Edit::Batch(edits) => edits.iter().any(Edit::affects_results),
            _ => true,
        }
    }

    /// Connects an input to an output, or (`None`) disconnects it.
    pub fn link(body: Body, node: NodeId, input: String, from: Option<OutputRef>) -> Edit {
        match from {
            Some(from) => Edit::Connect {
                body,
                node,
                input,
                from,
            },
            None => Edit::Disconnect { body, node, input },
        }
    }
}

/// Reason for refusing an edit; the document is unchanged.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EditError {
    /// The graph would be invalid.
    #[error(transparent)]
    Problem(#[from] Problem),
    /// A frame, knob, variant, input, output or group with this name does not exist.
    #[error("there is no {what} {name}{hint}")]
    Missing {
        /// `frame`, `knob` and so on.
        what: &'static str,
        /// The name, quoted.
        name: String,
        /// The nearest existing name, as a question.
        hint: String,
    },
    /// A group with that name exists already.
    #[error("there is a group {name} already; choose another name")]
    GroupExists {
        /// The name, quoted.
        name: String,
    },
    /// A group with instances cannot be removed.
    #[error("group {name} is in use by {users}; remove these instances first")]
    GroupInUse {
        /// The name, quoted.
        name: String,
        /// Instances, quoted.
        users: String,
    },
    /// A fit that is not a number above zero.
    #[error("a fit must be a length above zero, or \"unit\" or \"metres\"")]
    BadFit,
    /// A position on the canvas that is not a finite number.
    #[error("a node can only stand at a finite place on the canvas")]
    BadPosition,
}
