//! Ports: their dots, by color and form, and taking a wire at them.

use egui::{Color32, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, WidgetInfo, WidgetType, pos2, vec2};
use sabi_editing::{OpenDocument, PendingWire};
use sabi_engine::catalog::Port;
use sabi_graph::{NodeId, OutputRef, PortType, SlotRef};

use super::gesture::Gesture;
use super::{Around, Canvas, port_menu, wires};
use crate::action::Action;
use crate::theme::Theme;

/// Half the width of a dot, canvas points.
pub(super) const DOT: f32 = 5.0;
/// How near the pointer has to be to take one, screen points at least.
const REACH: f32 = 9.0;
/// At most so much of a node's width is taken for the ports at each of its sides.
pub(super) const INSIDE: f32 = 0.3;

/// A port of a node that is seen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Place {
    Input(SlotRef),
    Output(OutputRef),
}

impl Place {
    /// Where it is on the canvas.
    pub(super) fn on_canvas(&self, document: &OpenDocument) -> Option<[f32; 2]> {
        match self {
            Place::Input(slot) => wires::end_of(document, slot),
            Place::Output(from) => wires::start_of(document, from),
        }
    }

    pub(super) fn node(&self) -> &NodeId {
        match self {
            Place::Input(slot) => &slot.node,
            Place::Output(from) => &from.node,
        }
    }

    /// A wire that begins here.
    pub(super) fn loose(&self) -> PendingWire {
        match self {
            Place::Input(slot) => PendingWire::Into(slot.clone()),
            Place::Output(from) => PendingWire::From(from.clone()),
        }
    }
}

/// All ports of a node, in order.
pub(super) fn places(document: &OpenDocument, id: &NodeId) -> Vec<(Place, Port)> {
    let Some(face) = document.face(id) else {
        return Vec::new();
    };
    let inputs = face.inputs.iter().map(|port| {
        let slot = SlotRef {
            node: id.clone(),
            name: port.name.clone(),
        };
        (Place::Input(slot), port.clone())
    });
    let outputs = face.outputs.iter().map(|port| {
        let from = OutputRef {
            node: id.clone(),
            port: Some(port.name.clone()),
        };
        (Place::Output(from), port.clone())
    });
    inputs.chain(outputs).collect()
}

/// Draws the ports of a node and takes wires at them.
pub(super) fn show(
    canvas: &mut Canvas,
    ui: &Ui,
    panel: Rect,
    around: &Around<'_>,
    id: &NodeId,
    actions: &mut Vec<Action>,
) {
    let document = around.document;
    let zoom = canvas.view.zoom;
    let title = document.title(id);
    for (place, port) in places(document, id) {
        let Some(at) = place.on_canvas(document) else { continue };
        let center = canvas.view.screen(panel, at);
        let reach = (DOT * 1.6 * zoom).max(REACH);
        let is_input = matches!(place, Place::Input(_));
        // Of a small node enough is left to take it itself.
        let inside = reach.min(document.size(id)[0] * zoom * INSIDE);
        let [left, right] = if is_input { [reach, inside] } else { [inside, reach] };
        let rect = Rect::from_min_max(center - vec2(left, reach), center + vec2(right, reach));
        let widget = ui.id().with(("port", id, &port.name, is_input));
        let response = ui.interact(rect, widget, Sense::click_and_drag());
        let name = accessible(&title, &port, is_input);
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &name));
        let fits = canvas.gesture.takes(document, &place);
        let is_hot = fits != Some(false) && response.contains_pointer() || canvas.is_focused(&place);
        let mut color = around.theme.port(port.ty);
        if fits == Some(false) {
            color = color.gamma_multiply(0.25);
        }
        let is_wired = is_wired(document, &place);
        let size = DOT * zoom * if is_hot { 1.35 } else { 1.0 };
        dot(ui.painter(), around.theme, center, size, (port.ty, color), is_wired);
        if port.is_required && !is_wired && is_input && zoom > 0.6 {
            ui.painter()
                .circle_stroke(center, size + 2.5 * zoom, Stroke::new(1.0, around.theme.warning));
        }
        if response.drag_started_by(egui::PointerButton::Primary) {
            canvas.gesture = taken(document, &place);
        }
        if response.clicked() {
            clicked(&place, actions);
        }
        port_menu::mark(ui.painter(), around.theme, document, &place, center, zoom);
        port_menu::show(canvas, &response, &place, document, actions);
        if matches!(canvas.gesture, Gesture::Idle) {
            response.on_hover_ui(|ui| tooltip(ui, around.theme, &port));
        }
    }
}

/// Shows an output's result; a click on an input is one on its node, of which it is a part.
pub(super) fn clicked(place: &Place, actions: &mut Vec<Action>) {
    actions.push(Action::Select(vec![place.node().clone()]));
    let port = match place {
        Place::Output(from) => from.port.clone(),
        Place::Input(_) => None,
    };
    actions.push(Action::Show {
        node: place.node().clone(),
        port,
    });
}

/// The name of a port for those who do not see it.
fn accessible(title: &str, port: &Port, is_input: bool) -> String {
    let side = if is_input { "input" } else { "output" };
    let carries = port.ty.map_or("anything".to_owned(), |ty| ty.to_string());
    format!("{title}, {side} {}, {carries}", port.label)
}

pub(super) fn tooltip(ui: &mut Ui, theme: &Theme, port: &Port) {
    ui.set_max_width(260.0);
    let carries = port.ty.map_or("anything".to_owned(), |ty| ty.to_string());
    ui.horizontal(|ui| {
        ui.strong(&port.label);
        ui.colored_label(theme.port(port.ty), carries);
    });
    if !port.doc.is_empty() {
        ui.label(&port.doc);
    }
    if port.is_required {
        ui.colored_label(theme.warning, "Has to be connected.");
    }
}

pub(super) fn is_wired(document: &OpenDocument, place: &Place) -> bool {
    match place {
        Place::Input(slot) => document.wire_into(slot).is_some(),
        Place::Output(from) => {
            let face = document.face(&from.node);
            let first = face.and_then(|face| face.outputs.first()).map(|port| &port.name);
            let readers = document.graph().readers(from.node.as_str());
            readers
                .iter()
                .filter_map(|slot| document.wire_into(slot))
                .any(|wire| wire.port == from.port || wire.port.is_none() && first == from.port.as_ref())
        }
    }
}

/// What is in hand once a port was taken: a wire from it; or, of an input that has one, that wire, taken off it.
pub(super) fn taken(document: &OpenDocument, place: &Place) -> Gesture {
    if let Place::Input(slot) = place
        && let Some(from) = document.wire_into(slot)
    {
        return Gesture::wire(PendingWire::From(from.clone()), Some(slot.clone()));
    }
    Gesture::wire(place.loose(), None)
}

/// A dot: round for masks, a diamond for colors, a triangle for vectors, a square for materials; hollow where nothing is tied.
pub(super) fn dot(
    painter: &Painter,
    theme: &Theme,
    center: Pos2,
    size: f32,
    (ty, color): (Option<PortType>, Color32),
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

/// The port under a place of the screen.
pub(super) fn at(canvas: &Canvas, document: &OpenDocument, panel: Rect, pointer: Pos2) -> Option<Place> {
    let reach = (DOT * 1.6 * canvas.view.zoom).max(REACH);
    let near = |id: &&NodeId| {
        let rect = super::node_rect(document, id).map(|rect| canvas.view.screen_rect(panel, rect));
        rect.is_some_and(|rect| rect.expand(reach).contains(pointer))
    };
    let places = document.graph().ids().filter(near).flat_map(|id| places(document, id));
    let found = places.filter_map(|(place, _)| {
        let center = canvas.view.screen(panel, place.on_canvas(document)?);
        Some((center.distance(pointer), place)).filter(|(distance, _)| *distance < reach)
    });
    let nearest = found.min_by(|(one, _), (other, _)| one.total_cmp(other));
    nearest.map(|(_, place)| place)
}

/// The port that a wire would be dropped at: the nearest that takes it, or on a node's body the first that does, a free one
/// before one that has a wire, and one of its type before one that converts.
pub(super) fn target(canvas: &Canvas, around: &Around<'_>, panel: Rect, pointer: Pos2) -> Option<Place> {
    let document = around.document;
    let here = canvas.view.place(panel, pointer);
    let here = pos2(here[0], here[1]);
    let margin = 24.0;
    let mut best: Option<(f32, Place)> = None;
    let mut under: Option<((bool, bool), Place)> = None;
    for id in document.graph().ids() {
        let Some(rect) = super::node_rect(document, id).filter(|rect| rect.expand(margin).contains(here)) else {
            continue;
        };
        for (place, _) in places(document, id) {
            if canvas.gesture.takes(document, &place) != Some(true) {
                continue;
            }
            let Some(at) = place.on_canvas(document) else { continue };
            let distance = here.distance(pos2(at[0], at[1]));
            let cost = canvas.gesture.cost(document, &place);
            if rect.contains(here) && under.as_ref().is_none_or(|(least, _)| cost < *least) {
                under = Some((cost, place.clone()));
            }
            if distance < margin && best.as_ref().is_none_or(|(least, _)| distance < *least) {
                best = Some((distance, place));
            }
        }
    }
    best.map(|(_, place)| place).or(under.map(|(_, place)| place))
}
