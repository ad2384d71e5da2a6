//! Pictures of viewports, coarse before full.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Instant;

use sabi_gpu::Run;
use sabi_plan::{Plan, Target};

use super::{Job, PictureHash, SentLooks, Worker};
use crate::error::{EngineError, ErrorKind};
use crate::evaluating::looks::{LookAssignment, ModelLooks};
use crate::live::evaluation_error::EvaluationError;
use crate::live::event::LiveEvent;
use crate::live::flattened_request::{FailedNode, FlattenedRequest};
use crate::live::queue::WorkProgress;
use crate::live::request::ViewSubject;
use crate::live::sized_model::{RunTotals, SizedModel};
use crate::opening::graph_faults::targets;
use crate::source::paint::NAME as PAINT;

impl Worker {
    /// Sends coarse pictures, or full ones if there is no coarse size or full ones are quick.
    pub(super) fn show_first(&mut self, job: &mut Job, flattened: &FlattenedRequest) -> Result<(), EvaluationError> {
        let has_coarse = self.loaded.as_ref().is_some_and(|loaded| loaded.coarse.is_some());
        let is_quick = self.full_duration.is_some_and(|took| took < self.options.coarse_after)
            || (has_coarse && self.full_runs_in_part(job, flattened)?);
        job.is_full_first = !has_coarse || is_quick;
        if has_coarse {
            self.show(job, flattened, true)?;
        }
        if job.is_full_first {
            self.show_in_full(job, flattened)?;
        }
        Ok(())
    }

    /// Returns true if full pictures of all subjects need only a few tiles, for example while a stroke is drawn.
    fn full_runs_in_part(&mut self, job: &Job, flattened: &FlattenedRequest) -> Result<bool, EvaluationError> {
        let is_loaded = self.loaded.as_ref().is_some_and(|loaded| loaded.full.is_some());
        // Only strokes change a few tiles.
        let is_painted = flattened.graph.nodes.iter().any(|node| node.kind == PAINT);
        if !is_loaded || !is_painted || !self.set_graph_in_full(job, flattened)? {
            return Ok(false);
        }
        let Worker {
            loaded, failed_nodes, ..
        } = self;
        let Some(sized) = loaded.as_mut().and_then(|loaded| loaded.full.as_mut()) else {
            return Ok(false);
        };
        let mut in_part = job
            .request
            .subjects
            .iter()
            .map(|subject| match wanted(sized, flattened, subject) {
                Some((wanted, _)) => sized.runs_in_part(&flattened.without_failed(&wanted, failed_nodes)),
                None => true,
            });
        Ok(in_part.all(|own| own))
    }

    /// Sends full pictures, unless they have been sent already.
    pub(super) fn show_full(&mut self, job: &mut Job, flattened: &FlattenedRequest) -> Result<(), EvaluationError> {
        if job.is_full_first {
            return Ok(());
        }
        self.stop_if_superseded()?;
        self.show_in_full(job, flattened)
    }

    fn show_in_full(&mut self, job: &mut Job, flattened: &FlattenedRequest) -> Result<(), EvaluationError> {
        if !self.set_graph_in_full(job, flattened)? {
            return Ok(());
        }
        let started = Instant::now();
        let steps = job.totals.steps;
        self.show(job, flattened, false)?;
        if job.totals.steps > steps {
            self.full_duration = Some(started.elapsed());
        }
        Ok(())
    }

    /// Sends pictures of all subjects at one size if they have changed.
    fn show(&mut self, job: &mut Job, flattened: &FlattenedRequest, is_coarse: bool) -> Result<(), EvaluationError> {
        // A first picture is always finished, so that a stream of requests still shows pictures.
        let is_superseded_by_requests = !is_coarse && !job.is_full_first;
        for subject in job.request.subjects.clone() {
            if is_superseded_by_requests {
                self.stop_if_superseded()?;
            }
            match self.show_one(job, flattened, &subject, is_coarse, is_superseded_by_requests) {
                Err(EvaluationError::Failed(error)) => {
                    if error.kind == ErrorKind::OutOfMemory {
                        self.forget_results();
                    }
                    self.send(LiveEvent::Failed {
                        revision: job.request.revision,
                        error,
                    });
                    return Ok(());
                }
                looks => looks?,
            }
        }
        Ok(())
    }

    fn show_one(
        &mut self,
        job: &mut Job,
        flattened: &FlattenedRequest,
        subject: &ViewSubject,
        is_coarse: bool,
        is_superseded_by_requests: bool,
    ) -> Result<(), EvaluationError> {
        let Worker {
            loaded,
            sent,
            failed_nodes,
            queue,
            ..
        } = self;
        let Some(sized) = loaded.as_mut().and_then(|loaded| loaded.at(is_coarse)) else {
            return Ok(());
        };
        let Some((wanted, shows)) = wanted(sized, flattened, subject) else {
            return Ok(());
        };
        let plan = sized.plan(&flattened.without_failed(&wanted, failed_nodes));
        let key = looks_key(sized, &plan, &shows);
        let before = sent.looks.get(subject).copied();
        let is_known = |sent: SentLooks| if is_coarse { sent.coarse } else { sent.full } == Some(key);
        if is_coarse {
            job.coarse_keys.insert(subject.clone(), key);
        }
        // An earlier complete picture is better than a newer one with missing materials.
        let is_whole = |plan: &Plan| plan.results.len() == wanted.len();
        let is_worse = |plan: &Plan| !is_whole(plan) && before.is_some_and(|before| before.is_whole);
        if before.is_some_and(is_known) || (is_coarse && job.is_full_first) || is_worse(&plan) {
            return Ok(());
        }
        let work = WorkProgress {
            queue,
            is_superseded_by_requests,
        };
        let (plan, mut run) = evaluate(sized, flattened, failed_nodes, &wanted, plan, &work, &mut job.totals)?;
        if is_worse(&plan) {
            return Ok(());
        }
        let looks = sized.looks(&plan, &mut run, &shows, &work)?;
        let now = SentLooks {
            coarse: job.coarse_keys.get(subject).copied(),
            full: (!is_coarse).then_some(key),
            is_whole: is_whole(&plan),
        };
        sent.looks.insert(subject.clone(), now);
        let event = looks_event(job, subject, is_coarse, sized, flattened, looks);
        self.send(event);
        job.latency = Some(job.submitted.elapsed());
        Ok(())
    }

    /// Clears the caches of results, so that memory is free for the next request.
    pub(super) fn forget_results(&mut self) {
        if let Some(loaded) = &mut self.loaded {
            for sized in loaded.coarse.iter_mut().chain(&mut loaded.full) {
                sized.cache.clear();
            }
        }
    }
}

/// Returns the event with the looks of a subject.
fn looks_event(
    job: &Job,
    subject: &ViewSubject,
    is_coarse: bool,
    sized: &SizedModel,
    flattened: &FlattenedRequest,
    looks: ModelLooks,
) -> LiveEvent {
    LiveEvent::Looks {
        revision: job.request.revision,
        subject: subject.clone(),
        is_coarse,
        model: sized.model.clone(),
        looks: Arc::new(looks),
        outputs: Arc::new(outputs_of(sized, flattened)),
    }
}

/// Returns the id of the output that serves each material.
fn outputs_of(sized: &SizedModel, flattened: &FlattenedRequest) -> BTreeMap<u32, String> {
    let nodes = &flattened.graph.nodes;
    let served = sized.node_of_material.iter();
    // The node for materials that no output serves comes after all others.
    let served = served.filter_map(|(material, node)| Some((*material, nodes.get(*node)?.id.clone())));
    served.collect()
}

/// Returns the targets of a subject and their assignment to materials; `None` if a node does not exist.
pub(super) fn wanted(
    sized: &SizedModel,
    flattened: &FlattenedRequest,
    subject: &ViewSubject,
) -> Option<(Vec<Target>, LookAssignment)> {
    match subject {
        ViewSubject::Node(node) => Some((vec![flattened.found.get(node)?.clone()], LookAssignment::One)),
        ViewSubject::Outputs => {
            let nodes: BTreeSet<usize> = sized.node_of_material.values().copied().collect();
            Some((targets(nodes), LookAssignment::Served(sized.node_of_material.clone())))
        }
    }
}

/// Runs a plan for the wanted targets. If a source node fails, plans again without the targets that need it.
pub(super) fn evaluate(
    sized: &mut SizedModel,
    flattened: &FlattenedRequest,
    failed_nodes: &mut BTreeMap<String, FailedNode>,
    wanted: &[Target],
    mut plan: Plan,
    progress: &WorkProgress<'_>,
    totals: &mut RunTotals,
) -> Result<(Plan, Run), EvaluationError> {
    loop {
        match sized.run(&plan, progress, totals) {
            Ok(run) => return Ok((plan, run)),
            Err(EvaluationError::Node { node, why, is_too_long }) => {
                if !flattened.record_failure(failed_nodes, &node, &why, is_too_long) {
                    return Err(EvaluationError::Failed(EngineError::new(ErrorKind::BadInput, why)));
                }
                plan = sized.plan(&flattened.without_failed(wanted, failed_nodes));
            }
            Err(error) => return Err(error),
        }
    }
}

/// Returns a hash of the results that materials show, and whether they are approximate.
fn looks_key(sized: &SizedModel, plan: &Plan, shows: &LookAssignment) -> PictureHash {
    let mut hash = blake3::Hasher::new();
    hash.update(&[u8::from(sized.is_approximate(plan))]);
    match shows {
        LookAssignment::One => plan.results.iter().for_each(|result| {
            hash.update(&result.key);
        }),
        LookAssignment::Served(node_of_material) => {
            for (material, node) in node_of_material {
                let result = plan.results.iter().find(|result| result.target.node == *node);
                hash.update(&material.to_le_bytes());
                hash.update(&result.map_or([0; 32], |result| result.key));
            }
        }
    }
    *hash.finalize().as_bytes()
}
