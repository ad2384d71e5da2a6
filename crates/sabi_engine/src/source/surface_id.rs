//! `surface/id`: groups of triangles: parts, materials, charts, names, connected pieces.

use sabi_gpu::{GpuError, SourceCanvas, SourceDraw, SourceShader};
use sabi_graph::PortType;
use sabi_nodes::kind::Param;
use sabi_plan::{NoSuchValue, SourceKind, SourcePort, SourceStep};
use sabi_surface::model::Model;
use sabi_surface::pieces::{PieceBox, boxes};

use super::hash_apart;
use super::part_groups::TriangleGroups;
use super::texels::SourceSurface;
use super::unreadable;

/// Id of the kind.
pub(crate) const NAME: &str = "surface/id";

/// Choices of `by`.
const WORDS: [&str; 6] = ["part", "material", "chart", "name", "piece", "whole"];

/// Declares the kind.
pub(crate) fn kind() -> SourceKind {
    SourceKind {
        id: NAME.to_owned(),
        label: "Parts".to_owned(),
        summary: "Divides the model into parts, or selects some of them.".to_owned(),
        aliases: [
            "part",
            "object",
            "select",
            "pick",
            "piece",
            "plank",
            "random",
            "island",
            "flood fill",
        ]
        .map(str::to_owned)
        .to_vec(),
        params: vec![
            Param::choice(
                "by",
                &WORDS,
                "Division of the model: its parts, its materials, its UV charts, parts of the same name, connected \
                 pieces inside a part, such as single planks, or the whole model as one part.",
            ),
            Param::text(
                "pick",
                "",
                "Names or numbers (from 0) to select, separated by commas; a * at the end matches any ending, as in \
                 leg*. Empty selects everything. 'sabi mesh' lists the names.",
            ),
        ],
        inputs: Vec::new(),
        outputs: vec![
            SourcePort::new("mask", PortType::Mask, "1 on the selected parts, 0 elsewhere."),
            SourcePort::new(
                "id",
                PortType::Mask,
                "A random value for each part. With name, it depends on the name alone, so it stays the same when the \
                 order of the parts changes.",
            ),
            SourcePort::new(
                "color",
                PortType::Color,
                "A color for each part that tells it from its neighbors, as programs select parts by.",
            ),
            SourcePort::new(
                "position",
                PortType::Vector,
                "Position in the bounding box of each part: from the center of the box, x along its longest side.",
            ),
        ],
        content: [0; 32],
    }
}

/// Declares the kind for a model: with a hash of all names that can be picked and of their triangles.
pub(crate) fn kind_for(model: &Model) -> SourceKind {
    let mut hash = blake3::Hasher::new();
    let own = model.materials.iter().map(|material| &material.name);
    let files = sabi_export::set_names(model);
    for names in [
        model.parts.iter().collect::<Vec<_>>(),
        own.collect(),
        files.iter().collect(),
    ] {
        hash.update(&(names.len() as u64).to_le_bytes());
        for name in names {
            hash_apart(&mut hash, name.as_bytes());
        }
    }
    for groups in [&model.mesh.triangle_part, &model.mesh.triangle_material] {
        for group in groups {
            hash.update(&group.to_le_bytes());
        }
    }
    SourceKind {
        content: *hash.finalize().as_bytes(),
        ..kind()
    }
}

/// Draws a plane of a result. Adds picked names that do not exist to `warnings`.
///
/// # Errors
/// A parameter is missing, the run is canceled, or the device refuses.
pub(super) fn draw(
    surface: &SourceSurface<'_>,
    canvas: &SourceCanvas<'_>,
    step: &SourceStep,
    output: &str,
    warnings: &mut Vec<String>,
) -> Result<(), GpuError> {
    let value = |known: Result<usize, NoSuchValue>| known.map_err(|error| unreadable(step, &error));
    let groups = TriangleGroups::new(surface, value(step.values.index("by"))?);
    let single = |value: f32| [[value, 0.0, 0.0, 1.0]];
    let rows = match output {
        "color" => {
            let colors = groups.colors();
            groups.rows(|group| {
                let [r, g, b] = colors[group];
                [[r, g, b, 1.0]]
            })
        }
        "position" => {
            let boxes = boxes(&surface.model.mesh, &groups.of_triangles(surface), groups.count());
            groups.rows(|group| box_rows(&boxes[group], surface.working_from_model))
        }
        "id" => groups.rows(|group| single((groups.random[group] >> 8) as f32 / 16_777_216.0)),
        _ => {
            let pick = step.values.text("pick").map_err(|error| unreadable(step, &error))?;
            let (picked, unknown) = groups.picked(pick);
            warnings.extend(unknown.iter().map(|word| groups.unknown(&step.id, word)));
            groups.rows(|group| single(f32::from(u8::from(picked[group]))))
        }
    };
    canvas.draw(&SourceDraw {
        shader: SourceShader::Parts {
            of: groups.by,
            has_boxes: output == "position",
        },
        constants: (),
        tables: &[&canvas.table("the parts of the model", &rows)?],
        tiles: None,
    })
}

/// The sides of a box, each with a coordinate of its middle in working units.
fn box_rows(own: &PieceBox, working_from_model: f64) -> [[f32; 4]; 3] {
    std::array::from_fn(|side| {
        let [x, y, z] = own.axes[side];
        [x, y, z, (f64::from(own.center[side]) * working_from_model) as f32]
    })
}

#[cfg(test)]
mod tests {
    use sabi_surface::model::Model;

    use super::kind_for;

    #[test]
    fn models_that_differ_in_names_alone_share_no_result() {
        let of = |parts: &[&str]| {
            kind_for(&Model {
                parts: parts.iter().map(|name| (*name).to_owned()).collect(),
                ..Model::default()
            })
            .content
        };
        assert_eq!(of(&["leg", "seat"]), of(&["leg", "seat"]));
        assert_ne!(of(&["leg", "seat"]), of(&["seat", "leg"]));
        assert_ne!(of(&["ab", "c"]), of(&["a", "bc"]));
    }
}
