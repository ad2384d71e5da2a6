//! `cargo bench --bench live`: how soon a window shows what a slider does, and what thumbnails take. Medians of some moves;
//! nothing here asserts.

#![allow(clippy::print_stdout, reason = "a bench's table is its output")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot run may stop")]

mod setup;

use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use sabi_engine::evaluating::ModelLooks;
use sabi_engine::live::{LiveEvent, LiveModel, LiveOptions, LiveRequest, ViewSubject};
use sabi_engine::opening::default_cache_dir;
use sabi_engine::opening::environment::load_environment;
use sabi_engine::opening::linked_model::ModelOptions;
use sabi_engine::{Kinds, Live, OpenGraph};
use sabi_gpu::Gpu;
use sabi_graph::NodeRef;
use sabi_view::{Background, Camera, Environment, MaterialLook, Mode, RenderTarget, Renderer, Scene, Shot, Viewpoint};
use setup::{adapter, peer_model};

const MOVES: usize = 15;
/// Texels across the sheet of a finished material.
const FINE: u32 = 2048;
/// Viewport of a window of 900 × 700 while something moves.
const VIEWPORT: [u32; 2] = [450, 350];
const THUMBNAIL: [u32; 2] = [128, 128];

/// Returns a graph of five point nodes in a row, of which the first has the slider.
fn graph(folder: &Path, at: f32) -> OpenGraph {
    let text = format!(
        r##"{{ "format": "sabi", "version": 1, "name": "bench", "nodes": {{
            "clouds": {{ "kind": "noise/simplex" }},
            "cut": {{ "kind": "adjust/threshold", "inputs": {{ "source": "clouds" }}, "params": {{ "at": {at} }} }},
            "levels": {{ "kind": "adjust/levels", "inputs": {{ "source": "cut" }} }},
            "turned": {{ "kind": "adjust/invert", "inputs": {{ "source": "levels" }} }},
            "both": {{ "kind": "blend/mask", "inputs": {{ "below": "turned", "above": "clouds" }} }},
            "base": {{ "kind": "source/material" }},
            "rust": {{ "kind": "effect/layer", "inputs": {{ "base": "base", "mask": "both", "height_map": "clouds" }},
              "params": {{ "color": "#6b3a1e", "height": 0.01 }} }},
            "out": {{ "kind": "output/material", "inputs": {{ "material": "rust" }} }} }} }}"##
    );
    let path = folder.join("live.sabi");
    std::fs::write(&path, text).unwrap();
    OpenGraph::open(&path).unwrap()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::NAN)
}

fn ms(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1000.0
}

fn row(what: &str, ms: f64, aim: &str) {
    println!("| {what} | {ms:.1} ms | {aim} |");
}

/// Looks that were drawn, with their model.
type DrawnLooks = (Arc<LiveModel>, Arc<ModelLooks>);

/// Stand-in for a window that draws the results it receives.
struct BenchWindow {
    gpu: Arc<Gpu>,
    live: Live,
    woken: Receiver<()>,
    renderer: Renderer,
    environment: Environment,
    target: RenderTarget,
}

/// Milliseconds of one move from the request on: until coarse and full results were reported, and until they were drawn.
#[derive(Default)]
struct Move {
    told: [f64; 2],
    drawn: [f64; 2],
    last: Option<DrawnLooks>,
    nodes: Vec<(String, Duration)>,
}

impl BenchWindow {
    fn new(gpu: &Arc<Gpu>, options: LiveOptions) -> BenchWindow {
        let (wake, woken) = channel();
        BenchWindow {
            live: Live::start(gpu.clone(), options.clone(), move || {
                // Sending fails once the window is closed, which does not matter.
                let _ = wake.send(());
            }),
            woken,
            renderer: Renderer::new(gpu).unwrap(),
            environment: load_environment(gpu, "studio", options.cache_dir.as_deref()).unwrap().0,
            target: RenderTarget::new(gpu, VIEWPORT).unwrap(),
            gpu: gpu.clone(),
        }
    }

    fn draw(&mut self, pictured: &DrawnLooks) {
        let (model, shown) = pictured;
        let points = model.placement.points_in_view(&model.linked.model.mesh);
        let aspect = VIEWPORT[0] as f32 / VIEWPORT[1] as f32;
        let scene = Scene {
            model: &model.view,
            looks: &shown.looks,
            look_of_material: &shown.look_of_material,
            environment: &self.environment,
            lights: &[],
        };
        let shot = Shot::new(Camera::seen_from(Viewpoint::THREE_QUARTER, &points, aspect));
        self.renderer.draw(&self.gpu, &mut self.target, &scene, &shot).unwrap();
        self.gpu.wait().unwrap();
    }

    /// Sends a request and draws the results until all have come.
    fn answer(&mut self, request: LiveRequest) -> Move {
        let asked = Instant::now();
        let mut made = Move::default();
        self.live.submit(request);
        loop {
            self.woken.recv().unwrap();
            for event in self.live.take_events() {
                match event {
                    LiveEvent::Looks {
                        is_coarse,
                        model,
                        looks,
                        ..
                    } => {
                        let at = usize::from(!is_coarse);
                        made.told[at] = ms(asked);
                        let pictured = (model, looks);
                        self.draw(&pictured);
                        made.drawn[at] = ms(asked);
                        made.last = Some(pictured);
                    }
                    LiveEvent::Times { times, .. } => made.nodes = times.nodes,
                    LiveEvent::Failed { error, .. } | LiveEvent::ModelFailed { error, .. } | LiveEvent::Lost(error) => {
                        panic!("{error}")
                    }
                    LiveEvent::Done { .. } => return made,
                    _ => {}
                }
            }
        }
    }
}

/// Measures a thumbnail of a look drawn on its own, and as one of many of a pose, in milliseconds.
fn pictures(window: &BenchWindow, pictured: &DrawnLooks) -> [f64; 2] {
    let (model, shown) = pictured;
    let (gpu, renderer, environment) = (&window.gpu, &window.renderer, &window.environment);
    let look: &MaterialLook = shown.looks.last().unwrap();
    let points = model.placement.points_in_view(&model.linked.model.mesh);
    let shot = Shot {
        background: Background::Clear,
        mode: Mode::Material,
        samples: 4,
        ..Shot::new(Camera::seen_from(Viewpoint::THREE_QUARTER, &points, 1.0))
    };
    let scene = Scene {
        model: &model.view,
        looks: std::slice::from_ref(look),
        look_of_material: &vec![0; shown.look_of_material.len()],
        environment,
        lights: &[],
    };
    let mut target = RenderTarget::new(gpu, THUMBNAIL).unwrap();
    let mut pose = renderer.pose(gpu, THUMBNAIL, &model.view, environment, &shot).unwrap();
    let alone = |_| {
        let started = Instant::now();
        renderer.draw(gpu, &mut target, &scene, &shot).unwrap();
        target.read(gpu).unwrap();
        ms(started)
    };
    let alone = median((0..MOVES).map(alone).collect());
    let posed = |_| {
        let started = Instant::now();
        let drawn = renderer
            .draw_look(gpu, &mut pose, &model.view, environment, look)
            .unwrap();
        drawn.read(gpu).unwrap();
        ms(started)
    };
    [alone, median((0..MOVES).map(posed).collect())]
}

/// Sends requests with the slider at one position after another.
struct Slider {
    folder: tempfile::TempDir,
    kinds: Arc<Kinds>,
    model: Arc<ModelOptions>,
}

impl Slider {
    fn on(size: u32) -> Slider {
        Slider {
            folder: tempfile::tempdir().unwrap(),
            kinds: Arc::new(Kinds::builtin()),
            model: Arc::new(ModelOptions::new(&peer_model(), size)),
        }
    }

    fn request(&self, revision: u64) -> LiveRequest {
        LiveRequest {
            revision,
            graph: Arc::new(graph(self.folder.path(), 0.2 + 0.02 * revision as f32)).into(),
            kinds: self.kinds.clone(),
            kinds_revision: 0,
            model: self.model.clone(),
            model_revision: 0,
            coarse_size: 256,
            subjects: vec![ViewSubject::Outputs],
            inspected: Vec::new(),
            set: None,
            thumbnails: Vec::new(),
            outputs_thumbnail: false,
            is_flat: false,
            is_moving: true,
        }
    }

    /// Thumbnails alone, of all nodes.
    fn still(&self, revision: u64) -> LiveRequest {
        let all = ["clouds", "cut", "levels", "turned", "both", "base", "rust", "out"];
        let node = |id: &str| NodeRef {
            node: id.to_owned(),
            port: None,
        };
        LiveRequest {
            subjects: Vec::new(),
            thumbnails: all.map(node).to_vec(),
            is_moving: false,
            ..self.request(revision)
        }
    }
}

/// Measures moves of the slider on a fine sheet, where the window itself decides to show a coarse result first.
fn bench_fine(gpu: &Arc<Gpu>) {
    let slider = Slider::on(FINE);
    let mut window = BenchWindow::new(
        gpu,
        LiveOptions {
            cache_dir: default_cache_dir(),
            ..LiveOptions::default()
        },
    );
    for revision in 0..3 {
        window.answer(slider.request(revision));
    }
    let moves: Vec<Move> = (3..)
        .take(MOVES)
        .map(|revision| window.answer(slider.request(revision)))
        .collect();
    let drawn = |made: &Move| made.drawn.into_iter().find(|&at| at > 0.0).unwrap();
    let of = |number: &dyn Fn(&Move) -> f64| median(moves.iter().map(number).collect());
    row(
        &format!("a slider moves at {FINE}²: first drawn"),
        of(&drawn),
        "≤ 16 ms on a card",
    );
    row("… and drawn in full", of(&|made| made.drawn[1]), "≤ 16 ms on a card");
}

fn report(moves: &[Move]) {
    let of = |number: &dyn Fn(&Move) -> f64| median(moves.iter().map(number).collect());
    row("a slider moves: coarse is told", of(&|made| made.told[0]), "≤ 60 ms");
    row("… and drawn at 450 × 350", of(&|made| made.drawn[0]), "");
    row("a slider moves: full is told", of(&|made| made.told[1]), "");
    row("… and drawn at 450 × 350", of(&|made| made.drawn[1]), "≤ 150 ms");
    for (node, time) in moves.iter().flat_map(|made| &made.nodes).take(moves[0].nodes.len()) {
        let ms = time.as_secs_f64() * 1000.0;
        row(&format!("… in which {node} at both sizes"), ms, "");
    }
}

fn main() {
    let gpu = Arc::new(Gpu::open(&adapter()).unwrap());
    println!(
        "{}\n\n| what | measured | aim on a software driver |\n|---|---|---|",
        gpu.summary().name
    );
    let options = LiveOptions {
        cache_dir: default_cache_dir(),
        coarse_after: Duration::ZERO,
        ..LiveOptions::default()
    };
    let slider = Slider::on(512);
    let mut window = BenchWindow::new(&gpu, options);
    let first = window.answer(slider.request(0));
    row("the first time: coarse", first.told[0], "");
    row("the first time: full", first.told[1], "");
    window.answer(slider.request(1));
    let moves: Vec<Move> = (2..)
        .take(MOVES)
        .map(|revision| window.answer(slider.request(revision)))
        .collect();
    report(&moves);
    let [alone, posed] = pictures(&window, moves.iter().find_map(|made| made.last.as_ref()).unwrap());
    row("a thumbnail drawn on its own", alone, "");
    row("a thumbnail as one of many", posed, "");
    window.answer(slider.still(100));
    let thumbnails = |revision: u64| {
        let started = Instant::now();
        window.answer(slider.still(revision));
        ms(started)
    };
    let six = median((101..).take(MOVES).map(thumbnails).collect());
    row("a slider moves: its six thumbnails alone", six, "");
    drop(window);
    bench_fine(&gpu);
}
