//! Description of a graph: its knobs, its outputs, and the files that it uses.

pub(crate) mod graph_description;
pub(crate) mod graph_files;
