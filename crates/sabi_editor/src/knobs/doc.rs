//! Tooltips of parameters.

use egui::text::{LayoutJob, TextFormat};
use egui::{FontFamily, FontId, Ui};
use sabi_engine::catalog::Knob;
use sabi_nodes::kind::Role;

use super::KnobRow;
use crate::theme::{Theme, type_size};

/// Width of a tooltip, points.
const WIDEST: f32 = 300.0;

/// Shows the tooltip of a parameter.
pub(super) fn show(ui: &mut Ui, theme: &Theme, row: &KnobRow<'_>) {
    ui.set_max_width(WIDEST);
    if !row.knob.doc.is_empty() {
        ui.label(formatted(&row.knob.doc, theme));
    }
    let name = format!("`{}`{}", row.knob.name, limits(row.knob));
    ui.label(formatted_as(&name, theme.quiet, type_size::SMALL));
    if let Some(exposed) = row.exposed {
        let sentence = format!("Exposed as `{exposed}`.");
        ui.label(formatted_as(&sentence, theme.quiet, type_size::SMALL));
    }
}

fn formatted(text: &str, theme: &Theme) -> LayoutJob {
    formatted_as(text, theme.text, type_size::BODY)
}

/// Text of a doc comment, with code between backticks.
fn formatted_as(text: &str, color: egui::Color32, size: f32) -> LayoutJob {
    let mut job = LayoutJob::default();
    for (at, part) in text.split('`').enumerate() {
        let family = if at % 2 == 1 {
            FontFamily::Monospace
        } else {
            FontFamily::Proportional
        };
        job.append(part, 0.0, TextFormat::simple(FontId::new(size, family), color));
    }
    job
}

/// Range and default of a parameter.
fn limits(knob: &Knob) -> String {
    let range = knob
        .ty
        .range
        .map_or(String::new(), |[low, high]| format!(", {low} to {high}"));
    let is_short = !matches!(knob.ty.role, Role::Stops | Role::Curve | Role::Seed);
    match is_short {
        true => format!("{range}, default {}", knob.ty.default.to_json()),
        false => range,
    }
}
