//! Steps of nodes that read a survey: the table, the passes that read it once, and the results.

use sabi_graph::PortType;
use sabi_nodes::kind::{Argument, Kind};
use sabi_nodes::link::{Binding, Call, Convert, Domain, Operand, Plane};

use crate::field::working_value;
use crate::kernel_builder::KernelBuilder;
use crate::level::Level;
use crate::plan::{Grouping, Step, SurveyStep};
use crate::resolved_graph::Behavior;
use crate::resources::{Resource, TextureContent, UnassignedStep};
use crate::step_builder::StepBuilder;

impl StepBuilder<'_, '_> {
    /// Builds the survey, the node's passes as kernels that run once, and all results in one kernel.
    pub(crate) fn survey(&self, node: usize, outputs: &[usize]) -> Vec<UnassignedStep> {
        let Behavior::Shader(kind) = self.node(node).behavior else {
            unreachable!("surveys are shaders")
        };
        let mut steps = self.survey_table(node, kind);
        steps.extend((0..kind.passes.len()).map(|pass| self.survey_pass(node, kind, pass)));
        let mut kernel = KernelBuilder::new(self, Domain::AllTexels);
        let block = kernel.block(node);
        for output in outputs {
            let bindings = self.node(node).inputs.iter().map(|input| match input {
                None => Binding::Default,
                Some(input) => Binding::Value(Operand::Load(kernel.load((input.node, input.output)), input.convert)),
            });
            let inputs = bindings.collect();
            let arguments = &kind.outputs[*output].arguments;
            let passes = kind.passes.iter().enumerate().map(|(index, pass)| {
                let is_taken = arguments.contains(&Argument::Pass(index));
                is_taken.then(|| {
                    let content = TextureContent::SurveyPass(node, index, self.has_groups(node, kind));
                    kernel.load_resource(content, pass.function.ty)
                })
            });
            let passes = passes.collect();
            let call = kernel.call(node, *output, inputs, block);
            kernel.spec.calls[call].passes = passes;
            kernel.store(call, (node, *output));
        }
        steps.push(kernel.finish());
        steps
    }

    /// Builds the table of the surveyed input.
    fn survey_table(&self, node: usize, kind: &Kind) -> Vec<UnassignedStep> {
        let surveyed = kind
            .surveyed
            .and_then(|index| Some((index, (*self.node(node).inputs.get(index)?)?)));
        let Some((index, input)) = surveyed else {
            unreachable!("the surveyed input is required")
        };
        let mut steps = Vec::new();
        let mut resource = Resource::result((input.node, input.output));
        if input.convert != Convert::None {
            let (step, converted) = self.conversion(node, index, input);
            resource = converted;
            steps.push(step);
        }
        let content = TextureContent::Survey(node, self.has_groups(node, kind));
        steps.push(UnassignedStep {
            step: Step::Survey(SurveyStep {
                node: self.id(node),
                each: self.grouping(node, kind),
                from: 0,
                to: 0,
            }),
            reads: vec![Some((resource, Plane::Mask))],
            writes: vec![Some((
                Resource {
                    content,
                    level: Level::FINEST,
                },
                Plane::Vector,
            ))],
            scratch: None,
        });
        steps
    }

    /// Places that the survey of a node measures together.
    fn grouping(&self, node: usize, kind: &Kind) -> Grouping {
        let number = kind
            .survey_groups
            .map(|param| working_value(self.node(node), kind, param));
        Grouping::of_choice(number.unwrap_or(0.0) as u32)
    }

    fn has_groups(&self, node: usize, kind: &Kind) -> bool {
        self.grouping(node, kind) != Grouping::Whole
    }

    /// Builds a pass that reads the table of the whole surface, or the tables of all groups.
    fn survey_pass(&self, node: usize, kind: &Kind, pass: usize) -> UnassignedStep {
        let function = &kind.passes[pass].function;
        let has_groups = self.has_groups(node, kind);
        let domain = if has_groups { Domain::Groups } else { Domain::Once };
        let mut kernel = KernelBuilder::new(self, domain);
        let block = kernel.block(node);
        let survey = kernel.load_resource(TextureContent::Survey(node, has_groups), PortType::Vector);
        kernel.spec.calls.push(Call {
            kind: kind.id.clone(),
            function: function.name.clone(),
            inputs: vec![Binding::Default; kind.inputs.len()],
            passes: Vec::new(),
            survey: Some(survey),
            normals: None,
            // Passes read no parameter that takes a mask.
            param_masks: Vec::new(),
            block,
            by_piece: false,
        });
        let content = TextureContent::SurveyPass(node, pass, has_groups);
        let resource = Resource {
            content,
            level: Level::FINEST,
        };
        kernel.store_resource(Operand::Call(0, Convert::None), resource, function.ty);
        kernel.finish()
    }
}
