//! Values as one writes them on a command line.

use sabi_graph::{FlatGraph, Overrides, Value};

use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;

/// Reads `NAME=VALUE`. The value stays the text that was typed until it is known what takes it.
pub fn read_setting(text: &str) -> Result<(String, Value), String> {
    let (name, value) = text
        .split_once('=')
        .filter(|(name, _)| !name.trim().is_empty())
        .ok_or_else(|| format!("'{text}' is not of the form NAME=VALUE, as in amount=0.8 or paint.color=#6b3a1e"))?;
    Ok((name.trim().to_owned(), Value::Text(value.trim().to_owned())))
}

/// Texts among the overrides become numbers, lists and truth values, except where they reach what takes a text: a map's
/// name may be `42`, and a variant `true`.
pub(crate) fn read_typed(open: &OpenGraph, kinds: &Kinds, overrides: &Overrides) -> Overrides {
    let mut read = overrides.clone();
    for (_, value) in &mut read.set {
        if let Value::Text(text) = value {
            *value = read_value(text);
        }
    }
    for (at, (_, typed)) in overrides.set.iter().enumerate() {
        if read.set[at].1 == *typed {
            continue;
        }
        let mut as_text = read.clone();
        as_text.set[at].1 = typed.clone();
        let is_text = match (open.flatten(&read), open.flatten(&as_text)) {
            (Ok(plain), Ok(text)) => reaches_texts(&plain, &text, kinds),
            // The name of a variant, which is read while the graph is flattened.
            (plain, text) => plain.is_err() && text.is_ok(),
        };
        if is_text {
            read = as_text;
        }
    }
    read
}

/// Whether all parameters in which two readings of a graph differ take texts.
fn reaches_texts(plain: &FlatGraph, text: &FlatGraph, kinds: &Kinds) -> bool {
    let pairs = plain.nodes.iter().zip(&text.nodes);
    let mut reached = pairs
        .flat_map(|(plain, text)| {
            let names = text
                .params
                .iter()
                .filter(|(name, value)| plain.params.get(*name) != Some(value));
            names.map(|(name, _)| kinds.takes_text(&text.kind, name))
        })
        .peekable();
    reached.peek().is_some() && reached.all(|takes_text| takes_text)
}

/// A value is a number, `true` or `false`, numbers separated by commas, a JSON list, or a word.
fn read_value(text: &str) -> Value {
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
        return Value::List(numbers.into_iter().map(Value::Number).collect());
    }
    if text.starts_with('[')
        && let Ok(json) = serde_json::from_str::<serde_json::Value>(text)
        && let Some(value) = from_json(&json)
    {
        return value;
    }
    Value::Text(text.to_owned())
}

fn finite(text: &str) -> Option<f64> {
    text.parse::<f64>().ok().filter(|number| number.is_finite())
}

fn from_json(json: &serde_json::Value) -> Option<Value> {
    Some(match json {
        serde_json::Value::Bool(on) => Value::Bool(*on),
        serde_json::Value::Number(number) => Value::Number(number.as_f64()?),
        serde_json::Value::String(text) => Value::Text(text.clone()),
        serde_json::Value::Array(items) => Value::List(items.iter().map(from_json).collect::<Option<_>>()?),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use sabi_graph::Value;

    use super::{read_setting, read_value};

    #[test]
    fn a_setting_is_split_at_its_first_sign() {
        let text = |text: &str| Value::Text(text.into());
        assert_eq!(read_setting("name=a=b"), Ok(("name".into(), text("a=b"))));
        assert_eq!(read_setting(" amount = 0.80 "), Ok(("amount".into(), text("0.80"))));
        assert!(read_setting("amount").is_err() && read_setting("=1").is_err());
    }

    #[test]
    fn a_value_is_read_as_what_it_looks_like() {
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
            assert_eq!(read_value(text), value, "{text}");
        }
    }
}
