//! The tip of the brush: a picture of a stroke with it, which opens all tips and the artist's own pictures.

use egui::{
    Button, ComboBox, Grid, Image, Key, Popup, PopupCloseBehavior, RichText, ScrollArea, Sense, TextEdit, Ui,
    WidgetInfo, WidgetType, vec2,
};
use egui_phosphor::regular as icon;
use sabi_paint::Tip;

use super::swatches::{SWATCH, Swatches};
use crate::action::{Action, PaintAction};
use crate::context::ViewContext;
use crate::settings::brush::BrushChoices;
use crate::settings::text_font::TextFont;

/// Columns of the list of tips.
const COLUMNS: usize = 3;
/// Height of the list of nodes, points.
const RESULTS_HEIGHT: f32 = 320.0;
/// Largest side of the model that swatches are drawn for, so that they do not depend on the shown model.
const MODEL: f64 = 1.0;

/// Shows the tip, and changes the brush if another one is chosen. `text` is the text to stamp.
pub(super) fn show(
    ui: &mut Ui,
    context: &ViewContext<'_>,
    swatches: &mut Swatches,
    text: &mut String,
    brush: &mut BrushChoices,
) -> Vec<Action> {
    let mut actions = Vec::new();
    let shown = swatches.of(ui, context, &brush.brush(MODEL));
    let size = vec2(ui.available_width(), 1.2 * SWATCH[1] as f32);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let visuals = *ui.style().interact(&response);
    ui.painter().rect_filled(rect, 4.0, ui.visuals().extreme_bg_color);
    if let Some(texture) = shown {
        let place = egui::Rect::from_center_size(rect.center(), vec2(SWATCH[0] as f32, SWATCH[1] as f32));
        Image::new((texture, place.size())).paint_at(ui, place);
    }
    ui.painter()
        .rect_stroke(rect, 4.0, visuals.bg_stroke, egui::StrokeKind::Inside);
    let title = title_of(brush);
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, format!("Tip: {title}")));
    let response = response.on_hover_text(format!("{title}. Click for other tips and pictures of your own"));
    Popup::menu(&response)
        .close_behavior(PopupCloseBehavior::CloseOnClick)
        .show(|ui| {
            list(ui, context, swatches, brush);
            if ui.button(format!("{} A picture of your own…", icon::IMAGE)).clicked() {
                actions.push(Action::Paint(PaintAction::AskForPicture));
            }
            ui.menu_button(format!("{} The result of a node", icon::GRAPH), |ui| {
                actions.extend(results(ui, context));
            })
            .response
            .on_hover_text(
                "Evaluates a node on a square, such as a pattern for a ribbon, and stamps the picture of now",
            );
        });
    if brush.area.is_single() {
        ui.horizontal(|ui| {
            let field = ui.add(
                TextEdit::singleline(text)
                    .hint_text("Text to stamp")
                    .desired_width(150.0),
            );
            let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            let button = ui.add_enabled(!text.trim().is_empty(), Button::new("Use the text"));
            if button.clicked() || (is_entered && !text.trim().is_empty()) {
                actions.push(Action::Paint(PaintAction::TakeText(text.clone())));
            }
        });
        ui.horizontal(|ui| actions.extend(fonts(ui, &context.settings.text_font)));
    }
    actions
}

/// List of the fonts of texts. Returns the action of the chosen one.
fn fonts(ui: &mut Ui, font: &TextFont) -> Option<Action> {
    let mut chosen = None;
    ui.label("Font");
    let list = ComboBox::from_id_salt("font of the text").selected_text(font.title());
    list.width(110.0).truncate().show_ui(ui, |ui| {
        for offered in [TextFont::default(), TextFont::monospace()] {
            if ui.selectable_label(*font == offered, offered.title()).clicked() {
                chosen = Some(PaintAction::ChooseFont(offered));
            }
        }
        if ui.selectable_label(font.file.is_some(), "A font file…").clicked() {
            chosen = Some(PaintAction::AskForFont);
        }
    });
    chosen.map(Action::Paint)
}

/// The nodes of the shown graph, whose results can be stamped.
fn results(ui: &mut Ui, context: &ViewContext<'_>) -> Option<Action> {
    let document = context.document;
    let nodes = document.graph().nodes().map(|(id, _)| id);
    let mut nodes: Vec<_> = nodes
        // The paint node itself has no paint on the square that tips are evaluated on.
        .filter(|id| Some(*id) != document.selected_one())
        .filter(|id| {
            document
                .interface(id)
                .is_some_and(|interface| !interface.outputs.is_empty())
        })
        .map(|id| (document.title(id), id))
        .collect();
    nodes.sort();
    let mut chosen = None;
    ScrollArea::vertical().max_height(RESULTS_HEIGHT).show(ui, |ui| {
        for (title, id) in nodes {
            if ui.button(title).clicked() {
                chosen = Some(Action::Paint(PaintAction::TakeNode(context.looks.chosen(document, id))));
            }
        }
    });
    chosen
}

fn title_of(brush: &BrushChoices) -> &'static str {
    if brush.picture.is_some() {
        return "A picture";
    }
    let mut all = Tip::ALL.iter();
    all.find(|(tip, _)| *tip == brush.tip).map_or("", |(_, title)| title) // All tips are in the list.
}

/// All tips with a stroke of each.
fn list(ui: &mut Ui, context: &ViewContext<'_>, swatches: &mut Swatches, brush: &mut BrushChoices) {
    Grid::new("tips").num_columns(COLUMNS).show(ui, |ui| {
        for (index, (tip, title)) in Tip::ALL.iter().enumerate() {
            let usual = BrushChoices::default().with_tip(*tip);
            ui.vertical(|ui| {
                let size = vec2(SWATCH[0] as f32, SWATCH[1] as f32);
                let is_chosen = brush.picture.is_none() && brush.tip == *tip;
                let clicked = match swatches.of(ui, context, &usual.brush(MODEL)) {
                    Some(texture) => {
                        let button = ui.add(Button::image(Image::new((texture, size))).selected(is_chosen));
                        button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, *title));
                        button.clicked()
                    }
                    None => ui.add_sized(size, Button::new("")).clicked(),
                };
                ui.label(RichText::new(*title).small().color(context.theme.quiet));
                if clicked {
                    *brush = brush.with_tip(*tip);
                }
            });
            if index % COLUMNS == COLUMNS - 1 {
                ui.end_row();
            }
        }
    });
}
