//! Values of exposed knobs, and the values that they accept.

use std::collections::BTreeSet;

use sabi_graph::{Edit, ExposedParameter, NodeId, SlotRef, Value, canonical_number};

use crate::names::knob_label;
use crate::open_document::OpenDocument;
use crate::{exposed_knobs, instances, shown_variant};

/// Sets an exposed knob. If a variant is shown, the value is stored in the variant; otherwise in the knob's default if it
/// has one, or else in the nodes that it controls.
pub fn set(document: &mut OpenDocument, name: &str, value: &Value) -> bool {
    if let Some(why) = why_not_set(document, name, value) {
        return document.refuse(why);
    }
    let edits = setting(document, name, value);
    document.edit(&step_name(document, name), edits)
}

/// Resets an exposed knob: if a variant is shown, to the graph's own value; otherwise to its value when the graph was opened.
pub fn reset(document: &mut OpenDocument, name: &str) -> bool {
    if let Some((variant, values)) = shown_variant::values(document) {
        let mut values = values.clone();
        if values.remove(name).is_none() && document.graph().exposed().contains_key(name) {
            return true;
        }
        let edit = shown_variant::setting(document, variant, Some(values));
        return document.edit(&step_name(document, name), vec![edit]);
    }
    let mut knobs = exposed_knobs::knobs(document).into_iter();
    match knobs.find(|knob| knob.name == name) {
        Some(knob) => set(document, name, &knob.at_first),
        None => document.refuse(format!("there is no exposed parameter '{name}'")),
    }
}

/// Name of a step that sets an exposed knob.
fn step_name(document: &OpenDocument, name: &str) -> String {
    let label = knob_label(document.own_interface(), name);
    match shown_variant::name(document) {
        Some(variant) => format!("{label} of the variant '{variant}'"),
        None => format!("{label} of the panel"),
    }
}

/// Returns the reason why an exposed knob cannot be set to a value; `None` if it can.
pub(crate) fn why_not_set(document: &OpenDocument, name: &str, value: &Value) -> Option<String> {
    let Some(exposed) = document.graph().exposed().get(name) else {
        return Some(format!("there is no exposed parameter '{name}'"));
    };
    range_fault(exposed.range, value).map(|why| format!("'{}' {why}", knob_label(document.own_interface(), name)))
}

/// Edits that set an exposed knob.
fn setting(document: &OpenDocument, name: &str, value: &Value) -> Vec<Edit> {
    if let Some((variant, values)) = shown_variant::values(document) {
        let mut values = values.clone();
        values.insert(name.to_owned(), value.clone());
        return vec![shown_variant::setting(document, variant, Some(values))];
    }
    let Some(exposed) = document.graph().exposed().get(name) else {
        return Vec::new();
    };
    if exposed.default.is_some() {
        let default = Some(value.clone());
        return vec![exposed_knobs::exposing(
            document,
            name,
            ExposedParameter {
                default,
                ..exposed.clone()
            },
        )];
    }
    let set = |(slot, value): (&SlotRef, Value)| Edit::SetParam {
        body: document.body(),
        node: slot.node.clone(),
        param: slot.name.clone(),
        value: Some(value),
    };
    exposed.settings(value).map(set).collect()
}

/// Returns whether a new value of a node's knob belongs only in the shown variant: the variant sets this knob, and the
/// value is within the exposed range, or a reset.
pub(crate) fn is_of_variant_only(document: &OpenDocument, id: &NodeId, knob: &str, value: Option<&Value>) -> bool {
    let Some(name) = exposed_knobs::exposed_as(document, id, knob) else {
        return false;
    };
    let is_set = shown_variant::values(document).is_some_and(|(_, values)| values.contains_key(name));
    let exposed = document.graph().exposed().get(name);
    let range = exposed.and_then(|exposed| exposed.range);
    is_set && value.is_none_or(|value| range_fault(range, value).is_none())
}

/// Returns the edits of exposed knobs that must accompany new values of the nodes' knobs, since the shown variant or a
/// default would override these.
pub(crate) fn values_of_exposed(
    document: &OpenDocument,
    ids: &[NodeId],
    knob: &str,
    value: Option<&Value>,
) -> Vec<Edit> {
    let exposed: BTreeSet<&str> = ids
        .iter()
        .filter_map(|id| exposed_knobs::exposed_as(document, id, knob))
        .collect();
    let variant = shown_variant::values(document);
    let mut of_variant = variant.map(|(_, values)| values.clone()).unwrap_or_default(); // Without a shown variant, it has no values.
    let mut edits = Vec::new();
    for name in exposed {
        let Some(exposed) = document.graph().exposed().get(name) else {
            continue;
        };
        let slot = exposed
            .to
            .iter()
            .find(|slot| slot.name == knob && ids.contains(&slot.node));
        let curve = slot.and_then(|slot| exposed.curves.get(slot));
        let of_knob = value.map(|value| curve.map_or_else(|| value.clone(), |curve| curve.invert(value)));
        // A reset removes the overriding value. A value outside of the exposed range removes it, too.
        let inside = of_knob
            .as_ref()
            .filter(|value| range_fault(exposed.range, value).is_none());
        let is_of_variant = of_variant.contains_key(name);
        if is_of_variant {
            match inside {
                Some(value) => of_variant.insert(name.to_owned(), value.clone()),
                None => of_variant.remove(name),
            };
        }
        // A value that does not belong in the variant is a value of the graph itself. A knob with curves keeps its default,
        // since it has no other value.
        let can_lose_default = exposed.curves.is_empty() || inside.is_some();
        if exposed.default.is_some() && can_lose_default && (!is_of_variant || value.is_some() && inside.is_none()) {
            let default = inside.cloned();
            let exposed = ExposedParameter {
                default,
                ..exposed.clone()
            };
            edits.push(exposed_knobs::exposing(document, name, exposed));
        }
    }
    if let Some((name, values)) = variant
        && *values != of_variant
    {
        edits.push(shown_variant::setting(document, name, Some(of_variant)));
    }
    edits
}

/// Sets the default of an exposed knob. `None` removes it, so that the nodes keep their own values.
pub fn set_default(document: &mut OpenDocument, name: &str, default: Option<Value>) -> bool {
    let Some(exposed) = document.graph().exposed().get(name).cloned() else {
        return document.refuse(format!("there is no exposed parameter '{name}'"));
    };
    if let Some(why) = default.as_ref().and_then(|value| range_fault(exposed.range, value)) {
        let label = knob_label(document.own_interface(), name);
        return document.refuse(format!("'{label}' {why}"));
    }
    let edit = exposed_knobs::exposing(document, name, ExposedParameter { default, ..exposed });
    document.edit("Set default", vec![edit])
}

/// Sets the range of an exposed knob; `None` restores the range of the knob that it controls. All values set so far must
/// lie in the range.
pub fn set_range(document: &mut OpenDocument, name: &str, range: Option<[f64; 2]>) -> bool {
    let Some(exposed) = document.graph().exposed().get(name).cloned() else {
        return document.refuse(format!("there is no exposed parameter '{name}'"));
    };
    // Round as in the file, so that a value at the end of the range is inside.
    let range = range.map(|ends| ends.map(|end| canonical_number(end).unwrap_or(end)));
    let outside = set_values(document, name, &exposed).find_map(|(place, value)| {
        let why = range_fault(range, &value)?;
        let label = knob_label(document.own_interface(), name);
        Some(format!("{place} would lie outside: '{label}' {why}"))
    });
    if let Some(why) = outside {
        return document.refuse(why);
    }
    let edit = exposed_knobs::exposing(document, name, ExposedParameter { range, ..exposed });
    document.edit("Set range", vec![edit])
}

/// Lists the values of an exposed knob in its default, the variants and the instances, each with a description of its place.
fn set_values<'d>(
    document: &'d OpenDocument,
    name: &'d str,
    exposed: &'d ExposedParameter,
) -> impl Iterator<Item = (String, Value)> + 'd {
    let default = exposed
        .default
        .iter()
        .map(|value| ("its default".to_owned(), value.clone()));
    let variants = document.graph().variants().iter();
    let variants = variants
        .filter_map(move |(variant, values)| Some((format!("the variant '{variant}'"), values.get(name)?.clone())));
    let instances = instances::of_body(document.contents(), document.shown()).into_iter();
    let instances = instances.filter_map(move |(_, id, node)| {
        let title = node.label.clone().unwrap_or_else(|| id.to_string());
        Some((format!("the instance '{title}'"), node.params.get(name)?.clone()))
    });
    default.chain(variants).chain(instances)
}

/// Returns the reason why a value is outside of a range; `None` if it is inside.
pub(crate) fn range_fault(range: Option<[f64; 2]>, value: &Value) -> Option<String> {
    let [low, high] = range?;
    let one = std::slice::from_ref(value);
    for part in value.as_list().unwrap_or(one) {
        match part.as_number() {
            Some(number) if (low..=high).contains(&number) => {}
            Some(number) => return Some(format!("takes {low} to {high}, and this is {number}")),
            None => return Some(format!("takes numbers from {low} to {high}, and this is none")),
        }
    }
    None
}
