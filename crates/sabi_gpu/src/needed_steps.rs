//! Steps of a plan that have to run, and the last uses of their results.

use std::collections::{BTreeMap, BTreeSet};

use sabi_nodes::link::Plane;
use sabi_plan::{Level, Plan, SlotRef, Step};

use crate::result_key::ResultKey;

/// Content key of every slot of a plan in which no slot is reused, as of [`Plan::with_own_slots`].
pub(crate) fn slot_keys(plan: &Plan) -> BTreeMap<SlotRef, ResultKey> {
    let mut keys = BTreeMap::new();
    for step in &plan.steps {
        match step {
            Step::Source(source) => {
                for ((_, planes), content) in source.writes.iter().zip(&source.keys) {
                    let named = |(plane, slot): &(Plane, SlotRef)| (*slot, ResultKey::whole(*content, *plane));
                    keys.extend(planes.iter().map(named));
                }
            }
            Step::Move(step) => {
                let result = step.result.map(|(content, plane)| ResultKey::whole(content, plane));
                keys.extend(result.map(|key| (step.to, key)));
            }
            // Only results have keys, and a survey is none.
            Step::Survey(_) => {}
            // Values of a coarser level are moved to the finest one before they are a result.
            Step::Kernel(kernel) if kernel.level != Level::FINEST => {}
            Step::Kernel(kernel) => {
                let planes = kernel
                    .spec
                    .stores
                    .iter()
                    .enumerate()
                    .flat_map(|(store, spec)| spec.stored.planes().into_iter().map(move |plane| (store, plane)));
                for ((store, plane), slot) in planes.zip(&kernel.writes) {
                    if let (Some(slot), Some(content)) = (slot, kernel.keys.get(store)) {
                        keys.insert(*slot, ResultKey::whole(*content, plane));
                    }
                }
            }
        }
    }
    keys
}

/// Slots that a step reads.
pub(crate) fn reads(step: &Step) -> Vec<SlotRef> {
    match step {
        Step::Source(source) => source.reads.iter().flatten().copied().collect(),
        Step::Move(step) => vec![step.from],
        Step::Survey(step) => vec![step.from],
        Step::Kernel(kernel) => kernel.reads.iter().flatten().copied().collect(),
    }
}

/// Slots that a step writes.
pub(crate) fn writes(step: &Step) -> Vec<SlotRef> {
    match step {
        Step::Source(source) => source
            .writes
            .iter()
            .flat_map(|(_, planes)| planes)
            .map(|(_, slot)| *slot)
            .collect(),
        Step::Move(step) => vec![step.to],
        Step::Survey(step) => vec![step.to],
        Step::Kernel(kernel) => {
            let scratch = kernel.feedback.iter().map(|feedback| feedback.scratch);
            kernel.writes.iter().flatten().copied().chain(scratch).collect()
        }
    }
}

/// Steps that lead to a result that is not known.
pub(crate) fn needed_steps(plan: &Plan, known: &BTreeSet<SlotRef>) -> Vec<usize> {
    let mut wanted: BTreeSet<SlotRef> = plan.results.iter().flat_map(|result| &result.slots).copied().collect();
    let mut steps = Vec::new();
    for (at, step) in plan.steps.iter().enumerate().rev() {
        let is_missing = |slot: &SlotRef| wanted.contains(slot) && !known.contains(slot);
        if known.is_empty() || writes(step).iter().any(is_missing) {
            wanted.extend(reads(step));
            steps.push(at);
        }
    }
    steps.reverse();
    steps
}

/// Slots that these steps of a plan write.
pub(crate) fn written_by(plan: &Plan, steps: &[usize]) -> BTreeSet<SlotRef> {
    steps.iter().flat_map(|at| writes(&plan.steps[*at])).collect()
}

/// Last one of these steps that uses each slot; `usize::MAX` for results.
pub(crate) fn last_uses(plan: &Plan, steps: &[usize]) -> BTreeMap<SlotRef, usize> {
    let mut last = BTreeMap::new();
    for at in steps {
        let step = &plan.steps[*at];
        last.extend(reads(step).into_iter().chain(writes(step)).map(|slot| (slot, *at)));
    }
    last.extend(
        plan.results
            .iter()
            .flat_map(|result| &result.slots)
            .map(|slot| (*slot, usize::MAX)),
    );
    last
}
