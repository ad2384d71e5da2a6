//! Random values of the knobs of a group instance, near those that the group was made with.

use std::collections::BTreeSet;

use sabi_engine::catalog::{Knob, KnobRole};
use sabi_graph::{Edit, INSTANCE_KNOBS, NodeId, Value};

use crate::open_document::OpenDocument;

/// Largest step from the default, as a share of a knob's range: the look changes, and stays what it is.
const STEP: f64 = 0.35;
/// Largest step of the channels of a color, of 255.
const COLOR_STEP: f64 = 22.0;

/// Gives an instance of a group another seed, and each published number and color another value near its default. Knobs of `kept`
/// stay, and so do choices, texts, lists and numbers without a range.
pub fn randomize(document: &mut OpenDocument, id: &NodeId, kept: &BTreeSet<String>) -> bool {
    let Some(face) = document.face(id).cloned() else {
        return document.refuse("only an instance of a group has random values");
    };
    let body = document.body();
    let set = |param: &str, value: Value| Edit::SetParam {
        body: body.clone(),
        node: id.clone(),
        param: param.to_owned(),
        value: Some(value),
    };
    let mut edits = Vec::new();
    if !kept.contains("seed") {
        edits.push(set("seed", Value::from(document.ids.seed())));
    }
    for knob in &face.knobs {
        if INSTANCE_KNOBS.contains(&knob.name.as_str()) || kept.contains(&knob.name) {
            continue;
        }
        let value = near_default(knob, || f64::from(document.ids.seed() % 1000) / 999.0 * 2.0 - 1.0);
        edits.extend(value.map(|value| set(&knob.name, value)));
    }
    document.edit("Random values", edits)
}

/// A value near the default of a knob; `signed` gives random numbers from −1 to 1.
fn near_default(knob: &Knob, mut signed: impl FnMut() -> f64) -> Option<Value> {
    match knob.ty.role {
        KnobRole::Color => {
            let code = knob.ty.default.as_text()?.strip_prefix('#')?;
            let channels: Option<Vec<f64>> = (0..3)
                .map(|at| Some(f64::from(u8::from_str_radix(code.get(2 * at..2 * at + 2)?, 16).ok()?)))
                .collect();
            // All channels go the same way, and each a little its own.
            let shared = signed();
            let moved = channels?.into_iter().map(|channel| {
                let step = COLOR_STEP * (0.7 * shared + 0.3 * signed());
                (channel + step).round().clamp(0.0, 255.0) as u8
            });
            let code: String = moved.map(|channel| format!("{channel:02x}")).collect();
            Some(Value::from(format!("#{code}").as_str()))
        }
        KnobRole::Choice(_) | KnobRole::Toggle | KnobRole::Seed | KnobRole::Text => None,
        _ => {
            let [low, high] = knob.ty.range?;
            let default = knob.ty.default.as_number()?;
            let value = (default + STEP * (high - low) * signed()).clamp(low, high);
            // As many digits as a person would type.
            let unit = 10_f64.powf(((high - low).abs().max(1e-9).log10() - 3.0).floor());
            Some(Value::Number(((value / unit).round() * unit).clamp(low, high)))
        }
    }
}
