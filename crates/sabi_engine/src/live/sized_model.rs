//! Model at one size, with the graph on it and its cache of results.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Duration;

use sabi_export::SetKey;
use sabi_gpu::{Gpu, Hits, ResultCache, Run, RunReport};
use sabi_graph::{FlatGraph, Overrides};
use sabi_plan::{Mode, Plan, Step, Target};

use super::evaluation_error::EvaluationError;
use super::event::LiveModel;
use super::request::{LiveOptions, LiveRequest};
use crate::error::{EngineError, ErrorKind};
use crate::evaluating::evaluated_graph::model_source_node;
use crate::evaluating::evaluator::{Evaluator, EvaluatorOptions};
use crate::evaluating::looks::{LookAssignment, ModelLooks, looks_of_run};
use crate::evaluating::texture_sets::{TextureSet, assign_shown_nodes, texture_sets};
use crate::evaluating::texture_space::TextureSpace;
use crate::opening::document::OpenGraph;
use crate::opening::linked_model::{LinkedModel, ModelOptions};
use crate::opening::solidity;
use crate::phases::Progress;
use crate::source::paint::is_plainly_painted_on;
use crate::warning::Warning;
use sabi_gpu::AdapterChoice;

/// Rays per texel of a coarse picture while a knob is dragged.
const FEW_RAYS: u32 = 8;

/// Model at one size, with the evaluator of the graph on it and the cached results.
pub(super) struct SizedModel {
    pub(super) evaluator: Evaluator,
    pub(super) cache: ResultCache,
    pub(super) model: Arc<LiveModel>,
    /// Layout of the texture set that was last wanted.
    texture_space: Option<(TextureSet, TextureSpace)>,
    /// Index of the node whose result each material shows.
    pub(super) node_of_material: BTreeMap<u32, usize>,
    /// Warnings about outputs that serve no material.
    unused_outputs: Vec<String>,
    /// Warnings, each with the sources of the run that caused it. Sources with cached results do not warn again.
    source_warnings: Vec<(BTreeSet<[u8; 32]>, Warning)>,
    /// Sources that the current request needs.
    sources: BTreeSet<[u8; 32]>,
    /// True if the current request casts rays.
    traces_rays: bool,
    kinds_revision: u64,
    /// True if this is the coarse size.
    is_coarse: bool,
    submission: Duration,
}

/// Times and counts, summed over runs.
#[derive(Default)]
pub(super) struct RunTotals {
    pub(super) nodes: BTreeMap<String, Duration>,
    pub(super) steps: usize,
    pub(super) cache_hits: usize,
}

impl RunTotals {
    fn add(&mut self, plan: &Plan, report: &RunReport) {
        self.steps += report.steps.len();
        self.cache_hits += plan.steps.len() - report.steps.len();
        for step in &report.steps {
            for (node, share) in &step.nodes {
                *self.nodes.entry(node.clone()).or_default() += step.run.mul_f32(share.max(0.0));
            }
        }
    }
}

impl SizedModel {
    /// Uploads a model at one size.
    pub(super) fn new(
        gpu: &Arc<Gpu>,
        options: &LiveOptions,
        request: &LiveRequest,
        open: &OpenGraph,
        linked: Arc<LinkedModel>,
        model_revision: u64,
        is_coarse: bool,
    ) -> Result<SizedModel, EngineError> {
        let evaluator_options = EvaluatorOptions {
            model: ModelOptions {
                cache_dir: options.cache_dir.clone(),
                size: linked.atlas.size,
                ..(*request.model).clone()
            },
            overrides: Overrides::default(),
            fit: None,
            adapter: AdapterChoice::Auto,
            caster: options.caster,
            budget_bytes: options.budget_bytes,
        };
        let graph = FlatGraph::default();
        let kinds = (*request.kinds).clone();
        let mut evaluator = Evaluator::assemble(open, graph, kinds, linked, gpu.clone(), &evaluator_options)?;
        evaluator.evaluate_shown_alone();
        // Coarse results have at most a quarter of the texels of full ones.
        let of_coarse = options.cache_bytes / 4;
        let cache_bytes = if is_coarse {
            of_coarse
        } else {
            options.cache_bytes - of_coarse
        };
        Ok(SizedModel {
            model: live_model(&evaluator, model_revision)?,
            evaluator,
            cache: ResultCache::new(cache_bytes),
            texture_space: None,
            node_of_material: BTreeMap::new(),
            unused_outputs: Vec::new(),
            source_warnings: Vec::new(),
            sources: BTreeSet::new(),
            traces_rays: false,
            kinds_revision: request.kinds_revision,
            is_coarse,
            submission: options.submission,
        })
    }

    /// Sets the graph of a request. Returns true if the fit has changed, so that the model must be sent again.
    pub(super) fn set_graph(
        &mut self,
        request: &LiveRequest,
        open: &OpenGraph,
        graph: &FlatGraph,
    ) -> Result<bool, EngineError> {
        if self.kinds_revision != request.kinds_revision {
            self.evaluator.set_kinds((*request.kinds).clone());
            self.kinds_revision = request.kinds_revision;
            self.cache.forget_plans();
        }
        let surface = self.evaluator.surface_key();
        let (node_of_material, unused_outputs) = assign_shown_nodes(graph, self.evaluator.linked());
        self.node_of_material = node_of_material;
        // A node at the end of the graph provides the model's own materials for those that no output serves.
        let mut graph = graph.clone();
        graph.nodes.push(model_source_node(open.document.fit));
        self.evaluator.set_graph(open, graph)?;
        if self.evaluator.surface_key() != surface {
            self.cache.forget_plans();
        }
        self.unused_outputs = unused_outputs;
        self.sources.clear();
        self.traces_rays = false;
        self.evaluator.rays.hits = if request.is_moving { Hits::Cached } else { Hits::Cast };
        let is_another = self.evaluator.fit() != self.model.fit;
        if is_another {
            self.model = live_model(&self.evaluator, self.model.model_revision)?;
        }
        Ok(is_another)
    }

    /// Returns the layout of the wanted texture set, or of the first if the model does not have it, and the evaluator.
    pub(super) fn texture_space(
        &mut self,
        wanted: Option<SetKey>,
    ) -> Result<(&Evaluator, &TextureSet, &TextureSpace), EngineError> {
        let SizedModel {
            model,
            texture_space,
            evaluator,
            ..
        } = self;
        let set = model.set(wanted).ok_or_else(no_texture_space)?;
        let known = texture_space.take().filter(|(known, _)| known == set);
        let (set, texture_space) = texture_space
            .insert(known.unwrap_or_else(|| (set.clone(), TextureSpace::new(evaluator.linked(), set.key))));
        Ok((evaluator, set, texture_space))
    }

    /// Plans the targets as far as possible. While a knob is dragged, coarse pictures use few rays, which are not cached.
    pub(super) fn plan(&mut self, targets: &[Target]) -> Plan {
        self.evaluator.rays.most_rays = None;
        let mut plan = self.try_plan(targets);
        let is_new = |keys: &[[u8; 32]]| keys.iter().any(|key| !self.cache.contains(key));
        let traces_rays = |step: &Step| match step {
            Step::Kernel(kernel) => kernel.rays.as_ref().is_some_and(|rays| is_new(&rays.results)),
            _ => false,
        };
        if self.is_coarse && self.is_moving() && plan.steps.iter().any(traces_rays) {
            self.evaluator.rays.most_rays = Some(FEW_RAYS);
            plan = self.try_plan(targets);
        }
        self.traces_rays |= plan.steps.iter().any(has_rays);
        self.sources.extend(sources_of(&plan));
        plan
    }

    /// Returns true if the targets need only some tiles that strokes have changed.
    pub(super) fn runs_in_part(&mut self, targets: &[Target]) -> bool {
        let plan = self.plan(targets);
        self.cache
            .would_run_in_part(&plan, self.evaluator.shown(), &|before, now| {
                is_plainly_painted_on(before, now)
            })
    }

    fn try_plan(&self, targets: &[Target]) -> Plan {
        // The faults of all nodes were sent when the request was flattened.
        self.evaluator.try_plan(targets, Mode::Interactive).0
    }

    /// Lists the warnings about nodes and sources that the current request needs.
    pub(super) fn warnings(&self) -> impl Iterator<Item = Warning> {
        let is_of_now = |of: &BTreeSet<[u8; 32]>| of.is_empty() || !of.is_disjoint(&self.sources);
        let source_warnings = self.source_warnings.iter().filter(move |(of, _)| is_of_now(of));
        let of_model = self.traces_rays.then(|| self.model.linked.solidity.get()).flatten();
        let sentences = self.unused_outputs.iter();
        let sentences = sentences.map(|sentence| Warning::from(sentence.as_str()));
        let source_warnings = source_warnings.map(|(_, warning)| warning);
        let evaluator = self.evaluator.warnings().iter();
        let warnings = evaluator.chain(source_warnings).chain(of_model.into_iter().flatten());
        warnings.cloned().chain(sentences)
    }

    /// Checks the model for properties on which rays depend, if the current request casts any.
    pub(super) fn check_solidity(&self) {
        if self.traces_rays {
            solidity::of_model(&self.model.linked);
        }
    }

    fn is_moving(&self) -> bool {
        self.evaluator.rays.hits == Hits::Cached
    }

    /// Returns true if results of a plan may differ, by rounding or noise, from those after the knob is released.
    pub(super) fn is_approximate(&self, plan: &Plan) -> bool {
        self.is_moving() && plan.steps.iter().any(has_rays)
    }

    /// Runs a plan.
    pub(super) fn run(
        &mut self,
        plan: &Plan,
        progress: &dyn Progress,
        totals: &mut RunTotals,
    ) -> Result<Run, EvaluationError> {
        let (gpu, size) = (self.evaluator.gpu().clone(), self.model.size);
        let made = self.evaluator.make_levels(plan, progress);
        made.map_err(|error| EvaluationError::of(&gpu, error))?;
        let known = self.evaluator.warnings().len();
        let cache = Some(&mut self.cache);
        let run = self.evaluator.run_on_levels(plan, self.submission, progress, cache);
        for warning in self.evaluator.take_warnings_after(known) {
            self.source_warnings.retain(|(_, other)| *other != warning);
            self.source_warnings.push((sources_of(plan).collect(), warning));
        }
        let run = run.map_err(|error| EvaluationError::of_run(&gpu, size, error))?;
        totals.add(plan, &run.report);
        Ok(run)
    }

    /// Creates the looks of materials from the results of a run.
    pub(super) fn looks(
        &mut self,
        plan: &Plan,
        run: &mut Run,
        shows: &LookAssignment,
        progress: &dyn Progress,
    ) -> Result<ModelLooks, EvaluationError> {
        let is_canceled = || progress.is_canceled();
        let options = self.evaluator.run_options(self.submission, &is_canceled);
        let looks = looks_of_run(&self.evaluator, plan, run, shows, &options, Some(&mut self.cache));
        looks.map_err(|error| EvaluationError::of_results(self.evaluator.gpu(), self.model.size, error))
    }
}

/// Error for a model without a texture set.
pub(super) fn no_texture_space() -> EngineError {
    EngineError::new(
        ErrorKind::BadInput,
        "the model has no texture space that could be shown",
    )
}

fn has_rays(step: &Step) -> bool {
    matches!(step, Step::Kernel(kernel) if kernel.rays.is_some())
}

/// Lists the keys of the results of a plan's sources.
fn sources_of(plan: &Plan) -> impl Iterator<Item = [u8; 32]> {
    let keys = |step: &Step| match step {
        Step::Source(source) => source.keys.clone(),
        _ => Vec::new(),
    };
    plan.steps.iter().flat_map(keys)
}

fn live_model(evaluator: &Evaluator, model_revision: u64) -> Result<Arc<LiveModel>, EngineError> {
    let linked = evaluator.linked();
    let view = evaluator.view_model()?;
    if let Some(shade) = linked.found_shade() {
        view.set_shade(evaluator.gpu(), shade.ground, shade.openness)?;
    }
    Ok(Arc::new(LiveModel {
        model_revision,
        size: linked.atlas.size,
        linked: linked.clone(),
        placement: view.placement,
        view,
        fit: evaluator.fit(),
        warnings: linked.warnings(),
        // A model without sets has an empty list. An error is reported when a set is wanted.
        sets: texture_sets(&linked.model, &linked.atlas, None).unwrap_or_default(),
    }))
}
