//! Steps of a plan that have to run, and the steps for which their results are needed.

use std::collections::{BTreeMap, BTreeSet};

use sabi_nodes::link::{KernelSpec, Plane};
use sabi_plan::{KernelStep, Level, Plan, SlotRef, Step};
use sabi_surface::atlas::TILE;

use crate::result_key::ResultKey;

/// Returns the content key of each slot of a plan in which no slot is reused (see [`Plan::with_own_slots`]).
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
            // Only results have keys, and a survey is not a result.
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

/// Returns the steps on which results depend that are not known.
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

/// Returns the slots whose values no later step of these reads, by the step after which that is true. A slot that holds
/// several values in turn is in the list of each. Results of the plan are in no list.
pub(crate) fn dead_after(plan: &Plan, steps: &[usize]) -> BTreeMap<usize, BTreeSet<SlotRef>> {
    let mut needed: BTreeSet<SlotRef> = plan.results.iter().flat_map(|result| &result.slots).copied().collect();
    let mut dead = BTreeMap::new();
    for at in steps.iter().rev() {
        let (reads, writes) = (reads(&plan.steps[*at]), writes(&plan.steps[*at]));
        let used = reads.iter().chain(&writes);
        let unneeded: BTreeSet<SlotRef> = used.filter(|slot| !needed.contains(slot)).copied().collect();
        dead.insert(*at, unneeded);
        writes.iter().for_each(|slot| {
            needed.remove(slot);
        });
        needed.extend(reads);
    }
    dead
}

/// Returns the slot that only the first run of a repeated kernel reads, if nothing reads it afterwards: its texture is free
/// for the second run.
pub(crate) fn free_after_first_run(kernel: &KernelStep, dead: &BTreeSet<SlotRef>) -> Option<SlotRef> {
    let feedback = kernel.feedback.as_ref().filter(|feedback| feedback.run_count > 1)?;
    let start = *kernel.reads.get(feedback.read)?.as_ref()?;
    let is_read_once = kernel.reads.iter().flatten().filter(|slot| **slot == start).count() == 1;
    (is_read_once && dead.contains(&start)).then_some(start)
}

/// Returns the slots that a kernel of points reads and that are `dead` after it, by the written slots that can take over
/// their textures. Both slots have the same format, and each occurs once.
pub(crate) fn written_over(plan: &Plan, kernel: &KernelStep, dead: &BTreeSet<SlotRef>) -> BTreeMap<SlotRef, SlotRef> {
    let all_bound = kernel.reads.iter().chain(&kernel.writes).all(Option::is_some);
    if !kernel.is_of_points() || !all_bound {
        return BTreeMap::new();
    }
    let read: BTreeSet<SlotRef> = kernel.reads.iter().flatten().copied().collect();
    let mut free: Vec<SlotRef> = read.into_iter().filter(|slot| dead.contains(slot)).collect();
    let mut over = BTreeMap::new();
    for slot in kernel.writes.iter().flatten() {
        if let Some(at) = free.iter().position(|from| plan.slots[*from] == plan.slots[*slot]) {
            over.insert(*slot, free.remove(at));
        }
    }
    over
}

/// Approximate limit of the bytes of the bands that a kernel writes before they are copied over the textures that it reads.
const BAND_BYTES: u64 = 32 << 20;
/// Minimum number of bands of a page.
const FEWEST_BANDS: u32 = 8;

/// Returns the number of rows of a band whose rows have `row_bytes` bytes: a multiple of the tile size.
pub(crate) fn band_rows([_, height, _]: [u32; 3], row_bytes: u64) -> u32 {
    let within = BAND_BYTES / row_bytes.max(1);
    let rows = within.min(u64::from(height.div_ceil(FEWEST_BANDS))) as u32;
    (rows.max(1).next_multiple_of(TILE)).min(height)
}

/// Returns the number of bytes that a kernel saves by writing its results over textures that it is the last to read. It
/// does so only from a limit on.
fn spared(
    plan: &Plan,
    kernel: &KernelStep,
    dead: &BTreeSet<SlotRef>,
    from: u64,
    bytes: impl Fn(SlotRef) -> u64,
) -> u64 {
    let over = written_over(plan, kernel, dead);
    let sum: u64 = over.keys().map(|slot| bytes(*slot)).sum();
    match sum >= from {
        true => sum.saturating_sub(BAND_BYTES),
        false => 0,
    }
}

/// Returns the maximum number of bytes of slots that hold needed values at the same time in a run of these steps, given
/// the bytes of each slot. Above a limit, kernels write their results over textures that no later step reads.
pub(crate) fn most_alive(
    plan: &Plan,
    steps: &[usize],
    dead: &BTreeMap<usize, BTreeSet<SlotRef>>,
    writes_over_from: u64,
    bytes: impl Fn(SlotRef) -> u64,
) -> u64 {
    let none = BTreeSet::new();
    let mut alive: BTreeSet<SlotRef> = BTreeSet::new();
    let mut most = 0;
    for at in steps {
        let step = &plan.steps[*at];
        let dead = dead.get(at).unwrap_or(&none);
        alive.extend(reads(step).into_iter().chain(writes(step)));
        let sum: u64 = alive.iter().map(|slot| bytes(*slot)).sum();
        let shared = match step {
            Step::Kernel(kernel) => match free_after_first_run(kernel, dead) {
                Some(start) => second_written(kernel).map_or(0, |second| bytes(start).min(bytes(second))),
                None => spared(plan, kernel, dead, writes_over_from, &bytes),
            },
            Step::Source(_) | Step::Move(_) | Step::Survey(_) => 0,
        };
        most = most.max(sum - shared);
        alive.retain(|slot| !dead.contains(slot));
    }
    most
}

/// Returns the steps among these that are the last to use their kernel.
pub(crate) fn last_of_kernels(plan: &Plan, steps: &[usize]) -> BTreeSet<usize> {
    let mut seen: Vec<&KernelSpec> = Vec::new();
    let mut last = BTreeSet::new();
    for at in steps.iter().rev() {
        if let Step::Kernel(kernel) = &plan.steps[*at]
            && !seen.contains(&&kernel.spec)
        {
            seen.push(&kernel.spec);
            last.insert(*at);
        }
    }
    last
}

/// Returns the slot that a repeated kernel writes in its second run. The last run writes the slot of the result.
fn second_written(kernel: &KernelStep) -> Option<SlotRef> {
    let feedback = kernel.feedback.as_ref()?;
    match feedback.run_count.is_multiple_of(2) {
        true => kernel.writes.first().copied().flatten(),
        false => Some(feedback.scratch),
    }
}
