//! Memory that steps use.

use std::collections::{BTreeMap, BTreeSet};

use sabi_nodes::link::Plane;

use crate::level::Level;
use crate::plan::{SlotExtent, Step};
use crate::resources::{Resource, TextureContent, UnassignedStep};

/// A stored plane on a level.
pub(crate) type StoredPlane = (Resource, Plane);

/// Planes that a step writes, without the second texture of a repeated function.
pub(crate) fn written(step: &UnassignedStep) -> impl Iterator<Item = StoredPlane> {
    step.writes.iter().flatten().copied()
}

/// Returns whether a plane belongs to a result of a node, on the level on which others read it.
pub(crate) fn is_result((resource, _): &StoredPlane) -> bool {
    matches!(resource.content, TextureContent::Result(_)) && resource.level == Level::FINEST
}

/// Memory of a plane: that of a number on the finest level is 2²².
pub(crate) fn weight((resource, plane): &StoredPlane) -> u64 {
    match resource.extent() {
        SlotExtent::Level(Level::Texels(number)) => (plane.format().texel_bytes() << 20) >> (2 * number).min(63),
        // Points and tables are small.
        SlotExtent::Level(Level::Points(_))
        | SlotExtent::Survey
        | SlotExtent::GroupSurvey
        | SlotExtent::Single
        | SlotExtent::Groups => 0,
    }
}

/// Memory that steps use, in the unit of [`weight`].
#[derive(Clone, Debug, Default)]
pub(crate) struct MemoryUse {
    /// Memory in use during each step.
    pub(crate) of_steps: Vec<u64>,
    /// Planes that are stored during the step that uses most, which is the first of several.
    pub(crate) stored_at_peak: BTreeSet<StoredPlane>,
}

impl MemoryUse {
    /// Memory in use while steps run. Planes that none of the steps writes are stored from the start to the end, and
    /// planes that `stays` selects are stored from the step that writes them to the end.
    pub(crate) fn of(steps: &[&UnassignedStep], stays: impl Fn(&StoredPlane) -> bool) -> MemoryUse {
        let mut last_use: BTreeMap<StoredPlane, usize> = BTreeMap::new();
        let mut stored: BTreeSet<StoredPlane> = BTreeSet::new();
        for (at, step) in steps.iter().enumerate() {
            let read = step.reads.iter().flatten();
            stored.extend(read.clone().filter(|plane| !last_use.contains_key(plane)));
            let used = read.chain(step.writes.iter().flatten()).chain(&step.scratch);
            last_use.extend(used.map(|plane| (*plane, at)));
        }
        let outer = stored.clone();
        let mut in_use: u64 = stored.iter().map(weight).sum();
        let (mut found, mut peak) = (MemoryUse::default(), 0);
        for (at, step) in steps.iter().enumerate() {
            for plane in step.writes.iter().flatten().chain(&step.scratch) {
                if stored.insert(*plane) {
                    in_use += weight(plane);
                }
            }
            let is_last =
                |plane: &StoredPlane| last_use.get(plane) == Some(&at) && !outer.contains(plane) && !stays(plane);
            let shared = match start_of(step) {
                Some(start) if is_last(&start) => weight(&start),
                Some(_) => 0,
                None => written_over(step, is_last),
            };
            found.of_steps.push(in_use - shared);
            if in_use - shared > peak {
                peak = in_use - shared;
                found.stored_at_peak = stored.clone();
            }
            let used = step.reads.iter().chain(&step.writes).flatten().chain(&step.scratch);
            for plane in used.filter(|plane| is_last(plane)) {
                if stored.remove(plane) {
                    in_use -= weight(plane);
                }
            }
        }
        found
    }

    /// Most memory that is in use at once.
    pub(crate) fn peak(&self) -> u64 {
        self.of_steps.iter().copied().max().unwrap_or(0) // Without steps, none.
    }

    /// The first of the steps that use most.
    pub(crate) fn peak_step(&self) -> Option<usize> {
        let peak = self.peak();
        self.of_steps.iter().position(|in_use| *in_use == peak)
    }

    /// What of two uses is better comes first: a lower peak, then lower memory over all steps, where much counts more.
    pub(crate) fn badness(&self) -> (u64, u128) {
        let squares = self.of_steps.iter().map(|in_use| u128::from(*in_use).pow(2));
        (self.peak(), squares.sum())
    }
}

/// Memory of the planes that a kernel of points writes over planes that it reads for the last time; `is_last` tells
/// whether a read is the last one.
fn written_over(step: &UnassignedStep, is_last: impl Fn(&StoredPlane) -> bool) -> u64 {
    let Step::Kernel(kernel) = &step.step else { return 0 };
    if !kernel.is_of_points() {
        return 0;
    }
    let read: BTreeSet<StoredPlane> = step.reads.iter().flatten().copied().collect();
    let mut free: Vec<StoredPlane> = read.into_iter().filter(is_last).collect();
    let mut shared = 0;
    for plane in written(step) {
        if let Some(at) = free.iter().position(|from| from.1.format() == plane.1.format()) {
            shared += weight(&free.remove(at));
        }
    }
    shared
}

/// The plane whose texture a repeated kernel takes for its second run, if nothing reads it later: what its first run reads.
fn start_of(step: &UnassignedStep) -> Option<StoredPlane> {
    let Step::Kernel(kernel) = &step.step else { return None };
    let start = (*step.reads.get(kernel.feedback.as_ref()?.read)?)?;
    (step.reads.iter().flatten().filter(|plane| **plane == start).count() == 1).then_some(start)
}
