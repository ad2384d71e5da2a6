//! Evaluator of a graph on a model with a device.

mod plan_and_run;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use sabi_files::{PathBase, TrustedPaths, is_local};
use sabi_gpu::{
    AdapterChoice, AdapterKind, CasterChoice, Exported, Gpu, GpuSurface, Hits, Shares, ShownTiles, TextureBudget,
    TileSet,
};
use sabi_graph::{Document, Fit, FlatGraph, FlatNode, NodeRef, Overrides, ResultOrigin};
use sabi_view::{ViewModel, ViewModelParts};

use crate::error::EngineError;
use crate::evaluating::evaluated_graph::EvaluatedGraph;
use crate::evaluating::evaluated_surface::EvaluatedSurface;
use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;
use crate::opening::linked_model::{FittedModel, LinkedModel, ModelOptions};
use crate::opening::override_faults::{all_override_faults, refuse_bad_values};
use crate::opening::setting::read_typed;
use crate::phases::{NoProgress, Phase, PhaseTimes, Progress, stop_if_canceled};
use crate::program_cache::ProgramCache;
use crate::source::ray_cache::RayCache;
use crate::warning::Warning;

/// Options of an evaluator.
pub struct EvaluatorOptions {
    /// Model.
    pub model: ModelOptions,
    /// Variant, values and seed that override those of the file. A value may be a text, whose meaning depends on the parameter.
    pub overrides: Overrides,
    /// Fit in place of the document's.
    pub fit: Option<Fit>,
    /// Adapter to run on.
    pub adapter: AdapterChoice,
    /// Ray caster.
    pub caster: CasterChoice,
    /// Size limit of the textures of a run, bytes.
    pub budget_bytes: u64,
}

/// Settings of a run's rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RaySettings {
    /// Ray caster.
    pub caster: CasterChoice,
    /// Treatment of ray hits: all rays are cast, or hits are stored and used for shorter rays, for example while a knob is dragged.
    pub hits: Hits,
    /// Limit of rays per texel for a quick and noisy picture; `None` for all rays.
    pub most_rays: Option<u32>,
}

/// Evaluator of a graph on a model. It plans and runs, and collects times and warnings.
pub struct Evaluator {
    graph: EvaluatedGraph,
    surface: EvaluatedSurface,
    fixed: FixedSettings,
    gpu: Arc<Gpu>,
    /// Settings of the rays for the next plan and run.
    pub rays: RaySettings,
    ray_cache: RayCache,
    kept_results: Option<ProgramCache>,
    budget: TextureBudget,
    times_ghosts: bool,
    /// True if kernels are forgotten as soon as no further step needs them.
    forgets_kernels: bool,
    /// True if results are read only where they are shown.
    shows_alone: bool,
    times: PhaseTimes,
    warnings: Vec<Warning>,
}

/// Fit and seed that override the document's.
struct FixedSettings {
    fit: Option<Fit>,
    seed: Option<u32>,
}

impl FixedSettings {
    fn new(options: &EvaluatorOptions) -> FixedSettings {
        FixedSettings {
            fit: options.fit.or(options.overrides.fit),
            seed: options.overrides.seed,
        }
    }

    /// Returns the fit and the seed for a document.
    fn of(&self, document: &Document) -> (Fit, u32) {
        // The options override the document.
        (self.fit.unwrap_or(document.fit), self.seed.unwrap_or(document.seed))
    }
}

impl EvaluatorOptions {
    /// Returns the paths from which a graph file may open the files that it names, for these options of the user: the paths
    /// for its model, and files that are given as values.
    pub fn trusted_with(&self, graph: &Path) -> TrustedPaths {
        let base = PathBase::of_file(graph);
        let texts = self.overrides.set.iter().filter_map(|(_, value)| value.as_text());
        let files = texts.filter(|text| is_local(text) && !text.is_empty());
        let trusted = self.model.trusted.clone().with_file(graph);
        files.fold(trusted, |trusted, text| trusted.with_path(&base.resolve(text)))
    }

    /// Flattens a graph with the overrides of these options. Refuses values that no node takes.
    pub fn flat_graph(&self, open: &OpenGraph, kinds: &Kinds) -> Result<FlatGraph, EngineError> {
        self.flat_graph_and_find(open, kinds, &[]).map(|(graph, _)| graph)
    }

    /// Flattens a graph, and finds the nodes from which the results of some nodes of the document come.
    pub(crate) fn flat_graph_and_find(
        &self,
        open: &OpenGraph,
        kinds: &Kinds,
        wanted: &[NodeRef],
    ) -> Result<(FlatGraph, Vec<ResultOrigin>), EngineError> {
        let overrides = Overrides {
            fit: self.fit.or(self.overrides.fit),
            ..self.overrides.clone()
        };
        let typed = read_typed(open, kinds, &overrides);
        let flat = open.flatten_and_find(&typed, wanted);
        let (graph, found) = flat.map_err(|first| all_override_faults(open, kinds, &overrides, first))?;
        refuse_bad_values(open, &graph, kinds, &typed)?;
        Ok((graph, found))
    }

    /// Returns the limit of textures in addition to a model that takes `model_bytes`. A driver that runs on the processor
    /// keeps textures in the memory of the process, so the memory limit applies to them as well.
    fn texture_budget(&self, kind: AdapterKind, model_bytes: u64) -> TextureBudget {
        let left = self.model.memory_bytes.saturating_sub(model_bytes);
        match kind {
            AdapterKind::Cpu if left < self.budget_bytes => TextureBudget::Process(left),
            AdapterKind::Cpu | AdapterKind::Integrated | AdapterKind::Discrete => {
                TextureBudget::Textures(self.budget_bytes)
            }
        }
    }
}

impl Evaluator {
    /// Loads the model, opens the device and creates the evaluator. `graph` is from [`EvaluatorOptions::flat_graph`].
    pub fn open(
        open: &OpenGraph,
        graph: FlatGraph,
        kinds: Kinds,
        options: &EvaluatorOptions,
        progress: &dyn Progress,
    ) -> Result<Evaluator, EngineError> {
        Evaluator::open_resized(open, graph, kinds, options, progress, |_| options.model.size)
    }

    /// Opens an evaluator like [`Evaluator::open`], with maps of a size that is chosen for the loaded model and its texture coordinates.
    pub(crate) fn open_resized(
        open: &OpenGraph,
        graph: FlatGraph,
        kinds: Kinds,
        options: &EvaluatorOptions,
        progress: &dyn Progress,
        size_for: impl FnOnce(&LinkedModel) -> u32,
    ) -> Result<Evaluator, EngineError> {
        let mut times = PhaseTimes::default();
        let trusting = ModelOptions {
            trusted: options.model.trusted.clone().with(&open.trusted),
            ..options.model.for_graph(open)
        };
        let model = times.load.time(|| LinkedModel::load_model(&trusting, progress))?;
        progress.advance(Phase::Load, 1, 1);
        stop_if_canceled(progress)?;
        let linked = times
            .atlas
            .time(|| LinkedModel::link(model, &options.model, progress))?;
        stop_if_canceled(progress)?;
        let size = size_for(&linked);
        let linked = if size == options.model.size {
            linked
        } else {
            let resized = ModelOptions {
                size,
                ..options.model.clone()
            };
            times.atlas.time(|| linked.resized(&resized, progress))?
        };
        let gpu = times.compile.time(|| {
            let _span = tracing::debug_span!("open device").entered();
            Gpu::open(&options.adapter)
        })?;
        tracing::debug!(adapter = gpu.summary().name, "device opened");
        progress.advance(Phase::Upload, 0, 1);
        let mut evaluator = Evaluator::assemble(open, graph, kinds, linked, Arc::new(gpu), options)?;
        evaluator.times.load.add(times.load.total());
        evaluator.times.atlas = times.atlas;
        evaluator.times.compile = times.compile;
        Ok(evaluator)
    }

    /// Creates an evaluator from a loaded model and a device that others may use too.
    pub fn assemble(
        open: &OpenGraph,
        graph: FlatGraph,
        kinds: Kinds,
        linked: impl Into<Arc<LinkedModel>>,
        gpu: Arc<Gpu>,
        options: &EvaluatorOptions,
    ) -> Result<Evaluator, EngineError> {
        let mut times = PhaseTimes::default();
        let fixed = FixedSettings::new(options);
        let (fit, seed) = fixed.of(&open.document);
        let surface = EvaluatedSurface::upload(&gpu, linked.into(), fit, seed, &mut times)?;
        let model = &surface.linked().model;
        let memory_bytes = options.model.memory_bytes.saturating_sub(model.file_bytes);
        let budget = options.texture_budget(gpu.summary().kind, surface.linked().memory_bytes());
        let graph = EvaluatedGraph::new(open, graph, kinds, model, memory_bytes);
        let mut evaluator = Evaluator {
            graph,
            surface,
            fixed,
            gpu,
            rays: RaySettings {
                caster: options.caster,
                hits: Hits::Cast,
                most_rays: None,
            },
            ray_cache: RayCache::new(options.model.cache_dir.as_deref()),
            kept_results: None,
            budget,
            times_ghosts: false,
            forgets_kernels: false,
            shows_alone: false,
            times,
            warnings: Vec::new(),
        };
        evaluator.reset_warnings();
        Ok(evaluator)
    }

    /// Replaces the graph, for example after an edit. `graph` is the flattened document of `open`. The model stays loaded.
    /// The tables of the surface are computed again only if the fit or the seed has changed.
    pub fn set_graph(&mut self, open: &OpenGraph, graph: FlatGraph) -> Result<(), EngineError> {
        let (fit, seed) = self.fixed.of(&open.document);
        self.surface.set_fit_and_seed(&self.gpu, fit, seed)?;
        self.graph.set(open, graph);
        self.reset_warnings();
        Ok(())
    }

    /// Replaces the flat graph by another one of the same document, with the same fit and seed.
    pub fn set_flat_graph(&mut self, graph: FlatGraph) {
        self.graph.set_flat(graph);
    }

    /// Replaces the node kinds, for example after node files were read again.
    pub fn set_kinds(&mut self, kinds: Kinds) {
        self.graph.set_kinds(kinds, &self.surface.linked().model);
        self.reset_warnings();
    }

    /// Appends a node of the model's own materials to the graph. Its index is the previous number of nodes.
    pub(crate) fn append_model_source(&mut self) {
        self.graph.append_model_source(self.surface.fit());
    }

    /// Appends nodes to the graph. The index of the first is the previous number of nodes.
    pub(crate) fn append_nodes(&mut self, nodes: Vec<FlatNode>) {
        self.graph.append(nodes);
    }

    /// Flat graph.
    pub fn graph(&self) -> &FlatGraph {
        self.graph.flat()
    }

    /// Model with its atlas.
    pub fn linked(&self) -> &Arc<LinkedModel> {
        self.surface.linked()
    }

    /// Model under the fit.
    pub fn model(&self) -> FittedModel<'_> {
        self.surface.model()
    }

    /// Returns the fit of the document, or the one that overrides it.
    pub fn fit(&self) -> Fit {
        self.surface.fit()
    }

    /// Returns the corners of boxes around some tiles in model space.
    pub(crate) fn bounds_of(&self, tiles: &TileSet) -> Vec<[DVec3; 2]> {
        let scale = self.model().model_from_working();
        let bounds = self.surface.for_sources(&NoProgress).bounds_of(tiles).into_iter();
        bounds.map(|corners| corners.map(|corner| corner * scale)).collect()
    }

    /// Returns a hash of the surface with its fit and seed.
    pub(crate) fn surface_key(&self) -> [u8; 32] {
        self.surface.key()
    }

    /// Device.
    pub fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    /// Finest level of the atlas on the device.
    pub fn surface(&self) -> &GpuSurface {
        self.surface.on_device()
    }

    /// Returns the texels that show the values of others, if charts overlap.
    pub(crate) fn shares(&self) -> Result<Option<&Shares>, EngineError> {
        self.surface.shares(&self.gpu)
    }

    /// Returns the changes of exported maps that shown maps take over.
    pub(crate) fn exported(&self) -> Result<Exported<'_>, EngineError> {
        Ok(Exported {
            shares: self.shares()?,
            borders: Some(self.surface.borders(&self.gpu)?),
            changes_results: false,
        })
    }

    /// Limits runs to the parts of the surface that maps and pictures show, and to the parts on which these depend. If
    /// charts overlap on the maps, only the chart that is exported is evaluated. Results elsewhere are undefined.
    pub fn evaluate_shown_alone(&mut self) {
        self.shows_alone = true;
    }

    /// Returns the tiles whose results are shown if runs are limited to them; `None` if runs evaluate everything.
    pub(crate) fn shown(&self) -> Option<&ShownTiles> {
        self.shows_alone.then(|| self.surface.shown()).flatten()
    }

    /// Makes runs report the time for filling ghosts.
    pub fn time_ghosts(&mut self) {
        self.times_ghosts = true;
    }

    /// Times so far.
    pub fn times(&self) -> PhaseTimes {
        self.times
    }

    /// Returns the warnings for the artist, without repeats.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// Returns the warnings after the first `known` ones.
    pub(crate) fn take_warnings_after(&mut self, known: usize) -> Vec<Warning> {
        self.warnings.split_off(known)
    }

    /// Adds warnings, each once.
    pub(crate) fn warn(&mut self, warnings: impl IntoIterator<Item = impl Into<Warning>>) {
        for warning in warnings.into_iter().map(Into::into) {
            if !self.warnings.contains(&warning) {
                self.warnings.push(warning);
            }
        }
    }

    /// Drops the warnings about the previous graph.
    fn reset_warnings(&mut self) {
        self.warnings = self.surface.linked().warnings();
        let left_out = self.graph.kinds().left_out();
        self.warnings.extend(left_out.map(Warning::from));
    }

    /// Lists the files from which the graph and the model were read. They must not be overwritten.
    pub(crate) fn read_files(&self, open: &OpenGraph) -> Vec<PathBuf> {
        let model = self.linked().model.files.iter().cloned();
        self.graph.read_files(open).into_iter().chain(model).collect()
    }

    /// Returns the data from which the model is uploaded for drawing.
    pub fn view_parts(&self) -> ViewModelParts<'_> {
        let linked = self.linked();
        ViewModelParts {
            model: &linked.model,
            atlas: &linked.atlas,
            surface: self.surface(),
            model_from_working: self.model().model_from_working(),
        }
    }

    /// Adds the shade of the model to its copy on the device.
    pub fn add_shade(&self, view: &ViewModel, cache_dir: Option<&Path>) -> Result<(), EngineError> {
        let shade = self.linked().shade(cache_dir);
        Ok(view.set_shade(&self.gpu, shade.ground, shade.openness)?)
    }

    /// Uploads the model for drawing.
    pub(crate) fn view_model(&self) -> Result<ViewModel, EngineError> {
        Ok(ViewModel::new(&self.gpu, self.view_parts())?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn textures_of_a_processor_driver_count_in_the_memory_of_the_process() {
        let mut model = ModelOptions::new(Path::new("cube.glb"), 64);
        model.memory_bytes = 1000;
        let options = EvaluatorOptions {
            model,
            overrides: Overrides::default(),
            fit: None,
            adapter: AdapterChoice::Auto,
            caster: CasterChoice::Auto,
            budget_bytes: 600,
        };
        for (kind, model_bytes, budget) in [
            (AdapterKind::Cpu, 300, TextureBudget::Textures(600)),
            (AdapterKind::Cpu, 500, TextureBudget::Process(500)),
            (AdapterKind::Cpu, 2000, TextureBudget::Process(0)),
            (AdapterKind::Integrated, 500, TextureBudget::Textures(600)),
            (AdapterKind::Discrete, 2000, TextureBudget::Textures(600)),
        ] {
            assert_eq!(
                options.texture_budget(kind, model_bytes),
                budget,
                "{kind}, {model_bytes}"
            );
        }
    }
}
