//! Types of parameters: the values that they take, and how these are read, written and described.
//!
//! A graph file is read without knowledge of its kinds, so its values are checked by [`ParamType::read`] when the graph is planned. The
//! editor checks typed and pasted texts by [`ParamType::parse`], and keeps numbers that are dragged within [`ParamType::limits`].

#[cfg(test)]
mod tests;

use sabi_color::srgb8_from_linear;
use sabi_graph::{Value, canonical_number};

use super::written_value::UNUSED_STOP;
use super::{Memory, ParamValue, Role, WrittenStop, WrittenValue};
use crate::color::typed_color;

/// Type of a parameter's values, shared by the planner, the catalog, the command line and the editor.
#[derive(Clone, Debug, PartialEq)]
pub struct ParamType {
    /// Meaning of the parameter to an artist.
    pub role: Role,
    /// Shape in memory.
    pub memory: Memory,
    /// Lowest and highest accepted number, in the units of artists.
    pub range: Option<[f64; 2]>,
    /// Ends of the slider, in the units of artists.
    pub soft: Option<[f64; 2]>,
    /// Value until the parameter is set, as stored in graph files.
    pub default: Value,
}

impl ParamType {
    /// Creates a type without a range. Its default has these components.
    pub fn new(role: Role, memory: Memory, default: &ParamValue) -> ParamType {
        ParamType {
            default: write(&role, default),
            role,
            memory,
            range: None,
            soft: None,
        }
    }

    /// Returns the number of components, or the maximum number of points of a curve or gradient.
    pub fn components(&self) -> usize {
        self.memory.entries()
    }

    /// Returns true if only whole numbers are accepted.
    pub fn is_whole(&self) -> bool {
        self.memory.is_whole()
    }

    /// Returns the lowest and the highest accepted number, in the units of artists: the range, or all numbers of an unsigned type.
    pub fn limits(&self) -> Option<[f64; 2]> {
        let unsigned = (self.memory == Memory::U32).then_some([0.0, f64::from(u32::MAX)]);
        self.range.or(unsigned)
    }

    /// Returns the accepted number nearest to `number`: within the limits, and whole if only whole numbers are accepted.
    pub fn nearest(&self, number: f64) -> f64 {
        let number = if self.is_whole() { number.round() } else { number };
        match self.limits() {
            Some([low, high]) => number.max(low).min(high),
            None => number,
        }
    }

    /// Returns true if files store the values as texts.
    pub fn is_text(&self) -> bool {
        matches!(self.role, Role::Text | Role::File | Role::Choice(_) | Role::Color)
    }

    /// Returns the ends of the slider: the soft ends, or the range, or an interval that suits the default.
    pub fn slider(&self) -> [f64; 2] {
        self.soft.or(self.range).unwrap_or_else(|| {
            // Only single numbers have a slider.
            let largest = self.default.as_number().unwrap_or(1.0).abs().max(0.5);
            [0.0, largest * 2.0]
        })
    }

    /// Returns a value as artists see it; `None` if it does not have the right form. Ranges are not checked.
    pub fn written<'v>(&self, value: &'v Value) -> Option<WrittenValue<'v>> {
        WrittenValue::read(&self.role, self.memory, value)
    }

    /// Reads a value of a graph file. The error is the text of [`ParamType::expectation`].
    pub fn read(&self, value: &Value) -> Result<ParamValue, String> {
        let read = self
            .written(value)
            .and_then(|written| written.components(&self.role, self.memory));
        read.filter(|components| self.is_in_range(components))
            .ok_or_else(|| self.expectation())
    }

    /// Returns true if a value has the right form and lies within the range.
    pub fn takes(&self, value: &Value) -> bool {
        self.read(value).is_ok()
    }

    /// Reads a value as users type it: `on`, `0, 1, 0`, `6b3a1e`, a word of a choice, lists as JSON. The error is the text
    /// of [`ParamType::expectation`].
    pub fn parse(&self, text: &str) -> Result<Value, String> {
        let text = text.trim();
        let value = match self.role {
            Role::Toggle => toggle(text).map(Value::Bool),
            Role::Choice(_) | Role::Text | Role::File => Some(Value::Text(text.to_owned())),
            Role::Color => typed_color(text).map(|color| WrittenValue::Color(color).to_value()),
            Role::Plain | Role::Length | Role::Angle | Role::Seed if !text.starts_with('[') => {
                let numbers: Option<Vec<f64>> = text.split(',').map(|part| finite(part.trim())).collect();
                numbers.map(|numbers| WrittenValue::Numbers(numbers).to_value())
            }
            _ => Value::from_json(text),
        };
        value
            .filter(|value| self.takes(value))
            .ok_or_else(|| self.expectation())
    }

    /// Describes the accepted values, worded to follow "takes": `a number from 0 to 1`.
    pub fn expectation(&self) -> String {
        let between = match self.limits() {
            Some([low, high]) => format!(" from {low} to {high}"),
            None => String::new(),
        };
        let room = self.components();
        match (&self.role, self.memory) {
            (Role::Toggle, _) => "true or false".to_owned(),
            (Role::Choice(words), _) => format!("one of {}", words.join(", ")),
            (Role::Color, _) => "a color such as \"#6b3a1e\"".to_owned(),
            (Role::Stops, _) => {
                format!("a list of 1 to {room} stops such as [0.5, \"#6b3a1e\"], positions from 0 to 1")
            }
            (Role::Curve, _) => format!("a list of 1 to {room} points such as [0.5, 0.8], both numbers{between}"),
            (Role::Extent { .. }, _) => "no value: it is measured on the model".to_owned(),
            (Role::Text, _) => match &self.default {
                Value::Text(text) if !text.is_empty() => format!("a text such as {text:?}"),
                _ => "a text".to_owned(),
            },
            (Role::File, _) => "the path of a file, as a text".to_owned(),
            (Role::Angle, Memory::F32) => format!("an angle in degrees{between}"),
            (_, Memory::U32 | Memory::I32) => format!("a whole number{between}"),
            (_, Memory::F32) => format!("a number{between}"),
            _ => format!("a list of {room} numbers{between}"),
        }
    }

    /// Returns true if all numbers of a value lie in the range. For a curve, only the coordinates of the points are checked.
    pub(crate) fn is_in_range(&self, value: &ParamValue) -> bool {
        let Some([low, high]) = self.range else { return true };
        let is_inside = |number: f64| (low..=high).contains(&number);
        match value {
            // Numbers are compared as `f32`, so that 0.3 in a file equals the end of a range to 0.3.
            ParamValue::Floats(numbers) => {
                let range = low as f32..=high as f32;
                let is_curve = self.role == Role::Curve;
                let counted = numbers.iter().enumerate().filter(|(at, _)| !is_curve || at % 4 < 2);
                counted.map(|(_, number)| number).all(|number| range.contains(number))
            }
            ParamValue::Unsigned(number) => is_inside(f64::from(*number)),
            ParamValue::Signed(number) => is_inside(f64::from(*number)),
            ParamValue::Text(_) => true,
        }
    }
}

/// Converts components to a value as a graph file holds it.
fn write(role: &Role, value: &ParamValue) -> Value {
    match (role, value) {
        (Role::Choice(words), ParamValue::Unsigned(index)) => match words.get(*index as usize) {
            Some(word) => WrittenValue::Text(word).to_value(),
            // No kind has such a default; writing the index makes the mistake visible.
            None => Value::Number(f64::from(*index)),
        },
        (Role::Toggle, ParamValue::Unsigned(on)) => Value::Bool(*on != 0),
        (Role::Color, ParamValue::Floats(floats)) => match floats.as_slice() {
            [r, g, b] => WrittenValue::Color([*r, *g, *b].map(srgb8_from_linear)).to_value(),
            floats => numbers(floats).to_value(),
        },
        (Role::Stops, ParamValue::Floats(floats)) => {
            let (stops, _) = floats.as_chunks::<4>();
            let used = stops.iter().filter(|[.., position]| *position < UNUSED_STOP);
            let stop = |[r, g, b, position]: &[f32; 4]| WrittenStop {
                position: shortest_decimal(*position),
                color: [*r, *g, *b].map(srgb8_from_linear),
            };
            WrittenValue::Stops(used.map(stop).collect()).to_value()
        }
        (Role::Curve, ParamValue::Floats(floats)) => {
            let (points, _) = floats.as_chunks::<4>();
            let used = points.iter().filter(|[.., is_used]| *is_used > 0.0);
            WrittenValue::Points(
                used.map(|[x, y, ..]| [shortest_decimal(*x), shortest_decimal(*y)])
                    .collect(),
            )
            .to_value()
        }
        (_, ParamValue::Floats(floats)) => numbers(floats).to_value(),
        (_, ParamValue::Unsigned(whole)) => Value::Number(f64::from(*whole)),
        (_, ParamValue::Signed(whole)) => Value::Number(f64::from(*whole)),
        (_, ParamValue::Text(text)) => WrittenValue::Text(text).to_value(),
    }
}

fn numbers(floats: &[f32]) -> WrittenValue<'static> {
    WrittenValue::Numbers(floats.iter().copied().map(shortest_decimal).collect())
}

/// Returns the number of a float's shortest decimal text, so that 0.1 is shown as 0.1.
pub(crate) fn shortest_decimal(float: f32) -> f64 {
    canonical_number(f64::from(float)).unwrap_or(f64::from(float)) // Only infinities and NaN have no canonical form.
}

fn toggle(text: &str) -> Option<bool> {
    match text {
        "true" | "on" => Some(true),
        "false" | "off" => Some(false),
        _ => None,
    }
}

fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}
