//! Settings of the brush: its action, its tip, its size, and everything else that strokes depend on.

use egui::epaint::Hsva;
use egui::{Button, Color32, Popup, PopupCloseBehavior, Rgba, Sense, Slider, StrokeKind, Ui, vec2};
use egui_phosphor::regular as icon;
use sabi_paint::{Action as BrushAction, Area, CopyOf, Fade, FadeCurve, PicturePart, TipDirection};

use super::swatches::Swatches;
use super::{brush_tips, choice, pen, stencil};
use crate::action::{Action, PaintAction};
use crate::context::ViewContext;
use crate::knobs::{CurveMemory, curve_ui, picker, remember_color};
use crate::settings::brush::{BrushChoices, HEIGHTS, Hand, LAGS, POINTS, SIZES, SPACINGS};
use crate::shown_results::ColorTarget;

/// Side of the colors that were used last, points.
const COLOR_SIDE: f32 = 15.0;

/// Actions of the brush with their signs and descriptions.
const ACTIONS: [(BrushAction, &str, &str); 6] = [
    (BrushAction::Paint, icon::PENCIL_SIMPLE, "Paint"),
    (
        BrushAction::Erase,
        icon::ERASER,
        "Erase; Ctrl erases with the others while it is held",
    ),
    (BrushAction::Smear, icon::HAND_SWIPE_RIGHT, "Smear: pull paint along"),
    (BrushAction::Blur, icon::DROP_HALF, "Blur: soften paint"),
    (BrushAction::Sharpen, icon::TRIANGLE, "Sharpen: make borders harder"),
    (
        BrushAction::Clone,
        icon::STAMP,
        "Clone: click with Ctrl where to copy from, then paint",
    ),
];

/// Shows the settings of the brush, and changes it. `text` is the text to stamp, `curve` the state of the curve of the
/// fade.
pub(super) fn show(
    ui: &mut Ui,
    context: &ViewContext<'_>,
    swatches: &mut Swatches,
    text: &mut String,
    curve: &mut CurveMemory,
    brush: &mut BrushChoices,
) -> Vec<Action> {
    let mut actions = Vec::new();
    ui.horizontal(|ui| {
        for (action, sign, doc) in ACTIONS {
            let button = ui.selectable_label(brush.action == action, sign);
            let name = doc.split(&[':', ';']).next().unwrap_or(doc); // The whole text, if no sign is in it.
            button.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, name));
            if button.on_hover_text(doc).clicked() {
                brush.action = action;
            }
        }
    });
    ui.horizontal(|ui| {
        if !brush.action.adjusts() {
            choice(ui, "Lays", &mut brush.area, &Area::ALL).on_hover_text(
                "What the brush puts on the model: a stroke of stamps, a picture or a text in one piece, or color on a whole part",
            );
        }
        if brush.action.adjusts() || matches!(brush.area, Area::Way | Area::Ribbon | Area::Inside) {
            choice(ui, "Drawn", &mut brush.hand, &Hand::ALL)
                .on_hover_text("How the way of a stroke is given: by a drag, by points, or along edges, seams or borders next to a click");
        }
    });
    details(ui, brush);
    actions.extend(brush_tips::show(ui, context, swatches, text, brush));
    if let Some(tip) = &mut brush.picture {
        ui.horizontal(|ui| choice(ui, "Stamps", &mut tip.part, &PicturePart::ALL));
    }
    sliders(ui, brush);
    actions.extend(color(ui, context, brush));
    ui.collapsing("Stamps", |ui| {
        stamps(ui, brush);
        fade(ui, context, curve, brush);
        variations(ui, brush);
    });
    ui.collapsing("Symmetry", |ui| symmetry(ui, brush));
    ui.collapsing("Limits and hand", |ui| limits(ui, brush));
    ui.collapsing("Stencil", |ui| actions.extend(stencil::show(ui, context)));
    ui.collapsing("Pen", |ui| pen::show(ui, context, brush));
    actions
}

/// Settings that only some actions or areas have.
fn details(ui: &mut Ui, brush: &mut BrushChoices) {
    if brush.action == BrushAction::Clone {
        ui.horizontal(|ui| choice(ui, "Copies", &mut brush.copy_of, &CopyOf::ALL))
            .response
            .on_hover_text(match brush.copy_of {
                CopyOf::Paint => "Paint of this node",
                CopyOf::Input => {
                    "The result that is connected to From, as it lies at each place; a click with Ctrl takes another place, \
                     beside the model none"
                }
            });
    }
    match brush.area {
        _ if brush.action.adjusts() => {}
        Area::Side => {
            let slider = Slider::new(&mut brush.side_degrees, 1.0..=120.0)
                .suffix("°")
                .text("Edge");
            ui.add(slider)
                .on_hover_text("The side ends at edges that bend by more than this");
        }
        Area::Similar => {
            ui.add(Slider::new(&mut brush.tolerance, 0.0..=1.0).text("Tolerance"))
                .on_hover_text("Fills up to where the paint of this node differs by more than this");
        }
        _ => {}
    }
}

fn sliders(ui: &mut Ui, brush: &mut BrushChoices) {
    let size = if brush.is_on_screen {
        Slider::new(&mut brush.points, POINTS).suffix(" pt")
    } else {
        Slider::new(&mut brush.size, SIZES)
    };
    let rows: [(&str, &str, Slider<'_>); 6] = [
        (
            "Size",
            "Radius, as a share of the model or on the screen. Keys [ and ], or a drag with Ctrl and the right button",
            size.logarithmic(true),
        ),
        (
            "Hardness",
            "Share of the radius that is painted in full",
            Slider::new(&mut brush.hardness, 0.0..=1.0),
        ),
        (
            "Flow",
            "Below 1 a stroke builds up where it passes again",
            Slider::new(&mut brush.flow, 0.01..=1.0),
        ),
        (
            "Opacity",
            "The most that one stroke lays",
            Slider::new(&mut brush.opacity, 0.0..=1.0),
        ),
        ("Value", "What the mask gets", Slider::new(&mut brush.value, 0.0..=1.0)),
        (
            "Height",
            "Height that strokes add, as a share of the model; below 0 they carve. Connect the output Height",
            Slider::new(&mut brush.height, HEIGHTS),
        ),
    ];
    for (name, doc, slider) in rows {
        ui.add(slider.text(name)).on_hover_text(doc);
    }
}

/// The color, an eyedropper, and the colors that were painted last.
fn color(ui: &mut Ui, context: &ViewContext<'_>, brush: &mut BrushChoices) -> Vec<Action> {
    let mut actions = Vec::new();
    ui.horizontal(|ui| {
        color_button(ui, &mut brush.color);
        ui.label("Color").on_hover_text("Connect the output Color");
        let is_taking = context.looks.color_target == Some(ColorTarget::Brush);
        let dropper = ui.add(Button::new(icon::EYEDROPPER).selected(is_taking));
        let name = "Take the color of the brush from the model";
        dropper.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, name));
        if dropper.on_hover_text(name).clicked() {
            actions.push(Action::Paint(PaintAction::TakeColor));
        }
        for color in &context.settings.brush_colors {
            let (rect, response) = ui.allocate_exact_size(vec2(COLOR_SIDE, COLOR_SIDE), Sense::click());
            let [red, green, blue] = *color;
            let shown = Color32::from(Rgba::from_rgb(red, green, blue));
            ui.painter().rect_filled(rect, 2.0, shown);
            let outline = ui.visuals().widgets.noninteractive.bg_stroke;
            ui.painter().rect_stroke(rect, 2.0, outline, StrokeKind::Inside);
            if response.on_hover_text("A color that was painted before").clicked() {
                brush.color = *color;
            }
        }
    });
    actions
}

/// A sample of a linear color, which opens a picker.
fn color_button(ui: &mut Ui, color: &mut [f32; 3]) {
    let [red, green, blue] = *color;
    let shown = Color32::from(Rgba::from_rgb(red, green, blue));
    let sample = ui.add(
        Button::new("")
            .fill(shown)
            .min_size(vec2(2.0 * COLOR_SIDE, ui.spacing().interact_size.y)),
    );
    sample.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::ColorButton, true, "Color of the brush"));
    let popup = Popup::menu(&sample).close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    popup.show(|ui| {
        // A gray has no hue, so the picker's own is kept while it gives this color.
        let kept_as = ui.id().with("picked");
        let kept = ui.data(|data| data.get_temp::<Hsva>(kept_as));
        let kept = kept.filter(|kept| kept.to_rgb() == *color);
        let mut picked = kept.unwrap_or_else(|| Hsva::from_rgb(*color)); // Another color than the last picked one.
        if picker(ui, &mut picked) {
            *color = picked.to_rgb();
            ui.data_mut(|data| data.insert_temp(kept_as, picked));
        }
        if kept.is_some() && ui.input(|input| input.pointer.primary_released()) {
            remember_color(ui.ctx(), shown);
        }
    });
}

/// Distance between stamps, their turn, and their fade.
fn stamps(ui: &mut Ui, brush: &mut BrushChoices) {
    ui.add(
        Slider::new(&mut brush.spacing, SPACINGS)
            .logarithmic(true)
            .text("Spacing"),
    )
    .on_hover_text("Way between two stamps, in radii");
    ui.add(
        Slider::new(&mut brush.angle_degrees, -180.0..=180.0)
            .suffix("°")
            .text("Turn"),
    )
    .on_hover_text("Turn of the tip, counter-clockwise");
    ui.horizontal(|ui| {
        choice(ui, "Follows", &mut brush.turn, &TipDirection::ALL);
        let drawn = Fade::Curve(brush.fade.curve());
        let fades: Vec<_> = Fade::ALL.into_iter().chain([(drawn, "Curve")]).collect();
        choice(ui, "Fades", &mut brush.fade, &fades);
    });
}

/// The curve by which the brush fades, if it is drawn.
fn fade(ui: &mut Ui, context: &ViewContext<'_>, memory: &mut CurveMemory, brush: &mut BrushChoices) {
    let Fade::Curve(curve) = brush.fade else { return };
    ui.weak("From the hard part to the border");
    let points = curve.points();
    let changed = curve_ui(ui, context.theme, memory, "Fade", FadeCurve::ROOM, &points);
    if let Some(points) = changed {
        brush.fade = Fade::Curve(FadeCurve::new(points));
    }
}

/// Random differences between stamps.
fn variations(ui: &mut Ui, brush: &mut BrushChoices) {
    ui.add(Slider::new(&mut brush.jitter.place, 0.0..=4.0).text("Scatter"))
        .on_hover_text("How far stamps lie from the way, in radii");
    ui.add(Slider::new(&mut brush.jitter.size, 0.0..=1.0).text("Size varies"));
    ui.add(
        Slider::new(&mut brush.jitter.angle_degrees, 0.0..=180.0)
            .suffix("°")
            .text("Turn varies"),
    );
    ui.add(Slider::new(&mut brush.jitter.flow, 0.0..=1.0).text("Flow varies"));
    for (name, share, most) in [
        ("Hue varies", &mut brush.jitter.hue, 0.5),
        ("Saturation varies", &mut brush.jitter.saturation, 1.0),
        ("Brightness varies", &mut brush.jitter.value, 1.0),
    ] {
        ui.add(Slider::new(share, 0.0..=most).text(name));
    }
}

fn symmetry(ui: &mut Ui, brush: &mut BrushChoices) {
    ui.horizontal(|ui| {
        ui.label("Mirror");
        for (mirror, axis) in brush.symmetry.mirrors.iter_mut().zip(["X", "Y", "Z"]) {
            ui.toggle_value(mirror, axis)
                .on_hover_text(format!("Copies strokes to the other side along {axis}"));
        }
    });
    ui.add(Slider::new(&mut brush.symmetry.turns, 0..=24).text("Copies around"))
        .on_hover_text("Copies strokes around the upright axis");
}

/// Settings of the places that strokes change, and of how the brush follows the pointer.
fn limits(ui: &mut Ui, brush: &mut BrushChoices) {
    ui.add(
        Slider::new(&mut brush.limits.angle_degrees, 10.0..=180.0)
            .suffix("°")
            .text("Angle"),
    )
    .on_hover_text("Leaves places alone that face another way than the surface under the brush; 180° for none");
    ui.checkbox(&mut brush.limits.front_only, "Front only")
        .on_hover_text("Leaves places alone that face away from you, and those seen edge-on");
    ui.checkbox(&mut brush.limits.seen_only, "Only what is seen")
        .on_hover_text("Leaves places alone that something hides from you");
    ui.checkbox(&mut brush.stays_on_piece, "Stay on the piece")
        .on_hover_text("Strokes do not go on to other pieces nearby, such as the next board");
    ui.add(Slider::new(&mut brush.lag, LAGS).text("String"))
        .on_hover_text("Length of a string on which the pointer pulls the brush, in points: it smooths the hand");
    ui.checkbox(&mut brush.is_on_screen, "Size on the screen")
        .on_hover_text("Strokes are as wide on the screen, from near and far");
}
