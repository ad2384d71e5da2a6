//! `output/vector`: an exported map of vectors.

use sabi_graph::PortType;
use sabi_nodes::kind::Param;
use sabi_plan::{SourceKind, SourcePort};

/// Id of the kind.
pub(super) const NAME: &str = "output/vector";

/// Declares the kind.
pub(super) fn kind() -> SourceKind {
    SourceKind {
        id: NAME.to_owned(),
        label: "Vector output".to_owned(),
        summary: "Exports a vector as an additional map of floats.".to_owned(),
        aliases: ["export", "map", "flow", "direction", "position", "exr"]
            .map(str::to_owned)
            .to_vec(),
        params: vec![Param::text(
            "name",
            "vector",
            "Name of the map, which follows the name of the material in the file name.",
        )],
        inputs: vec![SourcePort::new(
            "source",
            PortType::Vector,
            "The vector to export, whose numbers are written as they are.",
        )],
        outputs: Vec::new(),
        content: [0; 32],
    }
}
