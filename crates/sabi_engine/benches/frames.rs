//! `cargo bench --bench frames`: how long a frame of the viewport takes at 1280 × 720. Median of some frames; nothing here
//! asserts.

#![allow(clippy::print_stdout, reason = "a bench's table is its output")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot run may stop")]

use std::path::Path;
use std::time::Instant;

use sabi_engine::view::{
    Background, Camera, Environment, Light, LightPlace, Lines, Mode, Panorama, Placement, Renderer, Scene, Shot,
    Target, ViewModel, Viewpoint,
};
use sabi_engine::{
    AdapterChoice, CasterChoice, DEFAULT_BUDGET_BYTES, Kinds, ModelOptions, OpenGraph, Overrides, Silent, Workpiece,
    WorkpieceOptions, show,
};

const SIZE: [u32; 2] = [1280, 720];
const FRAMES: usize = 15;

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

fn workpiece(root: &Path) -> Workpiece {
    let shared = root.join("../shared/data/meshes/bench-suzanne30k/mesh30k.glb");
    let own = root.join("assets/meshes/figure.glb");
    let model = if shared.is_file() { shared } else { own };
    let options = WorkpieceOptions {
        model: ModelOptions::new(&model, 1024),
        overrides: Overrides::default(),
        fit: None,
        adapter: match std::env::var("SABI_ADAPTER") {
            Ok(name) => name.parse().unwrap(),
            Err(_) => AdapterChoice::Auto,
        },
        caster: CasterChoice::Auto,
        budget_bytes: DEFAULT_BUDGET_BYTES,
    };
    let path = root.join("graphs/weathered-paint.sabi");
    let open = OpenGraph::open(&path).unwrap();
    let kinds = Kinds::beside(Some(&path));
    let graph = Workpiece::flat_graph(&open, &kinds, &options).unwrap();
    Workpiece::open(&open, graph, kinds, &options, &Silent).unwrap()
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

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut workpiece = workpiece(&root);
    let shown = show(&mut workpiece, None, &Silent).unwrap();
    let gpu = &workpiece.gpu;
    let started = Instant::now();
    let model = {
        let prepared = &workpiece.prepared;
        let model_from_working = 1.0 / prepared.working_from_model(&workpiece.fit);
        ViewModel::new(
            gpu,
            &prepared.model,
            &prepared.atlas,
            &workpiece.surface,
            model_from_working,
        )
        .unwrap()
    };
    let on_device = started.elapsed().as_secs_f64() * 1000.0;
    let started = Instant::now();
    let environment = Environment::new(gpu, &sky()).unwrap();
    let light = started.elapsed().as_secs_f64() * 1000.0;
    let started = Instant::now();
    let renderer = Renderer::new(gpu).unwrap();
    let ready = started.elapsed().as_secs_f64() * 1000.0;
    let mesh = &workpiece.prepared.model.mesh;
    let bounds = Placement::of(mesh).box_in_view(mesh);
    println!(
        "{}\n\n| what | measured | aim on a software driver |\n|---|---|---|",
        gpu.summary().name
    );
    println!("| model onto the device | {on_device:.1} ms | |");
    println!("| environment | {light:.1} ms | |");
    println!("| pipelines | {ready:.1} ms | |");
    let lamp = Light {
        place: LightPlace::Far([0.5, 0.7, 0.5]),
        color: [2.0; 3],
        has_shadow: true,
    };
    let half = SIZE.map(|side| side / 2);
    let cases: [(&str, [u32; 2], Mode, &[Light], Background, &[Lines], &str); 7] = [
        ("still", SIZE, Mode::Material, &[], Background::Blurred, &[], "≤ 120 ms"),
        (
            "while moving, half the size",
            half,
            Mode::Material,
            &[],
            Background::Blurred,
            &[],
            "≤ 60 ms",
        ),
        (
            "sharp environment behind",
            SIZE,
            Mode::Material,
            &[],
            Background::Environment,
            &[],
            "",
        ),
        ("nothing behind", SIZE, Mode::Material, &[], Background::Clear, &[], ""),
        (
            "with a light and its shadow",
            SIZE,
            Mode::Material,
            &[lamp],
            Background::Blurred,
            &[],
            "",
        ),
        (
            "wires",
            SIZE,
            Mode::Material,
            &[],
            Background::Blurred,
            &[Lines::Wires],
            "",
        ),
        ("base color", SIZE, Mode::BaseColor, &[], Background::Blurred, &[], ""),
    ];
    for (what, size, mode, lights, background, lines, aim) in cases {
        let scene = Scene {
            model: &model,
            looks: &shown.looks,
            look_of_material: &shown.look_of_material,
            environment: &environment,
            lights,
        };
        let aspect = size[0] as f32 / size[1] as f32;
        let shot = Shot {
            mode,
            background,
            lines: lines.to_vec(),
            ..Shot::new(Camera::seen_from(Viewpoint::FRONT, bounds, aspect))
        };
        let mut target = Target::new(gpu, size).unwrap();
        let frame = |_| {
            let started = Instant::now();
            renderer.draw(gpu, &mut target, &scene, &shot).unwrap();
            gpu.wait().unwrap();
            started.elapsed().as_secs_f64() * 1000.0
        };
        let times: Vec<f64> = (0..FRAMES + 2).map(frame).skip(2).collect();
        println!("| {what} | {:.1} ms | {aim} |", median(times));
    }
}
