//! `output/mask`: an additional exported map.

use sabi_graph::PortType;
use sabi_nodes::kind::Param;
use sabi_plan::{SourceKind, SourcePort};

/// Id of the kind.
pub(super) const NAME: &str = "output/mask";

/// Declares the kind.
pub(super) fn kind() -> SourceKind {
    SourceKind {
        id: NAME.to_owned(),
        label: "Mask output".to_owned(),
        summary: "Exports a mask as an additional map.".to_owned(),
        aliases: ["export", "map"].map(str::to_owned).to_vec(),
        params: vec![Param::text(
            "name",
            "mask",
            "Name of the map, which follows the name of the material in the file name.",
        )],
        inputs: vec![SourcePort::new("source", PortType::Mask, "The mask to export.")],
        outputs: Vec::new(),
        content: [0; 32],
    }
}
