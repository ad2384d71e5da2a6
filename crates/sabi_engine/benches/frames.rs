//! `cargo bench --bench frames`: how long a frame of the viewport takes at 1280 × 720. Median of some frames; nothing here
//! asserts.

#![allow(clippy::print_stdout, reason = "a bench's table is its output")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot run may stop")]

mod setup;

use std::time::Instant;

use sabi_engine::evaluating::{EvaluatorOptions, ModelLooks, evaluate_looks};
use sabi_engine::opening::linked_model::ModelOptions;
use sabi_engine::phases::NoProgress;
use sabi_engine::{Evaluator, Kinds, OpenGraph};
use sabi_gpu::{CasterChoice, DEFAULT_BUDGET_BYTES};
use sabi_graph::Overrides;
use sabi_view::{
    Background, Camera, Environment, Light, LightPlace, Lines, Mode, Panorama, Placement, RenderTarget, Renderer,
    STUDIO_ENVIRONMENT_STRENGTH, STUDIO_LIGHTS, Scene, Shot, ViewModel, Viewpoint,
};
use setup::{adapter, peer_model, root};

const SIZE: [u32; 2] = [1280, 720];
const FRAMES: usize = 15;

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

fn evaluator() -> Evaluator {
    let options = EvaluatorOptions {
        model: ModelOptions::new(&peer_model(), 1024),
        overrides: Overrides::default(),
        fit: None,
        adapter: adapter(),
        caster: CasterChoice::Auto,
        budget_bytes: DEFAULT_BUDGET_BYTES,
    };
    let path = root().join("tests/graphs/weathered-paint.sabi");
    let open = OpenGraph::open(&path).unwrap();
    let kinds = Kinds::beside(Some(&path), &open.trusted);
    let graph = options.flat_graph(&open, &kinds).unwrap();
    Evaluator::open(&open, graph, kinds, &options, &NoProgress).unwrap()
}

/// Light from above and less from below, which is all that a time depends on.
fn sky() -> Panorama {
    let pixel = |index: u32| {
        let height = 1.0 - (index / 128) as f32 / 64.0;
        [1.0 + height, 1.0 + height, 1.2 + height, 1.0]
    };
    let pixels: Vec<[f32; 4]> = (0..128 * 64).map(pixel).collect();
    Panorama::new(128, 64, &pixels).unwrap().0
}

/// Evaluated scene and the renderer that draws it.
struct Stage {
    evaluator: Evaluator,
    shown: ModelLooks,
    model: ViewModel,
    environment: Environment,
    renderer: Renderer,
}

/// Runs `work` and prints how long it took.
fn timed<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let started = Instant::now();
    let done = work();
    println!("| {what} | {:.1} ms | |", started.elapsed().as_secs_f64() * 1000.0);
    done
}

impl Stage {
    fn new() -> Stage {
        let mut evaluator = evaluator();
        let shown = evaluate_looks(&mut evaluator, None, &NoProgress).unwrap();
        let gpu = evaluator.gpu();
        let name = &gpu.summary().name;
        println!("{name}\n\n| what | measured | aim on a software driver |\n|---|---|---|");

        let new_model = || ViewModel::new(gpu, evaluator.view_parts());
        let model = timed("model onto the device", new_model).unwrap();
        let environment = timed("environment", || Environment::new(gpu, &sky())).unwrap();
        let renderer = Renderer::new(gpu).unwrap();
        Stage {
            shown,
            model,
            environment,
            renderer,
            evaluator,
        }
    }

    /// Returns the milliseconds of a frame after `change`.
    fn frame(&self, size: [u32; 2], lights: &[Light], change: impl FnOnce(&mut Shot)) -> f64 {
        let gpu = self.evaluator.gpu();
        let scene = Scene {
            model: &self.model,
            looks: &self.shown.looks,
            look_of_material: &self.shown.look_of_material,
            environment: &self.environment,
            lights,
        };
        let mesh = &self.evaluator.linked().model.mesh;
        let points = Placement::of(mesh).points_in_view(mesh);
        let aspect = size[0] as f32 / size[1] as f32;
        let mut shot = Shot::new(Camera::seen_from(Viewpoint::FRONT, &points, aspect));
        shot.height_range = self.shown.height_range;
        change(&mut shot);
        let mut target = RenderTarget::new(gpu, size).unwrap();
        let frame = |_| {
            let started = Instant::now();
            self.renderer.draw(gpu, &mut target, &scene, &shot).unwrap();
            gpu.wait().unwrap();
            started.elapsed().as_secs_f64() * 1000.0
        };
        // The first ones make pipelines.
        median((0..FRAMES + 2).map(frame).skip(2).collect())
    }
}

fn main() {
    let stage = Stage::new();
    let half = SIZE.map(|side| side / 2);
    let lamp = Light {
        place: LightPlace::Directional([0.5, 0.7, 0.5]),
        color: [2.0; 3],
        has_shadow: true,
        size_degrees: 0.0,
        follows_camera: false,
    };
    let row = |what: &str, ms: f64, aim: &str| println!("| {what} | {ms:.1} ms | {aim} |");
    row("environment alone", stage.frame(SIZE, &[], |_| {}), "");
    let sharp = |shot: &mut Shot| shot.background = Background::Environment;
    row("sharp environment behind", stage.frame(SIZE, &[], sharp), "");
    let clear = |shot: &mut Shot| shot.background = Background::Clear;
    row("nothing behind", stage.frame(SIZE, &[], clear), "");
    row("with a light and its shadow", stage.frame(SIZE, &[lamp], |_| {}), "");
    let relief = |shot: &mut Shot| shot.has_relief = true;
    row("relief", stage.frame(SIZE, &[], relief), "");
    let wires = |shot: &mut Shot| shot.lines = vec![Lines::Wires];
    row("wires", stage.frame(SIZE, &[], wires), "");
    let color = |shot: &mut Shot| shot.mode = Mode::BaseColor;
    row("base color", stage.frame(SIZE, &[], color), "");
    // The look that the window and `sabi render` start with: lights, shade of the model on itself and on the ground.
    timed("shade of the model", || {
        stage.evaluator.add_shade(&stage.model, None).unwrap();
    });
    let usual = |shot: &mut Shot| {
        shot.environment_strength = STUDIO_ENVIRONMENT_STRENGTH;
        shot.background = Background::Studio;
        shot.has_ground = true;
    };
    row(
        "still, as the window draws",
        stage.frame(SIZE, &STUDIO_LIGHTS, usual),
        "≤ 120 ms",
    );
    row(
        "the same while moving, half the size",
        stage.frame(half, &STUDIO_LIGHTS, usual),
        "≤ 60 ms",
    );
}
