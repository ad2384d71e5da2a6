//! Values of a node's parameters and knobs: those in its file, otherwise the defaults.

use sabi_graph::{Fit, FlatNode, Value};
use sabi_nodes::kind::{Input, InputDefault, Kind, Param, ParamType, ParamValue};

use crate::error::Problem;
use crate::request::Planner;

/// Returns the parameter values of a node, in the units of artists. An invalid value is added to the problems, because of
/// which the node is refused.
pub(crate) fn read_params(params: &[Param], node: &FlatNode, problems: &mut Vec<Problem>) -> Vec<ParamValue> {
    let mut value = |param: &Param| {
        let former = param.formerly.iter().find_map(|old| node.params.get(old));
        let written = node.params.get(&param.name).or(former);
        let read = written.and_then(|written| read(&param.name, &param.ty, written, problems));
        read.unwrap_or_else(|| param.default.clone()) // The default is used if the file has no value, or if the value is already reported as a problem.
    };
    params.iter().map(&mut value).collect()
}

impl Planner<'_> {
    /// Returns the factor from the node's lengths to working units, for lengths that are shares of the model even under the fit of pieces.
    pub(crate) fn working_from_absolute(&self, node: &FlatNode) -> f64 {
        let fit = match node.fit {
            Fit::Piece => Fit::Unit,
            other => other,
        };
        node.length_scale * (self.lengths.working_from)(&fit)
    }

    /// Problem of the file that a node names.
    pub(crate) fn file_fault(&self, node: usize) -> Option<Problem> {
        let fault = self.files.get(&node)?.as_ref().err()?;
        Some(Problem::BadFile(fault.clone()))
    }
}

/// Values of a node's knobs by input; `None` for an input that has no knob.
pub(crate) fn read_knobs(kind: &Kind, node: &FlatNode, problems: &mut Vec<Problem>) -> Vec<Option<Vec<f32>>> {
    let mut value = |input: &Input| {
        let InputDefault::Knob(default) = &input.default else {
            return None;
        };
        let read = match (input.knob(), node.params.get(&input.name)) {
            (Some(ty), Some(written)) => read(&input.name, &ty, written, problems),
            _ => None,
        };
        match read {
            Some(ParamValue::Floats(numbers)) => Some(numbers),
            _ => Some(default.clone()), // The default is used if the file has no value, or if the value is already reported as a problem.
        }
    };
    kind.inputs.iter().map(&mut value).collect()
}

fn read(name: &str, ty: &ParamType, value: &Value, problems: &mut Vec<Problem>) -> Option<ParamValue> {
    let read = ty.read(value);
    let problem = |expected| Problem::BadValue {
        param: name.to_owned(),
        expected,
        found: format!("{value}{}", value.decimal_comma_advice()),
    };
    read.map_err(|expected| problems.push(problem(expected))).ok()
}
