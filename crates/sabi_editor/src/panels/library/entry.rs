//! One entry of the library: a click adds it in the middle of the canvas, a drag where it is dropped.

use egui::epaint::RectShape;
use egui::{
    Align2, Color32, FontId, Key, Pos2, Rect, Response, RichText, Sense, TextureId, Ui, Vec2, WidgetInfo, WidgetType,
    pos2, vec2,
};
use egui_phosphor::regular as icon;
use sabi_engine::catalog::Interface;

use super::entry_pictures::PictureSize;
use crate::action::{Action, SettingAction};
use crate::command::{Command, Favorite};
use crate::context::ViewContext;
use crate::panels::picture_tooltip;
use crate::search::Candidate;
use crate::theme::{Theme, space, type_size};

/// Heights of entries without and with a picture.
const HEIGHT: f32 = 22.0;
const WITH_PICTURE: f32 = 40.0;
/// Width of the star and the key.
const STAR: f32 = 34.0;

/// One entry of the library.
pub(super) struct LibraryEntry<'a> {
    pub(super) candidate: &'a Candidate,
    /// Its place among the favorites.
    pub(super) number: Option<usize>,
    /// True if it has a picture, loaded or not.
    pub(super) has_picture: bool,
    /// Its picture, once it is loaded.
    pub(super) picture: &'a dyn Fn(PictureSize) -> Option<TextureId>,
}

/// Outputs of an entry, each with its dot in the list.
fn outputs(ui: &mut Ui, interface: &Interface, theme: &Theme) {
    if interface.outputs.is_empty() {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        let word = |text: &str| RichText::new(text).size(type_size::SMALL).color(theme.quiet);
        ui.label(word("Gives"));
        for port in &interface.outputs {
            let (place, _) = ui.allocate_exact_size(Vec2::splat(6.0), Sense::hover());
            ui.painter().circle_filled(place.center(), 3.0, theme.port(port.ty));
            ui.label(word(&port.label));
        }
    });
}

impl LibraryEntry<'_> {
    /// Shows the entry and returns the requested action.
    pub(super) fn show(&self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let mut actions = Vec::new();
        let Candidate { new, interface, .. } = self.candidate;
        let height = if self.has_picture { WITH_PICTURE } else { HEIGHT };
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &interface.label));
        let star = rect.with_max_x(rect.left() + STAR);
        let star = ui.interact(star, response.id.with("star"), Sense::CLICK);
        star.widget_info(|| {
            let name = format!("{} is a favorite", interface.label);
            WidgetInfo::selected(WidgetType::Checkbox, true, self.number.is_some(), name)
        });
        if ui.is_rect_visible(rect) {
            self.paint(ui, context, rect, response.hovered(), star.hovered());
        }
        let (at, is_canceled) = ui.input(|input| (input.pointer.latest_pos(), input.key_pressed(Key::Escape)));
        if response.drag_started() {
            // Keys that follow the drag are not for the search field.
            ui.memory_mut(egui::Memory::stop_text_input);
        }
        if response.clicked() {
            actions.push(Action::AddInMiddle(new.clone()));
        } else if let Some(at) = at.filter(|_| response.dragged()) {
            let interface = interface.clone();
            actions.push(Action::DragNew { interface, at });
        } else if let Some(at) = at.filter(|_| response.drag_stopped() && !is_canceled) {
            let (new, interface) = (new.clone(), interface.clone());
            actions.push(Action::DropNew { new, interface, at });
        }
        if !response.dragged() {
            self.show_beside(&response, context);
        }
        let tooltip = match self.number {
            Some(_) => "Remove from the favorites",
            None => "A favorite; the first nine are added by the keys 1 to 9",
        };
        if star.on_hover_text(tooltip).clicked() {
            // A favorite that was stored under a key of an earlier version is removed by that key.
            let known = self.number.and_then(|number| context.settings.favorites.get(number));
            let key = known.unwrap_or(&self.candidate.favorite).clone();
            actions.push(Action::Setting(SettingAction::ToggleFavorite(key)));
        }
        actions
    }

    /// Describes the entry beside the list while the pointer rests on it: with a large picture, its name, its effect,
    /// and the words that it is found by.
    fn show_beside(&self, response: &Response, context: &ViewContext<'_>) {
        let interface = &self.candidate.interface;
        let picture = || (self.picture)(PictureSize::Large).or_else(|| (self.picture)(PictureSize::Small));
        let picture: Option<&dyn Fn() -> Option<TextureId>> = match self.has_picture {
            true => Some(&picture),
            false => None,
        };
        picture_tooltip::show(response, context.theme, picture, |ui| {
            ui.strong(&interface.label);
            ui.label(&interface.summary);
            outputs(ui, interface, context.theme);
            if !interface.aliases.is_empty() {
                let words = RichText::new(interface.aliases.join(", ")).size(type_size::SMALL);
                ui.label(words.color(context.theme.quiet));
            }
        });
    }

    fn paint(&self, ui: &Ui, context: &ViewContext<'_>, rect: Rect, is_hovered: bool, is_on_star: bool) {
        let theme = context.theme;
        let painter = ui.painter();
        if is_hovered || is_on_star {
            painter.rect_filled(rect, space::CORNER, theme.raised);
        }
        let write = |at: Pos2, align: Align2, text: &str, size: f32, color: Color32| {
            painter.text(at, align, text, FontId::proportional(size), color)
        };
        let star = match (self.number.is_some(), is_on_star) {
            (true, _) => Some(theme.accent),
            (false, true) => Some(theme.quiet),
            (false, false) => None,
        };
        if let Some(color) = star {
            let at = pos2(rect.left() + 4.0, rect.center().y);
            write(at, Align2::LEFT_CENTER, icon::STAR, type_size::BODY, color);
        }
        let favorite = self.number.and_then(|number| Favorite::ALL.get(number));
        if let Some(favorite) = favorite {
            let at = pos2(rect.left() + 20.0, rect.center().y);
            let keys = context.keys.shown(Command::Favorite(*favorite));
            write(at, Align2::LEFT_CENTER, &keys, type_size::SMALL, theme.quiet);
        }
        let mut left = rect.left() + STAR;
        let interface = &self.candidate.interface;
        if self.has_picture {
            let place = Rect::from_min_size(pos2(left, rect.top() + 2.0), Vec2::splat(WITH_PICTURE - 4.0));
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            painter.add(match (self.picture)(PictureSize::Small) {
                Some(picture) => RectShape::filled(place, space::CORNER, Color32::WHITE).with_texture(picture, whole),
                None => RectShape::filled(place, space::CORNER, theme.raised),
            });
            left = place.right() + space::USUAL;
        } else {
            let mark = Rect::from_center_size(pos2(left + 3.0, rect.center().y), vec2(4.0, 12.0));
            painter.rect_filled(mark, 2.0, theme.category(interface.category()));
            left += 12.0;
        }
        let at = pos2(left, rect.center().y);
        write(at, Align2::LEFT_CENTER, &interface.label, type_size::BODY, theme.text);
        for (at, port) in interface.outputs.iter().take(4).enumerate() {
            let center = pos2(rect.right() - 10.0 - 10.0 * at as f32, rect.center().y);
            painter.circle_filled(center, 3.0, theme.port(port.ty));
        }
    }
}
