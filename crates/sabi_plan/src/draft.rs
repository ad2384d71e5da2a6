//! A kernel step in the making: what it calls, reads and stores, before slots are known.

use sabi_graph::PortType;
use sabi_nodes::kind::Channel;
use sabi_nodes::link::{Binding, Call, Convert, Domain, KernelSpec, Operand, Plane, Store, Stored};

use crate::fuse::{self, Value};
use crate::keys::result_key;
use crate::plan::{BlockValues, Feedback, KernelStep, Room, Step, StepRays};
use crate::resolve::Behavior;
use crate::schedule::Builder;

/// What lies in storage, and on which level of the atlas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Kept {
    pub(crate) what: What,
    pub(crate) level: u32,
}

impl Kept {
    /// A result; all of them are on the finest level.
    pub(crate) fn result(value: Value) -> Kept {
        Kept {
            what: What::Result(value),
            level: 0,
        }
    }

    /// How large its texture is.
    pub(crate) fn room(self) -> Room {
        match self.what {
            What::Survey(_) => Room::Survey,
            What::Found(..) => Room::Single,
            What::Result(_) | What::Pass(..) | What::Scratch(..) | What::Converted(..) => Room::Level(self.level),
        }
    }
}

/// A result, or what a pass of a field leaves for the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum What {
    Result(Value),
    Pass(usize, usize),
    /// Takes turns with a repeated function's result: node, and which of its steps.
    Scratch(usize, usize),
    /// The table of a node's survey.
    Survey(usize),
    /// What a pass gives for the whole surface: node and pass.
    Found(usize, usize),
    /// What a field's or a survey's input reads, converted: node and index of the input.
    Converted(usize, usize),
}

/// A step before its slots are known.
pub(crate) struct Draft {
    pub(crate) step: Step,
    pub(crate) reads: Vec<Option<(Kept, Plane)>>,
    pub(crate) writes: Vec<Option<(Kept, Plane)>>,
    pub(crate) scratch: Option<(Kept, Plane)>,
}

/// A kernel step in the making.
pub(crate) struct KernelDraft<'b, 'p, 'a> {
    builder: &'b Builder<'p, 'a>,
    pub(crate) spec: KernelSpec,
    blocks: Vec<usize>,
    loaded: Vec<Option<Kept>>,
    reads: Vec<Option<(Kept, Plane)>>,
    writes: Vec<Option<(Kept, Plane)>>,
    pub(crate) flags: [u32; 4],
    pub(crate) repeat: Option<(u32, usize, Kept)>,
    pub(crate) rays: Option<Box<StepRays>>,
    /// Level of the atlas that it runs on.
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

    pub(crate) fn add_load(&mut self, kept: Option<Kept>, stored: Stored, planes: Vec<Option<(Kept, Plane)>>) -> usize {
        self.spec.loads.push(stored);
        self.loaded.push(kept);
        self.reads.extend(planes);
        self.loaded.len() - 1
    }

    /// The load of a stored result, one for all its readers in this kernel.
    pub(crate) fn load(&mut self, value: Value) -> usize {
        let kept = self.here(What::Result(value));
        if let Some(load) = self.loaded.iter().position(|loaded| *loaded == Some(kept)) {
            return load;
        }
        let stored = self.builder.stored(value);
        let planes = stored.planes().into_iter().map(|plane| Some((kept, plane))).collect();
        self.add_load(Some(kept), stored, planes)
    }

    /// Something stored, on the level of this kernel.
    fn here(&self, what: What) -> Kept {
        Kept {
            what,
            level: self.level,
        }
    }

    /// The load of something that is no result, of one plane.
    pub(crate) fn load_kept(&mut self, what: What, ty: PortType) -> usize {
        let kept = self.here(what);
        let stored = Stored {
            ty,
            channels: Vec::new(),
        };
        let planes = stored.planes().into_iter().map(|plane| Some((kept, plane))).collect();
        self.add_load(Some(kept), stored, planes)
    }

    /// A load for all planes the input could have; those that are not there stay open.
    pub(crate) fn switched_load(&mut self, from: Option<Value>, stored: Stored) -> usize {
        let there = from.map(|value| (value, self.builder.stored(value)));
        let planes = stored.planes().into_iter().map(|plane| {
            let (value, from) = there.as_ref()?;
            let converted = matches!(
                (from.ty, stored.ty),
                (PortType::Mask, PortType::Color) | (PortType::Color, PortType::Mask)
            );
            let plane = if converted { from.planes()[0] } else { plane };
            from.planes().contains(&plane).then_some((Kept::result(*value), plane))
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
        self.store_kept(made, Kept::result(value), self.builder.stored(value));
    }

    pub(crate) fn store_kept(&mut self, value: Operand, kept: Kept, stored: Stored) {
        self.writes
            .extend(stored.planes().into_iter().map(|plane| Some((kept, plane))));
        self.add_store(value, kept, stored);
    }

    /// Stores all planes the result could have; those that are not set stay open.
    pub(crate) fn store_switched(&mut self, call: usize, value: Value) {
        let kept = Kept::result(value);
        let set = self.builder.stored(value);
        let channels = if set.ty == PortType::Material {
            Channel::ALL.to_vec()
        } else {
            Vec::new()
        };
        let stored = Stored { ty: set.ty, channels };
        let is_set = |plane: Plane| set.planes().contains(&plane).then_some((kept, plane));
        self.writes.extend(stored.planes().into_iter().map(is_set));
        self.add_store(Operand::Call(call, Convert::None), kept, stored);
    }

    pub(crate) fn add_store(&mut self, value: Operand, kept: Kept, stored: Stored) {
        let formats = stored.planes().iter().map(|plane| plane.format()).collect();
        self.spec.stores.push(Store { value, stored, formats });
        if let What::Result((node, output)) = kept.what {
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
        let scratch = self.repeat.and_then(|(_, _, kept)| {
            let (_, plane) = self.writes.first().copied().flatten()?;
            Some((kept, plane))
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
