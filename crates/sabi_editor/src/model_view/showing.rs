//! Menus that choose the subject of the viewport, and its title on the picture.

use egui::text::{LayoutJob, TextWrapping};
use egui::{Align2, FontId, Pos2, Rect, Sense, Ui, WidgetInfo, WidgetType, vec2};
use egui_phosphor::regular as icon;
use sabi_engine::paint::Action as BrushAction;

use super::{ModelView, Subject};
use crate::action::{Action, LookAction};
use crate::command::{BrushCommand, Command, LookCommand, ViewportCommand};
use crate::evaluation::Evaluation;
use crate::settings::brush::Hand;
use crate::theme::{Theme, space, type_size};

/// Height of a hint over the titles at the foot, points: under the menus it would lie on them where the view is narrow.
const HINT: f32 = 24.0;

/// Menu that chooses what the model shows.
pub(super) fn menu(view: &ModelView, ui: &mut Ui, subject: &Subject<'_>, actions: &mut Vec<Action>) {
    let showing = subject.showing;
    let is_compared = view.comparison.share.is_some();
    let is_pinned = showing.pinned.is_some() && !is_compared;
    let mut choice = |ui: &mut Ui, is_on: bool, text: String, meant: LookAction| {
        if ui.selectable_label(is_on, text).clicked() {
            actions.push(Action::Look(meant));
        }
    };
    choice(
        ui,
        !showing.follows && !is_pinned,
        "Outputs".to_owned(),
        LookAction::Outputs,
    );
    choice(
        ui,
        showing.follows && !is_pinned,
        "Follow the node that is clicked".to_owned(),
        LookAction::Follow,
    );
    if let Some(pinned) = &showing.pinned {
        choice(ui, is_pinned, format!("Pinned: {pinned}"), LookAction::UnpinFrom3d);
    }
    match &showing.clicked {
        clicked if *clicked == showing.pinned && clicked.is_some() => {}
        Some(clicked) => choice(ui, false, format!("Pin {clicked}"), LookAction::PinIn3d),
        None => drop(ui.weak("Click a node to pin it")),
    }
    ui.separator();
    match showing.pinned.as_ref().or(showing.clicked.as_ref()) {
        Some(other) => choice(ui, is_compared, format!("Compare with {other}"), LookAction::Compare),
        None if is_compared => choice(ui, true, "Compare".to_owned(), LookAction::Compare),
        None => drop(ui.weak("Click a node to compare with it")),
    }
    ui.separator();
    for command in [
        Command::Look(LookCommand::Follow),
        Command::Look(LookCommand::Pin),
        Command::Look(LookCommand::Compare),
    ] {
        ui.weak(format!("{}  {}", subject.keys.shown(command), command.title()));
    }
}

/// Menu of viewpoints, each with its key.
pub(super) fn viewpoints(ui: &mut Ui, subject: &Subject<'_>, actions: &mut Vec<Action>) {
    ui.set_min_width(200.0);
    for command in [
        Command::Viewport(ViewportCommand::ShowAll),
        Command::Viewport(ViewportCommand::Front),
        Command::Viewport(ViewportCommand::Right),
        Command::Viewport(ViewportCommand::Top),
        Command::Viewport(ViewportCommand::Lens),
    ] {
        let keys = subject.keys.shown(command);
        let entry = ui.add(egui::Button::new(command.title()).shortcut_text(keys));
        entry.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, command.title()));
        if entry.clicked() {
            actions.push(Action::Do(command));
        }
    }
    let look = subject.keys.shown(Command::Viewport(ViewportCommand::Focus));
    ui.weak(format!("{look}  {}", Command::Viewport(ViewportCommand::Focus).title()));
}

/// Writes on the picture what it shows; of two pictures, on either side of the line between them.
pub(super) fn label(view: &ModelView, ui: &Ui, rect: Rect, evaluation: &Evaluation, subject: &Subject<'_>) {
    let showing = subject.showing;
    let theme = subject.theme;
    if evaluation.model.received.is_none() {
        return;
    }
    let state = match &showing.fault {
        Some(fault) => format!(" — {fault}"),
        None if evaluation.results.picture(subject.shown).is_none() => " (evaluating)".to_owned(),
        None if view.pictures.is_loading() => " (preparing)".to_owned(),
        None => String::new(),
    };
    let text = format!("{}{state}", showing.text);
    let row = rect.bottom() - 10.0;
    match (&showing.other, view.comparison.share) {
        (Some(other), Some(share)) => {
            let at = Pos2::new(rect.left() + share * rect.width(), row);
            let beside = vec2(space::USUAL, 0.0);
            let [one, other] = [format!("A  {text}"), format!("B  {other}")];
            caption(ui, theme, "shown", at - beside, Align2::RIGHT_CENTER, &one);
            caption(ui, theme, "compared", at + beside, Align2::LEFT_CENTER, &other);
        }
        _ => {
            let at = Pos2::new(rect.right() - 10.0, row);
            caption(ui, theme, "shown", at, Align2::RIGHT_CENTER, &text);
        }
    }
    if let Some(painted) = subject.painted {
        let keys = subject.keys.shown(Command::Brush(BrushCommand::Paint));
        let ctrl = match painted.brush.action {
            _ if painted.brush.used_hand() == Hand::Path => "Click knots, drag to bend, Enter ends the path",
            _ if painted.brush.used_hand().edges().is_some() => "Click an edge of the model",
            BrushAction::Clone => "Ctrl takes the place to copy from",
            BrushAction::Erase => "Ctrl paints",
            BrushAction::Paint | BrushAction::Smear | BrushAction::Blur | BrushAction::Sharpen => "Ctrl erases",
        };
        let text = format!(
            "{} Painting on {}. {ctrl}, Alt turns the model, {keys} ends.",
            icon::PAINT_BRUSH,
            painted.title
        );
        let at = Pos2::new(rect.center().x, row - HINT);
        caption(ui, theme, "brush", at, Align2::CENTER_CENTER, &text);
    }
    if subject.is_picking_color {
        let text = format!("{} Click the color to take. Escape cancels.", icon::EYEDROPPER);
        let at = Pos2::new(rect.center().x, row - HINT);
        caption(ui, theme, "eyedropper", at, Align2::CENTER_CENTER, &text);
    }
}

/// Writes a caption on a picture, which cannot be clicked. With an id of its own, it does not change the ids of the widgets
/// beside it. Returns its place.
pub(super) fn caption(ui: &Ui, theme: &Theme, name: &str, at: Pos2, align: Align2, text: &str) -> Rect {
    let font = FontId::proportional(type_size::SMALL);
    let mut job = LayoutJob::simple_singleline(text.to_owned(), font, theme.text);
    job.wrap = TextWrapping::truncate_at_width((ui.clip_rect().width() - 2.0 * space::USUAL).max(1.0));
    let galley = ui.painter().layout_job(job);
    let place = align.anchor_size(at, galley.size());
    let ground = place.expand2(vec2(4.0, 2.0));
    ui.painter()
        .rect_filled(ground, space::CORNER, theme.background.gamma_multiply(0.6));
    ui.painter().galley(place.min, galley, theme.text);
    let response = ui.interact(place, ui.id().with(("caption", name)), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, text));
    place
}
