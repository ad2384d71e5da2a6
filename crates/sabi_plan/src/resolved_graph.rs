//! Resolved nodes: their kinds, checked inputs, values and keys.

use sabi_graph::PortType;
use sabi_nodes::kind::{Channel, Kind, Param, ParamValue, Reads};
use sabi_nodes::link::Convert;

use crate::error::PlanError;
use crate::request::SourceKind;
use crate::source_values::SourceValues;

/// How a node is evaluated.
#[derive(Clone, Copy, Debug)]
pub enum Behavior<'a> {
    /// By a kernel.
    Shader(&'a Kind),
    /// By the engine.
    Source(&'a SourceKind),
    /// Not at all: the kind has no outputs.
    Sink(&'a SourceKind),
}

impl<'a> Behavior<'a> {
    /// Parameters of the kind.
    pub(crate) fn params(self) -> &'a [Param] {
        match self {
            Behavior::Shader(kind) => &kind.params,
            Behavior::Source(kind) | Behavior::Sink(kind) => &kind.params,
        }
    }

    /// Names of the results, in order.
    pub(crate) fn output_names(self) -> Vec<&'a str> {
        match self {
            Behavior::Shader(kind) => kind.outputs.iter().map(|output| output.name.as_str()).collect(),
            Behavior::Source(kind) | Behavior::Sink(kind) => {
                kind.outputs.iter().map(|output| output.name.as_str()).collect()
            }
        }
    }
}

/// A node whose ports and values were checked.
#[derive(Clone, Debug)]
pub struct ResolvedNode<'a> {
    /// How it is evaluated.
    pub behavior: Behavior<'a>,
    /// Connections by input of the kind, or `None` if it is not connected; then those of `masked_params`.
    pub inputs: Vec<Option<ResolvedInput>>,
    /// Indices of the parameters that masks multiply, in the order of their connections.
    pub masked_params: Vec<usize>,
    /// Values of the parameters in artist's units.
    pub values: Vec<ParamValue>,
    /// Bytes of `struct Params`; empty for sources and sinks.
    pub params: Vec<u8>,
    /// True if lengths among its parameters are shares of the piece that contains a place.
    pub is_by_piece: bool,
    /// Values for a source or sink; empty for shaders.
    pub source_values: SourceValues,
    /// Knob values by input.
    pub knobs: Vec<Option<Vec<f32>>>,
    /// For each output the channels that a material result sets.
    pub channels: Vec<Vec<Channel>>,
    /// Key of all results.
    pub key: [u8; 32],
}

impl ResolvedNode<'_> {
    /// Masks that multiply parameters, by index of the parameter.
    pub(crate) fn param_masks(&self) -> impl Iterator<Item = (usize, ResolvedInput)> {
        let masks = self.inputs.iter().flatten().rev().take(self.masked_params.len());
        let params = self.masked_params.iter().rev();
        params.copied().zip(masks.copied())
    }

    /// Channels that any of its results sets.
    pub(crate) fn all_channels(&self) -> impl Iterator<Item = Channel> {
        self.channels.iter().flatten().copied()
    }
}

/// Origin of an input's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ResolvedInput {
    /// Index of the node in the flat graph.
    pub node: usize,
    /// Index of its result.
    pub output: usize,
    /// Type of that result.
    pub ty: PortType,
    /// Conversion on the way.
    pub convert: Convert,
    /// How the value is read: at this place, or as a stored texture.
    pub reads: Reads,
}

/// The wanted part of a graph.
#[derive(Debug, Default)]
pub struct ResolvedGraph<'a> {
    /// By index in the flat graph; `None` for nodes that are not wanted, or have a problem.
    pub nodes: Vec<Option<ResolvedNode<'a>>>,
    /// Indices of the resolved nodes, inputs first, chains kept together.
    pub order: Vec<usize>,
    /// Problems of the wanted part, in evaluation order.
    pub errors: Vec<PlanError>,
}

impl ResolvedNode<'_> {
    /// Name and type of a result.
    pub fn output(&self, index: usize) -> Option<(&str, PortType)> {
        match self.behavior {
            Behavior::Shader(kind) => kind.outputs.get(index).map(|output| (output.name.as_str(), output.ty)),
            Behavior::Source(kind) | Behavior::Sink(kind) => {
                kind.outputs.get(index).map(|output| (output.name.as_str(), output.ty))
            }
        }
    }
}
