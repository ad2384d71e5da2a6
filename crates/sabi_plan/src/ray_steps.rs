//! Steps of nodes that cast rays.

use sabi_graph::PortType;
use sabi_nodes::kind::{Argument, Denoise, Kind, Output};
use sabi_nodes::link::{Binding, Convert, Domain, Operand};

use crate::kernel_builder::KernelBuilder;
use crate::level::Level;
use crate::resolved_graph::Behavior;
use crate::resources::{Resource, TextureContent, UnassignedStep};
use crate::step_builder::StepBuilder;

impl StepBuilder<'_, '_> {
    /// Builds all results of a node that casts rays from the same rays. They are cast on the level that suits their length,
    /// and the results are moved to the finest level. Results of denoised means need another step after the rays, which
    /// reads the means of neighbors.
    pub(crate) fn rays(&self, node: usize, outputs: &[usize]) -> Vec<UnassignedStep> {
        let ready = self.node(node);
        let Behavior::Shader(kind @ Kind { rays: Some(rays), .. }) = ready.behavior else {
            unreachable!("only nodes with rays are grouped by rays")
        };
        let level = self.level(ready, kind, [&rays.texel, &None]);
        let (of_denoised, of_rays): (Vec<usize>, Vec<usize>) = outputs
            .iter()
            .partition(|output| reads_denoised(kind, &kind.outputs[**output]));
        let means = means_behind(kind, &of_denoised);

        let mut kernel = KernelBuilder::new(self, Domain::OwnedTexelsByRays);
        kernel.level = level;
        let block = kernel.block(node);
        for output in of_rays {
            let inputs = self.values(node, &mut kernel);
            let call = kernel.call(node, output, inputs, block);
            kernel.store(call, (node, output));
        }
        for pass in &means {
            let function = &kind.passes[*pass].function;
            let inputs = self.values(node, &mut kernel);
            let masks = kernel.param_masks(node, |_| None);
            let call = kernel.call_function(node, kind, function, inputs, masks, block);
            let content = TextureContent::Pass(node, *pass);
            kernel.store_resource(
                Operand::Call(call, Convert::None),
                Resource { content, level },
                function.ty,
            );
        }
        kernel.rays = Some(Box::new(
            self.planner.step_rays(node, ready, kind, rays, level, outputs),
        ));
        let step = kernel.finish();
        let mut steps = self.level_moves(node, &step, &[]);
        steps.push(step);
        if let Some(denoise) = kind.denoise().filter(|_| !means.is_empty()) {
            steps.push(self.normals(node, denoise, level));
            let denoised = self.denoised(node, kind, &of_denoised, &means, level);
            for moved in self.moves_of_denoised(node, &denoised, &means, level) {
                // The rays may read the same inputs, so a move may be in the list already.
                if steps.iter().all(|step| step.writes != moved.writes) {
                    steps.push(moved);
                }
            }
            steps.push(denoised);
        }
        if level != Level::FINEST {
            steps.extend(
                outputs
                    .iter()
                    .flat_map(|output| self.result_moves((node, *output), level)),
            );
        }
        steps
    }

    /// Returns the moves of other planes that the step of denoised means reads.
    fn moves_of_denoised(
        &self,
        node: usize,
        step: &UnassignedStep,
        means: &[usize],
        level: Level,
    ) -> Vec<UnassignedStep> {
        let passes = means.iter().map(|pass| TextureContent::Pass(node, *pass));
        let own = passes.chain([TextureContent::Normals(node)]);
        let own: Vec<Resource> = own.map(|content| Resource { content, level }).collect();
        self.level_moves(node, step, &own)
    }

    /// Bindings of the inputs of a node as values at the place.
    fn values(&self, node: usize, kernel: &mut KernelBuilder<'_, '_, '_>) -> Vec<Binding> {
        let inputs = self.node(node).inputs.iter().map(|input| match input {
            None => Binding::Default,
            Some(input) => Binding::Value(Operand::Load(kernel.load((input.node, input.output)), input.convert)),
        });
        inputs.collect()
    }

    /// Builds the normals of all texels of a level, with which similar neighbors are found.
    fn normals(&self, node: usize, denoise: Denoise, level: Level) -> UnassignedStep {
        let mut kernel = KernelBuilder::new(self, Domain::AllTexels);
        kernel.level = level;
        let content = TextureContent::Normals(node);
        kernel.store_resource(Operand::Normal(denoise), Resource { content, level }, PortType::Vector);
        kernel.finish()
    }

    /// Builds results of stored means over rays. The means are denoised when they are read.
    fn denoised(&self, node: usize, kind: &Kind, outputs: &[usize], means: &[usize], level: Level) -> UnassignedStep {
        let mut kernel = KernelBuilder::new(self, Domain::OwnedTexels);
        kernel.level = level;
        let block = kernel.block(node);
        let normals = kernel.load_resource(TextureContent::Normals(node), PortType::Vector);
        let mut passes = vec![None; kind.passes.len()];
        for pass in means {
            passes[*pass] =
                Some(kernel.load_resource(TextureContent::Pass(node, *pass), kind.passes[*pass].function.ty));
        }
        for output in outputs {
            let inputs = self.values(node, &mut kernel);
            let call = kernel.call(node, *output, inputs, block);
            kernel.spec.calls[call].passes.clone_from(&passes);
            kernel.spec.calls[call].normals = Some(normals);
            kernel.store(call, (node, *output));
        }
        kernel.finish()
    }
}

/// Passes that a function reads.
fn passes_of(function: &Output) -> impl Iterator<Item = usize> {
    function.arguments.iter().filter_map(|argument| match argument {
        Argument::Pass(pass) => Some(*pass),
        _ => None,
    })
}

fn reads_denoised(kind: &Kind, function: &Output) -> bool {
    passes_of(function).any(|pass| kind.passes[pass].denoise.is_some())
}

/// Passes that these results read, in ascending order.
fn means_behind(kind: &Kind, outputs: &[usize]) -> Vec<usize> {
    let mut means: Vec<usize> = outputs
        .iter()
        .flat_map(|output| passes_of(&kind.outputs[*output]))
        .collect();
    means.sort_unstable();
    means.dedup();
    means
}
