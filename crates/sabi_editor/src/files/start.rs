//! The start page: recent graphs, examples, and graphs that were not saved when the program last ended.

use super::examples::EXAMPLES;
use super::recovery_list::RecoveryList;
use crate::action::{Action, FileAction, Next};
use crate::command::{Command, FileCommand};
use crate::context::{View, ViewContext};
use crate::paths::file_stem;
use crate::saved_pictures::OF_GRAPH;
use crate::theme::{Theme, space, type_size};
use egui::epaint::RectShape;
use egui::{
    Align2, Color32, ColorImage, Context, FontId, Id, Modal, Rect, RichText, Sense, TextureHandle, TextureId,
    TextureOptions, Ui, Vec2, pos2, vec2,
};
use egui_phosphor::regular as icon;
use sabi_engine::catalog::small_picture;

/// Height of a card without and with a picture, and side of a picture, points.
const HEIGHT: f32 = 44.0;
const WITH_PICTURE: f32 = 60.0;
const PICTURE: f32 = 52.0;
/// Pixels along a side of a picture.
const PIXELS: u32 = 104;

/// The start page.
pub(crate) struct StartPage {
    pub(crate) is_open: bool,
    /// Pictures of the examples, in their order, once the page was shown.
    examples: Vec<Option<TextureHandle>>,
    recovery_list: RecoveryList,
}

impl StartPage {
    pub(crate) fn new(is_open: bool) -> StartPage {
        StartPage {
            is_open,
            examples: Vec::new(),
            recovery_list: RecoveryList::default(),
        }
    }

    fn load_pictures(&mut self, context: &Context) {
        if self.examples.is_empty() {
            let loaded = EXAMPLES.iter().map(|example| {
                let picture = small_picture(example.picture, PIXELS)?;
                let size = picture.size.map(|side| side as usize);
                let image = ColorImage::from_rgba_unmultiplied(size, &picture.rgba);
                Some(context.load_texture(example.title, image, TextureOptions::LINEAR))
            });
            self.examples = loaded.collect();
        }
    }
}

impl View for StartPage {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let mut actions = Vec::new();
        let modal = Modal::new(Id::new("start")).show(ui.ctx(), |ui| {
            ui.set_width(720.0);
            title(ui, context.theme);
            ui.add_space(space::WIDE);
            let recovered = self.recovery_list.show(ui, context, &mut actions);
            self.load_pictures(ui.ctx());
            self.cards(ui, context).or(recovered)
        });
        let should_close = modal.should_close();
        if let Some(chosen) = modal.inner {
            self.is_open = false;
            actions.push(chosen);
        }
        self.is_open &= !should_close;
        actions
    }
}

fn title(ui: &mut Ui, theme: &Theme) {
    ui.horizontal(|ui| {
        let sign = RichText::new(icon::DIAMONDS_FOUR);
        ui.label(sign.color(theme.accent).size(type_size::TITLE));
        ui.label(RichText::new("Sabi").size(type_size::TITLE));
        ui.colored_label(theme.quiet, "materials that age, on real models");
    });
}

impl StartPage {
    /// Shows cards of graphs that can be opened. Returns the action of the clicked one.
    fn cards(&self, ui: &mut Ui, context: &ViewContext<'_>) -> Option<Action> {
        let theme = context.theme;
        let open = |next: Next| Some(Action::File(FileAction::Ask(next)));
        let mut chosen = None;
        ui.columns(2, |columns| {
            let [left, right] = columns else { return };
            left.strong("New");
            if card(left, theme, "Empty graph", "Begin with nothing but a model", None) {
                chosen = open(Next::New);
            }
            if card(left, theme, "Open…", "A graph of yours", None) {
                chosen = Some(Action::Do(Command::File(FileCommand::Open)));
            }
            left.add_space(space::USUAL);
            let recent = &context.settings.recent;
            if !recent.is_empty() {
                left.strong("Recent");
            }
            for path in recent.iter().take(5) {
                let picture = context.pictures.find(left.ctx(), path, OF_GRAPH);
                if card(left, theme, &file_stem(path), &path.display().to_string(), picture) {
                    chosen = open(Next::Open(path.clone()));
                }
            }
            right.strong("Examples");
            for (at, example) in EXAMPLES.iter().enumerate() {
                let picture = self.examples.get(at).and_then(Option::as_ref);
                if card(
                    right,
                    theme,
                    example.title,
                    example.says,
                    picture.map(TextureHandle::id),
                ) {
                    chosen = open(Next::Example(at));
                }
            }
        });
        chosen
    }
}

/// Shows a card with a title, a sentence and perhaps a picture. Returns whether it was clicked.
fn card(ui: &mut Ui, theme: &Theme, title: &str, says: &str, picture: Option<TextureId>) -> bool {
    let height = if picture.is_some() { WITH_PICTURE } else { HEIGHT };
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, title));
    let fill = if response.hovered() || response.has_focus() {
        theme.hovered
    } else {
        theme.raised
    };
    let painter = ui.painter().with_clip_rect(rect);
    painter.rect_filled(rect, space::CORNER, fill);
    let mut left = 12.0;
    if let Some(picture) = picture {
        let place = Rect::from_center_size(rect.left_center() + vec2(WITH_PICTURE / 2.0, 0.0), Vec2::splat(PICTURE));
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        painter.add(RectShape::filled(place, space::CORNER, Color32::WHITE).with_texture(picture, whole));
        left = WITH_PICTURE + space::USUAL;
    }
    let middle = rect.center().y - rect.top();
    let text = |y: f32, text: &str, size: f32, color: Color32| {
        painter.text(
            rect.left_top() + vec2(left, y),
            Align2::LEFT_TOP,
            text,
            FontId::proportional(size),
            color,
        );
    };
    text(middle - 16.0, title, type_size::BODY, theme.text);
    text(middle + 2.0, says, type_size::SMALL, theme.quiet);
    response.clicked()
}
