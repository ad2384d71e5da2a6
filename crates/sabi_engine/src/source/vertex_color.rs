//! `source/vertex_color`: the colors of the model's vertices.

use sabi_graph::PortType;
use sabi_nodes::link::Plane;
use sabi_plan::{SourceKind, SourcePort};
use sabi_surface::model::Model;

use super::texels::SourceSurface;

/// Id of the kind.
pub(crate) const NAME: &str = "source/vertex_color";

/// Declares the kind.
pub(crate) fn kind() -> SourceKind {
    SourceKind {
        id: NAME.to_owned(),
        label: "Vertex color".to_owned(),
        summary: "The colors of the model's vertices.".to_owned(),
        aliases: ["painted", "attribute", "vertices"].map(str::to_owned).to_vec(),
        params: Vec::new(),
        inputs: Vec::new(),
        outputs: vec![
            SourcePort::new(
                "color",
                PortType::Color,
                "Color, interpolated between the vertices; white for a model without vertex colors.",
            ),
            SourcePort::new(
                "alpha",
                PortType::Mask,
                "Fourth component of the vertex colors; 1 where there is none.",
            ),
        ],
        content: [0; 32],
    }
}

/// Declares the kind for a model: with a hash of its colors.
pub(crate) fn kind_for(model: &Model) -> SourceKind {
    let mut hash = blake3::Hasher::new();
    for color in &model.mesh.colors {
        hash.update(color.map(f32::to_le_bytes).as_flattened());
    }
    SourceKind {
        content: *hash.finalize().as_bytes(),
        ..kind()
    }
}

/// Fills a plane of a result. Adds a warning for a model without colors.
pub(crate) fn plane(surface: &SourceSurface<'_>, node: &str, plane: Plane, warnings: &mut Vec<String>) -> Vec<u8> {
    let mesh = &surface.model.mesh;
    if mesh.colors.is_empty() {
        let why = format!(
            "node '{node}' ({NAME}) gives white: the model has no vertex colors; add some in a modeling \
                     program"
        );
        if !warnings.contains(&why) {
            warnings.push(why);
        }
    }
    surface.texels(plane, |point| {
        // The center of a texel may lie outside its triangle; colors are not extrapolated.
        let [second, third] = surface.weights(point, point.uv).map(|weight| weight.max(0.0));
        let sum = (second + third).max(1.0);
        let weights = [1.0 - (second + third) / sum, second / sum, third / sum].map(|weight| weight as f32);
        let corners = mesh.triangles[point.triangle].iter().zip(weights);
        let mut sum = [0.0_f32; 4];
        for (vertex, weight) in corners {
            let color = mesh.colors.get(*vertex as usize).copied().unwrap_or([1.0; 4]); // White without colors, with a warning.
            for (sum, value) in sum.iter_mut().zip(color) {
                *sum += weight * value;
            }
        }
        match plane {
            Plane::Mask => [sum[3], 0.0, 0.0, 1.0],
            _ => [sum[0], sum[1], sum[2], 1.0],
        }
    })
}
