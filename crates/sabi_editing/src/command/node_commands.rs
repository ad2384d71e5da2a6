//! Commands for nodes, their knobs, positions, groups and layers.

use std::collections::BTreeSet;
use std::path::PathBuf;

use sabi_graph::{NodeId, NodeRows, SlotRef, Value};

use crate::arrangement::{Align, DistributionAxis};
use crate::connections::PendingWire;
use crate::dropped_layers::DroppedOn;
use crate::hand_layers::HandLayer;
use crate::knob_target::KnobTarget;
use crate::stack::StackEnd;

use super::Positions;

/// Origin of a new node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NodeSource {
    /// A node kind.
    Kind(String),
    /// A group of the document, or a graph file by its path relative to the document.
    Group(String),
    /// A graph file of a library, which becomes a group of the document.
    Library(PathBuf),
}

/// Change of nodes.
#[derive(Clone, Debug, PartialEq)]
pub enum NodeCommand {
    /// Add a node and select it.
    Add {
        /// Kind, group or library file of the new node.
        source: NodeSource,
        /// Upper left corner, canvas points.
        place: [f32; 2],
        /// Wire to connect to the new node, if it fits.
        pending: Option<PendingWire>,
        /// Input into whose wire the node is inserted.
        into: Option<SlotRef>,
    },
    /// Replace a node, and keep its wires where they fit.
    Replace {
        /// Node that is replaced.
        node: NodeId,
        /// Kind, group or library file of the new node.
        by: NodeSource,
    },
    /// Set the label of a node; an empty one restores that of its kind.
    Rename {
        /// Node that is renamed.
        node: NodeId,
        /// New label.
        name: String,
    },
    /// Delete the selected nodes.
    DeleteSelected {
        /// True if the readers of the deleted nodes are connected to the sources of those nodes.
        reconnects: bool,
    },
    /// Duplicate the selected nodes.
    DuplicateSelected {
        /// True if the inputs of the copies are connected like those of the originals.
        keeps_inputs: bool,
    },
    /// Mute the selected nodes, or unmute them if all are muted.
    ToggleMuted,
    /// Let the selected nodes show only these rows, or all rows if all selected nodes are in that state already.
    ToggleRows(NodeRows),
    /// Draw wires that start at the selected nodes as names, or as wires again if all of them are drawn as names.
    ToggleNamedWires,
    /// Add the texture sets that these image files form, according to their names.
    AddTextureSets {
        /// Image files.
        files: Vec<PathBuf>,
        /// Upper left corner of the new nodes, canvas points; they are moved down or up where they would cover other nodes.
        place: [f32; 2],
    },
    /// Add a node that reads an image file.
    AddImage {
        /// Image file.
        file: PathBuf,
        /// Upper left corner, canvas points.
        place: [f32; 2],
    },
}

/// Change of knobs of nodes.
#[derive(Clone, Debug, PartialEq)]
pub enum KnobCommand {
    /// Set a knob of a node and of the selected nodes of its kind; `None` restores the default.
    Set {
        /// Node that has the knob.
        node: NodeId,
        /// Name of the knob.
        knob: String,
        /// New value.
        value: Option<Value>,
    },
    /// Set a knob that was waiting for a value.
    SetTarget {
        /// Knob to set.
        target: KnobTarget,
        /// New value.
        value: Value,
    },
    /// Expose a knob of a node together with those of the selected nodes of its kind.
    Expose {
        /// Node that has the knob.
        node: NodeId,
        /// Name of the knob.
        knob: String,
    },
    /// Expose a knob of a node no longer.
    Unexpose {
        /// Node that has the knob.
        node: NodeId,
        /// Name of the knob.
        knob: String,
    },
}

/// Change of the positions of nodes.
#[derive(Clone, Debug, PartialEq)]
pub enum ArrangeCommand {
    /// Move nodes.
    Move(Positions),
    /// Align the selected nodes.
    Align(Align),
    /// Distribute the selected nodes evenly.
    Distribute(DistributionAxis),
    /// Move the selected nodes up or down until the wires between them are horizontal.
    Straighten,
    /// Lay out the selected nodes from left to right, or all nodes if none is selected.
    LayOut,
}

/// Change of groups.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum GroupCommand {
    /// Make a group of the selected nodes.
    Make,
    /// Replace the selected instances by the contents of their groups.
    Dissolve,
    /// Write the group of the selected instance into a library folder.
    SaveToLibrary(PathBuf),
    /// Replace linked groups by the newer versions in their libraries.
    Update(Vec<String>),
    /// End the link of a group to its library.
    Unlink(String),
    /// Set the variant of a group instance, or use the group's own values.
    ChooseVariant {
        /// Instance.
        node: NodeId,
        /// Name of the variant; none for the group's own values.
        name: Option<String>,
    },
    /// Give a group instance another seed and other values of its knobs, except for knobs in `kept`.
    Randomize {
        /// Instance.
        node: NodeId,
        /// Names of the knobs that keep their values.
        kept: BTreeSet<String>,
    },
}

/// Change of layers. Positions are counted from the top of a stack.
#[derive(Clone, Debug, PartialEq)]
pub enum LayerCommand {
    /// Hide or show a layer.
    Toggle(NodeId),
    /// Set the opacity of a layer.
    SetOpacity {
        /// Node of the layer.
        node: NodeId,
        /// New opacity.
        opacity: f64,
    },
    /// Move a layer.
    Move {
        /// Output of the stack.
        end: StackEnd,
        /// Position of the layer.
        from: usize,
        /// New position.
        to: usize,
    },
    /// Remove a layer.
    Remove {
        /// Output of the stack.
        end: StackEnd,
        /// Position of the layer.
        at: usize,
    },
    /// Add a node as a layer above another one.
    Add {
        /// Output of the stack.
        end: StackEnd,
        /// Position of the layer below.
        at: usize,
        /// Kind of the node.
        kind: String,
    },
    /// Add a node or group above all layers of the material at a place of the model.
    AddOnModel {
        /// Node or group that is added.
        source: NodeSource,
        /// Material at the place.
        place: DroppedOn,
        /// True if the model has a normal map there.
        has_normal_map: bool,
    },
    /// Add a node or group on top of the material that a node outputs.
    AddOnNode {
        /// Node or group that is added.
        source: NodeSource,
        /// Node that outputs the material.
        node: NodeId,
    },
    /// Add a node as the mask of a layer, replacing an existing mask.
    AddMask {
        /// Node of the layer.
        node: NodeId,
        /// Node or group that is added.
        source: NodeSource,
    },
    /// Add a filled or painted layer above all other layers of a stack.
    AddByHand {
        /// Output of the stack. `None` means the only stack; if there is none, an output is added.
        end: Option<StackEnd>,
        /// Layer that is added.
        what: HandLayer,
    },
    /// Add a painted mask to a layer, replacing an existing mask.
    PaintMask {
        /// Node of the layer.
        node: NodeId,
        /// Value of the mask where nothing is painted.
        empty: f64,
    },
    /// Disconnect the mask of a layer. The mask's nodes stay in the graph.
    RemoveMask(NodeId),
}
