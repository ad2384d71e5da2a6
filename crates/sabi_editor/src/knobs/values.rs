//! What the values of knobs mean, as files hold them.

use egui::Color32;
use sabi_engine::catalog::{Knob, KnobRole};
use sabi_graph::{Value, canonical_number};

/// A value, as its knob reads it.
#[derive(Debug, PartialEq)]
pub(super) enum Held<'v> {
    /// As many as the knob has components.
    Numbers([f64; 4]),
    On(bool),
    Text(&'v str),
    Color(Color32),
    /// By position.
    Stops(Vec<Stop>),
    /// By x; two at one place are a step.
    Points(Vec<[f64; 2]>),
}

/// A color of a gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stop {
    /// 0 to 1.
    pub(super) at: f64,
    pub(super) color: Color32,
}

/// Reads a value; nothing where it is none that the knob takes, whatever its range.
pub(super) fn read<'v>(knob: &Knob, value: &'v Value) -> Option<Held<'v>> {
    match &knob.role {
        KnobRole::Toggle => value.as_bool().map(Held::On),
        KnobRole::Choice(words) => {
            let word = value.as_text()?;
            words.iter().any(|known| known == word).then_some(Held::Text(word))
        }
        KnobRole::Text | KnobRole::File => value.as_text().map(Held::Text),
        KnobRole::Color => color(value).map(Held::Color),
        KnobRole::Stops => stops(value.as_list()?, knob.components).map(Held::Stops),
        KnobRole::Curve => points(value.as_list()?, knob.components).map(Held::Points),
        KnobRole::Plain | KnobRole::Length | KnobRole::Angle | KnobRole::Seed => numbers(knob, value),
        KnobRole::Extent { .. } => None,
    }
}

fn numbers(knob: &Knob, value: &Value) -> Option<Held<'static>> {
    let mut read = [0.0; 4];
    let given = match value {
        Value::List(items) if knob.components > 1 => items.as_slice(),
        single if knob.components == 1 => std::slice::from_ref(single),
        _ => return None,
    };
    let places = read.get_mut(..knob.components)?;
    if given.len() != places.len() {
        return None;
    }
    for (place, item) in places.iter_mut().zip(given) {
        *place = item.as_number()?;
        if knob.is_whole && place.fract() != 0.0 {
            return None;
        }
    }
    Some(Held::Numbers(read))
}

fn color(value: &Value) -> Option<Color32> {
    let text = value.as_text()?;
    (text.len() == 7 && text.starts_with('#'))
        .then(|| color_of(text))
        .flatten()
}

fn stops(items: &[Value], room: usize) -> Option<Vec<Stop>> {
    let stop = |item: &Value| match item.as_list()? {
        [at, code] => Some(Stop {
            at: at.as_number().filter(|at| (0.0..=1.0).contains(at))?,
            color: color(code)?,
        }),
        _ => None,
    };
    let mut stops: Vec<Stop> = items.iter().map(stop).collect::<Option<_>>()?;
    stops.sort_by(|left, right| left.at.total_cmp(&right.at));
    (1..=room).contains(&stops.len()).then_some(stops)
}

fn points(items: &[Value], room: usize) -> Option<Vec<[f64; 2]>> {
    let point = |item: &Value| match item.as_list()? {
        [x, y] => Some([x.as_number()?, y.as_number()?]),
        _ => None,
    };
    let mut points: Vec<[f64; 2]> = items.iter().map(point).collect::<Option<_>>()?;
    points.sort_by(|left, right| left[0].total_cmp(&right[0]));
    (1..=room).contains(&points.len()).then_some(points)
}

/// What a knob takes, to follow "takes".
pub(super) fn takes(knob: &Knob) -> String {
    match &knob.role {
        KnobRole::Toggle => "true or false".to_owned(),
        KnobRole::Choice(words) => format!("one of {}", words.join(", ")),
        KnobRole::Text | KnobRole::File => "a text".to_owned(),
        KnobRole::Color => "a color such as \"#6b3a1e\"".to_owned(),
        KnobRole::Stops => format!("1 to {} stops such as [0.5, \"#6b3a1e\"]", knob.components),
        KnobRole::Curve => format!("1 to {} points such as [0.5, 0.8]", knob.components),
        KnobRole::Extent { .. } => "no value: it is measured on the model".to_owned(),
        _ => {
            let sort = if knob.is_whole { "whole number" } else { "number" };
            let between = knob
                .range
                .map_or(String::new(), |[low, high]| format!(" from {low} to {high}"));
            match knob.components {
                1 => format!("a {sort}{between}"),
                count => format!("a list of {count} {sort}s{between}"),
            }
        }
    }
}

/// Whether a knob takes a value, its range included.
pub(super) fn fits(knob: &Knob, value: &Value) -> bool {
    let [low, high] = knob.range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let is_inside = |number: &f64| (low..=high).contains(number);
    match read(knob, value) {
        Some(Held::Numbers(numbers)) if knob.role == KnobRole::Seed => {
            (0.0..=f64::from(u32::MAX)).contains(&numbers[0])
        }
        Some(Held::Numbers(numbers)) => numbers.iter().take(knob.components).all(is_inside),
        Some(Held::Points(points)) => points.iter().flatten().all(is_inside),
        read => read.is_some(),
    }
}

/// A color as people write it: `#6b3a1e`, with or without the `#`, or `#fff`.
pub(super) fn color_of(text: &str) -> Option<Color32> {
    let digits = text.trim();
    let digits = digits.strip_prefix('#').unwrap_or(digits);
    if !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return None;
    }
    let code = u32::from_str_radix(digits, 16).ok()?;
    let [r, g, b] = match digits.len() {
        6 => [code >> 16, code >> 8, code],
        3 => [code >> 8, code >> 4, code].map(|nibble| (nibble & 0xf) * 0x11),
        _ => return None,
    }
    .map(|byte| (byte & 0xff) as u8);
    Some(Color32::from_rgb(r, g, b))
}

/// The code of a color, as files hold it.
pub(super) fn code_of(color: Color32) -> String {
    format!("#{:02x}{:02x}{:02x}", color.r(), color.g(), color.b())
}

/// Numbers as a file holds them: one of them plain, several as a list.
pub(super) fn of_numbers(numbers: &[f64]) -> Value {
    match numbers {
        [one] => Value::Number(*one),
        several => Value::List(several.iter().copied().map(Value::Number).collect()),
    }
}

/// A gradient as a file holds it.
pub(super) fn of_stops(stops: &[Stop]) -> Value {
    let stop = |stop: &Stop| Value::List(vec![Value::Number(stop.at), Value::Text(code_of(stop.color))]);
    Value::List(stops.iter().map(stop).collect())
}

/// A curve as a file holds it.
pub(super) fn of_points(points: &[[f64; 2]]) -> Value {
    Value::List(points.iter().map(|point| of_numbers(point)).collect())
}

/// Sorts, and says where what stood at `index` stands then.
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

/// The size of a usual step between two ends, a power of ten.
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
    fn a_number_is_shown_with_the_digits_that_count() {
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
    fn what_is_sorted_is_found_again() {
        let mut items = [2.5, 1.0, 2.0, 4.0];
        assert_eq!(sort_keeping(&mut items, 0, |item| *item), 2);
        assert_eq!(items, [1.0, 2.0, 2.5, 4.0]);
        items[3] = 1.5;
        assert_eq!(sort_keeping(&mut items, 3, |item| *item), 1);
        assert_eq!(items, [1.0, 1.5, 2.0, 2.5]);
    }

    #[test]
    fn a_color_is_read_as_people_write_it() {
        let rust = Some(Color32::from_rgb(0x6b, 0x3a, 0x1e));
        for text in ["#6b3a1e", "6B3A1E", " #6b3a1e "] {
            assert_eq!(color_of(text), rust);
        }
        assert_eq!(color_of("#18f"), Some(Color32::from_rgb(0x11, 0x88, 0xff)));
        for text in ["", "#", "#12345", "#1234567", "rust", "#+12345", "ééé"] {
            assert_eq!(color_of(text), None, "{text}");
        }
    }
}
