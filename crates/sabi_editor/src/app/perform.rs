//! What is asked for is done here, and nowhere else.

mod commands;
mod publishing;

use egui::Ui;
use sabi_graph::{NodeId, SlotRef};

use super::Editor;
use crate::action::{Action, FrameAsk, LayerAsk, New, WireAsk};
use crate::canvas::Way;
use crate::desk::{Desk, KnobAt, Loose};
use crate::dock::Panel;
use crate::files::Next;
use crate::knobs::KnobEvent;

impl Editor {
    /// Does what a panel asks for.
    pub(super) fn perform(&mut self, action: Action, ui: &Ui) {
        let desk = &mut self.desk;
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
            Action::BeginMove => desk.session.begin("Move"),
            Action::Move(places) => {
                desk.move_to("Move", places);
            }
            Action::EndMove => desk.session.end(),
            Action::TakeBack => desk.take_back(),
            Action::TakeOut => {
                desk.take_out();
            }
            Action::Select(ids) => self.select(ids),
            Action::Arrow(way) => self.follow_arrow(way, ui),
            Action::Toggle(id) => desk.toggle(&id),
            Action::Show { node, port } => self.look_at(&node, port),
            Action::Pin { node } => self.pin(&node),
            Action::Look(asked) => self.look(asked),
            Action::Enter(id) => {
                desk.enter(&id);
            }
            Action::LeaveTo(depth) => {
                desk.leave_to(depth);
            }
            Action::Knob { node, event } => self.turn_knob(&node, event),
            Action::Panel(asked) => self.change_panel(asked),
            Action::Variant(asked) => self.change_variants(asked),
            Action::Port(asked) => self.change_ports(asked),
            Action::Layer(asked) => self.change_layers(asked),
            Action::Rename { node, name } => {
                desk.rename(&node, &name);
            }
            Action::Frame(asked) => self.change_frames(asked),
            Action::Paste { text, place } => {
                desk.paste(&text, place);
            }
            Action::OpenFile(path) => self.files.ask_next(&mut self.desk, Next::Open(path)),
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
            if steps < 0 { self.desk.undo() } else { self.desk.redo() }
        }
    }

    /// Goes to the node or the port that an arrow key leads to.
    fn follow_arrow(&mut self, way: Way, ui: &Ui) {
        for action in self.canvas.arrow(&self.desk, way) {
            self.perform(action, ui);
        }
    }

    /// Adds a node, ties it to the wire in hand or puts it into another one, and looks at it.
    fn add(&mut self, kind: &New, place: [f32; 2], loose: Option<&Loose>, into: Option<&SlotRef>) {
        let desk = &mut self.desk;
        desk.session.begin("Add");
        let added = match kind {
            New::Kind(kind) => desk.add(kind, place, loose),
            New::Group(group) => desk.add_group_instance(group, place, loose),
            New::Library(file) => desk.add_from_library(file, place, loose),
        };
        if let Some((id, into)) = added.as_ref().zip(into) {
            desk.insert(id, into);
        }
        desk.session.end();
        if let Some(id) = added {
            self.look_at(&id, None);
        }
    }

    /// Puts something in the place of a node; who looked at that one looks at it.
    fn replace(&mut self, node: &NodeId, by: &New) {
        let gone = self.desk.full_id(node);
        let desk = &mut self.desk;
        let is_made = match by {
            New::Kind(kind) => desk.replace(node, kind),
            New::Group(group) => desk.replace_by_group(node, group),
            New::Library(file) => {
                desk.session.begin("Replace by a group");
                let group = desk.bring_from_library(file);
                let is_made = group.is_some_and(|group| desk.replace_by_group(node, &group));
                if is_made {
                    desk.session.end();
                } else {
                    desk.take_back();
                }
                is_made
            }
        };
        if let Some(new) = self.desk.selected_one().cloned().filter(|_| is_made) {
            self.look_on(&gone, &new);
        }
    }

    fn change_wires(&mut self, asked: WireAsk) {
        let desk = &mut self.desk;
        match asked {
            WireAsk::Connect { from, to, off } => {
                desk.session.begin("Connect");
                if desk.connect(&from, &to)
                    && let Some(off) = off
                {
                    desk.cut(&[off]);
                }
                desk.session.end();
            }
            WireAsk::Merge { from, to, how } => drop(desk.merge(&from, &to, how)),
            WireAsk::Cut(slots) => drop(desk.cut(&slots)),
            WireAsk::Insert { node, into } => drop(desk.insert(&node, &into)),
            WireAsk::Reroute { into, place } => drop(desk.reroute(&into, place)),
        }
    }

    fn change_frames(&mut self, asked: FrameAsk) {
        let desk = &mut self.desk;
        match asked {
            FrameAsk::Rename { frame, title } => self.change_frame(&frame, |known| known.title = Some(title)),
            FrameAsk::Recolor(frame) => self.change_frame(&frame, |known| {
                known.color = Some(Desk::next_color(known.color.as_deref()));
            }),
            FrameAsk::Select(frame) => desk.select_frame(&frame),
            FrameAsk::Fill(frame) => {
                let nodes = desk.selection().clone();
                desk.put_into_frame(&nodes, frame.as_deref());
            }
            FrameAsk::Remove(frame) => drop(desk.remove_frame(&frame)),
        }
    }

    fn change_layers(&mut self, asked: LayerAsk) {
        let desk = &mut self.desk;
        match asked {
            LayerAsk::Toggle(id) => drop(desk.toggle_layer(&id)),
            LayerAsk::Opacity { node, opacity } => drop(desk.set_layer_opacity(&node, opacity)),
            LayerAsk::Move { end, from, to } => drop(desk.move_layer(&end, from, to)),
            LayerAsk::Remove { end, at } => drop(desk.remove_layer(&end, at)),
            LayerAsk::Add { end, at, kind } => {
                if let Some(id) = desk.add_layer(&end, at, &kind) {
                    self.look_at(&id, None);
                }
            }
        }
    }

    fn change_frame(&mut self, id: &str, change: impl FnOnce(&mut sabi_graph::Frame)) {
        if let Some(mut frame) = self.desk.graph().frames().get(id).cloned() {
            change(&mut frame);
            self.desk.set_frame("Change frame", id, frame);
        }
    }

    fn turn_knob(&mut self, node: &NodeId, event: KnobEvent) {
        let desk = &mut self.desk;
        match event {
            KnobEvent::Set { knob, value } => {
                desk.set_knob_of_alike(node, &knob, Some(value));
            }
            KnobEvent::Reset { knob } => {
                desk.set_knob_of_alike(node, &knob, None);
            }
            KnobEvent::Expose { knob } => self.expose_of_alike(node, &knob),
            KnobEvent::Unexpose { knob } => {
                desk.take_off_panel(node, &knob);
            }
            KnobEvent::Eyedropper { knob } => self.ask_for_color(KnobAt::of_node(node, knob)),
            KnobEvent::Browse { knob } => self.files.ask_for_picture(KnobAt::of_node(node, knob)),
            KnobEvent::Began | KnobEvent::Ended | KnobEvent::GivenUp | KnobEvent::ShowLength(_) => {
                self.move_knob(&event)
            }
        }
    }

    /// Publishes a knob: one on the panel turns it on all selected nodes of the kind.
    fn expose_of_alike(&mut self, node: &NodeId, knob: &str) {
        let desk = &mut self.desk;
        let kind = |desk: &Desk, id: &NodeId| desk.node(id).map(|node| node.kind.clone());
        let alike = desk
            .selection()
            .iter()
            .filter(|id| *id != node && kind(desk, id) == kind(desk, node));
        let alike: Vec<NodeId> = alike.cloned().collect();
        desk.session.begin("Expose");
        desk.expose(node, knob);
        if let Some(name) = desk.exposed_as(node, knob).map(str::to_owned) {
            for other in alike {
                desk.expose_as(&other, knob, &name);
            }
        }
        desk.session.end();
    }

    /// Shows a node, in the group that it is in.
    fn go_to(&mut self, node: &str) {
        self.desk.leave_to(0);
        let steps: Vec<NodeId> = node.split('/').filter_map(|step| step.parse().ok()).collect();
        let Some((mut last, instances)) = steps.split_last() else {
            return;
        };
        for instance in instances {
            if !self.desk.enter(instance) {
                // What is in a group file is not seen here; the nearest to it is the instance.
                last = instance;
                break;
            }
        }
        self.desk.select([last.clone()]);
        self.bring_up(Panel::Canvas);
        self.canvas.frame_nodes(&self.desk, [last].into_iter());
        self.look_at(last, None);
    }
}
