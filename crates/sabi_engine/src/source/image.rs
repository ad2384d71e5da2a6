//! `source/image`: a picture from a file, projected onto the surface.

use sabi_color::luminance;
use sabi_graph::PortType;
use sabi_image::{Declared, Picture, Pixels};
use sabi_nodes::kind::Param;
use sabi_nodes::link::Plane;
use sabi_plan::{NoSuchValue, SourceKind, SourcePort, SourceStep};
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
        summary: "An image file, projected onto the surface.".to_owned(),
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
            SourcePort::new("color", PortType::Color, "Colors of the image."),
            SourcePort::new(
                "mask",
                PortType::Mask,
                "Luminance of the image as stored in the file; 0 outside of a decal.",
            ),
            SourcePort::new("alpha", PortType::Mask, "Opacity of the image; 0 outside of a decal."),
            SourcePort::new(
                "slope",
                PortType::Vector,
                "Slope of a normal map: the surface gradient in model space; 0 outside of a decal.",
            ),
        ],
        content: [0; 32],
    }
}

fn params() -> Vec<Param> {
    vec![
        Param::file(
            "file",
            "Image file: PNG, JPEG, WebP, TGA, BMP, HDR or OpenEXR. A relative path starts from the folder of the \
             graph file.",
        ),
        Param::choice(
            "color_space",
            &["auto", "srgb", "linear"],
            "Color space of the file. With auto, the color is read as the file declares, else as sRGB, or as linear in \
             files of floating-point numbers, and the mask is read as linear. Alpha and slope are always linear.",
        ),
        Param::choice(
            "projection",
            &["uv", "triplanar", "decal"],
            "Placement of the image: by the model's own texture coordinates (uv), from three sides along the model's \
             axes (triplanar), or from one side (decal).",
        ),
        Param::length(
            "size",
            0.5,
            "Width of one tile for triplanar, or of the decal; pixels stay square.",
        )
        .within(1e-4, 100.0)
        .with_slider(0.01, 2.0),
        Param::pair(
            "tiles",
            [1.0, 1.0],
            "Number of repeats across and down the texture coordinates, for uv.",
        )
        .within(0.001, 1000.0)
        .with_slider(1.0, 16.0),
        Param::angle("rotate", 0.0, "Rotates the image counter-clockwise.")
            .within(-360.0, 360.0)
            .with_slider(-180.0, 180.0),
        Param::pair("offset", [0.0, 0.0], "Moves the image to the right and up, in tiles.").within(-1000.0, 1000.0),
        Param::number(
            "sharpness",
            8.0,
            "Sharpness of the blend between the three sides, for triplanar.",
        )
        .within(1.0, 64.0),
        Param::choice(
            "normal_y",
            &["up", "down"],
            "Direction of green in a normal map: up as in OpenGL and glTF, down as in DirectX.",
        ),
    ]
}

/// Parameters that place a decal.
fn decal_params() -> Vec<Param> {
    vec![
        Param::lengths("position", [0.0; 3], "Center of the decal, in model space."),
        Param::vector(
            "toward",
            [0.0, 0.0, 1.0],
            "Direction that the decal faces, in model space.",
        ),
        Param::vector(
            "up",
            [0.0, 1.0, 0.0],
            "Direction from the bottom to the top of the decal, in model space.",
        ),
        Param::length(
            "depth",
            0.25,
            "Distance that the decal reaches in front of its position and behind it.",
        )
        .within(1e-4, 100.0),
        Param::angle(
            "facing",
            80.0,
            "Largest angle between the surface normal and Toward; the decal fades out over the last ten degrees.",
        )
        .within(10.0, 180.0),
    ]
}

/// Output of the kind, which decides the use of a picture's values for an output.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Output {
    Color,
    Mask,
    Alpha,
    Slope,
}

/// Returns whether values are decoded from sRGB.
fn is_srgb(choice: usize, of: Output, picture: &Picture) -> bool {
    match (choice, of) {
        (_, Output::Alpha | Output::Slope) | (2, _) => false,
        (1, _) => true,
        (_, Output::Mask) => false,
        (_, Output::Color) => match picture.color_space {
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
) -> Result<Vec<u8>, NoSuchValue> {
    let picture = &open.picture;
    let of = match output {
        "color" => Output::Color,
        "mask" => Output::Mask,
        "alpha" => Output::Alpha,
        _ => Output::Slope,
    };
    for mistake in probable_mistakes(open, step, of)? {
        if !warnings.contains(&mistake) {
            warnings.push(mistake);
        }
    }
    let projection = Projection::new(&step.values, [picture.width, picture.height])?;
    let wrap = if projection.repeats() {
        Wrap::Repeat
    } else {
        Wrap::Clamp
    };
    let levels = open.levels(is_srgb(step.values.index("color_space")?, of, picture), 1);
    let sampler = Sampler::new(levels, [wrap; 2]);
    let green = if step.values.index("normal_y")? == 0 { 1.0 } else { -1.0 };
    let has_normals = picture.channels >= 3;
    Ok(surface.texels(plane, |point| {
        let mut sum = [0.0_f32; 4];
        for view in projection.views(surface, point).iter().flatten() {
            let [r, g, b, a] = sampler.sample(&view.footprint);
            let value = match of {
                Output::Color => [r, g, b],
                Output::Mask => [view.cover * luminance([r, g, b]), 0.0, 0.0],
                Output::Alpha => [view.cover * a, 0.0, 0.0],
                Output::Slope if has_normals && view.cover > 0.0 => {
                    let [x, y, z] = [r, g, b].map(|code| 2.0 * code - 1.0);
                    let slope = projection.slope(view, &surface.frame(point), [x, green * y, z]);
                    slope.map(|part| view.cover * part)
                }
                Output::Slope => [0.0; 3],
            };
            for (sum, value) in sum.iter_mut().zip(value) {
                *sum += view.weight * value;
            }
        }
        [sum[0], sum[1], sum[2], 1.0]
    }))
}

/// Lists probable mistakes, as sentences.
fn probable_mistakes(open: &OpenPicture, step: &SourceStep, of: Output) -> Result<Vec<String>, NoSuchValue> {
    let file = step.values.text("file")?;
    let mut sentences = Vec::new();
    if of == Output::Slope && open.picture.channels < 3 {
        sentences.push(format!(
            "node '{}' ({NAME}) has no slope: {file} is gray, and a normal map has colors; use its mask as a height \
             instead",
            step.id
        ));
    }
    if open.has_non_numbers {
        sentences.push(format!(
            "node '{}' ({NAME}): {file} holds infinite or undefined numbers, which count as 0",
            step.id
        ));
    }
    Ok(sentences)
}
