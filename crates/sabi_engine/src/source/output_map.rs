//! Outputs that are exported as separate maps, in addition to the materials.

use sabi_export::{Channel, OutputKind};
use sabi_graph::{FlatNode, Value};

use super::{output_color, output_mask, output_vector};

/// Returns the channel that a node exports; `None` for nodes of other kinds.
pub(crate) fn map_output(node: &FlatNode) -> Option<Channel> {
    let (kind, default) = match node.kind.as_str() {
        output_mask::NAME => (OutputKind::Mask, "mask"),
        output_color::NAME => (OutputKind::Color, "color"),
        output_vector::NAME => (OutputKind::Vector, "vector"),
        _ => return None,
    };
    let name = match node.params.get("name") {
        Some(Value::Text(name)) if !name.is_empty() => name,
        _ => default,
    };
    Some(Channel::output(kind, name.to_owned()))
}
