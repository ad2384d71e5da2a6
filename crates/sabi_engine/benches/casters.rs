//! `cargo bench --bench casters`: the same rays through the wide tree on all cores, through it in its kernel, and through a
//! tree of two boxes a node in a kernel. Best of a few runs; nothing here asserts.

#![allow(clippy::print_stdout, reason = "a bench's table is its output")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot run may stop")]

#[path = "casters/bvh2.rs"]
mod bvh2;
#[path = "casters/kernel.rs"]
mod kernel;
mod setup;

use std::time::Instant;

use bvh2::Bvh2;
use glam::Vec3;
use kernel::{Kernel, Machine};
use rayon::prelude::*;
use sabi_engine::opening::linked_model::{LinkedModel, ModelOptions};
use sabi_engine::phases::NoProgress;
use sabi_surface::bvh::Bvh;
use setup::peer_model;

const SIZE: u32 = 1024;
/// Of the model's largest side.
const REACHES: [f32; 2] = [0.05, 0.5];
/// For each texel.
const RAYS: u32 = 3;
const RUNS: u32 = 3;

/// A ray as kernels read it: origin and reach, direction.
type Ray = [[f32; 4]; 2];

/// Rays out of every owned texel, more of them straight up.
fn rays(linked: &LinkedModel, reach: f32) -> Vec<Ray> {
    let tables = linked.fitted(sabi_graph::Fit::Metres).tables(0);
    let width = linked.atlas.page_size[0];
    let owners = linked.atlas.owners.iter().enumerate();
    let owned = owners.filter(|(_, owner)| **owner >> 31 == 0);
    let of_texel = |(index, &triangle): (usize, &u32)| {
        let rows = &tables.geometry[6 * triangle as usize..][..6];
        let texel = [index as u32 % width, index as u32 / width].map(|texel| texel as f32 + 0.5);
        let step = [texel[0] - rows[0][3], texel[1] - rows[1][3]];
        let along = |first: usize| {
            let row = |at: usize| Vec3::new(rows[at][0], rows[at][1], rows[at][2]);
            row(first) + row(first + 1) * step[0] + row(first + 2) * step[1]
        };
        let up = along(3).normalize_or(Vec3::Y);
        let origin = along(0) + up * (1e-5 * linked.largest_side as f32);
        let ray = move |ray: u32| {
            // Points of a sphere that touches the surface give cosine-weighted directions.
            let turn = (index as u32 * 64 + ray).wrapping_mul(2_654_435_769) as f32 / 4_294_967_296.0;
            let height = (ray as f32 + turn) / RAYS as f32 * 2.0 - 1.0;
            let round = (1.0 - height * height).max(0.0).sqrt();
            let (sine, cosine) = (turn * 97.0).sin_cos();
            let direction = (up + Vec3::new(round * cosine, round * sine, height)).normalize_or(up);
            [origin.extend(reach).to_array(), direction.extend(0.0).to_array()]
        };
        (0..RAYS).map(ray)
    };
    owned.flat_map(of_texel).collect()
}

/// Best time of a few runs, seconds, and the number of hits.
fn best(mut run: impl FnMut() -> (f64, usize)) -> (f64, usize) {
    (0..RUNS)
        .map(|_| run())
        .min_by(|one, other| one.0.total_cmp(&other.0))
        .unwrap()
}

fn row(what: &str, value: f64, unit: &str, aim: &str) {
    println!("| {what} | {value:.3} {unit} | {aim} |");
}

fn bench(machine: &Machine, linked: &LinkedModel, reach: f32) {
    let shot = rays(linked, reach * linked.largest_side as f32);
    let bvh = Bvh::build(&linked.model.mesh);
    let count = shot.len() as f64;
    let (bare, hits) = best(|| {
        let started = Instant::now();
        let is_hit = |[origin, direction]: &&Ray| {
            let [x, y, z, reach] = *origin;
            bvh.any([x, y, z], [direction[0], direction[1], direction[2]], reach)
        };
        let hits = shot.par_iter().with_min_len(1024).filter(is_hit).count();
        (started.elapsed().as_secs_f64(), hits)
    });
    row(
        &format!("reach {reach}: all cores, rays a second"),
        count / bare / 1e6,
        "M",
        "",
    );
    let wide = Kernel::wide(machine, &bvh, &shot);
    let mesh = &linked.model.mesh;
    let corners = |triangle: &[u32; 3]| triangle.map(|vertex| Vec3::from(mesh.positions[vertex as usize]));
    let two = Bvh2::build(&mesh.triangles.iter().map(corners).collect::<Vec<_>>());
    let two = Kernel::two(machine, &two, &shot);
    let (wide, wide_hits) = best(|| wide.run(machine));
    let (two, two_hits) = best(|| two.run(machine));
    row("the wide tree's kernel, rays a second", count / wide / 1e6, "M", "");
    row(
        "the same, as a multiple of all cores",
        bare / wide,
        "×",
        "≥ 0.4 × on a software driver",
    );
    row("the kernel of two boxes, rays a second", count / two / 1e6, "M", "");
    row("the wide tree's, as a multiple of it", two / wide, "×", "≥ 1.5 ×");
    let apart = |other: usize| hits.abs_diff(other) as f64 / count;
    row("hits that differ, wide", 100.0 * apart(wide_hits), "%", "≤ 0.2 %");
    row("hits that differ, two", 100.0 * apart(two_hits), "%", "");
}

fn main() {
    let linked = LinkedModel::open(&ModelOptions::new(&peer_model(), SIZE), &NoProgress).unwrap();
    let machine = Machine::open();
    println!("{}\n\n| what | measured | aim |\n|---|---|---|", machine.name);
    for reach in REACHES {
        bench(&machine, &linked, reach);
    }
}
