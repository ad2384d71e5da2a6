//! What a node's file says for parameters and knobs, or the defaults.

use sabi_graph::{FlatNode, PortType, Value};
use sabi_nodes::kind::{Input, InputDefault, Kind, Param, ParamType, ParamValue, Role};

use crate::error::Problem;
use crate::request::Planner;
use crate::values::read_param;

/// Parameter values of a node, in artist's units: what the file says, else the defaults.
pub(crate) fn read_params(params: &[Param], node: &FlatNode, problems: &mut Vec<Problem>) -> Vec<ParamValue> {
    let written = |param: &Param| {
        let former = param.formerly.iter().find_map(|old| node.params.get(old));
        node.params.get(&param.name).or(former)
    };
    let values = params.iter().map(|param| read(param, written(param), problems));
    values.collect()
}

impl Planner<'_> {
    /// What is wrong with the file that a node names.
    pub(crate) fn file_fault(&self, node: usize) -> Option<Problem> {
        let fault = self.files.get(&node)?.as_ref().err()?;
        Some(Problem::BadFile(fault.clone()))
    }
}

/// Values of a node's knobs by input; none where an input is no knob.
pub(crate) fn read_knobs(kind: &Kind, node: &FlatNode, problems: &mut Vec<Problem>) -> Vec<Option<Vec<f32>>> {
    let mut knob = |input: &Input| {
        let InputDefault::Knob(start) = &input.default else {
            return None;
        };
        let knob = knob_param(&input.name, input.ty, start);
        match read(&knob, node.params.get(&input.name), problems) {
            ParamValue::Floats(numbers) => Some(numbers),
            _ => Some(start.clone()),
        }
    };
    kind.inputs.iter().map(&mut knob).collect()
}

fn read(param: &Param, value: Option<&Value>, problems: &mut Vec<Problem>) -> ParamValue {
    let Some(value) = value else {
        return param.default.clone();
    };
    read_param(param, value).unwrap_or_else(|takes| {
        let (param, given) = (param.name.clone(), value.to_string());
        problems.push(Problem::BadValue { param, takes, given });
        ParamValue::Unsigned(0)
    })
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
