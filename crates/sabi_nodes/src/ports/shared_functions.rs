//! Reads shared functions. They compute values that several outputs need, once for each place.

use naga::{Function, Handle, Type};

use super::functions::FunctionAnnotations;
use super::{FunctionDraft, Gives, PortReader, Ports};
use crate::kind::{Argument, Reads, SharedFunction};
use crate::scan::{Item, Member};

/// Name and result of a shared function.
pub(super) struct SharedType {
    pub(super) name: String,
    ty: Handle<Type>,
}

impl<'a> PortReader<'a> {
    /// A function marked `@shared`, which has no other annotations of its own.
    pub(super) fn shared_draft(
        &mut self,
        item: &'a Item,
        function: &'a Function,
        annotations: FunctionAnnotations,
    ) -> Option<FunctionDraft<'a>> {
        let range = annotations.shared.clone()?;
        if !annotations.is_free() {
            let message = format!("`{}` is shared, and is no output, pass or ray.", item.name);
            self.at(range, message, "Leave `@input` as the only other annotation above it.");
            return None;
        }
        if function.result.is_none() {
            let message = format!("The shared function `{}` gives nothing.", item.name);
            self.at(
                item.name_range.clone(),
                message,
                "Return a value, for example a struct.",
            );
            return None;
        }
        Some(FunctionDraft {
            item,
            function,
            annotations,
            gives: Gives::Shared,
        })
    }

    /// Records the shared functions for arguments that refer to them.
    pub(super) fn find_shared(&mut self, drafts: &[FunctionDraft<'a>]) {
        let shared = drafts.iter().filter(|draft| draft.gives == Gives::Shared);
        let typed = shared.filter_map(|draft| {
            Some(SharedType {
                name: draft.item.name.clone(),
                ty: draft.function.result.as_ref()?.ty,
            })
        });
        self.shared = typed.collect();
    }

    /// Reads a shared function.
    pub(super) fn shared(&mut self, draft: &FunctionDraft<'a>) -> SharedFunction {
        SharedFunction {
            name: draft.item.name.clone(),
            arguments: self.arguments(draft),
        }
    }

    /// Reads an argument that has the name of a shared function and receives its result.
    pub(super) fn shared_argument(
        &mut self,
        draft: &FunctionDraft<'a>,
        member: &Member,
        ty: Handle<Type>,
        index: usize,
    ) -> Option<Argument> {
        let name = &member.name;
        if draft.gives == Gives::Shared {
            let message = format!(
                "`{}` is shared, and takes the result of another shared function.",
                draft.item.name
            );
            self.at(member.name_range.clone(), message, format!("Call `{name}` in it."));
            return None;
        }
        if self.shared[index].ty != ty {
            let message = format!("`{name}` is the result of a shared function, and has its type.");
            let advice = "Give the argument the type that the function returns.";
            self.at(member.type_range.clone(), message, advice);
            return None;
        }
        Some(Argument::Shared(index))
    }

    /// Checks that a node with shared functions only takes values, not stored results, and that its outputs take all shared functions.
    pub(super) fn check_shared(&mut self, drafts: &[FunctionDraft<'a>], ports: &Ports) {
        if !self.faults.is_empty() {
            return;
        }
        let reads_textures = self.inputs.iter().any(|input| input.reads == Reads::Field);
        let is_point = !(reads_textures || self.has_rays || self.has_survey || !ports.passes.is_empty());
        for (index, shared) in ports.shared.iter().enumerate() {
            let draft = drafts.iter().find(|draft| draft.item.name == shared.name);
            let range = draft.map_or(0..0, |draft| draft.item.name_range.clone());
            let is_taken = ports
                .outputs
                .iter()
                .any(|output| output.arguments.contains(&Argument::Shared(index)));
            if !is_point {
                let message = "A node with a shared function has no textures, passes, rays or surveys.";
                self.at(range, message, "Let the outputs call the function.");
            } else if !is_taken {
                let message = format!("No output takes the result of `{}`.", shared.name);
                let advice = format!(
                    "Give an output the argument `{}`, of the type that it returns.",
                    shared.name
                );
                self.at(range, message, advice);
            }
        }
    }
}
