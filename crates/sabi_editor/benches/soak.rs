//! `cargo bench --bench soak`: ten thousand edits at random in one window, whose memory should stay as it is.

#![allow(clippy::print_stdout, reason = "a bench's table is its output")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot run may stop")]

#[path = "soak/walk.rs"]
mod walk;

use std::path::Path;
use std::time::{Duration, Instant};

use sabi_editor::Offscreen;
use sabi_gpu::AdapterChoice;
use walk::{FIRST, Walk, WalkStep};

const EDITS: usize = 10_000;
const EVERY: usize = 1000;

/// Memory that this program takes, MiB; `None` where the system does not say so in a file.
fn resident_mib() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kib: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kib / 1024.0)
}

fn main() {
    let adapter = match std::env::var("SABI_ADAPTER") {
        Ok(name) => name.parse().unwrap(),
        Err(_) => AdapterChoice::Auto,
    };
    let edits = std::env::var("SABI_SOAK_EDITS").map_or(EDITS, |count| count.parse().unwrap());
    let folder = tempfile::tempdir().unwrap();
    let graph = folder.path().join("soak.sabi");
    std::fs::write(&graph, FIRST).unwrap();
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/meshes/cube.glb");
    let render = egui_kittest::wgpu::create_render_state(Offscreen::setup(&adapter), Default::default());
    let mut window = Offscreen::open(&graph.display().to_string(), model, render, [1600.0, 900.0]).unwrap();
    window.rest();
    println!("| edits | nodes | memory | of it results | a thousand edits took |\n|---|---|---|---|---|");
    let mut walk = Walk::new(1);
    let mut began = Instant::now();
    for at in 0..=edits {
        if at % EVERY == 0 {
            window.rest();
            let memory = resident_mib().map_or("unknown".to_owned(), |mib| format!("{mib:.0} MiB"));
            let nodes = window.document().graph.len();
            let results = window.kept_bytes()[0] >> 20;
            let seconds = began.elapsed().as_secs_f64();
            println!("| {at} | {nodes} | {memory} | {results} MiB | {seconds:.1} s |");
            began = Instant::now();
        }
        match walk.next(window.document()) {
            WalkStep::Edit(edit) => window.edit(*edit),
            WalkStep::Undo => window.undo(),
            WalkStep::Redo => window.redo(),
        }
        window.frame(Vec::new());
        // About as soon as a user could act again: some results arrive, others are replaced before.
        window.wait(Duration::from_millis(5));
    }
}
