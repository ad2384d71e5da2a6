//! Names in place of wires: a wire that would cross half the graph is drawn as the name of its source at both ends.

use std::collections::BTreeSet;

use egui::{Align2, FontId, Pos2, Rect, Sense, Stroke, StrokeKind, Ui, WidgetInfo, WidgetType, vec2};
use sabi_editing::OpenDocument;
use sabi_graph::{OutputRef, SlotRef};

use super::{Canvas, CanvasContext, wires};
use crate::action::Action;
use crate::theme::{space, type_size};

/// Zoom below which names cannot be read and are left out.
const LEGIBLE: f32 = 0.4;
/// Gap between a port and a name, canvas points.
const GAP: f32 = 12.0;

/// Name of a wire: the title of its source, with the output where that is not the first one.
pub(super) fn name_of(document: &OpenDocument, from: &OutputRef) -> String {
    let title = document.title(&from.node);
    let outputs = document
        .interface(&from.node)
        .map_or(&[][..], |interface| &interface.outputs);
    let port = from
        .port
        .as_ref()
        .and_then(|name| outputs.iter().position(|port| port.name == *name));
    match port {
        Some(at) if at > 0 => format!("{title} · {}", outputs[at].label),
        _ => title,
    }
}

/// End of a named wire.
struct Tag {
    from: OutputRef,
    /// Input that reads it; `None` at its source.
    to: Option<SlotRef>,
    /// Place of the port on the canvas.
    port: [f32; 2],
}

/// Draws the names of wires, and adds the requested actions: a click on a name selects the source, a double click shows it.
pub(super) fn show(canvas: &mut Canvas, ui: &Ui, panel: Rect, context: &CanvasContext<'_>, actions: &mut Vec<Action>) {
    let zoom = canvas.camera.view.zoom;
    if zoom < LEGIBLE {
        return;
    }
    for tag in tags(context.document) {
        let port = canvas.camera.view.screen(panel, tag.port);
        let rect = paint(ui, context, &tag, port, zoom);
        if !rect.intersects(panel) {
            continue;
        }
        let name = name_of(context.document, &tag.from);
        let response = ui.interact(rect, ui.id().with(("wire name", &tag.from, &tag.to)), Sense::click());
        let label = match &tag.to {
            Some(slot) => format!("Wire from {name} to {slot}"),
            None => format!("Wires from {name}"),
        };
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &label));
        if response.double_clicked() {
            canvas
                .camera
                .frame_nodes(context.document, std::iter::once(&tag.from.node));
        } else if response.clicked() {
            actions.push(Action::Select(vec![tag.from.node.clone()]));
        }
        if tag.to.is_some() {
            response.on_hover_text("Click to select where it comes from; double-click to go there.");
        }
    }
}

/// Ends of all named wires of the shown graph.
fn tags(document: &OpenDocument) -> Vec<Tag> {
    let mut sources = BTreeSet::new();
    let mut tags = Vec::new();
    for id in document.graph().ids() {
        let inputs = document.graph().inputs(id.as_str()).into_iter();
        for (name, from) in inputs.filter(|(_, from)| wires::is_named(document, &from.node)) {
            let to = SlotRef {
                node: id.clone(),
                name: name.to_owned(),
            };
            sources.insert(from.clone());
            if let Some(port) = wires::end_of(document, &to) {
                tags.push(Tag {
                    from: from.clone(),
                    to: Some(to),
                    port,
                });
            }
        }
    }
    tags.extend(sources.into_iter().filter_map(|from| {
        let port = wires::start_of(document, &from)?;
        Some(Tag { from, to: None, port })
    }));
    tags
}

/// Paints a name beside its port, and returns its rectangle.
fn paint(ui: &Ui, context: &CanvasContext<'_>, tag: &Tag, port: Pos2, zoom: f32) -> Rect {
    let document = context.document;
    let color = context
        .theme
        .port(document.interfaces().carried(document.shown(), &tag.from));
    let (way, align) = match tag.to {
        Some(_) => (-1.0, Align2::RIGHT_CENTER),
        None => (1.0, Align2::LEFT_CENTER),
    };
    let font = FontId::proportional((type_size::SMALL * zoom * 2.0).round() / 2.0);
    let text = ui
        .painter()
        .layout_no_wrap(name_of(document, &tag.from), font, context.theme.text);
    let near = port + vec2(way * GAP * zoom, 0.0);
    let padding = vec2(6.0, 2.0) * zoom;
    let rect = align.anchor_size(near, text.size() + 2.0 * padding);
    ui.painter().line_segment([port, near], Stroke::new(1.8 * zoom, color));
    ui.painter().rect(
        rect,
        f32::from(space::CORNER) * zoom,
        context.theme.raised,
        Stroke::new(1.0, color),
        StrokeKind::Inside,
    );
    ui.painter().galley(rect.min + padding, text, context.theme.text);
    rect
}
