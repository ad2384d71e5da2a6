//! Builder of a kernel step: its calls, loads and stores.

use sabi_graph::PortType;
use sabi_nodes::kind::{Kind, Output};
use sabi_nodes::link::{Binding, Call, Convert, Domain, KernelSpec, KernelStore, Operand, Plane, StoredLayout};

use crate::fuse::{self, ResultRef};
use crate::keys::result_key;
use crate::level::Level;
use crate::plan::{BlockValues, Feedback, KernelStep, Step, StepRays};
use crate::resolved_graph::{Behavior, ResolvedInput};
use crate::resources::{Resource, TextureContent, UnassignedStep};
use crate::step_builder::StepBuilder;

/// Repetition of a function in which each run reads the result of the previous run.
#[derive(Clone, Copy)]
pub(crate) struct Repetition {
    /// Number of runs, at least 2.
    pub(crate) run_count: u32,
    /// Index of the load that is replaced by the previous result.
    pub(crate) load: usize,
    /// Texture used alternately with the result.
    pub(crate) scratch: Resource,
}

/// Builder of a kernel step.
pub(crate) struct KernelBuilder<'b, 'p, 'a> {
    builder: &'b StepBuilder<'p, 'a>,
    pub(crate) spec: KernelSpec,
    /// Node of each parameter block.
    blocks: Vec<usize>,
    /// Resource of each load of the spec; none for switched loads.
    loaded: Vec<Option<Resource>>,
    reads: Vec<Option<(Resource, Plane)>>,
    writes: Vec<Option<(Resource, Plane)>>,
    pub(crate) flags: [u32; 4],
    pub(crate) repetition: Option<Repetition>,
    pub(crate) rays: Option<Box<StepRays>>,
    /// Level of the surface that the kernel runs on.
    pub(crate) level: Level,
    keys: Vec<[u8; 32]>,
}

impl<'b, 'p, 'a> KernelBuilder<'b, 'p, 'a> {
    pub(crate) fn new(builder: &'b StepBuilder<'p, 'a>, domain: Domain) -> Self {
        KernelBuilder {
            builder,
            spec: KernelSpec {
                calls: Vec::new(),
                loads: Vec::new(),
                stores: Vec::new(),
                domain,
                on_points: false,
            },
            blocks: Vec::new(),
            loaded: Vec::new(),
            reads: Vec::new(),
            writes: Vec::new(),
            flags: [0; 4],
            repetition: None,
            rays: None,
            level: Level::FINEST,
            keys: Vec::new(),
        }
    }

    /// Adds the parameter block of a node and returns its index.
    pub(crate) fn block(&mut self, node: usize) -> usize {
        self.blocks.push(node);
        self.blocks.len() - 1
    }

    fn add_load(
        &mut self,
        resource: Option<Resource>,
        stored: StoredLayout,
        planes: Vec<Option<(Resource, Plane)>>,
    ) -> usize {
        self.spec.loads.push(stored);
        self.loaded.push(resource);
        self.reads.extend(planes);
        self.loaded.len() - 1
    }

    /// Index of the load of a stored result, shared by all its readers in this kernel.
    pub(crate) fn load(&mut self, value: ResultRef) -> usize {
        let resource = self.on_level(TextureContent::Result(value));
        if let Some(load) = self.loaded.iter().position(|loaded| *loaded == Some(resource)) {
            return load;
        }
        let stored = self.builder.stored(value);
        self.load_stored(resource, stored)
    }

    /// Content on the level of this kernel.
    fn on_level(&self, content: TextureContent) -> Resource {
        Resource {
            content,
            level: self.level,
        }
    }

    /// Adds a load of content other than a result, of one plane.
    pub(crate) fn load_resource(&mut self, content: TextureContent, ty: PortType) -> usize {
        let resource = self.on_level(content);
        let stored = StoredLayout {
            ty,
            channels: Vec::new(),
        };
        self.load_stored(resource, stored)
    }

    /// Adds a load of one plane that is 0 everywhere: no slot is bound to it.
    pub(crate) fn load_nothing(&mut self, ty: PortType) -> usize {
        let channels = Vec::new();
        self.add_load(None, StoredLayout { ty, channels }, vec![None])
    }

    /// Adds a load of all planes of stored content.
    fn load_stored(&mut self, resource: Resource, stored: StoredLayout) -> usize {
        let planes = stored.planes().into_iter();
        let planes = planes.map(|plane| Some((resource, plane))).collect();
        self.add_load(Some(resource), stored, planes)
    }

    /// Adds a load of all planes that an input can have; planes that do not exist stay unbound.
    pub(crate) fn switched_load(&mut self, from: Option<ResultRef>, stored: StoredLayout) -> usize {
        let present = from.map(|value| (value, self.builder.stored(value)));
        let planes = stored.planes().into_iter().map(|plane| {
            let (value, from) = present.as_ref()?;
            let converted = matches!(
                (from.ty, stored.ty),
                (PortType::Mask, PortType::Color) | (PortType::Color, PortType::Mask)
            );
            let plane = if converted { from.planes()[0] } else { plane };
            from.planes()
                .contains(&plane)
                .then_some((Resource::result(*value), plane))
        });
        let planes = planes.collect();
        self.add_load(None, stored, planes)
    }

    /// Returns the masks that multiply parameters of a node. `made` finds masks that a call of this kernel computes.
    pub(crate) fn param_masks(
        &mut self,
        node: usize,
        made: impl Fn(ResultRef) -> Option<usize>,
    ) -> Vec<(usize, Operand)> {
        let masks: Vec<_> = self.builder.node(node).param_masks().collect();
        let operand = |(param, mask): (usize, ResolvedInput)| {
            let value = (mask.node, mask.output);
            let operand = match made(value) {
                Some(call) => Operand::Call(call, mask.convert),
                None => Operand::Load(self.load(value), mask.convert),
            };
            (param, operand)
        };
        masks.into_iter().map(operand).collect()
    }

    /// Adds the call of a shader's result function whose parameter masks are stored, and returns the index of the call.
    pub(crate) fn call(&mut self, node: usize, output: usize, inputs: Vec<Binding>, block: usize) -> usize {
        let param_masks = self.param_masks(node, |_| None);
        self.call_with(node, output, inputs, param_masks, block)
    }

    /// Adds the call of a shader's result function with these masks of parameters, and returns its index.
    pub(crate) fn call_with(
        &mut self,
        node: usize,
        output: usize,
        inputs: Vec<Binding>,
        param_masks: Vec<(usize, Operand)>,
        block: usize,
    ) -> usize {
        let Behavior::Shader(kind) = self.builder.node(node).behavior else {
            unreachable!("only shaders are called")
        };
        self.call_function(node, kind, &kind.outputs[output], inputs, param_masks, block)
    }

    /// Adds the call of a result or a pass with these inputs, masks of parameters, and block; returns its index.
    pub(crate) fn call_function(
        &mut self,
        node: usize,
        kind: &Kind,
        function: &Output,
        inputs: Vec<Binding>,
        param_masks: Vec<(usize, Operand)>,
        block: usize,
    ) -> usize {
        self.spec.calls.push(Call {
            kind: kind.id.clone(),
            function: function.name.clone(),
            inputs,
            passes: Vec::new(),
            survey: None,
            normals: None,
            param_masks,
            block,
            by_piece: self.builder.node(node).is_by_piece,
        });
        self.spec.calls.len() - 1
    }

    /// Stores the result of a call, on the level of this kernel.
    pub(crate) fn store(&mut self, call: usize, value: ResultRef) {
        let made = Operand::Call(call, Convert::None);
        self.store_planes(
            made,
            self.on_level(TextureContent::Result(value)),
            self.builder.stored(value),
        );
    }

    /// Stores content other than a result, of one plane.
    pub(crate) fn store_resource(&mut self, value: Operand, resource: Resource, ty: PortType) {
        let stored = StoredLayout {
            ty,
            channels: Vec::new(),
        };
        self.store_planes(value, resource, stored);
    }

    /// Stores all planes of a value.
    fn store_planes(&mut self, value: Operand, resource: Resource, stored: StoredLayout) {
        self.writes
            .extend(stored.planes().into_iter().map(|plane| Some((resource, plane))));
        self.add_store(value, resource, stored);
    }

    /// Stores all planes that a result can have; planes that are not set stay unbound.
    pub(crate) fn store_switched(&mut self, call: usize, value: ResultRef) {
        let resource = Resource::result(value);
        let set = self.builder.stored(value);
        let channels = if set.ty == PortType::Material {
            self.builder.switched_channels.to_vec()
        } else {
            Vec::new()
        };
        let stored = StoredLayout { ty: set.ty, channels };
        let is_set = |plane: Plane| set.planes().contains(&plane).then_some((resource, plane));
        self.writes.extend(stored.planes().into_iter().map(is_set));
        self.add_store(Operand::Call(call, Convert::None), resource, stored);
    }

    fn add_store(&mut self, value: Operand, resource: Resource, stored: StoredLayout) {
        let formats = stored.planes().iter().map(|plane| plane.format()).collect();
        self.spec.stores.push(KernelStore { value, stored, formats });
        if let TextureContent::Result((node, output)) = resource.content {
            let (name, _) = self.builder.output((node, output));
            self.keys.push(result_key(self.builder.node(node), name));
        }
    }

    /// The step of this kernel.
    pub(crate) fn finish(mut self) -> UnassignedStep {
        self.spec.on_points = matches!(self.level, Level::Points(_));
        let builder = self.builder;
        let mut nodes: Vec<usize> = self.blocks.clone();
        nodes.dedup();
        let costs: Vec<f32> = nodes
            .iter()
            .map(|node| fuse::node_cost(builder.resolved, *node).all.max(1) as f32)
            .collect();
        let total: f32 = costs.iter().sum();
        let feedback = self.repetition.map(|repetition| {
            let before = &self.spec.loads[..repetition.load];
            Feedback {
                run_count: repetition.run_count,
                read: before.iter().map(|stored| stored.planes().len()).sum(),
                scratch: 0,
            }
        });
        let scratch = self.repetition.and_then(|repetition| {
            let (_, plane) = self.writes.first().copied().flatten()?;
            Some((repetition.scratch, plane))
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
            cost_shares: costs.iter().map(|cost| cost / total).collect(),
            keys: self.keys,
        };
        UnassignedStep {
            step: Step::Kernel(step),
            reads: self.reads,
            writes: self.writes,
            scratch,
        }
    }
}
