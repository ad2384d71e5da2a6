//! Pool of slots, which stored results share one after the other.

use std::collections::BTreeMap;

use sabi_nodes::link::Format;

use crate::plan::{Slot, SlotExtent, SlotRef};

/// Free and used slots by format.
#[derive(Debug, Default)]
pub(crate) struct SlotPool {
    slots: Vec<Slot>,
    free: BTreeMap<(Format, SlotExtent), Vec<SlotRef>>,
}

impl SlotPool {
    /// Takes a slot of that format and size: the one freed last, or a new one.
    pub(crate) fn take(&mut self, format: Format, extent: SlotExtent) -> SlotRef {
        if let Some(slot) = self.free.get_mut(&(format, extent)).and_then(Vec::pop) {
            return slot;
        }
        self.slots.push(Slot { format, extent });
        self.slots.len() - 1
    }

    /// Frees a slot.
    pub(crate) fn release(&mut self, slot: SlotRef) {
        let Slot { format, extent } = self.slots[slot];
        self.free.entry((format, extent)).or_default().push(slot);
    }

    /// All slots ever taken.
    pub(crate) fn into_slots(self) -> Vec<Slot> {
        self.slots
    }
}
