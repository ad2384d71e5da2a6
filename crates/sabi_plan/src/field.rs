//! Steps of field nodes: passes that read stored textures, each on the level that it requests.

use sabi_graph::PortType;
use sabi_nodes::formula::{Formula, Variables};
use sabi_nodes::kind::{Argument, InputDefault, Kind, Memory, Output, Reads, Role};
use sabi_nodes::link::{Binding, Convert, Domain, Operand, Plane};

use crate::fuse::ResultRef;
use crate::kernel_builder::{KernelBuilder, Repetition};
use crate::keys::result_key;
use crate::level::Level;
use crate::plan::{MoveStep, Step};
use crate::resolved_graph::{Behavior, ResolvedInput, ResolvedNode};
use crate::resources::{Resource, TextureContent, UnassignedStep};
use crate::step_builder::StepBuilder;

/// Maximum number of runs of a repeated function.
const RUN_LIMIT: f64 = 4096.0;

impl StepBuilder<'_, '_> {
    /// Builds the passes and results of a field node, each as a kernel.
    pub(crate) fn field(&self, node: usize, outputs: &[usize]) -> Vec<UnassignedStep> {
        let Behavior::Shader(kind) = self.node(node).behavior else {
            unreachable!("fields are shaders")
        };
        let mut passes = passes_behind(kind, outputs);
        passes.retain(|pass| self.is_needed(node, kind, *pass));
        passes.sort_by_key(|pass| kind.passes[*pass].number);
        let passes = passes.into_iter().map(|pass| {
            let function = &kind.passes[pass].function;
            let level = self.level(self.node(node), kind, [&function.texel, &function.points]);
            (
                function,
                Resource {
                    content: TextureContent::Pass(node, pass),
                    level,
                },
            )
        });
        let results = outputs
            .iter()
            .map(|output| (&kind.outputs[*output], Resource::result((node, *output))));
        let mut built = self.conversions(node);
        let functions: Vec<_> = passes.chain(results).collect();
        let written: Vec<Resource> = functions.iter().map(|(_, resource)| *resource).collect();
        for (index, (function, resource)) in functions.iter().enumerate() {
            let step = self.field_step(node, kind, function, *resource, index);
            built.extend(self.level_moves(node, &step, &written));
            built.push(step);
        }
        built
    }

    /// Returns whether a pass runs. A pass that exists for an input runs only if something is connected to it, or if the
    /// parameter of the input differs from its default.
    fn is_needed(&self, node: usize, kind: &Kind, pass: usize) -> bool {
        let Some(input) = kind.passes[pass].with else {
            return true;
        };
        let ready = self.node(node);
        let knob = ready.knobs.get(input).and_then(Option::as_ref);
        let default = match &kind.inputs[input].default {
            InputDefault::Knob(default) => Some(default),
            _ => None,
        };
        ready.inputs[input].is_some() || knob != default
    }

    /// Returns the widest points that are not farther apart than requested; if there are none, the coarsest level whose
    /// texels are not wider than requested.
    pub(crate) fn level(&self, ready: &ResolvedNode<'_>, kind: &Kind, [texel, points]: [&Option<Formula>; 2]) -> Level {
        let widths = self.planner.level_widths;
        let variables = Variables {
            param: &|param| self.largest_value(ready, kind, param),
            texel: widths.finest,
            finest: widths.finest,
        };
        // Points have the same density on small and large pieces, so a width that is large on the largest piece may be too
        // small on another.
        let points = points.as_ref().filter(|_| !ready.is_by_piece);
        let points = points.map(|formula| formula.value(&variables));
        let points = points.and_then(|spacing| widths.widest_points_within(spacing));
        let texels = texel.as_ref().map(|formula| formula.value(&variables));
        let texels = texels.map(|width| widths.coarsest_texels_within(width));
        points.or(texels).unwrap_or(Level::FINEST)
    }

    /// Returns the value of a parameter for formulas of levels and repetitions, which are the same for the whole surface.
    /// For a length that is a share of each piece, it is the length on the largest piece.
    fn largest_value(&self, ready: &ResolvedNode<'_>, kind: &Kind, param: usize) -> f64 {
        let value = working_value(ready, kind, param);
        let of_piece = &kind.params[param];
        if ready.is_by_piece && of_piece.ty.role == Role::Length && !of_piece.is_absolute {
            return value * self.planner.lengths.largest_piece;
        }
        value
    }

    /// Number of runs of a function.
    fn run_count(&self, ready: &ResolvedNode<'_>, kind: &Kind, function: &Output, level: Level) -> u32 {
        let Some(repeat) = &function.repeat else { return 1 };
        let widths = self.planner.level_widths;
        let variables = Variables {
            param: &|param| self.largest_value(ready, kind, param),
            texel: widths.of(level),
            finest: widths.finest,
        };
        let runs = repeat.value(&variables).ceil();
        // NaN counts as one run.
        if runs > 1.0 { runs.min(RUN_LIMIT) as u32 } else { 1 }
    }

    /// Builds conversions of inputs of another type. They are needed since reading a texture does not convert.
    fn conversions(&self, node: usize) -> Vec<UnassignedStep> {
        let inputs = self.node(node).inputs.iter().enumerate();
        let converted = inputs.filter_map(|(index, input)| {
            let input = input.filter(|input| input.reads == Reads::Field && input.convert != Convert::None)?;
            Some(self.conversion(node, index, input).0)
        });
        converted.collect()
    }

    /// Builds a copy of an input in the type that it is read as.
    pub(crate) fn conversion(&self, node: usize, index: usize, input: ResolvedInput) -> (UnassignedStep, Resource) {
        let mut kernel = KernelBuilder::new(self, Domain::AllTexels);
        let load = kernel.load((input.node, input.output));
        let ty = if input.ty == PortType::Mask {
            PortType::Color
        } else {
            PortType::Mask
        };
        let resource = Resource {
            content: TextureContent::Converted(node, index),
            level: Level::FINEST,
        };
        kernel.store_resource(Operand::Load(load, input.convert), resource, ty);
        (kernel.finish(), resource)
    }

    fn field_step(
        &self,
        node: usize,
        kind: &Kind,
        function: &Output,
        resource: Resource,
        index: usize,
    ) -> UnassignedStep {
        let reads_textures = function.arguments.iter().any(|argument| match argument {
            Argument::Pass(_) => true,
            Argument::Input(input) => kind.inputs[*input].reads == Reads::Field,
            _ => false,
        });
        // A function that reads no texture is also evaluated for ghosts. Otherwise ghosts are filled across their links.
        let domain = if reads_textures {
            Domain::OwnedTexels
        } else {
            Domain::AllTexels
        };
        let mut kernel = KernelBuilder::new(self, domain);
        kernel.level = resource.level;
        let block = kernel.block(node);
        let ready = self.node(node);
        let inputs = self.field_inputs(node, kind, function, &mut kernel);
        let (passes, first_field) = self.pass_loads(node, kind, function, &inputs, &mut kernel);
        let reads_params = function.arguments.contains(&Argument::Params);
        let param_masks = if reads_params {
            kernel.param_masks(node, |_| None)
        } else {
            Vec::new()
        };
        let call = kernel.call_function(node, kind, function, inputs, param_masks, block);
        kernel.spec.calls[call].passes = passes;
        store_result(&mut kernel, resource, function.ty);
        let run_count = self.run_count(ready, kind, function, resource.level);
        kernel.repetition = first_field.filter(|_| run_count > 1).map(|load| Repetition {
            run_count,
            load,
            scratch: Resource {
                content: TextureContent::Scratch(node, index),
                level: resource.level,
            },
        });
        kernel.finish()
    }

    /// Returns the loads of the passes that a function reads, and of the first texture that it reads. That texture replaces
    /// passes that do not run; if there is none, the function reads 0.
    fn pass_loads(
        &self,
        node: usize,
        kind: &Kind,
        function: &Output,
        inputs: &[Binding],
        kernel: &mut KernelBuilder<'_, '_, '_>,
    ) -> (Vec<Option<usize>>, Option<usize>) {
        let is_read = |pass: usize| function.arguments.contains(&Argument::Pass(pass));
        let loads: Vec<Option<usize>> = (0..kind.passes.len())
            .map(|pass| {
                (is_read(pass) && self.is_needed(node, kind, pass))
                    .then(|| kernel.load_resource(TextureContent::Pass(node, pass), kind.passes[pass].function.ty))
            })
            .collect();
        let first = function.arguments.iter().find_map(|argument| match argument {
            Argument::Pass(pass) => loads[*pass],
            Argument::Input(input) => match inputs[*input] {
                Binding::Field(load) => Some(load),
                _ => None,
            },
            _ => None,
        });
        let with_stand_ins = loads.into_iter().enumerate().map(|(pass, load)| {
            let stand_in = || first.unwrap_or_else(|| kernel.load_nothing(kind.passes[pass].function.ty));
            is_read(pass).then(|| load.unwrap_or_else(stand_in))
        });
        (with_stand_ins.collect(), first)
    }

    /// Bindings of the inputs of a function: values at the place, or textures.
    fn field_inputs(
        &self,
        node: usize,
        kind: &Kind,
        function: &Output,
        kernel: &mut KernelBuilder<'_, '_, '_>,
    ) -> Vec<Binding> {
        let mut inputs = Vec::new();
        for (index, input) in self.node(node).inputs.iter().enumerate() {
            let is_read = function.arguments.contains(&Argument::Input(index));
            inputs.push(match input {
                Some(input) if is_read && input.reads == Reads::Value => {
                    Binding::Value(Operand::Load(kernel.load((input.node, input.output)), input.convert))
                }
                Some(input) if is_read && input.convert != Convert::None => {
                    Binding::Field(kernel.load_resource(TextureContent::Converted(node, index), kind.inputs[index].ty))
                }
                Some(input) if is_read => Binding::Field(kernel.load((input.node, input.output))),
                _ => Binding::Default,
            });
        }
        inputs
    }

    /// Builds moves of planes that a step reads from other levels. Between two other levels, planes are moved by way of the
    /// finest one. `written` lists the planes that the node itself writes.
    pub(crate) fn level_moves(&self, node: usize, step: &UnassignedStep, written: &[Resource]) -> Vec<UnassignedStep> {
        let reads = step.reads.iter().flatten();
        let moved = reads.flat_map(|(resource, plane)| {
            let own = written.iter().find(|own| own.content == resource.content);
            // Everything else is on the finest level.
            let level = own.map_or(Level::FINEST, |own| own.level);
            if level == resource.level {
                return Vec::new();
            }
            self.planner
                .level_widths
                .moves(level, resource.level)
                .into_iter()
                .map(|levels| self.level_move(node, resource.content, *plane, levels, None))
                .collect::<Vec<_>>()
        });
        moved.collect()
    }

    /// Moves all planes of a result to the finest level.
    pub(crate) fn result_moves(&self, value: ResultRef, level: Level) -> Vec<UnassignedStep> {
        let (name, _) = self.output(value);
        let key = result_key(self.node(value.0), name);
        let planes = self.stored(value).planes().into_iter();
        let moved = |plane| {
            self.level_move(
                value.0,
                TextureContent::Result(value),
                plane,
                [level, Level::FINEST],
                Some((key, plane)),
            )
        };
        planes.map(moved).collect()
    }

    fn level_move(
        &self,
        node: usize,
        content: TextureContent,
        plane: Plane,
        levels: [Level; 2],
        result: Option<([u8; 32], Plane)>,
    ) -> UnassignedStep {
        let [from, to] = levels.map(|level| Some((Resource { content, level }, plane)));
        UnassignedStep {
            step: Step::Move(MoveStep {
                node: self.id(node),
                from: 0,
                to: 0,
                format: plane.format(),
                levels,
                result,
            }),
            reads: vec![from],
            writes: vec![to],
            scratch: None,
        }
    }
}

/// Stores the result of the only call: for a material, all planes that it sets.
fn store_result(kernel: &mut KernelBuilder<'_, '_, '_>, resource: Resource, ty: PortType) {
    match resource.content {
        TextureContent::Result(value) => kernel.store(0, value),
        _ => kernel.store_resource(Operand::Call(0, Convert::None), resource, ty),
    }
}

/// Passes whose results these outputs read, directly or through other passes.
fn passes_behind(kind: &Kind, outputs: &[usize]) -> Vec<usize> {
    let mut found: Vec<usize> = Vec::new();
    let mut next: Vec<&Output> = outputs.iter().map(|output| &kind.outputs[*output]).collect();
    while let Some(function) = next.pop() {
        for argument in &function.arguments {
            if let Argument::Pass(pass) = argument
                && !found.contains(pass)
            {
                found.push(*pass);
                next.push(&kind.passes[*pass].function);
            }
        }
    }
    found
}

/// Returns the value of a parameter as in its buffer: lengths in working units or as shares of the piece, angles in radians.
pub(crate) fn working_value(ready: &ResolvedNode<'_>, kind: &Kind, param: usize) -> f64 {
    let param = &kind.params[param];
    let Some(bytes) = ready.params[param.offset as usize..].first_chunk() else {
        unreachable!("'{}' of '{}' lies inside of its struct", param.name, kind.id)
    };
    match param.ty.memory {
        Memory::F32 => f64::from(f32::from_le_bytes(*bytes)),
        Memory::I32 => f64::from(i32::from_le_bytes(*bytes)),
        Memory::U32 => f64::from(u32::from_le_bytes(*bytes)),
        Memory::Vec2 | Memory::Vec3 | Memory::Vec4 | Memory::Points(_) | Memory::Text => {
            unreachable!(
                "'{}' of '{}' is in a formula, which takes numbers alone",
                param.name, kind.id
            )
        }
    }
}
