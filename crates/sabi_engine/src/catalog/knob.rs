//! What can be set on a node.

use sabi_graph::{PortType, Value};
use sabi_nodes::kind::{Input, InputDefault, Param, ParamType, ParamValue, Role};

/// Something that can be set: a parameter, or an input while nothing is connected to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Knob {
    /// Name in graph files.
    pub name: String,
    /// Name shown to artists.
    pub label: String,
    /// What it does.
    pub doc: String,
    /// What an artist sees and writes.
    pub role: Role,
    /// How many numbers it holds; of a curve or a gradient the most points.
    pub components: usize,
    /// Whether only whole numbers are taken.
    pub is_whole: bool,
    /// What it holds until it is set, as a file would have it.
    pub default: Value,
    /// Values outside are refused.
    pub range: Option<[f64; 2]>,
    /// Ends of the slider.
    pub soft: Option<[f64; 2]>,
    /// Whether it stands in for an input.
    pub is_of_input: bool,
}

impl Knob {
    pub(super) fn of_param(param: &Param) -> Knob {
        let ends = |ends: Option<[f32; 2]>| ends.map(|ends| ends.map(exact));
        Knob {
            name: param.name.clone(),
            label: param.label.clone(),
            doc: param.doc.clone(),
            components: match param.ty {
                ParamType::Points(most) => most as usize,
                ty => ty.components(),
            },
            is_whole: matches!(param.ty, ParamType::U32 | ParamType::I32),
            default: default_of(&param.role, &param.default),
            role: param.role.clone(),
            range: ends(param.range),
            soft: ends(param.soft),
            is_of_input: false,
        }
    }

    /// The knob that stands in for an input, where one does.
    pub(super) fn of_input(input: &Input) -> Option<Knob> {
        let InputDefault::Knob(numbers) = &input.default else {
            return None;
        };
        let role = match input.ty {
            PortType::Color => Role::Color,
            _ => Role::Plain,
        };
        let is_mask = input.ty == PortType::Mask;
        Some(Knob {
            name: input.name.clone(),
            label: input.label.clone(),
            doc: input.doc.clone(),
            components: numbers.len(),
            is_whole: false,
            default: default_of(&role, &ParamValue::Floats(numbers.clone())),
            role,
            range: None,
            // A mask is made to lie there.
            soft: is_mask.then_some([0.0, 1.0]),
            is_of_input: true,
        })
    }

    /// Ends of the slider: the soft ones, or the hard ones, or what suits the default.
    pub fn slider(&self) -> [f64; 2] {
        self.soft.or(self.range).unwrap_or_else(|| {
            let largest = self.default.as_number().unwrap_or(1.0).abs().max(0.5);
            [0.0, largest * 2.0]
        })
    }
}

/// A default as a file would have it.
fn default_of(role: &Role, value: &ParamValue) -> Value {
    match (role, value) {
        (Role::Choice(words), ParamValue::Unsigned(index)) => {
            let word = words.get(*index as usize).cloned();
            Value::Text(word.unwrap_or_default())
        }
        (Role::Toggle, ParamValue::Unsigned(on)) => Value::Bool(*on != 0),
        (Role::Color, ParamValue::Floats(rgb)) => Value::Text(hexadecimal(rgb)),
        (Role::Stops, ParamValue::Floats(stops)) => {
            let used = stops.chunks_exact(4).filter(|stop| stop[3] <= 1.0);
            let stop = |stop: &[f32]| Value::List(vec![number(stop[3]), Value::Text(hexadecimal(stop))]);
            Value::List(used.map(stop).collect())
        }
        (Role::Curve, ParamValue::Floats(points)) => {
            let used = points.chunks_exact(4).filter(|point| point[3] > 0.0);
            let point = |point: &[f32]| Value::List(vec![number(point[0]), number(point[1])]);
            Value::List(used.map(point).collect())
        }
        (_, ParamValue::Floats(numbers)) => match numbers.as_slice() {
            [one] => number(*one),
            several => Value::List(several.iter().map(|one| number(*one)).collect()),
        },
        (_, ParamValue::Unsigned(whole)) => Value::Number(f64::from(*whole)),
        (_, ParamValue::Signed(whole)) => Value::Number(f64::from(*whole)),
        (_, ParamValue::Text(text)) => Value::Text(text.clone()),
    }
}

fn number(single: f32) -> Value {
    Value::Number(exact(single))
}

/// The number that its shortest text says, so that 0.1 is shown as 0.1.
fn exact(single: f32) -> f64 {
    sabi_graph::canonical_number(f64::from(single)).unwrap_or(0.0)
}

/// Linear color as a file has it.
fn hexadecimal(rgb: &[f32]) -> String {
    let code = |at: usize| sabi_image::srgb8_from_linear(rgb.get(at).copied().unwrap_or(0.0));
    format!("#{:02x}{:02x}{:02x}", code(0), code(1), code(2))
}
