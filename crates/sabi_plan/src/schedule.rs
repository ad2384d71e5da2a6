//! Planning: orders groups of nodes so that few results are stored at the same time, and builds the steps of each group.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::PortType;
use sabi_nodes::link::{Binding, Convert, Domain, Operand, Plane, StoredLayout, channel_bits};

use crate::error::{PlanError, Problem};
use crate::fuse::{self, FusionGroup, ResultRef};
use crate::group_order::GroupOrder;
use crate::kernel_builder::KernelBuilder;
use crate::keys::result_key;
use crate::plan::{Plan, SourceStep, Step};
use crate::request::{Mode, Planner, Target};
use crate::resolved_graph::{Behavior, ResolvedGraph};
use crate::resources::{Resource, UnassignedStep};
use crate::step_builder::StepBuilder;

impl Planner<'_> {
    /// Plans everything that the targets need, except nodes with problems and nodes that depend on them. Also returns the problems.
    pub fn plan(&self, targets: &[Target]) -> (Plan, Vec<PlanError>) {
        let mut resolved = self.resolve(targets);
        let mut errors = std::mem::take(&mut resolved.errors);
        let mut wanted: Vec<(Target, ResultRef)> = Vec::new();
        for target in targets {
            match self.wanted_value(&resolved, target) {
                Ok(Some(value)) => wanted.push((target.clone(), value)),
                Ok(None) => {}
                Err(error) => errors.push(*error),
            }
        }
        let values: Vec<ResultRef> = wanted.iter().map(|(_, value)| *value).collect();
        let readers = fuse::readers(&resolved);
        let groups = fuse::groups(&resolved, &readers, &values, self.mode, &self.limits);
        let builder = StepBuilder::new(self, &resolved, &groups, readers);
        let built: Vec<Vec<UnassignedStep>> = groups.iter().map(|group| builder.steps(group, &values)).collect();
        let order = GroupOrder::new(&builder, &groups, &built, &values).order(self.mode);
        let mut steps = in_order(built, &order);
        keep_first_moves(&mut steps);
        (builder.assign_slots(steps, wanted), errors)
    }

    /// Result of a target; `None` where it depends on a node with a problem, or is muted and passes nothing on.
    fn wanted_value(&self, resolved: &ResolvedGraph<'_>, target: &Target) -> Result<Option<ResultRef>, Box<PlanError>> {
        let node = &self.graph.nodes[target.node];
        let Ok(behavior) = self.behavior(node) else {
            return Ok(None);
        };
        let names: Vec<&str> = match behavior {
            Behavior::Sink(kind) => kind.inputs.iter().map(|input| input.name.as_str()).collect(),
            Behavior::Source(kind) => kind.outputs.iter().map(|output| output.name.as_str()).collect(),
            Behavior::Shader(kind) => kind.outputs.iter().map(|output| output.name.as_str()).collect(),
        };
        let found = match &target.port {
            None => (!names.is_empty()).then_some(0),
            Some(port) => names.iter().position(|name| name == port),
        };
        let Some(index) = found else {
            let known = names.iter().map(|name| (*name).to_owned()).collect();
            let problem = Problem::NoSuchResult {
                output: target.port.clone(),
                known,
            };
            return Err(Box::new(PlanError {
                node: node.id.clone(),
                kind: node.kind.clone(),
                problem,
            }));
        };
        if let Behavior::Sink(_) = behavior {
            let ready = resolved.nodes[target.node].as_ref();
            return Ok(ready.and_then(|ready| ready.inputs[index].map(|input| (input.node, input.output))));
        }
        let value = self.target_origin(target).and_then(|from| {
            let (output, _) = self.find_output(&from)?;
            resolved.nodes[from.node].as_ref().map(|_| (from.node, output))
        });
        Ok(value)
    }
}

/// Returns the steps of groups in this order. Groups that are not in the order are left out.
fn in_order(built: Vec<Vec<UnassignedStep>>, order: &[usize]) -> Vec<UnassignedStep> {
    let mut built: Vec<Option<Vec<UnassignedStep>>> = built.into_iter().map(Some).collect();
    order
        .iter()
        .filter_map(|group| built[*group].take())
        .flatten()
        .collect()
}

/// Keeps only the first of several moves of the same plane to the same level.
fn keep_first_moves(steps: &mut Vec<UnassignedStep>) {
    let mut moved = BTreeSet::new();
    steps.retain(|unassigned| match unassigned.step {
        Step::Move(_) => unassigned.writes.iter().flatten().any(|plane| moved.insert(*plane)),
        _ => true,
    });
}

impl StepBuilder<'_, '_> {
    /// Builds the steps of a group.
    fn steps(&self, group: &FusionGroup, wanted: &[ResultRef]) -> Vec<UnassignedStep> {
        match group {
            FusionGroup::Source { node, outputs } => self.source(*node, outputs),
            FusionGroup::Field { node, outputs } => self.field(*node, outputs),
            FusionGroup::Rays { node, outputs } => self.rays(*node, outputs),
            FusionGroup::Survey { node, outputs } => self.survey(*node, outputs),
            FusionGroup::Points(members) if self.planner.mode == Mode::Interactive => members
                .iter()
                .map(|(node, outputs)| self.single(*node, outputs[0]))
                .collect(),
            FusionGroup::Points(members) => vec![self.points(members, wanted)],
        }
    }

    /// Builds the step of a source, after copies of its inputs in the types that it reads.
    fn source(&self, node: usize, outputs: &[usize]) -> Vec<UnassignedStep> {
        let ready = self.node(node);
        let mut steps = Vec::new();
        let mut reads = Vec::new();
        for (index, input) in ready.inputs.iter().enumerate() {
            reads.push(input.and_then(|input| {
                let resource = if input.convert == Convert::None {
                    Resource::result((input.node, input.output))
                } else {
                    let (step, converted) = self.conversion(node, index, input);
                    steps.push(step);
                    converted
                };
                Some((resource, self.read_plane(node, index)?))
            }));
        }
        let mut writes = Vec::new();
        let mut names = Vec::new();
        let mut keys = Vec::new();
        for output in outputs {
            let planes = self.stored((node, *output)).planes();
            let (name, _) = self.output((node, *output));
            keys.push(result_key(ready, name));
            names.push((name.to_owned(), planes.iter().map(|plane| (*plane, 0)).collect()));
            writes.extend(
                planes
                    .into_iter()
                    .map(|plane| Some((Resource::result((node, *output)), plane))),
            );
        }
        let step = SourceStep {
            node,
            id: self.id(node),
            kind: self.planner.graph.nodes[node].kind.clone(),
            values: ready.source_values.clone(),
            reads: Vec::new(),
            writes: names,
            keys,
        };
        steps.push(UnassignedStep {
            step: Step::Source(step),
            reads,
            writes,
            scratch: None,
        });
        steps
    }

    /// Returns the plane of an input of a source; `None` for a material, which has several planes and which no source reads.
    fn read_plane(&self, node: usize, input: usize) -> Option<Plane> {
        let Behavior::Source(kind) = self.node(node).behavior else {
            return None;
        };
        let stored = StoredLayout {
            ty: kind.inputs.get(input)?.ty,
            channels: Vec::new(),
        };
        stored.planes().first().copied()
    }

    /// Builds a region of point nodes as one kernel.
    fn points(&self, members: &[(usize, Vec<usize>)], wanted: &[ResultRef]) -> UnassignedStep {
        let group = self.producer[&(members[0].0, members[0].1[0])];
        let mut kernel = KernelBuilder::new(self, Domain::AllTexels);
        let mut call_of: BTreeMap<ResultRef, usize> = BTreeMap::new();
        for (node, outputs) in members {
            let block = kernel.block(*node);
            for output in outputs {
                let bindings = self.node(*node).inputs.iter().map(|input| match input {
                    None => Binding::Default,
                    Some(input) => match call_of.get(&(input.node, input.output)) {
                        Some(call) => Binding::Value(Operand::Call(*call, input.convert)),
                        None => Binding::Value(Operand::Load(kernel.load((input.node, input.output)), input.convert)),
                    },
                });
                let inputs = bindings.collect();
                let masks = kernel.param_masks(*node, |value| call_of.get(&value).copied());
                let call = kernel.call_with(*node, *output, inputs, masks, block);
                call_of.insert((*node, *output), call);
            }
        }
        for (value, call) in &call_of {
            if wanted.contains(value) || self.is_read_outside(*value, group) {
                kernel.store(*call, *value);
            }
        }
        kernel.finish()
    }

    /// Builds a result of a point node as a kernel that is independent of the node's links.
    fn single(&self, node: usize, output: usize) -> UnassignedStep {
        let Behavior::Shader(kind) = self.node(node).behavior else {
            unreachable!("points are shaders")
        };
        let mut kernel = KernelBuilder::new(self, Domain::AllTexels);
        let block = kernel.block(node);
        let mut flags = [0_u32; 4];
        let mut inputs = Vec::new();
        let mut materials = 0;
        for (index, (port, input)) in kind.inputs.iter().zip(&self.node(node).inputs).enumerate() {
            let channels = if port.ty == PortType::Material {
                self.switched_channels.to_vec()
            } else {
                Vec::new()
            };
            let from = input.map(|input| (input.node, input.output));
            inputs.push(Binding::Switch(
                kernel.switched_load(from, StoredLayout { ty: port.ty, channels }),
            ));
            if let Some(input) = input {
                flags[0] |= mode_bits(input.ty, port.ty) << (2 * index);
                let present = &self.node(input.node).channels[input.output];
                let bits = present.iter().fold(0, |bits, channel| bits | 1 << (*channel as u32));
                if port.ty == PortType::Material {
                    let (word, shift) = channel_bits(materials);
                    flags[word] |= bits << shift;
                }
            }
            materials += usize::from(port.ty == PortType::Material);
        }
        let call = kernel.call(node, output, inputs, block);
        kernel.store_switched(call, (node, output));
        kernel.flags = flags;
        kernel.finish()
    }
}

/// Flag bits of an input: 1 as it is, 2 gray to color, 3 luminance.
fn mode_bits(from: PortType, to: PortType) -> u32 {
    match (from, to) {
        (PortType::Mask, PortType::Color) => 2,
        (PortType::Color, PortType::Mask) => 3,
        _ => 1,
    }
}
