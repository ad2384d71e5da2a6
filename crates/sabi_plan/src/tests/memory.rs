//! Memory that plans of bakes need at once.

use std::collections::{BTreeMap, BTreeSet};

use super::{FUSED, TestPlanner, graph};
use crate::{KernelStep, Level, Plan, SlotExtent, SlotRef, Step};

/// Bytes of a texel of the finest level that a slot takes.
fn bytes(plan: &Plan, slot: SlotRef) -> u64 {
    match plan.slots[slot].extent {
        SlotExtent::Level(Level::FINEST) => plan.slots[slot].format.texel_bytes(),
        // A quarter or less.
        SlotExtent::Level(_)
        | SlotExtent::Survey
        | SlotExtent::GroupSurvey
        | SlotExtent::Single
        | SlotExtent::Groups => 0,
    }
}

/// Slots that a step reads, and those that it writes.
fn used(step: &Step) -> [Vec<SlotRef>; 2] {
    match step {
        Step::Source(source) => {
            let written = source.writes.iter().flat_map(|(_, planes)| planes);
            [
                source.reads.iter().flatten().copied().collect(),
                written.map(|(_, slot)| *slot).collect(),
            ]
        }
        Step::Kernel(kernel) => {
            let scratch = kernel.feedback.iter().map(|feedback| feedback.scratch);
            [
                kernel.reads.iter().flatten().copied().collect(),
                kernel.writes.iter().flatten().copied().chain(scratch).collect(),
            ]
        }
        Step::Move(step) => [vec![step.from], vec![step.to]],
        Step::Survey(step) => [vec![step.from], vec![step.to]],
    }
}

/// Bytes of what a kernel of points writes over planes that it reads last.
fn written_over(plan: &Plan, kernel: &KernelStep, dead: &BTreeSet<SlotRef>) -> u64 {
    if !kernel.is_of_points() {
        return 0;
    }
    let read: BTreeSet<SlotRef> = kernel.reads.iter().flatten().copied().collect();
    let mut free: Vec<SlotRef> = read.intersection(dead).copied().collect();
    let mut sum = 0;
    for slot in kernel.writes.iter().flatten() {
        if let Some(at) = free.iter().position(|from| plan.slots[*from] == plan.slots[*slot]) {
            free.remove(at);
            sum += bytes(plan, *slot);
        }
    }
    sum
}

/// Most bytes for a texel of the finest level that are in use at once.
fn peak(plan: &Plan) -> u64 {
    let mut needed: BTreeSet<SlotRef> = plan.results.iter().flat_map(|result| &result.slots).copied().collect();
    let mut dead_after: BTreeMap<usize, BTreeSet<SlotRef>> = BTreeMap::new();
    for (at, step) in plan.steps.iter().enumerate().rev() {
        let [reads, writes] = used(step);
        let unneeded = reads.iter().chain(&writes).filter(|slot| !needed.contains(slot));
        dead_after.insert(at, unneeded.copied().collect());
        for slot in &writes {
            needed.remove(slot);
        }
        needed.extend(reads);
    }
    let (mut alive, mut most) = (BTreeSet::new(), 0);
    for (at, step) in plan.steps.iter().enumerate() {
        alive.extend(used(step).into_iter().flatten());
        let sum: u64 = alive.iter().map(|slot| bytes(plan, *slot)).sum();
        let over = match step {
            Step::Kernel(kernel) => written_over(plan, kernel, &dead_after[&at]),
            Step::Source(_) | Step::Move(_) | Step::Survey(_) => 0,
        };
        most = most.max(sum - over);
        alive.retain(|slot| !dead_after[&at].contains(slot));
    }
    most
}

/// Layers over a material, each with a mask that is blurred and a noise that both the mask and the layer read.
fn layers(count: usize) -> String {
    let mut lines = "l0 source/material\n".to_owned();
    for layer in 1..=count {
        let below = layer - 1;
        lines += &format!(
            "n{layer} noise/simplex seed={layer}\n\
             s{layer} filter/blur source=n{layer} radius=0.003\n\
             a{layer} blend/mask below=s{layer} above=n{layer}\n\
             l{layer} effect/layer base=l{below} mask=a{layer} roughness_map=n{layer} height_map=a{layer} height=0.1\n"
        );
    }
    lines + &format!("out output/material material=l{count}")
}

#[test]
fn memory_does_not_grow_with_the_number_of_layers() {
    let mut bench = TestPlanner::new();
    let layer = bench.library.kind("effect/layer").unwrap().cost;
    bench.limits.cost.straight = 4 * layer.straight;
    let peaks = [3, 6, 12].map(|count| {
        let (plan, errors) = bench.plan(&graph(&layers(count)), FUSED);
        assert_eq!(errors, []);
        peak(&plan)
    });
    // A material of color, surface and height takes 20 bytes, and a blur that takes no level 84 while it runs.
    // Some masks are stored between two kernels.
    assert!(peaks[1] <= 120 && peaks[2] <= peaks[1] + 4, "{peaks:?}");
}

#[test]
fn a_kernel_of_points_counts_once_for_what_it_writes_over_what_it_reads_last() {
    let mut bench = TestPlanner::new();
    bench.limits.cost.straight = bench.library.kind("effect/layer").unwrap().cost.straight + 100;
    let mut lines = "l0 source/material\n".to_owned();
    for layer in 1..=4 {
        lines += &format!("l{layer} effect/layer base=l{}\n", layer - 1);
    }
    let (plan, errors) = bench.plan(&graph(&(lines + "out output/material material=l4")), FUSED);
    assert_eq!(errors, []);
    assert!(plan.passes() >= 3, "{plan}");
    let material: u64 = plan.results[0].slots.iter().map(|slot| bytes(&plan, *slot)).sum();
    assert_eq!(peak(&plan), material, "{plan}");
}
