//! Wires: their curves, and tests against the pointer and lines.

use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, Ui, Vec2, epaint::CubicBezierShape, pos2};
use sabi_editing::node_size::{TITLE_HEIGHT, rows_of};
use sabi_editing::{OpenDocument, connections};
use sabi_graph::{NodeId, OutputRef, PortType, SlotRef};

use super::view::CanvasView;
use super::{Canvas, CanvasContext};
use crate::theme::Theme;

/// Segments that approximate a curve for distances.
const PIECES: usize = 16;
/// Distance at which a wire is under the pointer, screen points.
pub(super) const NEAR: f32 = 7.0;

/// Wire on the screen.
#[derive(Clone, Debug)]
pub(crate) struct Wire {
    pub(super) from: OutputRef,
    pub(crate) to: SlotRef,
    pub(super) carries: Option<PortType>,
    /// True if the value is converted to the type of the input.
    pub(super) is_converted: bool,
    pub(super) curve: [Pos2; 4],
}

impl Wire {
    /// Rectangle around the curve.
    pub(super) fn bounds(&self) -> Rect {
        Rect::from_points(&self.curve)
    }

    /// Points along the curve.
    fn points(&self) -> impl Iterator<Item = Pos2> + '_ {
        (0..=PIECES).map(|at| point(&self.curve, at as f32 / PIECES as f32))
    }

    /// Distance of a place from the curve, screen points.
    pub(super) fn distance(&self, place: Pos2) -> f32 {
        let points: Vec<Pos2> = self.points().collect();
        let pieces = points.windows(2);
        pieces
            .map(|ends| from_segment(place, ends[0], ends[1]))
            .fold(f32::INFINITY, f32::min)
    }

    /// Returns whether a segment crosses the curve.
    pub(super) fn is_crossed(&self, line: [Pos2; 2]) -> bool {
        let points: Vec<Pos2> = self.points().collect();
        points.windows(2).any(|ends| cross([ends[0], ends[1]], line))
    }

    /// Middle of the curve.
    pub(super) fn middle(&self) -> Pos2 {
        point(&self.curve, 0.5)
    }
}

/// Returns whether wires from a node are drawn as names.
pub(super) fn is_named(document: &OpenDocument, node: &NodeId) -> bool {
    document.node(node).is_some_and(|node| node.display.has_named_wires)
}

/// Wires that may be in the panel; those that are drawn as names are not among them.
pub(super) fn visible(document: &OpenDocument, view: &CanvasView, panel: Rect) -> Vec<Wire> {
    let mut wires = Vec::new();
    for id in document.graph().ids() {
        for (name, from) in document.graph().inputs(id.as_str()) {
            if is_named(document, &from.node) {
                continue;
            }
            let to = SlotRef {
                node: id.clone(),
                name: name.to_owned(),
            };
            let ends = start_of(document, from).zip(end_of(document, &to));
            let Some((start, end)) = ends else { continue };
            let ends = [start, end].map(|place| view.screen(panel, place));
            let curve = curve(ends, view.zoom);
            if !Rect::from_points(&curve).intersects(panel) {
                continue;
            }
            let carries = document.interfaces().carried(&document.body(), from);
            let takes = connections::input(document, &to).and_then(|port| port.ty);
            wires.push(Wire {
                from: from.clone(),
                to,
                carries,
                is_converted: carries.is_some() && takes.is_some() && carries != takes,
                curve,
            });
        }
    }
    wires
}

/// Place on the canvas where a wire from an output begins; at the title where there is no such output.
pub(super) fn start_of(document: &OpenDocument, from: &OutputRef) -> Option<[f32; 2]> {
    let node = document.node(&from.node)?;
    let interface = document.interface(&from.node)?;
    let row = match &from.port {
        Some(name) => interface.outputs.iter().position(|port| port.name == *name),
        None => (!interface.outputs.is_empty()).then_some(0),
    };
    let rows = rows_of(document, &from.node)?;
    let down = row.map_or(TITLE_HEIGHT / 2.0, |row| rows.output(row));
    Some([node.pos[0] + rows.size()[0], node.pos[1] + down])
}

/// Place on the canvas where a wire into an input ends; at the title where there is no such input.
pub(super) fn end_of(document: &OpenDocument, to: &SlotRef) -> Option<[f32; 2]> {
    let node = document.node(&to.node)?;
    let interface = document.interface(&to.node)?;
    let row = interface.inputs.iter().position(|port| port.name == to.name);
    let rows = rows_of(document, &to.node)?;
    let down = row.map_or(TITLE_HEIGHT / 2.0, |row| rows.input(row));
    Some([node.pos[0], node.pos[1] + down])
}

/// Curve that leaves to the right and arrives from the left.
pub(super) fn curve([start, end]: [Pos2; 2], zoom: f32) -> [Pos2; 4] {
    let across = (end.x - start.x).abs() * 0.5;
    let reach = across
        .clamp(24.0 * zoom, 160.0 * zoom)
        .min(24.0 * zoom + start.distance(end));
    let aside = Vec2::new(reach, 0.0);
    [start, start + aside, end - aside, end]
}

fn point([a, b, c, d]: &[Pos2; 4], t: f32) -> Pos2 {
    let s = 1.0 - t;
    let at = |axis: fn(&Pos2) -> f32| {
        s * s * s * axis(a) + 3.0 * s * s * t * axis(b) + 3.0 * s * t * t * axis(c) + t * t * t * axis(d)
    };
    pos2(at(|p| p.x), at(|p| p.y))
}

fn from_segment(place: Pos2, start: Pos2, end: Pos2) -> f32 {
    let along = end - start;
    let length = along.length_sq();
    let share = if length > 0.0 {
        ((place - start).dot(along) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    place.distance(start + along * share)
}

fn cross(one: [Pos2; 2], other: [Pos2; 2]) -> bool {
    let side = |line: [Pos2; 2], place: Pos2| {
        let (along, to) = (line[1] - line[0], place - line[0]);
        along.x * to.y - along.y * to.x
    };
    // An end on the line counts to one side, so that no line passes between two segments.
    let parts = |line: [Pos2; 2], ends: [Pos2; 2]| (side(line, ends[0]) < 0.0) != (side(line, ends[1]) < 0.0);
    parts(one, other) && parts(other, one)
}

/// Nearest wire under the pointer.
pub(super) fn under(wires: &[Wire], pointer: Pos2) -> Option<&Wire> {
    within(wires, pointer, NEAR)
}

/// Nearest wire within a distance of the pointer, points.
pub(super) fn within(wires: &[Wire], pointer: Pos2, reach: f32) -> Option<&Wire> {
    let near = wires
        .iter()
        .filter(|wire| wire.bounds().expand(reach).contains(pointer));
    let near = near.map(|wire| (wire.distance(pointer), wire));
    let nearest = near.filter(|(distance, _)| *distance < reach);
    nearest
        .min_by(|(one, _), (other, _)| one.total_cmp(other))
        .map(|(_, wire)| wire)
}

/// Draws a curve.
pub(super) fn draw_curve(painter: &Painter, curve: [Pos2; 4], color: Color32, width: f32) {
    let stroke = Stroke::new(width, color);
    let shape = CubicBezierShape::from_points_stroke(curve, false, Color32::TRANSPARENT, stroke);
    painter.add(Shape::CubicBezier(shape));
}

/// Draws the wires in the panel.
pub(super) fn show(canvas: &Canvas, ui: &Ui, context: &CanvasContext<'_>, wires: &[Wire]) {
    let pointer = ui.input(|input| input.pointer.hover_pos());
    let document = context.document;
    let highlighted = canvas.gesture.highlighted_wire(canvas, document, wires, pointer);
    for wire in wires {
        let look = if canvas.gesture.cuts(wire) {
            WireLook::Cut
        } else if highlighted == Some(&wire.to) {
            WireLook::Highlighted
        } else if document.selection().contains(&wire.to.node) || document.selection().contains(&wire.from.node) {
            WireLook::Selected
        } else {
            WireLook::Plain
        };
        draw(ui.painter(), context.theme, wire, canvas.camera.view.zoom, look);
    }
}

/// Look of a wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WireLook {
    Plain,
    /// Connected to a selected node.
    Selected,
    /// Under the pointer, or the dragged node would be inserted into it.
    Highlighted,
    /// Under the current cut.
    Cut,
}

/// Draws a wire.
pub(super) fn draw(painter: &Painter, theme: &Theme, wire: &Wire, zoom: f32, look: WireLook) {
    let color = theme.port(wire.carries);
    let width = 1.8 * zoom.clamp(0.55, 1.6);
    let (color, width) = match look {
        WireLook::Plain => (color.gamma_multiply(0.7), width),
        WireLook::Selected => (color, width * 1.3),
        WireLook::Highlighted => (theme.accent, width * 1.6),
        WireLook::Cut => (theme.fault, width * 1.3),
    };
    draw_curve(painter, wire.curve, color, width);
    if wire.is_converted && zoom > 0.3 {
        painter.circle_filled(wire.middle(), 3.5 * zoom, color);
        painter.circle_filled(wire.middle(), 1.8 * zoom, theme.canvas);
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    fn wire(ends: [Pos2; 2]) -> Wire {
        let id = || "node_a".parse::<NodeId>().expect("an id");
        Wire {
            from: OutputRef { node: id(), port: None },
            to: SlotRef {
                node: id(),
                name: "mask".to_owned(),
            },
            carries: None,
            is_converted: false,
            curve: curve(ends, 1.0),
        }
    }

    #[test]
    fn a_wire_is_under_the_pointer_on_its_curve_and_not_beside_it() {
        let wires = [
            wire([pos2(0.0, 0.0), pos2(300.0, 120.0)]),
            wire([pos2(0.0, 300.0), pos2(300.0, 300.0)]),
        ];
        let hit = |at: Pos2| under(&wires, at).map(|wire| wire.curve[0].y);
        assert_eq!(hit(wires[0].middle()), Some(0.0));
        assert_eq!(hit(pos2(150.0, 303.0)), Some(300.0));
        assert_eq!(hit(pos2(150.0, 200.0)), None);
        let caught = |at: Pos2| within(&wires, at, 40.0).map(|wire| wire.curve[0].y);
        assert_eq!(caught(pos2(150.0, 270.0)), Some(300.0));
    }

    #[test]
    fn a_line_cuts_only_the_wires_that_it_crosses() {
        let wire = wire([pos2(0.0, 0.0), pos2(300.0, 0.0)]);
        assert!(wire.is_crossed([pos2(150.0, -20.0), pos2(160.0, 20.0)]));
        assert!(
            wire.is_crossed([pos2(150.0, -20.0), pos2(150.0, 20.0)]),
            "where two pieces meet"
        );
        assert!(!wire.is_crossed([pos2(150.0, 5.0), pos2(160.0, 20.0)]));
        assert!(!wire.is_crossed([pos2(400.0, -20.0), pos2(400.0, 20.0)]));
    }
}
