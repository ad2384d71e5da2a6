//! `source/vertex_color`: the colors of the model's vertices.

use rayon::prelude::*;
use sabi_gpu::{GpuError, SourceCanvas, SourceDraw, SourceShader};
use sabi_graph::PortType;
use sabi_nodes::link::Plane;
use sabi_plan::{SourceKind, SourcePort};
use sabi_surface::model::Model;

use super::corners::weight_changes;
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

/// Draws a plane of a result. Adds a warning for a model without colors.
///
/// # Errors
/// The run is canceled, or the device refuses.
pub(super) fn draw(
    surface: &SourceSurface<'_>,
    canvas: &SourceCanvas<'_>,
    node: &str,
    plane: Plane,
    warnings: &mut Vec<String>,
) -> Result<(), GpuError> {
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
    let number = |change: f64| (change as f32).to_bits();
    let corners: Vec<[u32; 4]> = (0..mesh.triangles.len())
        .into_par_iter()
        .flat_map_iter(|triangle| {
            // White without colors, with a warning.
            let [a, b, c] = mesh.triangles[triangle].map(|vertex| if mesh.colors.is_empty() { 0 } else { vertex });
            let [[second_u, second_v], [third_u, third_v]] = weight_changes(surface, triangle);
            [[a, b, c, 0], [second_u, second_v, third_u, third_v].map(number)]
        })
        .collect();
    let colors: Vec<[u32; 4]> = match mesh.colors.as_slice() {
        [] => vec![[1.0_f32; 4].map(f32::to_bits)],
        colors => colors.iter().map(|color| color.map(f32::to_bits)).collect(),
    };
    canvas.draw(&SourceDraw {
        shader: SourceShader::VertexColor {
            is_alpha: plane == Plane::Mask,
        },
        constants: (),
        tables: &[
            &canvas.table("the corners of triangles", &corners)?,
            &canvas.table("vertex colors", &colors)?,
        ],
        tiles: None,
    })
}
