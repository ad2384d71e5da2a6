//! Values set from outside, as `NAME=VALUE` on the command line.

use std::error::Error as _;

use sabi_graph::{FlatGraph, FlattenError, Overrides, Value};
use sabi_nodes::kind::ParamType;

use crate::error::EngineError;
use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;

/// Reads `NAME=VALUE`. The value stays a text until the parameter that it sets is known.
pub fn read_setting(text: &str) -> Result<(String, Value), String> {
    let (name, value) = text
        .split_once('=')
        .filter(|(name, _)| !name.trim().is_empty())
        .ok_or_else(|| format!("'{text}' is not of the form NAME=VALUE, as in amount=0.8 or paint.color=#6b3a1e"))?;
    Ok((name.trim().to_owned(), Value::Text(value.trim().to_owned())))
}

/// Parses the texts of overrides by the types of the parameters that they set: the name of a map may be `42`, and a color
/// `111111`. A text that sets no known parameter is parsed by its form, so that messages show the intended value.
pub(crate) fn read_typed(open: &OpenGraph, kinds: &Kinds, overrides: &Overrides) -> Overrides {
    let mut read = overrides.clone();
    for (_, value) in &mut read.set {
        if let Value::Text(text) = value {
            *value = likely_value(text);
        }
    }
    for (at, (_, typed)) in overrides.set.iter().enumerate() {
        if let Value::Text(text) = typed {
            let with = |value: Value| {
                let mut changed = read.clone();
                changed.set[at].1 = value;
                open.flatten(&changed)
            };
            // Flattening does not check values of parameters. Therefore the parameters that are set are those that differ
            // between two probes.
            let has_comma = !typed.decimal_comma_advice().is_empty();
            let value = match (with(Value::Bool(false)), with(Value::Bool(true))) {
                (Ok(off), Ok(on)) => {
                    let types = changed_params(&off, &on, kinds);
                    parsed(&types, text).or_else(|| (has_comma && are_lone_numbers(&types)).then(|| typed.clone()))
                }
                // A number with a decimal comma stays a text for a knob of one number, so that the message shows it.
                (Err(error), _) if has_comma => {
                    let ends = range_of(&error).map(|range| range.map(|end| with(Value::Number(end))));
                    let types = match &ends {
                        Some([Ok(low), Ok(high)]) => changed_params(low, high, kinds),
                        _ => Vec::new(),
                    };
                    are_lone_numbers(&types).then(|| typed.clone())
                }
                // It sets a knob with a range or a knob of a group instance. If it is the name of a variant, it stays a text.
                _ => (with(likely_value(text)).is_err() && with(typed.clone()).is_ok()).then(|| typed.clone()),
            };
            if let Some(value) = value {
                read.set[at].1 = value;
            }
        }
    }
    read
}

/// Types of the parameters in which two flat graphs differ.
fn changed_params(off: &FlatGraph, on: &FlatGraph, kinds: &Kinds) -> Vec<ParamType> {
    let pairs = off.nodes.iter().zip(&on.nodes);
    let types = pairs.flat_map(|(off, on)| {
        let params = on.params.iter();
        let set = params.filter(|(name, value)| off.params.get(*name) != Some(value));
        set.filter_map(|(name, _)| kinds.param_type(&on.kind, name))
    });
    types.collect()
}

/// Returns the range of a knob that refused a value of another type.
fn range_of(error: &EngineError) -> Option<[f64; 2]> {
    match error.source()?.downcast_ref()? {
        FlattenError::NotANumber { low, high, .. } => Some([low.parse().ok()?, high.parse().ok()?]),
        _ => None,
    }
}

/// Returns true if there are parameters and each takes a single number.
fn are_lone_numbers(types: &[ParamType]) -> bool {
    !types.is_empty() && types.iter().all(|ty| ty.components() == 1 && !ty.is_text())
}

/// Parses a text as a value that all these parameters accept; `None` if there is no such value.
fn parsed(types: &[ParamType], text: &str) -> Option<Value> {
    let value = types.first()?.parse(text).ok();
    let value = value.filter(|value| types.iter().all(|ty| ty.takes(value)));
    let are_texts = types.iter().all(ParamType::is_text);
    value.or_else(|| are_texts.then(|| Value::from(text)))
}

/// Guesses the value of a text by its form: a number, a Boolean, numbers separated by commas, a JSON list or a word.
fn likely_value(text: &str) -> Value {
    match text {
        "true" | "on" => return Value::Bool(true),
        "false" | "off" => return Value::Bool(false),
        _ => {}
    }
    if let Some(number) = finite(text) {
        return Value::Number(number);
    }
    let parts: Option<Vec<f64>> = text.split(',').map(|part| finite(part.trim())).collect();
    if let Some(numbers) = parts {
        return numbers.into();
    }
    let list = text.starts_with('[').then(|| Value::from_json(text)).flatten();
    list.unwrap_or_else(|| Value::from(text)) // Anything else is a word.
}

fn finite(text: &str) -> Option<f64> {
    text.parse::<f64>().ok().filter(|number| number.is_finite())
}

#[cfg(test)]
mod tests {
    use sabi_graph::Value;

    use super::{likely_value, read_setting};

    #[test]
    fn a_setting_is_split_at_its_first_sign() {
        let text = |text: &str| Value::Text(text.into());
        assert_eq!(read_setting("name=a=b"), Ok(("name".into(), text("a=b"))));
        assert_eq!(read_setting(" amount = 0.80 "), Ok(("amount".into(), text("0.80"))));
        assert!(read_setting("amount").is_err() && read_setting("=1").is_err());
    }

    #[test]
    fn a_value_for_an_unknown_name_is_parsed_by_its_form() {
        let cases = [
            ("0.8", Value::Number(0.8)),
            ("true", Value::Bool(true)),
            ("#6b3a1e", Value::Text("#6b3a1e".into())),
            ("0,1,0", Value::List([0.0, 1.0, 0.0].map(Value::Number).to_vec())),
            (
                "[[0, 0.2], [1, 1]]",
                Value::List(
                    [[0.0, 0.2], [1.0, 1.0]]
                        .map(|point| Value::List(point.map(Value::Number).to_vec()))
                        .to_vec(),
                ),
            ),
            ("add", Value::Text("add".into())),
        ];
        for (text, value) in cases {
            assert_eq!(likely_value(text), value, "{text}");
        }
    }
}
