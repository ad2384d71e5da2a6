//! Checks passes: their numbers, their readers, and repetition.

use naga::Type;
use sabi_graph::PortType;

use super::{FunctionDraft, PortReader, Ports, is_field, port_type};
use crate::kind::{Argument, Input, InputDefault, Reads};
use crate::scan::Member;

impl<'a> PortReader<'a> {
    /// Checks that the numbers of passes are unique, and records the passes for arguments that refer to them.
    pub(super) fn check_passes(&mut self, drafts: &[FunctionDraft<'a>]) {
        for draft in drafts {
            let Some((number, range)) = draft.annotations.pass.clone() else {
                continue;
            };
            if let Some((_, other, _)) = self.pass_numbers.iter().find(|(known, ..)| *known == number) {
                let message = format!("`{}` and `{other}` are both pass {number}.", draft.item.name);
                self.at(range, message, "Number the passes in the order in which they run.");
            }
            let Some(ty) = draft.port() else { continue };
            self.pass_numbers.push((number, draft.item.name.clone(), ty));
        }
        self.pass_numbers.sort_by_key(|(number, ..)| *number);
    }

    /// Reads an argument that has the name of a pass and receives its stored result.
    pub(super) fn pass_argument(
        &mut self,
        draft: &FunctionDraft<'a>,
        member: &Member,
        ty: &Type,
        index: usize,
    ) -> Option<Argument> {
        let (number, _, carried) = self.pass_numbers[index].clone();
        if self.has_rays || self.has_survey {
            return self.mean_argument(
                member,
                port_type(ty, carried == PortType::Vector) == Some(carried),
                index,
            );
        }
        if !is_field(ty) {
            let message = format!("`{}` is a pass, so its result is a stored texture.", member.name);
            self.at(
                member.type_range.clone(),
                message,
                "Make the argument a `texture_2d_array<f32>`, and read it through lib/surface.",
            );
            return None;
        }
        if draft.annotations.pass.as_ref().is_some_and(|(own, _)| *own <= number) {
            let message = format!("`{}` reads pass {number}, which has not run yet.", draft.item.name);
            self.at(
                member.name_range.clone(),
                message,
                "Give the pass that is read the lower number.",
            );
            return None;
        }
        Some(Argument::Pass(index))
    }

    /// Finds the inputs that passes exist for.
    pub(super) fn find_inputs_of_passes(&mut self, drafts: &[FunctionDraft<'a>], ports: &mut Ports) {
        for draft in drafts {
            let Some((name, range)) = draft.annotations.with.clone() else {
                continue;
            };
            let is_optional = |input: &Input| input.name == name && input.default != InputDefault::Required;
            let input = self.inputs.iter().position(is_optional);
            let pass = ports
                .passes
                .iter_mut()
                .find(|pass| pass.function.name == draft.item.name);
            match (input, pass) {
                (Some(input), Some(pass)) if self.inputs[input].reads == Reads::Value => pass.with = Some(input),
                _ => {
                    let message = format!("`{}` is no pass for an input `{name}`.", draft.item.name);
                    let advice =
                        "Write `@with` above a pass, with the name of an optional input that is read at the place.";
                    self.at(range, message, advice);
                }
            }
        }
    }

    /// Checks that the first field argument of a repeated function has the type of its result, since it receives the previous result.
    pub(super) fn check_repeat(&mut self, draft: &FunctionDraft<'a>, arguments: &[Argument]) {
        let Some((_, range)) = draft.annotations.repeat.clone() else {
            return;
        };
        let first = arguments.iter().find_map(|argument| match argument {
            Argument::Input(index) => {
                let input = self.inputs.get(*index)?;
                (input.reads == Reads::Field).then_some(input.ty)
            }
            Argument::Pass(index) => self.pass_numbers.get(*index).map(|(_, _, ty)| *ty),
            _ => None,
        });
        match first {
            Some(ty) if Some(ty) == draft.port() => {}
            Some(ty) => {
                let message = format!(
                    "`{}` is repeated and returns a {}, but its first texture holds a {ty}.",
                    draft.item.name,
                    draft.port().map_or_else(|| "ray".to_owned(), |ty| ty.to_string())
                );
                self.at(
                    range,
                    message,
                    "Each repetition reads the last one's result through the first texture.",
                );
            }
            None => {
                let message = format!("`{}` is repeated but reads no texture.", draft.item.name);
                self.at(
                    range,
                    message,
                    "Each repetition reads the last one's result through the first `texture_2d_array<f32>` argument.",
                );
            }
        }
    }
}
