//! The brush and the strokes of the selected paint node.

use std::sync::Arc;

use egui::{ComboBox, Label, ScrollArea, Slider, Ui, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use sabi_editing::command::PaintCommand;
use sabi_editing::painting::{PAINT, strokes_on};
use sabi_engine::paint::{Action as BrushAction, Area, Step, Stroke, Tip};
use sabi_graph::NodeId;

use crate::action::{Action, PaintAction};
use crate::command::{BrushCommand, Command};
use crate::context::ViewContext;
use crate::settings::brush::{BrushChoices, HEIGHTS, SIZES, SPACINGS};

/// Shows the brush and the strokes of a paint node; nothing for other nodes, and for several.
pub(super) fn show(ui: &mut Ui, context: &ViewContext<'_>, id: &NodeId) -> Vec<Action> {
    let document = context.document;
    let is_paint = document.node(id).is_some_and(|node| node.kind == PAINT);
    if !is_paint || document.selection().len() != 1 {
        return Vec::new();
    }
    let mut actions = Vec::new();
    let key = context.keys.shown(Command::Brush(BrushCommand::Paint));
    let is_painting = context.looks.is_painting;
    let toggle = ui.selectable_label(is_painting, format!("{} Paint on the model", icon::PAINT_BRUSH));
    if toggle.on_hover_text(format!("Drags paint ({key})")).clicked() {
        actions.push(Action::Do(Command::Brush(BrushCommand::Paint)));
    }
    let brush = sliders(ui, &context.settings.brush);
    if brush != context.settings.brush {
        actions.push(Action::Paint(PaintAction::Choose(brush)));
    }
    actions.extend(strokes(ui, context, id));
    actions
}

/// The brush; returns it as it is after this frame.
fn sliders(ui: &mut Ui, brush: &BrushChoices) -> BrushChoices {
    let mut brush = brush.clone();
    ui.horizontal(|ui| {
        ui.selectable_value(&mut brush.erases, false, format!("{} Paint", icon::PENCIL_SIMPLE));
        ui.selectable_value(&mut brush.erases, true, format!("{} Erase", icon::ERASER))
            .on_hover_text("Ctrl erases while it is held");
    });
    ui.horizontal(|ui| {
        let mut tip = brush.tip;
        choice(ui, "Tip", &mut tip, &Tip::ALL);
        if tip != brush.tip {
            brush = brush.with_tip(tip);
        }
        choice(ui, "Fills", &mut brush.area, &Area::ALL);
    });
    let rows: [(&str, &str, Slider<'_>); 5] = [
        (
            "Size",
            "Radius, as a share of the model. Keys: [ and ]",
            Slider::new(&mut brush.size, SIZES).logarithmic(true),
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
    ];
    for (name, doc, slider) in rows {
        ui.add(slider.text(name)).on_hover_text(doc);
    }
    ui.add(Slider::new(&mut brush.height, HEIGHTS).text("Height"))
        .on_hover_text(
            "Height that strokes add, as a share of the model; below 0 they carve. Connect the output Height",
        );
    ui.horizontal(|ui| {
        ui.color_edit_button_rgb(&mut brush.color);
        ui.label("Color").on_hover_text("Connect the output Color");
    });
    ui.collapsing("Stamps and symmetry", |ui| more(ui, &mut brush));
    brush
}

fn choice<T: PartialEq + Copy>(ui: &mut Ui, name: &str, chosen: &mut T, all: &[(T, &str)]) {
    let title = all
        .iter()
        .find(|(one, _)| one == chosen)
        .map_or("", |(_, title)| *title); // Every value is in its list.
    ui.label(name);
    ComboBox::from_id_salt(name)
        .selected_text(title)
        .width(84.0)
        .show_ui(ui, |ui| {
            for (one, title) in all {
                ui.selectable_value(chosen, *one, *title);
            }
        });
}

/// Sliders that are moved less often: the way between stamps, their differences, and copies on other sides.
fn more(ui: &mut Ui, brush: &mut BrushChoices) {
    ui.add(
        Slider::new(&mut brush.spacing, SPACINGS)
            .logarithmic(true)
            .text("Spacing"),
    )
    .on_hover_text("Way between two stamps, in radii");
    ui.add(Slider::new(&mut brush.jitter.place, 0.0..=4.0).text("Scatter"))
        .on_hover_text("How far stamps lie from the way, in radii");
    ui.add(Slider::new(&mut brush.jitter.size, 0.0..=1.0).text("Size varies"));
    ui.add(
        Slider::new(&mut brush.jitter.angle_degrees, 0.0..=180.0)
            .suffix("°")
            .text("Turn varies"),
    );
    ui.add(Slider::new(&mut brush.jitter.flow, 0.0..=1.0).text("Flow varies"));
    ui.horizontal(|ui| {
        ui.label("Mirror");
        for (mirror, axis) in brush.symmetry.mirrors.iter_mut().zip(["X", "Y", "Z"]) {
            ui.toggle_value(mirror, axis)
                .on_hover_text(format!("Copies strokes to the other side along {axis}"));
        }
    });
    ui.add(Slider::new(&mut brush.symmetry.turns, 0..=24).text("Copies around"))
        .on_hover_text("Copies strokes around the upright axis");
    ui.checkbox(&mut brush.presses_size, "Pressure changes the size")
        .on_hover_text("The pressure of a pen always changes the strength");
    ui.checkbox(&mut brush.stays_on_piece, "Stay on the piece")
        .on_hover_text("Strokes do not go on to other pieces nearby, such as the next board");
}

/// The strokes on the shown model, the topmost first.
fn strokes(ui: &mut Ui, context: &ViewContext<'_>, id: &NodeId) -> Vec<Action> {
    let Some(model) = &context.evaluation.model.received else {
        return Vec::new();
    };
    let linked = &model.linked;
    let name = &linked.model.stem;
    let list = strokes_on(context.document, id, name);
    let count = list.as_ref().map_or(0, |list| list.strokes.len());
    let mut actions = Vec::new();
    ui.collapsing(format!("Strokes on {name}: {count}"), |ui| {
        let Some(list) = list else {
            ui.weak("Nothing is painted on this model yet.");
            return;
        };
        let height = ui.spacing().interact_size.y;
        let area = ScrollArea::vertical().id_salt("strokes").max_height(180.0);
        area.show_rows(ui, height, count, |ui, rows| {
            for index in rows.map(|row| count - 1 - row) {
                let stroke = &list.strokes[index];
                let step = ui.push_id(stroke.id.0, |ui| row(ui, context, index, stroke, linked.largest_side));
                actions.extend(step.inner.map(|(title, step)| {
                    Action::Paint(PaintAction::Change(PaintCommand::Step {
                        node: id.clone(),
                        model: name.clone(),
                        title: title.to_owned(),
                        step: Box::new(step),
                    }))
                }));
            }
        });
    });
    actions
}

/// One stroke; returns the step that its buttons ask for.
fn row(
    ui: &mut Ui,
    context: &ViewContext<'_>,
    index: usize,
    stroke: &Arc<Stroke>,
    largest_side: f64,
) -> Option<(&'static str, Step)> {
    let changed = |is_hidden: bool, brush: &sabi_engine::paint::Brush| Step::Change {
        stroke: stroke.id,
        name: stroke.name.clone(),
        brush: Box::new(brush.clone()),
        is_hidden,
    };
    let mut done = None;
    ui.horizontal(|ui| {
        let mut button = |ui: &mut Ui, icon: &str, name: &str, step: (&'static str, Step)| {
            let button = ui.small_button(icon);
            button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, name));
            if button.on_hover_text(name).clicked() {
                done = Some(step);
            }
        };
        let (eye, name) = match stroke.is_hidden {
            true => (icon::EYE_SLASH, "Show the stroke"),
            false => (icon::EYE, "Hide the stroke"),
        };
        button(ui, eye, name, (name, changed(!stroke.is_hidden, &stroke.brush)));
        let brush = context.settings.brush.brush(largest_side);
        let name = "Give it the present brush";
        button(
            ui,
            icon::PAINT_BRUSH,
            name,
            ("Brush of a stroke", changed(stroke.is_hidden, &brush)),
        );
        button(
            ui,
            icon::TRASH,
            "Remove the stroke",
            ("Remove a stroke", Step::Remove(vec![stroke.id])),
        );
        let what = match stroke.action {
            BrushAction::Paint => "Stroke",
            BrushAction::Erase => "Eraser",
            BrushAction::Smear => "Smear",
            BrushAction::Blur => "Blur",
            BrushAction::Sharpen => "Sharpening",
            BrushAction::Clone => "Clone",
        };
        ui.add(Label::new(format!("{what} {}", index + 1)).truncate());
    });
    done
}
