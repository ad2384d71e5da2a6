//! `source/image`: a picture from a file, projected onto the surface.

use sabi_color::luminance;
use sabi_gpu::PlaneData;
use sabi_graph::PortType;
use sabi_image::{Declared, Picture, Pixels};
use sabi_nodes::link::Plane;
use sabi_plan::{NoSuchValue, SourceKind, SourcePort, SourceStep};
use sabi_surface::model::Wrap;

use super::image_params;
use super::patches::Patches;
use super::pictures::OpenPicture;
use super::projection::{Projection, View};
use super::read_position::{ReadPosition, ReadPositions};
use super::sampler::{Footprint, Sampler};
use super::texels::{SourceSurface, SurfacePoint};

/// Weight below which a patch is not read: less than a step of 8 bits.
const LEAST_WEIGHT: f32 = 1.0 / 256.0;

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

/// Output of the kind, which decides the use of a picture's values for an output.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Output {
    Color,
    Mask,
    Alpha,
    Slope,
    /// Red, green or blue as a mask.
    Channel(usize),
}

impl Output {
    fn of(name: &str) -> Output {
        match name {
            "color" => Output::Color,
            "mask" => Output::Mask,
            "alpha" | "a" => Output::Alpha,
            "r" => Output::Channel(0),
            "g" => Output::Channel(1),
            "b" => Output::Channel(2),
            _ => Output::Slope,
        }
    }

    /// Returns whether values are decoded from sRGB.
    fn is_srgb(self, choice: usize, picture: &Picture) -> bool {
        match (choice, self) {
            (_, Output::Alpha | Output::Slope) | (2, _) => false,
            (1, _) => true,
            (_, Output::Mask | Output::Channel(_)) => false,
            (_, Output::Color) => match picture.color_space {
                Declared::Srgb => true,
                Declared::Linear => false,
                Declared::Unknown => !matches!(picture.pixels, Pixels::F32(_)),
            },
        }
    }
}

/// Picture as it is read for one output.
struct Reader {
    of: Output,
    projection: Projection,
    sampler: Sampler,
    patches: Option<Patches>,
    /// Mean of the picture, and whether its values end at 0 and 1.
    mean: [f32; 4],
    is_limited: bool,
    /// Sign of green in a normal map; 0 for a picture without colors.
    green: f32,
}

impl Reader {
    fn new(open: &OpenPicture, step: &SourceStep, of: Output) -> Result<Reader, NoSuchValue> {
        let (picture, values) = (&open.picture, &step.values);
        let projection = Projection::new(values, [picture.width, picture.height])?;
        let wrap = if projection.repeats() {
            Wrap::Repeat
        } else {
            Wrap::Clamp
        };
        let levels = open.levels(of.is_srgb(values.index("color_space")?, picture), 1);
        let is_random = values.index("tiling")? == 1 && projection.repeats() && !projection.has_cells();
        let seed = values.index("seed")? as u32;
        let turn = f64::from(values.number("turn")?);
        let green = if values.index("normal_y")? == 0 { 1.0 } else { -1.0 };
        Ok(Reader {
            of,
            patches: is_random.then(|| Patches::new(seed, turn, projection.aspect())),
            projection,
            mean: levels.pixel(levels.last(), 0, 0),
            sampler: Sampler::new(levels, [wrap; 2]),
            is_limited: !matches!(picture.pixels, Pixels::F32(_)),
            green: if picture.channels >= 3 { green } else { 0.0 },
        })
    }

    /// Returns the sum of all views of the picture at a point.
    fn value(
        &self,
        surface: &SourceSurface<'_>,
        point: &SurfacePoint,
        (read, cell): (Option<ReadPosition>, Option<f64>),
    ) -> [f32; 4] {
        let mut sum = [0.0_f32; 4];
        for view in self
            .projection
            .views_of_cell(surface, point, read, cell)
            .iter()
            .flatten()
        {
            let value = match self.of {
                Output::Slope if self.green == 0.0 || view.cover <= 0.0 => [0.0; 3],
                Output::Slope => self.slope(surface, point, view).map(|part| view.cover * part),
                of => {
                    let [r, g, b, a] = self.pixel(view);
                    match of {
                        Output::Mask => [view.cover * luminance([r, g, b]), 0.0, 0.0],
                        Output::Alpha => [view.cover * a, 0.0, 0.0],
                        Output::Channel(channel) => [view.cover * [r, g, b][channel], 0.0, 0.0],
                        Output::Color | Output::Slope => [r, g, b],
                    }
                }
            };
            for (sum, value) in sum.iter_mut().zip(value) {
                *sum += view.weight * value;
            }
        }
        [sum[0], sum[1], sum[2], 1.0]
    }

    /// Returns the picture's value in a view.
    fn pixel(&self, view: &View) -> [f32; 4] {
        let Some(patches) = &self.patches else {
            return self.sampler.sample(&view.footprint);
        };
        let mut value = self.mean;
        for patch in patches.at(&view.footprint) {
            if patch.weight > LEAST_WEIGHT {
                let sample = self.sampler.sample(&patch.footprint);
                for (channel, value) in value.iter_mut().enumerate() {
                    *value += patch.weight * (sample[channel] - self.mean[channel]);
                }
            }
        }
        if self.is_limited {
            return value.map(|value| value.clamp(0.0, 1.0));
        }
        value
    }

    /// Returns the surface gradient of a normal map in a view. Patches are blended as gradients: they add up, normals do not.
    fn slope(&self, surface: &SourceSurface<'_>, point: &SurfacePoint, view: &View) -> [f32; 3] {
        let frame = surface.frame(point);
        let of = |footprint: &Footprint, [cos, sin]: [f32; 2]| {
            let [r, g, b, _] = self.sampler.sample(footprint);
            let [x, y, z] = [r, g, b].map(|code| 2.0 * code - 1.0);
            let y = self.green * y;
            self.projection
                .slope(view, &frame, [cos * x - sin * y, sin * x + cos * y, z])
        };
        let Some(patches) = &self.patches else {
            return of(&view.footprint, [1.0, 0.0]);
        };
        let mut sum = [0.0_f32; 3];
        for patch in patches.at(&view.footprint) {
            if patch.weight > LEAST_WEIGHT {
                let slope = of(&patch.footprint, patch.turn);
                for (sum, part) in sum.iter_mut().zip(slope) {
                    *sum += patch.weight * part;
                }
            }
        }
        sum
    }
}

/// Fills a plane of a result. Adds probable mistakes to `warnings`.
pub(crate) fn plane(
    surface: &SourceSurface<'_>,
    open: &OpenPicture,
    (step, output, inputs): (&SourceStep, &str, &[Option<PlaneData>]),
    plane: Plane,
    warnings: &mut Vec<String>,
) -> Result<Vec<u8>, NoSuchValue> {
    let of = Output::of(output);
    for mistake in probable_mistakes(open, step, of)? {
        if !warnings.contains(&mistake) {
            warnings.push(mistake);
        }
    }
    let reader = Reader::new(open, step, of)?;
    let positions = inputs.first().and_then(Option::as_ref);
    let positions = positions.map(|plane| ReadPositions::new(surface, plane));
    let cells = inputs.get(1).and_then(Option::as_ref);
    Ok(surface.texels(plane, |point| {
        let read = positions.as_ref().map(|positions| positions.of(point));
        let cell = cells.map(|plane| f64::from(plane.texel(point.index)[0]));
        reader.value(surface, point, (read, cell.filter(|cell| cell.is_finite())))
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
