//! Order of groups: producers before readers, chosen so that little memory is in use at the same time.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

use sabi_nodes::link::Plane;

use crate::fuse::{Group, Value};
use crate::level::Level;
use crate::plan::{SlotExtent, Step};
use crate::request::Mode;
use crate::resources::{Content, Resource, UnassignedStep};
use crate::step_builder::StepBuilder;

/// A stored plane on a level.
type StoredPlane = (Resource, Plane);

impl StepBuilder<'_, '_> {
    /// Orders groups from inputs to results, depth first, so that results are freed soon. If results are kept anyway,
    /// inputs are followed in their order. Otherwise this order is compared with that of Sethi and Ullman ("The generation
    /// of optimal code for arithmetic expressions", 1970), in which the input that needs the most memory in addition to its
    /// result comes first, while little else is stored. The order that needs less memory is used.
    pub(crate) fn order(&self, groups: &[Group], built: &[Vec<UnassignedStep>], wanted: &[Value]) -> Vec<usize> {
        let inputs: Vec<Vec<usize>> = groups.iter().map(|group| self.producers_of(group)).collect();
        let as_written = self.depth_first(&inputs, wanted);
        if self.planner.mode == Mode::Interactive {
            return as_written;
        }
        let largest_first = self.depth_first(&largest_first(built, &inputs, &as_written), wanted);
        let orders = [as_written, largest_first];
        // If both orders have the same peak, the first one is used.
        let least = orders.into_iter().min_by_key(|order| self.peak(built, order, wanted));
        least.unwrap_or_else(|| unreachable!("there are two orders"))
    }

    /// Returns the groups that produce what a group reads, in the order of inputs.
    fn producers_of(&self, group: &Group) -> Vec<usize> {
        let nodes: BTreeSet<usize> = group.values().into_iter().map(|(node, _)| node).collect();
        let inputs = nodes.iter().flat_map(|node| self.node(*node).inputs.iter().flatten());
        inputs.map(|input| self.producer[&(input.node, input.output)]).collect()
    }

    /// Returns the groups that the wanted values need, each after all groups that it reads. `inputs` lists the groups that
    /// each group reads, in the order in which they are followed.
    fn depth_first(&self, inputs: &[Vec<usize>], wanted: &[Value]) -> Vec<usize> {
        let mut seen = BTreeSet::new();
        let mut order = Vec::new();
        for value in wanted {
            // An explicit stack is used, since graphs may be deeper than the stack of a thread allows.
            let mut stack = vec![(self.producer[value], false)];
            while let Some((group, inputs_done)) = stack.pop() {
                if inputs_done {
                    order.push(group);
                } else if seen.insert(group) {
                    stack.push((group, true));
                    let fresh = inputs[group].iter().filter(|from| !seen.contains(from));
                    let fresh: Vec<usize> = fresh.copied().collect();
                    stack.extend(fresh.into_iter().rev().map(|from| (from, false)));
                }
            }
        }
        order
    }

    /// Returns the peak of memory in use, in the unit of [`weight`], if groups run in this order.
    fn peak(&self, built: &[Vec<UnassignedStep>], order: &[usize], wanted: &[Value]) -> u64 {
        let is_wanted = |plane: &StoredPlane| {
            is_result(plane) && matches!(plane.0.content, Content::Result(value) if wanted.contains(&value))
        };
        let mut moved = BTreeSet::new();
        let steps = order.iter().flat_map(|group| &built[*group]);
        // Each plane is moved to a level only once.
        let steps =
            steps.filter(|step| !matches!(step.step, Step::Move(_)) || written(step).any(|plane| moved.insert(plane)));
        peak_of(&steps.collect::<Vec<_>>(), is_wanted)
    }
}

/// Returns for each group the groups that it reads, sorted so that the one that needs the most memory in addition to its
/// results comes first. In `order`, every group comes after those that it reads.
fn largest_first(built: &[Vec<UnassignedStep>], inputs: &[Vec<usize>], order: &[usize]) -> Vec<Vec<usize>> {
    let mut sorted: Vec<Vec<usize>> = inputs.to_vec();
    // Peak of memory while a group and everything that it needs run.
    let mut needs = vec![0_u64; built.len()];
    for &group in order {
        let steps: Vec<&UnassignedStep> = built[group].iter().collect();
        let read: BTreeSet<StoredPlane> = steps
            .iter()
            .flat_map(|step| step.reads.iter().flatten().copied())
            .collect();
        let left_by = |from: usize| -> u64 {
            let made: BTreeSet<StoredPlane> = built[from].iter().flat_map(written).collect();
            made.intersection(&read).map(weight).sum()
        };
        let left: BTreeMap<usize, u64> = inputs[group].iter().map(|from| (*from, left_by(*from))).collect();
        let mut seen = BTreeSet::from([group]);
        sorted[group].retain(|from| seen.insert(*from));
        sorted[group].sort_by_key(|from| Reverse(needs[*from].saturating_sub(left[from])));
        let (mut stored, mut need) = (0, peak_of(&steps, is_result));
        for from in &sorted[group] {
            need = need.max(stored + needs[*from]);
            stored += left[from];
        }
        needs[group] = need;
    }
    sorted
}

/// Returns the planes that a step writes, except the second texture of a repeated function.
fn written(step: &UnassignedStep) -> impl Iterator<Item = StoredPlane> {
    step.writes.iter().flatten().copied()
}

/// Returns whether a plane belongs to a result of a node, on the level on which others read it.
fn is_result((resource, _): &StoredPlane) -> bool {
    matches!(resource.content, Content::Result(_)) && resource.level == Level::FINEST
}

/// Returns the memory of a plane. A plane of single numbers on the finest level has weight 2²².
fn weight((resource, plane): &StoredPlane) -> u64 {
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

/// Returns the peak of memory while steps run. Planes that are read but written by none of the steps are in memory all the
/// time, and planes selected by `stays` from when they are written.
fn peak_of(steps: &[&UnassignedStep], stays: impl Fn(&StoredPlane) -> bool) -> u64 {
    let mut last_use: BTreeMap<StoredPlane, usize> = BTreeMap::new();
    let mut stored: BTreeSet<StoredPlane> = BTreeSet::new();
    for (at, step) in steps.iter().enumerate() {
        let read = step.reads.iter().flatten();
        stored.extend(read.clone().filter(|plane| !last_use.contains_key(plane)));
        last_use.extend(
            read.chain(step.writes.iter().flatten())
                .chain(&step.scratch)
                .map(|plane| (*plane, at)),
        );
    }
    let outer = stored.clone();
    let mut in_use: u64 = stored.iter().map(weight).sum();
    let mut peak = in_use;
    for (at, step) in steps.iter().enumerate() {
        for plane in step.writes.iter().flatten().chain(&step.scratch) {
            if stored.insert(*plane) {
                in_use += weight(plane);
            }
        }
        let is_last = |plane: &StoredPlane| last_use.get(plane) == Some(&at) && !outer.contains(plane);
        peak = peak.max(in_use - start_of(step).filter(is_last).map_or(0, |start| weight(&start)));
        let used = step.reads.iter().chain(&step.writes).flatten().chain(&step.scratch);
        for plane in used.filter(|plane| is_last(plane)) {
            if !stays(plane) && stored.remove(plane) {
                in_use -= weight(plane);
            }
        }
    }
    peak
}

/// Returns the plane whose texture a repeated kernel reuses for its second run if nothing reads it later: the plane that
/// its first run reads.
fn start_of(step: &UnassignedStep) -> Option<StoredPlane> {
    let Step::Kernel(kernel) = &step.step else { return None };
    let start = (*step.reads.get(kernel.feedback.as_ref()?.read)?)?;
    (step.reads.iter().flatten().filter(|plane| **plane == start).count() == 1).then_some(start)
}
