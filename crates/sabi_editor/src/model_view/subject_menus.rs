//! Menus that choose the subject of the viewport, and its title on the picture.

use egui::text::{LayoutJob, TextWrapping};
use egui::{Align, Align2, FontId, Pos2, Rect, Sense, Ui, Vec2, WidgetInfo, WidgetType, vec2};
use egui_phosphor::regular as icon;
use sabi_paint::Action as BrushAction;

use super::{ModelView, Subject};
use crate::action::{Action, LookAction};
use crate::command::{BrushCommand, Command, LookCommand, ViewportCommand};
use crate::evaluation::Evaluation;
use crate::settings::brush::Hand;
use crate::theme::{Theme, space, type_size};

/// Height of a hint above the titles at the lower edge, in points. At the top it would cover the menus of a narrow
/// view.
const HINT: f32 = 24.0;
/// Border of the ground of a caption, points.
const GROUND: Vec2 = vec2(4.0, 2.0);
/// Least width of a caption beside the line between two pictures, points.
const LEAST_SIDE: f32 = 40.0;

/// Menu that chooses the subject that the model shows.
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

/// Writes the title of the shown result on the picture; of two pictures, on either side of the line between them.
pub(super) fn label(view: &mut ModelView, ui: &Ui, rect: Rect, evaluation: &Evaluation, subject: &Subject<'_>) {
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
    let within = rect.shrink(space::TIGHT);
    let row = rect.bottom() - 10.0;
    match (&showing.other, view.comparison.share) {
        (Some(other), Some(share)) => {
            let line = rect.left() + share * rect.width();
            let sides = [
                ("shown", line - space::USUAL, Align2::RIGHT_CENTER, format!("A  {text}")),
                (
                    "compared",
                    line + space::USUAL,
                    Align2::LEFT_CENTER,
                    format!("B  {other}"),
                ),
            ];
            for (name, x, align, text) in sides {
                // Where the line is near an edge, there is no room beside it.
                let at = Pos2::new(x, row);
                let place = CaptionPlace { at, align, within };
                if room_of(&place) >= LEAST_SIDE {
                    view.captions.write(ui, theme, name, &place, &text);
                }
            }
        }
        _ => {
            let place = CaptionPlace {
                at: Pos2::new(rect.right() - 10.0, row),
                align: Align2::RIGHT_CENTER,
                within,
            };
            view.captions.write(ui, theme, "shown", &place, &text);
        }
    }
    if let Some((name, text)) = hint(subject) {
        let place = CaptionPlace {
            at: Pos2::new(rect.center().x, row - HINT),
            align: Align2::CENTER_CENTER,
            within,
        };
        view.captions.write(ui, theme, name, &place, &text);
    }
}

/// Sentence about the effect that a drag or a click on the model has now, with the name of its caption.
fn hint(subject: &Subject<'_>) -> Option<(&'static str, String)> {
    if subject.is_picking_color {
        let text = format!("{} Click the color to take. Escape cancels.", icon::EYEDROPPER);
        return Some(("eyedropper", text));
    }
    let painted = subject.painted?;
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
    Some(("brush", text))
}

/// Captions that were written on the pictures in this frame, none of which covers another.
#[derive(Default)]
pub(super) struct Captions {
    placed: Vec<Rect>,
}

/// Place of a caption.
pub(super) struct CaptionPlace {
    pub(super) at: Pos2,
    pub(super) align: Align2,
    /// Part of the view that it may take; a longer text is cut off.
    pub(super) within: Rect,
}

impl Captions {
    /// Forgets the captions of the last frame.
    pub(super) fn begin_frame(&mut self) {
        self.placed.clear();
    }

    /// Writes a caption on a picture, which cannot be clicked: at its place, or above the captions that are there already.
    /// With an id of its own, it does not change the ids of the widgets beside it. Returns its place.
    pub(super) fn write(&mut self, ui: &Ui, theme: &Theme, name: &str, place: &CaptionPlace, text: &str) -> Rect {
        let font = FontId::proportional(type_size::SMALL);
        let mut job = LayoutJob::simple_singleline(text.to_owned(), font, theme.text);
        let room = room_of(place) - 2.0 * GROUND.x;
        job.wrap = TextWrapping::truncate_at_width(room.max(1.0));
        let galley = ui.painter().layout_job(job);
        let at = self.free(place.align.anchor_size(place.at, galley.size()));
        ui.painter()
            .rect_filled(at.expand2(GROUND), space::CORNER, theme.background.gamma_multiply(0.6));
        ui.painter().galley(at.min, galley, theme.text);
        let response = ui.interact(at, ui.id().with(("caption", name)), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, text));
        at
    }

    /// First place above a wanted one that covers no caption. It is taken from then on.
    pub(super) fn free(&mut self, wanted: Rect) -> Rect {
        let mut place = wanted;
        let covered = |place: Rect, placed: &[Rect]| {
            let ground = place.expand2(GROUND);
            let found = placed.iter().find(|taken| taken.expand2(GROUND).intersects(ground));
            found.copied()
        };
        while let Some(taken) = covered(place, &self.placed) {
            let above = taken.top() - 3.0 * GROUND.y - place.bottom();
            place = place.translate(vec2(0.0, above));
        }
        self.placed.push(place);
        place
    }
}

/// Width that a caption may have so that it stays in its part of the view.
fn room_of(place: &CaptionPlace) -> f32 {
    let [left, right] = [place.at.x - place.within.left(), place.within.right() - place.at.x];
    match place.align.x() {
        Align::Min => right,
        Align::Max => left,
        Align::Center => 2.0 * left.min(right),
    }
}

#[cfg(test)]
mod tests {
    use egui::pos2;

    use super::*;

    #[test]
    fn captions_at_one_place_are_drawn_above_each_other() {
        let mut captions = Captions::default();
        let at = |left: f32, width: f32| Rect::from_min_size(pos2(left, 100.0), vec2(width, 12.0));
        let wanted = [at(0.0, 200.0), at(150.0, 100.0), at(180.0, 40.0), at(400.0, 50.0)];
        let placed = wanted.map(|rect| captions.free(rect));
        assert_eq!(placed[0], wanted[0]);
        assert_eq!(placed[3], wanted[3], "nothing is there");
        assert!(placed[1].bottom() < placed[0].top() && placed[2].bottom() < placed[1].top());
        for (index, one) in placed.iter().enumerate() {
            let others = &placed[index + 1..];
            assert!(
                others
                    .iter()
                    .all(|other| !one.expand2(GROUND).intersects(other.expand2(GROUND)))
            );
        }
    }

    #[test]
    fn a_caption_is_as_wide_as_its_part_of_the_view_allows() {
        let within = Rect::from_min_max(pos2(100.0, 0.0), pos2(400.0, 50.0));
        let room = |x: f32, align: Align2| {
            let at = pos2(x, 40.0);
            room_of(&CaptionPlace { at, align, within })
        };
        assert_eq!(room(300.0, Align2::RIGHT_CENTER), 200.0);
        assert_eq!(room(300.0, Align2::LEFT_CENTER), 100.0);
        assert_eq!(room(300.0, Align2::CENTER_CENTER), 200.0);
    }
}
