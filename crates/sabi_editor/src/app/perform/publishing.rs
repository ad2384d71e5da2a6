//! What is asked of published knobs, and what knobs ask for wherever they stand.

use std::path::Path;

use crate::action::{PanelAsk, PortAsk, VariantAsk};
use crate::app::Editor;
use crate::desk::{Desk, KnobAt};
use crate::knobs::{KnobEvent, KnobMemory};
use crate::panels::Panels;

impl Editor {
    /// What the panel of published knobs is shown from, and what it remembers.
    pub(crate) fn parts_of_panel(&mut self) -> (&Desk, &mut Panels, &mut KnobMemory) {
        (&self.desk, &mut self.panels, &mut self.knob_memory)
    }

    /// Does what is asked of the published knobs.
    pub(super) fn change_panel(&mut self, asked: PanelAsk) {
        let desk = &mut self.desk;
        match asked {
            PanelAsk::Turn(event) => self.turn_published(event),
            PanelAsk::Label { name, label } => drop(desk.label_exposed(&name, &label)),
            PanelAsk::Rename { name, to } => drop(desk.rename_exposed(&name, &to)),
            PanelAsk::Section { name, section } => drop(desk.set_section(&name, &section)),
            PanelAsk::Range { name, range } => drop(desk.set_exposed_range(&name, range)),
            PanelAsk::Default { name, default } => drop(desk.set_exposed_default(&name, default)),
            PanelAsk::Move { name, before } => drop(desk.move_exposed(&name, before.as_deref())),
            PanelAsk::TakeOff(name) => drop(desk.unexpose(&name)),
        }
    }

    fn turn_published(&mut self, event: KnobEvent) {
        let desk = &mut self.desk;
        match event {
            KnobEvent::Set { knob, value } => drop(desk.turn(&knob, &value)),
            KnobEvent::Reset { knob } => drop(desk.turn_back(&knob)),
            KnobEvent::Unexpose { knob } => drop(desk.unexpose(&knob)),
            KnobEvent::Eyedropper { knob } => self.ask_for_color(KnobAt::Panel(knob)),
            KnobEvent::Browse { knob } => self.files.ask_for_picture(KnobAt::Panel(knob)),
            KnobEvent::Began | KnobEvent::Ended | KnobEvent::GivenUp | KnobEvent::ShowLength(_) => {
                self.move_knob(&event)
            }
            // All that stand on the panel are published.
            KnobEvent::Expose { .. } => {}
        }
    }

    /// Does what is asked of inputs and outputs.
    pub(super) fn change_ports(&mut self, asked: PortAsk) {
        let desk = &mut self.desk;
        match asked {
            PortAsk::NameGraph(name) => drop(desk.rename_graph(&name)),
            PortAsk::PublishInput(slot) => drop(desk.publish_input(&slot)),
            PortAsk::PublishOutput(from) => drop(desk.publish_output(&from)),
            PortAsk::LabelInput { name, label } => drop(desk.label_input(&name, &label)),
            PortAsk::RenameInput { name, to } => drop(desk.rename_input(&name, &to)),
            PortAsk::RemoveInput(name) => drop(desk.remove_input(&name)),
            PortAsk::Feed { name, slot } => drop(desk.feed(&name, &slot)),
            PortAsk::Unfeed(slot) => drop(desk.unfeed(&slot)),
            PortAsk::RenameOutput { name, to } => drop(desk.rename_output(&name, &to)),
            PortAsk::RemoveOutput(name) => drop(desk.remove_output(&name)),
            PortAsk::Retarget { name, from } => drop(desk.retarget_output(&name, &from)),
        }
    }

    /// Does what is asked of the variants.
    pub(super) fn change_variants(&mut self, asked: VariantAsk) {
        let desk = &mut self.desk;
        match asked {
            VariantAsk::Apply(name) => drop(desk.apply_variant(&name)),
            VariantAsk::Rename { name, to } => drop(desk.rename_variant(&name, &to)),
            VariantAsk::Remove(name) => drop(desk.remove_variant(&name)),
            VariantAsk::Save(name) => {
                if desk.save_variant(&name) {
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
        let file = self.desk.session.file().unwrap_or(Path::new(""));
        let what = self.desk.variant_as_text(name);
        let kept = self.panels.keepsakes.keep(&self.context, file, &what, &picture);
        if let Err(why) = kept {
            self.say(why);
        }
    }

    /// What a drag of a knob means wherever the knob stands: all of it is one step, and pictures are quick meanwhile.
    pub(super) fn move_knob(&mut self, event: &KnobEvent) {
        match event {
            KnobEvent::Began => {
                self.desk.session.begin("Turn a knob");
                self.is_moving = true;
            }
            // Where its knob was gone it has ended already, and another step may be open by now.
            KnobEvent::Ended if self.is_moving => {
                self.desk.session.end();
                self.is_moving = false;
            }
            KnobEvent::GivenUp => {
                self.desk.take_back();
                self.is_moving = false;
            }
            KnobEvent::ShowLength(length) => {
                self.panels.parameters.length = Some(*length).filter(|length| length.is_finite());
            }
            _ => {}
        }
    }
}
