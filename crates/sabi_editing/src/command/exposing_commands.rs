//! Commands for everything that a graph exposes: knobs, variants, inputs and outputs. They refer to all of these by their
//! exposed names.

use std::collections::BTreeSet;

use sabi_graph::{OutputRef, SlotRef, Value};

/// Change of an exposed knob.
#[derive(Clone, Debug, PartialEq)]
pub enum ExposedCommand {
    /// Set the value of a knob.
    Set {
        /// Name of the knob.
        name: String,
        /// New value.
        value: Value,
    },
    /// Restore the value that a knob had when the document was opened.
    Reset(String),
    /// Set the label of a knob; an empty one restores that of the knob that it sets.
    SetLabel {
        /// Name of the knob.
        name: String,
        /// New label.
        label: String,
    },
    /// Set the name of a knob in files and on command lines.
    Rename {
        /// Present name.
        name: String,
        /// New name.
        to: String,
    },
    /// Set the section that contains a knob. An empty title removes the knob from its section.
    SetSection {
        /// Name of the knob.
        name: String,
        /// Title of the section.
        section: String,
    },
    /// Set the range of a knob; `None` restores that of the knob that it sets.
    SetRange {
        /// Name of the knob.
        name: String,
        /// Least and greatest value.
        range: Option<[f64; 2]>,
    },
    /// Set the default of a knob. `None` removes it, so that the nodes keep their own values.
    SetDefault {
        /// Name of the knob.
        name: String,
        /// New default.
        default: Option<Value>,
    },
    /// Move a knob before another one, or (`None`) to the end.
    Move {
        /// Name of the knob.
        name: String,
        /// Name of the knob that comes after it.
        before: Option<String>,
    },
    /// Expose a knob no longer.
    Remove(String),
    /// Give the knobs values near their current ones, and the document another seed.
    Randomize {
        /// Knobs that keep their values; `seed` stands for the document's seed.
        kept: BTreeSet<String>,
    },
}

/// Change of the variants.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum VariantCommand {
    /// Save the current values of the exposed knobs as a variant.
    Save(String),
    /// Show a variant, which further edits of the panel then change. `None` shows the graph's own values.
    Show(Option<String>),
    /// Rename a variant.
    Rename {
        /// Current name.
        name: String,
        /// New name.
        to: String,
    },
    /// Remove a variant.
    Remove(String),
}

/// Change of the inputs and outputs that the shown graph has as a group.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PortCommand {
    /// Set the name of the shown graph.
    NameGraph(String),
    /// Expose an input of a node.
    ExposeInput(SlotRef),
    /// Expose an output of a node.
    ExposeOutput(OutputRef),
    /// Set the label of an input; an empty one restores its name.
    SetInputLabel {
        /// Name of the input.
        name: String,
        /// New label.
        label: String,
    },
    /// Set the name of an input in files.
    RenameInput {
        /// Current name.
        name: String,
        /// New name.
        to: String,
    },
    /// Remove an input.
    RemoveInput(String),
    /// Connect an input of the graph to an input of a node.
    Feed {
        /// Name of the input.
        name: String,
        /// Input of a node.
        slot: SlotRef,
    },
    /// Disconnect an input of a node from the input of the graph that feeds it.
    Unfeed(SlotRef),
    /// Set the name of an output.
    RenameOutput {
        /// Current name.
        name: String,
        /// New name.
        to: String,
    },
    /// Remove an output.
    RemoveOutput(String),
    /// Connect an output to another result.
    Retarget {
        /// Name of the output.
        name: String,
        /// Result that the output is connected to.
        from: OutputRef,
    },
}
