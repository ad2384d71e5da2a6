//! The brush and the strokes of the selected paint node.

mod brush_settings;
mod brush_tips;
mod pen;
mod presets;
mod stencil;
mod strokes;
mod swatches;

use egui::{ComboBox, Response, ScrollArea, Ui};
use egui_phosphor::regular as icon;
use sabi_editing::painting::PAINT;
use sabi_graph::NodeId;

use crate::action::{Action, PaintAction};
use crate::command::{BrushCommand, Command};
use crate::context::ViewContext;
use crate::knobs::CurveMemory;
use presets::PresetName;
use strokes::StrokeRows;
use swatches::Swatches;

/// Height that is left for the parameters of the node, points.
const LEFT: f32 = 64.0;

/// A page of the panel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum PaintingPage {
    #[default]
    Brush,
    Brushes,
    Strokes,
}

/// The brush and the strokes of a paint node.
#[derive(Default)]
pub(super) struct PaintingPanel {
    page: PaintingPage,
    swatches: Swatches,
    rows: StrokeRows,
    preset: PresetName,
    /// Curve by which the brush fades.
    curve: CurveMemory,
    /// Text that is typed for the brush to stamp.
    text: String,
}

impl PaintingPanel {
    /// Shows the brush and the strokes of a paint node; nothing for other nodes, and for several.
    pub(super) fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>, id: &NodeId) -> Vec<Action> {
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
        self.swatches.begin_frame();
        ui.horizontal(|ui| {
            let strokes = format!("Strokes {}", strokes::count(context, id));
            let pages = [
                (PaintingPage::Brush, "Brush"),
                (PaintingPage::Brushes, "Brushes"),
                (PaintingPage::Strokes, &strokes),
            ];
            for (page, title) in pages {
                ui.selectable_value(&mut self.page, page, title);
            }
        });
        let height = (ui.available_height() - LEFT).max(LEFT);
        let area = ScrollArea::vertical().id_salt(self.page as u8).max_height(height);
        let page = area.auto_shrink([false, true]).show(ui, |ui| match self.page {
            PaintingPage::Brush => {
                let chosen = &context.settings.brush;
                let mut brush = chosen.clone();
                let mut actions = brush_settings::show(
                    ui,
                    context,
                    &mut self.swatches,
                    &mut self.text,
                    &mut self.curve,
                    &mut brush,
                );
                if brush != *chosen {
                    actions.push(Action::Paint(PaintAction::Choose(Box::new(brush))));
                }
                actions
            }
            PaintingPage::Brushes => presets::show(ui, context, &mut self.swatches, &mut self.preset),
            PaintingPage::Strokes => self.rows.show(ui, context, &mut self.swatches, id),
        });
        actions.extend(page.inner);
        actions
    }
}

/// Height of the longest list of choices, points.
const LONGEST_LIST: f32 = 400.0;

/// A list from which one of several values is chosen.
fn choice<T: PartialEq + Copy>(ui: &mut Ui, name: &str, chosen: &mut T, all: &[(T, &str)]) -> Response {
    let title = all
        .iter()
        .find(|(one, _)| one == chosen)
        .map_or("", |(_, title)| *title); // Every value is in its list.
    let label = ui.label(name);
    let list = ComboBox::from_id_salt((name, "choice"))
        .selected_text(title)
        .width(84.0)
        // All choices are in view, rather than in a list that scrolls.
        .height(LONGEST_LIST)
        .show_ui(ui, |ui| {
            for (one, title) in all {
                ui.selectable_value(chosen, *one, *title);
            }
        });
    label | list.response
}
