//! Results in texture space: values laid out like the maps of a texture set.

use sabi_color::srgb8_from_linear;
use sabi_export::{BorderRule, Channel, ChartBorders, Cover, NONE, Padding, PaddingMap, SetKey, SetLayout};
use sabi_gpu::{BorderKind, Run, read_slot};
use sabi_graph::PortType;
use sabi_image::quantize_u8;
use sabi_nodes::kind::Channel as Stored;
use sabi_nodes::link::Plane;
use sabi_plan::{Plan, PlannedResult};

use crate::error::EngineError;
use crate::evaluating::evaluator::Evaluator;
use crate::opening::linked_model::{LinkedModel, Overlap};

/// Padding around charts of results that are displayed.
const PADDING: Padding = Padding::Texels(4);

/// Layout and padding of a texture set.
pub(crate) struct TextureSpace {
    pub(crate) layout: SetLayout,
    padding: PaddingMap,
    borders: ChartBorders,
}

/// Meaning of the numbers of a plane, which determines how they are displayed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaneKind {
    /// Independent numbers. 0..1 is displayed as black to white.
    Numbers,
    /// Linear color, displayed in sRGB. A fourth number is its opacity.
    Color,
    /// Numbers in −1..1, displayed as 0..1.
    Signed,
}

/// Plane of a result in texture space.
#[derive(Clone, Debug, PartialEq)]
pub struct ResultPlane {
    /// Channel group of a material; empty for its base color and for results with one plane.
    pub name: &'static str,
    /// Meaning of its numbers.
    pub holds: PlaneKind,
    /// Numbers per pixel.
    pub components: usize,
    /// Exact values, row by row from the top.
    pub values: Vec<f32>,
}

impl TextureSpace {
    pub(crate) fn new(linked: &LinkedModel, key: SetKey) -> TextureSpace {
        let layout = set_layout(linked, key);
        TextureSpace {
            padding: PaddingMap::new(&layout, PADDING),
            borders: ChartBorders::new(&linked.atlas, &layout),
            layout,
        }
    }

    /// Repeats charts in the texels around them, as exported maps do.
    fn settle(&self, plane: Plane, values: &mut [f32]) {
        let (_, _, components) = shape_of(plane);
        let BorderKind {
            together,
            keeps_first_ring,
        } = BorderKind::of(plane);
        let rule = match keeps_first_ring {
            true => BorderRule::Meet,
            false => BorderRule::AtJumps,
        };
        let mut are_changed = false;
        for first in (0..components).step_by(together) {
            let parts = first..components.min(first + together);
            are_changed |= self.borders.repeat_values(rule, components, parts, values);
        }
        if are_changed {
            for (pixel, from) in self.padding.sources().enumerate() {
                let from = from as usize;
                if from != pixel && from != NONE as usize {
                    values.copy_within(from * components..(from + 1) * components, pixel * components);
                }
            }
        }
    }

    /// Returns for each pixel true if a chart covers it. The others contain padding.
    pub(crate) fn is_owned(&self) -> Vec<bool> {
        self.layout.cover.iter().map(|cover| *cover == Cover::Owned).collect()
    }

    /// Reads back the planes of a result. The base color of a material comes first.
    pub(crate) fn planes(
        &self,
        evaluator: &Evaluator,
        plan: &Plan,
        run: &Run,
        result: &PlannedResult,
    ) -> Result<Vec<ResultPlane>, EngineError> {
        let planes = result.stored.planes().into_iter().zip(&result.slots);
        let laid_out = planes.map(|(plane, &slot)| {
            let data = read_slot(evaluator.gpu(), evaluator.surface(), plan, run, slot)?;
            let (name, holds, components) = shape_of(plane);
            let one = |first| {
                let channel = Channel::Mask(String::new());
                let gathered = self
                    .padding
                    .gather(&self.layout, &channel, first, |index| data.texel(index));
                gathered.data
            };
            let parts: Vec<Vec<f32>> = (0..components).map(one).collect();
            let pixels = 0..self.padding.pixels();
            let mut values: Vec<f32> = pixels
                .flat_map(|pixel| parts.iter().map(move |part| part[pixel]))
                .collect();
            self.settle(plane, &mut values);
            Ok(ResultPlane {
                name,
                holds,
                components,
                values,
            })
        });
        laid_out.collect()
    }
}

/// Returns the layout of a texture set for the overlap setting of the model.
pub(crate) fn set_layout(linked: &LinkedModel, key: SetKey) -> SetLayout {
    match linked.overlap {
        Overlap::Merge => SetLayout::merged(&linked.atlas, key),
        Overlap::Auto | Overlap::First | Overlap::Unwrap => SetLayout::new(&linked.atlas, key),
    }
}

/// Returns the name of a plane, the meaning of its numbers, and how many a texel has.
fn shape_of(plane: Plane) -> (&'static str, PlaneKind, usize) {
    use PlaneKind::{Color, Numbers, Signed};
    match plane {
        Plane::Mask => ("", Numbers, 1),
        Plane::Color => ("", Color, 3),
        Plane::Vector => ("", Signed, 3),
        Plane::Material(Stored::Color) => ("", Color, 4),
        Plane::Material(Stored::Surface) => ("surface", Numbers, 3),
        Plane::Material(Stored::Height) => ("height", Numbers, 1),
        Plane::Material(Stored::Slope) => ("slope", Signed, 3),
        Plane::Material(Stored::Emission) => ("emission", Color, 3),
        Plane::Material(Stored::Coat) => ("coat", Numbers, 2),
        Plane::Material(Stored::Anisotropy) => ("anisotropy", Signed, 3),
        Plane::Material(Stored::Sheen) => ("sheen", Color, 3),
        Plane::Material(Stored::Subsurface) => ("subsurface", Color, 3),
    }
}

/// Encodes a texel's values for a display: masks as gray, colors in sRGB, vectors with −1..1 mapped to 0..1.
pub(crate) fn rgb_codes(ty: PortType, values: &[f32]) -> [u8; 3] {
    // A mask has one value, which is shown as gray.
    let rgb = match values {
        [r, g, b, ..] => [*r, *g, *b],
        [gray, ..] => [*gray; 3],
        [] => [0.0; 3],
    };
    rgb.map(|value| match ty {
        PortType::Mask => quantize_u8(value),
        PortType::Color | PortType::Material => srgb8_from_linear(value),
        PortType::Vector => quantize_u8(value * 0.5 + 0.5),
    })
}
