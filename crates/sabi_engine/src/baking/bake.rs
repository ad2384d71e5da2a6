//! Baking: a graph on a model becomes PBR texture sets.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Duration;

use sabi_export::{BakeWriter, Channel, CommittedBake, EngineMemory, MeshMap, SetOptions};
use sabi_gpu::Run;
use sabi_graph::FlatGraph;
use sabi_plan::{Mode, Plan, Target};

use crate::baking::bake_request::{BakeRequest, set_options};
use crate::baking::documents::{check_documents, write_documents};
use crate::baking::encoded_cache::EncodedCache;
use crate::baking::folder::is_foreign_folder;
use crate::baking::losses::tell_losses;
use crate::baking::made_of::BakeProvenance;
use crate::baking::map_encoder::WrittenMaps;
use crate::baking::maps::{MapWriter, SetPixels};
use crate::baking::mesh_maps::{append_mesh_maps, file_bounds};
use crate::baking::model_copy::{open_copy, write_copy};
use crate::baking::recorded::manifest::{FolderChange, check_own_folder};
use crate::baking::report::{BakeAdapter, BakeReport, BakedMesh, Conventions, REPORT_VERSION};
use crate::baking::seams::ModelSeams;
use crate::baking::set_works::set_works;
use crate::error::{EngineError, ErrorKind};
use crate::evaluating::evaluator::Evaluator;
use crate::evaluating::outputs::{duplicate_map_names, map_outputs, missing_output, outputs};
use crate::evaluating::texture_sets::{
    OutputAssignment, TextureSet, assign_outputs, materials_without_maps, texture_sets,
};
use crate::opening::cache_dir::cache_budget_bytes;
use crate::opening::document::OpenGraph;
use crate::opening::graph_faults::{refuse_faults, targets};
use crate::opening::kinds::Kinds;
use crate::opening::mesh_report::{DecodedUvs, UnwrappingReport, parts_left_out};
use crate::opening::overlap::OverlapTotals;
use crate::phases::{PhaseClock, PhaseTimes, Progress, stop_if_canceled};
use crate::program::Build;
use crate::remedy::Remedy;
use crate::source::map_output;
use crate::warning::Warning;

/// Maximum time of one GPU submission of a bake: long enough for full throughput, short enough for canceling.
const SUBMISSION: Duration = Duration::from_millis(200);

/// Bakes a graph file. No file is replaced before all are complete, and no model is loaded for a graph with a fault.
pub fn bake(request: &BakeRequest, progress: &dyn Progress) -> Result<BakeReport, EngineError> {
    let clock = PhaseClock::start();
    // An unknown preset is reported before anything is read.
    let options = set_options(request)?;
    let (graph, trusted) = (request.graph.clone(), request.evaluator.trusted_with(&request.graph));
    let (open, kinds) = OpenGraph::open_with_kinds(graph, trusted, progress)?;
    bake_open(&open, kinds, options, clock, None, request, progress)
}

/// Bakes a graph in memory, saved or not.
pub fn bake_graph(
    open: &OpenGraph,
    kinds: &Kinds,
    request: &BakeRequest,
    progress: &dyn Progress,
) -> Result<BakeReport, EngineError> {
    let clock = PhaseClock::start();
    let options = set_options(request)?;
    let document = open.unsaved_text();
    bake_open(open, kinds.clone(), options, clock, document, request, progress)
}

/// Checks a request in the same way as a bake before it reads the model.
pub fn check_bake(open: &OpenGraph, kinds: &Kinds, request: &BakeRequest) -> Result<(), EngineError> {
    // An unknown preset is reported before the graph's faults.
    let options = set_options(request)?;
    let checked = CheckedBake::of(open, kinds, options, request)?;
    // Names that are the same for one material are the same for every model, so one material is enough.
    let (options, channels) = (&checked.options, &checked.map_channels);
    Ok(options.refuse_same_names(&[("material", None)], channels, request.evaluator.model.size)?)
}

/// Bakes a graph. `options` are those of the presets. `clock` started when reading of the graph began. `document` is the
/// text of the graph if it differs from its file.
fn bake_open(
    open: &OpenGraph,
    kinds: Kinds,
    options: SetOptions,
    mut clock: PhaseClock,
    document: Option<String>,
    request: &BakeRequest,
    progress: &dyn Progress,
) -> Result<BakeReport, EngineError> {
    let checked = CheckedBake::of(open, &kinds, options, request)?;
    // A folder that cannot be written to is reported before the work.
    let mut writer = open_writer(request, &checked.graph, &checked.options)?;
    let loaded = LoadedBake::open(open, kinds, checked, request, progress)?;
    let LoadedBake {
        mut evaluator,
        outputs,
        map_channels,
        options,
        read,
    } = loaded;
    let provenance = BakeProvenance::of(request, document, &read)?;
    writer.protect(read);
    let linked = evaluator.linked().clone();
    let sets = checked_sets(&evaluator, request, &options, &map_channels, &writer)?;
    let mut assignment = assign_outputs(open, evaluator.graph(), &outputs, &linked.model, &linked.atlas, &sets)?;
    let copy = open_copy(request, &linked, &sets, &mut assignment, &mut writer)?;
    evaluator.warn(std::mem::take(&mut assignment.warnings));
    let mut times = times_of_loading(&evaluator, clock.lap());

    let planned = PlannedBake::of(&mut evaluator, &outputs, &assignment, &options, request)?;
    times.compile.add(clock.lap());
    let evaluate = || evaluator.run_once(&planned.plan, SUBMISSION, progress);
    let (mut run, pixels) = SetPixels::new_while(&linked, sets.first(), request.map_padding(), evaluate)?;
    times.add_evaluation(clock.lap(), run.report.compile);

    let sets = set_works(
        evaluator.graph(),
        &planned.plan,
        sets,
        &assignment.nodes,
        &planned.mesh_targets,
    );
    let is_canceled = || progress.is_canceled();
    let map_writer = MapWriter {
        evaluator: &evaluator,
        plan: &planned.plan,
        options,
        padding: request.map_padding(),
        seams: ModelSeams::new(request.seams, &linked),
        run_options: evaluator.run_options(SUBMISSION, &is_canceled),
    };
    let mut written = map_writer.write(&mut run, &sets, pixels, &mut writer, progress)?;
    stop_if_canceled(progress)?;
    write_copy(copy, &mut writer, &mut written)?;
    write_documents(request, &map_writer.options, &linked, &mut writer, &mut written)?;
    tell_losses(request, &map_writer.options, &writer, &mut written);

    let warnings = evaluator.warnings().iter().chain(&written.warnings).cloned().collect();
    let conventions = Conventions::of(&map_writer.options.presets);
    let report = BakeReport {
        maps_cached: writer.kept().to_vec(),
        warnings,
        ..report(
            request,
            &evaluator,
            &planned.plan,
            &run,
            written,
            provenance,
            conventions,
        )
    };
    // The times in the folder's record end here.
    times.encode.add(clock.lap());
    let report = commit(writer, request, BakeReport { times, ..report }, progress)?;
    times.encode.add(clock.lap());
    Ok(BakeReport { times, ..report })
}

/// A graph without faults, and the maps that it gives, before its model is read.
struct CheckedBake {
    graph: FlatGraph,
    /// Its outputs, ordered by id.
    outputs: Vec<usize>,
    /// Channels of the outputs that become separate maps.
    map_channels: Vec<Channel>,
    options: SetOptions,
}

impl CheckedBake {
    /// Checks a graph for a bake with the options of its presets.
    fn of(
        open: &OpenGraph,
        kinds: &Kinds,
        options: SetOptions,
        request: &BakeRequest,
    ) -> Result<CheckedBake, EngineError> {
        let graph = request.evaluator.flat_graph(open, kinds)?;
        let outputs = checked_outputs(open, &graph, kinds)?;
        let map_channels = map_channels(&graph, &outputs);
        let options = with_outputs(options, request, open, &map_channels)?;
        Ok(CheckedBake {
            graph,
            outputs,
            map_channels,
            options,
        })
    }
}

/// A graph with its model, on a device.
struct LoadedBake {
    evaluator: Evaluator,
    outputs: Vec<usize>,
    map_channels: Vec<Channel>,
    options: SetOptions,
    /// Files that were read.
    read: Vec<PathBuf>,
}

impl LoadedBake {
    fn open(
        open: &OpenGraph,
        kinds: Kinds,
        checked: CheckedBake,
        request: &BakeRequest,
        progress: &dyn Progress,
    ) -> Result<LoadedBake, EngineError> {
        let mut evaluator = Evaluator::open(open, checked.graph, kinds, &request.evaluator, progress)?;
        evaluator.warn(open.unknown_keys());
        let read = evaluator.read_files(open);
        refuse_read_report(request, &read)?;
        let without_maps = materials_without_maps(&evaluator.linked().model, &evaluator.linked().atlas);
        evaluator.warn(without_maps);
        Ok(LoadedBake {
            evaluator,
            outputs: checked.outputs,
            map_channels: checked.map_channels,
            options: checked.options,
            read,
        })
    }
}

/// Results that a bake evaluates.
struct PlannedBake {
    plan: Plan,
    /// Results of the mesh maps.
    mesh_targets: Vec<(MeshMap, Target)>,
}

impl PlannedBake {
    fn of(
        evaluator: &mut Evaluator,
        outputs: &[usize],
        assignment: &OutputAssignment,
        options: &SetOptions,
        request: &BakeRequest,
    ) -> Result<PlannedBake, EngineError> {
        if assignment.model_source.is_some() {
            evaluator.append_model_source();
        }
        let mesh_targets = append_mesh_maps(evaluator, options);
        let wanted = wanted(evaluator.graph(), outputs, assignment, &mesh_targets);
        let plan = plan_with_cache(evaluator, &wanted, request)?;
        Ok(PlannedBake { plan, mesh_targets })
    }
}

/// Returns the times of a bake until everything was read and checked, which took `taken` in total. Everything except the
/// atlas and opening the device counts as loading.
fn times_of_loading(evaluator: &Evaluator, taken: Duration) -> PhaseTimes {
    let PhaseTimes { atlas, compile, .. } = evaluator.times();
    let mut times = PhaseTimes {
        atlas,
        compile,
        ..PhaseTimes::default()
    };
    times.load.add(taken.saturating_sub(times.total()));
    times
}

/// Returns the sets of a bake. Refuses files that cannot be written in their places before anything is evaluated.
fn checked_sets(
    evaluator: &Evaluator,
    request: &BakeRequest,
    options: &SetOptions,
    map_channels: &[Channel],
    writer: &BakeWriter,
) -> Result<Vec<TextureSet>, EngineError> {
    let linked = evaluator.linked();
    let sets = texture_sets(&linked.model, &linked.atlas, request.material.as_deref())?;
    refuse_same_names(map_channels, options, &sets, linked.atlas.size)?;
    check_documents(options, writer)?;
    Ok(sets)
}

/// Opens the writer of the maps, which reuses encoded files from the cache.
fn open_writer(request: &BakeRequest, graph: &FlatGraph, options: &SetOptions) -> Result<BakeWriter, EngineError> {
    refuse_foreign_folder(request, graph, options)?;
    check_own_folder(&request.output)?;
    let budget = cache_budget_bytes()?;
    let mut writer = BakeWriter::create_on(&request.disk, &request.output)?;
    let cache_dir = request.evaluator.model.cache_dir.as_deref();
    if let Some(files) = cache_dir.and_then(|folder| EncodedCache::open(&request.disk, folder, budget)) {
        writer.keep_encoded_files(Box::new(files));
    }
    Ok(writer)
}

/// Plans a bake of the shown results. The evaluator reads results from the cache and stores new ones there.
fn plan_with_cache(evaluator: &mut Evaluator, wanted: &[Target], request: &BakeRequest) -> Result<Plan, EngineError> {
    evaluator.evaluate_shown_alone();
    evaluator.forget_kernels();
    let plan = evaluator.plan(wanted, Mode::Bake { fuse: request.fuse })?;
    let Some(cache_dir) = &request.evaluator.model.cache_dir else {
        return Ok(plan);
    };
    evaluator.keep_results(cache_dir, cache_budget_bytes()?);
    Ok(plan.with_own_slots())
}

/// Renames all files of a bake to their final names, and records the bake in the manifest of the folder.
fn commit(
    writer: BakeWriter,
    request: &BakeRequest,
    report: BakeReport,
    progress: &dyn Progress,
) -> Result<BakeReport, EngineError> {
    let _span = tracing::debug_span!("write", folder = %request.output.display()).entered();
    let folder = FolderChange::begin(&request.disk, &request.output, progress)?;
    let committed = match writer.commit() {
        Ok(committed) => committed,
        Err(error) => {
            folder.abandon();
            return Err(error.into());
        }
    };
    let mut report = BakeReport {
        files: file_names(&committed),
        ..report
    };
    report.warnings.extend(leftover_warnings(&committed));
    folder.record(&mut report)?;
    Ok(report)
}

fn file_names(committed: &CommittedBake) -> Vec<String> {
    let names = committed.files.iter().filter_map(|file| file.file_name());
    names.map(|name| name.to_string_lossy().into_owned()).collect()
}

/// Returns a warning for each file that an earlier bake left.
fn leftover_warnings(committed: &CommittedBake) -> impl Iterator<Item = Warning> {
    let paths = committed.left_over.iter().map(|path| path.display());
    paths.map(|path| format!("{path} is from an earlier bake; its channel is constant now").into())
}

/// Returns the graph's outputs, ordered by id. Refuses a graph without outputs, or with a fault that they depend on.
fn checked_outputs(open: &OpenGraph, graph: &FlatGraph, kinds: &Kinds) -> Result<Vec<usize>, EngineError> {
    let found = outputs(graph);
    let mut messages: Vec<String> = missing_output(graph)
        .into_iter()
        .chain(duplicate_map_names(graph))
        .collect();
    for message in &mut messages {
        *message = open.with_path(&message);
    }
    if let Err(faults) = refuse_faults(open, graph, kinds, &targets(found.iter().copied())) {
        if messages.is_empty() {
            return Err(faults);
        }
        messages.extend(faults.messages);
    }
    if messages.is_empty() {
        return Ok(found);
    }
    Err(EngineError::several(ErrorKind::BadInput, messages))
}

/// Returns true if a bake needs `force`, because its folder has files but no earlier maps.
pub fn needs_force(open: &OpenGraph, request: &BakeRequest) -> bool {
    let graph = open.flatten(&request.evaluator.overrides);
    // Other errors are reported by the bake itself.
    graph.is_ok_and(|graph| {
        set_options(request)
            .and_then(|options| refuse_foreign_folder(request, &graph, &options))
            .is_err_and(|error| error.remedies.contains(&Remedy::IntoThisFolderAnyway))
    })
}

/// Refuses a folder with foreign files, so that maps are not written there because of a mistyped path.
fn refuse_foreign_folder(request: &BakeRequest, graph: &FlatGraph, options: &SetOptions) -> Result<(), EngineError> {
    let (folder, report) = (&request.output, request.report.as_deref());
    if request.force || !is_foreign_folder(folder, graph, options, report)? {
        return Ok(());
    }
    let why = format!("the folder {} has files but no earlier maps", folder.display());
    let refused = EngineError::new(ErrorKind::CannotWrite, why);
    Err(refused.with_remedies([Remedy::OtherFolder, Remedy::IntoThisFolderAnyway]))
}

/// Refuses names of files that are not unique, before anything is evaluated.
fn refuse_same_names(
    outputs: &[Channel],
    options: &SetOptions,
    sets: &[TextureSet],
    size: u32,
) -> Result<(), EngineError> {
    let sets: Vec<(&str, Option<u32>)> = sets.iter().map(|set| (set.name.as_str(), set.key.udim)).collect();
    Ok(options.refuse_same_names(&sets, outputs, size)?)
}

/// Returns the channels of the outputs that become separate maps.
fn map_channels(graph: &FlatGraph, outputs: &[usize]) -> Vec<Channel> {
    let found = map_outputs(graph, outputs).into_iter();
    found.map(|(_, channel)| channel).collect()
}

/// Returns the options for writing the sets of a graph with these outputs.
fn with_outputs(
    mut options: SetOptions,
    request: &BakeRequest,
    open: &OpenGraph,
    outputs: &[Channel],
) -> Result<SetOptions, EngineError> {
    // The seed that nodes get.
    options.dither_seed = request.evaluator.overrides.seed.unwrap_or(open.document.seed);
    let set = options.set_outputs(outputs);
    set.map_err(|error| EngineError::of(ErrorKind::BadInput, error))?;
    Ok(options)
}

/// Lists the targets of a bake: outputs that serve a set, and those that become separate maps.
fn wanted(
    graph: &FlatGraph,
    outputs: &[usize],
    assignment: &OutputAssignment,
    mesh_targets: &[(MeshMap, Target)],
) -> Vec<Target> {
    let is_served = |node: usize| {
        assignment
            .nodes
            .iter()
            .any(|nodes| nodes.values().any(|of| *of == node))
    };
    let is_used = |node: &usize| map_output(&graph.nodes[*node]).is_some() || is_served(*node);
    let mut wanted = targets(outputs.iter().copied().filter(is_used).chain(assignment.model_source));
    wanted.extend(mesh_targets.iter().map(|(_, target)| target.clone()));
    wanted
}

/// Refuses a report that would replace a file which the bake reads.
fn refuse_read_report(request: &BakeRequest, read: &[PathBuf]) -> Result<(), EngineError> {
    let Some((path, real)) = request
        .report
        .as_ref()
        .and_then(|path| Some((path, path.canonicalize().ok()?)))
    else {
        return Ok(());
    };
    if read
        .iter()
        .all(|input| input.canonicalize().ok().as_ref() != Some(&real))
    {
        return Ok(());
    }
    let why = "this very bake reads it; name another file";
    let why = format!("cannot write the report {}: {why}", path.display());
    Err(EngineError::new(ErrorKind::CannotWrite, why))
}

/// Returns the report without the parts that are known only after the maps are in place: times, files and warnings.
fn report(
    request: &BakeRequest,
    evaluator: &Evaluator,
    plan: &Plan,
    run: &Run,
    written: WrittenMaps,
    provenance: BakeProvenance,
    conventions: Conventions,
) -> BakeReport {
    let adapter = evaluator.gpu().summary();
    let linked = evaluator.linked();
    let atlas = &linked.atlas;
    let unwrapped = linked.unwrapped.as_ref();
    BakeReport {
        version: REPORT_VERSION,
        sabi: env!("CARGO_PKG_VERSION"),
        build: Build::current().clone(),
        recipe: provenance.recipe,
        inputs: provenance.inputs,
        conventions,
        graph: request.graph.display().to_string(),
        mesh: BakedMesh {
            file: request.evaluator.model.path.display().to_string(),
            triangles: linked.model.mesh.triangles.len(),
            charts: atlas.uv_charts().len(),
            coverage: rounded(atlas.report.coverage),
            bounds: file_bounds(evaluator),
            overlap: OverlapTotals::of(linked).report(linked),
            unwrapped: unwrapped.map(|unwrapping| UnwrappingReport::of(unwrapping, atlas.size)),
            decoded_uvs: DecodedUvs::of(linked),
            smooth_degrees: linked.smooth_degrees,
            parts_left_out: parts_left_out(&linked.model),
            turned_faces: linked.model.turned_faces,
        },
        adapter: BakeAdapter {
            name: adapter.name.clone(),
            kind: adapter.kind.to_string(),
        },
        size: atlas.size,
        nodes: plan.nodes.len(),
        passes: plan.passes(),
        finish_passes: written.finish_passes,
        fused: plan.fused(),
        evaluated_texels: run.report.texels,
        peak_texture_bytes: run.report.pool.peak_bytes,
        up_to_date: false,
        atlas_cached: linked.atlas_was_cached,
        rays_cached: run.report.found_on_disk.clone(),
        results_cached: run.report.kept_results.clone(),
        maps_cached: Vec::new(),
        unwrapping_cached: unwrapped.map(|unwrapping| unwrapping.was_cached),
        times: PhaseTimes::default(),
        nodes_ms: nodes_ms(run),
        engine: EngineMemory::of(&written.outputs),
        outputs: written.outputs,
        constants: written.constants,
        documents: written.documents,
        left_out: written.left_out,
        warnings: Vec::new(),
        model: written.copy,
        files: Vec::new(),
    }
}

/// Returns milliseconds by node, rounded to hundredths. The time of a fused kernel is divided by estimated cost, since it
/// cannot be measured for each node.
fn nodes_ms(run: &Run) -> BTreeMap<String, f64> {
    let mut nodes_ms = BTreeMap::new();
    for step in &run.report.steps {
        for (node, share) in &step.nodes {
            let ms = step.run.as_secs_f64() * 1000.0 * f64::from(*share);
            *nodes_ms.entry(node.clone()).or_insert(0.0) += ms;
        }
    }
    for ms in nodes_ms.values_mut() {
        *ms = (*ms * 100.0).round() / 100.0;
    }
    nodes_ms
}

fn rounded(value: f32) -> f64 {
    (f64::from(value) * 10_000.0).round() / 10_000.0
}
