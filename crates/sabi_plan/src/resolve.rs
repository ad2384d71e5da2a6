//! Resolves nodes to their kinds: checks types, reads values and makes keys.

use sabi_graph::{Fit, FlatNode, FlatRef, PortType, nearest};
use sabi_nodes::kind::{ParamValue, Shape};

use crate::channels::channels;
use crate::error::{PlanError, Problem};
use crate::inputs::{LinkedInputs, ports};
use crate::muting::NodePorts;
use crate::packing::{ParamPacking, pack_params};
use crate::parameter_values::{read_knobs, read_params};
use crate::request::{Planner, Target};
use crate::resolved_graph::{Behavior, ResolvedGraph, ResolvedNode};
use crate::source_values::SourceValues;

/// Version of all kinds of the engine.
const ENGINE_KIND_VERSION: u32 = 1;

impl<'a> Planner<'a> {
    /// Resolves what the targets need.
    pub fn resolve(&self, targets: &[Target]) -> ResolvedGraph<'a> {
        let count = self.graph.nodes.len();
        let mut resolved = ResolvedGraph {
            nodes: (0..count).map(|_| None).collect(),
            ..ResolvedGraph::default()
        };
        for node in self.evaluation_order(targets) {
            match self.resolve_node(node, &resolved) {
                Ok(Some(ready)) => {
                    resolved.nodes[node] = Some(ready);
                    resolved.order.push(node);
                }
                Ok(None) => {}
                Err(errors) => resolved.errors.extend(errors),
            }
            let warnings = self.unknown_params(node);
            resolved.errors.extend(warnings);
        }
        resolved
    }

    /// The behavior of a node's kind.
    pub fn behavior(&self, node: &FlatNode) -> Result<Behavior<'a>, Problem> {
        let own = self.sources.get(&node.kind).map(Behavior::Source);
        if let Some(own) = own.or_else(|| self.sinks.get(&node.kind).map(Behavior::Sink)) {
            return match node.version {
                0..=ENGINE_KIND_VERSION => Ok(own),
                wanted => Err(Problem::NewerKind {
                    wanted,
                    loaded: ENGINE_KIND_VERSION,
                }),
            };
        }
        let Some(kind) = self.library.kind(&node.kind) else {
            let own = self.sources.keys().chain(self.sinks.keys()).map(String::as_str);
            let known = own.chain(self.library.kinds().map(|kind| kind.id.as_str()));
            return Err(Problem::UnknownKind {
                nearest: nearest(&node.kind, known).map(str::to_owned),
            });
        };
        if node.version > kind.version {
            return Err(Problem::NewerKind {
                wanted: node.version,
                loaded: kind.version,
            });
        }
        Ok(Behavior::Shader(kind))
    }

    /// Resolves a node; `Ok(None)` where a node that it depends on has a problem.
    fn resolve_node(
        &self,
        index: usize,
        resolved: &ResolvedGraph<'a>,
    ) -> Result<Option<ResolvedNode<'a>>, Vec<PlanError>> {
        let node = &self.graph.nodes[index];
        let at_fault = |problem| PlanError {
            node: node.id.clone(),
            kind: node.kind.clone(),
            problem,
        };
        let behavior = self.behavior(node).map_err(|problem| vec![at_fault(problem)])?;
        if node.muted {
            return Ok(None);
        }
        let mut problems = Vec::new();
        let LinkedInputs {
            inputs,
            masked_params,
            is_blocked,
        } = self.linked_inputs(node, behavior, resolved, &mut problems);
        let values = self.with_limited_rays(behavior, read_params(behavior.params(), node, &mut problems));
        let knobs = knobs_of(behavior, node, &mut problems);
        problems.extend(self.file_fault(index));
        if !problems.is_empty() {
            return Err(problems.into_iter().map(at_fault).collect());
        }
        if is_blocked {
            return Ok(None);
        }
        let (params, source_values) = self.pack(behavior, node, &values);
        let mut ready = ResolvedNode {
            behavior,
            inputs,
            masked_params,
            params,
            is_by_piece: is_by_piece(behavior, node),
            source_values,
            knobs,
            values,
            channels: Vec::new(),
            key: [0; 32],
        };
        ready.channels = channels(&ready, resolved);
        ready.key = self.node_key(index, &ready, resolved);
        Ok(Some(ready))
    }

    fn pack(&self, behavior: Behavior<'_>, node: &FlatNode, values: &[ParamValue]) -> (Vec<u8>, SourceValues) {
        let packing = ParamPacking {
            seeds: &node.seeds,
            working_from_length: self.working_from_length(behavior, node),
            working_from_absolute: self.working_from_absolute(node),
            extent: self.lengths.extent,
        };
        match behavior {
            Behavior::Shader(kind) => (pack_params(kind, values, &packing), SourceValues::default()),
            Behavior::Source(kind) | Behavior::Sink(kind) => {
                (Vec::new(), SourceValues::new(&kind.params, values, &packing))
            }
        }
    }

    /// Returns the factor from a node's lengths to working units; for lengths that are shares of a piece, to shares of the piece.
    pub(crate) fn working_from_length(&self, behavior: Behavior<'_>, node: &FlatNode) -> f64 {
        if is_by_piece(behavior, node) {
            return node.length_scale;
        }
        node.length_scale * (self.lengths.working_from)(&node.fit)
    }

    pub(crate) fn find_output(&self, from: &FlatRef) -> Option<(usize, PortType)> {
        let find = |names: &[(&str, PortType)]| {
            let index = match &from.port {
                None => 0,
                Some(port) => names.iter().position(|(name, _)| name == port)?,
            };
            names.get(index).map(|(_, ty)| (index, *ty))
        };
        match self.behavior(&self.graph.nodes[from.node]).ok()? {
            Behavior::Shader(kind) => find(
                &kind
                    .outputs
                    .iter()
                    .map(|output| (output.name.as_str(), output.ty))
                    .collect::<Vec<_>>(),
            ),
            Behavior::Source(kind) | Behavior::Sink(kind) => find(
                &kind
                    .outputs
                    .iter()
                    .map(|output| (output.name.as_str(), output.ty))
                    .collect::<Vec<_>>(),
            ),
        }
    }

    /// Returns the problems of parameters that the kind does not have. They stay in the file without effect.
    fn unknown_params(&self, index: usize) -> Vec<PlanError> {
        let node = &self.graph.nodes[index];
        let Ok(behavior) = self.behavior(node) else {
            return Vec::new();
        };
        let params = behavior.params().iter();
        let names = params.flat_map(|param| std::iter::once(&param.name).chain(&param.formerly));
        let knobs = match behavior {
            Behavior::Shader(kind) => kind.inputs.as_slice(),
            Behavior::Source(_) | Behavior::Sink(_) => &[],
        };
        let known: Vec<&str> = names
            .chain(knobs.iter().map(|input| &input.name))
            .map(String::as_str)
            .collect();
        let unknown = node.params.keys().filter(|name| !known.contains(&name.as_str()));
        let problem = |name: &String| Problem::UnknownParam {
            param: name.clone(),
            nearest: nearest(name, known.iter().copied()).map(str::to_owned),
        };
        unknown
            .map(|name| PlanError {
                node: node.id.clone(),
                kind: node.kind.clone(),
                problem: problem(name),
            })
            .collect()
    }
}

impl NodePorts for Planner<'_> {
    fn output(&self, node: usize, port: Option<&str>) -> Option<PortType> {
        self.find_output(&FlatRef {
            node,
            port: port.map(str::to_owned),
        })
        .map(|(_, ty)| ty)
    }

    fn inputs(&self, node: usize) -> Vec<(String, PortType)> {
        let behavior = match self.behavior(&self.graph.nodes[node]) {
            // An input of a source is a position at which it is read, which a muted source cannot pass on.
            Err(_) | Ok(Behavior::Source(_)) => return Vec::new(),
            Ok(behavior) => behavior,
        };
        ports(behavior)
            .into_iter()
            .map(|port| (port.name.to_owned(), port.ty))
            .collect()
    }
}

/// Knob values by input; sources and sinks have none.
fn knobs_of(behavior: Behavior<'_>, node: &FlatNode, problems: &mut Vec<Problem>) -> Vec<Option<Vec<f32>>> {
    match behavior {
        Behavior::Shader(kind) => read_knobs(kind, node, problems),
        Behavior::Source(_) | Behavior::Sink(_) => Vec::new(),
    }
}

/// Returns true if the lengths of a node are multiplied by the size of the piece at every place. Surveys and sources are
/// evaluated for the whole surface at once, so their lengths are multiplied by the mean size of the pieces instead.
/// Formulas of fields use the size of the largest piece.
fn is_by_piece(behavior: Behavior<'_>, node: &FlatNode) -> bool {
    let Behavior::Shader(kind) = behavior else {
        return false;
    };
    kind.shape != Shape::Survey && node.fit == Fit::Piece
}
