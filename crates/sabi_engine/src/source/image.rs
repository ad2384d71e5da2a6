//! `source/image`: a picture from a file, projected onto the surface.

use sabi_color::luminance;
use sabi_graph::PortType;
use sabi_image::{Declared, Picture, Pixels};
use sabi_nodes::kind::Param;
use sabi_nodes::link::Plane;
use sabi_plan::{SourceKind, SourcePort, SourceStep};
use sabi_surface::model::Wrap;

use super::pictures::OpenPicture;
use super::projection::Projection;
use super::sampler::Sampler;
use super::texels::SourceSurface;

/// Id of the kind.
pub(crate) const NAME: &str = "source/image";

/// Declares the kind.
pub(crate) fn kind() -> SourceKind {
    SourceKind {
        id: NAME.to_owned(),
        label: "Image".to_owned(),
        summary: "A picture from a file, brought onto the surface.".to_owned(),
        aliases: [
            "bitmap",
            "texture",
            "picture",
            "photo",
            "decal",
            "stamp",
            "triplanar",
            "normal map",
        ]
        .map(str::to_owned)
        .to_vec(),
        params: [params(), decal_params()].concat(),
        inputs: Vec::new(),
        outputs: vec![
            SourcePort::new("color", PortType::Color, "Its colors."),
            SourcePort::new(
                "mask",
                PortType::Mask,
                "Its luminance, as numbers of the file; 0 outside of a decal.",
            ),
            SourcePort::new("alpha", PortType::Mask, "Its opacity; 0 outside of a decal."),
            SourcePort::new(
                "slope",
                PortType::Vector,
                "Of a normal map: the surface gradient in model space; 0 outside of a decal.",
            ),
        ],
        content: [0; 32],
    }
}

fn params() -> Vec<Param> {
    vec![
        Param::file(
            "file",
            "The picture: PNG, JPEG, WebP, TGA, BMP, HDR or OpenEXR, relative to the graph file.",
        ),
        Param::choice(
            "color_space",
            &["auto", "srgb", "linear"],
            "Whether colors are encoded with the sRGB curve. With auto the color is what the file says of itself, else \
             sRGB unless its numbers are floats, and the mask is read as plain numbers. Alpha and slope always are.",
        ),
        Param::choice(
            "projection",
            &["uv", "triplanar", "decal"],
            "Along the model's own texture coordinates, from three sides along the model's axes, or pressed on from one.",
        ),
        Param::length(
            "size",
            0.5,
            "Width of one tile for triplanar, and of the decal; pixels stay square.",
        )
        .within(1e-4, 100.0)
        .mostly(0.01, 2.0),
        Param::pair(
            "tiles",
            [1.0, 1.0],
            "How often it repeats across and down the texture coordinates, for uv.",
        )
        .within(0.001, 1000.0)
        .mostly(1.0, 16.0),
        Param::angle("rotate", 0.0, "Turns the picture counter-clockwise.")
            .within(-360.0, 360.0)
            .mostly(-180.0, 180.0),
        Param::pair("offset", [0.0, 0.0], "Moves the picture to the right and up, in tiles.").within(-1000.0, 1000.0),
        Param::number(
            "sharpness",
            8.0,
            "How narrow the three sides blend into one another, for triplanar.",
        )
        .within(1.0, 64.0),
        Param::choice(
            "normal_y",
            &["up", "down"],
            "Where green points in a normal map: up as in OpenGL and glTF, down as in DirectX.",
        ),
    ]
}

/// Parameters that place a decal.
fn decal_params() -> Vec<Param> {
    vec![
        Param::lengths("position", [0.0; 3], "The middle of the decal in model space."),
        Param::vector(
            "toward",
            [0.0, 0.0, 1.0],
            "The way the decal's front faces, in model space.",
        ),
        Param::vector(
            "up",
            [0.0, 1.0, 0.0],
            "Where the decal's upper side points, in model space.",
        ),
        Param::length(
            "depth",
            0.25,
            "How far before and behind its position the decal reaches.",
        )
        .within(1e-4, 100.0),
        Param::angle(
            "facing",
            80.0,
            "A surface that turns away further than this gets nothing of the decal, which fades over ten degrees.",
        )
        .within(10.0, 180.0),
    ]
}

/// Use of a picture's values for an output.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Use {
    Color,
    Mask,
    Alpha,
    Slope,
}

/// Whether to decode sRGB.
fn is_srgb(choice: usize, of: Use, picture: &Picture) -> bool {
    match (choice, of) {
        (_, Use::Alpha | Use::Slope) | (2, _) => false,
        (1, _) => true,
        (_, Use::Mask) => false,
        (_, Use::Color) => match picture.color_space {
            Declared::Srgb => true,
            Declared::Linear => false,
            Declared::Unknown => !matches!(picture.pixels, Pixels::F32(_)),
        },
    }
}

/// Fills a plane of a result. Adds probable mistakes to `warnings`.
pub(crate) fn plane(
    surface: &SourceSurface<'_>,
    open: &OpenPicture,
    step: &SourceStep,
    output: &str,
    plane: Plane,
    warnings: &mut Vec<String>,
) -> Vec<u8> {
    let picture = &open.picture;
    let of = match output {
        "color" => Use::Color,
        "mask" => Use::Mask,
        "alpha" => Use::Alpha,
        _ => Use::Slope,
    };
    for doubt in doubts(open, step, of) {
        if !warnings.contains(&doubt) {
            warnings.push(doubt);
        }
    }
    let projection = Projection::new(&step.values, [picture.width, picture.height]);
    let wrap = if projection.repeats() {
        Wrap::Repeat
    } else {
        Wrap::Clamp
    };
    let levels = open.levels(is_srgb(step.values.index("color_space"), of, picture));
    let sampler = Sampler::new(levels, [wrap; 2]);
    let green = if step.values.index("normal_y") == 0 { 1.0 } else { -1.0 };
    let has_normals = picture.channels >= 3;
    surface.texels(plane, |point| {
        let mut sum = [0.0_f32; 4];
        for view in projection.views(surface, point).iter().flatten() {
            let [r, g, b, a] = sampler.sample(&view.footprint);
            let value = match of {
                Use::Color => [r, g, b],
                Use::Mask => [view.cover * luminance([r, g, b]), 0.0, 0.0],
                Use::Alpha => [view.cover * a, 0.0, 0.0],
                Use::Slope if has_normals && view.cover > 0.0 => {
                    let [x, y, z] = [r, g, b].map(|code| 2.0 * code - 1.0);
                    let slope = projection.slope(view, &surface.frame(point), [x, green * y, z]);
                    slope.map(|part| view.cover * part)
                }
                Use::Slope => [0.0; 3],
            };
            for (sum, value) in sum.iter_mut().zip(value) {
                *sum += view.weight * value;
            }
        }
        [sum[0], sum[1], sum[2], 1.0]
    })
}

/// Lists probable mistakes, as sentences.
fn doubts(open: &OpenPicture, step: &SourceStep, of: Use) -> Vec<String> {
    let file = step.values.text("file");
    let mut sentences = Vec::new();
    if of == Use::Slope && open.picture.channels < 3 {
        sentences.push(format!(
            "node '{}' ({NAME}) has no slope: {file} is gray, and a normal map has colors; use its mask as a height instead",
            step.id
        ));
    }
    if open.has_non_numbers {
        sentences.push(format!(
            "node '{}' ({NAME}): {file} holds infinite or undefined numbers, which count as 0",
            step.id
        ));
    }
    sentences
}
