//! A node that is dragged to the canvas from another panel.

use egui::{Align2, CornerRadius, FontId, Id, LayerId, Order, Pos2, Rect, Stroke, StrokeKind, Ui, vec2};
use sabi_editing::OpenDocument;
use sabi_editing::node_size::{NODE_WIDTH, PICTURE_SIDE, TITLE_HEIGHT};
use sabi_engine::catalog::Entry;
use sabi_graph::SlotRef;

use super::gesture::{EDGE, pull};
use super::wires::{self, Wire};
use super::{Canvas, body};
use crate::theme::{Theme, space, type_size};

/// Zoom of the dragged node while it is beside the canvas.
const BESIDE: f32 = 0.6;

impl Canvas {
    /// Draws a node that is dragged from another panel where it would be put, and scrolls at the edges of the canvas.
    pub(crate) fn drag_new(&mut self, ui: &Ui, theme: &Theme, document: &OpenDocument, face: &Entry, at: Pos2) {
        self.draw_dragged(ui, theme, document, face, at);
        self.scroll_for(ui, at);
    }

    /// Place for a node that is dropped at a place of the screen, and the wire that takes it; none beside the canvas.
    pub(crate) fn place_for_dropped(
        &self,
        document: &OpenDocument,
        face: &Entry,
        at: Pos2,
    ) -> Option<([f32; 2], Option<SlotRef>)> {
        let wire = self.wire_for(document, face, at);
        Some((self.place_at(at)?, wire.map(|wire| wire.to)))
    }

    fn draw_dragged(&self, ui: &Ui, theme: &Theme, document: &OpenDocument, face: &Entry, at: Pos2) {
        let zoom = self.place_at(at).map_or(BESIDE, |_| self.view.zoom);
        let painter = ui
            .ctx()
            .layer_painter(LayerId::new(Order::Tooltip, Id::new("node that is dragged")));
        if let Some((wire, panel)) = self.wire_for(document, face, at).zip(self.panel) {
            wires::draw(&painter.with_clip_rect(panel), theme, &wire, zoom, wires::Look::Hot);
        }
        let rect = Rect::from_min_size(at, vec2(NODE_WIDTH, TITLE_HEIGHT + PICTURE_SIDE) * zoom);
        let title = rect.with_max_y(rect.top() + TITLE_HEIGHT * zoom);
        let corner = CornerRadius::same(space::CORNER);
        painter.rect_filled(rect, corner, theme.raised.gamma_multiply(0.7));
        painter.rect_filled(title, corner, theme.category(face.category()).gamma_multiply(0.9));
        let line = Stroke::new(1.5, theme.accent);
        painter.rect_stroke(rect, corner, line, StrokeKind::Outside);
        let font = FontId::proportional((type_size::BODY * zoom).max(type_size::SMALL));
        let name = body::elided(ui, &face.label, font, title.width() - 12.0 * zoom, theme.text);
        let place = Align2::LEFT_CENTER.align_size_within_rect(name.size(), title.shrink2(vec2(8.0 * zoom, 0.0)));
        painter.galley(place.min, name, theme.text);
        ui.set_cursor_icon(egui::CursorIcon::Grabbing);
    }

    /// Wire at a place of the screen that takes a new node.
    fn wire_for(&self, document: &OpenDocument, face: &Entry, at: Pos2) -> Option<Wire> {
        let panel = self.panel.filter(|panel| panel.contains(at))?;
        let wires = wires::visible(document, &self.view, panel);
        let wire = wires::under(&wires, at)?;
        sabi_editing::wires::can_insert_new(document, face, &wire.to).then(|| wire.clone())
    }

    /// Scrolls the canvas under a drag near its edge, once the drag has been farther in.
    fn scroll_for(&mut self, ui: &Ui, at: Pos2) {
        let Some(panel) = self.panel.filter(|panel| panel.contains(at)) else {
            return;
        };
        self.is_brought |= panel.shrink(EDGE).contains(at);
        if self.is_brought {
            pull(self, ui, panel, at);
        }
    }
}
