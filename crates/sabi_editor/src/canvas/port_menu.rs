//! What can be done with a port besides wiring it; and the marks of ports that the graph gives to those who use it as a group.

use egui::{Align2, FontId, Painter, Pos2, Response, Stroke, vec2};
use sabi_editing::OpenDocument;
use sabi_graph::{Body, SlotRef};

use super::places::Place;
use super::{AddMenu, Canvas, Purpose};
use crate::action::{Action, PortAction, WireAction};
use crate::theme::{Theme, type_size};

/// Below this zoom the names of what is given on cannot be read.
const LEGIBLE: f32 = 0.7;

/// The menu of a port.
pub(super) fn show(
    canvas: &mut Canvas,
    response: &Response,
    place: &Place,
    document: &OpenDocument,
    actions: &mut Vec<Action>,
) {
    response.context_menu(|ui| {
        let whole = match document.body() {
            Body::Main => "graph",
            Body::Group(_) => "group",
        };
        let given_as = document.given_as(&place.loose());
        let (publish, off) = match place {
            Place::Input(_) => (
                format!("Publish as input of the {whole}"),
                "Take off the input".to_owned(),
            ),
            Place::Output(_) => (
                format!("Publish as output of the {whole}"),
                "Take back the output".to_owned(),
            ),
        };
        match &given_as {
            None if ui.button(publish).clicked() => actions.push(Action::Port(published(place))),
            Some(name) if ui.button(format!("{off} '{name}'")).clicked() => {
                actions.push(Action::Port(taken_back(place, name)));
            }
            _ => {}
        }
        let tied = tied(document, place);
        ui.separator();
        if ui
            .add_enabled(!tied.is_empty(), egui::Button::new("Disconnect"))
            .clicked()
        {
            actions.push(Action::Wire(WireAction::Cut(tied.clone())));
        }
        let instead = match (place, tied.is_empty()) {
            (Place::Input(_), false) => "Replace by…",
            _ => "Connect a new node…",
        };
        if ui.button(instead).clicked() {
            canvas.open_port_menu(document, place, response.rect.center());
        }
    });
}

fn published(place: &Place) -> PortAction {
    match place {
        Place::Input(slot) => PortAction::PublishInput(slot.clone()),
        Place::Output(from) => PortAction::PublishOutput(from.clone()),
    }
}

fn taken_back(place: &Place, name: &str) -> PortAction {
    match place {
        Place::Input(slot) => PortAction::Unfeed(slot.clone()),
        Place::Output(_) => PortAction::RemoveOutput(name.to_owned()),
    }
}

/// The inputs whose wires end or begin at a port.
fn tied(document: &OpenDocument, place: &Place) -> Vec<SlotRef> {
    match place {
        Place::Input(slot) => document.wire_into(slot).map(|_| slot.clone()).into_iter().collect(),
        Place::Output(from) => {
            let readers = document.graph().readers(from.node.as_str()).into_iter();
            readers.filter(|slot| document.reads(slot, from)).collect()
        }
    }
}

impl Canvas {
    /// Opens the menu of nodes for one that is tied to a port.
    fn open_port_menu(&mut self, document: &OpenDocument, place: &Place, at: Pos2) {
        let aside = match place {
            Place::Input(_) => -(sabi_editing::NODE_WIDTH + 60.0),
            Place::Output(_) => 60.0,
        };
        let on_canvas = place.on_canvas(document).unwrap_or_default();
        let purpose = Purpose {
            place: [on_canvas[0] + aside, on_canvas[1] - 20.0],
            loose: Some(place.loose()),
            ..Purpose::default()
        };
        self.menu = Some(AddMenu::new(at, purpose));
    }
}

/// Marks a port that the graph gives on, with the name that it has outside.
pub(super) fn mark(painter: &Painter, theme: &Theme, document: &OpenDocument, place: &Place, center: Pos2, zoom: f32) {
    let Some(name) = document.given_as(&place.loose()) else {
        return;
    };
    let (way, align) = match place {
        Place::Input(_) => (-1.0, Align2::RIGHT_CENTER),
        Place::Output(_) => (1.0, Align2::LEFT_CENTER),
    };
    let [near, far] = [9.0, 24.0].map(|away| center + vec2(way * away * zoom, 0.0));
    painter.line_segment([near, far], Stroke::new(2.0 * zoom, theme.accent));
    painter.circle_filled(far, 3.0 * zoom, theme.accent);
    if zoom > LEGIBLE {
        let font = FontId::proportional((type_size::SMALL * zoom * 2.0).round() / 2.0);
        painter.text(far + vec2(way * 7.0 * zoom, 0.0), align, name, font, theme.quiet);
    }
}
