//! Targets of nodes and files that are dragged over the window, and their marks.

use std::path::Path;

use egui::{Align2, CornerRadius, FontId, Id, LayerId, Order, Pos2, Rect, Stroke, StrokeKind, Ui, vec2};
use sabi_editing::dropped_layers::DroppedOn;
use sabi_editing::stack::StackEnd;
use sabi_engine::catalog::Interface;
use sabi_graph::{NodeId, SlotRef};
use sabi_surface::load::MODEL_ENDINGS;

use super::documents::Documents;
use super::shell::Shell;
use crate::dock::Panel;
use crate::evaluation::Evaluation;
use crate::model_view::drop_place::DropPlace;
use crate::paths::{IMAGES, file_name, lowercase_ending};
use crate::shown_results::ShownResults;
use crate::theme::{Theme, space, type_size};
use crate::views::Views;

/// Result of dropping a node at a place.
pub(super) enum DropTarget {
    /// The mask of a layer.
    Mask(NodeId),
    /// A layer of a material of the model.
    Model(DropPlace),
    /// A layer on the material of a node.
    Node(NodeId),
    /// A node on the canvas, inserted into the wire of an input if it is on one.
    Canvas([f32; 2], Option<SlotRef>),
}

/// Distance from the lower edge of a view to a label above its captions, in points.
const ABOVE_CAPTIONS: f32 = 52.0;

/// Targets of a node that is dragged from the library, in all views.
pub(super) struct DropTargets<'a> {
    pub(super) documents: &'a Documents,
    pub(super) evaluation: &'a Evaluation,
    pub(super) looks: &'a ShownResults,
    pub(super) shell: &'a Shell,
    pub(super) views: &'a Views,
}

impl DropTargets<'_> {
    /// Target of a node at a place of the screen; `None` where it cannot be dropped.
    pub(super) fn find(&self, interface: &Interface, at: Pos2) -> Option<DropTarget> {
        let document = &self.documents.document;
        // Hidden panels still have the rectangles of their last frame.
        let is_shown = |panel: Panel| self.shell.dock.is_shown(panel);
        if is_shown(Panel::Stack)
            && let Some(node) = self.views.layers.mask_target(document, interface, at)
        {
            return Some(DropTarget::Mask(node));
        }
        if is_shown(Panel::Viewport) {
            let subject = self.looks.on_model(document, &self.shell.settings);
            let model = &self.views.model;
            if let Some(place) = model.drop_place(document, self.evaluation, &subject, interface, at) {
                return Some(DropTarget::Model(place));
            }
        }
        let canvas = is_shown(Panel::Canvas).then_some(&self.views.canvas)?;
        if let Some(node) = canvas.node_for_dropped(document, interface, at) {
            return Some(DropTarget::Node(node));
        }
        let (place, into) = canvas.place_for_dropped(document, interface, at)?;
        Some(DropTarget::Canvas(place, into))
    }

    /// Marks where a node would be dropped outside of the canvas, with a caption that says what the drop does. The canvas
    /// marks its own targets.
    pub(super) fn mark(&self, ui: &Ui, interface: &Interface, at: Pos2) {
        let document = &self.documents.document;
        let theme = &self.shell.theme;
        match self.find(interface, at) {
            Some(DropTarget::Mask(node)) => {
                if let Some(row) = self.views.layers.row_of(&node) {
                    mark_target(ui, theme, row, &format!("Mask of {}", document.title(&node)));
                }
            }
            Some(DropTarget::Model(place)) => {
                let of = match &place.material {
                    DroppedOn::Output(StackEnd::Node(node)) => document.title(node),
                    DroppedOn::Output(StackEnd::Port(name)) | DroppedOn::Material(name) => name.clone(),
                    DroppedOn::Unknown => "the model".to_owned(),
                };
                if let Some(view) = self.shell.dock.rects.get(&Panel::Viewport) {
                    mark_target(ui, theme, *view, &format!("Layer on {of}"));
                }
            }
            Some(DropTarget::Node(_) | DropTarget::Canvas(..)) | None => {}
        }
    }
}

/// Marks the target of a drag, with a caption that says what a drop does there.
fn mark_target(ui: &Ui, theme: &Theme, place: Rect, words: &str) {
    let layer = LayerId::new(Order::Foreground, Id::new("target of a drop"));
    let painter = ui.ctx().layer_painter(layer);
    painter.rect_filled(
        place,
        CornerRadius::same(space::CORNER),
        theme.accent.gamma_multiply(0.12),
    );
    let line = Stroke::new(2.5, theme.accent);
    painter.rect_stroke(place, CornerRadius::same(space::CORNER), line, StrokeKind::Inside);
    let font = FontId::proportional(type_size::BODY);
    let text = painter.layout_no_wrap(words.to_owned(), font, theme.on_accent);
    let size = text.size() + vec2(2.0 * space::USUAL, space::TIGHT);
    // Keeps the captions along the lower edge of a view uncovered; a row has none.
    let ground = match place.height() > 4.0 * ABOVE_CAPTIONS {
        true => Align2::CENTER_BOTTOM.anchor_size(place.center_bottom() - vec2(0.0, ABOVE_CAPTIONS), size),
        false => Align2::LEFT_BOTTOM.anchor_size(place.left_bottom() + vec2(2.5, -2.5), size),
    };
    painter.rect_filled(ground, CornerRadius::same(space::CORNER), theme.accent);
    let at = Align2::CENTER_CENTER.align_size_within_rect(text.size(), ground);
    painter.galley(at.min, text, theme.on_accent);
    let marked = ui.interact(ground, Id::new("words about a drop"), egui::Sense::hover());
    marked.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Label, true, words));
}

/// Marks the window while a file is held over it, with a caption that says what a drop does.
pub(super) fn mark_hovered_file(ui: &Ui, theme: &Theme) {
    let hovered = ui.input(|input| input.raw.hovered_files.first().cloned());
    let Some(hovered) = hovered else { return };
    let file = hovered.path.as_deref();
    let name = file.map_or_else(|| "the file".into(), file_name);
    let ending = file.and_then(lowercase_ending);
    let words = match ending.as_deref() {
        _ if file.is_some_and(Path::is_dir) => format!("Drop {name} to add its pictures as texture sets"),
        Some("sabi") => format!("Drop {name} to open it"),
        Some(ending) if MODEL_ENDINGS.contains(&ending) => format!("Drop {name} to show the graph on it"),
        Some("hdr") => format!("Drop {name} to light the model by it"),
        Some(ending) if IMAGES.contains(&ending) => format!("Drop {name} to add it as an image"),
        _ => "Drop a graph, a model, a picture or an environment here".to_owned(),
    };
    mark_target(ui, theme, ui.ctx().content_rect(), &words);
}
