//! Values of parameters as stored in graph files and as seen by artists.

use sabi_color::linear_from_srgb8;
use sabi_graph::Value;

use super::{Memory, ParamValue, Role};
use crate::color::{color_code, color_srgb8};
use crate::curve::curve_points;

/// Position of an unused gradient stop.
pub(crate) const UNUSED_STOP: f32 = 2.0;

/// A parameter's value as an artist sees it: angles in degrees, colors in sRGB.
#[derive(Clone, Debug, PartialEq)]
pub enum WrittenValue<'v> {
    /// Numbers, one for each component of the parameter.
    Numbers(Vec<f64>),
    /// On or off.
    Toggle(bool),
    /// A text, a path, or the word of a choice.
    Text(&'v str),
    /// sRGB.
    Color([u8; 3]),
    /// Gradient stops in ascending order.
    Stops(Vec<WrittenStop>),
    /// Points of a curve by ascending x. Two points with the same x form a step.
    Points(Vec<[f64; 2]>),
}

/// A color at a position of a gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenStop {
    /// 0 to 1.
    pub position: f64,
    /// sRGB.
    pub color: [u8; 3],
}

impl<'v> WrittenValue<'v> {
    /// Reads a value of a parameter; `None` if it does not have the right form. Ranges are not checked.
    pub(super) fn read(role: &Role, memory: Memory, value: &'v Value) -> Option<WrittenValue<'v>> {
        match role {
            Role::Toggle => value.as_bool().map(WrittenValue::Toggle),
            Role::Choice(words) => {
                let word = value.as_text()?;
                words
                    .iter()
                    .any(|known| known == word)
                    .then_some(WrittenValue::Text(word))
            }
            Role::Text | Role::File => value.as_text().map(WrittenValue::Text),
            Role::Color => color_srgb8(value.as_text()?).map(WrittenValue::Color),
            Role::Stops => stops(value.as_list()?, memory.entries()).map(WrittenValue::Stops),
            Role::Curve => points(value.as_list()?, memory.entries()).map(WrittenValue::Points),
            Role::Plain | Role::Length | Role::Angle | Role::Seed => numbers(memory, value).map(WrittenValue::Numbers),
            Role::Extent { .. } => None,
        }
    }

    /// Returns the components of this value in the memory of a parameter; `None` for numbers that do not fit there.
    pub(super) fn components(&self, role: &Role, memory: Memory) -> Option<ParamValue> {
        Some(match (self, role, memory) {
            (WrittenValue::Toggle(on), ..) => ParamValue::Unsigned(u32::from(*on)),
            (WrittenValue::Text(word), Role::Choice(words), _) => {
                let index = words.iter().position(|known| known == word)?;
                ParamValue::Unsigned(index as u32)
            }
            (WrittenValue::Text(text), ..) => ParamValue::Text((*text).to_owned()),
            (WrittenValue::Color(color), ..) => ParamValue::Floats(linear_from_srgb8(*color).to_vec()),
            (WrittenValue::Stops(stops), ..) => ParamValue::Floats(stop_components(stops, memory.entries())),
            (WrittenValue::Points(points), ..) => {
                let points: Vec<[f32; 2]> = points.iter().map(|point| point.map(|number| number as f32)).collect();
                ParamValue::Floats(curve_points(&points, memory.entries()))
            }
            (WrittenValue::Numbers(numbers), _, Memory::U32) => ParamValue::Unsigned(single_whole(numbers)?),
            (WrittenValue::Numbers(numbers), _, Memory::I32) => ParamValue::Signed(single_whole(numbers)?),
            (WrittenValue::Numbers(numbers), ..) => {
                let floats: Vec<f32> = numbers.iter().map(|number| *number as f32).collect();
                let are_finite = floats.iter().all(|number| number.is_finite());
                are_finite.then_some(ParamValue::Floats(floats))?
            }
        })
    }

    /// Returns this value as stored in graph files.
    pub fn to_value(&self) -> Value {
        match self {
            WrittenValue::Numbers(numbers) => match numbers.as_slice() {
                [number] => Value::Number(*number),
                several => several.to_vec().into(),
            },
            WrittenValue::Toggle(on) => Value::Bool(*on),
            WrittenValue::Text(text) => Value::Text((*text).to_owned()),
            WrittenValue::Color(color) => Value::Text(color_code(*color)),
            WrittenValue::Stops(stops) => {
                let stop = |stop: &WrittenStop| {
                    Value::List(vec![Value::Number(stop.position), Value::Text(color_code(stop.color))])
                };
                Value::List(stops.iter().map(stop).collect())
            }
            WrittenValue::Points(points) => points.iter().map(|point| point.to_vec()).collect::<Vec<_>>().into(),
        }
    }
}

fn numbers(memory: Memory, value: &Value) -> Option<Vec<f64>> {
    let given = match value {
        Value::List(items) if memory.entries() > 1 => items.as_slice(),
        single if memory.entries() == 1 => std::slice::from_ref(single),
        _ => return None,
    };
    let numbers: Vec<f64> = given.iter().map(Value::as_number).collect::<Option<_>>()?;
    let are_whole = !memory.is_whole() || numbers.iter().all(|number| number.fract() == 0.0);
    (numbers.len() == memory.entries() && are_whole).then_some(numbers)
}

fn stops(items: &[Value], room: usize) -> Option<Vec<WrittenStop>> {
    let stop = |item: &Value| match item.as_list()? {
        [position, code] => Some(WrittenStop {
            position: position.as_number().filter(|at| (0.0..=1.0).contains(at))?,
            color: color_srgb8(code.as_text()?)?,
        }),
        _ => None,
    };
    let mut stops: Vec<WrittenStop> = items.iter().map(stop).collect::<Option<_>>()?;
    stops.sort_by(|left, right| left.position.total_cmp(&right.position));
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

fn stop_components(stops: &[WrittenStop], room: usize) -> Vec<f32> {
    let used = stops.iter().map(|stop| {
        let [r, g, b] = linear_from_srgb8(stop.color);
        [r, g, b, stop.position as f32]
    });
    let mut components: Vec<[f32; 4]> = used.collect();
    components.resize(room, [0.0, 0.0, 0.0, UNUSED_STOP]);
    components.into_flattened()
}

/// Returns the number in a list of one number, if a 32-bit whole number can hold it.
fn single_whole<T: TryFrom<i64>>(numbers: &[f64]) -> Option<T> {
    match numbers {
        // An `f64` holds all whole numbers of 32 bits exactly.
        [number] if number.fract() == 0.0 && number.abs() <= f64::from(u32::MAX) => T::try_from(*number as i64).ok(),
        _ => None,
    }
}
