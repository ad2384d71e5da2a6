//! Any node's result in texture space, as a picture or as exact numbers.

use std::path::PathBuf;
use std::time::Duration;

use sabi_export::{Channel, Padding, PaddingMap, SetLayout};
use sabi_graph::PortType;
use sabi_image::{PngData, PngOptions, encode_exr, encode_png, quantize_u8, srgb8_from_linear};
use sabi_nodes::kind::Channel as Stored;
use sabi_nodes::link::Plane;
use sabi_plan::{Mode, PlannedResult};

use crate::document::OpenGraph;
use crate::error::{EngineError, ErrorKind};
use crate::kinds::Kinds;
use crate::maps::set_layout;
use crate::modelless::refuse_faults;
use crate::picture_file::PictureFiles;
use crate::seen_node::graph_and_target;
use crate::sets::{texture_sets, which_is_shown};
use crate::stages::Progress;
use crate::workpiece::{Workpiece, WorkpieceOptions, stop_if_canceled};

/// What to look at.
pub struct PreviewRequest {
    /// The graph file.
    pub graph: PathBuf,
    /// Model, overrides, fit, adapter.
    pub workpiece: WorkpieceOptions,
    /// Node id, or `id.port`.
    pub node: String,
    /// `.png` for a picture, `.exr` for the exact values.
    pub output: PathBuf,
    /// The material whose layout is shown; the first one if none.
    pub material: Option<String>,
}

/// Writes one node's result.
pub fn preview(request: &PreviewRequest, progress: &dyn Progress) -> Result<Vec<String>, EngineError> {
    let is_exact = match request.output.extension().and_then(|ending| ending.to_str()) {
        Some("png") => false,
        Some("exr") => true,
        _ => {
            let why = format!(
                "{}: a preview is a .png or, for exact values, an .exr",
                request.output.display()
            );
            return Err(EngineError::new(ErrorKind::Usage, why));
        }
    };
    let open = OpenGraph::open(&request.graph)?;
    let kinds = Kinds::beside(Some(&request.graph));
    let (graph, target) = graph_and_target(&open, &kinds, &request.workpiece, &request.node)?;
    let nothing = || {
        let why = format!(
            "node '{}' is muted and passes nothing on, so there is nothing to see; unmute it",
            request.node
        );
        EngineError::new(ErrorKind::BadInput, open.said(why))
    };
    let rehearsed = refuse_faults(&open, &graph, &kinds, std::slice::from_ref(&target))?;
    rehearsed.results.first().ok_or_else(nothing)?;
    let mut workpiece = Workpiece::open(&open, graph, kinds, &request.workpiece, progress)?;
    let (model, atlas) = (&workpiece.prepared.model, &workpiece.prepared.atlas);
    let sets = texture_sets(model, atlas, request.material.as_deref())?;
    workpiece.warn(which_is_shown(&sets));
    let key = sets[0].key;
    let plan = workpiece.plan(&[target], Mode::Bake { fuse: true }, workpiece.gpu.limits())?;
    let run = workpiece.run(&plan, Duration::from_millis(200), progress, None)?;
    let result = plan.results.first().ok_or_else(nothing)?;
    let layout = set_layout(&workpiece.prepared, key);
    let padding = PaddingMap::new(&layout, Padding::Texels(4));
    let shown = shown_planes(result).into_iter().zip(&result.slots);
    let planes = shown.map(|((name, components), &slot)| {
        let data = workpiece.gpu.read(&workpiece.surface, &plan, &run, slot)?;
        let one = |first| {
            padding
                .gather(&layout, &Channel::Mask(String::new()), first, |index| data.texel(index))
                .data
        };
        let parts: Vec<Vec<f32>> = (0..components).map(one).collect();
        let pixels = (0..padding.source.len()).flat_map(|pixel| parts.iter().map(move |part| part[pixel]));
        Ok((name, pixels.collect()))
    });
    let planes: Vec<(&str, Vec<f32>)> = planes.collect::<Result<_, EngineError>>()?;
    let bytes = if is_exact {
        exact(&layout, &planes)
    } else {
        picture(&layout, result.stored.ty, &planes[0].1)
    }?;
    stop_if_canceled(progress)?;
    let output = std::slice::from_ref(&request.output);
    let mut file = PictureFiles::begin(output, workpiece.read_files(&open))?;
    file.add(bytes)?;
    file.commit()?;
    Ok(workpiece.warnings)
}

/// Planes to show, one a slot: name in an EXR, values a texel. A material shows its base color, and in an EXR all of it.
fn shown_planes(result: &PlannedResult) -> Vec<(&'static str, usize)> {
    result
        .stored
        .planes()
        .into_iter()
        .map(|plane| match plane {
            Plane::Mask => ("", 1),
            Plane::Color | Plane::Vector => ("", 3),
            Plane::Material(Stored::Color) => ("", 4),
            Plane::Material(Stored::Surface) => ("surface.", 3),
            Plane::Material(Stored::Height) => ("height.", 1),
            Plane::Material(Stored::Slope) => ("slope.", 3),
            Plane::Material(Stored::Emission) => ("emission.", 3),
        })
        .collect()
}

fn exact(layout: &SetLayout, planes: &[(&str, Vec<f32>)]) -> Result<Vec<u8>, EngineError> {
    let pixels = layout.source.len();
    let mut channels: Vec<(String, Vec<f32>)> = Vec::new();
    for (prefix, data) in planes {
        let components = data.len() / pixels.max(1);
        let names: &[&str] = if components == 1 { &["Y"] } else { &["R", "G", "B", "A"] };
        for (at, name) in names.iter().enumerate().take(components) {
            let values = data.iter().skip(at).step_by(components).copied().collect();
            channels.push((format!("{prefix}{name}"), values));
        }
    }
    let channels: Vec<(&str, &[f32])> = channels
        .iter()
        .map(|(name, values)| (name.as_str(), values.as_slice()))
        .collect();
    encode_exr(layout.size, layout.size, &channels).map_err(|error| EngineError::new(ErrorKind::CannotWrite, error))
}

/// Masks as gray, colors in sRGB, vectors with −1..1 brought to 0..1.
fn picture(layout: &SetLayout, ty: PortType, data: &[f32]) -> Result<Vec<u8>, EngineError> {
    let (codes, channels, srgb_chunk): (Vec<u8>, u8, bool) = match ty {
        PortType::Mask => (data.iter().map(|value| quantize_u8(*value)).collect(), 1, false),
        PortType::Color => (data.iter().map(|value| srgb8_from_linear(*value)).collect(), 3, true),
        PortType::Vector => (
            data.iter().map(|value| quantize_u8(value * 0.5 + 0.5)).collect(),
            3,
            false,
        ),
        PortType::Material => {
            let rgb = data
                .chunks_exact(4)
                .flat_map(|pixel| pixel[..3].iter().map(|value| srgb8_from_linear(*value)));
            (rgb.collect(), 3, true)
        }
    };
    let options = PngOptions {
        channels,
        bits: 8,
        srgb_chunk,
    };
    encode_png(layout.size, layout.size, PngData::U8(&codes), options)
        .map_err(|error| EngineError::new(ErrorKind::CannotWrite, error))
}
