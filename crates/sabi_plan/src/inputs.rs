//! Inputs of a node, which are those of its kind and masks of its parameters, with the results that are linked to them.

use sabi_graph::{FlatNode, PortType, nearest};
use sabi_nodes::kind::{Input, InputDefault, Reads};
use sabi_nodes::link::Convert;

use crate::error::Problem;
use crate::muting::unmuted_origin;
use crate::request::{Planner, SourcePort};
use crate::resolved_graph::{Behavior, ResolvedGraph, ResolvedInput};

/// Links of a node.
pub(crate) struct LinkedInputs {
    /// For each input of the kind the link, or `None` if it is not connected; then the links of `masked_params`.
    pub(crate) inputs: Vec<Option<ResolvedInput>>,
    /// Indices of the parameters that masks multiply.
    pub(crate) masked_params: Vec<usize>,
    /// True if a node that it reads has a problem, or depends on a node with a problem.
    pub(crate) is_blocked: bool,
}

impl<'a> Planner<'a> {
    /// Finds what is linked to a node.
    pub(crate) fn linked_inputs(
        &self,
        node: &FlatNode,
        behavior: Behavior<'_>,
        resolved: &ResolvedGraph<'a>,
        problems: &mut Vec<Problem>,
    ) -> LinkedInputs {
        let mut linked = LinkedInputs {
            inputs: Vec::new(),
            masked_params: Vec::new(),
            is_blocked: false,
        };
        let mut ports = ports(behavior);
        let is_unknown = |port: &&String| ports.iter().all(|known| known.name != **port);
        let unknown: Vec<&String> = node.inputs.keys().filter(is_unknown).collect();
        for port in unknown {
            match masked_param(behavior, port) {
                Some(param) => ports.push(mask_port(behavior, param)),
                None => problems.push(unknown_input(behavior, port, &ports)),
            }
        }
        for port in &ports {
            match (self.resolve_input(node, port, resolved), port.masked_param) {
                (Ok(InputLink::Connected(input)), masked_param) => {
                    linked.inputs.push(Some(input));
                    linked.masked_params.extend(masked_param);
                }
                (Ok(InputLink::Unconnected), None) => linked.inputs.push(None),
                // If the mask comes from a muted node that passes nothing on, nothing multiplies the parameter.
                (Ok(InputLink::Unconnected), Some(_)) => {}
                (Ok(InputLink::Blocked), _) => linked.is_blocked = true,
                (Err(problem), _) => problems.push(problem),
            }
        }
        linked
    }

    fn resolve_input(
        &self,
        node: &FlatNode,
        port: &KindInput<'_>,
        resolved: &ResolvedGraph<'a>,
    ) -> Result<InputLink, Problem> {
        let link = node.inputs.get(port.name);
        let origin = link.and_then(|from| match self.find_output(from) {
            // A missing result is reported even if the node is muted.
            None => Some(from.clone()),
            Some(_) => unmuted_origin(self.graph, self, from).0,
        });
        let Some(from) = origin else {
            return if port.required {
                Err(Problem::MissingInput {
                    port: port.name.to_owned(),
                    expected: port.ty,
                })
            } else {
                Ok(InputLink::Unconnected)
            };
        };
        let from_id = self.graph.nodes[from.node].id.clone();
        let Some((output, ty)) = self.find_output(&from) else {
            let Ok(behavior) = self.behavior(&self.graph.nodes[from.node]) else {
                return Ok(InputLink::Blocked);
            };
            let output = from.port.unwrap_or_else(|| "result".to_owned());
            let names = behavior.output_names();
            let nearest = nearest(&output, names.iter().copied()).map(str::to_owned);
            return Err(Problem::UnknownOutput {
                port: port.name.to_owned(),
                from: from_id,
                output,
                nearest,
            });
        };
        if !port.ty.accepts(ty) {
            return Err(Problem::Mistyped {
                port: port.name.to_owned(),
                expected: port.ty,
                from: from_id,
                found: ty,
            });
        }
        if resolved.nodes[from.node].is_none() {
            return Ok(InputLink::Blocked);
        }
        let convert = Convert::between(ty, port.ty);
        Ok(InputLink::Connected(ResolvedInput {
            node: from.node,
            output,
            ty,
            convert,
            reads: port.reads,
        }))
    }
}

/// Link of an input.
enum InputLink {
    Connected(ResolvedInput),
    Unconnected,
    /// Connected to a node that has a problem, or depends on one that has.
    Blocked,
}

/// Input of a kind, whatever its behavior.
pub(crate) struct KindInput<'a> {
    pub(crate) name: &'a str,
    pub(crate) ty: PortType,
    reads: Reads,
    required: bool,
    /// For the mask of a parameter, the index of the parameter that it multiplies.
    masked_param: Option<usize>,
}

/// Index of a parameter that a mask can multiply at each place.
fn masked_param(behavior: Behavior<'_>, name: &str) -> Option<usize> {
    match behavior {
        Behavior::Shader(kind) => kind.masked_param(name),
        Behavior::Source(_) | Behavior::Sink(_) => None,
    }
}

fn mask_port(behavior: Behavior<'_>, param: usize) -> KindInput<'_> {
    KindInput {
        name: &behavior.params()[param].name,
        ty: PortType::Mask,
        reads: Reads::Value,
        required: false,
        masked_param: Some(param),
    }
}

/// The problem of a link to an input that the kind does not have.
fn unknown_input(behavior: Behavior<'_>, port: &str, ports: &[KindInput<'_>]) -> Problem {
    if behavior.params().iter().any(|param| param.name == port) {
        return Problem::ParamWithoutMask { param: port.to_owned() };
    }
    let nearest = nearest(port, ports.iter().map(|known| known.name)).map(str::to_owned);
    Problem::UnknownInput {
        port: port.to_owned(),
        nearest,
    }
}

pub(crate) fn ports<'a>(behavior: Behavior<'a>) -> Vec<KindInput<'a>> {
    match behavior {
        Behavior::Shader(kind) => {
            let port = |input: &'a Input| KindInput {
                name: &input.name,
                ty: input.ty,
                reads: input.reads,
                required: input.default == InputDefault::Required,
                masked_param: None,
            };
            kind.inputs.iter().map(port).collect()
        }
        Behavior::Source(kind) | Behavior::Sink(kind) => {
            let port = |input: &'a SourcePort| KindInput {
                name: &input.name,
                ty: input.ty,
                reads: Reads::Value,
                required: input.unconnected.is_none(),
                masked_param: None,
            };
            kind.inputs.iter().map(port).collect()
        }
    }
}
