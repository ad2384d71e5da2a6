//! The sides of cards, whose ports are too small for the pointer: a drag takes the nearest one.

use egui::{PointerButton, Pos2, Rect, Sense, Ui, WidgetInfo, WidgetType, pos2};
use sabi_editing::OpenDocument;
use sabi_editing::node_size::{ShownRows, rows_of};
use sabi_engine::catalog::{Interface, Port};
use sabi_graph::NodeId;

use super::gesture::Gesture;
use super::port_refs::{self, DOT, PortRef};
use super::ports::{self, INSIDE};
use super::{Canvas, CanvasContext, node_rect};
use crate::action::Action;

/// Distance at which the pointer takes a side, screen points.
const REACH: f32 = 7.0;
/// Smallest size of dots, screen points.
const LEAST_DOT: f32 = 1.4;

/// Inputs or outputs of a card.
struct CardSide<'a> {
    id: &'a NodeId,
    interface: &'a Interface,
    rows: &'a ShownRows,
    is_input: bool,
    /// Rectangle of the whole card on the screen.
    rect: Rect,
    zoom: f32,
}

/// Draws the ports of a card and begins drags of wires at its sides.
pub(super) fn show(
    canvas: &mut Canvas,
    ui: &Ui,
    panel: Rect,
    context: &CanvasContext<'_>,
    id: &NodeId,
    actions: &mut Vec<Action>,
) {
    let document = context.document;
    let Some((interface, rect)) = document.interface(id).zip(node_rect(document, id)) else {
        return;
    };
    let Some(rows) = rows_of(document, id) else { return };
    for is_input in [true, false] {
        let side = CardSide {
            id,
            interface,
            rows: &rows,
            is_input,
            rect: canvas.camera.view.screen_rect(panel, rect),
            zoom: canvas.camera.view.zoom,
        };
        if !side.ports().is_empty() {
            side.draw(ui, context);
            side.interact(canvas, ui, context, actions);
        }
    }
}

impl CardSide<'_> {
    fn ports(&self) -> &[Port] {
        if self.is_input {
            &self.interface.inputs
        } else {
            &self.interface.outputs
        }
    }

    fn x(&self) -> f32 {
        if self.is_input {
            self.rect.left()
        } else {
            self.rect.right()
        }
    }

    /// Height of the port of a row on the screen.
    fn y(&self, row: usize) -> f32 {
        let down = match self.is_input {
            true => self.rows.input(row),
            false => self.rows.output(row),
        };
        self.rect.top() + down * self.zoom
    }

    fn draw(&self, ui: &Ui, context: &CanvasContext<'_>) {
        let size = DOT * self.zoom;
        let is_shown = |row: usize| match self.is_input {
            true => self.rows.shows_input(row),
            false => self.rows.shows_output(row),
        };
        let ports = self.ports().iter().enumerate();
        for (row, port) in ports.filter(|(row, _)| size > LEAST_DOT && is_shown(*row)) {
            let center = pos2(self.x(), self.y(row));
            ui.painter().circle_filled(center, size, context.theme.port(port.ty));
        }
    }

    /// Port nearest to a place.
    fn nearest(&self, document: &OpenDocument, at: Pos2) -> Option<(PortRef, Port)> {
        let rows = 0..self.ports().len();
        let away = |row: &usize| (self.y(*row) - at.y).abs();
        let row = rows.min_by(|one, other| away(one).total_cmp(&away(other)))?;
        let before = if self.is_input { 0 } else { self.interface.inputs.len() };
        port_refs::ports_of(document, self.id).into_iter().nth(before + row)
    }

    fn interact(&self, canvas: &mut Canvas, ui: &Ui, context: &CanvasContext<'_>, actions: &mut Vec<Action>) {
        let document = context.document;
        let inside = REACH.min(self.rect.width() * INSIDE);
        let [left, right] = if self.is_input {
            [REACH, inside]
        } else {
            [inside, REACH]
        };
        let area = Rect::from_x_y_ranges(self.x() - left..=self.x() + right, self.rect.y_range());
        let widget = ui.id().with(("side", self.id, self.is_input));
        let response = ui.interact(area, widget, Sense::click_and_drag());
        response.widget_info(|| {
            let what = if self.is_input { "inputs" } else { "outputs" };
            WidgetInfo::labeled(WidgetType::Button, true, format!("{}, {what}", document.title(self.id)))
        });
        let nearest = |at: Pos2| self.nearest(document, at);
        if response.drag_started_by(PointerButton::Primary) {
            let origin = ui.input(|input| input.pointer.press_origin());
            if let Some((place, _)) = origin.and_then(nearest) {
                canvas.gesture = Gesture::from_port(document, &place);
            }
        } else if response.clicked() {
            if let Some((place, _)) = response.interact_pointer_pos().and_then(nearest) {
                ports::clicked(&place, actions);
            }
        } else if let Some((place, port)) = response.hover_pos().and_then(nearest)
            && matches!(canvas.gesture, Gesture::Idle)
        {
            let is_wired = ports::is_wired(document, &place);
            response.on_hover_ui(|ui| ports::tooltip(ui, context.theme, &port, is_wired));
        }
    }
}
