//! The inside of a node: title, port names, first parameters, and a picture of its result.

use egui::{Align2, Color32, CornerRadius, FontId, Rect, Sense, Shape, Stroke, StrokeKind, Ui, UiBuilder, pos2, vec2};
use egui_phosphor::regular as icon;
use sabi_editing::node_size::{MARGIN, NODE_WIDTH, PICTURE_SIDE, ROW_HEIGHT, TITLE_HEIGHT};

use super::node_summary::{NodeSummary, RowContext};
use crate::knobs::{KnobRow, ParamMask, is_inline_menu_asked, knob_inline};
use crate::notices::with_capital;
use crate::theme::{Theme, space, type_size};
use crate::time_text::time_text;

/// Margin that the canvas crate leaves to the left and right of a node's contents.
const SIDE: f32 = 15.0;
/// Margin that it leaves above and below the title.
const ABOVE: f32 = 5.0;
/// Room that it leaves for its buttons, which are switched off.
const BUTTONS: f32 = 20.0;
/// Width of a node's contents.
const INNER: f32 = NODE_WIDTH - 2.0 * SIDE;

/// Draws a node's title as wide as the node, which gives all nodes the same width.
pub(super) fn title_row(ui: &mut Ui, row_context: &RowContext, shown: &NodeSummary) {
    let zoom = row_context.zoom;
    let size = vec2(INNER, TITLE_HEIGHT - 2.0 * ABOVE) * zoom;
    // Drawn in place of the crate's own label, which is empty; the crate adds the room for its buttons after it.
    let rect = Rect::from_min_size(pos2(ui.min_rect().left(), ui.max_rect().top()), size);
    ui.allocate_rect(
        Rect::from_min_size(rect.min, size - vec2(BUTTONS, 0.0) * zoom),
        Sense::hover(),
    );
    let rect = rect.expand2(vec2(SIDE - 8.0, 0.0) * zoom);
    let theme = &row_context.theme;
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

/// Text in one line, with an ellipsis where it is too long.
pub(super) fn elided(ui: &Ui, text: &str, font: FontId, width: f32, color: Color32) -> std::sync::Arc<egui::Galley> {
    let mut job = egui::text::LayoutJob::simple_singleline(text.to_owned(), font, color);
    job.wrap = egui::text::TextWrapping::truncate_at_width(width.max(1.0));
    ui.painter().layout_job(job)
}

/// Sign at the end of a title: muted, faulty or waiting, or else the time of the evaluation.
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

/// Draws the name of a port beside its dot.
pub(super) fn port_row(ui: &mut Ui, row_context: &RowContext, name: &str, is_input: bool) {
    let zoom = row_context.zoom;
    let (rect, _) = ui.allocate_exact_size(vec2(INNER, ROW_HEIGHT) * zoom, Sense::hover());
    let font = FontId::proportional(type_size::SMALL * zoom);
    let (at, align) = match is_input {
        true => (rect.left_center(), Align2::LEFT_CENTER),
        false => (rect.right_center(), Align2::RIGHT_CENTER),
    };
    ui.painter().text(at, align, name, font, row_context.theme.quiet);
}

/// Draws a parameter that is changed on the node itself.
pub(super) fn knob_row(ui: &mut Ui, row_context: &mut RowContext, shown: &NodeSummary, at: usize) {
    let zoom = row_context.zoom;
    // Allocated first, since ports are placed by rows, whose height must not depend on their contents.
    let (rect, _) = ui.allocate_exact_size(vec2(INNER, ROW_HEIGHT) * zoom, Sense::hover());
    let Some(knob) = shown.interface.knobs.get(at) else {
        return;
    };
    let theme = row_context.theme.clone();
    let row = KnobRow {
        knob,
        value: shown.values.get(&knob.name),
        wired: None,
        mask: match shown.masks.get(&knob.name) {
            Some(mask) => ParamMask::Of(mask),
            None if shown.interface.param_mask(&knob.name).is_some() => ParamMask::Unlinked,
            None => ParamMask::NotTaken,
        },
        exposed: shown.exposed.get(&knob.name).map(String::as_str),
        differs: false,
    };
    row_context.has_asked_for_menu |= is_inline_menu_asked(ui, rect, zoom);
    let inside = UiBuilder::new().id_salt((&shown.id, &knob.name)).max_rect(rect);
    let events = knob_inline(&mut ui.new_child(inside), &theme, &row, rect.width(), zoom);
    let events = events.into_iter().map(|event| (shown.id.clone(), event));
    row_context.knob_events.extend(events);
}

/// Draws the picture of the result, or the error.
pub(super) fn picture_row(ui: &mut Ui, row_context: &RowContext, shown: &NodeSummary) {
    if !shown.rows.shows_picture() {
        return;
    }
    let zoom = row_context.zoom;
    ui.add_space(MARGIN * zoom);
    let (rect, _) = ui.allocate_exact_size(vec2(INNER, PICTURE_SIDE) * zoom, Sense::hover());
    let wide = rect.expand2(vec2(SIDE - MARGIN, 0.0) * zoom);
    picture(ui, &row_context.theme, shown, wide, zoom);
}

/// Draws the picture in a rectangle.
pub(super) fn picture(ui: &Ui, theme: &Theme, shown: &NodeSummary, rect: Rect, zoom: f32) {
    let corner = CornerRadius::same(space::CORNER);
    ui.painter().rect_filled(rect, corner, theme.background);
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
            .rect_filled(rect, corner, theme.background.gamma_multiply(0.85));
        ui.painter()
            .rect_stroke(rect, corner, Stroke::new(1.0, color), StrokeKind::Inside);
        let inner = rect.shrink(space::TIGHT * zoom);
        let font = FontId::proportional(type_size::SMALL * zoom);
        let text = ui.painter().layout(with_capital(sentence), font, color, inner.width());
        ui.painter()
            .with_clip_rect(inner.intersect(ui.clip_rect()))
            .galley(inner.min, text, color);
    } else if shown.is_previewed {
        ui.painter()
            .rect_stroke(rect, corner, Stroke::new(1.5, theme.accent), StrokeKind::Inside);
    }
}

/// Background of a node: body, title strip, and an outline for selected and faulty nodes.
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
    let category = theme.category(shown.interface.category());
    let fill = if shown.is_muted { theme.panel } else { theme.raised };
    let outline = match (is_selected, &shown.state.fault) {
        (true, _) => Stroke::new(2.0, theme.accent),
        (false, Some(_)) => Stroke::new(1.5, theme.fault),
        (false, None) => Stroke::new(1.0, theme.background),
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
