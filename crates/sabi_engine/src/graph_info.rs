//! A graph in words: what it lets be set, its outputs, and the files that it takes.

pub(crate) mod graph_description;
pub(crate) mod graph_files;
