//! What rays cannot rely on: models that are open, inside out, or have no clear inside.

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
    } else if signed_volume(&prepared.model.mesh) < 0.0 {
        told.push(
            "The model is inside out: its faces look inward, so edges and creases change places and all of it counts as \
             buried. Turn its faces around in a modeling program."
                .to_owned(),
        );
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

/// Six times the volume that the faces enclose, below 0 where they look inward.
fn signed_volume(mesh: &Mesh) -> f64 {
    let volume = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize].map(f64::from));
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    mesh.triangles.iter().map(volume).sum()
}
