//! Links a node or a library with the libraries that it uses.

use naga::valid::Capabilities;

use crate::annotations::AnnotationWord;
use crate::fault::{Fault, Text};
use crate::limits;
use crate::link::LinkedModule;
use crate::link::given_declarations::{SURFACE_GROUP, on_points};
use crate::link::parse::compile;
use crate::link::uses::{FileUses, SharedHeader};
use crate::shader_files::{CORE, Libraries, shared_path};
use crate::source_file::FILE_LIMIT_BYTES;

/// Links a node's text with `core` and these libraries. The node comes first, so that line 12 in an error is line 12 of the file.
pub(crate) fn link_with_libraries(node: Text<'_>, used: &[String], libraries: &Libraries) -> LinkedModule {
    let mut linked = LinkedModule::default();
    linked.push_node(node.path, node.text);
    for name in std::iter::once(CORE).chain(used.iter().map(String::as_str)) {
        if let Some(text) = libraries.text(name) {
            linked.push_shared(name, text);
        }
    }
    linked.push_generated(&format!("{SURFACE_GROUP}{}", on_points(false)));
    linked
}

/// Lists the libraries that a file uses, directly or through others, in the order of first use, without `core`.
pub(crate) fn used_libraries(
    text: Text<'_>,
    uses: &[AnnotationWord],
    libraries: &Libraries,
    faults: &mut Vec<Fault>,
) -> Vec<String> {
    let mut closure = FileUses::new(libraries);
    closure.follow(text, uses, false);
    faults.append(&mut closure.faults);
    closure.names.retain(|name| name != CORE);
    closure.names
}

/// Checks that a library compiles together with `core` and the libraries that it uses.
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
    let mut faults = Vec::new();
    let header = SharedHeader::read(text, &mut faults);
    let mut used = used_libraries(text, &header.uses, libraries, &mut faults);
    first(faults)?;
    // The library itself is linked as the first text and must not be linked twice.
    used.retain(|used| used != name);
    let linked = if name == CORE {
        let mut linked = LinkedModule::default();
        linked.push_node(&path, library);
        linked
    } else {
        link_with_libraries(text, &used, libraries)
    };
    limits::check(&linked).map_or(Ok(()), Err)?;
    compile(&linked, Capabilities::default()).map(|_| ())
}
