//! Names of groups, knobs and ports.

use std::sync::Arc;

use sabi_engine::catalog::Interface;

/// Suffix of the names of groups that are files.
pub(crate) const FILE_ENDING: &str = ".sabi";

/// Returns whether a group name refers to a file. A group of the document with the same name takes precedence.
pub(crate) fn is_file(group: &str) -> bool {
    group.ends_with(FILE_ENDING)
}

/// Returns a sentence that a group is a file and not part of the document.
pub(crate) fn separate_file_notice(group: &str) -> String {
    format!("'{group}' is a file of its own; open it to change what is inside")
}

/// Returns the label of a knob, or its name if the ports and knobs of its node are unknown.
pub(crate) fn knob_label(interface: Option<&Arc<Interface>>, knob: &str) -> String {
    let known = interface.and_then(|interface| interface.knob(knob));
    known.map_or_else(|| knob.to_owned(), |knob| knob.label.clone())
}

/// Finds a name that is not taken: the stem, or the stem with a number.
pub(crate) fn free_name(stem: &str, before_number: char, is_taken: impl Fn(&str) -> bool) -> String {
    let mut name = stem.to_owned();
    let mut number = 2;
    while is_taken(&name) {
        name = format!("{stem}{before_number}{number}");
        number += 1;
    }
    name
}
