//! Random values of exposed knobs, near their current values: of a group instance, and of those that the document exposes.

use std::collections::{BTreeMap, BTreeSet};

use sabi_engine::catalog::Knob;
use sabi_graph::{Body, Edit, GROUP_KIND, INSTANCE_KNOBS, NodeId, Value};
use sabi_nodes::kind::{Memory, Role};

use crate::open_document::OpenDocument;
use crate::{document_settings, exposed_knobs, exposed_values};

/// Name of the seed in lists of knobs that keep their values.
pub const SEED: &str = "seed";
/// Largest step, as a share of a knob's range: small enough that the result keeps its character.
const STEP: f64 = 0.3;
/// Largest distance from the value in the group or variant, as a share of the range.
const REACH: f64 = 0.35;
/// Smallest value, as a share of the value in the group or variant, so that no feature disappears.
const LEAST: f64 = 0.25;
/// Largest factor of a step, and of the distance from the value in the group or variant, for lengths and other scales.
const FACTOR: f64 = 1.6;
const FACTOR_REACH: f64 = 2.5;
/// Share of its range below which a value counts as small, and ratio of the ends of a range above which it counts as a scale. Such values
/// are changed by factors, since a fixed step would be too small at one end of the range and too large at the other.
const SMALL: f64 = 0.2;
const SCALE: f64 = 8.0;
/// Largest step of the channels of a color, and largest distance from the color in the group or variant, of 255.
const COLOR_STEP: f64 = 22.0;
const COLOR_REACH: f64 = 40.0;

/// Gives an instance of a group another seed, and changes each exposed number and color to a value near its current one.
/// Values also stay near those of the chosen variant, or of the group if there is none. Knobs of `kept`, choices, texts,
/// lists and numbers without a range stay unchanged.
pub fn randomize(document: &mut OpenDocument, id: &NodeId, kept: &BTreeSet<String>) -> bool {
    let node = document.node(id).filter(|node| node.kind == GROUP_KIND).cloned();
    let Some((node, interface)) = node.zip(document.interface(id).cloned()) else {
        return document.refuse("only an instance of a group has random values");
    };
    let chosen = node.params.get("variant").and_then(Value::as_text);
    let of_variant = match (&node.group, chosen) {
        (Some(group), Some(name)) => values_of_variant(document, group, name),
        _ => BTreeMap::new(),
    };
    let body = document.body();
    let set = |param: &str, value: Value| Edit::SetParam {
        body: body.clone(),
        node: id.clone(),
        param: param.to_owned(),
        value: Some(value),
    };
    let mut edits = Vec::new();
    if !kept.contains(SEED) {
        edits.push(set(SEED, Value::from(document.ids.seed())));
    }
    for knob in &interface.knobs {
        if INSTANCE_KNOBS.contains(&knob.name.as_str()) || kept.contains(&knob.name) {
            continue;
        }
        let home = of_variant.get(&knob.name).unwrap_or(&knob.ty.default);
        let now = node.params.get(&knob.name).unwrap_or(home);
        let value = near(knob, home, now, || signed(document));
        edits.extend(value.map(|value| set(&knob.name, value)));
    }
    document.edit("Random values", edits)
}

/// Gives the document another seed and the exposed knobs of the shown graph other values, like [`randomize`]. If a
/// variant is shown, its values are changed. Values stay near those that a reset restores.
pub fn randomize_exposed(document: &mut OpenDocument, kept: &BTreeSet<String>) -> bool {
    let knobs = exposed_knobs::knobs(document);
    if knobs.is_empty() {
        return document.refuse("there are no exposed parameters to give random values to");
    }
    document.session.begin("Random values");
    let mut is_changed = false;
    if !kept.contains(SEED) && *document.shown() == Body::Main {
        let seed = document.ids.seed();
        is_changed |= document_settings::set_seed(document, seed);
    }
    for known in knobs.into_iter().filter(|known| !kept.contains(&known.name)) {
        let value = match known.knob.ty.role {
            Role::Seed => Some(Value::from(document.ids.seed())),
            // A knob that was exposed since the graph was opened has no other value than its current one.
            _ => near(&known.knob, home_of(&known), &known.value, || signed(document)),
        };
        if let Some(value) = value {
            is_changed |= exposed_values::set(document, &known.name, &value);
        }
    }
    document.session.end();
    is_changed
}

/// Returns the value that an exposed knob stays near: the one that a reset restores, if the knob accepts it.
fn home_of(known: &exposed_knobs::ExposedKnob) -> &Value {
    match exposed_values::range_fault(known.knob.ty.range, &known.at_first) {
        None => &known.at_first,
        Some(_) => &known.value,
    }
}

/// Returns the values of a variant of a group, which is in the document or in a graph file.
fn values_of_variant(document: &mut OpenDocument, group: &str, name: &str) -> BTreeMap<String, Value> {
    if let Some(known) = document.contents().groups.get(group) {
        return known.graph.variants().get(name).cloned().unwrap_or_default(); // A variant that does not exist sets nothing.
    }
    let base = document.session.graph().base();
    let file = document.read_group_file(&base, group);
    file.and_then(|file| file.graph.variants().get(name).cloned())
        .unwrap_or_default() // A file that cannot be read has no values.
}

/// A random number from −1 to 1.
fn signed(document: &mut OpenDocument) -> f64 {
    f64::from(document.ids.seed() % 1000) / 999.0 * 2.0 - 1.0
}

/// Returns a random value near the current one and near `home`; `None` for knobs whose values cannot be varied.
fn near(knob: &Knob, home: &Value, now: &Value, mut signed: impl FnMut() -> f64) -> Option<Value> {
    match knob.ty.role {
        Role::Color => {
            let (home, now) = (channels(home)?, channels(now)?);
            // All channels change in the same direction, with small differences.
            let shared = signed();
            let moved = [0, 1, 2].map(|at| {
                let step = COLOR_STEP * (0.7 * shared + 0.3 * signed());
                let (low, high) = (home[at] - COLOR_REACH, home[at] + COLOR_REACH);
                let bounds = [low.min(now[at]).max(0.0), high.max(now[at]).min(255.0)];
                reflected(now[at] + step, bounds).round() as u8
            });
            let code: String = moved.iter().map(|channel| format!("{channel:02x}")).collect();
            Some(Value::from(format!("#{code}").as_str()))
        }
        Role::Choice(_) | Role::Toggle | Role::Seed | Role::Text => None,
        // Whole numbers are choices or counts, which have no values in between.
        _ if knob.ty.memory != Memory::F32 => None,
        _ => {
            let range = knob.ty.range?;
            let (home, now) = (home.as_number()?, now.as_number()?);
            let is_length = knob.ty.role == Role::Length;
            Some(Value::Number(near_number(is_length, range, home, now, signed())))
        }
    }
}

/// Returns a number near the current one. Lengths and scales are changed by factors.
fn near_number(is_length: bool, [low, high]: [f64; 2], home: f64, now: f64, signed: f64) -> f64 {
    let span = high - low;
    let is_scale = is_length || low > 0.0 && high >= SCALE * low || low >= 0.0 && home < SMALL * span;
    if is_scale && low >= 0.0 && home > 0.0 && now > 0.0 {
        let bounds = [
            (home / FACTOR_REACH).max(low).min(now),
            (home * FACTOR_REACH).min(high).max(now),
        ];
        let moved = reflected(now.ln() + signed * FACTOR.ln(), bounds.map(f64::ln)).exp();
        // Round to as many digits as a person would type.
        let unit = 10_f64.powf(moved.log10().floor() - 2.0);
        return ((moved / unit).round() * unit).clamp(low, high);
    }
    let least = if low >= 0.0 && home > 0.0 {
        (home * LEAST).max(low)
    } else {
        low
    };
    let bounds = [
        (home - REACH * span).max(least).min(now),
        (home + REACH * span).min(high).max(now),
    ];
    let moved = reflected(now + signed * STEP * span, bounds);
    let unit = 10_f64.powf((span.abs().max(1e-9).log10() - 3.0).floor());
    ((moved / unit).round() * unit).clamp(low, high)
}

/// Returns a value inside of bounds: a value beyond them is reflected, so that values do not accumulate at the ends.
fn reflected(value: f64, [low, high]: [f64; 2]) -> f64 {
    let turned = if value < low {
        2.0 * low - value
    } else if value > high {
        2.0 * high - value
    } else {
        value
    };
    turned.clamp(low, high.max(low))
}

/// Channels of a color, of 255.
fn channels(color: &Value) -> Option<[f64; 3]> {
    let code = color.as_text()?.strip_prefix('#')?;
    let channel = |at: usize| u8::from_str_radix(code.get(2 * at..2 * at + 2)?, 16).ok();
    Some([channel(0)?, channel(1)?, channel(2)?].map(f64::from))
}
