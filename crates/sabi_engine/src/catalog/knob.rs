//! Settings of a node.

use sabi_nodes::kind::{Input, Param, ParamType};

/// A value that can be set: a parameter, or the default of an input to which nothing is connected.
#[derive(Clone, Debug, PartialEq)]
pub struct Knob {
    /// Name in graph files.
    pub name: String,
    /// Name shown to artists.
    pub label: String,
    /// Description of its effect, for artists.
    pub doc: String,
    /// Values that it accepts. The default is that of the node, which a group may have set.
    pub ty: ParamType,
    /// True if it sets the value of an input that is not connected.
    pub is_of_input: bool,
}

impl Knob {
    pub(super) fn of_param(param: &Param) -> Knob {
        Knob {
            name: param.name.clone(),
            label: param.label.clone(),
            doc: param.doc.clone(),
            ty: param.ty.clone(),
            is_of_input: false,
        }
    }

    /// Returns the knob for the default of an input; `None` if the input has none.
    pub(super) fn of_input(input: &Input) -> Option<Knob> {
        Some(Knob {
            name: input.name.clone(),
            label: input.label.clone(),
            doc: input.doc.clone(),
            ty: input.knob()?,
            is_of_input: true,
        })
    }
}
