//! `output/material`: what is exported and shown.

use sabi_graph::{FlatNode, PortType, Value};
use sabi_plan::{SourceKind, SourcePort, TextParam};

/// Id of the kind.
pub(crate) const NAME: &str = "output/material";

/// The kind as the planner and the reference see it.
pub(crate) fn kind() -> SourceKind {
    SourceKind {
        id: NAME.to_owned(),
        label: "Material output".to_owned(),
        summary: "What is exported and shown.".to_owned(),
        params: vec![TextParam {
            name: "materials".to_owned(),
            doc:
                "Names of the model's materials that this output serves, separated by commas; * serves all. Of several \
                  outputs the first one that matches serves a material."
                    .to_owned(),
            default: Value::Text("*".to_owned()),
        }],
        inputs: vec![SourcePort {
            name: "material".to_owned(),
            ty: PortType::Material,
            doc: "The finished material.".to_owned(),
            channels: Vec::new(),
        }],
        outputs: Vec::new(),
        content: [0; 32],
    }
}

/// Whether an output node serves the model's material of that name.
pub(crate) fn serves(node: &FlatNode, material: &str) -> bool {
    match node.params.get("materials") {
        Some(Value::Text(names)) => names
            .split(',')
            .map(str::trim)
            .any(|name| name == "*" || name == material),
        _ => true,
    }
}
