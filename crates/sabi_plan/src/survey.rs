//! Steps of nodes that read a survey: the table, the passes that read it once, and the results.

use sabi_graph::PortType;
use sabi_nodes::kind::{Argument, Kind};
use sabi_nodes::link::{Binding, Call, Convert, Domain, Operand, Plane, Stored};

use crate::draft::{Content, Draft, KernelDraft, Resident};
use crate::plan::{Step, SurveyStep};
use crate::resolve::Behavior;
use crate::schedule::Builder;

impl Builder<'_, '_> {
    /// Drafts the survey, the passes of the node as kernels that run once, and all results in one kernel.
    pub(crate) fn survey(&self, node: usize, outputs: &[usize]) -> Vec<Draft> {
        let Behavior::Shader(kind) = self.node(node).behavior else {
            unreachable!("surveys are shaders")
        };
        let mut drafts = self.table(node, kind);
        drafts.extend((0..kind.passes.len()).map(|pass| self.found(node, kind, pass)));
        let mut kernel = KernelDraft::new(self, Domain::AllTexels);
        let block = kernel.block(node);
        for output in outputs {
            let bindings = self.node(node).inputs.iter().map(|input| match input {
                None => Binding::Default,
                Some(input) => Binding::Value(Operand::Load(kernel.load((input.node, input.output)), input.convert)),
            });
            let inputs = bindings.collect();
            let arguments = &kind.outputs[*output].arguments;
            let passes = kind.passes.iter().enumerate().map(|(pass, found)| {
                let is_taken = arguments.contains(&Argument::Pass(pass));
                is_taken.then(|| kernel.load_resident(Content::Found(node, pass), found.function.ty))
            });
            let passes = passes.collect();
            let call = kernel.call(node, *output, inputs, block);
            kernel.spec.calls[call].passes = passes;
            kernel.store(call, (node, *output));
        }
        drafts.push(kernel.finish());
        drafts
    }

    /// Drafts the table of the surveyed input.
    fn table(&self, node: usize, kind: &Kind) -> Vec<Draft> {
        let surveyed = kind
            .surveyed
            .and_then(|index| Some((index, (*self.node(node).inputs.get(index)?)?)));
        let Some((index, input)) = surveyed else {
            unreachable!("the surveyed input is required")
        };
        let mut drafts = Vec::new();
        let mut resident = Resident::result((input.node, input.output));
        if input.convert != Convert::None {
            let (draft, converted) = self.conversion(node, index, input);
            resident = converted;
            drafts.push(draft);
        }
        let content = Content::Survey(node);
        drafts.push(Draft {
            step: Step::Survey(SurveyStep {
                node: self.id(node),
                from: 0,
                to: 0,
            }),
            reads: vec![Some((resident, Plane::Mask))],
            writes: vec![Some((Resident { content, level: 0 }, Plane::Vector))],
            scratch: None,
        });
        drafts
    }

    /// Drafts a pass, which reads the table once.
    fn found(&self, node: usize, kind: &Kind, pass: usize) -> Draft {
        let function = &kind.passes[pass].function;
        let mut kernel = KernelDraft::new(self, Domain::Once);
        let block = kernel.block(node);
        let survey = kernel.load_resident(Content::Survey(node), PortType::Vector);
        kernel.spec.calls.push(Call {
            kind: kind.id.clone(),
            function: function.name.clone(),
            inputs: vec![Binding::Default; kind.inputs.len()],
            passes: Vec::new(),
            survey: Some(survey),
            block,
        });
        let content = Content::Found(node, pass);
        let stored = Stored {
            ty: function.ty,
            channels: Vec::new(),
        };
        kernel.store_resident(Operand::Call(0, Convert::None), Resident { content, level: 0 }, stored);
        kernel.finish()
    }
}
