//! What is asked of published knobs, and what knobs ask for wherever they stand.

use std::path::Path;

use sabi_editing::{KnobTarget, OpenDocument};

use crate::action::{PanelAsk, PortAsk, VariantAsk};
use crate::app::Editor;
use crate::knobs::{KnobEvent, KnobMemory};
use crate::panels::Panels;

impl Editor {
    /// What the panel of published knobs is shown from, and what it remembers.
    pub(crate) fn parts_of_panel(&mut self) -> (&OpenDocument, &mut Panels, &mut KnobMemory) {
        (&self.document, &mut self.panels, &mut self.knob_memory)
    }

    /// Does what is asked of the published knobs.
    pub(super) fn change_panel(&mut self, asked: PanelAsk) {
        let document = &mut self.document;
        match asked {
            PanelAsk::Turn(event) => self.turn_published(event),
            PanelAsk::Label { name, label } => drop(document.label_exposed(&name, &label)),
            PanelAsk::Rename { name, to } => drop(document.rename_exposed(&name, &to)),
            PanelAsk::Section { name, section } => drop(document.set_section(&name, &section)),
            PanelAsk::Range { name, range } => drop(document.set_exposed_range(&name, range)),
            PanelAsk::Default { name, default } => drop(document.set_exposed_default(&name, default)),
            PanelAsk::Move { name, before } => drop(document.move_exposed(&name, before.as_deref())),
            PanelAsk::TakeOff(name) => drop(document.unexpose(&name)),
        }
    }

    fn turn_published(&mut self, event: KnobEvent) {
        let document = &mut self.document;
        match event {
            KnobEvent::Set { knob, value } => drop(document.turn(&knob, &value)),
            KnobEvent::Reset { knob } => drop(document.turn_back(&knob)),
            KnobEvent::Unexpose { knob } => drop(document.unexpose(&knob)),
            KnobEvent::Eyedropper { knob } => self.ask_for_color(KnobTarget::Panel(knob)),
            KnobEvent::Browse { knob } => self.files.ask_for_picture(KnobTarget::Panel(knob)),
            KnobEvent::Began | KnobEvent::Ended | KnobEvent::GivenUp | KnobEvent::ShowLength(_) => {
                self.move_knob(&event)
            }
            // All that stand on the panel are published.
            KnobEvent::Expose { .. } => {}
        }
    }

    /// Does what is asked of inputs and outputs.
    pub(super) fn change_ports(&mut self, asked: PortAsk) {
        let document = &mut self.document;
        match asked {
            PortAsk::NameGraph(name) => drop(document.rename_graph(&name)),
            PortAsk::PublishInput(slot) => drop(document.publish_input(&slot)),
            PortAsk::PublishOutput(from) => drop(document.publish_output(&from)),
            PortAsk::LabelInput { name, label } => drop(document.label_input(&name, &label)),
            PortAsk::RenameInput { name, to } => drop(document.rename_input(&name, &to)),
            PortAsk::RemoveInput(name) => drop(document.remove_input(&name)),
            PortAsk::Feed { name, slot } => drop(document.feed(&name, &slot)),
            PortAsk::Unfeed(slot) => drop(document.unfeed(&slot)),
            PortAsk::RenameOutput { name, to } => drop(document.rename_output(&name, &to)),
            PortAsk::RemoveOutput(name) => drop(document.remove_output(&name)),
            PortAsk::Retarget { name, from } => drop(document.retarget_output(&name, &from)),
        }
    }

    /// Does what is asked of the variants.
    pub(super) fn change_variants(&mut self, asked: VariantAsk) {
        let document = &mut self.document;
        match asked {
            VariantAsk::Apply(name) => drop(document.apply_variant(&name)),
            VariantAsk::Rename { name, to } => drop(document.rename_variant(&name, &to)),
            VariantAsk::Remove(name) => drop(document.remove_variant(&name)),
            VariantAsk::Save(name) => {
                if document.save_variant(&name) {
                    self.picture_variant(name.trim());
                }
            }
        }
    }

    /// Keeps the model as it looks now as the picture of a variant.
    fn picture_variant(&mut self, name: &str) {
        let Some(picture) = self.model_view.picture(self.stage.gpu()) else {
            return;
        };
        let file = self.document.session.file().unwrap_or(Path::new(""));
        let what = self.document.variant_as_text(name);
        let kept = self.panels.keepsakes.keep(&self.context, file, &what, &picture);
        if let Err(why) = kept {
            self.say(why);
        }
    }

    /// What a drag of a knob means wherever the knob stands: all of it is one step, and pictures are quick meanwhile.
    pub(super) fn move_knob(&mut self, event: &KnobEvent) {
        match event {
            KnobEvent::Began => {
                self.document.session.begin("Turn a knob");
                self.is_moving = true;
            }
            // Where its knob was gone it has ended already, and another step may be open by now.
            KnobEvent::Ended if self.is_moving => {
                self.document.session.end();
                self.is_moving = false;
            }
            KnobEvent::GivenUp => {
                self.document.take_back();
                self.is_moving = false;
            }
            KnobEvent::ShowLength(length) => {
                self.panels.parameters.length = Some(*length).filter(|length| length.is_finite());
            }
            _ => {}
        }
    }
}
