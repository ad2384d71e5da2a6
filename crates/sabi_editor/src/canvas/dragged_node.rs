//! A node that is dragged to the canvas from another panel.

use egui::{Align2, CornerRadius, FontId, Id, LayerId, Order, Pos2, Rect, Stroke, StrokeKind, Ui, vec2};
use sabi_editing::node_size::{NODE_WIDTH, PICTURE_SIDE, TITLE_HEIGHT};
use sabi_editing::{OpenDocument, dropped_layers};
use sabi_engine::catalog::Interface;

use sabi_graph::NodeId;

use super::camera::{CanvasCamera, SCROLL_EDGE};
use super::wires::{self, Wire};
use super::{Canvas, body, node_rect};
use crate::theme::{Theme, space, type_size};

/// Zoom of the dragged node while it is outside of the canvas.
const ZOOM_OUTSIDE: f32 = 0.6;
/// Distance at which a wire catches the node, points.
const CATCH: f32 = 40.0;

/// Scrolling at the edges of the canvas during a drag from another panel.
#[derive(Default)]
pub(super) struct EdgeScroll {
    /// True once the drag has been away from the edges, which it crosses when it enters.
    was_inside: bool,
}

impl EdgeScroll {
    /// Ends the scrolling once no button of the pointer is pressed.
    pub(super) fn begin_frame(&mut self, ui: &Ui) {
        self.was_inside &= ui.input(|input| input.pointer.any_down());
    }

    /// Scrolls the canvas under a drag near its edge.
    pub(super) fn scroll(&mut self, camera: &mut CanvasCamera, ui: &Ui, at: Pos2) {
        let Some(panel) = camera.panel.filter(|panel| panel.contains(at)) else {
            return;
        };
        self.was_inside |= panel.shrink(SCROLL_EDGE).contains(at);
        if self.was_inside {
            camera.scroll_at_edge(ui, panel, at);
        }
    }
}

/// Draws the dragged node, and the node that it would be a layer on or the wire that it would be inserted into.
pub(super) fn draw(canvas: &Canvas, ui: &Ui, theme: &Theme, document: &OpenDocument, interface: &Interface, at: Pos2) {
    let camera = &canvas.camera;
    let zoom = camera.place_at(at).map_or(ZOOM_OUTSIDE, |_| camera.view.zoom);
    let painter = ui
        .ctx()
        .layer_painter(LayerId::new(Order::Tooltip, Id::new("node that is dragged")));
    let under = node_at(canvas, document, interface, at).and_then(|id| node_rect(document, &id));
    if let Some((under, panel)) = under.zip(camera.panel) {
        let under = camera.view.screen_rect(panel, under);
        let line = Stroke::new(2.5, theme.accent);
        let painter = painter.with_clip_rect(panel);
        painter.rect_stroke(under, CornerRadius::same(space::CORNER), line, StrokeKind::Outside);
    } else if let Some((wire, panel)) = wire_at(camera, document, interface, at).zip(camera.panel) {
        let painter = painter.with_clip_rect(panel);
        wires::draw(&painter, theme, &wire, zoom, wires::WireLook::Highlighted);
    }
    // Outside of the canvas only the title is drawn, so that the target of the drop stays visible.
    let picture = if camera.place_at(at).is_some() {
        PICTURE_SIDE
    } else {
        0.0
    };
    let rect = Rect::from_min_size(at, vec2(NODE_WIDTH, TITLE_HEIGHT + picture) * zoom);
    let title = rect.with_max_y(rect.top() + TITLE_HEIGHT * zoom);
    let corner = CornerRadius::same(space::CORNER);
    painter.rect_filled(rect, corner, theme.raised.gamma_multiply(0.7));
    painter.rect_filled(title, corner, theme.category(interface.category()).gamma_multiply(0.9));
    let line = Stroke::new(1.5, theme.accent);
    painter.rect_stroke(rect, corner, line, StrokeKind::Outside);
    let font = FontId::proportional((type_size::BODY * zoom).max(type_size::SMALL));
    let name = body::elided(ui, &interface.label, font, title.width() - 12.0 * zoom, theme.text);
    let place = Align2::LEFT_CENTER.align_size_within_rect(name.size(), title.shrink2(vec2(8.0 * zoom, 0.0)));
    painter.galley(place.min, name, theme.text);
    ui.set_cursor_icon(egui::CursorIcon::Grabbing);
}

/// Node at a place of the screen on whose material a new node is added as a layer; of several, the one that is drawn on
/// top.
pub(super) fn node_at(canvas: &Canvas, document: &OpenDocument, interface: &Interface, at: Pos2) -> Option<NodeId> {
    let panel = canvas.camera.panel.filter(|panel| panel.contains(at))?;
    let is_at = |id: &NodeId| {
        let rect = node_rect(document, id).map(|rect| canvas.camera.view.screen_rect(panel, rect));
        rect.is_some_and(|rect| rect.contains(at))
    };
    let order = |id: &NodeId| canvas.draw_order.iter().position(|known| known == id);
    let nodes = document.graph().ids().filter(|id| is_at(id));
    let above = nodes.max_by_key(|id| order(id))?;
    dropped_layers::can_lie_on(document, interface, above).then(|| above.clone())
}

/// Wire at a place of the screen that a new node can be inserted into.
pub(super) fn wire_at(camera: &CanvasCamera, document: &OpenDocument, interface: &Interface, at: Pos2) -> Option<Wire> {
    let panel = camera.panel.filter(|panel| panel.contains(at))?;
    let wires = wires::visible(document, &camera.view, panel);
    let wire = wires::within(&wires, at, CATCH)?;
    sabi_editing::wires::can_insert_new(document, interface, &wire.to).then(|| wire.clone())
}
