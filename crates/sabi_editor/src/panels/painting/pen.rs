//! Settings of the pen: the effects of its pressure and its tilt.

use egui::{Sense, Slider, Ui, vec2};
use sabi_paint::PenEffects;

use crate::context::ViewContext;
use crate::settings::brush::BrushChoices;

/// Side of the curve of a pen, points.
const CURVE_SIDE: f32 = 56.0;

/// Texts about the effects of pressure, or of tilt.
struct PenWords {
    title: &'static str,
    /// Tooltips of the size, strength, hardness, scatter, turn, and the curve.
    docs: [&'static str; 6],
}

const PRESSURE: PenWords = PenWords {
    title: "Pressure",
    docs: [
        "How much a light touch makes the brush smaller; below 0 larger",
        "How much a light touch makes the paint fainter; below 0 stronger",
        "How much a light touch makes the brush softer; below 0 harder",
        "How much a light touch brings stamps nearer to the way; below 0 farther from it",
        "How far the full pressure turns the tip, counter-clockwise",
        "More has a light touch count more, less asks for a heavy one",
    ],
};

const TILT: PenWords = PenWords {
    title: "Tilt",
    docs: [
        "How much an upright pen makes the brush smaller; below 0 a pen that lies flat does",
        "How much an upright pen makes the paint fainter; below 0 a pen that lies flat does",
        "How much an upright pen makes the brush softer; below 0 a pen that lies flat does",
        "How much an upright pen brings stamps nearer to the way; below 0 a pen that lies flat does",
        "How far a pen that lies flat turns the tip, counter-clockwise. In Stamps, Follows: Pen has the tip lie as the pen leans",
        "More has a little lean count more, less asks for a flat pen",
    ],
};

/// Shows the effects of the pen, and the state of the search for pens.
pub(super) fn show(ui: &mut Ui, context: &ViewContext<'_>, brush: &mut BrushChoices) {
    effects(ui, &PRESSURE, &mut brush.pressure);
    effects(ui, &TILT, &mut brush.tilt);
    ui.weak(context.pens.status());
}

fn effects(ui: &mut Ui, words: &PenWords, effects: &mut PenEffects) {
    ui.push_id(words.title, |ui| {
        ui.label(words.title);
        let [size, strength, hardness, scatter, turn, curve] = words.docs;
        for (name, doc, amount) in [
            ("Size", size, &mut effects.radius),
            ("Strength", strength, &mut effects.flow),
            ("Hardness", hardness, &mut effects.hardness),
            ("Scatter", scatter, &mut effects.scatter),
        ] {
            ui.add(Slider::new(amount, -1.0..=1.0).text(name)).on_hover_text(doc);
        }
        let slider = Slider::new(&mut effects.angle_degrees, -180.0..=180.0);
        ui.add(slider.suffix("°").text("Turn")).on_hover_text(turn);
        ui.add(Slider::new(&mut effects.bend, 0.05..=0.95).text("Touch"))
            .on_hover_text(curve);
        let (rect, _) = ui.allocate_exact_size(vec2(CURVE_SIDE, CURVE_SIDE), Sense::hover());
        ui.painter().rect_filled(rect, 2.0, ui.visuals().extreme_bg_color);
        let places = (0..=32).map(|step| {
            let share = step as f32 / 32.0;
            rect.left_bottom() + vec2(share, -effects.effect(share) as f32) * rect.size()
        });
        let line = ui.visuals().widgets.active.fg_stroke;
        ui.painter().line(places.collect(), line);
    });
}
