//! The nodes that come with the program.

use sabi_nodes::Library;

#[test]
fn every_built_in_node_and_library_is_faultless() {
    let (files, libraries) = Library::builtin_files();
    let count = files.len();
    let (library, faults) = Library::load(files, libraries);
    let shown: Vec<String> = faults.iter().map(ToString::to_string).collect();
    assert!(faults.is_empty(), "{}", shown.join("\n\n"));
    assert_eq!(library.kinds().count(), count);
}
