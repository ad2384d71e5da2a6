//! Parsing and validation of linked modules. An error of naga becomes a fault at a place in a file.

use std::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};

use naga::front::wgsl::{Frontend, Options};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Module, Span};

use super::module::LinkedModule;
use crate::fault::{Fault, INVALID};

impl LinkedModule {
    /// Parses and validates the text, with all capabilities that a device can have. The error names file and line.
    pub fn check(&self) -> Result<(), Fault> {
        compile(self, Capabilities::all()).map(|_| ())
    }
}

/// Parses and validates, and also returns the types of all expressions. The fault has naga's message, which `explain.rs`
/// replaces if it has a clearer one.
pub(crate) fn compile(linked: &LinkedModule, capabilities: Capabilities) -> Result<(Module, ModuleInfo), Fault> {
    // naga may panic on malformed text, which is a fault of naga. It must not end the program.
    let compiled = catch_unwind(AssertUnwindSafe(|| parse_and_validate(linked, capabilities)));
    compiled.unwrap_or_else(|_| {
        Err(Fault::of_file(
            linked.first_path(),
            "The WGSL compiler gave up on this text.",
            "Undo the last change, and write it in another way.",
        ))
    })
}

fn parse_and_validate(linked: &LinkedModule, capabilities: Capabilities) -> Result<(Module, ModuleInfo), Fault> {
    let mut frontend = Frontend::new_with_options(Options {
        parse_doc_comments: true,
        capabilities,
    });
    let module = frontend.parse(linked.wgsl()).map_err(|error| {
        // Of several labels, take the one in the node's text: its author can change that place.
        let mine = error.labels().find(|(span, _)| linked.is_in_node(*span));
        let (span, label) = mine.or_else(|| error.labels().next()).unwrap_or((Span::UNDEFINED, ""));
        let label = if error.message().contains(label) { "" } else { label };
        linked.fault(span, sentence(error.message()), sentence(label))
    })?;
    let mut validator = Validator::new(ValidationFlags::all(), capabilities);
    let types = validator.validate(&module).map_err(|error| {
        let spans = error.spans().map(|(span, _)| *span);
        // The narrowest span is the most precise one.
        let span = spans
            .filter(Span::is_defined)
            .min_by_key(|span| span.to_range().map(|range| range.len()));
        let mut cause: &dyn Error = error.as_inner();
        while let Some(deeper) = cause.source() {
            cause = deeper;
        }
        let message = format!("{INVALID}{}", sentence(&cause.to_string()));
        let advice = "The text is that of the WGSL compiler; numbers in brackets count its own expressions.";
        linked.fault(span.unwrap_or(Span::UNDEFINED), message, advice)
    })?;
    Ok((module, types))
}

/// Formats a text as a sentence: with a capital at the start and a full stop at the end.
fn sentence(text: &str) -> String {
    let mut text = text.trim().to_owned();
    if let Some(first) = text.get_mut(0..1) {
        first.make_ascii_uppercase();
    }
    if !text.is_empty() && !text.ends_with(['.', '?', '!']) {
        text.push('.');
    }
    text
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::LinkedModule;

    #[test]
    fn compiler_errors_are_reported_with_file_and_line() {
        let mut module = LinkedModule::default();
        module.push_node(Path::new("nodes/a.wgsl"), "// a\nconst A = B;");
        module.push_shared("noise", "const B = C;\n");
        let fault = module.check().unwrap_err();
        assert_eq!(
            (fault.path.to_str(), fault.line, fault.column),
            (Some("lib/noise.wgsl"), 1, 11)
        );
    }
}
