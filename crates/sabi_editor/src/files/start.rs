//! The start page: recent graphs, examples, and graphs that were not saved when the program last ended.

use super::examples::EXAMPLES;
use super::recovery_list::RecoveryList;
use crate::action::{Action, FileAction, Next};
use crate::command::{Command, FileCommand, WindowCommand};
use crate::context::{View, ViewContext};
use crate::paths::file_stem;
use crate::saved_pictures::OF_GRAPH;
use crate::theme::{Theme, space, type_size};
use egui::epaint::RectShape;
use egui::text::LayoutJob;
use egui::{
    Align2, Color32, ColorImage, Context, FontId, Id, Modal, Rect, RichText, ScrollArea, Sense, TextureHandle,
    TextureId, TextureOptions, Ui, Vec2, pos2, vec2,
};
use egui_phosphor::regular as icon;
use sabi_engine::catalog::small_picture;

/// Height of a card without and with a picture, and side of a picture, points.
const HEIGHT: f32 = 44.0;
const WITH_PICTURE: f32 = 60.0;
const PICTURE: f32 = 52.0;
/// Width of the page, and margin above and below it, points.
const WIDTH: f32 = 720.0;
const MARGIN: f32 = 40.0;
/// Time in which a click on a card chooses nothing after an offer of unsaved work has moved the cards, seconds: it may have
/// been aimed at what was there before.
const AFTER_MOVE: f64 = 0.6;
/// Pixels along a side of a picture.
const PIXELS: u32 = 104;

/// The start page.
pub(crate) struct StartPage {
    pub(crate) is_open: bool,
    /// Pictures of the examples, in their order, once the page was shown.
    examples: Vec<Option<TextureHandle>>,
    recovery_list: RecoveryList,
    /// Number of offers of unsaved work, and time since when there are so many, seconds; `None` until the page was shown.
    offers: Option<(usize, f64)>,
    /// True if a chosen graph opens with the model and its parameters only; `None` until the page was shown.
    opens_use_view: Option<bool>,
}

impl StartPage {
    pub(crate) fn new(is_open: bool) -> StartPage {
        StartPage {
            is_open,
            examples: Vec::new(),
            recovery_list: RecoveryList::default(),
            offers: None,
            opens_use_view: None,
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
            ui.set_width(WIDTH);
            // On a small screen, or with many graphs to recover, the page is higher than the screen.
            let most = ui.ctx().content_rect().height() - 2.0 * MARGIN;
            // The window of the page has the height of its last frame, which must not limit it.
            let page = ScrollArea::vertical().max_height(most).min_scrolled_height(most);
            page.show(ui, |ui| self.page(ui, context, &mut actions)).inner
        });
        let should_close = modal.should_close();
        if let Some(chosen) = modal.inner {
            self.is_open = false;
            actions.push(chosen);
            let opens_use_view = self.opens_use_view.take();
            if opens_use_view.is_some_and(|opens| opens != context.is_use_view) {
                actions.push(Action::Do(Command::Window(WindowCommand::UseView)));
            }
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
    /// Shows the contents of the page. Returns the requested action.
    fn page(&mut self, ui: &mut Ui, context: &ViewContext<'_>, actions: &mut Vec<Action>) -> Option<Action> {
        title(ui, context.theme);
        ui.add_space(space::WIDE);
        let recovered = self.recovery_list.show(ui, context, actions);
        self.load_pictures(ui.ctx());
        let is_still = self.is_still(context.recoveries.len(), ui.input(|input| input.time));
        let chosen = self.cards(ui, context).filter(|_| is_still).or(recovered);
        ui.add_space(space::USUAL);
        let opens_use_view = self.opens_use_view.get_or_insert(context.is_use_view);
        let switch = ui.checkbox(opens_use_view, Command::Window(WindowCommand::UseView).title());
        switch.on_hover_text("For those who use a material and do not change its graph");
        chosen
    }

    /// Returns whether the cards stand where they stood a moment ago, with this number of offers of unsaved work above them.
    fn is_still(&mut self, offer_count: usize, now: f64) -> bool {
        let (known, since) = *self.offers.get_or_insert((offer_count, f64::NEG_INFINITY));
        if known != offer_count {
            self.offers = Some((offer_count, now));
            return false;
        }
        now - since > AFTER_MOVE
    }

    /// Shows cards of graphs that can be opened. Returns the action of the clicked one.
    fn cards(&self, ui: &mut Ui, context: &ViewContext<'_>) -> Option<Action> {
        let theme = context.theme;
        let open = |next: Next| Some(Action::File(FileAction::Ask(next)));
        let mut chosen = None;
        ui.columns(2, |columns| {
            let [left, right] = columns else { return };
            left.strong("New");
            if card(
                left,
                theme,
                "Empty graph",
                "Begin with nothing but a model",
                PicturePlace::None,
            ) {
                chosen = open(Next::New);
            }
            if card(left, theme, "Open…", "A graph of yours", PicturePlace::None) {
                chosen = Some(Action::Do(Command::File(FileCommand::Open)));
            }
            left.add_space(space::USUAL);
            let recent = &context.settings.recent;
            if !recent.is_empty() {
                left.strong("Recent");
            }
            for path in recent.iter().take(5) {
                let picture = context.pictures.find(left.ctx(), path, OF_GRAPH);
                if card(
                    left,
                    theme,
                    &file_stem(path),
                    &path.display().to_string(),
                    PicturePlace::with(picture),
                ) {
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
                    PicturePlace::with(picture.map(TextureHandle::id)),
                ) {
                    chosen = open(Next::Example(at));
                }
            }
        });
        chosen
    }
}

/// Place for a picture on a card.
#[derive(Clone, Copy, PartialEq)]
enum PicturePlace {
    /// The card has none.
    None,
    /// Without a picture yet: an icon stands there, so that the texts of all cards line up.
    Free,
    Of(TextureId),
}

impl PicturePlace {
    fn with(picture: Option<TextureId>) -> PicturePlace {
        picture.map_or(PicturePlace::Free, PicturePlace::Of)
    }
}

/// Shows a card with a title, a sentence and perhaps a picture. Returns whether it was clicked.
fn card(ui: &mut Ui, theme: &Theme, title: &str, whole: &str, picture: PicturePlace) -> bool {
    let has_place = picture != PicturePlace::None;
    let height = if has_place { WITH_PICTURE } else { HEIGHT };
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
    if has_place {
        let place = Rect::from_center_size(rect.left_center() + vec2(WITH_PICTURE / 2.0, 0.0), Vec2::splat(PICTURE));
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        if let PicturePlace::Of(picture) = picture {
            painter.add(RectShape::filled(place, space::CORNER, Color32::WHITE).with_texture(picture, whole));
        } else {
            painter.rect_filled(place, space::CORNER, theme.panel);
            let font = FontId::proportional(type_size::TITLE);
            painter.text(place.center(), Align2::CENTER_CENTER, icon::GRAPH, font, theme.quiet);
        }
        left = WITH_PICTURE + space::USUAL;
    }
    let width = rect.width() - left - space::USUAL;
    let line = |text: &str, size: f32, color: Color32, rows: usize| {
        let mut job = LayoutJob::simple(text.to_owned(), FontId::proportional(size), color, width);
        job.wrap.max_rows = rows;
        // A path has no spaces to break at.
        job.wrap.break_anywhere = rows == 1;
        painter.layout_job(job)
    };
    let rows = if has_place { 2 } else { 1 };
    let title = line(title, type_size::BODY, theme.text, 1);
    let says = line(whole, type_size::SMALL, theme.quiet, rows);
    let is_cut = says.elided;
    let top = rect.center().y - (title.size().y + says.size().y) / 2.0;
    let at = pos2(rect.left() + left, top);
    let below = at + vec2(0.0, title.size().y);
    painter.galley(at, title, theme.text);
    painter.galley(below, says, theme.quiet);
    let response = if is_cut {
        response.on_hover_text(whole)
    } else {
        response
    };
    response.clicked()
}

#[cfg(test)]
mod tests {
    use super::StartPage;

    #[test]
    fn cards_are_not_chosen_just_after_an_offer_of_unsaved_work_has_moved_them() {
        let mut page = StartPage::new(true);
        assert!(page.is_still(1, 10.0), "the page opens with it");
        assert!(!page.is_still(2, 11.0) && !page.is_still(2, 11.5));
        assert!(page.is_still(2, 11.7));
        assert!(!page.is_still(1, 12.0), "a discarded offer moves them back");
    }
}
