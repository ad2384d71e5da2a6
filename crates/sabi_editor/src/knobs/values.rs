//! Values of knobs as the widgets show them. [`ParamType`](sabi_nodes::kind::ParamType) defines their meaning.

use egui::Color32;
use sabi_engine::catalog::Knob;
use sabi_graph::{Value, canonical_number};
use sabi_nodes::kind::{WrittenStop, WrittenValue};
use sabi_nodes::{color_code, typed_color};

/// A knob's value, with colors as egui has them.
#[derive(Debug, PartialEq)]
pub(super) enum KnobValue<'v> {
    /// As many as the knob has components; the others are 0.
    Numbers([f64; 4]),
    On(bool),
    Text(&'v str),
    Color(Color32),
    /// By position.
    Stops(Vec<GradientStop>),
    /// By x; two at one x are a step.
    Points(Vec<[f64; 2]>),
}

/// A color of a gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GradientStop {
    /// 0 to 1.
    pub(super) at: f64,
    pub(super) color: Color32,
}

impl GradientStop {
    /// The stop as egui has its color.
    pub(super) fn of(written: &WrittenStop) -> GradientStop {
        GradientStop {
            at: written.position,
            color: color32(written.color),
        }
    }
}

/// Reads a value; `None` where its form is not that of the knob. Ranges are not checked.
pub(super) fn read<'v>(knob: &Knob, value: &'v Value) -> Option<KnobValue<'v>> {
    Some(match knob.ty.written(value)? {
        WrittenValue::Numbers(numbers) => {
            let mut held = [0.0; 4];
            held.get_mut(..numbers.len())?.copy_from_slice(&numbers);
            KnobValue::Numbers(held)
        }
        WrittenValue::Toggle(is_on) => KnobValue::On(is_on),
        WrittenValue::Text(text) => KnobValue::Text(text),
        WrittenValue::Color(srgb) => KnobValue::Color(color32(srgb)),
        WrittenValue::Stops(stops) => KnobValue::Stops(stops.iter().map(GradientStop::of).collect()),
        WrittenValue::Points(points) => KnobValue::Points(points),
    })
}

fn color32([r, g, b]: [u8; 3]) -> Color32 {
    Color32::from_rgb(r, g, b)
}

fn srgb_of(color: Color32) -> [u8; 3] {
    [color.r(), color.g(), color.b()]
}

/// A color as people type it: `#6b3a1e`, with or without the `#`, or `#fff`.
pub(super) fn color_of(text: &str) -> Option<Color32> {
    typed_color(text).map(color32)
}

/// The code of a color, as files hold it.
pub(super) fn code_of(color: Color32) -> String {
    color_code(srgb_of(color))
}

/// Numbers as a file holds them: a single one plain, several as a list.
pub(super) fn of_numbers(numbers: &[f64]) -> Value {
    WrittenValue::Numbers(numbers.to_vec()).to_value()
}

/// A gradient as a file holds it.
pub(super) fn of_stops(stops: &[GradientStop]) -> Value {
    let stop = |stop: &GradientStop| WrittenStop {
        position: stop.at,
        color: srgb_of(stop.color),
    };
    WrittenValue::Stops(stops.iter().map(stop).collect()).to_value()
}

/// A curve as a file holds it.
pub(super) fn of_points(points: &[[f64; 2]]) -> Value {
    WrittenValue::Points(points.to_vec()).to_value()
}

/// Moves the item at `index` to its place in sorted order, and returns that place.
pub(super) fn sort_keeping<T>(items: &mut [T], mut index: usize, place: impl Fn(&T) -> f64) -> usize {
    while index > 0 && place(&items[index - 1]) > place(&items[index]) {
        items.swap(index - 1, index);
        index -= 1;
    }
    while index + 1 < items.len() && place(&items[index]) > place(&items[index + 1]) {
        items.swap(index, index + 1);
        index += 1;
    }
    index
}

/// Usual step between two ends, a power of ten.
pub(super) fn step_of(ends: [f64; 2], is_whole: bool) -> f64 {
    let span = (ends[1] - ends[0]).abs();
    if is_whole || !span.is_normal() {
        return if is_whole { 1.0 } else { 0.01 };
    }
    // A hundred steps or more; the little extra keeps a span of 1 from falling to the next finer step.
    10.0_f64.powf((span.log10() + 1e-9).floor() - 2.0)
}

/// A number to the nearest multiple of a step, as a file would keep it.
pub(super) fn rounded(number: f64, step: f64) -> f64 {
    let near = (number / step).round() * step;
    canonical_number(near).unwrap_or(number)
}

/// A number with no more digits than its steps need.
pub(super) fn text_of(number: f64, step: f64) -> String {
    let finest = step / 100.0;
    let decimals = (-finest.log10()).ceil().clamp(0.0, 9.0) as usize;
    let text = format!("{number:.decimals$}");
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => text.as_str(),
    };
    match text {
        "0" | "-0" if number != 0.0 => format!("{number:.1e}"),
        "-0" => "0".to_owned(),
        text => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_a_power_of_ten_of_which_a_hundred_or_more_fit() {
        for (ends, expected) in [
            ([0.0, 1.0], 0.01),
            ([0.0, 180.0], 1.0),
            ([-1.0, 1.0], 0.01),
            ([0.001, 0.05], 0.0001),
            ([1.0, 1.0], 0.01),
        ] {
            let found = step_of(ends, false);
            assert!((found / expected - 1.0).abs() < 1e-9, "{ends:?} has {found}");
        }
        assert_eq!(step_of([0.0, 10_000.0], true), 1.0);
    }

    #[test]
    fn a_number_is_shown_without_superfluous_digits() {
        for (number, step, expected) in [
            (0.5, 0.01, "0.5"),
            (1.0 / 3.0, 0.01, "0.3333"),
            (100.0, 1.0, "100"),
            (-0.0, 0.01, "0"),
            (0.000_001, 0.01, "1.0e-6"),
            (-0.000_04, 0.01, "-4.0e-5"),
        ] {
            assert_eq!(text_of(number, step), expected);
        }
    }

    #[test]
    fn a_sorted_item_is_found_at_its_new_place() {
        let mut items = [2.5, 1.0, 2.0, 4.0];
        assert_eq!(sort_keeping(&mut items, 0, |item| *item), 2);
        assert_eq!(items, [1.0, 2.0, 2.5, 4.0]);
        items[3] = 1.5;
        assert_eq!(sort_keeping(&mut items, 3, |item| *item), 1);
        assert_eq!(items, [1.0, 1.5, 2.0, 2.5]);
    }
}
