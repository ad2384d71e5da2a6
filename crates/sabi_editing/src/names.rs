//! Names of groups, knobs and ports.

/// How names of groups end that are files.
pub(crate) const FILE_ENDING: &str = ".sabi";

/// Whether a group of that name is a file, unless the document has one of that name.
pub(crate) fn is_file(group: &str) -> bool {
    group.ends_with(FILE_ENDING)
}

/// The sentence that a group is not part of the document.
pub(crate) fn of_its_own(group: &str) -> String {
    format!("'{group}' is a file of its own; open it to change what is inside")
}

/// A name that is not taken: the stem, or the stem with a number.
pub(crate) fn free_name(stem: &str, before_number: char, is_taken: impl Fn(&str) -> bool) -> String {
    let mut name = stem.to_owned();
    let mut number = 2;
    while is_taken(&name) {
        name = format!("{stem}{before_number}{number}");
        number += 1;
    }
    name
}
