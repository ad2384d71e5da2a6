//! Plans and runs of an evaluator.

use std::path::Path;
use std::time::Duration;

use sabi_gpu::{DEFAULT_KEEPS_FROM, DEFAULT_WRITES_OVER_FROM, GpuError, ResultCache, Run, RunOptions, run_plan};
use sabi_plan::{Lengths, Mode, Plan, PlanError, Planner, Target};

use super::Evaluator;
use crate::error::{EngineError, ErrorKind};
use crate::opening::graph_faults::remedies_of;
use crate::opening::solidity;
use crate::phases::{Phase, Progress};
use crate::program_cache::ProgramCache;
use crate::source::Sources;

impl Evaluator {
    /// Returns options for work on results outside of a run.
    pub(crate) fn run_options<'p>(&'p self, submission: Duration, is_canceled: &'p dyn Fn() -> bool) -> RunOptions<'p> {
        RunOptions {
            is_canceled,
            shown: self.shown(),
            ..RunOptions::new(submission, self.budget)
        }
    }

    /// Plans the targets with the limits of the device. Stores warnings, and returns other faults as an error.
    pub fn plan(&mut self, targets: &[Target], mode: Mode) -> Result<Plan, EngineError> {
        let (plan, errors) = self.try_plan(targets, mode);
        let (warnings, errors): (Vec<PlanError>, Vec<PlanError>) = errors.into_iter().partition(PlanError::is_warning);
        let path = self.graph.path().display().to_string();
        let said = |error: &PlanError| format!("{path}: {error}");
        let messages: Vec<String> = errors.iter().map(said).collect();
        self.warn(warnings.iter().map(said));
        self.warn(solidity::warnings(&plan, self.surface.linked()));
        let remedies = remedies_of(&errors);
        match errors.into_iter().next() {
            None => Ok(plan),
            Some(first) => Err(EngineError::several(ErrorKind::BadInput, messages)
                .with_remedies(remedies)
                .caused_by(first)),
        }
    }

    /// Plans the targets as far as possible, and returns the faults.
    pub fn try_plan(&self, targets: &[Target], mode: Mode) -> (Plan, Vec<PlanError>) {
        let _span = tracing::debug_span!("plan", targets = targets.len()).entered();
        let model = self.model();
        let kinds = self.graph.kinds();
        let contents = self.graph.contents(targets, &model.linked().model);
        let planner = Planner {
            graph: self.graph.flat(),
            library: &kinds.library,
            sources: &kinds.sources,
            sinks: &kinds.sinks,
            files: &contents,
            lengths: Lengths {
                working_from: &|fit| model.working_from(*fit),
                largest_piece: model.largest_piece(),
                extent: &|direction| model.extent(direction),
            },
            level_widths: self.surface.level_widths(self.graph.has_filters()),
            surface_key: self.surface.key(),
            mode,
            most_rays: self.rays.most_rays,
            limits: self.gpu.limits(),
        };
        let planned = planner.plan(targets);
        tracing::trace!("the plan:\n{}", planned.0);
        planned
    }

    /// Keeps results that take long to compute for later runs, and reads those of earlier runs, in a cache folder with a
    /// size limit. Plans must then have their own slots (see [`Plan::with_own_slots`]).
    pub(crate) fn keep_results(&mut self, cache_dir: &Path, limit_bytes: u64) {
        self.kept_results = ProgramCache::open(cache_dir, "results", "result", limit_bytes);
    }

    /// Makes runs forget kernels that no later step needs. The device must belong only to this evaluator.
    pub(crate) fn forget_kernels(&mut self) {
        self.forgets_kernels = true;
    }

    /// Runs the only plan of this evaluator, and drops the decoded pictures afterwards.
    pub(crate) fn run_once(
        &mut self,
        plan: &Plan,
        submission: Duration,
        progress: &dyn Progress,
    ) -> Result<Run, EngineError> {
        let run = self.run(plan, submission, progress, None)?;
        self.graph.forget_pictures();
        self.surface.forget_pictures();
        Ok(run)
    }

    /// Runs a plan. `submission` is the maximum time of one GPU submission.
    pub fn run(
        &mut self,
        plan: &Plan,
        submission: Duration,
        progress: &dyn Progress,
        cache: Option<&mut ResultCache>,
    ) -> Result<Run, EngineError> {
        self.make_levels(plan, progress)?;
        Ok(self.run_on_levels(plan, submission, progress, cache)?)
    }

    /// Builds the coarser levels on which a plan runs, as far as they are missing.
    pub(crate) fn make_levels(&mut self, plan: &Plan, progress: &dyn Progress) -> Result<(), EngineError> {
        progress.advance(Phase::Upload, 0, 1);
        self.surface.make_levels(plan, &self.gpu)
    }

    /// Runs a plan whose levels are built.
    pub(crate) fn run_on_levels(
        &mut self,
        plan: &Plan,
        submission: Duration,
        progress: &dyn Progress,
        cache: Option<&mut ResultCache>,
    ) -> Result<Run, GpuError> {
        let _span = tracing::debug_span!("run", steps = plan.steps.len()).entered();
        let mut sources = Sources::new(
            self.surface.for_sources(progress),
            self.graph.files(),
            &self.ray_cache,
            self.kept_results.as_ref(),
            progress,
        );
        let options = RunOptions {
            submission,
            is_canceled: &|| progress.is_canceled(),
            progress: &|done, of| progress.advance(Phase::Run, done, of),
            budget: self.budget,
            caster: self.rays.caster,
            hits: self.rays.hits,
            times_ghosts: self.times_ghosts,
            forgets_kernels: self.forgets_kernels,
            keeps_from: DEFAULT_KEEPS_FROM,
            writes_over_from: DEFAULT_WRITES_OVER_FROM,
            shown: self.shown(),
        };
        progress.advance(Phase::Run, 0, plan.steps.len());
        let (surfaces, library) = (self.surface.surfaces(), &self.graph.kinds().library);
        let run = run_plan(&self.gpu, surfaces, library, plan, &options, &mut sources, cache);
        let warnings = sources.warnings;
        self.warn(warnings);
        let run = run?;
        let report = &run.report;
        tracing::debug!(compile = ?report.compile, run = ?report.run, steps = report.steps.len(), "plan was run");
        self.times.compile.add(run.report.compile);
        self.times.run.add(run.report.run);
        Ok(run)
    }
}
