//! `output/material`: the material that is exported and shown.

use sabi_graph::{FlatNode, PortType, Value};
use sabi_nodes::kind::Param;
use sabi_plan::{SourceKind, SourcePort};

/// Id of the kind.
pub(crate) const NAME: &str = "output/material";

/// Declares the kind.
pub(crate) fn kind() -> SourceKind {
    SourceKind {
        id: NAME.to_owned(),
        label: "Material output".to_owned(),
        summary: "The material that is exported and shown.".to_owned(),
        aliases: ["export", "result"].map(str::to_owned).to_vec(),
        params: vec![
            Param::text(
                "materials",
                "*",
                "Names of the model's materials that get this result, separated by commas; * means all. Of several \
                 outputs, one that lists a material takes precedence over one with *; otherwise the first by id.",
            )
            .labeled("Materials (* = all)"),
        ],
        inputs: vec![SourcePort::new(
            "material",
            PortType::Material,
            "The finished material.",
        )],
        outputs: Vec::new(),
        content: [0; 32],
    }
}

/// Priority with which an output serves a material. The lesser one is preferred.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum MaterialClaim {
    /// The output lists the material.
    Listed,
    /// The output takes all materials.
    All,
}

/// Returns the priority with which an output serves the material with these names; `None` if it does not serve it.
pub(crate) fn claim(node: &FlatNode, names: &[&str]) -> Option<MaterialClaim> {
    let Some(Value::Text(text)) = node.params.get("materials") else {
        return Some(MaterialClaim::All);
    };
    let listed = || text.split(',').map(str::trim);
    // Checked as a whole first, since the name of a material may contain a comma.
    if names.contains(&text.trim()) || listed().any(|name| names.contains(&name)) {
        return Some(MaterialClaim::Listed);
    }
    listed().any(|name| name == "*").then_some(MaterialClaim::All)
}
