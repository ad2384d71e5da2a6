//! Drafts of steps: calls, reads and stores before slots are assigned.

use sabi_graph::PortType;
use sabi_nodes::kind::Channel;
use sabi_nodes::link::{Binding, Call, Convert, Domain, KernelSpec, Operand, Plane, Store, Stored};

use crate::fuse::{self, Value};
use crate::keys::result_key;
use crate::plan::{BlockValues, Feedback, KernelStep, Room, Step, StepRays};
use crate::resolve::Behavior;
use crate::schedule::Builder;

/// Stored content on a level of the atlas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Resident {
    pub(crate) content: Content,
    pub(crate) level: u32,
}

impl Resident {
    /// A result, which is on the finest level.
    pub(crate) fn result(value: Value) -> Resident {
        Resident {
            content: Content::Result(value),
            level: 0,
        }
    }

    /// Size of its texture.
    pub(crate) fn room(self) -> Room {
        match self.content {
            Content::Survey(_) => Room::Survey,
            Content::Found(..) => Room::Single,
            Content::Result(_) | Content::Pass(..) | Content::Scratch(..) | Content::Converted(..) => {
                Room::Level(self.level)
            }
        }
    }
}

/// Content of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Content {
    Result(Value),
    Pass(usize, usize),
    /// Second texture of a repeated function, used alternately with its result: node and index of the step.
    Scratch(usize, usize),
    /// Table of a node's survey.
    Survey(usize),
    /// Value of a pass for the whole surface: node and pass.
    Found(usize, usize),
    /// Converted value that an input of a field or a survey reads: node and index of the input.
    Converted(usize, usize),
}

/// A step before slots are assigned.
pub(crate) struct Draft {
    pub(crate) step: Step,
    pub(crate) reads: Vec<Option<(Resident, Plane)>>,
    pub(crate) writes: Vec<Option<(Resident, Plane)>>,
    pub(crate) scratch: Option<(Resident, Plane)>,
}

/// Draft of a kernel step.
pub(crate) struct KernelDraft<'b, 'p, 'a> {
    builder: &'b Builder<'p, 'a>,
    pub(crate) spec: KernelSpec,
    blocks: Vec<usize>,
    loaded: Vec<Option<Resident>>,
    reads: Vec<Option<(Resident, Plane)>>,
    writes: Vec<Option<(Resident, Plane)>>,
    pub(crate) flags: [u32; 4],
    pub(crate) repeat: Option<(u32, usize, Resident)>,
    pub(crate) rays: Option<Box<StepRays>>,
    /// Level of the atlas that the kernel runs on.
    pub(crate) level: u32,
    keys: Vec<[u8; 32]>,
}

impl<'b, 'p, 'a> KernelDraft<'b, 'p, 'a> {
    pub(crate) fn new(builder: &'b Builder<'p, 'a>, domain: Domain) -> Self {
        KernelDraft {
            builder,
            spec: KernelSpec {
                calls: Vec::new(),
                loads: Vec::new(),
                stores: Vec::new(),
                domain,
            },
            blocks: Vec::new(),
            loaded: Vec::new(),
            reads: Vec::new(),
            writes: Vec::new(),
            flags: [0; 4],
            repeat: None,
            rays: None,
            level: 0,
            keys: Vec::new(),
        }
    }

    pub(crate) fn block(&mut self, node: usize) -> usize {
        self.blocks.push(node);
        self.blocks.len() - 1
    }

    pub(crate) fn add_load(
        &mut self,
        resident: Option<Resident>,
        stored: Stored,
        planes: Vec<Option<(Resident, Plane)>>,
    ) -> usize {
        self.spec.loads.push(stored);
        self.loaded.push(resident);
        self.reads.extend(planes);
        self.loaded.len() - 1
    }

    /// Index of the load of a stored result, shared by all its readers in this kernel.
    pub(crate) fn load(&mut self, value: Value) -> usize {
        let resident = self.here(Content::Result(value));
        if let Some(load) = self.loaded.iter().position(|loaded| *loaded == Some(resident)) {
            return load;
        }
        let stored = self.builder.stored(value);
        self.load_stored(resident, stored)
    }

    /// Content on the level of this kernel.
    fn here(&self, content: Content) -> Resident {
        Resident {
            content,
            level: self.level,
        }
    }

    /// Adds a load of content other than a result, of one plane.
    pub(crate) fn load_resident(&mut self, content: Content, ty: PortType) -> usize {
        let resident = self.here(content);
        let stored = Stored {
            ty,
            channels: Vec::new(),
        };
        self.load_stored(resident, stored)
    }

    /// Adds a load of all planes of stored content.
    fn load_stored(&mut self, resident: Resident, stored: Stored) -> usize {
        let planes = stored.planes().into_iter();
        let planes = planes.map(|plane| Some((resident, plane))).collect();
        self.add_load(Some(resident), stored, planes)
    }

    /// Adds a load of all planes that an input can have; planes that do not exist stay unbound.
    pub(crate) fn switched_load(&mut self, from: Option<Value>, stored: Stored) -> usize {
        let there = from.map(|value| (value, self.builder.stored(value)));
        let planes = stored.planes().into_iter().map(|plane| {
            let (value, from) = there.as_ref()?;
            let converted = matches!(
                (from.ty, stored.ty),
                (PortType::Mask, PortType::Color) | (PortType::Color, PortType::Mask)
            );
            let plane = if converted { from.planes()[0] } else { plane };
            from.planes()
                .contains(&plane)
                .then_some((Resident::result(*value), plane))
        });
        let planes = planes.collect();
        self.add_load(None, stored, planes)
    }

    pub(crate) fn call(&mut self, node: usize, output: usize, inputs: Vec<Binding>, block: usize) -> usize {
        let ready = self.builder.node(node);
        let Behavior::Shader(kind) = ready.behavior else {
            unreachable!("only shaders are called")
        };
        let function = kind.outputs[output].name.clone();
        self.spec.calls.push(Call {
            kind: kind.id.clone(),
            function,
            inputs,
            passes: Vec::new(),
            survey: None,
            block,
        });
        self.spec.calls.len() - 1
    }

    pub(crate) fn store(&mut self, call: usize, value: Value) {
        let made = Operand::Call(call, Convert::None);
        self.store_resident(made, Resident::result(value), self.builder.stored(value));
    }

    pub(crate) fn store_resident(&mut self, value: Operand, resident: Resident, stored: Stored) {
        self.writes
            .extend(stored.planes().into_iter().map(|plane| Some((resident, plane))));
        self.add_store(value, resident, stored);
    }

    /// Stores all planes that a result can have; planes that are not set stay unbound.
    pub(crate) fn store_switched(&mut self, call: usize, value: Value) {
        let resident = Resident::result(value);
        let set = self.builder.stored(value);
        let channels = if set.ty == PortType::Material {
            Channel::ALL.to_vec()
        } else {
            Vec::new()
        };
        let stored = Stored { ty: set.ty, channels };
        let is_set = |plane: Plane| set.planes().contains(&plane).then_some((resident, plane));
        self.writes.extend(stored.planes().into_iter().map(is_set));
        self.add_store(Operand::Call(call, Convert::None), resident, stored);
    }

    pub(crate) fn add_store(&mut self, value: Operand, resident: Resident, stored: Stored) {
        let formats = stored.planes().iter().map(|plane| plane.format()).collect();
        self.spec.stores.push(Store { value, stored, formats });
        if let Content::Result((node, output)) = resident.content {
            let ready = self.builder.node(node);
            self.keys
                .push(result_key(ready, ready.output(output).map_or("", |(name, _)| name)));
        }
    }

    pub(crate) fn finish(self) -> Draft {
        let builder = self.builder;
        let mut nodes: Vec<usize> = self.blocks.clone();
        nodes.dedup();
        let costs: Vec<f32> = nodes
            .iter()
            .map(|node| fuse::node_cost(builder.resolved, *node).max(1) as f32)
            .collect();
        let total: f32 = costs.iter().sum();
        let feedback = self.repeat.and_then(|(times, load, _)| {
            let read = self.spec.loads[..load].iter().map(|stored| stored.planes().len()).sum();
            (times > 1).then_some(Feedback {
                times,
                read,
                scratch: 0,
            })
        });
        let scratch = self.repeat.and_then(|(_, _, resident)| {
            let (_, plane) = self.writes.first().copied().flatten()?;
            Some((resident, plane))
        });
        let block = |node: &usize| {
            let ready = builder.node(*node);
            BlockValues {
                params: ready.params.clone(),
                knobs: ready.knobs.clone(),
            }
        };
        let step = KernelStep {
            fills_ghosts: matches!(self.spec.domain, Domain::OwnedTexels | Domain::OwnedTexelsByRays),
            blocks: self.blocks.iter().map(block).collect(),
            spec: self.spec,
            flags: self.flags,
            reads: Vec::new(),
            writes: Vec::new(),
            feedback,
            rays: self.rays,
            level: self.level,
            nodes: nodes.iter().map(|node| builder.id(*node)).collect(),
            shares: costs.iter().map(|cost| cost / total).collect(),
            keys: self.keys,
        };
        Draft {
            step: Step::Kernel(step),
            reads: self.reads,
            writes: self.writes,
            scratch,
        }
    }
}
