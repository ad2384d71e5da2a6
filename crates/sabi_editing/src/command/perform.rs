//! Performs commands. No match here has a wildcard arm, so that a command that is not handled does not compile.

use std::path::Path;

use sabi_graph::{GROUP_KIND, NodeId, Value};
use sabi_nodes::label_of;

use super::{
    ArrangeCommand, ClipboardCommand, DocumentCommand, EditCommand, ExposedCommand, FrameCommand, GroupCommand,
    HistoryCommand, KnobCommand, LayerCommand, NavigationCommand, NodeCommand, NodeSource, NoteCommand, Outcome,
    PaintCommand, PortCommand, SelectionCommand, VariantCommand, WireCommand,
};
use crate::connections::PendingWire;
use crate::names::FILE_ENDING;
use crate::open_document::OpenDocument;
use crate::{
    arrangement, clipboard, document_settings, dropped_layers, duplication, exposed_knobs, exposed_values, frames,
    groups, hand_layers, history, instance_variants, knob_target, layers, library, linked_groups, navigation,
    node_replacement, nodes, notes, painting, ports, random_knobs, relative_paths, selection, texture_sets, variants,
    wires,
};

/// Performs a command on the open document.
pub fn perform(document: &mut OpenDocument, command: EditCommand) -> Outcome {
    match command {
        EditCommand::History(command) => history(document, command),
        EditCommand::Selection(command) => select(document, command),
        EditCommand::Navigation(command) => navigate(document, &command),
        EditCommand::Node(command) => node(document, command),
        EditCommand::Knob(command) => knob(document, command),
        EditCommand::Arrange(command) => arrange(document, command),
        EditCommand::Wire(command) => wire(document, command),
        EditCommand::Frame(command) => frame(document, command),
        EditCommand::Note(command) => note(document, command),
        EditCommand::Group(command) => group(document, &command),
        EditCommand::Clipboard(command) => clip(document, &command),
        EditCommand::Exposed(command) => exposed(document, command),
        EditCommand::Variant(command) => variant(document, &command),
        EditCommand::Port(command) => port(document, command),
        EditCommand::Layer(command) => layer(document, command),
        EditCommand::Document(command) => settings(document, command),
        EditCommand::Paint(command) => paint(document, command),
    }
}

fn paint(document: &mut OpenDocument, command: PaintCommand) -> Outcome {
    match command {
        PaintCommand::Stroke {
            node,
            model,
            before,
            stroke,
        } => painting::stroke(document, &node, &model, &before, stroke).into(),
        PaintCommand::Steps {
            node,
            model,
            before,
            title,
            steps,
        } => painting::take_steps(document, &node, &model, &before, &title, &steps).into(),
        PaintCommand::Over(node) => added_as(painting::paint_over(document, &node)),
    }
}

fn history(document: &mut OpenDocument, command: HistoryCommand) -> Outcome {
    let before = document.session.revision();
    match command {
        HistoryCommand::Undo => history::undo(document),
        HistoryCommand::Redo => history::redo(document),
        HistoryCommand::Begin(step) => document.session.begin(&step),
        HistoryCommand::End => document.session.end(),
        HistoryCommand::Cancel => history::cancel_step(document),
    }
    (document.session.revision() != before).into()
}

fn select(document: &mut OpenDocument, command: SelectionCommand) -> Outcome {
    let before = document.selection().clone();
    match command {
        SelectionCommand::Only(ids) => document.select(ids),
        SelectionCommand::Toggle(id) => selection::toggle(document, &id),
        SelectionCommand::All => selection::select_all(document),
        SelectionCommand::Muted => selection::select_muted(document),
        SelectionCommand::Upstream => selection::select_connected(document, true),
        SelectionCommand::Downstream => selection::select_connected(document, false),
    }
    (*document.selection() != before).into()
}

fn navigate(document: &mut OpenDocument, command: &NavigationCommand) -> Outcome {
    match command {
        NavigationCommand::Enter(id) => navigation::enter(document, id).into(),
        NavigationCommand::Leave => navigation::leave(document).into(),
        NavigationCommand::LeaveTo(depth) => navigation::leave_to(document, *depth).into(),
        NavigationCommand::GoTo(full_id) => navigation::go_to(document, full_id).is_some().into(),
    }
}

fn node(document: &mut OpenDocument, command: NodeCommand) -> Outcome {
    match command {
        NodeCommand::Add {
            source,
            place,
            pending,
            into,
        } => {
            document.session.begin(&format!("Add {}", name_of(document, &source)));
            let added = match &source {
                NodeSource::Kind(kind) => nodes::add(document, kind, place, pending.as_ref()),
                NodeSource::Group(group) => nodes::add_instance(document, group, place, pending.as_ref()),
                NodeSource::Library(file) => library::add(document, file, place, pending.as_ref()),
            };
            if let Some((id, into)) = added.as_ref().zip(into) {
                wires::insert(document, id, &into);
            }
            document.session.end();
            added_as(added)
        }
        NodeCommand::Replace { node, by } => {
            let is_replaced = replace(document, &node, &by);
            added_as(document.selected_one().cloned().filter(|_| is_replaced))
        }
        NodeCommand::Rename { node, name } => nodes::rename(document, &node, &name).into(),
        NodeCommand::DeleteSelected { reconnects } => nodes::delete(document, reconnects).into(),
        NodeCommand::DuplicateSelected { keeps_inputs } => duplication::duplicate(document, keeps_inputs).into(),
        NodeCommand::ToggleMuted => nodes::toggle_muted(document).into(),
        NodeCommand::ToggleRows(rows) => nodes::toggle_rows(document, rows).into(),
        NodeCommand::ToggleNamedWires => nodes::toggle_named_wires(document).into(),
        NodeCommand::AddTextureSets { files, place } => texture_sets::add(document, &files, place).into(),
        NodeCommand::AddImage { file, place } => added_as(add_image(document, &file, place)),
    }
}

fn added_as(added: Option<NodeId>) -> Outcome {
    added.map_or(Outcome::Unchanged, Outcome::Added)
}

fn replace(document: &mut OpenDocument, node: &NodeId, by: &NodeSource) -> bool {
    match by {
        NodeSource::Kind(kind) => node_replacement::by_kind(document, node, kind),
        NodeSource::Group(group) => node_replacement::by_group(document, node, group),
        NodeSource::Library(file) => {
            document.session.begin("Replace by a group");
            let group = library::import(document, file);
            let is_replaced = group.is_some_and(|group| node_replacement::by_group(document, node, &group));
            if is_replaced {
                document.session.end();
            } else {
                history::cancel_step(document);
            }
            is_replaced
        }
    }
}

fn add_image(document: &mut OpenDocument, file: &Path, place: [f32; 2]) -> Option<NodeId> {
    let path = match relative_paths::chosen(document, file) {
        Ok(path) => path,
        Err(refused) => {
            document.notify(refused.to_string());
            return None;
        }
    };
    document.session.begin("Add image");
    let added = nodes::add(document, "source/image", place, None);
    if let Some(id) = &added {
        nodes::set_knob(document, id, "file", Some(Value::Text(path)));
    }
    document.session.end();
    added
}

fn knob(document: &mut OpenDocument, command: KnobCommand) -> Outcome {
    let is_done = match command {
        KnobCommand::Set { node, knob, value } => nodes::set_knob_of_selected(document, &node, &knob, value),
        KnobCommand::SetTarget { target, value } => knob_target::set(document, &target, value),
        KnobCommand::Expose { node, knob } => exposed_knobs::expose_of_selected(document, &node, &knob),
        KnobCommand::Unexpose { node, knob } => exposed_knobs::unexpose_knob(document, &node, &knob),
    };
    is_done.into()
}

fn arrange(document: &mut OpenDocument, command: ArrangeCommand) -> Outcome {
    let is_done = match command {
        ArrangeCommand::Move(places) => arrangement::move_nodes(document, "Move", places),
        ArrangeCommand::Align(by) => arrangement::align(document, by),
        ArrangeCommand::Distribute(along) => arrangement::distribute(document, along),
        ArrangeCommand::Straighten => arrangement::straighten(document),
        ArrangeCommand::LayOut => arrangement::lay_out(document),
    };
    is_done.into()
}

fn wire(document: &mut OpenDocument, command: WireCommand) -> Outcome {
    let is_done = match command {
        WireCommand::Connect { from, to, off } => {
            let step = wires::connecting_step(document, &from, &to);
            document.session.begin(&step);
            let is_connected = wires::connect(document, &from, &to);
            if let Some(off) = off.filter(|_| is_connected) {
                wires::disconnect(document, &[off]);
            }
            document.session.end();
            is_connected
        }
        WireCommand::Merge { from, to, how } => wires::merge(document, &from, &to, how),
        WireCommand::Disconnect(slots) => wires::disconnect(document, &slots),
        WireCommand::RemoveMask(slot) => wires::remove_mask(document, &slot),
        WireCommand::Insert { node, into } => wires::insert(document, &node, &into),
        WireCommand::Reroute { into, place } => wires::reroute(document, &into, place),
        WireCommand::DetachSelected => wires::detach_selected(document),
        WireCommand::SwapInputs => wires::swap_inputs(document),
    };
    is_done.into()
}

fn frame(document: &mut OpenDocument, command: FrameCommand) -> Outcome {
    let is_done = match command {
        FrameCommand::Add => frames::add(document),
        FrameCommand::Rename { frame, title } => frames::rename(document, &frame, title),
        FrameCommand::Recolor(frame) => frames::recolor(document, &frame),
        FrameCommand::Select(frame) => return select_frame(document, &frame),
        FrameCommand::Assign(frame) => {
            let nodes = document.selection().clone();
            frames::assign(document, &nodes, frame.as_deref())
        }
        FrameCommand::Remove(frame) => frames::remove(document, &frame),
    };
    is_done.into()
}

fn note(document: &mut OpenDocument, command: NoteCommand) -> Outcome {
    let is_done = match command {
        NoteCommand::Add { place, text } => notes::add(document, place, text),
        NoteCommand::Change { note, change } => notes::change(document, &note, change),
        NoteCommand::Remove(note) => notes::remove(document, &note),
    };
    is_done.into()
}

fn select_frame(document: &mut OpenDocument, frame: &str) -> Outcome {
    let before = document.selection().clone();
    frames::select(document, frame);
    (*document.selection() != before).into()
}

fn group(document: &mut OpenDocument, command: &GroupCommand) -> Outcome {
    match command {
        GroupCommand::Make => groups::make(document).into(),
        GroupCommand::Dissolve => groups::dissolve_selected(document).into(),
        GroupCommand::SaveToLibrary(folder) => {
            library::save_group(document, folder).map_or(Outcome::Unchanged, Outcome::Saved)
        }
        GroupCommand::Update(groups) => linked_groups::update_all(document, groups).into(),
        GroupCommand::Unlink(group) => linked_groups::unlink(document, group).into(),
        GroupCommand::ChooseVariant { node, name } => instance_variants::choose(document, node, name.as_deref()).into(),
        GroupCommand::Randomize { node, kept } => random_knobs::randomize(document, node, kept).into(),
    }
}

fn clip(document: &mut OpenDocument, command: &ClipboardCommand) -> Outcome {
    let copied = match command {
        ClipboardCommand::Copy => clipboard::copy(document),
        ClipboardCommand::Cut => clipboard::cut(document),
        ClipboardCommand::Paste { text, place } => return clipboard::paste(document, text, *place).into(),
    };
    copied.map_or(Outcome::Unchanged, Outcome::Copied)
}

fn exposed(document: &mut OpenDocument, command: ExposedCommand) -> Outcome {
    let is_done = match command {
        ExposedCommand::Set { name, value } => exposed_values::set(document, &name, &value),
        ExposedCommand::Reset(name) => exposed_values::reset(document, &name),
        ExposedCommand::SetLabel { name, label } => exposed_knobs::set_label(document, &name, &label),
        ExposedCommand::Rename { name, to } => exposed_knobs::rename(document, &name, &to),
        ExposedCommand::SetSection { name, section } => exposed_knobs::set_section(document, &name, &section),
        ExposedCommand::SetRange { name, range } => exposed_values::set_range(document, &name, range),
        ExposedCommand::SetDefault { name, default } => exposed_values::set_default(document, &name, default),
        ExposedCommand::Move { name, before } => exposed_knobs::move_knob(document, &name, before.as_deref()),
        ExposedCommand::Remove(name) => exposed_knobs::unexpose(document, &name),
        ExposedCommand::Randomize { kept } => random_knobs::randomize_exposed(document, &kept),
    };
    is_done.into()
}

fn variant(document: &mut OpenDocument, command: &VariantCommand) -> Outcome {
    let is_done = match command {
        VariantCommand::Save(name) => variants::save(document, name),
        VariantCommand::Show(name) => variants::show(document, name.as_deref()),
        VariantCommand::Rename { name, to } => variants::rename(document, name, to),
        VariantCommand::Remove(name) => variants::remove(document, name),
    };
    is_done.into()
}

fn port(document: &mut OpenDocument, command: PortCommand) -> Outcome {
    let is_done = match command {
        PortCommand::NameGraph(name) => groups::rename_graph(document, &name),
        PortCommand::ExposeInput(slot) => ports::expose_input(document, &slot).is_some(),
        PortCommand::ExposeOutput(from) => ports::expose_output(document, &from).is_some(),
        PortCommand::SetInputLabel { name, label } => ports::set_input_label(document, &name, &label),
        PortCommand::RenameInput { name, to } => ports::rename_input(document, &name, &to),
        PortCommand::RemoveInput(name) => ports::remove_input(document, &name),
        PortCommand::Feed { name, slot } => ports::feed(document, &name, &slot),
        PortCommand::Unfeed(slot) => ports::unfeed(document, &slot),
        PortCommand::RenameOutput { name, to } => ports::rename_output(document, &name, &to),
        PortCommand::RemoveOutput(name) => ports::remove_output(document, &name),
        PortCommand::Retarget { name, from } => ports::retarget_output(document, &name, &from),
    };
    is_done.into()
}

fn layer(document: &mut OpenDocument, command: LayerCommand) -> Outcome {
    let is_done = match command {
        LayerCommand::Toggle(id) => layers::toggle(document, &id),
        LayerCommand::SetOpacity { node, opacity } => layers::set_opacity(document, &node, opacity),
        LayerCommand::Move { end, from, to } => layers::move_to(document, &end, from, to),
        LayerCommand::Remove { end, at } => layers::remove(document, &end, at),
        LayerCommand::AddMask { node: id, source } => {
            let Some(slot) = layers::expect_mask_input(document, &id) else {
                return Outcome::Unchanged;
            };
            let add = NodeCommand::Add {
                source,
                place: layers::place_of_mask(document, &id),
                pending: Some(PendingWire::Into(slot)),
                into: None,
            };
            return node(document, add);
        }
        LayerCommand::AddByHand { end, what } => {
            let step = format!("Add {}", what.title());
            return added_as(as_one_step(document, &step, |document| {
                hand_layers::add(document, end.as_ref(), what)
            }));
        }
        LayerCommand::PaintMask { node, empty } => {
            return added_as(as_one_step(document, "Paint the mask", |document| {
                hand_layers::paint_mask(document, &node, empty)
            }));
        }
        LayerCommand::RemoveMask(id) => layers::remove_mask(document, &id),
        LayerCommand::Add { end, at, kind } => return added_as(layers::add(document, &end, at, &kind)),
        LayerCommand::AddOnModel {
            source,
            place,
            has_normal_map,
        } => {
            return added_as(drop_layer(document, &source, |document, kind, group| {
                dropped_layers::on_model(document, kind, group, &place, has_normal_map)
            }));
        }
        LayerCommand::AddOnNode { source, node } => {
            return added_as(drop_layer(document, &source, |document, kind, group| {
                dropped_layers::on_node(document, kind, group, &node)
            }));
        }
    };
    is_done.into()
}

/// Adds a layer as one undo step. `add` receives its kind, and its group after that was imported.
fn drop_layer(
    document: &mut OpenDocument,
    source: &NodeSource,
    add: impl FnOnce(&mut OpenDocument, &str, Option<&str>) -> Option<NodeId>,
) -> Option<NodeId> {
    let step = format!("Add layer {}", name_of(document, source));
    as_one_step(document, &step, |document| match source {
        NodeSource::Kind(kind) => add(document, kind, None),
        NodeSource::Group(group) => add(document, GROUP_KIND, Some(group)),
        NodeSource::Library(file) => {
            library::import(document, file).and_then(|group| add(document, GROUP_KIND, Some(&group)))
        }
    })
}

/// Returns the name of a new node or group for the undo history.
fn name_of(document: &OpenDocument, source: &NodeSource) -> String {
    match source {
        NodeSource::Kind(kind) => {
            let entry = document.catalog().entry(kind);
            entry.map_or_else(|| kind.clone(), |entry| entry.label.clone())
        }
        NodeSource::Group(group) => {
            let name = group.rsplit('/').next().unwrap_or(group);
            name.strip_suffix(FILE_ENDING).unwrap_or(name).to_owned()
        }
        NodeSource::Library(file) => label_of(&file.file_stem().unwrap_or(file.as_os_str()).to_string_lossy()),
    }
}

/// Performs edits as one undo step and selects the node that they add. If they add no node, the step is canceled.
fn as_one_step(
    document: &mut OpenDocument,
    step: &str,
    add: impl FnOnce(&mut OpenDocument) -> Option<NodeId>,
) -> Option<NodeId> {
    document.session.begin(step);
    let added = add(document);
    match &added {
        Some(id) => {
            document.select([id.clone()]);
            document.session.end();
        }
        None => history::cancel_step(document),
    }
    added
}

fn settings(document: &mut OpenDocument, command: DocumentCommand) -> Outcome {
    let is_done = match command {
        DocumentCommand::SetSize(size) => document_settings::set_size(document, size),
        DocumentCommand::SetFit(fit) => document_settings::set_fit(document, fit),
        DocumentCommand::SetSeed(seed) => document_settings::set_seed(document, seed),
        DocumentCommand::KeepView(name, view) => document_settings::keep_view(document, name, view),
        DocumentCommand::ForgetView(name) => document_settings::forget_view(document, &name),
    };
    is_done.into()
}
