//! Times of painting: `cargo run --release -p sabi_paint --example paint_times -- [MODEL] [SIZE]`.
//!
//! Draws strokes over the front of the model, each as long as a fifth of it, with a round brush of 5 % of its size, and says how
//! long a stroke takes on a canvas that is there, what a new canvas of all strokes takes, and a step back.

#![allow(clippy::print_stdout, reason = "a program of its own")]

use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec3;
use sabi_paint::{
    Brush, Canvases, Layers, PaintSurface, Site, StampPictures, Step, Stroke, StrokeBook, StrokePoint, SurfaceIndex,
    Version,
};
use sabi_surface::atlas::{Atlas, AtlasOptions};
use sabi_surface::bvh::Bvh;
use sabi_surface::load::{LoadOptions, load};

/// Strokes that are drawn.
const STROKES: usize = 256;
/// Points of a stroke.
const POINTS: usize = 40;
/// Bytes of canvases that are kept.
const BUDGET: usize = 512 << 20;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1);
    let model = arguments
        .next()
        .map_or_else(|| PathBuf::from("assets/meshes/figure.glb"), PathBuf::from);
    let size = arguments
        .next()
        .and_then(|size| size.to_str()?.parse().ok())
        .unwrap_or(1024); // As in the editor.
    let mesh = load(&model, &LoadOptions::default())?.mesh;
    let atlas = Atlas::build(&mesh, &AtlasOptions::new(size))?;
    let (index, bvh) = (SurfaceIndex::new(&mesh), Bvh::build(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let mut book = StrokeBook::default();
    let mut versions = vec![Version::EMPTY];
    let (low, high) = bounds(&mesh.positions);
    for number in 0..STROKES {
        let stroke = stroke(&surface, &bvh, (low, high), number);
        versions.push(book.push(versions[number], &Step::Add(Arc::new(stroke))));
    }
    let layers = Layers {
        value: true,
        ..Layers::default()
    };
    let mut canvases = Canvases::default();
    let mut paint = |version: Version, canvases: &mut Canvases| -> Duration {
        let list = book.list(version).unwrap_or_default(); // All versions are known.
        let started = Instant::now();
        canvases.painted(
            &surface,
            (&atlas, [0; 32]),
            (&list, &StampPictures::new()),
            layers,
            BUDGET,
        );
        started.elapsed()
    };
    let mut times: Vec<Duration> = versions[1..]
        .iter()
        .map(|version| paint(*version, &mut canvases))
        .collect();
    times.sort();
    println!("{size} texels, {} triangles, {STROKES} strokes", mesh.triangles.len());
    println!(
        "one more stroke: {:?} in the middle, {:?} at most",
        times[STROKES / 2],
        times[STROKES - 1]
    );
    println!("a step back: {:?}", paint(versions[STROKES - 1], &mut canvases));
    println!(
        "all strokes anew: {:?}",
        paint(versions[STROKES], &mut Canvases::default())
    );
    Ok(())
}

fn bounds(positions: &[[f32; 3]]) -> (DVec3, DVec3) {
    let all = || positions.iter().map(|at| DVec3::from(at.map(f64::from)));
    (
        all().fold(DVec3::INFINITY, DVec3::min),
        all().fold(DVec3::NEG_INFINITY, DVec3::max),
    )
}

/// A stroke from somewhere on the front of the model, in some direction; the same for the same number.
fn stroke(surface: &PaintSurface<'_>, bvh: &Bvh, (low, high): (DVec3, DVec3), number: usize) -> Stroke {
    let side = (high - low).max_element();
    // Evenly spread numbers (Weyl's sequence of the plastic number).
    let spread = |step: f64| (number as f64 * step).fract();
    let start = low + (high - low) * DVec3::new(spread(0.754_877_666), spread(0.569_840_291), 0.0);
    let angle = std::f64::consts::TAU * spread(0.618_033_988);
    let way = 0.2 * side * DVec3::new(angle.cos(), angle.sin(), 0.0);
    let mut starts = true;
    let points = (0..POINTS).filter_map(|point| {
        let at = start + way * (point as f64 / POINTS as f64);
        let eye = DVec3::new(at.x, at.y, high.z + side);
        let hit = bvh.closest(eye.as_vec3().to_array(), [0.0, 0.0, -1.0], 1e9);
        let seen: Option<StrokePoint> = hit.and_then(|hit| {
            let site = Site {
                triangle: hit.triangle,
                position: surface.mesh().position(hit.triangle, hit.barycentric.map(f64::from)),
            };
            surface.point(site, 1.0, starts)
        });
        starts = seen.is_none();
        seen
    });
    let brush = Brush {
        radius: (0.05 * side) as f32,
        ..Brush::default()
    };
    Stroke::new(brush, points.collect())
}
