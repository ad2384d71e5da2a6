//! What a node's file says for parameters and knobs, or the defaults.

use sabi_graph::{FlatNode, PortType, Value};
use sabi_nodes::kind::{InputDefault, Kind, Param, ParamType, ParamValue, Role};

use crate::error::Problem;
use crate::request::SourceKind;
use crate::values::read_param;

/// Parameter values and knobs of a node: what the file says, else the defaults.
pub(crate) fn read_values(
    kind: &Kind,
    node: &FlatNode,
    problems: &mut Vec<Problem>,
) -> (Vec<ParamValue>, Vec<Option<Vec<f32>>>) {
    let mut read = |param: &Param, value: Option<&Value>| match value {
        None => param.default.clone(),
        Some(value) => read_param(param, value).unwrap_or_else(|takes| {
            let (param, given) = (param.name.clone(), value.to_string());
            problems.push(Problem::BadValue { param, takes, given });
            ParamValue::Unsigned(0)
        }),
    };
    let written = |param: &Param| {
        let former = param.formerly.iter().find_map(|old| node.params.get(old));
        node.params.get(&param.name).or(former)
    };
    let values = kind.params.iter().map(|param| read(param, written(param))).collect();
    let knobs = kind
        .inputs
        .iter()
        .map(|input| {
            let InputDefault::Knob(start) = &input.default else {
                return None;
            };
            let knob = knob_param(&input.name, input.ty, start);
            match read(&knob, node.params.get(&input.name)) {
                ParamValue::Floats(numbers) => Some(numbers),
                _ => Some(start.clone()),
            }
        })
        .collect();
    (values, knobs)
}

/// A knob read as if it were a parameter.
fn knob_param(name: &str, ty: PortType, start: &[f32]) -> Param {
    let (memory, role) = match ty {
        PortType::Mask => (ParamType::F32, Role::Plain),
        PortType::Color => (ParamType::Vec3, Role::Color),
        PortType::Vector | PortType::Material => (ParamType::Vec3, Role::Plain),
    };
    Param {
        name: name.to_owned(),
        label: String::new(),
        doc: String::new(),
        ty: memory,
        offset: 0,
        role,
        default: ParamValue::Floats(start.to_vec()),
        range: None,
        soft: None,
        bounds_a_loop: false,
        formerly: Vec::new(),
    }
}

/// Parameters of a kind that is no shader are texts.
pub(crate) fn check_texts(kind: &SourceKind, node: &FlatNode, problems: &mut Vec<Problem>) {
    for param in kind
        .params
        .iter()
        .filter(|param| matches!(param.default, Value::Text(_)))
    {
        if let Some(value) = node.params.get(&param.name).filter(|value| value.as_text().is_none()) {
            problems.push(Problem::BadValue {
                param: param.name.clone(),
                takes: format!("a text such as {}", param.default),
                given: value.to_string(),
            });
        }
    }
}
