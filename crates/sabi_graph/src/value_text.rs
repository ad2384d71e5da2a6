//! Values as JSON text.

use crate::{Value, json, layout};

impl Value {
    /// Reads one JSON value, as on a command line; `None` when the text is not JSON or cannot be kept (see
    /// [`Value::canonical`]).
    pub fn from_json(text: &str) -> Option<Value> {
        json::parse(text).ok()?.into_value().canonical()
    }

    /// Canonical text on one line: `[0.5, "#804020"]`.
    pub fn to_json(&self) -> String {
        layout::one_line(self)
    }
}
