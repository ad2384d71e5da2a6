//! Reads the comments of documented functions and the types of their results.

use naga::Function;
use sabi_graph::PortType;

use super::functions::{self, FunctionAnnotations};
use super::{FunctionDraft, Gives, PortReader, function, port_type};
use crate::scan::Item;

impl<'a> PortReader<'a> {
    /// Reads the comments of all documented functions.
    pub(super) fn drafts(&mut self) -> Vec<FunctionDraft<'a>> {
        let mut drafts = Vec::new();
        for item in self.scan.functions().filter(|item| !item.docs.is_empty()) {
            let Some((_, function)) = function(self.module, &item.name) else {
                continue;
            };
            let (annotations, inputs) = functions::read_annotations(self.text, item, self.params, self.faults);
            for input in inputs {
                if self.described.contains_key(&input.name) {
                    let message = format!("The input `{}` is described twice.", input.name);
                    self.at(input.range, message, "Describe an input once, where it appears first.");
                } else {
                    self.described.insert(input.name.clone(), input);
                }
            }
            drafts.extend(self.draft(item, function, annotations));
        }
        drafts
    }

    fn draft(
        &mut self,
        item: &'a Item,
        function: &'a Function,
        annotations: FunctionAnnotations,
    ) -> Option<FunctionDraft<'a>> {
        let returned = function
            .result
            .as_ref()
            .and_then(|result| self.module.types.get_handle(result.ty).ok());
        if !crate::names::is_plain_name(&item.name) {
            self.at(
                item.name_range.clone(),
                format!("`{}` cannot be the name of an output.", item.name),
                "Use lower-case letters, digits and `_`, and start with a letter.",
            );
        }
        if annotations.shared.is_some() {
            return self.shared_draft(item, function, annotations);
        }
        let is_ray = returned.is_some_and(|ty| ty.name.as_deref() == Some("Ray"));
        let ty = returned.and_then(|ty| port_type(ty, annotations.vector.is_some()));
        let gives = ty.map(Gives::Port).or(is_ray.then_some(Gives::Ray));
        let Some(gives) = gives else {
            self.at(
                item.name_range.clone(),
                format!("The output `{}` does not return what a port can carry.", item.name),
                "Return f32 (a mask), vec3f (a color, or a vector with `@vector`) or Material. A helper has no `///` comment.",
            );
            return None;
        };
        if let Some(range) = annotations.vector.clone()
            && ty != Some(PortType::Vector)
        {
            self.at(
                range,
                "`@vector` needs a function that returns `vec3f`.",
                "Return `vec3f`, or remove it.",
            );
        }
        Some(FunctionDraft {
            item,
            function,
            annotations,
            gives,
        })
    }
}
