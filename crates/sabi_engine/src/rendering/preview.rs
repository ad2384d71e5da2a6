//! Preview of a node's result in texture space, as a picture or as exact values.

use std::path::PathBuf;
use std::time::Duration;

use sabi_graph::PortType;
use sabi_image::{ExrSamples, PngData, PngOptions, encode_exr, encode_png, quantize_u8};
use sabi_plan::Mode;

use crate::error::{EngineError, ErrorKind};
use crate::evaluating::evaluator::{Evaluator, EvaluatorOptions};
use crate::evaluating::texture_sets::{shown_set_warning, texture_sets};
use crate::evaluating::texture_space::{ResultPlane, TextureSpace, rgb_codes};
use crate::opening::document::OpenGraph;
use crate::opening::graph_faults::refuse_faults;
use crate::opening::kinds::Kinds;
use crate::phases::{Progress, stop_if_canceled};
use crate::rendering::node_argument::graph_and_target;
use crate::rendering::picture_file::PictureFiles;
use crate::warning::Warning;

/// Request for a preview.
pub struct PreviewRequest {
    /// Graph file.
    pub graph: PathBuf,
    /// Model, overrides, fit and adapter.
    pub evaluator: EvaluatorOptions,
    /// Node id, or `id.port`.
    pub node: String,
    /// Output file: `.png` for a picture, `.exr` for exact values.
    pub output: PathBuf,
    /// Material whose texture set is shown; `None` for the first one.
    pub material: Option<String>,
}

/// Writes a preview of a graph file and returns warnings.
pub fn preview(request: &PreviewRequest, progress: &dyn Progress) -> Result<Vec<Warning>, EngineError> {
    // An output name with an unsupported extension is reported before anything is read.
    is_exact(request)?;
    let trusted = request.evaluator.trusted_with(&request.graph);
    let (open, kinds) = OpenGraph::open_with_kinds(request.graph.clone(), trusted, progress)?;
    preview_graph(&open, kinds, request, progress)
}

/// Writes a preview of a graph in memory and returns warnings.
pub fn preview_graph(
    open: &OpenGraph,
    kinds: Kinds,
    request: &PreviewRequest,
    progress: &dyn Progress,
) -> Result<Vec<Warning>, EngineError> {
    let is_exact = is_exact(request)?;
    let (graph, target) = graph_and_target(open, &kinds, &request.evaluator, &request.node)?;
    let nothing = || {
        let why = format!(
            "node '{}' is muted and passes nothing on, so it has no result; unmute it",
            request.node
        );
        EngineError::new(ErrorKind::BadInput, open.with_path(why))
    };
    let rehearsed = refuse_faults(open, &graph, &kinds, std::slice::from_ref(&target))?;
    rehearsed.results.first().ok_or_else(nothing)?;
    let mut evaluator = Evaluator::open(open, graph, kinds, &request.evaluator, progress)?;
    let linked = evaluator.linked().clone();
    let (model, atlas) = (&linked.model, &linked.atlas);
    let sets = texture_sets(model, atlas, request.material.as_deref())?;
    evaluator.warn(shown_set_warning(&sets));
    let key = sets[0].key;
    evaluator.evaluate_shown_alone();
    let plan = evaluator.plan(&[target], Mode::Bake { fuse: true })?;
    let run = evaluator.run(&plan, Duration::from_millis(200), progress, None)?;
    let result = plan.results.first().ok_or_else(nothing)?;
    let texture_space = TextureSpace::new(&linked, key);
    let planes = texture_space.planes(&evaluator, &plan, &run, result)?;
    let size = texture_space.layout.size;
    let bytes = if is_exact {
        exact(size, &planes)
    } else {
        picture(size, result.stored.ty, &planes[0])
    }?;
    stop_if_canceled(progress)?;
    let output = std::slice::from_ref(&request.output);
    let mut file = PictureFiles::begin(output, evaluator.read_files(open))?;
    file.add(bytes)?;
    file.commit()?;
    Ok(evaluator.warnings().to_vec())
}

/// Returns true if exact values are written.
fn is_exact(request: &PreviewRequest) -> Result<bool, EngineError> {
    let output = &request.output;
    match output.extension().and_then(|ending| ending.to_str()) {
        Some("png") => Ok(false),
        Some("exr") => Ok(true),
        _ => {
            let why = format!(
                "{}: a preview is a .png or, for exact values, an .exr",
                output.display()
            );
            Err(EngineError::new(ErrorKind::Usage, why))
        }
    }
}

fn exact(size: u32, planes: &[ResultPlane]) -> Result<Vec<u8>, EngineError> {
    let mut channels: Vec<(String, Vec<f32>)> = Vec::new();
    for ResultPlane {
        name,
        components,
        values,
        ..
    } in planes
    {
        let names: &[&str] = if *components == 1 {
            &["Y"]
        } else {
            &["R", "G", "B", "A"]
        };
        let prefix = if name.is_empty() {
            String::new()
        } else {
            format!("{name}.")
        };
        for (at, component) in names.iter().enumerate().take(*components) {
            let values = values.iter().skip(at).step_by(*components).copied().collect();
            channels.push((format!("{prefix}{component}"), values));
        }
    }
    let channels: Vec<(&str, &[f32])> = channels
        .iter()
        .map(|(name, values)| (name.as_str(), values.as_slice()))
        .collect();
    Ok(encode_exr(size, size, &channels, ExrSamples::Float)?)
}

/// Encodes a PNG: masks as gray, colors in sRGB, vectors with −1..1 mapped to 0..1.
pub(super) fn picture(size: u32, ty: PortType, plane: &ResultPlane) -> Result<Vec<u8>, EngineError> {
    let rgb = plane
        .values
        .chunks_exact(plane.components)
        .flat_map(|values| rgb_codes(ty, values));
    let (codes, channels): (Vec<u8>, u8) = match ty {
        PortType::Mask => (plane.values.iter().map(|value| quantize_u8(*value)).collect(), 1),
        _ => (rgb.collect(), 3),
    };
    let options = PngOptions {
        channels,
        bits: 8,
        srgb_chunk: matches!(ty, PortType::Color | PortType::Material),
    };
    Ok(encode_png(size, size, PngData::U8(&codes), options)?)
}
