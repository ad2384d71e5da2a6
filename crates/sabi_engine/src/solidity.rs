//! What rays cannot rely on: models that are open, inside out, or have no clear inside.

use glam::DVec3;
use sabi_plan::{Plan, Step};
use sabi_surface::model::Mesh;

use crate::prepare::Prepared;

/// Sentences about the model for a plan that shoots rays; none for others.
pub(crate) fn warnings(plan: &Plan, prepared: &Prepared) -> Vec<String> {
    let shoots = |step: &Step| matches!(step, Step::Kernel(kernel) if kernel.rays.is_some());
    if !plan.steps.iter().any(shoots) {
        return Vec::new();
    }
    let report = &prepared.atlas.report;
    let mut told = Vec::new();
    if report.border_edges > 0 {
        told.push(format!(
            "The model is open at {}: rays that should end inside of it leave there, so thickness, edges and creases are \
             weaker near its openings, and a sheet without thickness has none.",
            edges(report.border_edges)
        ));
    } else {
        told.extend(about_inside(&prepared.model.mesh).map(str::to_owned));
    }
    if report.nonmanifold_edges > 0 {
        told.push(format!(
            "More than two faces meet at {}: it is not clear there what is inside, so edges and thickness may be wrong.",
            edges(report.nonmanifold_edges)
        ));
    }
    told
}

fn edges(count: u32) -> String {
    match count {
        1 => "an edge".to_owned(),
        count => format!("{count} edges"),
    }
}

/// What is wrong with the inside of a closed model.
fn about_inside(mesh: &Mesh) -> Option<&'static str> {
    let (volume, area) = measured(mesh);
    if volume.abs() <= LEAST_VOLUME * area.powf(1.5) {
        return Some(
            "The model has no inside: its faces lie back to back, so rays pass between them, and thickness, edges and \
             creases find nothing. Give it a thickness in a modeling program.",
        );
    }
    (volume < 0.0).then_some(
        "The model is inside out: its faces look inward, so edges and creases change places and all of it counts as buried. \
         Turn its faces around in a modeling program.",
    )
}

/// Less volume than this for an area is what rounding leaves of none: a sheet of paper has dozens of times as much.
const LEAST_VOLUME: f64 = 1e-6;

/// The volume that the faces enclose, below 0 where they look inward, and their area.
fn measured(mesh: &Mesh) -> (f64, f64) {
    let place = |vertex: u32| DVec3::from(mesh.positions[vertex as usize].map(f64::from));
    // From a corner of its own, so that a model far from the middle of its scene loses nothing to rounding.
    let Some(origin) = mesh.triangles.first().map(|triangle| place(triangle[0])) else {
        return (0.0, 0.0);
    };
    let measures = mesh.triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|vertex| place(vertex) - origin);
        (a.dot(b.cross(c)) / 6.0, (b - a).cross(c - a).length() / 2.0)
    });
    measures.fold((0.0, 0.0), |(volume, area), (more, wider)| {
        (volume + more, area + wider)
    })
}
