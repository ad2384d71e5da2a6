//! Numbers as the JSON of a glTF file has them.

use serde_json::{Value as Json, json};

pub(super) fn numbers(values: &[f32]) -> Json {
    values.iter().map(|value| short(*value)).collect()
}

/// A number as short as an f32 can be written.
pub(super) fn short(value: f32) -> Json {
    let exact = value.to_string().parse::<f64>();
    exact.map_or(Json::Null, |exact| json!(exact))
}
