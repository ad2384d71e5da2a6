//! Lit pictures of a model with the looks of a graph, or the frames of a turntable.

use std::path::PathBuf;

use glam::UVec2;
use sabi_image::{ExrSamples, PngData, PngOptions, encode_exr, encode_png};
use sabi_surface::model::Mesh;
use sabi_view::{
    Background, Camera, Lens, Light, Lines, Mode, Pixels, Placement, RenderTarget as Canvas, Renderer, Scene, Shot,
    ViewModel, ViewTransform, Viewpoint, aspect_of,
};

use crate::error::{EngineError, ErrorKind};
use crate::evaluating::evaluator::{Evaluator, EvaluatorOptions};
use crate::evaluating::looks::{ModelLooks, evaluate_looks};
use crate::evaluating::outputs::outputs;
use crate::opening::document::OpenGraph;
use crate::opening::environment::{environment_of, read_panorama};
use crate::opening::graph_faults::{refuse_faults, targets};
use crate::opening::kinds::Kinds;
use crate::opening::linked_model::LinkedModel;
use crate::phases::{Phase, Progress, stop_if_canceled};
use crate::rendering::density::{chosen_size, softness, texels_for_pixels};
use crate::rendering::displace::{TriangleLimit, displaced_model};
use crate::rendering::node_argument::graph_and_target;
use crate::rendering::picture_file::PictureFiles;
use crate::warning::Warning;

/// Name of the lit view.
const LIT: &str = "material";
/// Maximum frames of a turntable.
const MOST_FRAMES: u32 = 9999;

/// Request for a rendering.
pub struct RenderRequest {
    /// Graph file.
    pub graph: PathBuf,
    /// Model, overrides, fit and adapter. The size of its maps is used only if `has_given_size` is true.
    pub evaluator: EvaluatorOptions,
    /// True if the maps have the size of the evaluator's options; otherwise one that fits the picture is chosen.
    pub has_given_size: bool,
    /// Output file: `.png` for display colors, `.exr` for linear light. Frames of a turntable get its stem and a number.
    pub output: PathBuf,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Name of a built-in environment, or a file.
    pub environment: String,
    /// Rotation of the environment about +Y, degrees.
    pub rotate: f32,
    /// Factor of the environment's light.
    pub environment_strength: f32,
    /// Viewpoint of the camera.
    pub camera: Viewpoint,
    /// Point at which the camera looks instead of the middle of what it sees, relative to the middle of the model's box, in
    /// shares of its largest side.
    pub target: Option<[f32; 3]>,
    /// True if the projection is orthographic.
    pub is_orthographic: bool,
    /// View to show: its name, or `node:ID`.
    pub view: String,
    /// Background behind the model.
    pub background: Background,
    /// Transform from linear light to display colors.
    pub transform: ViewTransform,
    /// Exposure, stops.
    pub exposure: f32,
    /// Share of the light above white that is spread around it, 0 to 1. Not used for an `.exr`.
    pub bloom: f32,
    /// True if the ground below the model shows its shade.
    pub has_ground: bool,
    /// Lights besides the environment.
    pub lights: Vec<Light>,
    /// Lines drawn over the model.
    pub lines: Vec<Lines>,
    /// True if heights are ray-marched, with occlusion and shadows.
    pub has_relief: bool,
    /// Triangle limit of a displaced copy that is drawn instead of the model. In this case heights are not ray-marched.
    pub displace: Option<TriangleLimit>,
    /// Samples per pixel.
    pub samples: u32,
    /// Number of frames of a turntable; `None` for one picture.
    pub turntable: Option<u32>,
    /// Part of the scene that rotates on the turntable.
    pub turns: Turns,
}

/// Part of the scene that rotates on a turntable.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Turns {
    /// The camera, around the model.
    #[default]
    Camera,
    /// The environment and all lights, around a fixed camera.
    Light,
}

/// Result of a rendering.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RenderOutput {
    /// Files that were written.
    pub files: Vec<PathBuf>,
    /// Warnings about probable mistakes.
    pub warnings: Vec<Warning>,
}

/// Renders pictures of a graph file. No file is replaced before all are complete.
pub fn render(request: &RenderRequest, progress: &dyn Progress) -> Result<RenderOutput, EngineError> {
    // Unsupported file names and unknown views are reported before anything is read.
    file_names(request)?;
    view_of(&request.view)?;
    let trusted = request.evaluator.trusted_with(&request.graph);
    let (open, kinds) = OpenGraph::open_with_kinds(request.graph.clone(), trusted, progress)?;
    render_graph(&open, kinds, request, progress)
}

/// Renders pictures of a graph in memory.
pub fn render_graph(
    open: &OpenGraph,
    kinds: Kinds,
    request: &RenderRequest,
    progress: &dyn Progress,
) -> Result<RenderOutput, EngineError> {
    let paths = file_names(request)?;
    let (mode, node) = view_of(&request.view)?;
    let (graph, seen) = match node {
        Some(node) => {
            let (graph, target) = graph_and_target(open, &kinds, &request.evaluator, node)?;
            (graph, Some(target))
        }
        None => (request.evaluator.flat_graph(open, &kinds)?, None),
    };
    let of_outputs = || targets(outputs(&graph));
    let faulty = seen.clone().map_or_else(of_outputs, |target| vec![target]);
    refuse_faults(open, &graph, &kinds, &faulty)?;
    let (panorama, remarks) = read_panorama(&request.environment)?;
    let mut needed = None;
    let size_for = |linked: &LinkedModel| {
        let mesh = &linked.model.mesh;
        needed = texels_for_pixels(mesh, &cameras_of(request, mesh), request.size);
        match request.has_given_size {
            true => request.evaluator.model.size,
            false => chosen_size(needed),
        }
    };
    let mut evaluator = Evaluator::open_resized(open, graph, kinds, &request.evaluator, progress, size_for)?;
    evaluator.warn(remarks);
    evaluator.warn(softness(evaluator.linked().atlas.size, needed));
    let mut inputs = evaluator.read_files(open);
    inputs.push(PathBuf::from(&request.environment));
    let mut files = PictureFiles::begin(&paths, inputs)?;
    let cache_dir = request.evaluator.model.cache_dir.as_deref();
    let (environment, remark) = environment_of(evaluator.gpu(), &panorama, cache_dir)?;
    evaluator.warn(remark);
    let shown = evaluate_looks(&mut evaluator, seen.as_ref(), progress)?;
    let model = view_model(request, &mut evaluator, &shown)?;
    if shown.is_lit && mode == Mode::Material {
        evaluator.add_shade(&model, cache_dir)?;
    }
    let scene = Scene {
        model: &model,
        looks: &shown.looks,
        look_of_material: &shown.look_of_material,
        environment: &environment,
        lights: &request.lights,
    };
    let mode = if shown.is_lit { mode } else { Mode::Node };
    let range = shown.height_range;
    draw(request, &evaluator, &scene, mode, range, &mut files, progress)?;
    stop_if_canceled(progress)?;
    files.commit()?;
    Ok(RenderOutput {
        files: paths,
        warnings: evaluator.warnings().to_vec(),
    })
}

/// Lists the output files: one, or one for each frame.
fn file_names(request: &RenderRequest) -> Result<Vec<PathBuf>, EngineError> {
    let refused = |why: String| EngineError::new(ErrorKind::Usage, why);
    let output = &request.output;
    let Some(ending @ ("png" | "exr")) = output.extension().and_then(|ending| ending.to_str()) else {
        return Err(refused(format!(
            "{}: a picture is a .png, or an .exr of its light",
            output.display()
        )));
    };
    if ending == "exr" && request.view != LIT {
        return Err(refused(format!(
            "{}: an .exr holds light, and the view '{}' shows none; write a .png, or show the material",
            output.display(),
            request.view
        )));
    }
    let Some(frames) = request.turntable else {
        return Ok(vec![output.clone()]);
    };
    if !(1..=MOST_FRAMES).contains(&frames) {
        return Err(refused(format!(
            "a turntable has 1 to {MOST_FRAMES} frames, not {frames}"
        )));
    }
    // A path with an ending has a stem.
    let stem = output.file_stem().unwrap_or_default();
    let frame = |number: u32| {
        let mut name = stem.to_owned();
        name.push(format!("_{number:04}.{ending}"));
        output.with_file_name(name)
    };
    Ok((0..frames).map(frame).collect())
}

/// Parses a view: the mode, and the node if it names one.
fn view_of(view: &str) -> Result<(Mode, Option<&str>), EngineError> {
    if let Some(node) = view.strip_prefix("node:") {
        return Ok((Mode::Material, Some(node)));
    }
    let mode = view.parse().map_err(|why| EngineError::new(ErrorKind::Usage, why))?;
    Ok((mode, None))
}

/// Uploads the model or a displaced copy of it.
fn view_model(
    request: &RenderRequest,
    evaluator: &mut Evaluator,
    shown: &ModelLooks,
) -> Result<ViewModel, EngineError> {
    if let Some(triangles) = request.displace {
        return displaced_model(evaluator, shown, triangles);
    }
    evaluator.view_model()
}

fn draw(
    request: &RenderRequest,
    evaluator: &Evaluator,
    scene: &Scene<'_>,
    mode: Mode,
    height_range: [f32; 2],
    files: &mut PictureFiles,
    progress: &dyn Progress,
) -> Result<(), EngineError> {
    let gpu = evaluator.gpu();
    let renderer = Renderer::new(gpu)?;
    let mut canvas = Canvas::new(gpu, request.size)?;
    let frames = request.turntable.unwrap_or(1); // Without a turntable, there is a single picture.
    let has_light = request.output.extension().is_some_and(|ending| ending == "exr");
    for frame in 0..frames {
        stop_if_canceled(progress)?;
        let around = 360.0 * frame as f32 / frames as f32;
        let [of_camera, of_light] = match request.turns {
            Turns::Camera => [around, 0.0],
            Turns::Light => [0.0, around],
        };
        let mut camera = camera_of(request, &evaluator.linked().model.mesh);
        camera.turn(of_camera);
        let lights: Vec<Light> = scene.lights.iter().map(|light| light.turned(of_light)).collect();
        let scene = &Scene {
            lights: &lights,
            ..*scene
        };
        let shot = Shot {
            environment_turn_degrees: request.rotate + of_light,
            environment_strength: request.environment_strength,
            exposure_stops: request.exposure,
            bloom: request.bloom,
            transform: request.transform,
            background: request.background,
            has_ground: request.has_ground,
            mode,
            has_relief: request.has_relief && request.displace.is_none(),
            height_range,
            lines: request.lines.clone(),
            samples: request.samples,
            ..Shot::new(camera)
        };
        files.add(if has_light {
            encode_light(request.size, &renderer.light(gpu, &mut canvas, scene, &shot)?)?
        } else {
            renderer.draw(gpu, &mut canvas, scene, &shot)?;
            encode_picture(&canvas.read(gpu)?, request.background == Background::Clear)?
        })?;
        progress.advance(Phase::Draw, frame as usize + 1, frames as usize);
    }
    Ok(())
}

/// Returns the cameras that determine the size of the maps: the only one, or one on each side of a turntable.
fn cameras_of(request: &RenderRequest, mesh: &Mesh) -> Vec<Camera> {
    let around: &[f32] = match request.turns {
        Turns::Camera if request.turntable.is_some() => &[0.0, 90.0, 180.0, 270.0],
        Turns::Camera | Turns::Light => &[0.0],
    };
    let camera = camera_of(request, mesh);
    let turned = around.iter().map(|degrees| {
        let mut camera = camera;
        camera.turn(*degrees);
        camera
    });
    turned.collect()
}

fn camera_of(request: &RenderRequest, mesh: &Mesh) -> Camera {
    let points = Placement::of(mesh).points_in_view(mesh);
    let aspect = aspect_of(UVec2::from(request.size).as_vec2());
    let mut camera = Camera::seen_from(request.camera, &points, aspect);
    if let Some(target) = request.target {
        camera.target = target.into();
    }
    if request.is_orthographic {
        camera.lens = Lens::Orthographic;
    }
    camera
}

/// Encodes a picture as PNG of 8 bits in sRGB, with or without alpha.
pub fn encode_picture(picture: &Pixels, with_alpha: bool) -> Result<Vec<u8>, EngineError> {
    let [width, height] = picture.size;
    let options = PngOptions {
        channels: if with_alpha { 4 } else { 3 },
        bits: 8,
        srgb_chunk: true,
    };
    let rgb: Vec<u8>;
    let codes = if with_alpha {
        &picture.rgba
    } else {
        let (pixels, _) = picture.rgba.as_chunks::<4>();
        rgb = pixels.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect();
        &rgb
    };
    Ok(encode_png(width, height, PngData::U8(codes), options)?)
}

/// Encodes linear light as OpenEXR, with premultiplied alpha.
fn encode_light([width, height]: [u32; 2], light: &[[f32; 4]]) -> Result<Vec<u8>, EngineError> {
    let channel = |at: usize| -> Vec<f32> { light.iter().map(|pixel| pixel[at]).collect() };
    let [r, g, b, a] = [0, 1, 2, 3].map(channel);
    let channels: [(&str, &[f32]); 4] = [("R", &r), ("G", &g), ("B", &b), ("A", &a)];
    Ok(encode_exr(width, height, &channels, ExrSamples::Float)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_is_a_mode_or_a_node() {
        assert_eq!(view_of("roughness").unwrap(), (Mode::Roughness, None));
        assert_eq!(view_of("node:rust.mask").unwrap(), (Mode::Material, Some("rust.mask")));
        assert!(view_of("rust").is_err());
    }
}
