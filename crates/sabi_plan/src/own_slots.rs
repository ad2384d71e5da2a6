//! Plans in which every stored plane has a separate slot.

use std::collections::BTreeMap;

use crate::plan::{Plan, Slot, SlotRef, Step};

impl Plan {
    /// Assigns a separate slot to every stored plane, so that a slot stands for one result. The memory of a run stays the
    /// same, since textures are freed after the last step that reads them.
    #[must_use]
    pub fn with_own_slots(mut self) -> Plan {
        let mut slots = OwnSlots {
            before: std::mem::take(&mut self.slots),
            now: Vec::new(),
            current: BTreeMap::new(),
        };
        for step in &mut self.steps {
            slots.rename(step);
        }
        for slot in self.results.iter_mut().flat_map(|result| &mut result.slots) {
            slots.read(slot);
        }
        self.slots = slots.now;
        self
    }
}

struct OwnSlots {
    before: Vec<Slot>,
    now: Vec<Slot>,
    /// New slot for the current content of each old slot.
    current: BTreeMap<SlotRef, SlotRef>,
}

impl OwnSlots {
    fn rename(&mut self, step: &mut Step) {
        match step {
            Step::Source(source) => {
                source.reads.iter_mut().flatten().for_each(|slot| self.read(slot));
                let planes = source.writes.iter_mut().flat_map(|(_, planes)| planes);
                planes.for_each(|(_, slot)| self.write(slot));
            }
            Step::Move(step) => {
                self.read(&mut step.from);
                self.write(&mut step.to);
            }
            Step::Survey(step) => {
                self.read(&mut step.from);
                self.write(&mut step.to);
            }
            Step::Kernel(kernel) => {
                kernel.reads.iter_mut().flatten().for_each(|slot| self.read(slot));
                kernel.writes.iter_mut().flatten().for_each(|slot| self.write(slot));
                if let Some(feedback) = &mut kernel.feedback {
                    self.write(&mut feedback.scratch);
                }
            }
        }
    }

    fn read(&self, slot: &mut SlotRef) {
        if let Some(now) = self.current.get(slot) {
            *slot = *now;
        }
    }

    fn write(&mut self, slot: &mut SlotRef) {
        let before = *slot;
        *slot = self.now.len();
        self.now.push(self.before[before]);
        self.current.insert(before, *slot);
    }
}
