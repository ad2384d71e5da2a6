//! Node text and libraries in one module; what naga refuses becomes a fault with a place in a file.

use std::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};

use naga::front::wgsl::{Frontend, Options};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Module, Span};

use crate::explain::INVALID;
use crate::fault::{Fault, Text};
use crate::library::Libraries;
use crate::link::uses::{CORE, SharedHeader, Uses, shared_path};
use crate::link::{Given, LinkedModule};
use crate::notes::Word;
use crate::reader::FILE_LIMIT_BYTES;
use crate::scan;

/// Bind group of the surface in every kernel, wanted by `lib/atlas.wgsl`.
pub(crate) const SURFACE_GROUP: Given = Given::group("SURFACE_GROUP", 0);

/// The node's text, `core`, then the libraries in order: line 12 of an error is line 12 of the file.
pub(crate) fn with_libraries(node: Text<'_>, used: &[String], libraries: &Libraries) -> LinkedModule {
    let mut linked = LinkedModule::default();
    linked.push_node(node.path, node.text);
    for name in std::iter::once(CORE).chain(used.iter().map(String::as_str)) {
        if let Some(text) = libraries.text(name) {
            linked.push_shared(name, text);
        }
    }
    linked.push_generated(&SURFACE_GROUP.to_string());
    linked
}

/// The libraries that a file names and those that they name, in the order of first use, without `core`.
pub(crate) fn used_libraries(
    text: Text<'_>,
    uses: &[Word],
    libraries: &Libraries,
    faults: &mut Vec<Fault>,
) -> Vec<String> {
    let mut closure = Uses::new(libraries);
    closure.follow(text, uses, false);
    faults.append(&mut closure.faults);
    closure.names.retain(|name| name != CORE);
    closure.names
}

/// Checks that a library compiles with `core` and what it uses.
pub(crate) fn check_library(name: &str, libraries: &Libraries) -> Result<(), Fault> {
    let path = shared_path(name);
    let Some(library) = libraries.text(name) else {
        return Err(Fault::of_file(&path, format!("There is no library `{name}`."), ""));
    };
    let text = Text {
        path: &path,
        text: library,
    };
    if text.text.len() > FILE_LIMIT_BYTES {
        let message = format!("The file is larger than {} KiB.", FILE_LIMIT_BYTES / 1024);
        return Err(Fault::of_file(&path, message, "Split it into several libraries."));
    }
    let first = |faults: Vec<Fault>| faults.into_iter().next().map_or(Ok(()), Err);
    scan::scan_depth(text).map_or(Ok(()), Err)?;
    let mut faults = Vec::new();
    let header = SharedHeader::read(text, &mut faults);
    let mut used = used_libraries(text, &header.uses, libraries, &mut faults);
    first(faults)?;
    // The library itself is the first text, so that it is not linked twice.
    used.retain(|used| used != name);
    let linked = if name == CORE {
        let mut linked = LinkedModule::default();
        linked.push_node(&path, library);
        linked
    } else {
        with_libraries(text, &used, libraries)
    };
    compile(&linked, Capabilities::default()).map(|_| ())
}

/// Parses and validates. The fault speaks naga's words where it has no better ones.
pub(crate) fn compile(linked: &LinkedModule, capabilities: Capabilities) -> Result<Module, Fault> {
    // naga is made for text that programs wrote; a text that makes it panic must not end the program.
    let compiled = catch_unwind(AssertUnwindSafe(|| parse_and_validate(linked, capabilities)));
    compiled.unwrap_or_else(|_| {
        Err(Fault::of_file(
            linked.first_path(),
            "The WGSL compiler gave up on this text.",
            "Undo the last change, and write it in another way.",
        ))
    })
}

fn parse_and_validate(linked: &LinkedModule, capabilities: Capabilities) -> Result<Module, Fault> {
    let mut frontend = Frontend::new_with_options(Options {
        parse_doc_comments: true,
        capabilities,
    });
    let module = frontend.parse(linked.wgsl()).map_err(|error| {
        // Where two places are told, the one in the node is the one that can be changed.
        let mine = error.labels().find(|(span, _)| linked.is_in_node(*span));
        let (span, label) = mine.or_else(|| error.labels().next()).unwrap_or((Span::UNDEFINED, ""));
        let label = if error.message().contains(label) { "" } else { label };
        linked.fault(span, sentence(error.message()), sentence(label))
    })?;
    let mut validator = Validator::new(ValidationFlags::all(), capabilities);
    validator.validate(&module).map_err(|error| {
        let spans = error.spans().map(|(span, _)| *span);
        // The narrowest place is the one that is meant.
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
    Ok(module)
}

/// With a capital at the start and a full stop at the end.
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
