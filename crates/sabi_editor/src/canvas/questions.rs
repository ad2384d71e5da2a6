//! Small questions on the canvas: how to merge two masks, and the name of a node or a frame.

use egui::{Area, EventFilter, Frame, Id, Key, Order, Pos2, Ui, WidgetInfo, WidgetType};
use sabi_editing::OpenDocument;
use sabi_editing::command::{FrameCommand, NodeCommand, WireCommand};
use sabi_editing::wires::MaskMerge;
use sabi_graph::{NodeId, OutputRef, SlotRef};

use super::camera::CanvasCamera;
use super::focus_id;
use crate::action::Action;

/// Question about how to merge a second mask with the first one.
pub(super) struct MergeQuestion {
    at: Pos2,
    from: OutputRef,
    to: SlotRef,
    /// Index of the answer that has the keyboard.
    chosen: usize,
    is_new: bool,
}

/// Keys of the answers, in their order.
const ANSWERS: [Key; 5] = [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5];

impl MergeQuestion {
    pub(super) fn new(at: Pos2, from: OutputRef, to: SlotRef) -> MergeQuestion {
        MergeQuestion {
            at,
            from,
            to,
            chosen: 0,
            is_new: true,
        }
    }

    /// Shows the answers. Returns the one chosen by a click, by its number, or by arrows and Enter.
    fn answers(&mut self, ui: &mut Ui) -> Option<MaskMerge> {
        let (down, up) = ui.input(|input| (input.key_pressed(Key::ArrowDown), input.key_pressed(Key::ArrowUp)));
        if down {
            self.chosen = (self.chosen + 1).min(MaskMerge::OFFERED.len() - 1);
        }
        if up {
            self.chosen = self.chosen.saturating_sub(1);
        }
        ui.label("The input has a mask already. Combine both by:");
        let mut given = None;
        for (at, ((name, how), key)) in MaskMerge::OFFERED.into_iter().zip(ANSWERS).enumerate() {
            let button = ui.add(egui::Button::new(name).shortcut_text(key.symbol_or_name()));
            button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, name));
            if at == self.chosen {
                focus_answer(ui, &button);
            }
            if button.clicked() || ui.input(|input| input.key_pressed(key)) {
                given = Some(how);
            }
        }
        given
    }
}

/// Shows the question about how to merge two masks.
pub(super) fn merge(question: &mut Option<MergeQuestion>, ui: &Ui, actions: &mut Vec<Action>) {
    let Some(open) = question else { return };
    let mut chosen = None;
    let area = Area::new(Id::new("merge_question"))
        .order(Order::Foreground)
        .current_pos(open.at)
        .constrain(true);
    let shown = area.show(ui.ctx(), |ui| {
        Frame::popup(ui.style()).show(ui, |ui| chosen = open.answers(ui));
    });
    let is_left = ui.input(|input| {
        let at = input.pointer.interact_pos();
        let is_outside = at.is_some_and(|at| !shown.response.rect.contains(at));
        input.key_pressed(Key::Escape) || input.pointer.any_pressed() && is_outside && !open.is_new
    });
    open.is_new = false;
    if let Some(how) = chosen {
        actions.push(Action::edit(WireCommand::Merge {
            from: open.from.clone(),
            to: open.to.clone(),
            how,
        }));
    }
    if chosen.is_some() || is_left {
        *question = None;
        ui.memory_mut(|memory| memory.request_focus(focus_id()));
    }
}

/// Item that is being renamed.
enum NamedItem {
    Node(NodeId),
    Frame(String),
}

/// Name while it is typed.
pub(super) struct ItemRename {
    item: NamedItem,
    text: String,
    is_new: bool,
}

impl ItemRename {
    pub(super) fn node(id: NodeId, text: String) -> ItemRename {
        ItemRename {
            item: NamedItem::Node(id),
            text,
            is_new: true,
        }
    }

    pub(super) fn frame(id: String, text: String) -> ItemRename {
        ItemRename {
            item: NamedItem::Frame(id),
            text,
            is_new: true,
        }
    }
}

/// Shows the text field of a name at the node or frame that has it.
pub(super) fn rename(
    open: &mut Option<ItemRename>,
    ui: &Ui,
    camera: &CanvasCamera,
    document: &OpenDocument,
    actions: &mut Vec<Action>,
) {
    let (Some(panel), Some(renaming)) = (camera.panel, open.as_mut()) else {
        return;
    };
    let corner = match &renaming.item {
        NamedItem::Node(id) => document.node(id).map(|node| node.pos),
        NamedItem::Frame(id) => super::frame_rects::rect_of(document, id).map(|rect| [rect.min.x, rect.min.y]),
    };
    let Some(corner) = corner else {
        *open = None;
        return;
    };
    let at = camera.view.screen(panel, corner);
    let area = Area::new(Id::new("renaming"))
        .order(Order::Foreground)
        .current_pos(at)
        .constrain(true);
    let shown = area.show(ui.ctx(), |ui| {
        Frame::popup(ui.style())
            .show(ui, |ui| {
                let field = ui.add(egui::TextEdit::singleline(&mut renaming.text).desired_width(180.0));
                field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "Name"));
                if renaming.is_new {
                    field.request_focus();
                    renaming.is_new = false;
                }
                field.lost_focus()
            })
            .inner
    });
    if !shown.inner {
        return;
    }
    let is_left = ui.input(|input| input.key_pressed(Key::Escape));
    if let Some(renaming) = open.take().filter(|_| !is_left) {
        actions.push(match renaming.item {
            NamedItem::Node(node) => Action::edit(NodeCommand::Rename {
                node,
                name: renaming.text,
            }),
            NamedItem::Frame(frame) => Action::edit(FrameCommand::Rename {
                frame,
                title: renaming.text,
            }),
        });
    }
}

/// Gives the keyboard to the chosen answer of a question, and keeps the arrow keys from leading out of the answers.
pub(super) fn focus_answer(ui: &Ui, button: &egui::Response) {
    button.request_focus();
    let filter = EventFilter {
        tab: true,
        vertical_arrows: true,
        horizontal_arrows: true,
        escape: true,
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(button.id, filter));
}
