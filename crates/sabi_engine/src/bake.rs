//! The main job: a graph on a model becomes a PBR set.

use std::path::{Path, PathBuf};
use std::time::Duration;

use sabi_export::{BakeWriter, Padding, SetKey, SetOptions, preset, set_keys, set_names};
use sabi_gpu::{Run, RunOptions};
use sabi_plan::{Mode, Plan, PlannedResult, Target};
use serde_json::{Map, Value as Json, json};

use crate::document::OpenGraph;
use crate::error::{EngineError, ErrorKind};
use crate::kinds::Kinds;
use crate::maps::{MapWriter, SetWork, WrittenMaps};
use crate::report::{BakeReport, StageTimes};
use crate::source::{OUTPUT_MASK, OUTPUT_MATERIAL, mask_name, serves};
use crate::stages::Progress;
use crate::workpiece::{Workpiece, WorkpieceOptions, stop_if_canceled};

/// How long one submission of a bake may take: long enough to cost nothing, short enough to be stopped.
const SUBMISSION: Duration = Duration::from_millis(200);

/// What to bake.
pub struct BakeRequest {
    /// The graph file.
    pub graph: PathBuf,
    /// Model, overrides, fit, adapter.
    pub workpiece: WorkpieceOptions,
    /// Folder for the maps.
    pub output: PathBuf,
    /// Presets by name.
    pub presets: Vec<String>,
    /// Only the set of this material.
    pub material: Option<String>,
    /// Whether channels that are the same all over get maps too.
    pub all_maps: bool,
    /// How far maps reach out of the charts, texels; none for everywhere.
    pub padding: Option<u32>,
    /// Whether point nodes are fused.
    pub fuse: bool,
}

/// Bakes; nothing is replaced before everything is complete.
pub fn bake(request: &BakeRequest, progress: &dyn Progress) -> Result<BakeReport, EngineError> {
    let options = set_options(request)?;
    let open = OpenGraph::open(&request.graph)?;
    // A folder that cannot be written to is found before the work, not after it.
    let mut writer = BakeWriter::create(&request.output)?;
    let kinds = Kinds::beside(Some(&request.graph));
    let mut workpiece = Workpiece::open(&open, kinds, &request.workpiece, progress)?;
    let outputs = outputs(&workpiece, &request.graph)?;
    let mut limits = workpiece.gpu.limits();
    limits.storage_textures = limits.storage_textures.max(1);
    let plan = workpiece.plan(&outputs, Mode::Bake { fuse: request.fuse }, limits)?;
    let mut run = workpiece.run(&plan, SUBMISSION, progress, None)?;
    let sets = texture_sets(&workpiece, &plan, request)?;
    let mut encode = workpiece.times.encode;
    let map_writer = MapWriter {
        workpiece: &workpiece,
        plan: &plan,
        options,
        padding: request.padding.map_or(Padding::Infinite, Padding::Texels),
        run_options: RunOptions {
            submission: SUBMISSION,
            is_canceled: &|| progress.is_canceled(),
            progress: &|_, _| {},
            budget_bytes: request.workpiece.budget_bytes,
        },
    };
    let written = encode.time(|| map_writer.write(&mut run, &sets, &mut writer, progress))?;
    stop_if_canceled(progress)?;
    let committed = encode.time(|| writer.commit())?;
    let mut warnings = workpiece.warnings.clone();
    warnings.extend(written.warnings.iter().cloned());
    for left_over in &committed.left_over {
        warnings.push(format!(
            "{} is from an earlier bake; its channel is constant now",
            left_over.display()
        ));
    }
    let times = StageTimes {
        encode,
        ..workpiece.times
    };
    let json = report(request, &workpiece, &plan, &run, &written, &times, &warnings);
    let files = committed
        .files
        .iter()
        .filter_map(|file| Some(file.file_name()?.to_string_lossy().into_owned()));
    Ok(BakeReport {
        times,
        files: files.collect(),
        warnings,
        json,
    })
}

fn set_options(request: &BakeRequest) -> Result<SetOptions, EngineError> {
    for name in &request.presets {
        if name != "raw" {
            let why = format!("there is no preset '{name}'; there is: raw");
            return Err(EngineError::new(ErrorKind::Usage, why));
        }
    }
    Ok(SetOptions {
        preset: preset::raw(),
        all_maps: request.all_maps,
    })
}

/// The graph's outputs, in the order in which they serve.
fn outputs(workpiece: &Workpiece, path: &Path) -> Result<Vec<Target>, EngineError> {
    let is_output = |kind: &str| kind == OUTPUT_MATERIAL || kind == OUTPUT_MASK;
    let nodes = workpiece.graph.nodes.iter().enumerate();
    let mut found: Vec<(usize, &str)> = nodes
        .filter(|(_, node)| is_output(&node.kind) && !node.muted)
        .map(|(index, node)| (index, node.id.as_str()))
        .collect();
    found.sort_by_key(|(_, id)| *id);
    if found.is_empty() {
        let why = format!(
            "{}: the graph has no output; add a node of kind '{OUTPUT_MATERIAL}' and connect its material",
            path.display()
        );
        return Err(EngineError::new(ErrorKind::BadInput, why));
    }
    Ok(found.into_iter().map(|(node, _)| Target { node, port: None }).collect())
}

fn texture_sets<'p>(
    workpiece: &Workpiece,
    plan: &'p Plan,
    request: &BakeRequest,
) -> Result<Vec<SetWork<'p>>, EngineError> {
    let model = &workpiece.prepared.model;
    let names = set_names(model);
    let kind = |result: &PlannedResult| workpiece.graph.nodes[result.target.node].kind.as_str();
    let keys: Vec<SetKey> = set_keys(&workpiece.prepared.atlas)
        .into_iter()
        .filter(|key| match &request.material {
            Some(wanted) => {
                let index = key.material as usize;
                names.get(index) == Some(wanted) || model.materials.get(index).is_some_and(|m| m.name == *wanted)
            }
            None => true,
        })
        .collect();
    if keys.is_empty() {
        let wanted = request.material.clone().unwrap_or_default();
        let why = format!("the model has no material '{wanted}'; it has {}", names.join(", "));
        return Err(EngineError::new(ErrorKind::Usage, why));
    }
    let set = |key: SetKey| {
        let index = key.material as usize;
        let own_name = model.materials.get(index).map_or("", |material| material.name.as_str());
        let name = names.get(index).cloned().unwrap_or_else(|| model.stem.clone());
        let serves = |result: &&PlannedResult| {
            let node = &workpiece.graph.nodes[result.target.node];
            kind(result) == OUTPUT_MATERIAL && (serves(node, own_name) || serves(node, &name))
        };
        let masks = plan.results.iter().filter(|result| kind(result) == OUTPUT_MASK);
        SetWork {
            material: plan.results.iter().find(serves),
            masks: masks
                .map(|result| (mask_name(&workpiece.graph.nodes[result.target.node]), result))
                .collect(),
            key,
            name,
        }
    };
    Ok(keys.into_iter().map(set).collect())
}

fn report(
    request: &BakeRequest,
    workpiece: &Workpiece,
    plan: &Plan,
    run: &Run,
    written: &WrittenMaps,
    times: &StageTimes,
    warnings: &[String],
) -> Json {
    let adapter = workpiece.gpu.summary();
    let atlas = &workpiece.prepared.atlas;
    let mut nodes_ms = Map::new();
    for step in &run.report.steps {
        for (node, share) in &step.nodes {
            // A fused kernel's time is shared out by cost: it cannot be measured node by node.
            let ms = step.run.as_secs_f64() * 1000.0 * f64::from(*share);
            let before = nodes_ms.get(node).and_then(Json::as_f64).unwrap_or(0.0);
            nodes_ms.insert(node.clone(), json!(((before + ms) * 100.0).round() / 100.0));
        }
    }
    json!({
        "sabi": env!("CARGO_PKG_VERSION"),
        "graph": request.graph.display().to_string(),
        "mesh": {
            "file": request.workpiece.model.path.display().to_string(),
            "triangles": workpiece.prepared.model.mesh.triangles.len(),
            "charts": atlas.charts.len(),
            "coverage": rounded(atlas.report.coverage),
            "overlap": atlas.report.overlap_texels,
        },
        "adapter": { "name": adapter.name, "kind": adapter.kind.to_string() },
        "size": atlas.size,
        "nodes": plan.nodes.len(),
        "passes": plan.passes(),
        "finish_passes": written.finish_passes,
        "fused": plan.fused(),
        "peak_texture_bytes": run.report.pool.peak_bytes + workpiece.surface.texture_bytes(),
        "atlas_cached": workpiece.prepared.atlas_was_cached,
        "stages_ms": times.json(),
        "nodes_ms": nodes_ms,
        "outputs": written.outputs.iter().map(sabi_export::OutputRecord::to_json).collect::<Vec<_>>(),
        "constants": written.constants.iter().map(sabi_export::ConstantRecord::to_json).collect::<Vec<_>>(),
        "warnings": warnings,
    })
}

fn rounded(value: f32) -> f64 {
    (f64::from(value) * 10_000.0).round() / 10_000.0
}
