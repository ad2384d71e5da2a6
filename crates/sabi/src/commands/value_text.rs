//! Values of parameters, and descriptions of their allowed values, in words.

use sabi_graph::Value;

/// Describes the values that a parameter accepts, in words.
pub(super) fn accepted_values(takes: &str, choices: Option<&[String]>, range: Option<&[Value; 2]>) -> String {
    let words = match choices {
        Some(choices) => choices.join(" | "),
        None => takes.to_owned(),
    };
    match range {
        Some([low, high]) => format!("{words} from {low} to {high}"),
        None => words,
    }
}

/// Returns a value as people write it: texts without quotes, `a, b` for a list.
pub(super) fn value_text(value: &Value) -> String {
    match value {
        Value::Text(text) => text.clone(),
        Value::List(items) => {
            let inside = |item: &Value| match item {
                Value::List(_) => format!("[{}]", value_text(item)),
                item => value_text(item),
            };
            items.iter().map(inside).collect::<Vec<_>>().join(", ")
        }
        other => other.to_string(),
    }
}
