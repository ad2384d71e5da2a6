//! What stands in a node: its title, the names of its ports, its first knobs, and a picture of its result.

use egui::{Align2, Color32, CornerRadius, FontId, Rect, Sense, Shape, Stroke, StrokeKind, Ui, UiBuilder, pos2, vec2};
use egui_phosphor::regular as icon;
use sabi_editing::{MARGIN, NODE_WIDTH, PICTURE_SIDE, ROW_HEIGHT, TITLE_HEIGHT};

use super::shown::{Hand, NodeSummary};
use crate::knobs::{KnobRow, knob_inline};
use crate::theme::{Theme, space, type_size};
use crate::time_text::time_text;

/// What the canvas crate leaves free to the left and right of what a node holds.
const SIDE: f32 = 15.0;
/// What it leaves free above the title, and again below it.
const ABOVE: f32 = 5.0;
/// What it leaves free for its buttons, which are switched off.
const BUTTONS: f32 = 20.0;
/// Width of what a node holds.
const INNER: f32 = NODE_WIDTH - 2.0 * SIDE;

/// A node's title, as wide as the node, so that all nodes are.
pub(super) fn title_row(ui: &mut Ui, hand: &Hand, shown: &NodeSummary) {
    let zoom = hand.zoom;
    let size = vec2(INNER, TITLE_HEIGHT - 2.0 * ABOVE) * zoom;
    // The crate's own label is empty, and this begins where it would have; after it the crate leaves room for its buttons.
    let rect = Rect::from_min_size(pos2(ui.min_rect().left(), ui.max_rect().top()), size);
    ui.allocate_rect(
        Rect::from_min_size(rect.min, size - vec2(BUTTONS, 0.0) * zoom),
        Sense::hover(),
    );
    let rect = rect.expand2(vec2(SIDE - 8.0, 0.0) * zoom);
    let theme = &hand.theme;
    let badge = badge(shown).map(|(text, color)| (text, color.unwrap_or(theme.text.gamma_multiply(0.75))));
    let pin = shown.is_pinned.then(|| (icon::PUSH_PIN.to_owned(), theme.text));
    let mut right = rect.right();
    for (text, color) in [badge, pin].into_iter().flatten() {
        let font = FontId::proportional(type_size::SMALL * zoom);
        let at = pos2(right, rect.center().y);
        let drawn = ui.painter().text(at, Align2::RIGHT_CENTER, text, font, color);
        right = drawn.left() - space::TIGHT * zoom;
    }
    let font = FontId::proportional(type_size::BODY * zoom);
    let color = if shown.is_muted {
        theme.text.gamma_multiply(0.55)
    } else {
        theme.text
    };
    let title = elided(ui, &shown.title, font, right - rect.left(), color);
    let at = pos2(rect.left(), rect.center().y - title.size().y / 2.0);
    ui.painter().galley(at, title, color);
}

/// A text in one line, cut where there is no room.
pub(super) fn elided(ui: &Ui, text: &str, font: FontId, width: f32, color: Color32) -> std::sync::Arc<egui::Galley> {
    let mut job = egui::text::LayoutJob::simple_singleline(text.to_owned(), font, color);
    job.wrap = egui::text::TextWrapping::truncate_at_width(width.max(1.0));
    ui.painter().layout_job(job)
}

/// What stands at the end of a title: that it is muted, at fault or waits, or how long it took.
fn badge(shown: &NodeSummary) -> Option<(String, Option<Color32>)> {
    if shown.is_muted {
        return Some((icon::SPEAKER_SIMPLE_SLASH.to_owned(), None));
    }
    let state = &shown.state;
    if state.fault.is_some() || state.waits.is_some() {
        return Some((icon::WARNING.to_owned(), None));
    }
    state.time.map(|time| (time_text(time), None))
}

/// The name of a port beside its dot.
pub(super) fn port_row(ui: &mut Ui, hand: &Hand, name: &str, is_input: bool) {
    let zoom = hand.zoom;
    let (rect, _) = ui.allocate_exact_size(vec2(INNER, ROW_HEIGHT) * zoom, Sense::hover());
    let font = FontId::proportional(type_size::SMALL * zoom);
    let (at, align) = match is_input {
        true => (rect.left_center(), Align2::LEFT_CENTER),
        false => (rect.right_center(), Align2::RIGHT_CENTER),
    };
    ui.painter().text(at, align, name, font, hand.theme.quiet);
}

/// A knob that is turned on the node itself.
pub(super) fn knob_row(ui: &mut Ui, hand: &mut Hand, shown: &NodeSummary, at: usize) {
    let zoom = hand.zoom;
    // Taken first: rows are as high as they say, whatever is in them, since ports are where rows are.
    let (rect, _) = ui.allocate_exact_size(vec2(INNER, ROW_HEIGHT) * zoom, Sense::hover());
    let Some(knob) = shown.face.knobs.get(at) else { return };
    let theme = hand.theme.clone();
    let row = KnobRow {
        knob,
        value: shown.values.get(&knob.name),
        wired: None,
        exposed: None,
        differs: false,
    };
    let inside = UiBuilder::new().id_salt((&shown.id, &knob.name)).max_rect(rect);
    let events = knob_inline(&mut ui.new_child(inside), &theme, &row, rect.width(), zoom);
    let events = events.into_iter().map(|event| (shown.id.clone(), event));
    hand.knob_events.extend(events);
}

/// The picture of the result, or what is wrong.
pub(super) fn picture_row(ui: &mut Ui, hand: &Hand, shown: &NodeSummary) {
    if shown.face.outputs.is_empty() && shown.face.category() != "output" {
        return;
    }
    let zoom = hand.zoom;
    ui.add_space(MARGIN * zoom);
    let (rect, _) = ui.allocate_exact_size(vec2(INNER, PICTURE_SIDE) * zoom, Sense::hover());
    let wide = rect.expand2(vec2(SIDE - MARGIN, 0.0) * zoom);
    picture(ui, &hand.theme, shown, wide, zoom);
}

/// The picture in its place.
pub(super) fn picture(ui: &Ui, theme: &Theme, shown: &NodeSummary, rect: Rect, zoom: f32) {
    let corner = CornerRadius::same(space::CORNER);
    ui.painter().rect_filled(rect, corner, theme.ground);
    if let Some(picture) = shown.state.picture {
        let square = Rect::from_center_size(rect.center(), egui::Vec2::splat(rect.height().min(rect.width())));
        let tint = match shown.is_muted || shown.state.waits.is_some() {
            true => Color32::from_white_alpha(90),
            false => Color32::WHITE,
        };
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        ui.painter().image(picture, square, whole, tint);
    }
    let said = shown.state.fault.as_ref().map(|fault| (fault, theme.fault));
    let said = said.or(shown.state.waits.as_ref().map(|waits| (waits, theme.warning)));
    if let Some((sentence, color)) = said {
        ui.painter()
            .rect_filled(rect, corner, theme.ground.gamma_multiply(0.85));
        ui.painter()
            .rect_stroke(rect, corner, Stroke::new(1.0, color), StrokeKind::Inside);
        let inner = rect.shrink(space::TIGHT * zoom);
        let font = FontId::proportional(type_size::SMALL * zoom);
        let text = ui.painter().layout(sentence.clone(), font, color, inner.width());
        ui.painter()
            .with_clip_rect(inner.intersect(ui.clip_rect()))
            .galley(inner.min, text, color);
    } else if shown.is_previewed {
        ui.painter()
            .rect_stroke(rect, corner, Stroke::new(1.5, theme.accent), StrokeKind::Inside);
    }
}

/// What is behind a node: body, title strip and, around it, whether it is selected, at fault or muted.
pub(super) fn backdrop(theme: &Theme, shown: &NodeSummary, rect: Rect, zoom: f32, is_selected: bool) -> Shape {
    let radius = (f32::from(space::CORNER + 2) * zoom).clamp(1.0, 12.0) as u8;
    let mut title = rect;
    title.max.y = (rect.min.y + TITLE_HEIGHT * zoom).min(rect.max.y);
    let strip = CornerRadius {
        nw: radius,
        ne: radius,
        sw: 0,
        se: 0,
    };
    let category = theme.category(shown.face.category());
    let fill = if shown.is_muted { theme.panel } else { theme.raised };
    let outline = match (is_selected, &shown.state.fault) {
        (true, _) => Stroke::new(2.0, theme.accent),
        (false, Some(_)) => Stroke::new(1.5, theme.fault),
        (false, None) => Stroke::new(1.0, theme.ground),
    };
    let corner = CornerRadius::same(radius);
    Shape::Vec(vec![
        Shape::rect_filled(
            rect.translate(vec2(0.0, 2.0 * zoom)).expand(1.5 * zoom),
            corner,
            Color32::from_black_alpha(50),
        ),
        Shape::rect_filled(rect, corner, fill),
        Shape::rect_filled(
            title,
            strip,
            if shown.is_muted {
                category.gamma_multiply(0.5)
            } else {
                category
            },
        ),
        Shape::Rect(egui::epaint::RectShape::stroke(
            rect,
            corner,
            outline,
            StrokeKind::Outside,
        )),
    ])
}
