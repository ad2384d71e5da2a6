//! `output/color`: an exported map of colors.

use sabi_graph::PortType;
use sabi_nodes::kind::Param;
use sabi_plan::{SourceKind, SourcePort};

/// Id of the kind.
pub(super) const NAME: &str = "output/color";

/// Declares the kind.
pub(super) fn kind() -> SourceKind {
    SourceKind {
        id: NAME.to_owned(),
        label: "Color output".to_owned(),
        summary: "Exports a color as an additional map, in sRGB.".to_owned(),
        aliases: ["export", "map", "tint", "exr"].map(str::to_owned).to_vec(),
        params: vec![Param::text(
            "name",
            "color",
            "Name of the map, which follows the name of the material in the file name.",
        )],
        inputs: vec![SourcePort::new(
            "source",
            PortType::Color,
            "The color to export. Where it exceeds 1, most presets write it as floats, too.",
        )],
        outputs: Vec::new(),
        content: [0; 32],
    }
}
