//! Conversion of knobs to parameters.

use std::collections::BTreeMap;

use super::{FlattenError, Overrides};
use crate::graph::ExposedParameter;
use crate::problem::{Problem, hint, listed, quoted};
use crate::value::number_text;
use crate::{Fit, Graph, SlotRef, Value};

/// Knobs of every group instance; exposed knobs of a group must have other names.
pub const INSTANCE_KNOBS: [&str; 4] = ["fit", "scale", "seed", "variant"];

/// Value of the knob `fit` of an instance that keeps the fit of its group.
const AS_MADE: &str = "as_made";

/// Parameters that knobs set, in order. Later entries win.
pub(super) type KnobValues = Vec<(SlotRef, Value)>;

/// The exposed knobs of a graph with the settings made so far. `of` describes the graph in messages: empty, or ` of "instance"`.
pub(super) struct ExposedSettings<'a> {
    graph: &'a Graph,
    of: String,
    settings: KnobValues,
}

impl<'a> ExposedSettings<'a> {
    /// Starts with all knobs at their defaults, and applies the variant.
    pub(super) fn new(graph: &'a Graph, of: String, variant: Option<&str>) -> Result<Self, FlattenError> {
        let mut exposed = ExposedSettings {
            graph,
            of,
            settings: Vec::new(),
        };
        let variant = variant.map(|name| exposed.variant(name)).transpose()?;
        for (name, value) in graph.knob_values(variant) {
            exposed.set(name, value)?;
        }
        Ok(exposed)
    }

    /// Sets an exposed knob. Returns false if there is no knob with this name.
    pub(super) fn set(&mut self, name: &str, value: &Value) -> Result<bool, FlattenError> {
        let graph = self.graph;
        match graph.exposed().get(name) {
            Some(knob) => self.set_knob(name, knob, value).map(|()| true),
            None => Ok(false),
        }
    }

    /// Settings in the order in which they were made.
    pub(super) fn into_settings(self) -> KnobValues {
        self.settings
    }

    fn variant(&self, name: &str) -> Result<&'a BTreeMap<String, Value>, FlattenError> {
        let variants = self.graph.variants();
        let names = || variants.keys().map(String::as_str);
        variants.get(name).ok_or_else(|| FlattenError::NoSuchVariant {
            name: format!("{}{}", quoted(name), self.of),
            hint: hint(name, names()),
            known: listed(names()),
        })
    }

    fn set_knob(&mut self, name: &str, knob: &ExposedParameter, value: &Value) -> Result<(), FlattenError> {
        if let Some(range) = knob.range {
            self.check_range(name, range, value)?;
        }
        self.settings
            .extend(knob.settings(value).map(|(slot, value)| (slot.clone(), value)));
        Ok(())
    }

    fn check_range(&self, name: &str, [low, high]: [f64; 2], value: &Value) -> Result<(), FlattenError> {
        let one = std::slice::from_ref(value);
        for part in value.as_list().unwrap_or(one) {
            let knob = format!("{}{}", quoted(name), self.of);
            let (low_text, high_text) = (number_text(low), number_text(high));
            match part.as_number() {
                Some(x) if (low..=high).contains(&x) => {}
                Some(x) => {
                    let value = number_text(x);
                    return Err(FlattenError::OutOfRange {
                        knob,
                        value,
                        low: low_text,
                        high: high_text,
                    });
                }
                None => {
                    let value = match part.decimal_comma_advice() {
                        "" => part.type_with_article().to_owned(),
                        advice => format!("{part}{advice}"),
                    };
                    return Err(FlattenError::NotANumber {
                        knob,
                        value,
                        low: low_text,
                        high: high_text,
                    });
                }
            }
        }
        Ok(())
    }
}

/// Settings of the overrides in the main graph.
pub(super) fn of_overrides(graph: &Graph, overrides: &Overrides) -> Result<KnobValues, FlattenError> {
    let mut exposed = ExposedSettings::new(graph, String::new(), overrides.variant.as_deref())?;
    for (name, value) in &overrides.set {
        let bad = || Problem::BadValue { name: quoted(name) };
        let value = value.clone().canonical().ok_or_else(bad)?;
        if exposed.set(name, &value)? {
            continue;
        }
        let slot = name
            .parse::<SlotRef>()
            .ok()
            .filter(|slot| graph.node(slot.node.as_str()).is_some());
        exposed
            .settings
            .push((slot.ok_or_else(|| no_such_knob(graph, name))?, value));
    }
    Ok(exposed.into_settings())
}

fn no_such_knob(graph: &Graph, name: &str) -> FlattenError {
    let knobs = || graph.exposed().keys().map(String::as_str);
    let param = name.split_once('.').map_or("", |(_, param)| param);
    let slots: Vec<String> = graph
        .ids()
        .map(|id| format!("{id}.{param}"))
        .filter(|_| !param.is_empty())
        .collect();
    FlattenError::NoSuchKnob {
        name: quoted(name),
        hint: hint(name, knobs().chain(slots.iter().map(String::as_str))),
        known: listed(knobs()),
    }
}

/// Settings that a group instance makes inside its group.
pub(super) struct InstanceKnobs {
    pub(super) settings: KnobValues,
    /// 0 when not set.
    pub(super) seed: u32,
    /// 1 when not set.
    pub(super) scale: f64,
    /// Fit in place of that of the group.
    pub(super) fit: Option<Fit>,
}

/// Reads the parameters of the instance `id` of the group `graph`.
pub(super) fn of_instance(
    graph: &Graph,
    id: &str,
    params: &BTreeMap<String, Value>,
) -> Result<InstanceKnobs, FlattenError> {
    if let Some(knob) = INSTANCE_KNOBS.iter().find(|knob| graph.exposed().contains_key(**knob)) {
        return Err(FlattenError::ReservedKnob {
            instance: quoted(id),
            knob,
        });
    }
    let bad = |knob: &'static str, expected: &'static str, value: &Value| FlattenError::BadInstanceKnob {
        instance: quoted(id),
        knob,
        expected,
        value: shortened(value),
    };
    let seed = match params.get("seed") {
        None => 0,
        Some(value) => value
            .as_u32()
            .ok_or_else(|| bad("seed", "a whole number from 0 to 4294967295", value))?,
    };
    let scale = match params.get("scale") {
        None => 1.0,
        Some(Value::Number(x)) if *x > 0.0 => *x,
        Some(value) => return Err(bad("scale", "a number above zero", value)),
    };
    let fit = params.get("fit").map(|value| fit_named(value).ok_or(value)).transpose();
    let fit = fit.map_err(|value| bad("fit", "\"as_made\", \"piece\", \"unit\" or \"metres\"", value))?;
    let variant = match params.get("variant") {
        None => None,
        Some(Value::Text(name)) => Some(name.as_str()),
        Some(value) => return Err(bad("variant", "the name of a variant of the group", value)),
    };
    let mut exposed = ExposedSettings::new(graph, format!(" of {}", quoted(id)), variant)?;
    for (name, value) in params {
        if !INSTANCE_KNOBS.contains(&name.as_str()) && !exposed.set(name, value)? {
            let knobs = || graph.exposed().keys().map(String::as_str).chain(INSTANCE_KNOBS);
            return Err(FlattenError::NoSuchInstanceKnob {
                instance: quoted(id),
                name: quoted(name),
                hint: hint(name, knobs()),
                known: listed(knobs()),
            });
        }
    }
    let settings = exposed.into_settings();
    Ok(InstanceKnobs {
        settings,
        seed,
        scale,
        fit: fit.flatten(),
    })
}

/// Returns the fit that a value of the knob `fit` names. The inner `None` stands for the fit of the group, the outer `None`
/// for an invalid value.
fn fit_named(value: &Value) -> Option<Option<Fit>> {
    match value.as_text()? {
        "unit" => Some(Some(Fit::Unit)),
        "metres" => Some(Some(Fit::Metres)),
        "piece" => Some(Some(Fit::Piece)),
        AS_MADE => Some(None),
        _ => None,
    }
}

/// A value on one line, shortened for messages.
fn shortened(value: &Value) -> String {
    let text = value.to_json();
    match text.char_indices().nth(80) {
        None => text,
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}
