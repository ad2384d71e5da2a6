//! What is asked for is done here, and nowhere else.

mod commands;
mod publishing;

use egui::Ui;
use sabi_editing::{KnobTarget, OpenDocument, PendingWire};
use sabi_graph::{NodeId, SlotRef};

use super::Editor;
use crate::action::{Action, FrameAsk, LayerAsk, New, WireAsk};
use crate::canvas::Way;
use crate::dock::Panel;
use crate::files::Next;
use crate::knobs::KnobEvent;

impl Editor {
    /// Does what a panel asks for.
    pub(super) fn perform(&mut self, action: Action, ui: &Ui) {
        let document = &mut self.document;
        match action {
            Action::Do(command) => self.command(command, ui),
            Action::Add {
                kind,
                place,
                loose,
                into,
            } => self.add(&kind, place, loose.as_ref(), into.as_ref()),
            Action::SaveNode(node) => self.save_node(&node),
            Action::Shelve(shelf) => self.shelve_selected(shelf),
            Action::Replace { node, by } => self.replace(&node, &by),
            Action::Wire(asked) => self.change_wires(asked),
            Action::BeginMove => document.session.begin("Move"),
            Action::Move(places) => {
                document.move_to("Move", places);
            }
            Action::EndMove => document.session.end(),
            Action::TakeBack => document.take_back(),
            Action::TakeOut => {
                document.take_out();
            }
            Action::Select(ids) => self.select(ids),
            Action::Arrow(way) => self.follow_arrow(way, ui),
            Action::Toggle(id) => document.toggle(&id),
            Action::Show { node, port } => self.look_at(&node, port),
            Action::Pin { node } => self.pin(&node),
            Action::Look(asked) => self.look(asked),
            Action::Enter(id) => {
                document.enter(&id);
            }
            Action::LeaveTo(depth) => {
                document.leave_to(depth);
            }
            Action::Knob { node, event } => self.turn_knob(&node, event),
            Action::Panel(asked) => self.change_panel(asked),
            Action::Variant(asked) => self.change_variants(asked),
            Action::Port(asked) => self.change_ports(asked),
            Action::Layer(asked) => self.change_layers(asked),
            Action::Rename { node, name } => {
                document.rename(&node, &name);
            }
            Action::Frame(asked) => self.change_frames(asked),
            Action::Paste { text, place } => {
                document.paste(&text, place);
            }
            Action::OpenFile(path) => self.files.ask_next(&mut self.document, Next::Open(path)),
            Action::TakeModel(path) => self.take_model(&path),
            Action::ReadModel(reading) => self.read_model(reading),
            Action::Dropped(path) => self.take_dropped_file(&path, ui),
            Action::GoTo(node) => self.go_to(&node),
            Action::Steps(steps) => self.go_steps(steps),
        }
    }

    /// Takes back so many steps, or does them again.
    fn go_steps(&mut self, steps: i32) {
        for _ in 0..steps.unsigned_abs() {
            if steps < 0 {
                self.document.undo()
            } else {
                self.document.redo()
            }
        }
    }

    /// Goes to the node or the port that an arrow key leads to.
    fn follow_arrow(&mut self, way: Way, ui: &Ui) {
        for action in self.canvas.arrow(&self.document, way) {
            self.perform(action, ui);
        }
    }

    /// Adds a node, ties it to the wire in hand or puts it into another one, and looks at it.
    fn add(&mut self, kind: &New, place: [f32; 2], loose: Option<&PendingWire>, into: Option<&SlotRef>) {
        let document = &mut self.document;
        document.session.begin("Add");
        let added = match kind {
            New::Kind(kind) => document.add(kind, place, loose),
            New::Group(group) => document.add_group_instance(group, place, loose),
            New::Library(file) => document.add_from_library(file, place, loose),
        };
        if let Some((id, into)) = added.as_ref().zip(into) {
            document.insert(id, into);
        }
        document.session.end();
        if let Some(id) = added {
            self.look_at(&id, None);
        }
    }

    /// Puts something in the place of a node; who looked at that one looks at it.
    fn replace(&mut self, node: &NodeId, by: &New) {
        let gone = self.document.full_id(node);
        let document = &mut self.document;
        let is_made = match by {
            New::Kind(kind) => document.replace(node, kind),
            New::Group(group) => document.replace_by_group(node, group),
            New::Library(file) => {
                document.session.begin("Replace by a group");
                let group = document.bring_from_library(file);
                let is_made = group.is_some_and(|group| document.replace_by_group(node, &group));
                if is_made {
                    document.session.end();
                } else {
                    document.take_back();
                }
                is_made
            }
        };
        if let Some(new) = self.document.selected_one().cloned().filter(|_| is_made) {
            self.look_on(&gone, &new);
        }
    }

    fn change_wires(&mut self, asked: WireAsk) {
        let document = &mut self.document;
        match asked {
            WireAsk::Connect { from, to, off } => {
                document.session.begin("Connect");
                if document.connect(&from, &to)
                    && let Some(off) = off
                {
                    document.cut(&[off]);
                }
                document.session.end();
            }
            WireAsk::Merge { from, to, how } => drop(document.merge(&from, &to, how)),
            WireAsk::Cut(slots) => drop(document.cut(&slots)),
            WireAsk::Insert { node, into } => drop(document.insert(&node, &into)),
            WireAsk::Reroute { into, place } => drop(document.reroute(&into, place)),
        }
    }

    fn change_frames(&mut self, asked: FrameAsk) {
        let document = &mut self.document;
        match asked {
            FrameAsk::Rename { frame, title } => self.change_frame(&frame, |known| known.title = Some(title)),
            FrameAsk::Recolor(frame) => self.change_frame(&frame, |known| {
                known.color = Some(OpenDocument::next_color(known.color.as_deref()));
            }),
            FrameAsk::Select(frame) => document.select_frame(&frame),
            FrameAsk::Fill(frame) => {
                let nodes = document.selection().clone();
                document.put_into_frame(&nodes, frame.as_deref());
            }
            FrameAsk::Remove(frame) => drop(document.remove_frame(&frame)),
        }
    }

    fn change_layers(&mut self, asked: LayerAsk) {
        let document = &mut self.document;
        match asked {
            LayerAsk::Toggle(id) => drop(document.toggle_layer(&id)),
            LayerAsk::Opacity { node, opacity } => drop(document.set_layer_opacity(&node, opacity)),
            LayerAsk::Move { end, from, to } => drop(document.move_layer(&end, from, to)),
            LayerAsk::Remove { end, at } => drop(document.remove_layer(&end, at)),
            LayerAsk::Add { end, at, kind } => {
                if let Some(id) = document.add_layer(&end, at, &kind) {
                    self.look_at(&id, None);
                }
            }
        }
    }

    fn change_frame(&mut self, id: &str, change: impl FnOnce(&mut sabi_graph::Frame)) {
        if let Some(mut frame) = self.document.graph().frames().get(id).cloned() {
            change(&mut frame);
            self.document.set_frame("Change frame", id, frame);
        }
    }

    fn turn_knob(&mut self, node: &NodeId, event: KnobEvent) {
        let document = &mut self.document;
        match event {
            KnobEvent::Set { knob, value } => {
                document.set_knob_of_alike(node, &knob, Some(value));
            }
            KnobEvent::Reset { knob } => {
                document.set_knob_of_alike(node, &knob, None);
            }
            KnobEvent::Expose { knob } => self.expose_of_alike(node, &knob),
            KnobEvent::Unexpose { knob } => {
                document.take_off_panel(node, &knob);
            }
            KnobEvent::Eyedropper { knob } => self.ask_for_color(KnobTarget::of_node(node, knob)),
            KnobEvent::Browse { knob } => self.files.ask_for_picture(KnobTarget::of_node(node, knob)),
            KnobEvent::Began | KnobEvent::Ended | KnobEvent::GivenUp | KnobEvent::ShowLength(_) => {
                self.move_knob(&event)
            }
        }
    }

    /// Publishes a knob: one on the panel turns it on all selected nodes of the kind.
    fn expose_of_alike(&mut self, node: &NodeId, knob: &str) {
        let document = &mut self.document;
        let kind = |document: &OpenDocument, id: &NodeId| document.node(id).map(|node| node.kind.clone());
        let alike = document
            .selection()
            .iter()
            .filter(|id| *id != node && kind(document, id) == kind(document, node));
        let alike: Vec<NodeId> = alike.cloned().collect();
        document.session.begin("Expose");
        document.expose(node, knob);
        if let Some(name) = document.exposed_as(node, knob).map(str::to_owned) {
            for other in alike {
                document.expose_as(&other, knob, &name);
            }
        }
        document.session.end();
    }

    /// Shows a node, in the group that it is in.
    fn go_to(&mut self, node: &str) {
        self.document.leave_to(0);
        let steps: Vec<NodeId> = node.split('/').filter_map(|step| step.parse().ok()).collect();
        let Some((mut last, instances)) = steps.split_last() else {
            return;
        };
        for instance in instances {
            if !self.document.enter(instance) {
                // What is in a group file is not seen here; the nearest to it is the instance.
                last = instance;
                break;
            }
        }
        self.document.select([last.clone()]);
        self.bring_up(Panel::Canvas);
        self.canvas.frame_nodes(&self.document, [last].into_iter());
        self.look_at(last, None);
    }
}
