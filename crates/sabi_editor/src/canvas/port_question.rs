//! The question to which input of a node a dropped wire leads: plain inputs, and parameters that a mask multiplies.

use egui::{Area, Frame, Id, Key, Order, Pos2, Rect, ScrollArea, Ui, WidgetInfo, WidgetType, pos2};
use sabi_editing::node_size::{own_knobs, rows_of};
use sabi_editing::{OpenDocument, connections, wires};
use sabi_graph::{NodeId, OutputRef, SlotRef};

use super::questions::focus_answer;
use super::{CARD_ZOOM, Canvas, focus_id, node_rect};

/// Largest height of the list, points.
const HIGHEST: f32 = 320.0;

/// Inputs of a node that a dropped wire may lead to.
pub(super) struct PortChoices {
    /// Plain inputs.
    plain: Vec<SlotRef>,
    /// Inputs for masks that multiply parameters.
    params: Vec<SlotRef>,
    /// Index among all of them of the one that is offered first.
    aimed: usize,
}

/// Choices for a wire that is dropped on a node. There are none where a plain input takes the wire, unless it is dropped on a
/// parameter that takes a mask.
pub(super) fn choices(
    canvas: &Canvas,
    document: &OpenDocument,
    panel: Rect,
    from: &OutputRef,
    pointer: Pos2,
) -> Option<PortChoices> {
    let here = canvas.camera.view.place(panel, pointer);
    let is_under = |id: &&NodeId| node_rect(document, id).is_some_and(|rect| rect.contains(pos2(here[0], here[1])));
    let under = document.graph().ids().filter(is_under);
    // The node that is drawn above the others.
    let node = under.max_by_key(|id| {
        let turn = canvas.draw_order.iter().position(|known| known == *id);
        (document.selection().contains(*id), turn)
    })?;
    let [plain, params] = wires::accepting(document, from, node);
    let down = here[1] - document.node(node)?.pos[1];
    let knob = rows_of(document, node)?
        .knob_at(down)
        .filter(|_| canvas.camera.view.zoom >= CARD_ZOOM)
        .and_then(|at| own_knobs(document.interface(node)?).nth(at));
    let pointed = knob.and_then(|knob| params.iter().position(|slot| slot.name == knob.name));
    let aimed = match pointed {
        Some(at) => plain.len() + at,
        None if plain.is_empty() && !params.is_empty() => 0,
        None => return None,
    };
    Some(PortChoices { plain, params, aimed })
}

/// The question while it is open.
pub(super) struct PortQuestion {
    at: Pos2,
    from: OutputRef,
    /// Input that the wire was taken off.
    off: Option<SlotRef>,
    choices: PortChoices,
    /// Index of the answer that has the keyboard.
    chosen: usize,
    is_new: bool,
}

/// Answer to the question: the ends of the wire, and the input that it was taken off.
pub(super) struct ChosenPort {
    pub(super) from: OutputRef,
    pub(super) to: SlotRef,
    pub(super) off: Option<SlotRef>,
    pub(super) at: Pos2,
}

impl PortQuestion {
    pub(super) fn new(at: Pos2, from: OutputRef, off: Option<SlotRef>, choices: PortChoices) -> PortQuestion {
        PortQuestion {
            at,
            from,
            off,
            chosen: choices.aimed,
            choices,
            is_new: true,
        }
    }

    /// Shows the answers. Returns the one chosen by a click, or by arrows and Enter.
    fn answers(&mut self, ui: &mut Ui, document: &OpenDocument) -> Option<SlotRef> {
        let count = self.choices.plain.len() + self.choices.params.len();
        let (down, up) = ui.input(|input| (input.key_pressed(Key::ArrowDown), input.key_pressed(Key::ArrowUp)));
        if down {
            self.chosen = (self.chosen + 1).min(count.saturating_sub(1));
        }
        if up {
            self.chosen = self.chosen.saturating_sub(1);
        }
        let mut given = None;
        let all = self.choices.plain.iter().chain(&self.choices.params);
        for (at, slot) in all.enumerate() {
            let label = connections::input(document, slot).map_or(&slot.name, |port| &port.label);
            let is_param = at >= self.choices.plain.len();
            if at == 0 && !is_param {
                ui.label("Connect to:");
            }
            if at == self.choices.plain.len() {
                ui.label("Multiply by the mask:");
            }
            let button = ui.button(label);
            let name = if is_param {
                format!("Multiply {label}")
            } else {
                label.clone()
            };
            button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &name));
            if at == self.chosen {
                if self.is_new || down || up {
                    button.scroll_to_me(None);
                }
                focus_answer(ui, &button);
            }
            if button.clicked() {
                given = Some(slot.clone());
            }
        }
        given
    }
}

/// Shows the question, and returns the answer once it is given.
pub(super) fn show(question: &mut Option<PortQuestion>, ui: &Ui, document: &OpenDocument) -> Option<ChosenPort> {
    let open = question.as_mut()?;
    let area = Area::new(Id::new("port_question"))
        .order(Order::Foreground)
        .current_pos(open.at)
        .constrain(true);
    let shown = area.show(ui.ctx(), |ui| {
        let list = ScrollArea::vertical().max_height(HIGHEST).min_scrolled_height(HIGHEST);
        let frame = Frame::popup(ui.style());
        frame
            .show(ui, |ui| list.show(ui, |ui| open.answers(ui, document)).inner)
            .inner
    });
    let is_left = ui.input(|input| {
        let at = input.pointer.interact_pos();
        let is_outside = at.is_some_and(|at| !shown.response.rect.contains(at));
        input.key_pressed(Key::Escape) || input.pointer.any_pressed() && is_outside && !open.is_new
    });
    open.is_new = false;
    let (from, off, at) = (open.from.clone(), open.off.clone(), open.at);
    let chosen = shown.inner.map(|to| ChosenPort { from, to, off, at });
    if chosen.is_some() || is_left {
        *question = None;
        ui.memory_mut(|memory| memory.request_focus(focus_id()));
    }
    chosen
}
