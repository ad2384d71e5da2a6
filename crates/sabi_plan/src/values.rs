//! Values of a graph file become the bytes that a node's WGSL reads.

use sabi_graph::Value;
use sabi_nodes::kind::{Kind, Param, ParamType, ParamValue, Role};
use sabi_nodes::{color_linear, curve_points};

/// Reads a value as written in a file for a parameter, in artist's units.
///
/// The error says what the parameter takes, to follow "takes".
pub fn read_param(param: &Param, value: &Value) -> Result<ParamValue, String> {
    let read = match (&param.role, value) {
        (Role::Toggle, Value::Bool(on)) => Some(ParamValue::Unsigned(u32::from(*on))),
        (Role::Choice(words), Value::Text(word)) => words
            .iter()
            .position(|known| known == word)
            .map(|index| ParamValue::Unsigned(index as u32)),
        (Role::Color, Value::Text(text)) => color_linear(text).map(|rgb| ParamValue::Floats(rgb.to_vec())),
        (Role::Stops, Value::List(stops)) => read_stops(param.ty, stops),
        (Role::Curve, Value::List(points)) => read_curve(param.ty, points),
        (Role::Text | Role::File, Value::Text(text)) => Some(ParamValue::Text(text.clone())),
        (
            Role::Toggle | Role::Choice(_) | Role::Stops | Role::Curve | Role::Extent { .. } | Role::Text | Role::File,
            _,
        ) => None,
        (_, value) => read_numbers(param.ty, value),
    };
    match read {
        Some(value) if in_range(param, &value) => Ok(value),
        _ => Err(takes(param)),
    }
}

fn read_numbers(ty: ParamType, value: &Value) -> Option<ParamValue> {
    match (ty, value) {
        (ParamType::U32, Value::Number(number)) => (number.fract() == 0.0
            && (0.0..=f64::from(u32::MAX)).contains(number))
        .then_some(ParamValue::Unsigned(*number as u32)),
        (ParamType::I32, Value::Number(number)) => (number.fract() == 0.0
            && (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(number))
        .then_some(ParamValue::Signed(*number as i32)),
        (ParamType::F32, Value::Number(number)) => Some(ParamValue::Floats(vec![*number as f32])),
        (ParamType::Vec2 | ParamType::Vec3 | ParamType::Vec4, Value::List(items)) => {
            let numbers: Option<Vec<f32>> = items.iter().map(|item| item.as_number().map(|n| n as f32)).collect();
            numbers
                .filter(|numbers| numbers.len() == ty.components())
                .map(ParamValue::Floats)
        }
        _ => None,
    }
}

fn read_stops(ty: ParamType, stops: &[Value]) -> Option<ParamValue> {
    let room = ty.components() / 4;
    if stops.is_empty() || stops.len() > room {
        return None;
    }
    let mut read: Vec<[f32; 4]> = Vec::with_capacity(room);
    for stop in stops {
        let Value::List(pair) = stop else { return None };
        let [Value::Number(position), Value::Text(text)] = pair.as_slice() else {
            return None;
        };
        let [r, g, b] = color_linear(text)?;
        if !(0.0..=1.0).contains(position) {
            return None;
        }
        read.push([r, g, b, *position as f32]);
    }
    read.sort_by(|a, b| a[3].total_cmp(&b[3]));
    read.resize(room, [0.0, 0.0, 0.0, 2.0]);
    Some(ParamValue::Floats(read.into_flattened()))
}

fn read_curve(ty: ParamType, points: &[Value]) -> Option<ParamValue> {
    let room = ty.components() / 4;
    if points.is_empty() || points.len() > room {
        return None;
    }
    let mut read: Vec<[f32; 2]> = Vec::with_capacity(room);
    for point in points {
        let Value::List(pair) = point else { return None };
        let [Value::Number(x), Value::Number(y)] = pair.as_slice() else {
            return None;
        };
        read.push([*x as f32, *y as f32]);
    }
    // Two points at one place make a step, from the first of them to the second.
    read.sort_by(|left, right| left[0].total_cmp(&right[0]));
    Some(ParamValue::Floats(curve_points(&read, room)))
}

fn in_range(param: &Param, value: &ParamValue) -> bool {
    let Some([low, high]) = param.range else { return true };
    match value {
        ParamValue::Floats(numbers) => param.role.ranged(numbers).all(|number| (low..=high).contains(&number)),
        ParamValue::Unsigned(number) => (f64::from(low)..=f64::from(high)).contains(&f64::from(*number)),
        ParamValue::Signed(number) => (f64::from(low)..=f64::from(high)).contains(&f64::from(*number)),
        ParamValue::Text(_) => true,
    }
}

fn takes(param: &Param) -> String {
    let between = param
        .range
        .map_or(String::new(), |[low, high]| format!(" from {low} to {high}"));
    match (&param.role, param.ty) {
        (Role::Toggle, _) => "true or false".to_owned(),
        (Role::Choice(words), _) => format!("one of {}", words.join(", ")),
        (Role::Color, _) => "a color such as \"#6b3a1e\"".to_owned(),
        (Role::Stops, ty) => {
            format!(
                "a list of 1 to {} stops such as [0.5, \"#6b3a1e\"], positions from 0 to 1",
                ty.components() / 4
            )
        }
        (Role::Curve, ty) => {
            let room = ty.components() / 4;
            format!("a list of 1 to {room} points such as [0.5, 0.8], both numbers{between}")
        }
        (Role::Extent { .. }, _) => "no value: it is measured on the model".to_owned(),
        (Role::Text, _) => match &param.default {
            ParamValue::Text(text) if !text.is_empty() => format!("a text such as {text:?}"),
            _ => "a text".to_owned(),
        },
        (Role::File, _) => "the path of a file, as a text".to_owned(),
        (Role::Angle, ParamType::F32) => format!("an angle in degrees{between}"),
        (_, ParamType::U32) if param.range.is_none() => format!("a whole number from 0 to {}", u32::MAX),
        (_, ParamType::U32 | ParamType::I32) => format!("a whole number{between}"),
        (_, ParamType::F32) => format!("a number{between}"),
        (_, ty) => format!("a list of {} numbers{between}", ty.components()),
    }
}

/// What the bytes of a node depend on besides its own values.
pub struct Packing<'a> {
    /// Seeds of the document and the groups around, outermost first.
    pub(crate) seeds: &'a [u32],
    /// Factor from the lengths as written to working units.
    pub(crate) working_from_length: f64,
    /// Lowest and highest `dot(vertex, direction)`.
    pub(crate) extent: &'a dyn Fn([f32; 3]) -> [f32; 2],
}

impl Packing<'_> {
    /// Factor from artist's units to those of kernels.
    pub(crate) fn factor(&self, role: &Role) -> f64 {
        match role {
            Role::Angle => std::f64::consts::PI / 180.0,
            Role::Length => self.working_from_length,
            _ => 1.0,
        }
    }
}

/// The bytes of `struct Params`: angles in radians, lengths in working units, seeds hashed.
///
/// `values` has one entry for each of the kind's parameters, in artist's units.
pub fn pack_params(kind: &Kind, values: &[ParamValue], packing: &Packing<'_>) -> Vec<u8> {
    let mut bytes = vec![0_u8; kind.params_size as usize];
    for (param, value) in kind.params.iter().zip(values) {
        let words: Vec<[u8; 4]> = match (&param.role, value) {
            (Role::Extent { along, high }, _) => {
                let extent = (packing.extent)(direction(kind, values, along));
                vec![extent[usize::from(*high)].to_le_bytes()]
            }
            (Role::Seed, ParamValue::Unsigned(seed)) => {
                vec![crate::seeds::effective(packing.seeds, *seed).to_le_bytes()]
            }
            (role, ParamValue::Floats(numbers)) => {
                let factor = packing.factor(role);
                numbers
                    .iter()
                    .map(|number| ((f64::from(*number) * factor) as f32).to_le_bytes())
                    .collect()
            }
            (_, ParamValue::Unsigned(number)) => vec![number.to_le_bytes()],
            (_, ParamValue::Signed(number)) => vec![number.to_le_bytes()],
            (_, ParamValue::Text(_)) => Vec::new(),
        };
        for (index, word) in words.iter().enumerate() {
            let at = param.offset as usize + 4 * index;
            if let Some(place) = bytes.get_mut(at..at + 4) {
                place.copy_from_slice(word);
            }
        }
    }
    bytes
}

/// The value of a direction parameter, unit length; straight up when it has no length.
fn direction(kind: &Kind, values: &[ParamValue], name: &str) -> [f32; 3] {
    let value = kind.params.iter().zip(values).find(|(param, _)| param.name == name);
    if let Some((_, ParamValue::Floats(numbers))) = value
        && let [x, y, z] = numbers[..]
    {
        let length = (x * x + y * y + z * z).sqrt();
        if length > 1e-12 {
            return [x / length, y / length, z / length];
        }
    }
    [0.0, 1.0, 0.0]
}
