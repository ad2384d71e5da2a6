//! Description of a graph: its knobs, its outputs, and the files that it uses.

pub(crate) mod graph_description;
pub(crate) mod graph_files;

pub use graph_description::{
    GraphDescription, GraphOutput, GroupDescription, KnobDescription, VariantDescription, describe_graph,
};
pub use graph_files::FileDescription;
