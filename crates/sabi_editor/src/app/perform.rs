//! The one place where actions are performed. No match here has a wildcard: an action or a command that is not handled does
//! not compile.

mod commands;
mod graph;

use std::path::Path;

use egui::Ui;
use sabi_editing::connections::PendingWire;
use sabi_editing::knob_target::KnobTarget;
use sabi_editing::{
    clipboard, knob_target, layers, navigation, nodes, panel, panel_values, relative_paths, selection, variants, wires,
};
use sabi_graph::{NodeId, SlotRef, Value};

use super::Editor;
use crate::action::{
    Action, ArrowKey, ClickedColor, ExportAction, FileAction, LayerAction, ModelAction, NewNode, PublishedAction,
    VariantAction,
};
use crate::dock::Panel;
use crate::knobs::KnobEvent;
use crate::looks::result_of;
use crate::paths::canonical_if_present;

impl Editor {
    /// Performs the actions of a frame, and what follows from them.
    pub(super) fn perform_all(&mut self, actions: Vec<Action>, ui: &Ui) {
        let length = self.looks.length.take();
        for action in actions {
            self.perform(action, ui);
        }
        // The viewport has been drawn without it.
        if self.looks.length != length {
            ui.ctx().request_repaint();
        }
        let is_dirty = self.documents.document.session.is_dirty();
        if let Some(next) = self.views.questions.take_next(is_dirty) {
            self.proceed(next);
        }
        for sentence in self.documents.document.take_notices() {
            self.shell.say(sentence);
        }
    }

    /// Performs an action.
    pub(super) fn perform(&mut self, action: Action, ui: &Ui) {
        let document = &mut self.documents.document;
        match action {
            Action::Do(command) => self.command(command, ui),
            Action::Notice(sentence) => self.shell.say(sentence),
            Action::Add {
                new,
                place,
                loose,
                into,
            } => self.add(&new, place, loose.as_ref(), into.as_ref()),
            Action::AddInMiddle(new) => self.add(&new, self.views.canvas.middle(), None, None),
            Action::DragNew { face, at } => self.views.canvas.drag_new(ui, &self.shell.theme, document, &face, at),
            Action::DropNew { new, face, at } => {
                if let Some((place, into)) = self.views.canvas.place_for_dropped(document, &face, at) {
                    self.add(&new, place, None, into.as_ref());
                }
            }
            Action::AddToLibrary(shelf) => self.shelve(shelf),
            Action::SaveNode(node) => self.save_node(&node),
            Action::Replace { node, by } => self.replace(&node, &by),
            Action::Wire(action) => graph::change_wires(document, action),
            Action::Move(action) => graph::move_nodes(document, action),
            Action::TakeOut => drop(wires::detach_selected(document)),
            Action::Select(ids) => self.select(ids),
            Action::Arrow(key) => self.follow_arrow(key, ui),
            Action::Toggle(id) => selection::toggle(document, &id),
            Action::Show { node, port } => self.looks.show(document, &node, port),
            Action::Pin { node } => self.looks.toggle_pin(document, &node),
            Action::Look(action) => self.looks.perform(action, &mut self.shell.settings),
            Action::Enter(id) => drop(navigation::enter(document, &id)),
            Action::LeaveTo(depth) => drop(navigation::leave_to(document, depth)),
            Action::Knob { node, event } => self.change_knob(&node, event),
            Action::Published(action) => self.change_published(action),
            Action::Variant(action) => self.change_variants(action),
            Action::Port(action) => graph::change_ports(document, action),
            Action::Layer(action) => self.change_layers(action),
            Action::Rename { node, name } => drop(nodes::rename(document, &node, &name)),
            Action::Frame(action) => graph::change_frames(document, action),
            Action::Paste { text, place } => drop(clipboard::paste(document, &text, place)),
            Action::Document(action) => graph::change_document(document, action),
            Action::File(action) => self.perform_on_file(action),
            Action::Model(action) => self.perform_on_model(action),
            Action::Dropped(path) => self.take_dropped(&path, ui),
            Action::GoTo(node) => self.go_to(&node),
            Action::Steps(steps) => graph::step(document, steps),
            Action::Export(action) => self.perform_export(action),
            Action::TakeColor(color) => self.take_color(color),
            Action::Setting(action) => self.shell.set(action),
            Action::ShowPanel(panel) => self.shell.dock.bring_up(panel),
            Action::ResetPanels => self.shell.dock.reset(),
            Action::ShowStartPage => self.views.start.is_open = true,
        }
    }

    fn perform_on_file(&mut self, action: FileAction) {
        match action {
            FileAction::Ask(next) => {
                let is_dirty = self.documents.document.session.is_dirty();
                self.views.questions.ask_next(is_dirty, next);
            }
            FileAction::Proceed(next) => self.proceed(next),
            FileAction::Save => self.save(),
            FileAction::SaveAs(file) => {
                let own = self.documents.document.session.file().map(canonical_if_present);
                let is_taken = file.exists() && own != Some(canonical_if_present(&file));
                match is_taken {
                    true => self.views.questions.ask_to_replace(file),
                    false => self.save_to(&file),
                }
            }
            FileAction::Overwrite(file) => self.save_to(&file),
            FileAction::Reload => self.reload(),
            FileAction::KeepOpen => {
                self.documents.is_file_foreign = false;
                self.documents.document.session.keep_apart();
                self.documents.autosave.invalidate();
            }
            FileAction::DeleteRecovery(at) => {
                let recoveries = &mut self.documents.recoveries;
                if at < recoveries.len() {
                    recoveries.remove(at).forget();
                }
            }
            FileAction::SetImage { parameter, file } => self.set_image(&parameter, &file),
        }
    }

    fn set_image(&mut self, parameter: &KnobTarget, file: &Path) {
        let document = &mut self.documents.document;
        match relative_paths::relative(document, file) {
            Ok(text) => {
                knob_target::set(document, parameter, Value::Text(text));
            }
            Err(refused) => document.notify(refused.to_string()),
        }
    }

    fn perform_on_model(&mut self, action: ModelAction) {
        match action {
            ModelAction::Ask => self.views.questions.ask_for_model(),
            ModelAction::Show(path) => self.take_model(&path),
            ModelAction::Read(reading) => self.read_model(reading),
            ModelAction::Remove(path) => self.shell.settings.models.retain(|known| *known != path),
        }
    }

    fn perform_export(&mut self, action: ExportAction) {
        match action {
            ExportAction::Start { force } => self.export(force),
            ExportAction::Cancel => self.exports.cancel(),
            ExportAction::Choose(choices) => self.shell.settings.export = choices,
            ExportAction::Target(place) => {
                self.exports.asks_force &= place.folder == self.exports.place.folder;
                self.exports.place = place;
            }
        }
    }

    /// Selects nodes; without any, the model shows the outputs again.
    fn select(&mut self, ids: Vec<NodeId>) {
        if ids.is_empty() {
            self.looks.followed = None;
        }
        self.documents.document.select(ids);
    }

    /// Goes to the node or the port that an arrow key leads to.
    fn follow_arrow(&mut self, key: ArrowKey, ui: &Ui) {
        for action in self.views.canvas.arrow(&self.documents.document, key) {
            self.perform(action, ui);
        }
    }

    /// Adds a node, connected to a loose wire or put into a wire, and shows its result.
    fn add(&mut self, new: &NewNode, place: [f32; 2], loose: Option<&PendingWire>, into: Option<&SlotRef>) {
        if let Some(id) = graph::add(&mut self.documents.document, new, place, loose, into) {
            self.looks.show(&self.documents.document, &id, None);
        }
    }

    /// Replaces a node, also wherever its result is shown.
    fn replace(&mut self, node: &NodeId, by: &NewNode) {
        let document = &mut self.documents.document;
        let before = document.full_id(node);
        if let Some(id) = graph::replace(document, node, by) {
            self.looks.replace(&before, &result_of(document, &id, None));
        }
    }

    fn change_layers(&mut self, action: LayerAction) {
        let document = &mut self.documents.document;
        match action {
            LayerAction::Toggle(id) => drop(layers::toggle(document, &id)),
            LayerAction::Opacity { node, opacity } => drop(layers::set_opacity(document, &node, opacity)),
            LayerAction::Move { end, from, to } => drop(layers::move_to(document, &end, from, to)),
            LayerAction::Remove { end, at } => drop(layers::remove(document, &end, at)),
            LayerAction::Add { end, at, kind } => {
                if let Some(id) = layers::add(document, &end, at, &kind) {
                    self.looks.show(document, &id, None);
                }
            }
        }
    }

    /// Changes a parameter of a node, and of the selected nodes of its kind.
    fn change_knob(&mut self, node: &NodeId, event: KnobEvent) {
        let document = &mut self.documents.document;
        match event {
            KnobEvent::Set { knob, value } => drop(nodes::set_knob_of_selected(document, node, &knob, Some(value))),
            KnobEvent::Reset { knob } => drop(nodes::set_knob_of_selected(document, node, &knob, None)),
            KnobEvent::Expose { knob } => graph::expose_of_alike(document, node, &knob),
            KnobEvent::Unexpose { knob } => drop(panel::unexpose_knob(document, node, &knob)),
            KnobEvent::Eyedropper { knob } => self.toggle_color_target(KnobTarget::of_node(node, knob)),
            KnobEvent::Browse { knob } => self.views.questions.ask_for_image(KnobTarget::of_node(node, knob)),
            KnobEvent::Began => self.begin_drag(),
            KnobEvent::Ended => self.end_drag(),
            KnobEvent::GivenUp => self.cancel_drag(),
            KnobEvent::ShowLength(length) => self.looks.length = Some(length).filter(|length| length.is_finite()),
        }
    }

    fn change_published(&mut self, action: PublishedAction) {
        let document = &mut self.documents.document;
        match action {
            PublishedAction::Turn(event) => self.change_published_value(event),
            PublishedAction::Label { name, label } => drop(panel::set_label(document, &name, &label)),
            PublishedAction::Rename { name, to } => drop(panel::rename(document, &name, &to)),
            PublishedAction::Section { name, section } => drop(panel::set_section(document, &name, &section)),
            PublishedAction::Range { name, range } => drop(panel_values::set_range(document, &name, range)),
            PublishedAction::Default { name, default } => drop(panel_values::set_default(document, &name, default)),
            PublishedAction::Move { name, before } => drop(panel::move_knob(document, &name, before.as_deref())),
            PublishedAction::TakeOff(name) => drop(panel::unexpose(document, &name)),
        }
    }

    fn change_published_value(&mut self, event: KnobEvent) {
        let document = &mut self.documents.document;
        match event {
            KnobEvent::Set { knob, value } => drop(panel_values::set(document, &knob, &value)),
            KnobEvent::Reset { knob } => drop(panel_values::reset(document, &knob)),
            KnobEvent::Unexpose { knob } => drop(panel::unexpose(document, &knob)),
            KnobEvent::Eyedropper { knob } => self.toggle_color_target(KnobTarget::Panel(knob)),
            KnobEvent::Browse { knob } => self.views.questions.ask_for_image(KnobTarget::Panel(knob)),
            KnobEvent::Began => self.begin_drag(),
            KnobEvent::Ended => self.end_drag(),
            KnobEvent::GivenUp => self.cancel_drag(),
            KnobEvent::ShowLength(length) => self.looks.length = Some(length).filter(|length| length.is_finite()),
            // A parameter of the panel is published already.
            KnobEvent::Expose { .. } => {}
        }
    }

    /// Begins the drag of a parameter: all of it is one step to undo, and results are quick meanwhile.
    fn begin_drag(&mut self) {
        self.documents.document.session.begin("Turn a knob");
        self.documents.is_dragging = true;
    }

    /// Ends the drag of a parameter. It has ended already where its row has disappeared.
    fn end_drag(&mut self) {
        if self.documents.is_dragging {
            self.documents.document.session.end();
            self.documents.is_dragging = false;
        }
    }

    /// Cancels the drag of a parameter.
    fn cancel_drag(&mut self) {
        self.documents.document.cancel_step();
        self.documents.is_dragging = false;
    }

    fn toggle_color_target(&mut self, parameter: KnobTarget) {
        if self.looks.toggle_color_target(parameter) {
            self.shell
                .say("Click the color on the model or in the 2D view. Escape gives it up.");
        }
    }

    /// Gives the clicked color to the parameter that waits for one. Where there is none, it waits for another click.
    fn take_color(&mut self, color: ClickedColor) {
        let Some([red, green, blue]) = self.shell.report(color) else {
            return;
        };
        if let Some(parameter) = self.looks.color_target.take() {
            let text = format!("#{red:02x}{green:02x}{blue:02x}");
            knob_target::set(&mut self.documents.document, &parameter, Value::Text(text));
        }
    }

    fn change_variants(&mut self, action: VariantAction) {
        let document = &mut self.documents.document;
        match action {
            VariantAction::Apply(name) => drop(variants::apply(document, &name)),
            VariantAction::Rename { name, to } => drop(variants::rename(document, &name, &to)),
            VariantAction::Remove(name) => drop(variants::remove(document, &name)),
            VariantAction::Save(name) => {
                if variants::save(document, &name) {
                    self.store_picture_of_variant(name.trim());
                }
            }
        }
    }

    /// Stores the model as it looks now as the picture of a variant.
    fn store_picture_of_variant(&mut self, name: &str) {
        let Some(picture) = self.views.model.picture(self.evaluation.gpu()) else {
            return;
        };
        let documents = &mut self.documents;
        let file = documents.document.session.file().unwrap_or(Path::new(""));
        let text = variants::as_text(&documents.document, name);
        let stored = documents.pictures.store(&self.shell.context, file, &text, &picture);
        self.shell.report(stored);
    }

    /// Selects a node in the group that it is in, and shows it on the canvas.
    fn go_to(&mut self, node: &str) {
        let document = &mut self.documents.document;
        let Some(id) = graph::go_to(document, node) else {
            return;
        };
        self.shell.dock.bring_up(Panel::Canvas);
        self.views.canvas.frame_nodes(document, [&id].into_iter());
        self.looks.show(document, &id, None);
    }
}
