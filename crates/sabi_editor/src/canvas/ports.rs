//! Ports: their dots, by color and shape, and dragging wires from them.

use egui::{Color32, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, WidgetInfo, WidgetType, vec2};
use sabi_editing::{OpenDocument, connections, node_size};
use sabi_engine::catalog::Port;
use sabi_graph::{NodeId, PortType};

use super::gesture::Gesture;
use super::port_refs::{DOT, PortRef, reach_of, shown_ports_of};
use super::{Canvas, CanvasContext, port_menu};
use crate::action::Action;
use crate::theme::Theme;

/// Largest share of a node's width that the ports at each of its sides are sensitive in.
pub(super) const INSIDE: f32 = 0.3;

/// Draws the ports of a node and begins drags of wires at them.
pub(super) fn show(
    canvas: &mut Canvas,
    ui: &Ui,
    panel: Rect,
    context: &CanvasContext<'_>,
    id: &NodeId,
    actions: &mut Vec<Action>,
) {
    let document = context.document;
    let zoom = canvas.camera.view.zoom;
    let title = document.title(id);
    for (place, port) in shown_ports_of(document, id) {
        let Some(at) = place.position(document) else { continue };
        let center = canvas.camera.view.screen(panel, at);
        let reach = reach_of(zoom);
        let is_input = matches!(place, PortRef::Input(_));
        // Leaves enough of a small node to drag the node itself.
        let inside = reach.min(node_size::of(document, id)[0] * zoom * INSIDE);
        let [left, right] = if is_input { [reach, inside] } else { [inside, reach] };
        let rect = Rect::from_min_max(center - vec2(left, reach), center + vec2(right, reach));
        let widget = ui.id().with(("port", id, &port.name, is_input));
        let response = ui.interact(rect, widget, Sense::click_and_drag());
        let name = accessible(&title, &port, is_input);
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &name));
        let fits = canvas.gesture.accepts(document, &place);
        let is_hot = fits != Some(false) && response.contains_pointer() || canvas.focus.is_at(&place);
        let mut color = context.theme.port(port.ty);
        if fits == Some(false) {
            color = color.gamma_multiply(0.25);
        }
        let is_wired = is_wired(document, &place);
        let size = DOT * zoom * if is_hot { 1.35 } else { 1.0 };
        dot(ui.painter(), context.theme, center, size, port.ty, color, is_wired);
        if port.is_required && !is_wired && is_input && zoom > 0.6 {
            ui.painter()
                .circle_stroke(center, size + 2.5 * zoom, Stroke::new(1.0, context.theme.warning));
        }
        if response.drag_started_by(egui::PointerButton::Primary) {
            canvas.gesture = Gesture::from_port(document, &place);
        }
        if response.clicked() {
            clicked(&place, actions);
        }
        port_menu::mark(ui.painter(), context.theme, document, &place, center, zoom);
        port_menu::show(canvas, &response, &place, document, actions);
        if matches!(canvas.gesture, Gesture::Idle) {
            response.on_hover_ui(|ui| tooltip(ui, context.theme, &port, is_wired));
        }
    }
}

/// Asks to show an output's result, or for an input that of its node.
pub(super) fn clicked(place: &PortRef, actions: &mut Vec<Action>) {
    actions.push(Action::Select(vec![place.node().clone()]));
    let port = match place {
        PortRef::Output(from) => from.port.clone(),
        PortRef::Input(_) => None,
    };
    actions.push(Action::Show {
        node: place.node().clone(),
        port,
    });
}

/// Name of a port for assistive technology.
fn accessible(title: &str, port: &Port, is_input: bool) -> String {
    let side = if is_input { "input" } else { "output" };
    let carries = port.ty.map_or("anything".to_owned(), |ty| ty.to_string());
    format!("{title}, {side} {}, {carries}", port.label)
}

pub(super) fn tooltip(ui: &mut Ui, theme: &Theme, port: &Port, is_wired: bool) {
    ui.set_max_width(260.0);
    let carries = port.ty.map_or("anything".to_owned(), |ty| ty.to_string());
    ui.horizontal(|ui| {
        ui.strong(&port.label);
        ui.colored_label(theme.port(port.ty), carries);
    });
    if !port.doc.is_empty() {
        ui.label(&port.doc);
    }
    if port.is_required && !is_wired {
        ui.colored_label(theme.warning, "Has to be connected.");
    }
}

pub(super) fn is_wired(document: &OpenDocument, place: &PortRef) -> bool {
    match place {
        PortRef::Input(slot) => connections::wire_into(document, slot).is_some(),
        PortRef::Output(from) => {
            let interface = document.interface(&from.node);
            let first = interface
                .and_then(|interface| interface.outputs.first())
                .map(|port| &port.name);
            let readers = document.graph().readers(from.node.as_str());
            readers
                .iter()
                .filter_map(|slot| connections::wire_into(document, slot))
                .any(|wire| wire.port == from.port || wire.port.is_none() && first == from.port.as_ref())
        }
    }
}

/// Draws a dot: round for masks, a diamond for colors, a triangle for vectors, a square for materials; hollow if not
/// connected.
pub(super) fn dot(
    painter: &Painter,
    theme: &Theme,
    center: Pos2,
    size: f32,
    ty: Option<PortType>,
    color: Color32,
    is_wired: bool,
) {
    let fill = if is_wired { color } else { theme.canvas };
    let stroke = Stroke::new((size * 0.35).max(1.0), color);
    let polygon = |corners: &[(f32, f32)]| {
        let corners = corners.iter().map(|(x, y)| center + vec2(*x, *y) * size);
        Shape::convex_polygon(corners.collect(), fill, stroke)
    };
    painter.add(match ty {
        Some(PortType::Mask) | None => Shape::Circle(egui::epaint::CircleShape {
            center,
            radius: size,
            fill,
            stroke,
        }),
        Some(PortType::Color) => polygon(&[(0.0, -1.25), (1.25, 0.0), (0.0, 1.25), (-1.25, 0.0)]),
        Some(PortType::Vector) => polygon(&[(-0.9, -1.1), (1.2, 0.0), (-0.9, 1.1)]),
        Some(PortType::Material) => polygon(&[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]),
    });
}
