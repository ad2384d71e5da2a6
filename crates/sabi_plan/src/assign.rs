//! Assigns slots to stored results, and frees them after their last reader.

use std::collections::{BTreeMap, BTreeSet};

use sabi_nodes::link::Plane;

use crate::fuse::ResultRef;
use crate::keys::result_key;
use crate::level::Level;
use crate::plan::{KernelStep, MoveStep, Plan, PlannedResult, SlotRef, SourceStep, Step, SurveyStep};
use crate::request::{Mode, Target};
use crate::resources::{Resource, TextureContent, UnassignedStep};
use crate::slots::SlotPool;
use crate::step_builder::StepBuilder;

impl StepBuilder<'_, '_> {
    /// Assigns a slot to every stored plane, free again after the last step that reads it.
    pub(crate) fn assign_slots(&self, unassigned_steps: Vec<UnassignedStep>, wanted: Vec<(Target, ResultRef)>) -> Plan {
        let keep_all = self.planner.mode == Mode::Interactive;
        let wanted_values: BTreeSet<ResultRef> = wanted.iter().map(|(_, value)| *value).collect();
        let mut last_use: BTreeMap<(Resource, Plane), usize> = BTreeMap::new();
        for (at, unassigned) in unassigned_steps.iter().enumerate() {
            for plane in unassigned
                .reads
                .iter()
                .chain(&unassigned.writes)
                .flatten()
                .chain(&unassigned.scratch)
            {
                last_use.insert(*plane, at);
            }
        }
        let is_wanted = |resource: &Resource| matches!(&resource.content, TextureContent::Result(value) if resource.level == Level::FINEST && wanted_values.contains(value));
        let mut dead_after: Vec<Vec<(Resource, Plane)>> = unassigned_steps.iter().map(|_| Vec::new()).collect();
        for (plane, at) in last_use {
            if !keep_all && !is_wanted(&plane.0) {
                dead_after[at].push(plane);
            }
        }
        let mut pool = SlotPool::default();
        let mut slot_of: BTreeMap<(Resource, Plane), SlotRef> = BTreeMap::new();
        let mut steps = Vec::new();
        let mut nodes = NodeIds::default();
        for (at, unassigned) in unassigned_steps.into_iter().enumerate() {
            for plane in unassigned.writes.iter().flatten().chain(&unassigned.scratch) {
                slot_of.insert(*plane, pool.take(plane.1.format(), plane.0.extent()));
            }
            let slots = |planes: &[Option<(Resource, Plane)>]| -> Vec<Option<SlotRef>> {
                planes.iter().map(|plane| plane.map(|plane| slot_of[&plane])).collect()
            };
            let (reads, writes) = (slots(&unassigned.reads), slots(&unassigned.writes));
            steps.push(with_slots(
                unassigned.step,
                reads,
                writes,
                unassigned.scratch.map(|plane| slot_of[&plane]),
            ));
            nodes.add(&steps[at]);
            for plane in std::mem::take(&mut dead_after[at]) {
                if let Some(slot) = slot_of.remove(&plane) {
                    pool.release(slot);
                }
            }
        }
        let results = wanted
            .into_iter()
            .map(|(target, value)| self.result(target, value, &slot_of))
            .collect();
        Plan {
            slots: pool.into_slots(),
            steps,
            results,
            nodes: nodes.in_order,
        }
    }

    fn result(
        &self,
        target: Target,
        (node, output): ResultRef,
        slot_of: &BTreeMap<(Resource, Plane), SlotRef>,
    ) -> PlannedResult {
        let stored = self.stored((node, output));
        let slots = stored
            .planes()
            .iter()
            .map(|plane| slot_of[&(Resource::result((node, output)), *plane)])
            .collect();
        let (name, _) = self.output((node, output));
        let key = result_key(self.node(node), name);
        PlannedResult {
            target,
            from: (self.id(node), name.to_owned()),
            stored,
            slots,
            key,
        }
    }
}

/// Slots of a step that reads one plane and writes one.
fn single_slots(reads: &[Option<SlotRef>], writes: &[Option<SlotRef>]) -> [SlotRef; 2] {
    match (reads, writes) {
        ([Some(from)], [Some(to)]) => [*from, *to],
        _ => unreachable!("moves and surveys are built with one plane to read and one to write"),
    }
}

fn with_slots(step: Step, reads: Vec<Option<SlotRef>>, writes: Vec<Option<SlotRef>>, scratch: Option<SlotRef>) -> Step {
    match step {
        Step::Source(mut source) => {
            let planes = source.writes.iter_mut().flat_map(|(_, planes)| planes);
            for ((_, place), slot) in planes.zip(writes.into_iter().flatten()) {
                *place = slot;
            }
            Step::Source(SourceStep { reads, ..source })
        }
        Step::Move(step) => {
            let [from, to] = single_slots(&reads, &writes);
            Step::Move(MoveStep { from, to, ..step })
        }
        Step::Survey(step) => {
            let [from, to] = single_slots(&reads, &writes);
            Step::Survey(SurveyStep { from, to, ..step })
        }
        Step::Kernel(mut kernel) => {
            if let (Some(feedback), Some(slot)) = (&mut kernel.feedback, scratch) {
                feedback.scratch = slot;
            }
            Step::Kernel(KernelStep {
                reads,
                writes,
                ..kernel
            })
        }
    }
}

/// Ids of nodes without repeats, in the order of first appearance.
#[derive(Default)]
struct NodeIds {
    seen: BTreeSet<String>,
    in_order: Vec<String>,
}

impl NodeIds {
    fn add(&mut self, step: &Step) {
        let names = match step {
            Step::Source(source) => std::slice::from_ref(&source.id),
            Step::Kernel(kernel) => &kernel.nodes,
            Step::Move(_) | Step::Survey(_) => &[],
        };
        for name in names {
            if self.seen.insert(name.clone()) {
                self.in_order.push(name.clone());
            }
        }
    }
}
