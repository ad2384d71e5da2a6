//! Order of groups: producers before readers, chosen so that little memory is in use at the same time.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

use crate::fuse::{FusionGroup, ResultRef};
use crate::memory_use::{MemoryUse, StoredPlane, is_result, weight, written};
use crate::plan::Step;
use crate::request::Mode;
use crate::resources::{TextureContent, UnassignedStep};
use crate::step_builder::StepBuilder;

/// Most attempts to find a better order. Each looks at all steps.
const MOST_ATTEMPTS: usize = 256;

/// Groups that are to be ordered, with their steps.
pub(crate) struct GroupOrder<'b> {
    built: &'b [Vec<UnassignedStep>],
    /// For each group those that produce what it reads, in the order of inputs.
    inputs: Vec<Vec<usize>>,
    /// Index of the group that produces each value.
    producer: &'b BTreeMap<ResultRef, usize>,
    wanted: &'b [ResultRef],
}

impl<'b> GroupOrder<'b> {
    /// `built` has the steps of each group.
    pub(crate) fn new(
        builder: &'b StepBuilder<'_, '_>,
        groups: &[FusionGroup],
        built: &'b [Vec<UnassignedStep>],
        wanted: &'b [ResultRef],
    ) -> GroupOrder<'b> {
        GroupOrder {
            built,
            inputs: groups.iter().map(|group| producers_of(builder, group)).collect(),
            producer: &builder.producer,
            wanted,
        }
    }

    /// Orders groups from inputs to results, depth first, so that results are freed soon. If results are kept anyway,
    /// inputs are followed in their order. Otherwise this order is compared with that of Sethi and Ullman ("The generation
    /// of optimal code for arithmetic expressions", 1970), in which the input that needs the most memory in addition to its
    /// result comes first, while little else is stored. The order that needs less memory is used.
    pub(crate) fn order(&self, mode: Mode) -> Vec<usize> {
        let as_written = self.depth_first(&self.inputs);
        if mode == Mode::Interactive {
            return as_written;
        }
        let largest_first = self.depth_first(&largest_first(self.built, &self.inputs, &as_written));
        let orders = [as_written, largest_first];
        // Of two orders that are as good the first one is taken.
        let least = orders.into_iter().min_by_key(|order| self.memory_use(order).peak());
        let least = least.unwrap_or_else(|| unreachable!("there are two orders"));
        self.better(least)
    }

    /// Lets the group that needs most memory run earlier, with all that it needs: before one of those whose results are stored
    /// meanwhile. Goes on as long as that makes the order better.
    fn better(&self, mut order: Vec<usize>) -> Vec<usize> {
        let mut known = self.memory_use(&order);
        let mut attempts = 0;
        loop {
            let Some(group) = known.peak_step().and_then(|step| self.group_of_step(&order, step)) else {
                return order;
            };
            let needed = with_producers(group, &self.inputs);
            let makers = self.makers(&known.stored_at_peak);
            let places = order.iter().take_while(|other| **other != group);
            let places = places
                .enumerate()
                .filter(|(_, other)| makers.contains(*other) && !needed.contains(*other));
            let tried: Vec<Vec<usize>> = places
                .take(MOST_ATTEMPTS.saturating_sub(attempts))
                .map(|(place, _)| moved_to(place, &needed, &order))
                .collect();
            attempts += tried.len();
            let tried = tried.into_iter().map(|order| (self.memory_use(&order), order));
            let best = tried.min_by_key(|(of, _)| of.badness());
            match best.filter(|(of, _)| of.badness() < known.badness()) {
                Some((of, other)) => (known, order) = (of, other),
                None => return order,
            }
        }
    }

    /// Groups that make planes.
    fn makers(&self, planes: &BTreeSet<StoredPlane>) -> BTreeSet<usize> {
        let maker = |(resource, _): &StoredPlane| {
            let TextureContent::Result(value) = resource.content else {
                return None;
            };
            self.producer.get(&value).copied()
        };
        planes.iter().filter_map(maker).collect()
    }

    /// The group with a step of an order.
    fn group_of_step(&self, order: &[usize], step: usize) -> Option<usize> {
        let steps = order
            .iter()
            .flat_map(|group| self.built[*group].iter().map(move |step| (*group, step)));
        first_moves(steps).nth(step).map(|(group, _)| group)
    }

    /// Returns the groups that the wanted values need, each after all groups that it reads. `inputs` lists the groups that
    /// each group reads, in the order in which they are followed.
    fn depth_first(&self, inputs: &[Vec<usize>]) -> Vec<usize> {
        let mut seen = BTreeSet::new();
        let mut order = Vec::new();
        for value in self.wanted {
            // An explicit stack is used, since graphs may be deeper than the stack of a thread allows. It is not petgraph's
            // `DfsPostOrder`: a petgraph graph does not say in which order it lists the edges of a node, and that order decides
            // here how much memory is in use.
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

    /// Memory in use when groups run in an order.
    fn memory_use(&self, order: &[usize]) -> MemoryUse {
        let is_wanted = |plane: &StoredPlane| {
            is_result(plane) && matches!(plane.0.content, TextureContent::Result(value) if self.wanted.contains(&value))
        };
        let steps = order
            .iter()
            .flat_map(|group| self.built[*group].iter().map(move |step| (*group, step)));
        let steps: Vec<&UnassignedStep> = first_moves(steps).map(|(_, step)| step).collect();
        MemoryUse::of(&steps, is_wanted)
    }
}

/// Returns the groups that produce what a group reads, in the order of inputs.
fn producers_of(builder: &StepBuilder<'_, '_>, group: &FusionGroup) -> Vec<usize> {
    let nodes: BTreeSet<usize> = group.values().into_iter().map(|(node, _)| node).collect();
    let inputs = nodes
        .iter()
        .flat_map(|node| builder.node(*node).inputs.iter().flatten());
    inputs
        .map(|input| builder.producer[&(input.node, input.output)])
        .collect()
}

/// Steps of groups, without moves of planes that an earlier one has moved to the same level.
fn first_moves<'b>(
    steps: impl Iterator<Item = (usize, &'b UnassignedStep)>,
) -> impl Iterator<Item = (usize, &'b UnassignedStep)> {
    let mut moved = BTreeSet::new();
    steps.filter(move |(_, step)| !matches!(step.step, Step::Move(_)) || written(step).any(|plane| moved.insert(plane)))
}

/// A group and all that it needs.
fn with_producers(group: usize, inputs: &[Vec<usize>]) -> BTreeSet<usize> {
    let mut needed = BTreeSet::new();
    let mut stack = vec![group];
    while let Some(group) = stack.pop() {
        if needed.insert(group) {
            stack.extend(&inputs[group]);
        }
    }
    needed
}

/// Returns the order with those of `groups` that come after `place` moved forward to it. `groups` includes everything
/// that they need.
fn moved_to(place: usize, groups: &BTreeSet<usize>, order: &[usize]) -> Vec<usize> {
    let (before, behind) = order.split_at(place);
    let (first, rest): (Vec<usize>, Vec<usize>) = behind.iter().partition(|group| groups.contains(*group));
    before.iter().copied().chain(first).chain(rest).collect()
}

/// Returns for each group the groups whose results it reads, sorted by the memory that they need in addition to their
/// results, the largest first. In `order`, every group comes after the groups that it reads.
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
        let (mut stored, mut need) = (0, MemoryUse::of(&steps, is_result).peak());
        for from in &sorted[group] {
            need = need.max(stored + needs[*from]);
            stored += left[from];
        }
        needs[group] = need;
    }
    sorted
}
