//! Channels that material results set. Other channels are not stored.

use sabi_graph::PortType;
use sabi_nodes::kind::{Channel, ChannelWrite, ParamValue};

use crate::resolved_graph::{Behavior, ResolvedGraph, ResolvedNode};

/// Returns the channels that each result sets: color and surface always, others if the node writes them or passes them on.
pub(crate) fn channels(node: &ResolvedNode<'_>, resolved: &ResolvedGraph<'_>) -> Vec<Vec<Channel>> {
    match node.behavior {
        Behavior::Source(kind) | Behavior::Sink(kind) => {
            kind.outputs.iter().map(|output| output.channels.clone()).collect()
        }
        Behavior::Shader(kind) => {
            let passed_on: Vec<Channel> = node
                .inputs
                .iter()
                .flatten()
                .filter(|input| input.ty == PortType::Material)
                .filter_map(|input| resolved.nodes[input.node].as_ref()?.channels.get(input.output).cloned())
                .flatten()
                .collect();
            let set = |write: &ChannelWrite| {
                write.unless_off.iter().all(|param| is_on(node, *param))
                    && write.unless_open.iter().all(|input| is_given(node, *input))
            };
            kind.outputs
                .iter()
                .map(|output| {
                    if output.ty != PortType::Material {
                        return Vec::new();
                    }
                    let written = |channel| {
                        output
                            .channels
                            .iter()
                            .any(|write| write.channel == channel && set(write))
                    };
                    let always = |channel| matches!(channel, Channel::Color | Channel::Surface);
                    let keeps =
                        |channel: &Channel| always(*channel) || written(*channel) || passed_on.contains(channel);
                    Channel::ALL.into_iter().filter(keeps).collect()
                })
                .collect()
        }
    }
}

/// Returns true if a toggle is on, or a number is not zero.
fn is_on(node: &ResolvedNode<'_>, param: usize) -> bool {
    match node.values.get(param) {
        Some(ParamValue::Unsigned(0)) => false,
        Some(ParamValue::Floats(numbers)) => numbers.iter().any(|number| *number != 0.0),
        _ => true,
    }
}

/// Returns true if an input is connected, or its knob is not zero.
fn is_given(node: &ResolvedNode<'_>, input: usize) -> bool {
    match (node.inputs.get(input), node.knobs.get(input)) {
        (Some(None), Some(Some(knob))) => knob.iter().any(|number| *number != 0.0),
        _ => true,
    }
}
