//! Variants: named settings of the panel.

use std::collections::BTreeMap;

use sabi_graph::{Edit, Value};

use crate::open_document::OpenDocument;
use crate::{instances, panel, panel_values};

/// The word for no variant, where one is chosen.
pub(crate) const NO_VARIANT: &str = "none";

/// Keeps what the panel shows now under a name, in place of what it had.
pub fn save(document: &mut OpenDocument, name: &str) -> bool {
    let name = match checked_name(name) {
        Ok(name) => name,
        Err(why) => return document.refuse(why),
    };
    let panel = panel::knobs(document);
    if panel.is_empty() {
        return document.refuse("a variant keeps the knobs of the panel, and there are none; publish some first");
    }
    let values: BTreeMap<String, Value> = panel.into_iter().map(|knob| (knob.name, knob.value)).collect();
    let edit = setting(document, &name, Some(values));
    document.edit("Save variant", vec![edit])
}

/// A variant as a text that says all of it: in which graph of the file it is, and its values.
pub fn as_text(document: &OpenDocument, name: &str) -> String {
    let values = document.graph().variants().get(name).cloned().unwrap_or_default();
    format!("variant of {:?}: {}", document.shown(), Value::Object(values).to_json())
}

/// Turns the panel as a variant has it; knobs that it does not name stay.
pub fn apply(document: &mut OpenDocument, name: &str) -> bool {
    let Some(values) = document.graph().variants().get(name).cloned() else {
        return document.refuse(format!("there is no variant '{name}'"));
    };
    let mut edits = Vec::new();
    for (knob, value) in &values {
        if let Some(why) = panel_values::why_not_set(document, knob, value) {
            return document.refuse(why);
        }
        edits.extend(panel_values::setting(document, knob, value));
    }
    document.edit("Apply variant", edits)
}

/// Gives a variant another name, in all instances that start from it.
pub fn rename(document: &mut OpenDocument, name: &str, to: &str) -> bool {
    let to = match checked_name(to) {
        Ok(to) => to,
        Err(why) => return document.refuse(why),
    };
    let Some(values) = document.graph().variants().get(name).cloned() else {
        return document.refuse(format!("there is no variant '{name}'"));
    };
    if name == to {
        return true;
    }
    if document.graph().variants().contains_key(&to) {
        return document.refuse(format!("there is a variant '{to}' already; choose another name"));
    }
    let mut edits = vec![setting(document, name, None), setting(document, &to, Some(values))];
    for (body, id, node) in instances::of_body(document.contents(), document.shown()) {
        if node.params.get("variant").and_then(Value::as_text) == Some(name) {
            edits.push(Edit::SetParam {
                body,
                node: id,
                param: "variant".to_owned(),
                value: Some(Value::Text(to.clone())),
            });
        }
    }
    document.edit("Rename variant", edits)
}

/// Removes a variant; instances that started from it start from none.
pub fn remove(document: &mut OpenDocument, name: &str) -> bool {
    if !document.graph().variants().contains_key(name) {
        return document.refuse(format!("there is no variant '{name}'"));
    }
    let edit = setting(document, name, None);
    document.edit("Remove variant", vec![edit])
}

fn checked_name(name: &str) -> Result<String, String> {
    match name.trim() {
        "" => Err("a variant needs a name".to_owned()),
        NO_VARIANT => Err(format!("'{NO_VARIANT}' stands for no variant; choose another name")),
        name => Ok(name.to_owned()),
    }
}

fn setting(document: &OpenDocument, name: &str, values: Option<BTreeMap<String, Value>>) -> Edit {
    Edit::SetVariant {
        body: document.body(),
        name: name.to_owned(),
        values,
    }
}
