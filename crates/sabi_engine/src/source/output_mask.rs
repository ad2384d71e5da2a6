//! `output/mask`: one more exported map.

use sabi_graph::{FlatNode, PortType, Value};
use sabi_nodes::kind::Param;
use sabi_plan::{SourceKind, SourcePort};

/// Id of the kind.
pub(crate) const NAME: &str = "output/mask";

/// Declares the kind.
pub(crate) fn kind() -> SourceKind {
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

/// Returns the name of a node's map.
pub(crate) fn mask_name(node: &FlatNode) -> String {
    match node.params.get("name") {
        Some(Value::Text(name)) if !name.is_empty() => name.clone(),
        _ => "mask".to_owned(),
    }
}
