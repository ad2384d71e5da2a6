//! What viewports show: coarse pictures first, full ones after them.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Instant;

use sabi_gpu::Run;
use sabi_plan::{Plan, Target};

use super::evaluation_error::EvaluationError;
use super::event::LiveEvent;
use super::faults::{Broken, Laid};
use super::queue::Watch;
use super::request::Seen;
use super::sized_model::{SizedModel, Tally};
use super::worker::{Job, Key, SentShown, Worker};
use crate::error::{EngineError, ErrorKind};
use crate::evaluating::looks::Shows;
use crate::opening::modelless::targets;

impl Worker {
    /// Shows everything coarse, or in full where there is nothing coarser or that would only flicker.
    pub(super) fn show_first(&mut self, job: &mut Job, laid: &Laid) -> Result<(), EvaluationError> {
        let has_coarse = self.loaded.as_ref().is_some_and(|loaded| loaded.coarse.is_some());
        let is_quick = self.full_took.is_some_and(|took| took < self.options.coarse_after);
        job.is_full_first = !has_coarse || is_quick;
        if has_coarse {
            self.show(job, laid, true)?;
        }
        if job.is_full_first {
            self.show_in_full(job, laid)?;
        }
        Ok(())
    }

    /// Shows everything in full, unless that was done first.
    pub(super) fn show_full(&mut self, job: &mut Job, laid: &Laid) -> Result<(), EvaluationError> {
        if job.is_full_first {
            return Ok(());
        }
        self.go_on()?;
        self.show_in_full(job, laid)
    }

    fn show_in_full(&mut self, job: &mut Job, laid: &Laid) -> Result<(), EvaluationError> {
        if !self.take_graph_in_full(job, laid)? {
            return Ok(());
        }
        let started = Instant::now();
        let steps = job.tally.steps;
        self.show(job, laid, false)?;
        if job.tally.steps > steps {
            self.full_took = Some(started.elapsed());
        }
        Ok(())
    }

    /// Shows everything at one size, as far as it has changed.
    fn show(&mut self, job: &mut Job, laid: &Laid, is_coarse: bool) -> Result<(), EvaluationError> {
        // A first picture is finished once it was begun, so that a stream of wishes has something to show.
        let gives_way = !is_coarse && !job.is_full_first;
        for seen in job.request.seen.clone() {
            if gives_way {
                self.go_on()?;
            }
            match self.show_one(job, laid, &seen, is_coarse, gives_way) {
                Err(EvaluationError::Failed(error)) => {
                    if error.kind == ErrorKind::OutOfMemory {
                        self.forget_results();
                    }
                    self.tell(LiveEvent::Failed {
                        revision: job.request.revision,
                        error,
                    });
                    return Ok(());
                }
                shown => shown?,
            }
        }
        Ok(())
    }

    fn show_one(
        &mut self,
        job: &mut Job,
        laid: &Laid,
        seen: &Seen,
        is_coarse: bool,
        gives_way: bool,
    ) -> Result<(), EvaluationError> {
        let Worker {
            loaded,
            sent,
            broken,
            queue,
            ..
        } = self;
        let Some(sized) = loaded.as_mut().and_then(|loaded| loaded.at(is_coarse)) else {
            return Ok(());
        };
        let Some((wanted, shows)) = wanted(sized, laid, seen) else {
            return Ok(());
        };
        let plan = sized.plan(&laid.sound(&wanted, broken));
        let key = shown_key(sized, &plan, &shows);
        let before = sent.shown.get(seen).copied();
        let is_known = |sent: SentShown| if is_coarse { sent.coarse } else { sent.full } == Some(key);
        if is_coarse {
            job.coarse_keys.insert(seen.clone(), key);
        }
        // What was shown before is more to look at than the same with holes in it.
        let is_whole = |plan: &Plan| plan.results.len() == wanted.len();
        let is_worse = |plan: &Plan| !is_whole(plan) && before.is_some_and(|before| before.is_whole);
        if before.is_some_and(is_known) || (is_coarse && job.is_full_first) || is_worse(&plan) {
            return Ok(());
        }
        let watch = Watch { queue, gives_way };
        let (plan, mut run) = evaluate(sized, laid, broken, (&wanted, plan), &watch, &mut job.tally)?;
        if is_worse(&plan) {
            return Ok(());
        }
        let looks = sized.looks(&plan, &mut run, &shows, &watch)?;
        let now = SentShown {
            coarse: job.coarse_keys.get(seen).copied(),
            full: (!is_coarse).then_some(key),
            is_whole: is_whole(&plan),
        };
        sent.shown.insert(seen.clone(), now);
        let event = LiveEvent::Shown {
            revision: job.request.revision,
            seen: seen.clone(),
            is_coarse,
            model: sized.model.clone(),
            shown: Arc::new(looks),
        };
        self.tell(event);
        job.latency = Some(job.asked.elapsed());
        Ok(())
    }

    /// Lets go of all results, so that the next wish has room.
    pub(super) fn forget_results(&mut self) {
        if let Some(loaded) = &mut self.loaded {
            for sized in loaded.coarse.iter_mut().chain(&mut loaded.full) {
                sized.cache.clear();
            }
        }
    }
}

/// The results that something seen is made of, and which material shows which; none where a node is not there.
fn wanted(sized: &SizedModel, laid: &Laid, seen: &Seen) -> Option<(Vec<Target>, Shows)> {
    match seen {
        Seen::Node(node) => Some((vec![laid.found.get(node)?.clone()], Shows::One)),
        Seen::Outputs => {
            let nodes: BTreeSet<usize> = sized.serving.values().copied().collect();
            Some((targets(nodes), Shows::Served(sized.serving.clone())))
        }
    }
}

/// Runs a plan for what is wanted; where a node's result cannot be made, another one without what needs it.
pub(super) fn evaluate(
    sized: &mut SizedModel,
    laid: &Laid,
    broken: &mut BTreeMap<String, Broken>,
    (wanted, mut plan): (&[Target], Plan),
    watch: &Watch<'_>,
    tally: &mut Tally,
) -> Result<(Plan, Run), EvaluationError> {
    loop {
        match sized.run(&plan, watch, tally) {
            Ok(run) => return Ok((plan, run)),
            Err(EvaluationError::Node { node, why }) => {
                if !laid.take_down(broken, &node, &why) {
                    return Err(EvaluationError::Failed(EngineError::new(ErrorKind::BadInput, why)));
                }
                plan = sized.plan(&laid.sound(wanted, broken));
            }
            Err(error) => return Err(error),
        }
    }
}

/// Names what is shown: what each material wears, and whether that may differ once nothing moves.
fn shown_key(sized: &SizedModel, plan: &Plan, shows: &Shows) -> Key {
    let mut hash = blake3::Hasher::new();
    hash.update(&[u8::from(sized.is_approximate(plan))]);
    match shows {
        Shows::One => plan.results.iter().for_each(|result| {
            hash.update(&result.key);
        }),
        Shows::Served(serving) => {
            for (material, node) in serving {
                let result = plan.results.iter().find(|result| result.target.node == *node);
                hash.update(&material.to_le_bytes());
                hash.update(&result.map_or([0; 32], |result| result.key));
            }
        }
    }
    *hash.finalize().as_bytes()
}
