//! `cargo bench --bench window`: processor time of the frames of the window, time until it shows something, and time
//! until it shows the effect of a slider. Medians and the worst of some frames; nothing here asserts. `-- slider`, `--
//! busy`, `-- orbit`, `-- painting`, `-- frames`, `-- clicks`, `-- start` and `-- settle` measure that alone.

#![allow(clippy::print_stdout, reason = "a bench's table is its output")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot run may stop")]

#[path = "window/frames.rs"]
mod frames;
#[path = "window/opening.rs"]
mod opening;
#[path = "window/orbit.rs"]
mod orbit;
#[path = "window/painting.rs"]
mod painting;
#[path = "window/slider.rs"]
mod slider;
#[path = "window/table.rs"]
mod table;

use std::path::{Path, PathBuf};

use sabi_editor::Offscreen;
use sabi_gpu::AdapterChoice;

const SIZE: [f32; 2] = [1600.0, 900.0];

/// A file of the project.
fn asset(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

/// The first of these files that exists; the figure that the program comes with otherwise.
fn model_or_figure(path: &str) -> PathBuf {
    let found = Some(asset(path)).filter(|path| path.is_file());
    found.unwrap_or_else(|| asset("assets/meshes/figure.glb"))
}

/// A model of 30 000 triangles.
fn busy_model() -> PathBuf {
    model_or_figure("../shared/data/meshes/bench-suzanne30k/mesh30k.glb")
}

/// Models with textures of their own, of one material and of five.
fn textured_models() -> [(&'static str, PathBuf); 2] {
    let bottle = "../shared/data/meshes/khr-WaterBottle/glTF/WaterBottle.gltf";
    let helmet = "../shared/data/meshes/bevy-FlightHelmet/FlightHelmet.gltf";
    [("a bottle", bottle), ("a helmet", helmet)].map(|(what, path)| (what, model_or_figure(path)))
}

fn opened(adapter: &AdapterChoice, graph: &str, model: PathBuf) -> Offscreen {
    let render = egui_kittest::wgpu::create_render_state(Offscreen::setup(adapter), Default::default());
    Offscreen::open(graph, model, render, SIZE).unwrap()
}

fn main() {
    let adapter = match std::env::var("SABI_ADAPTER") {
        Ok(name) => name.parse().unwrap(),
        Err(_) => AdapterChoice::Auto,
    };
    let wanted: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let is_wanted = |part: &str| wanted.is_empty() || wanted.iter().any(|word| word == part);
    let folder = tempfile::tempdir().unwrap();
    println!("| what | the middle one | the worst | aim |\n|---|---|---|---|");
    if is_wanted("start") {
        opening::start(&adapter);
    }
    if is_wanted("settle") {
        for (what, model) in textured_models() {
            opening::settle(&adapter, folder.path(), what, model);
        }
    }
    if is_wanted("frames") {
        for (count, aim) in [(60, "≤ 8 ms"), (500, "≤ 16 ms")] {
            frames::all_frames(&adapter, folder.path(), count, aim);
        }
    }
    if is_wanted("clicks") {
        frames::clicks(&adapter, folder.path());
    }
    if is_wanted("slider") {
        slider::slider(&adapter, folder.path());
    }
    if is_wanted("busy") {
        slider::busy(&adapter, folder.path());
    }
    if is_wanted("painting") {
        painting::painting(&adapter, folder.path());
    }
    if is_wanted("orbit") {
        orbit::orbit(&adapter, folder.path());
    }
}
