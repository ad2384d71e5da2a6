//! Draws strokes on a model according to a description, and writes them to a stroke file: `cargo run -p sabi_paint
//! --example draw MODEL DESCRIPTION FILE`. Prints the version for a graph to name.
//!
//! The description is a list of strokes in JSON. Each stroke has a `brush` (see [`sabi_paint::Brush`]; lengths are shares of the model's
//! largest side here), `erase`, the direction `seen_from`, and a `way` of points between 0 and 1 along the sides of the model's box. The
//! points are connected by straight lines, which are projected onto the model along the viewing direction.

#![allow(clippy::print_stdout, reason = "a program of its own")]

use std::collections::BTreeSet;
use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use sabi_paint::{Action, Brush, PaintSurface, Step, Stroke, StrokeBook, StrokePoint, SurfaceIndex, Version, file};
use sabi_surface::bvh::Bvh;
use sabi_surface::load::{LoadOptions, load};
use sabi_surface::model::Mesh;
use sabi_surface::patch::Site;
use serde::Deserialize;

/// Number of points of a way along one side of the model's box.
const POINTS_A_SIDE: f64 = 160.0;

#[derive(Deserialize)]
struct Description {
    brush: Brush,
    #[serde(default)]
    erase: bool,
    seen_from: [f64; 3],
    way: Vec<[f64; 3]>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [model, description, target] = arguments.as_slice() else {
        return Err("name a model, a description and the file to write".into());
    };
    let loaded = load(model, &LoadOptions::default())?;
    let strokes: Vec<Description> = serde_json::from_slice(&std::fs::read(description)?)?;
    let index = SurfaceIndex::new(&loaded.mesh);
    let surface = PaintSurface::new(&loaded.mesh, &index);
    let bvh = Bvh::build(&loaded.mesh);
    let mut book = StrokeBook::default();
    let mut version = Version::EMPTY;
    for described in strokes {
        let stroke = drawn(&surface, &bvh, &loaded.mesh, described);
        version = book.push(version, &Step::Add(Arc::new(stroke)));
    }
    // An existing file is replaced. Storing would append to it.
    if target.exists() {
        std::fs::remove_file(target)?;
    }
    file::store(
        &sabi_files::Disk::default(),
        target,
        &loaded.stem,
        &book,
        version,
        &mut BTreeSet::new(),
    )?;
    println!("{version}");
    Ok(())
}

fn drawn(surface: &PaintSurface<'_>, bvh: &Bvh, mesh: &Mesh, described: Description) -> Stroke {
    let at = |position: &[f32; 3]| DVec3::from(position.map(f64::from));
    let low = mesh.positions.iter().map(at).fold(DVec3::INFINITY, DVec3::min);
    let high = mesh.positions.iter().map(at).fold(DVec3::NEG_INFINITY, DVec3::max);
    let side = (high - low).max_element();
    let ray = -DVec3::from(described.seen_from).normalize();
    let mut points: Vec<StrokePoint> = Vec::new();
    let mut starts = true;
    for pair in described.way.windows(2) {
        let [from, to] = [pair[0], pair[1]].map(|point| low + DVec3::from(point) * (high - low));
        let steps = ((to - from).length() / side * POINTS_A_SIDE).ceil().max(1.0);
        for step in 0..=steps as usize {
            let origin = from.lerp(to, step as f64 / steps) - 2.0 * side * ray;
            let hit = bvh.closest(origin.as_vec3().to_array(), ray.as_vec3().to_array(), 1e9);
            let point = hit.and_then(|hit| {
                let site = Site {
                    triangle: hit.triangle,
                    position: mesh.position(hit.triangle, hit.barycentric.map(f64::from)),
                };
                surface.point(site, 1.0, starts)
            });
            starts = point.is_none();
            points.extend(point);
        }
    }
    let scaled = |share: f32| (f64::from(share) * side) as f32;
    let brush = Brush {
        radius: scaled(described.brush.radius),
        height: scaled(described.brush.height),
        ..described.brush
    };
    Stroke {
        action: if described.erase { Action::Erase } else { Action::Paint },
        ..Stroke::new(brush, points)
    }
}
