//! Bake that a command line requests: of a graph on a model, or of a bake that a report records.

use std::path::{Path, PathBuf};

use sabi_engine::baking::presets::default_preset_folder;
use sabi_engine::baking::recorded::{FinishedBake, RecordedBake, finished_bake};
use sabi_engine::baking::{BakeReport, BakeRequest, bake, bake_graph};
use sabi_engine::{Kinds, OpenGraph};
use sabi_files::{Disk, TrustedPaths};

use crate::arguments::BakeArguments;
use crate::exit::{Exit, Failure};
use crate::graph_argument::GraphArgument;
use crate::progress::ShownProgress;
use crate::terminal::Terminal;

/// Bake that a command line requests.
pub(crate) enum RequestedBake<'a> {
    /// A graph on a model.
    New { graph: &'a GraphArgument, mesh: &'a Path },
    /// A bake that a report records.
    Recorded { report: &'a Path, bake: Box<RecordedBake> },
}

/// Result of a bake.
pub(crate) enum BakeOutcome {
    /// The maps were written.
    Now(Box<BakeReport>),
    /// All maps existed already.
    Before(Box<FinishedBake>),
}

impl<'a> RequestedBake<'a> {
    /// Reads the request of a command line.
    pub(crate) fn of(arguments: &'a BakeArguments) -> Result<RequestedBake<'a>, Failure> {
        match (&arguments.from, &arguments.graph, &arguments.mesh) {
            (Some(report), ..) => Ok(RequestedBake::Recorded {
                report,
                bake: Box::new(RecordedBake::open(report)?),
            }),
            (None, Some(graph), Some(mesh)) => Ok(RequestedBake::New { graph, mesh }),
            (None, ..) => {
                let why = "a bake takes a graph and --mesh, or --from".to_owned();
                Err(Failure::new(Exit::Usage, why))
            }
        }
    }

    /// Returns the name of the graph for messages.
    pub(crate) fn graph(&self) -> PathBuf {
        match self {
            RequestedBake::New { graph, .. } => graph.path().to_owned(),
            RequestedBake::Recorded { bake, .. } => bake.recipe.graph_path(),
        }
    }

    /// Returns the model.
    pub(crate) fn mesh(&self) -> PathBuf {
        match self {
            RequestedBake::New { mesh, .. } => (*mesh).to_owned(),
            RequestedBake::Recorded { bake, .. } => bake.recipe.model_path(),
        }
    }

    /// Returns the number of texels along a side of the maps.
    pub(crate) fn size(&self, arguments: &BakeArguments) -> u32 {
        match self {
            RequestedBake::New { .. } => arguments.maps.size,
            RequestedBake::Recorded { bake, .. } => bake.recipe.size,
        }
    }

    /// Returns the files that the command line names and that are read.
    pub(crate) fn inputs(&self, arguments: &BakeArguments) -> Vec<PathBuf> {
        let report = match self {
            RequestedBake::New { .. } => None,
            RequestedBake::Recorded { report, .. } => Some((*report).to_owned()),
        };
        let set_files = arguments.evaluation.set_files().map(Path::to_owned);
        [self.graph(), self.mesh()]
            .into_iter()
            .chain(report)
            .chain(set_files)
            .collect()
    }

    /// Bakes, unless all maps exist already.
    pub(crate) fn bake(
        &self,
        arguments: &BakeArguments,
        trusted: &TrustedPaths,
        terminal: &Terminal,
    ) -> Result<BakeOutcome, Failure> {
        let request = self.request(arguments, trusted)?;
        let now = |report: BakeReport| BakeOutcome::Now(Box::new(report));
        if let Some((open, kinds)) = self.graph_in_memory(&request.evaluator.trusted_with(&request.graph))? {
            let progress = ShownProgress::new(terminal);
            return Ok(now(bake_graph(&open, &kinds, &request, &progress)?));
        }
        // A bake of a report proves that its maps can be made again, so existing maps are not used.
        let may_be_finished = matches!(self, RequestedBake::New { .. }) && !arguments.again;
        if let Some(finished) = may_be_finished.then(|| finished_bake(&request)).flatten() {
            return Ok(BakeOutcome::Before(Box::new(finished)));
        }
        let progress = ShownProgress::new(terminal);
        Ok(now(bake(&request, &progress)?))
    }

    /// Returns the graph with its kinds if it is not from a file.
    fn graph_in_memory(&self, trusted: &TrustedPaths) -> Result<Option<(OpenGraph, Kinds)>, Failure> {
        match self {
            RequestedBake::New { graph, .. } => graph.piped(trusted),
            RequestedBake::Recorded { bake, .. } => {
                let open = bake.recipe.open_document().transpose()?;
                Ok(open.map(|mut open| {
                    open.trusted = open.trusted.with(trusted);
                    let kinds = Kinds::beside(Some(&open.path), &open.trusted);
                    (open, kinds)
                }))
            }
        }
    }

    fn request(&self, arguments: &BakeArguments, trusted: &TrustedPaths) -> Result<BakeRequest, Failure> {
        let report = arguments.report.clone().filter(|path| path.as_os_str() != "-");
        let evaluation = &arguments.evaluation;
        match self {
            RequestedBake::New { graph, mesh } => Ok(BakeRequest {
                graph: graph.path().to_owned(),
                evaluator: evaluation.options(mesh, trusted, arguments.maps.size)?,
                output: arguments.output.clone(),
                presets: arguments.preset.clone(),
                preset_folder: default_preset_folder(),
                names: arguments.names.clone(),
                channels: arguments.channel.clone(),
                mesh_maps: arguments.mesh_map.clone(),
                material: evaluation.material.clone(),
                all_maps: arguments.all_maps,
                padding: arguments.padding_texels(),
                seams: arguments.seams.into(),
                fuse: !arguments.no_fuse,
                force: arguments.force,
                model: arguments.copy_options(),
                report,
                disk: Disk::default(),
            }),
            RequestedBake::Recorded { bake, .. } => {
                bake.refuse_changed_inputs()?;
                let cache_dir = evaluation.model.cache_dir();
                let recorded = bake
                    .recipe
                    .request(&arguments.output, cache_dir, default_preset_folder());
                let mut request = BakeRequest {
                    force: arguments.force,
                    report,
                    ..recorded
                };
                request.evaluator.budget_bytes = evaluation.budget_bytes();
                request.evaluator.model.memory_bytes = evaluation.model.memory_bytes();
                let of_model = &mut request.evaluator.model.trusted;
                *of_model = std::mem::take(of_model).with(trusted);
                Ok(request)
            }
        }
    }
}
