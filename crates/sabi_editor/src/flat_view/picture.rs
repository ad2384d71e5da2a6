//! Pictures and histograms of values.

use egui::{Color32, ColorImage, Painter, Rect, Stroke, ecolor::gamma_u8_from_linear_f32, pos2, vec2};
use sabi_engine::evaluating::{PlaneKind, ResultPlane};
use sabi_engine::live::InspectedResult;

use crate::theme::{Theme, space};

/// Height of the histogram in the corner of the view, points.
pub(super) const HISTOGRAM: f32 = 56.0;
/// Least width of a histogram, points.
const NARROWEST: f32 = 80.0;
/// Brightness beside the charts.
const BESIDE: f32 = 0.45;

/// Picture of a plane of values, or of one component of it in gray. Colors are encoded as sRGB, other numbers are kept,
/// and vectors are mapped from −1..1 to 0..1.
pub(super) fn picture_of(values: &InspectedResult, plane: &ResultPlane, component: Option<usize>) -> ColorImage {
    let side = values.size as usize;
    let code = |number: f32| match plane.holds {
        PlaneKind::Color if component != Some(3) => gamma_u8_from_linear_f32(number.clamp(0.0, 1.0)),
        PlaneKind::Signed => quantized(number * 0.5 + 0.5),
        PlaneKind::Color | PlaneKind::Numbers => quantized(number),
    };
    let texels = plane.values.chunks_exact(plane.components.max(1));
    let pixels = texels.zip(&values.is_on_surface).map(|(texel, is_on_surface)| {
        let color = match (component, texel) {
            (Some(at), texel) => Color32::from_gray(code(texel[at])),
            (None, [red, green, blue, ..]) => Color32::from_rgb(code(*red), code(*green), code(*blue)),
            (None, texel) => Color32::from_gray(code(texel[0])),
        };
        if *is_on_surface {
            return color;
        }
        let [red, green, blue] = [color.r(), color.g(), color.b()].map(|code| (f32::from(code) * BESIDE) as u8);
        Color32::from_rgb(red, green, blue)
    });
    ColorImage::new([side, side], pixels.collect())
}

fn quantized(number: f32) -> u8 {
    (number.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// Height that the numbers at both ends of a histogram take above its columns, points.
const ENDS: f32 = 13.0;

/// Histogram of the texels on the surface.
pub(crate) struct Histogram {
    /// Columns of each component.
    columns: Vec<Vec<u32>>,
    /// Values at both ends.
    range: [f32; 2],
}

impl Histogram {
    /// Counts the texels on the surface; values outside 0..1 widen the range.
    pub(crate) fn of(
        values: &InspectedResult,
        plane: &ResultPlane,
        component: Option<usize>,
        bins: usize,
    ) -> Histogram {
        let components: Vec<usize> = match component {
            Some(at) => vec![at],
            None => (0..plane.components.min(3)).collect(),
        };
        let texels = || {
            let texels = plane
                .values
                .chunks_exact(plane.components.max(1))
                .zip(&values.is_on_surface);
            texels
                .filter(|(_, is_on_surface)| **is_on_surface)
                .map(|(texel, _)| texel)
        };
        let mut range = [0.0_f32, 1.0];
        for texel in texels() {
            for at in &components {
                range = [range[0].min(texel[*at]), range[1].max(texel[*at])];
            }
        }
        let mut columns = vec![vec![0; bins]; components.len()];
        for texel in texels() {
            for (columns, at) in columns.iter_mut().zip(&components) {
                let share = (texel[*at] - range[0]) / (range[1] - range[0]);
                columns[((share * bins as f32) as usize).min(bins - 1)] += 1;
            }
        }
        Histogram { columns, range }
    }

    /// Draws the histogram in the lower right corner, as wide as there is room beside the texture in `square`; over it where that
    /// is too little.
    pub(super) fn draw(&self, painter: &Painter, panel: Rect, square: Rect, theme: &Theme) {
        let mut size = vec2(150.0, HISTOGRAM);
        if panel.width() < 2.0 * size.x || panel.height() < 2.0 * size.y {
            return;
        }
        let beside = panel.right() - square.right() - 2.0 * space::USUAL;
        if beside >= NARROWEST {
            size.x = size.x.min(beside);
        }
        let rect = Rect::from_min_size(panel.max - size - vec2(space::USUAL, space::USUAL), size);
        self.draw_in(painter, rect, theme);
    }

    /// Horizontal place of a value in a histogram that is drawn in a rectangle; `None` for values outside of its range.
    pub(crate) fn place_of(&self, value: f32, rect: Rect) -> Option<f32> {
        let [low, high] = self.range;
        (low..=high)
            .contains(&value)
            .then(|| rect.left() + (value - low) / (high - low) * rect.width())
    }

    /// Value at a horizontal place of a histogram that is drawn in a rectangle.
    pub(crate) fn value_at(&self, x: f32, rect: Rect) -> f32 {
        let [low, high] = self.range;
        low + (x - rect.left()) / rect.width() * (high - low)
    }

    /// Draws the histogram in a rectangle.
    pub(crate) fn draw_in(&self, painter: &Painter, rect: Rect, theme: &Theme) {
        painter.rect_filled(rect, space::CORNER, theme.panel.gamma_multiply(0.9));
        // The highest column is often that of one constant value, and would hide the others.
        let mut counts: Vec<u32> = self.columns.iter().flatten().copied().collect();
        counts.sort_unstable();
        let tall = counts
            .get(counts.len().saturating_sub(1 + self.columns.len() * 2))
            .copied()
            .unwrap_or(1)
            .max(1);
        let colors = match self.columns.len() {
            1 => vec![theme.text],
            _ => vec![
                Color32::from_rgb(230, 90, 90),
                Color32::from_rgb(90, 200, 110),
                Color32::from_rgb(90, 140, 240),
            ],
        };
        for (columns, color) in self.columns.iter().zip(colors) {
            let width = rect.width() / columns.len() as f32;
            for (at, count) in columns.iter().enumerate().filter(|(_, count)| **count > 0) {
                let height = (*count as f32 / tall as f32).min(1.0) * (rect.height() - ENDS);
                let x = rect.left() + (at as f32 + 0.5) * width;
                let stroke = Stroke::new(width.max(1.0), color.gamma_multiply(0.6));
                painter.line_segment([pos2(x, rect.bottom()), pos2(x, rect.bottom() - height)], stroke);
            }
        }
        let font = egui::FontId::monospace(9.0);
        let ends = [
            // Leaves room for the line of a parameter at an end.
            (rect.left_top() + vec2(4.0, 1.0), egui::Align2::LEFT_TOP),
            (rect.right_top() + vec2(-4.0, 1.0), egui::Align2::RIGHT_TOP),
        ];
        for ((at, align), number) in ends.into_iter().zip(self.range) {
            painter.text(at, align, format!("{number:.2}"), font.clone(), theme.quiet);
        }
    }
}

#[cfg(test)]
mod tests {
    use sabi_engine::evaluating::TextureSet;
    use sabi_export::SetKey;
    use sabi_graph::PortType;

    use super::*;

    fn mask(numbers: &[f32]) -> InspectedResult {
        plane(PlaneKind::Numbers, numbers)
    }

    fn plane(holds: PlaneKind, numbers: &[f32]) -> InspectedResult {
        InspectedResult {
            ty: PortType::Mask,
            size: 2,
            set: TextureSet {
                key: SetKey {
                    material: 0,
                    uv_tile: [0, 0],
                    udim: None,
                },
                name: "set".to_owned(),
            },
            planes: vec![ResultPlane {
                name: "",
                holds,
                components: 1,
                values: numbers.to_vec(),
            }],
            is_on_surface: vec![true, true, true, false],
        }
    }

    #[test]
    fn a_mask_is_drawn_in_gray_and_is_darker_outside_of_the_charts() {
        let values = mask(&[0.0, 0.5, 2.0, 1.0]);
        let picture = picture_of(&values, &values.planes[0], None);
        let gray: Vec<u8> = picture.pixels.iter().map(|pixel| pixel.r()).collect();
        assert_eq!(&gray[..3], [0, 128, 255]);
        assert!(gray[3] < 200);
    }

    #[test]
    fn colors_are_encoded_and_signed_numbers_shown_around_gray() {
        let grays = |holds| {
            let values = plane(holds, &[-1.0, 0.0, 0.5, 1.0]);
            let picture = picture_of(&values, &values.planes[0], None);
            [0, 1, 2].map(|at: usize| picture.pixels[at].r())
        };
        assert_eq!(grays(PlaneKind::Signed), [0, 128, 191]);
        assert_eq!(grays(PlaneKind::Color), [0, 0, 188]);
    }

    #[test]
    fn only_the_surface_is_counted_and_the_range_holds_all_of_it() {
        let values = mask(&[-1.0, 0.5, 0.5, 7.0]);
        let histogram = Histogram::of(&values, &values.planes[0], None, 4);
        assert_eq!(histogram.range, [-1.0, 1.0]);
        assert_eq!(histogram.columns, [vec![1, 0, 0, 2]]);
        let rect = Rect::from_min_size(pos2(10.0, 0.0), vec2(100.0, 50.0));
        let places = [-1.0, 0.0, 1.0, 1.5].map(|value| histogram.place_of(value, rect));
        assert_eq!(places, [Some(10.0), Some(60.0), Some(110.0), None]);
    }
}
