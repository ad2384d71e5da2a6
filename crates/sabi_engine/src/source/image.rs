//! `source/image`: a picture from a file, projected onto the surface.

use std::sync::Arc;

use sabi_gpu::{GpuError, ImageConstants, ImageShader, SourceCanvas, SourceDraw, SourceShader};
use sabi_graph::PortType;
use sabi_image::{Pixels, listed_layers};
use sabi_plan::{NoSuchValue, SourceKind, SourcePort, SourceStep};
use sabi_surface::model::Wrap;

use super::mip_chain::{PixelCurve, PixelReading};
use super::picture_table::PictureTable;
use super::projection::Projection;
use super::session_pictures::OpenPicture;
use super::texels::SourceSurface;
use super::{image_params, unreadable};

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
            "transform",
            "triplanar",
            "normal map",
        ]
        .map(str::to_owned)
        .to_vec(),
        params: image_params::params(),
        inputs: vec![
            SourcePort::new(
                "position",
                PortType::Vector,
                "Where the image is read, such as the place in each cell of a pattern. For uv x and y go from 0 to 1 across \
                 the image, to the right and up; for triplanar and decal it is a place in model space.",
            )
            .optional("the surface's own place"),
            SourcePort::new(
                "cell",
                PortType::Mask,
                "Which of the pictures in the file is seen, from 0 for the first to 1 for the last one: a random value for each \
                 stamp or brick, such as Id.",
            )
            .optional("the z of texture coordinates that are read, which Stamp and the patterns give, else the first"),
        ],
        outputs: outputs(),
        content: [0; 32],
    }
}

fn outputs() -> Vec<SourcePort> {
    let mask = |name: &str, doc: &str| SourcePort::new(name, PortType::Mask, doc);
    vec![
        SourcePort::new("color", PortType::Color, "Colors of the image."),
        mask(
            "mask",
            "Luminance of the image as stored in the file; 0 outside of a decal.",
        ),
        mask("alpha", "Opacity of the image; 0 outside of a decal."),
        SourcePort::new(
            "slope",
            PortType::Vector,
            "Slope of a normal map: the surface gradient in model space; 0 outside of a decal.",
        ),
        mask("r", "Red as stored in the file; 0 outside of a decal."),
        mask("g", "Green as stored in the file; 0 outside of a decal."),
        mask("b", "Blue as stored in the file; 0 outside of a decal."),
        mask("a", "The same as alpha."),
    ]
}

/// Output of the kind. It determines how a picture's values are used.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ImageOutput {
    Color,
    Mask,
    Alpha,
    Slope,
    /// Red, green or blue as a mask.
    Channel(usize),
}

impl ImageOutput {
    fn of(name: &str) -> ImageOutput {
        match name {
            "color" => ImageOutput::Color,
            "mask" => ImageOutput::Mask,
            "alpha" | "a" => ImageOutput::Alpha,
            "r" => ImageOutput::Channel(0),
            "g" => ImageOutput::Channel(1),
            "b" => ImageOutput::Channel(2),
            _ => ImageOutput::Slope,
        }
    }

    /// Returns the number of the shown value; see `shaders/source/image.wgsl`.
    fn number(self) -> u32 {
        match self {
            // The kernel for slopes does not use this number.
            ImageOutput::Color | ImageOutput::Slope => 0,
            ImageOutput::Mask => 1,
            ImageOutput::Alpha => 2,
            ImageOutput::Channel(channel) => 3 + channel as u32,
        }
    }

    /// Returns the curve of the values.
    fn curve(self, choice: ColorSpaceChoice) -> PixelCurve {
        match (choice, self) {
            (_, ImageOutput::Alpha | ImageOutput::Slope) | (ColorSpaceChoice::Linear, _) => PixelCurve::Linear,
            (ColorSpaceChoice::Srgb, _) => PixelCurve::Srgb,
            (ColorSpaceChoice::Auto, ImageOutput::Mask | ImageOutput::Channel(_)) => PixelCurve::Linear,
            (ColorSpaceChoice::Auto, ImageOutput::Color) => PixelCurve::Declared,
        }
    }
}

/// Value of the parameter `color_space`.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ColorSpaceChoice {
    Auto,
    Srgb,
    Linear,
}

impl ColorSpaceChoice {
    fn of(step: &SourceStep) -> Result<ColorSpaceChoice, NoSuchValue> {
        Ok(match step.values.index("color_space")? {
            1 => ColorSpaceChoice::Srgb,
            2 => ColorSpaceChoice::Linear,
            _ => ColorSpaceChoice::Auto,
        })
    }
}

/// Draws a plane of a result. Adds probable mistakes to `warnings`.
///
/// # Errors
/// A parameter is missing, the run is canceled, or the device refuses.
pub(super) fn draw(
    surface: &SourceSurface<'_>,
    canvas: &SourceCanvas<'_>,
    step: &SourceStep,
    output: &str,
    open: &Arc<OpenPicture>,
    warnings: &mut Vec<String>,
) -> Result<(), GpuError> {
    let of = ImageOutput::of(output);
    let unread = |error| unreadable(step, &error);
    let choice = ColorSpaceChoice::of(step).map_err(unread)?;
    let reading = PixelReading {
        curve: of.curve(choice),
        // Channels and slopes are values as stored in the file.
        by_alpha: of == ImageOutput::Color && step.values.index("alpha_is").map_err(unread)? == 0,
    };
    let picture = surface.picture_tables.table(canvas, open, reading)?;
    let mut mistakes = probable_mistakes(open, step, of, reading.curve).map_err(unread)?;
    let file = step.values.text("file").map_err(unread)?;
    mistakes.extend(picture.why_smaller(&format!("node '{}' ({NAME}): {file}", step.id)));
    for mistake in mistakes {
        if !warnings.contains(&mistake) {
            warnings.push(mistake);
        }
    }
    let (shader, constants) = kernel(canvas, step, of, open, reading, &picture).map_err(unread)?;
    canvas.draw(&SourceDraw {
        shader: SourceShader::Image(shader),
        constants,
        tables: &[&picture.table],
        tiles: None,
    })
}

/// The kernel that shows a picture, and its constants.
fn kernel(
    canvas: &SourceCanvas<'_>,
    step: &SourceStep,
    of: ImageOutput,
    open: &OpenPicture,
    reading: PixelReading,
    table: &PictureTable,
) -> Result<(ImageShader, ImageConstants), NoSuchValue> {
    let (picture, values) = (&open.picture, &step.values);
    let projection = Projection::new(values, [picture.width, picture.height])?;
    let repeats = projection.repeats();
    let wrap = if repeats { Wrap::Repeat } else { Wrap::Clamp };
    let green = if values.index("normal_y")? == 0 { 1.0 } else { -1.0 };
    let levels = open.levels(reading, 1);
    let shader = ImageShader {
        storage: table.storage,
        shows_slope: of == ImageOutput::Slope,
        way: projection.way,
        reads_place: canvas.has_input(0),
        has_cells: projection.has_cells,
        is_random: values.index("tiling")? == 1 && repeats && !projection.has_cells,
    };
    let constants = ImageConstants {
        projection: projection.constants,
        mean: levels.pixel(levels.last(), 0, 0),
        picture: table.constants([wrap; 2]),
        shown: of.number(),
        is_limited: u32::from(!matches!(picture.pixels, Pixels::F32(_))),
        seed: values.index("seed")? as u32,
        most_turned: values.number("turn")?,
        green: if picture.channels >= 3 { green } else { 0.0 },
        has_cell: u32::from(canvas.has_input(1)),
        pad: [0; 2],
    };
    Ok((shader, constants))
}

/// Lists probable mistakes, as sentences.
fn probable_mistakes(
    open: &OpenPicture,
    step: &SourceStep,
    of: ImageOutput,
    curve: PixelCurve,
) -> Result<Vec<String>, NoSuchValue> {
    let file = step.values.text("file")?;
    let mut sentences = Vec::new();
    if of == ImageOutput::Slope && open.picture.channels < 3 {
        sentences.push(format!(
            "node '{}' ({NAME}) has no slope: {file} is gray, and a normal map has colors; use its mask as a height \
             instead",
            step.id
        ));
    }
    if let [shown, others @ ..] = open.layers.as_slice()
        && !others.is_empty()
        && step.values.text("layer")?.is_empty()
    {
        sentences.push(format!(
            "node '{}' ({NAME}): {file} has {} layers, of which {shown} is shown; its parameter layer chooses another: {}",
            step.id,
            open.layers.len(),
            listed_layers(others)
        ));
    }
    let remarks = &open.picture.remarks;
    // Declarations about colors matter only where colors are read as declared.
    let of_color = remarks.color.iter().filter(|_| curve == PixelCurve::Declared);
    let told = remarks.values.iter().chain(of_color);
    sentences.extend(told.map(|remark| format!("node '{}' ({NAME}): {file} {remark}", step.id)));
    Ok(sentences)
}
