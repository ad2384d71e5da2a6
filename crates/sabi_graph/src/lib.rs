//! The document: nodes, links, edits with inverses, groups and the file format.

mod port;

pub use port::PortType;
