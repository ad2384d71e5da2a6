//! Variants: named sets of values for published knobs.

use std::collections::BTreeMap;

use sabi_graph::{Edit, Value};

use crate::open_document::OpenDocument;
use crate::{instances, panel, panel_values};

/// Value of an instance's variant parameter that selects no variant.
pub(crate) const NO_VARIANT: &str = "none";

/// Saves the present values of the panel as a variant of this name, in place of an existing one.
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

/// Text that identifies a variant of the shown graph by that graph and the variant's values. Its name does not matter.
pub fn as_text(document: &OpenDocument, values: &BTreeMap<String, Value>) -> String {
    let values = Value::Object(values.clone()).to_json();
    format!("variant of {:?}: {values}", document.shown())
}

/// Sets the panel to the values of a variant. Knobs without a value in the variant stay.
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

/// Renames a variant, in all instances that use it too.
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

/// Removes a variant; instances that used it use none.
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
