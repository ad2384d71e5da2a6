//! Nodes that are dragged from the library: the target below the pointer, its mark, and the drop.

use egui::{Align2, CornerRadius, FontId, Id, LayerId, Order, Pos2, Rect, Stroke, StrokeKind, Ui, vec2};
use sabi_editing::command::{LayerCommand, NodeSource};
use sabi_editing::dropped_layers::DroppedOn;
use sabi_editing::stack::StackEnd;
use sabi_engine::catalog::Interface;
use sabi_graph::{NodeId, SlotRef};

use crate::app::Editor;
use crate::dock::Panel;
use crate::model_view::drop_place::DropPlace;
use crate::theme::{space, type_size};

/// Result of dropping a node at a place.
enum DropTarget {
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

impl Editor {
    /// Target of a node at a place of the screen; `None` where it cannot be dropped.
    fn drop_target(&self, interface: &Interface, at: Pos2) -> Option<DropTarget> {
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
            if let Some(place) = model.drop_place(document, &self.evaluation, &subject, interface, at) {
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

    /// Adds a node where it is dropped.
    pub(super) fn drop_new(&mut self, source: NodeSource, interface: &Interface, at: Pos2, ui: &Ui) {
        match self.drop_target(interface, at) {
            Some(DropTarget::Mask(node)) => self.edit(LayerCommand::AddMask { node, source }, ui),
            Some(DropTarget::Model(place)) => {
                let command = LayerCommand::AddOnModel {
                    source,
                    place: place.material,
                    has_normal_map: place.has_normal_map,
                };
                self.edit(command, ui);
            }
            Some(DropTarget::Node(node)) => self.edit(LayerCommand::AddOnNode { source, node }, ui),
            Some(DropTarget::Canvas(place, into)) => self.add(source, place, into, ui),
            None => {}
        }
    }

    /// Draws a node that is dragged, and marks where it would be dropped.
    pub(super) fn drag_new(&mut self, interface: &Interface, at: Pos2, ui: &Ui) {
        if let Some((place, words)) = self.marked_target(interface, at) {
            self.mark_target(ui, place, &words);
        }
        let document = &self.documents.document;
        self.views
            .canvas
            .drag_new(ui, &self.shell.theme, document, interface, at);
    }

    /// Rectangle outside of the canvas that a drop at a place goes to, with a caption that says what the drop does. The
    /// canvas marks its own targets.
    fn marked_target(&self, interface: &Interface, at: Pos2) -> Option<(Rect, String)> {
        let document = &self.documents.document;
        match self.drop_target(interface, at)? {
            DropTarget::Mask(node) => {
                let row = self.views.layers.row_of(&node)?;
                Some((row, format!("Mask of {}", document.title(&node))))
            }
            DropTarget::Model(place) => {
                let of = match &place.material {
                    DroppedOn::Output(StackEnd::Node(node)) => document.title(node),
                    DroppedOn::Output(StackEnd::Port(name)) | DroppedOn::Material(name) => name.clone(),
                    DroppedOn::Unknown => "the model".to_owned(),
                };
                let view = self.shell.dock.rects.get(&Panel::Viewport)?;
                Some((*view, format!("Layer on {of}")))
            }
            DropTarget::Node(_) | DropTarget::Canvas(..) => None,
        }
    }

    /// Marks the target of a drag, with a caption that says what a drop does there.
    pub(in crate::app) fn mark_target(&self, ui: &Ui, place: Rect, words: &str) {
        let theme = &self.shell.theme;
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
}
