//! Checks passes that read a survey of the whole surface.

use std::ops::Range;

use sabi_graph::PortType;

use super::{FunctionDraft, PortReader, Ports};
use crate::kind::{Argument, InputDefault, Param, Reads, SURVEY_GROUPINGS};
use crate::words::list;

/// Returns true if a function has an argument `survey`.
pub(super) fn takes_survey(draft: &FunctionDraft<'_>) -> bool {
    draft.item.members.iter().any(|member| member.name == "survey")
}

impl<'a> PortReader<'a> {
    /// Finds the surveyed input. It must be required, and all passes must read the survey and no values of single places.
    pub(super) fn surveyed_input(
        &mut self,
        drafts: &[FunctionDraft<'a>],
        ports: &Ports,
    ) -> Option<(usize, Option<usize>)> {
        let declared = drafts.iter().find_map(|draft| draft.annotations.surveys.clone());
        if !self.faults.is_empty() {
            return None;
        }
        if !self.has_survey {
            let (_, range) = declared?;
            self.at(
                range,
                "Nothing here reads a survey.",
                "Let a pass take `survey: texture_2d_array<f32>`, and read it through lib/survey.",
            );
            return None;
        }
        self.check_survey_readers(drafts, ports);
        let Some((name, range)) = declared else {
            let draft = drafts.iter().find(|draft| takes_survey(draft))?;
            let advice = "Write `/// @surveys source` above it, with the name of an input.";
            let range = draft.item.name_range.clone();
            self.at(
                range,
                format!("`{}` does not say what is surveyed.", draft.item.name),
                advice,
            );
            return None;
        };
        let (name, groups) = match name.split_once(char::is_whitespace) {
            Some((name, groups)) => (name.to_owned(), Some(self.groups_param(groups.trim(), range.clone())?)),
            None => (name, None),
        };
        let found = self.inputs.iter().position(|input| input.name == name);
        let is_mask = found.is_some_and(|index| {
            let input = &self.inputs[index];
            input.ty == PortType::Mask && input.reads == Reads::Value
        });
        let Some(index) = found.filter(|_| is_mask) else {
            let masks = self.inputs.iter().filter(|input| input.ty == PortType::Mask);
            let names: Vec<String> = masks.map(|input| input.name.clone()).collect();
            let advice = format!(
                "Masks that an output takes: {}.",
                list(names.iter().map(String::as_str))
            );
            self.at(range, format!("`{name}` is no mask that could be surveyed."), advice);
            return None;
        };
        self.inputs[index].default = InputDefault::Required;
        Some((index, groups))
    }

    /// Reads `params.each` of `@surveys source params.each`: the parameter that chooses the groups.
    fn groups_param(&mut self, written: &str, range: Range<usize>) -> Option<usize> {
        let named = |param: &Param| written.strip_prefix("params.") == Some(param.name.as_str());
        let index = self.params.iter().position(named);
        let choices = index.and_then(|index| self.params[index].ty.role.choices());
        if choices.is_some_and(|words| words == SURVEY_GROUPINGS) {
            return index;
        }
        let message = format!("`{written}` does not choose what is surveyed apart.");
        let words = SURVEY_GROUPINGS.join(" ");
        let advice = format!("Name a parameter with `@choice {words}`: `@surveys source params.each`.");
        self.at(range, message, advice);
        None
    }

    /// Checks that all passes read the survey and nothing else, and that no other function reads it.
    fn check_survey_readers(&mut self, drafts: &[FunctionDraft<'a>], ports: &Ports) {
        let passes = ports.passes.iter().map(|pass| (&pass.function, true));
        for (function, is_pass) in ports.outputs.iter().map(|output| (output, false)).chain(passes) {
            let reads_survey = function.arguments.contains(&Argument::Survey);
            let of_a_place =
                |argument: &Argument| !matches!(argument, Argument::Survey | Argument::Params | Argument::Group);
            let draft = drafts.iter().find(|draft| draft.item.name == function.name);
            let range = draft.map_or(0..0, |draft| draft.item.name_range.clone());
            if reads_survey && !is_pass {
                let message = format!(
                    "`{}` reads a survey, which is read once for the whole surface and not at every place.",
                    function.name
                );
                let advice = "Make it a pass, and let the output take what it gives, by its name and type.";
                self.at(range, message, advice);
            } else if is_pass && (!reads_survey || function.arguments.iter().any(of_a_place)) {
                let message = format!("The pass `{}` runs once for the whole surface.", function.name);
                let advice = "Let it take `survey: texture_2d_array<f32>` and `params: Params`, and nothing else.";
                self.at(range, message, advice);
            }
        }
    }
}
