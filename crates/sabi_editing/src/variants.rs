//! Variants: named sets of values for exposed knobs, one of which is shown and edited.

use std::collections::BTreeMap;

use sabi_engine::OpenGraph;
use sabi_graph::{Body, Edit, NodeId, Value};

use crate::document_settings::changed_preview;
use crate::open_document::OpenDocument;
use crate::{exposed_knobs, exposed_values, instance_variants, instances, navigation, shown_variant};

/// Value of an instance's variant parameter that selects no variant.
pub(crate) const NO_VARIANT: &str = "none";

/// Saves the current values of the exposed knobs as a variant with this name, and replaces an existing one. If a variant is shown,
/// the new one is shown instead.
pub fn save(document: &mut OpenDocument, name: &str) -> bool {
    let name = match checked_name(name) {
        Ok(name) => name,
        Err(why) => return document.refuse(why),
    };
    let knobs = exposed_knobs::knobs(document);
    if knobs.is_empty() {
        return document.refuse("a variant stores the exposed parameters, and there are none; expose some first");
    }
    // An instance without a variant does not store the value of its variant knob.
    let is_none = |knob: &exposed_knobs::ExposedKnob| {
        knob.exposed.to.iter().any(|slot| slot.name == "variant") && knob.value.as_text() == Some(NO_VARIANT)
    };
    let values = knobs.into_iter().filter(|knob| !is_none(knob));
    let values: BTreeMap<String, Value> = values.map(|knob| (knob.name, knob.value)).collect();
    let mut edits = vec![shown_variant::setting(document, &name, Some(values))];
    // If a variant is shown, further edits are meant for the copy.
    if shown_variant::name(document).is_some_and(|shown| shown != name) {
        edits.push(showing(document, Some(&name)));
    }
    document.edit("Save variant", edits)
}

/// Returns a text that identifies the values that are shown, in the form of [`as_text`]: the shown variant, or the
/// graph's own values.
pub fn shown_as_text(document: &OpenDocument) -> String {
    match shown_variant::values(document) {
        Some((_, values)) => as_text(document, values),
        None => own_as_text(document),
    }
}

/// Returns a text that identifies the graph's own values of the exposed knobs.
pub fn own_as_text(document: &OpenDocument) -> String {
    let own = document
        .own_interface()
        .into_iter()
        .flat_map(|interface| &interface.knobs);
    let own = own.filter(|knob| document.graph().exposed().contains_key(&knob.name));
    as_text(
        document,
        &own.map(|knob| (knob.name.clone(), knob.ty.default.clone())).collect(),
    )
}

/// Returns a text that identifies a variant of the shown graph by the graph and the variant's values. The name of the
/// variant does not matter.
pub fn as_text(document: &OpenDocument, values: &BTreeMap<String, Value>) -> String {
    let values = Value::Object(values.clone()).to_json();
    format!("variant of {:?}: {values}", document.shown())
}

/// Shows a variant, or the graph's own values. Knobs that the variant does not set have the graph's values.
pub fn show(document: &mut OpenDocument, name: Option<&str>) -> bool {
    if let Some(name) = name {
        let Some(values) = document.graph().variants().get(name) else {
            return document.refuse(format!("there is no variant '{name}'"));
        };
        let mut faults = values.iter();
        let why = faults.find_map(|(knob, value)| exposed_values::why_not_set(document, knob, value));
        if let Some(why) = why {
            return document.refuse(why);
        }
    }
    // A variant that no longer exists counts as no variant, but its name is still stored.
    if shown_variant::chosen(document) == name {
        return true;
    }
    let step = match name {
        Some(name) => format!("Show variant '{name}'"),
        None => "Show own values".to_owned(),
    };
    let edit = showing(document, name);
    document.edit(&step, vec![edit])
}

/// Edit that shows a variant of the shown graph.
fn showing(document: &OpenDocument, name: Option<&str>) -> Edit {
    match navigation::entered_instance(document) {
        None => changed_preview(document, |preview| preview.variant = name.map(str::to_owned)),
        Some((body, id)) => choosing(body, id, name),
    }
}

/// Returns the whole graph as if the shown graph, or an instance in it, had another variant; a `name` of `None` stands for
/// the graph's own values. Returns `None` if there is no such instance.
pub fn graph_with_variant(document: &OpenDocument, instance: Option<&NodeId>, name: Option<&str>) -> Option<OpenGraph> {
    let edit = match instance {
        None => showing(document, name),
        Some(id) => Edit::Batch(instance_variants::choosing(document, id, name)?),
    };
    let mut graph = document.session.graph().clone();
    graph.document.apply(edit).ok()?;
    Some(graph)
}

/// Edit that chooses the variant of a group instance.
fn choosing(body: Body, node: NodeId, name: Option<&str>) -> Edit {
    Edit::SetParam {
        body,
        node,
        param: "variant".to_owned(),
        value: name.map(|name| Value::Text(name.to_owned())),
    }
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
    let mut edits = vec![
        shown_variant::setting(document, name, None),
        shown_variant::setting(document, &to, Some(values)),
    ];
    if *document.shown() == Body::Main && shown_variant::name(document) == Some(name) {
        edits.push(showing(document, Some(&to)));
    }
    for (body, id, node) in instances::of_body(document.contents(), document.shown()) {
        if node.params.get("variant").and_then(Value::as_text) == Some(name) {
            edits.push(choosing(body, id, Some(&to)));
        }
    }
    document.edit("Rename variant", edits)
}

/// Removes a variant. Everything that showed it shows the graph's own values.
pub fn remove(document: &mut OpenDocument, name: &str) -> bool {
    if !document.graph().variants().contains_key(name) {
        return document.refuse(format!("there is no variant '{name}'"));
    }
    let mut edits = vec![shown_variant::setting(document, name, None)];
    if *document.shown() == Body::Main && shown_variant::name(document) == Some(name) {
        edits.push(showing(document, None));
    }
    document.edit("Remove variant", edits)
}

fn checked_name(name: &str) -> Result<String, String> {
    match name.trim() {
        "" => Err("a variant needs a name".to_owned()),
        NO_VARIANT => Err(format!("'{NO_VARIANT}' stands for no variant; choose another name")),
        name => Ok(name.to_owned()),
    }
}
