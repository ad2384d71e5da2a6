//! Steps of field nodes: passes that read stored textures, each on the level that it requests.

use sabi_graph::PortType;
use sabi_nodes::formula::{Formula, Knowns};
use sabi_nodes::kind::{Argument, Kind, Memory, Output, Reads};
use sabi_nodes::link::{Binding, Call, Convert, Domain, Operand, Plane, Stored};

use crate::draft::{Content, Draft, KernelDraft, Resident};
use crate::plan::{MoveStep, Step};
use crate::resolve::{Behavior, ResolvedInput, ResolvedNode};
use crate::schedule::Builder;

/// Most runs of a repeated function.
const REPEAT_LIMIT: f64 = 4096.0;

impl Builder<'_, '_> {
    /// Drafts the passes of a field node and its results, one kernel each.
    pub(crate) fn field(&self, node: usize, outputs: &[usize]) -> Vec<Draft> {
        let Behavior::Shader(kind) = self.node(node).behavior else {
            unreachable!("fields are shaders")
        };
        let mut passes: Vec<usize> = (0..kind.passes.len()).collect();
        passes.sort_by_key(|pass| kind.passes[*pass].number);
        let passes = passes.into_iter().map(|pass| {
            let function = &kind.passes[pass].function;
            let level = self.level(self.node(node), kind, function.texel.as_ref());
            (
                function,
                Resident {
                    content: Content::Pass(node, pass),
                    level,
                },
            )
        });
        let results = outputs
            .iter()
            .map(|output| (&kind.outputs[*output], Resident::result((node, *output))));
        let mut drafts = self.conversions(node);
        let steps: Vec<_> = passes.chain(results).collect();
        for (index, (function, resident)) in steps.iter().enumerate() {
            let step = self.field_step(node, kind, function, *resident, index);
            drafts.extend(self.moves(node, &step, &steps));
            drafts.push(step);
        }
        drafts
    }

    /// Coarsest level with texels no wider than requested.
    fn level(&self, ready: &ResolvedNode<'_>, kind: &Kind, texel: Option<&Formula>) -> u32 {
        let Some(texel) = texel else { return 0 };
        let levels = self.planner.levels;
        let finest = levels.first().copied().unwrap_or(1.0);
        let knowns = Knowns {
            param: &|param| working_value(ready, kind, param),
            texel: finest,
            finest,
        };
        let widest = texel.value(&knowns);
        let fits = levels.iter().take_while(|width| **width <= widest).count();
        fits.saturating_sub(1) as u32
    }

    /// Number of runs of a function.
    fn times(&self, ready: &ResolvedNode<'_>, kind: &Kind, function: &Output, level: u32) -> u32 {
        let Some(repeat) = &function.repeat else { return 1 };
        let width = |level: u32| self.planner.levels.get(level as usize).copied().unwrap_or(1.0);
        let knowns = Knowns {
            param: &|param| working_value(ready, kind, param),
            texel: width(level),
            finest: width(0),
        };
        let times = repeat.value(&knowns).ceil();
        // NaN counts as one run.
        if times > 1.0 { times.min(REPEAT_LIMIT) as u32 } else { 1 }
    }

    /// Drafts conversions of inputs of another type, since reading a texture does not convert.
    fn conversions(&self, node: usize) -> Vec<Draft> {
        let inputs = self.node(node).inputs.iter().enumerate();
        let converted = inputs.filter_map(|(index, input)| {
            let input = input.filter(|input| input.reads == Reads::Field && input.convert != Convert::None)?;
            Some(self.conversion(node, index, input).0)
        });
        converted.collect()
    }

    /// Drafts a copy of an input in the type that it is read as.
    pub(crate) fn conversion(&self, node: usize, index: usize, input: ResolvedInput) -> (Draft, Resident) {
        let mut kernel = KernelDraft::new(self, Domain::AllTexels);
        let load = kernel.load((input.node, input.output));
        let stored = Stored {
            ty: if input.ty == PortType::Mask {
                PortType::Color
            } else {
                PortType::Mask
            },
            channels: Vec::new(),
        };
        let resident = Resident {
            content: Content::Converted(node, index),
            level: 0,
        };
        kernel.store_resident(Operand::Load(load, input.convert), resident, stored);
        (kernel.finish(), resident)
    }

    fn field_step(&self, node: usize, kind: &Kind, function: &Output, resident: Resident, index: usize) -> Draft {
        let reads_textures = function.arguments.iter().any(|argument| match argument {
            Argument::Pass(_) => true,
            Argument::Input(input) => kind.inputs[*input].reads == Reads::Field,
            _ => false,
        });
        // A function that reads no texture is evaluated on ghosts, too; otherwise they are filled over their links.
        let domain = if reads_textures {
            Domain::OwnedTexels
        } else {
            Domain::AllTexels
        };
        let mut kernel = KernelDraft::new(self, domain);
        kernel.level = resident.level;
        let block = kernel.block(node);
        let ready = self.node(node);
        let inputs = self.field_inputs(node, kind, function, &mut kernel);
        let pass_is_read = |pass: usize| function.arguments.contains(&Argument::Pass(pass));
        let passes: Vec<Option<usize>> = (0..kind.passes.len())
            .map(|pass| {
                pass_is_read(pass)
                    .then(|| kernel.load_resident(Content::Pass(node, pass), kind.passes[pass].function.ty))
            })
            .collect();
        let first_field = function.arguments.iter().find_map(|argument| match argument {
            Argument::Pass(pass) => passes[*pass],
            Argument::Input(input) => match inputs[*input] {
                Binding::Field(load) => Some(load),
                _ => None,
            },
            _ => None,
        });
        kernel.spec.calls.push(Call {
            kind: kind.id.clone(),
            function: function.name.clone(),
            inputs,
            passes,
            survey: None,
            block,
        });
        let stored = Stored {
            ty: function.ty,
            channels: Vec::new(),
        };
        kernel.store_resident(Operand::Call(0, Convert::None), resident, stored);
        let times = self.times(ready, kind, function, resident.level);
        kernel.repeat = first_field.filter(|_| times > 1).map(|read| {
            let content = Content::Scratch(node, index);
            (
                times,
                read,
                Resident {
                    content,
                    level: resident.level,
                },
            )
        });
        kernel.finish()
    }

    /// Bindings of the inputs of a function: values at the place, or textures.
    fn field_inputs(
        &self,
        node: usize,
        kind: &Kind,
        function: &Output,
        kernel: &mut KernelDraft<'_, '_, '_>,
    ) -> Vec<Binding> {
        let mut inputs = Vec::new();
        for (index, input) in self.node(node).inputs.iter().enumerate() {
            let is_read = function.arguments.contains(&Argument::Input(index));
            inputs.push(match input {
                Some(input) if is_read && input.reads == Reads::Value => {
                    Binding::Value(Operand::Load(kernel.load((input.node, input.output)), input.convert))
                }
                Some(input) if is_read && input.convert != Convert::None => {
                    Binding::Field(kernel.load_resident(Content::Converted(node, index), kind.inputs[index].ty))
                }
                Some(input) if is_read => Binding::Field(kernel.load((input.node, input.output))),
                _ => Binding::Default,
            });
        }
        inputs
    }

    /// Drafts moves of what a step reads from other levels; between two coarse levels by way of the finest.
    fn moves(&self, node: usize, step: &Draft, steps: &[(&Output, Resident)]) -> Vec<Draft> {
        let reads = step.reads.iter().flatten();
        let moved = reads.flat_map(|(resident, plane)| {
            let made = steps.iter().find(|(_, made)| made.content == resident.content);
            let level = made.map_or(0, |(_, made)| made.level);
            if level == resident.level {
                return Vec::new();
            }
            let stops = [level, 0, resident.level];
            let ways = stops
                .windows(2)
                .map(|way| [way[0], way[1]])
                .filter(|[from, to]| from != to);
            ways.map(|levels| self.bring(node, resident.content, *plane, levels))
                .collect::<Vec<_>>()
        });
        moved.collect()
    }

    fn bring(&self, node: usize, content: Content, plane: Plane, levels: [u32; 2]) -> Draft {
        let [from, to] = levels.map(|level| Some((Resident { content, level }, plane)));
        Draft {
            step: Step::Move(MoveStep {
                node: self.id(node),
                from: 0,
                to: 0,
                format: plane.format(),
                levels,
            }),
            reads: vec![from],
            writes: vec![to],
            scratch: None,
        }
    }
}

/// The value of a parameter as its shader reads it: lengths in working units, angles in radians.
fn working_value(ready: &ResolvedNode<'_>, kind: &Kind, param: usize) -> f64 {
    let Some(param) = kind.params.get(param) else {
        return 0.0;
    };
    let at = param.offset as usize;
    let Some(bytes) = ready.params.get(at..at + 4) else {
        return 0.0;
    };
    let bytes = [bytes[0], bytes[1], bytes[2], bytes[3]];
    match param.ty.memory {
        Memory::F32 => f64::from(f32::from_le_bytes(bytes)),
        Memory::I32 => f64::from(i32::from_le_bytes(bytes)),
        _ => f64::from(u32::from_le_bytes(bytes)),
    }
}
