//! Variants: named settings of the panel.

use std::collections::BTreeMap;

use sabi_graph::{Edit, Value};

use super::OpenDocument;

/// The word for no variant, where one is chosen.
pub(super) const NO_VARIANT: &str = "none";

impl OpenDocument {
    /// Keeps what the panel shows now under a name, in place of what it had.
    pub fn save_variant(&mut self, name: &str) -> bool {
        let name = match self.variant_name(name) {
            Ok(name) => name,
            Err(why) => return self.refuse(why),
        };
        let panel = self.panel();
        if panel.is_empty() {
            return self.refuse("a variant keeps the knobs of the panel, and there are none; publish some first");
        }
        let values: BTreeMap<String, Value> = panel.into_iter().map(|knob| (knob.name, knob.value)).collect();
        let edit = self.setting_variant(&name, Some(values));
        self.edit("Save variant", vec![edit])
    }

    /// A variant as a text that says all of it: in which graph of the file it is, and its values.
    pub fn variant_as_text(&self, name: &str) -> String {
        let values = self.graph().variants().get(name).cloned().unwrap_or_default();
        format!("variant of {:?}: {}", self.seen, Value::Object(values).to_json())
    }

    /// Turns the panel as a variant has it; knobs that it does not name stay.
    pub fn apply_variant(&mut self, name: &str) -> bool {
        let Some(values) = self.graph().variants().get(name).cloned() else {
            return self.refuse(format!("there is no variant '{name}'"));
        };
        let mut edits = Vec::new();
        for (knob, value) in &values {
            if let Some(why) = self.why_not_turn(knob, value) {
                return self.refuse(why);
            }
            edits.extend(self.turning(knob, value));
        }
        self.edit("Apply variant", edits)
    }

    /// Gives a variant another name, in all instances that start from it.
    pub fn rename_variant(&mut self, name: &str, to: &str) -> bool {
        let to = match self.variant_name(to) {
            Ok(to) => to,
            Err(why) => return self.refuse(why),
        };
        let Some(values) = self.graph().variants().get(name).cloned() else {
            return self.refuse(format!("there is no variant '{name}'"));
        };
        if name == to {
            return true;
        }
        if self.graph().variants().contains_key(&to) {
            return self.refuse(format!("there is a variant '{to}' already; choose another name"));
        }
        let mut edits = vec![
            self.setting_variant(name, None),
            self.setting_variant(&to, Some(values)),
        ];
        for (body, id, node) in self.instances_of_seen() {
            if node.params.get("variant").and_then(Value::as_text) == Some(name) {
                edits.push(Edit::SetParam {
                    body,
                    node: id,
                    param: "variant".to_owned(),
                    value: Some(Value::Text(to.clone())),
                });
            }
        }
        self.edit("Rename variant", edits)
    }

    /// Removes a variant; instances that started from it start from none.
    pub fn remove_variant(&mut self, name: &str) -> bool {
        if !self.graph().variants().contains_key(name) {
            return self.refuse(format!("there is no variant '{name}'"));
        }
        let edit = self.setting_variant(name, None);
        self.edit("Remove variant", vec![edit])
    }

    fn variant_name(&self, name: &str) -> Result<String, String> {
        match name.trim() {
            "" => Err("a variant needs a name".to_owned()),
            NO_VARIANT => Err(format!("'{NO_VARIANT}' stands for no variant; choose another name")),
            name => Ok(name.to_owned()),
        }
    }

    fn setting_variant(&self, name: &str, values: Option<BTreeMap<String, Value>>) -> Edit {
        Edit::SetVariant {
            body: self.body(),
            name: name.to_owned(),
            values,
        }
    }
}
