//! A graph and a model brought together on a device.

mod change;

use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use sabi_gpu::{
    AdapterChoice, CasterChoice, DeviceHierarchy, Gpu, GpuError, GpuSurface, Hits, ResultCache, Run, RunOptions,
    Shares, SurfaceTables, Surfaces,
};
use sabi_graph::{Fit, FlatGraph, FlatNode, Found, NodeRef, Overrides};
use sabi_nodes::kind::Shape;
use sabi_plan::{Lengths, Limits, Mode, Plan, PlanError, Planner, Target};
use sabi_surface::atlas::{AtlasOptions, atlas_key};

use crate::error::{EngineError, ErrorKind};
use crate::evaluating::ray_cache::RayCache;
use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;
use crate::opening::levels::AtlasLevels;
use crate::opening::linked_model::{LinkedModel, ModelOptions};
use crate::opening::overridden::refuse_bad_values;
use crate::opening::pictures::{Pictures, files};
use crate::opening::setting::read_typed;
use crate::opening::solidity;
use crate::phases::{Phase, PhaseTimes, Progress};
use crate::source::{Files, SourceSurface, Sources};
use crate::warning::Warning;

/// How a graph and a model are brought together.
pub struct EvaluatorOptions {
    /// The model.
    pub model: ModelOptions,
    /// Variant, values and seed on top of the file. A text is taken as typed: what it is read as depends on the parameter.
    pub overrides: Overrides,
    /// What counts as 1, in place of the document's fit.
    pub fit: Option<Fit>,
    /// Which adapter.
    pub adapter: AdapterChoice,
    /// Who follows rays.
    pub caster: CasterChoice,
    /// Bytes of textures that may be held at once.
    pub budget_bytes: u64,
}

/// A graph on a model, ready to be evaluated.
pub struct Evaluator {
    /// The graph file, as it was named.
    pub path: PathBuf,
    /// The flat graph.
    pub graph: FlatGraph,
    /// All node kinds, with `source/model` as this model has it.
    pub kinds: Kinds,
    /// The model with its atlas.
    pub linked: Arc<LinkedModel>,
    /// The device.
    pub gpu: Arc<Gpu>,
    /// The atlas on the device.
    pub surface: GpuSurface,
    /// What counts as 1.
    pub fit: Fit,
    /// Who follows rays.
    pub caster: CasterChoice,
    /// Whether all rays are shot, or what is known of longer ones will do, as while a knob is moved.
    pub hits: Hits,
    /// For a first picture, which is grainy and quick: no place shoots more rays than this. None for all of them.
    pub most_rays: Option<u32>,
    /// Whether runs say what part of them the filling of ghosts took.
    pub times_ghosts: bool,
    /// Time spent so far.
    pub times: PhaseTimes,
    /// What is probably not intended.
    pub warnings: Vec<Warning>,
    pictures: Pictures,
    tables: SurfaceTables,
    bvh_on_device: OnceLock<DeviceHierarchy>,
    levels: AtlasLevels,
    /// Texels that share a place on the maps; none where each has its own.
    pub(crate) shares: OnceLock<Option<Shares>>,
    ray_cache: RayCache,
    /// Warnings on the model itself, which stay when the graph changes.
    of_model: Vec<Warning>,
    /// What takes the place of the document's own.
    chosen: (Option<Fit>, Option<u32>),
    seed: u32,
    surface_key: [u8; 32],
    pub(crate) budget_bytes: u64,
}

impl Evaluator {
    /// The graph as these options want it, without groups; values that no node takes are refused.
    pub fn flat_graph(open: &OpenGraph, kinds: &Kinds, options: &EvaluatorOptions) -> Result<FlatGraph, EngineError> {
        Evaluator::flat_graph_and_find(open, kinds, options, &[]).map(|(graph, _)| graph)
    }

    /// The same, and where in it the results of some nodes of the document come from.
    pub(crate) fn flat_graph_and_find(
        open: &OpenGraph,
        kinds: &Kinds,
        options: &EvaluatorOptions,
        wanted: &[NodeRef],
    ) -> Result<(FlatGraph, Vec<Found>), EngineError> {
        let overrides = Overrides {
            fit: options.fit.or(options.overrides.fit),
            ..options.overrides.clone()
        };
        let overrides = read_typed(open, kinds, &overrides);
        let (graph, found) = open.flatten_and_find(&overrides, wanted)?;
        refuse_bad_values(open, &graph, kinds, &overrides)?;
        Ok((graph, found))
    }

    /// Opens everything on the adapter of choice; `graph` is from [`Evaluator::flat_graph`].
    pub fn open(
        open: &OpenGraph,
        graph: FlatGraph,
        kinds: Kinds,
        options: &EvaluatorOptions,
        progress: &dyn Progress,
    ) -> Result<Evaluator, EngineError> {
        let mut times = PhaseTimes::default();
        let model = times.load.time(|| LinkedModel::load_model(&options.model))?;
        progress.advance(Phase::Load, 1, 1);
        stop_if_canceled(progress)?;
        let linked = times
            .atlas
            .time(|| LinkedModel::link(model, &options.model, progress))?;
        stop_if_canceled(progress)?;
        let gpu = times.compile.time(|| Gpu::open(&options.adapter))?;
        let mut evaluator = Evaluator::assemble(open, graph, kinds, linked, Arc::new(gpu), options)?;
        evaluator.times.load.add(times.load.total());
        evaluator.times.atlas = times.atlas;
        evaluator.times.compile = times.compile;
        Ok(evaluator)
    }

    /// Brings together what is loaded already, on a device that others use too.
    pub fn assemble(
        open: &OpenGraph,
        graph: FlatGraph,
        mut kinds: Kinds,
        linked: impl Into<Arc<LinkedModel>>,
        gpu: Arc<Gpu>,
        options: &EvaluatorOptions,
    ) -> Result<Evaluator, EngineError> {
        let linked: Arc<LinkedModel> = linked.into();
        let mut times = PhaseTimes::default();
        let chosen = (options.fit.or(options.overrides.fit), options.overrides.seed);
        let fit = chosen.0.unwrap_or(open.document.fit);
        let seed = chosen.1.unwrap_or(open.document.seed);
        let tables = times.load.time(|| linked.tables(&fit, seed));
        let levels = times.atlas.time(|| AtlasLevels::new(&linked, &fit));
        let surface = times
            .load
            .time(|| GpuSurface::upload(&gpu, &linked.atlas, &tables, levels.of(0)))?;
        kinds.adapt_to(&linked.model);
        let of_model = linked.warnings();
        let left_out = kinds.left_out().map(Warning::from);
        let warnings = of_model.iter().cloned().chain(left_out).collect();
        let surface_key = surface_key(&linked, &tables);
        let budget_bytes = options.budget_bytes;
        Ok(Evaluator {
            path: open.path.clone(),
            graph,
            kinds,
            linked,
            gpu,
            surface,
            fit,
            times,
            warnings,
            pictures: open.pictures.clone(),
            tables,
            bvh_on_device: OnceLock::new(),
            levels,
            shares: OnceLock::new(),
            of_model,
            chosen,
            seed,
            surface_key,
            caster: options.caster,
            hits: Hits::Cast,
            most_rays: None,
            times_ghosts: false,
            ray_cache: RayCache::new(options.model.cache_dir.as_deref()),
            budget_bytes,
        })
    }

    /// Plans what the targets need; warnings are kept, anything worse is an error.
    pub fn plan(&mut self, targets: &[Target], mode: Mode, limits: Limits) -> Result<Plan, EngineError> {
        let (plan, errors) = self.try_plan(targets, mode, limits);
        let (warnings, errors): (Vec<PlanError>, Vec<PlanError>) = errors.into_iter().partition(PlanError::is_warning);
        let path = self.path.display().to_string();
        let said = |error: &PlanError| format!("{path}: {error}");
        let messages: Vec<String> = errors.iter().map(said).collect();
        self.warn(warnings.iter().map(said));
        self.warn(solidity::warnings(&plan, &self.linked));
        match errors.into_iter().next() {
            None => Ok(plan),
            Some(first) => Err(EngineError::several(ErrorKind::BadInput, messages).caused_by(first)),
        }
    }

    /// Adds warnings, each once however often it is given.
    pub(crate) fn warn(&mut self, warnings: impl IntoIterator<Item = impl Into<Warning>>) {
        for warning in warnings.into_iter().map(Into::into) {
            if !self.warnings.contains(&warning) {
                self.warnings.push(warning);
            }
        }
    }

    /// Files that this work was read from: they must not be written over.
    pub(crate) fn read_files(&self, open: &OpenGraph) -> Vec<PathBuf> {
        let groups = self.graph.nodes.iter().filter_map(|node| node.file.as_ref());
        let groups = groups.map(|file| open.folder().join(file));
        let model = self.linked.model.files.iter().cloned();
        let named = files(open.folder(), &self.graph, &self.kinds);
        let own = std::iter::once(open.path.clone()).chain(groups);
        own.chain(model).chain(named).collect()
    }

    /// The folder that paths in the graph start from.
    fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }

    /// Plans what of the targets can be planned, and says what is at fault.
    pub fn try_plan(&self, targets: &[Target], mode: Mode, limits: Limits) -> (Plan, Vec<PlanError>) {
        let scale = self.linked.working_from_model(&self.fit);
        let wanted: Vec<usize> = targets.iter().map(|target| target.node).collect();
        let wanted = self.graph.upstream(&wanted);
        let contents = self.pictures.contents(self.folder(), &self.graph, &self.kinds, wanted);
        let is_filter = |node: &FlatNode| {
            let kind = self.kinds.library.kind(&node.kind);
            kind.is_some_and(|kind| kind.shape == Shape::Field)
        };
        let has_filters = self.graph.nodes.iter().any(is_filter);
        let levels = self.levels.widths(&self.linked, has_filters);
        let planner = Planner {
            graph: &self.graph,
            library: &self.kinds.library,
            sources: &self.kinds.sources,
            sinks: &self.kinds.sinks,
            files: &contents,
            lengths: Lengths {
                working_from: &|fit| scale / self.linked.working_from_model(fit),
                extent: &|direction| self.linked.extent(&self.fit, direction),
            },
            levels: &levels,
            surface_key: self.surface_key,
            mode,
            most_rays: self.most_rays,
            limits,
        };
        planner.plan(targets)
    }

    /// Runs the only plan of this work, and lets go of the pictures that its nodes name.
    pub(crate) fn run_once(
        &mut self,
        plan: &Plan,
        submission: Duration,
        progress: &dyn Progress,
    ) -> Result<Run, EngineError> {
        let run = self.run(plan, submission, progress, None)?;
        self.pictures.forget();
        Ok(run)
    }

    /// Runs a plan; `submission` is how long one piece of work may hold the device.
    pub fn run(
        &mut self,
        plan: &Plan,
        submission: Duration,
        progress: &dyn Progress,
        cache: Option<&mut ResultCache>,
    ) -> Result<Run, EngineError> {
        self.make_levels(plan)?;
        Ok(self.run_on_levels(plan, submission, progress, cache)?)
    }

    /// Makes the coarser levels that a plan runs on and that are not there yet.
    pub(crate) fn make_levels(&mut self, plan: &Plan) -> Result<(), EngineError> {
        self.levels.make(plan, &self.gpu, &self.linked, &self.fit, self.seed)
    }

    /// Runs a plan whose levels are there.
    pub(crate) fn run_on_levels(
        &mut self,
        plan: &Plan,
        submission: Duration,
        progress: &dyn Progress,
        cache: Option<&mut ResultCache>,
    ) -> Result<Run, GpuError> {
        let ground = SourceSurface {
            model: &self.linked.model,
            atlas: &self.linked.atlas,
            tables: &self.tables,
            pieces: &self.linked.pieces,
            bvh: &self.linked.bvh,
            bvh_on_device: &self.bvh_on_device,
            working_from_model: self.linked.working_from_model(&self.fit),
        };
        let files = Files {
            pictures: &self.pictures,
            folder: self.folder(),
            graph: &self.graph,
        };
        let mut sources = Sources::new(ground, files, &self.ray_cache);
        let options = RunOptions {
            submission,
            is_canceled: &|| progress.is_canceled(),
            progress: &|done, of| progress.advance(Phase::Run, done, of),
            budget_bytes: self.budget_bytes,
            caster: self.caster,
            hits: self.hits,
            times_ghosts: self.times_ghosts,
        };
        let surfaces = Surfaces {
            finest: &self.surface,
            coarser: &self.levels.coarser,
        };
        let run = self
            .gpu
            .run(surfaces, &self.kinds.library, plan, &options, &mut sources, cache);
        let told = sources.warnings;
        self.warn(told);
        let run = run?;
        self.times.compile.add(run.report.compile);
        self.times.run.add(run.report.run);
        Ok(run)
    }
}

/// Ends the work with an error if the user asked for it.
pub(crate) fn stop_if_canceled(progress: &dyn Progress) -> Result<(), EngineError> {
    if progress.is_canceled() {
        return Err(EngineError::new(ErrorKind::Interrupted, "stopped; nothing was written"));
    }
    Ok(())
}

/// Names the surface: the atlas by what it is made of, and where every triangle lies in space. The program itself need not be
/// part of it: results are kept in memory, and those of rays on disk have a version of their own.
fn surface_key(linked: &LinkedModel, tables: &SurfaceTables) -> [u8; 32] {
    let mut hash = blake3::Hasher::new();
    hash.update(&atlas_key(&linked.model.mesh, &AtlasOptions::new(linked.atlas.size)));
    for row in tables.geometry.iter().chain(&tables.frames).chain(&tables.pieces) {
        hash.update(row.map(f32::to_le_bytes).as_flattened());
    }
    *hash.finalize().as_bytes()
}
