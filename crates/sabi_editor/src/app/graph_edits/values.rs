//! Values of the parameters of nodes, and of exposed parameters.

use egui::Ui;
use sabi_editing::command::{ExposedCommand, KnobCommand, PortCommand, WireCommand};
use sabi_editing::knob_target::KnobTarget;
use sabi_graph::{NodeId, SlotRef};

use super::GraphEdits;
use crate::dock::Panel;
use crate::knobs::KnobEvent;
use crate::shown_results::ColorTarget;

impl GraphEdits<'_> {
    /// Changes a parameter of a node, and of the selected nodes of its kind.
    pub(in crate::app) fn change_knob(&mut self, node: NodeId, event: KnobEvent, ui: &Ui) {
        match event {
            KnobEvent::Set { knob, value } => {
                let value = Some(value);
                self.edit(KnobCommand::Set { node, knob, value }, ui);
            }
            KnobEvent::Reset { knob } => {
                let value = None;
                self.edit(KnobCommand::Set { node, knob, value }, ui);
            }
            KnobEvent::Expose { knob } => self.edit(KnobCommand::Expose { node, knob }, ui),
            KnobEvent::Unexpose { knob } => self.edit(KnobCommand::Unexpose { node, knob }, ui),
            KnobEvent::AddMask { knob: name } => {
                self.shell.dock.bring_up(Panel::Canvas);
                let document = &self.documents.document;
                self.views.canvas.ask_for_mask(ui, document, SlotRef { node, name });
            }
            KnobEvent::RemoveMask { knob: name } => self.edit(WireCommand::RemoveMask(SlotRef { node, name }), ui),
            KnobEvent::ExposeMask { knob: name } => self.edit(PortCommand::ExposeInput(SlotRef { node, name }), ui),
            KnobEvent::Eyedropper { knob } => {
                self.toggle_color_target(ColorTarget::Parameter(KnobTarget::of_node(&node, knob)));
            }
            KnobEvent::Browse { knob } => self.browse(KnobTarget::of_node(&node, knob)),
            KnobEvent::PickGradient { knob } => self.ask_for_gradient(KnobTarget::of_node(&node, knob)),
            KnobEvent::Began => self.documents.begin_drag(),
            KnobEvent::Ended => self.documents.end_drag(),
            KnobEvent::Canceled => self.documents.cancel_drag(),
            KnobEvent::ShowLength(length) => self.looks.length = Some(length).filter(|length| length.is_finite()),
        }
    }

    /// Changes the value of an exposed parameter.
    pub(in crate::app) fn change_exposed_value(&mut self, event: KnobEvent, ui: &Ui) {
        match event {
            KnobEvent::Set { knob: name, value } => self.edit(ExposedCommand::Set { name, value }, ui),
            KnobEvent::Reset { knob } => self.edit(ExposedCommand::Reset(knob), ui),
            KnobEvent::Unexpose { knob } => self.edit(ExposedCommand::Remove(knob), ui),
            KnobEvent::Eyedropper { knob } => {
                self.toggle_color_target(ColorTarget::Parameter(KnobTarget::Exposed(knob)));
            }
            KnobEvent::Browse { knob } => self.browse(KnobTarget::Exposed(knob)),
            KnobEvent::PickGradient { knob } => self.ask_for_gradient(KnobTarget::Exposed(knob)),
            KnobEvent::Began => self.documents.begin_drag(),
            KnobEvent::Ended => self.documents.end_drag(),
            KnobEvent::Canceled => self.documents.cancel_drag(),
            KnobEvent::ShowLength(length) => self.looks.length = Some(length).filter(|length| length.is_finite()),
            // A parameter of the panel is exposed already, and its masks are linked at the nodes.
            KnobEvent::Expose { .. }
            | KnobEvent::AddMask { .. }
            | KnobEvent::RemoveMask { .. }
            | KnobEvent::ExposeMask { .. } => {}
        }
    }
}
