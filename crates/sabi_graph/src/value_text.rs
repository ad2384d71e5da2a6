//! Values as JSON text.

use crate::{Value, json, layout};

impl Value {
    /// Reads one JSON value, as given on a command line. Returns `None` if the text is not JSON or cannot be stored (see
    /// [`Value::canonical`]).
    pub fn from_json(text: &str) -> Option<Value> {
        json::parse(text).ok()?.into_value().canonical()
    }

    /// Returns the canonical text on one line: `[0.5, "#804020"]`.
    pub fn to_json(&self) -> String {
        layout::one_line(self)
    }
}
