//! Rows of layers: visibility, pictures of the layer and its mask, title and opacity.

use egui::{
    Align2, Color32, FontId, Key, Rect, Response, RichText, Sense, Stroke, StrokeKind, TextureId, Ui, Vec2, WidgetInfo,
    WidgetType, pos2, vec2,
};
use egui_phosphor::regular as icon;
use sabi_editing::command::{LayerCommand, NodeCommand};
use sabi_editing::exposed_knobs;
use sabi_editing::stack::Layer;
use sabi_graph::Value;

use super::LayerRename;
use crate::action::Action;
use crate::context::ViewContext;
use crate::knobs::{KnobEvent, KnobRow, ParamMask, knob_inline, select_all};
use crate::shown_results::result_of;
use crate::theme::{Theme, space, type_size};

/// Height of a row.
const HEIGHT: f32 = 48.0;
/// Side lengths of the pictures of a layer and of its mask, points.
const PICTURE: f32 = 40.0;
const MASK: f32 = 26.0;
/// Width of a sign that can be clicked.
const SIGN: f32 = 24.0;

/// Change that a row requests.
pub(super) enum RowChange {
    Toggle,
    Opacity(f64),
    Remove,
}

/// Shows a layer. Returns the response that drags begin with.
pub(super) fn show(
    ui: &mut Ui,
    context: &ViewContext<'_>,
    layer: &Layer,
    command_for: impl Fn(RowChange) -> LayerCommand,
    renaming: &mut Option<LayerRename>,
    actions: &mut Vec<Action>,
) -> Response {
    let (document, theme) = (context.document, context.theme);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::click_and_drag());
    // A row also counts as selected while its mask is, as during painting on the mask.
    let is_mask_selected = layer
        .mask
        .as_ref()
        .is_some_and(|mask| document.selection().contains(&mask.node));
    let is_selected = document.selection().contains(&layer.node) || is_mask_selected;
    response.widget_info(|| WidgetInfo::selected(WidgetType::SelectableLabel, true, is_selected, &layer.title));
    let fill = match (is_selected, response.hovered()) {
        (true, _) => theme.raised.lerp_to_gamma(theme.accent, 0.25),
        (false, true) => theme.hovered,
        (false, false) => theme.raised,
    };
    ui.painter().rect_filled(rect, space::CORNER, fill);
    let mut room = rect.shrink(4.0);
    let eye = sign(
        ui,
        theme,
        left(&mut room, SIGN),
        if layer.is_muted { icon::EYE_SLASH } else { icon::EYE },
        layer,
    );
    eye.widget_info(|| {
        let name = format!("Show {}", layer.title);
        WidgetInfo::selected(WidgetType::Checkbox, true, !layer.is_muted, name)
    });
    if eye.on_hover_text("Hides or shows the layer").clicked() {
        actions.push(Action::edit(command_for(RowChange::Toggle)));
    }
    let tint = Color32::from_white_alpha(if layer.is_muted { 90 } else { 255 });
    let own = context.node_picture(&layer.node);
    picture(ui, theme, left(&mut room, PICTURE), own, tint);
    if let Some(mask) = &layer.mask {
        left(&mut room, space::TIGHT);
        let place = left(&mut room, MASK);
        let place = Align2::CENTER_CENTER.align_size_within_rect(Vec2::splat(MASK), place);
        let shown = context.result_picture(&result_of(document, &mask.node, mask.port.clone()));
        picture(ui, theme, place, shown, tint);
        mask_of(ui, context, layer, place, actions);
    }
    left(&mut room, space::USUAL);
    end(ui, theme, layer, &mut room, &command_for, actions);
    name_and_opacity(ui, context, layer, room, &command_for, renaming, actions);
    if response.double_clicked() {
        *renaming = Some(LayerRename::of(layer));
    } else if response.clicked() {
        actions.push(Action::Select(vec![layer.node.clone()]));
        actions.push(Action::Show {
            node: layer.node.clone(),
            port: None,
        });
    }
    response
}

/// Cuts a width off the left.
fn left(room: &mut Rect, width: f32) -> Rect {
    let (taken, rest) = room.split_left_right_at_x((room.left() + width).min(room.right()));
    *room = rest;
    taken
}

fn sign(ui: &Ui, theme: &Theme, rect: Rect, sign: &str, layer: &Layer) -> Response {
    let response = ui.interact(rect, ui.id().with((sign, &layer.node)), Sense::click());
    let color = if response.hovered() { theme.text } else { theme.quiet };
    let font = FontId::proportional(type_size::HEADING);
    ui.painter()
        .text(rect.center(), Align2::CENTER_CENTER, sign, font, color);
    response
}

fn picture(ui: &Ui, theme: &Theme, rect: Rect, picture: Option<TextureId>, tint: Color32) {
    ui.painter().rect_filled(rect, space::CORNER, theme.background);
    if let Some(picture) = picture {
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        ui.painter().image(picture, rect, whole, tint);
    }
}

/// Selects the node of the mask on a click.
fn mask_of(ui: &Ui, context: &ViewContext<'_>, layer: &Layer, rect: Rect, actions: &mut Vec<Action>) {
    let Some(mask) = &layer.mask else { return };
    let title = context.document.title(&mask.node);
    let response = ui.interact(rect, ui.id().with(("mask", &layer.node)), Sense::click());
    let is_selected = context.document.selection().contains(&mask.node);
    response.widget_info(|| {
        WidgetInfo::selected(
            WidgetType::Button,
            true,
            is_selected,
            format!("Mask of {}", layer.title),
        )
    });
    if is_selected || response.hovered() {
        let line = Stroke::new(if is_selected { 2.0 } else { 1.0 }, context.theme.accent);
        ui.painter().rect_stroke(rect, space::CORNER, line, StrokeKind::Inside);
    }
    if response.on_hover_text(format!("Mask: {title}")).clicked() {
        actions.push(Action::Select(vec![mask.node.clone()]));
        actions.push(Action::Show {
            node: mask.node.clone(),
            port: mask.port.clone(),
        });
    }
}

/// Shows the button that removes the layer, or the reason why it cannot be removed.
fn end(
    ui: &Ui,
    theme: &Theme,
    layer: &Layer,
    room: &mut Rect,
    command_for: &impl Fn(RowChange) -> LayerCommand,
    actions: &mut Vec<Action>,
) {
    let (rest, place) = room.split_left_right_at_x((room.right() - SIGN).max(room.left()));
    *room = rest;
    match &layer.shared {
        Some(why) => {
            let lock = sign(ui, theme, place, icon::LOCK_SIMPLE, layer);
            lock.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, why));
            lock.on_hover_text(why);
        }
        None => {
            let bin = sign(ui, theme, place, icon::TRASH, layer);
            let name = format!("Remove {}", layer.title);
            bin.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &name));
            if bin
                .on_hover_text("Removes the layer and connects its neighbors")
                .clicked()
            {
                actions.push(Action::edit(command_for(RowChange::Remove)));
            }
        }
    }
}

fn name_and_opacity(
    ui: &mut Ui,
    context: &ViewContext<'_>,
    layer: &Layer,
    room: Rect,
    command_for: &impl Fn(RowChange) -> LayerCommand,
    renaming: &mut Option<LayerRename>,
    actions: &mut Vec<Action>,
) {
    let theme = context.theme;
    let knob = context
        .document
        .interface(&layer.node)
        .and_then(|interface| interface.knob("opacity"));
    let bar = knob.zip(layer.opacity).filter(|_| layer.opacity.is_some());
    let (name, below) = match bar {
        Some(_) => room.split_top_bottom_at_y(room.center().y - 2.0),
        None => (room, room),
    };
    let color = if layer.is_muted { theme.quiet } else { theme.text };
    let text = RichText::new(&layer.title).color(color);
    let label = egui::Label::new(text)
        .truncate()
        .selectable(false)
        .sense(Sense::hover());
    if renaming.as_ref().is_some_and(|open| open.node == layer.node) {
        let builder = egui::UiBuilder::new().max_rect(name).id_salt(("name", &layer.node));
        actions.extend(name_field(&mut ui.new_child(builder), renaming));
    } else {
        let mut within = ui.new_child(egui::UiBuilder::new().max_rect(name));
        within.horizontal_centered(|ui| ui.add(label));
    }
    let Some((knob, opacity)) = bar else { return };
    let value = Value::Number(opacity);
    let row = KnobRow {
        knob,
        value: Some(&value),
        wired: None,
        mask: ParamMask::NotTaken,
        exposed: exposed_knobs::exposed_as(context.document, &layer.node, "opacity"),
        differs: false,
    };
    let builder = egui::UiBuilder::new()
        .max_rect(below.shrink2(vec2(0.0, 1.0)))
        .id_salt(("opacity", &layer.node));
    // Drawn in a child, so that its contents do not change the place of the next row.
    let events = knob_inline(&mut ui.new_child(builder), theme, &row, below.width(), 0.85);
    for event in events {
        actions.push(match event {
            KnobEvent::Set { value, .. } => match value.as_number() {
                Some(opacity) => Action::edit(command_for(RowChange::Opacity(opacity))),
                None => continue,
            },
            event => Action::Knob {
                node: layer.node.clone(),
                event,
            },
        });
    }
}

/// Field for the name of a layer. Returns the action that renames it.
fn name_field(ui: &mut Ui, renaming: &mut Option<LayerRename>) -> Option<Action> {
    let open = renaming.as_mut()?;
    let field = ui.add(egui::TextEdit::singleline(&mut open.title).desired_width(f32::INFINITY));
    field.widget_info(|| WidgetInfo::labeled(WidgetType::TextEdit, true, "Name of the layer"));
    if std::mem::take(&mut open.is_new) {
        field.request_focus();
        select_all(&field, &open.title);
    }
    if !field.lost_focus() {
        return None;
    }
    let is_canceled = ui.input(|input| input.key_pressed(Key::Escape));
    let LayerRename { node, title, .. } = renaming.take()?;
    let name = title.trim().to_owned();
    (!is_canceled).then(|| Action::edit(NodeCommand::Rename { node, name }))
}
