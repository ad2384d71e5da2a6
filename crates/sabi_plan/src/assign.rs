//! Stored results get slots, and give them back after their last reader.

use std::collections::{BTreeMap, BTreeSet};

use sabi_nodes::link::Plane;

use crate::draft::{Draft, Kept, What};
use crate::fuse::Value;
use crate::keys::result_key;
use crate::plan::{KernelStep, MoveStep, Plan, PlannedResult, SlotRef, Step, SurveyStep};
use crate::request::{Mode, Target};
use crate::schedule::Builder;
use crate::slots::SlotPool;

impl Builder<'_, '_> {
    /// Gives every stored plane a slot, and frees it after its last reader.
    pub(crate) fn assign_slots(&self, drafts: Vec<Draft>, wanted: Vec<(Target, Value)>) -> Plan {
        let keep_all = self.planner.mode == Mode::Interactive;
        let wanted_values: BTreeSet<Value> = wanted.iter().map(|(_, value)| *value).collect();
        let mut last_use: BTreeMap<(Kept, Plane), usize> = BTreeMap::new();
        for (at, draft) in drafts.iter().enumerate() {
            for plane in draft.reads.iter().chain(&draft.writes).flatten().chain(&draft.scratch) {
                last_use.insert(*plane, at);
            }
        }
        let is_wanted =
            |kept: &Kept| matches!(&kept.what, What::Result(value) if kept.level == 0 && wanted_values.contains(value));
        let mut dead_after: Vec<Vec<(Kept, Plane)>> = drafts.iter().map(|_| Vec::new()).collect();
        for (plane, at) in last_use {
            if !keep_all && !is_wanted(&plane.0) {
                dead_after[at].push(plane);
            }
        }
        let mut pool = SlotPool::default();
        let mut slot_of: BTreeMap<(Kept, Plane), SlotRef> = BTreeMap::new();
        let mut steps = Vec::new();
        let mut nodes = Names::default();
        for (at, draft) in drafts.into_iter().enumerate() {
            for plane in draft.writes.iter().flatten().chain(&draft.scratch) {
                slot_of.insert(*plane, pool.take(plane.1.format(), plane.0.room()));
            }
            let slots = |planes: &[Option<(Kept, Plane)>]| -> Vec<Option<SlotRef>> {
                planes.iter().map(|plane| plane.map(|plane| slot_of[&plane])).collect()
            };
            let (reads, writes) = (slots(&draft.reads), slots(&draft.writes));
            steps.push(with_slots(
                draft.step,
                reads,
                writes,
                draft.scratch.map(|plane| slot_of[&plane]),
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
        (node, output): Value,
        slot_of: &BTreeMap<(Kept, Plane), SlotRef>,
    ) -> PlannedResult {
        let stored = self.stored((node, output));
        let slots = stored
            .planes()
            .iter()
            .map(|plane| slot_of[&(Kept::result((node, output)), *plane)])
            .collect();
        let name = self.node(node).output(output).map_or("", |(name, _)| name);
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

fn with_slots(step: Step, reads: Vec<Option<SlotRef>>, writes: Vec<Option<SlotRef>>, scratch: Option<SlotRef>) -> Step {
    match step {
        Step::Source(mut source) => {
            let planes = source.writes.iter_mut().flat_map(|(_, planes)| planes);
            for ((_, place), slot) in planes.zip(writes.into_iter().flatten()) {
                *place = slot;
            }
            Step::Source(source)
        }
        Step::Move(step) => Step::Move(MoveStep {
            from: reads.into_iter().flatten().next().unwrap_or(step.from),
            to: writes.into_iter().flatten().next().unwrap_or(step.to),
            ..step
        }),
        Step::Survey(step) => Step::Survey(SurveyStep {
            from: reads.into_iter().flatten().next().unwrap_or(step.from),
            to: writes.into_iter().flatten().next().unwrap_or(step.to),
            ..step
        }),
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

/// Ids of nodes, each once, in the order in which they come.
#[derive(Default)]
struct Names {
    seen: BTreeSet<String>,
    in_order: Vec<String>,
}

impl Names {
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
