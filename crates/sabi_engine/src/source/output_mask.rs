//! `output/mask`: one more exported map.

use sabi_graph::{FlatNode, PortType, Value};
use sabi_plan::{SourceKind, SourcePort, TextParam};

/// Id of the kind.
pub(crate) const NAME: &str = "output/mask";

/// The kind as the planner and the reference see it.
pub(crate) fn kind() -> SourceKind {
    SourceKind {
        id: NAME.to_owned(),
        label: "Mask output".to_owned(),
        summary: "One more exported map.".to_owned(),
        params: vec![TextParam {
            name: "name".to_owned(),
            doc: "What the file is called after the material's name.".to_owned(),
            default: Value::Text("mask".to_owned()),
        }],
        inputs: vec![SourcePort {
            name: "source".to_owned(),
            ty: PortType::Mask,
            doc: "The mask to export.".to_owned(),
            channels: Vec::new(),
        }],
        outputs: Vec::new(),
        content: [0; 32],
    }
}

/// The name of a node's map.
pub(crate) fn mask_name(node: &FlatNode) -> String {
    match node.params.get("name") {
        Some(Value::Text(name)) if !name.is_empty() => name.clone(),
        _ => "mask".to_owned(),
    }
}
