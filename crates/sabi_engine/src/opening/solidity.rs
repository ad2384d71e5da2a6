//! Warnings about models that are unsuitable for rays: open, inside out, self-intersecting, or without a clear inside.

use glam::{DVec3, Vec3};
use rayon::prelude::*;
use sabi_plan::{Plan, Step};
use sabi_surface::model::Mesh;
use sabi_surface::orientation::{LEAST_VOLUME, turned_faces};

use crate::opening::linked_model::LinkedModel;
use crate::remedy::Remedy;
use crate::warning::Warning;

/// Lists warnings about the model for a plan that casts rays; empty for others.
pub(crate) fn warnings(plan: &Plan, linked: &LinkedModel) -> Vec<Warning> {
    let traces_rays = |step: &Step| matches!(step, Step::Kernel(kernel) if kernel.rays.is_some());
    if !plan.steps.iter().any(traces_rays) {
        return Vec::new();
    }
    of_model(linked).to_vec()
}

/// Lists warnings about the model for rays; computed once.
pub(crate) fn of_model(linked: &LinkedModel) -> &[Warning] {
    linked.solidity.get_or_init(|| warnings_about(linked))
}

fn warnings_about(linked: &LinkedModel) -> Vec<Warning> {
    let report = &linked.atlas.report;
    let mesh = &linked.model.mesh;
    let turned = turned_warning(mesh);
    let mut warnings: Vec<Warning> = Vec::new();
    let mut warn = |sentence: String| warnings.push(sentence.into());
    if report.border_edges > 0 {
        warn(format!(
            "The model is open at {}: rays leave it through the openings, so thickness, edges and creases are weaker \
             near them, and a surface without thickness has none.",
            edges(report.border_edges)
        ));
    } else if turned.is_none() {
        inside_warning(mesh).map(str::to_owned).into_iter().for_each(&mut warn);
    }
    if report.nonmanifold_edges > 0 {
        warn(format!(
            "More than two faces meet at {}: the inside of the model is not defined there, so edges and thickness may \
             be wrong.",
            edges(report.nonmanifold_edges)
        ));
    }
    let crossings = crossings(linked);
    if crossings > 0 {
        warn(format!(
            "The model intersects itself at {}: the parts inside count as close surfaces, so creases and occlusion are \
             stronger there, and thickness ends at these parts.",
            edges(crossings)
        ));
    }
    turned.into_iter().chain(warnings).collect()
}

/// Returns a warning about faces that are inside out.
fn turned_warning(mesh: &Mesh) -> Option<Warning> {
    let (turned, all) = (turned_faces(mesh).len(), mesh.triangles.len());
    let sentence = match turned {
        0 => return None,
        _ if turned == all => {
            "The model is inside out: its faces point inward, so edges and creases are swapped and all of it \
                               counts as enclosed"
                .to_owned()
        }
        _ => format!(
            "{turned} of {all} faces of the model are inside out, against the faces around them or inward, so edges and \
             creases are swapped there and they count as enclosed"
        ),
    };
    Some(Warning::new(sentence, [Remedy::TurnFaces]))
}

/// Counts edges that pass through a face of the same piece, once for each of their triangles. Different pieces of a part may
/// intersect.
fn crossings(linked: &LinkedModel) -> u32 {
    let mesh = &linked.model.mesh;
    let bvh = linked.hierarchy();
    let pieces = &linked.pieces.triangle_piece;
    let place = |vertex: u32| Vec3::from(mesh.positions[vertex as usize]);
    let crosses = |triangle: u32, [from, to]: [u32; 2]| {
        let (start, way) = (place(from), place(to) - place(from));
        let length = way.length();
        let own = mesh.triangles[triangle as usize].map(place);
        let counts = |other: u32| {
            let corners = mesh.triangles[other as usize].map(place);
            let normal = (corners[1] - corners[0])
                .cross(corners[2] - corners[0])
                .normalize_or_zero();
            let beyond = [start, start + way].map(|end| (end - corners[0]).dot(normal));
            // Both ends have a distance from the face, on opposite sides, so faces that touch do not count.
            pieces[other as usize] == pieces[triangle as usize]
                && beyond[0] * beyond[1] < 0.0
                && beyond.iter().all(|beyond| beyond.abs() > OFF_FACE * length)
                && !own.iter().any(|corner| corners.contains(corner))
        };
        bvh.any_of(start.to_array(), way.to_array(), length, counts)
    };
    let of_triangle = |(triangle, [a, b, c]): (usize, &[u32; 3])| {
        let edges = [[*a, *b], [*b, *c], [*c, *a]];
        edges.into_iter().filter(|edge| crosses(triangle as u32, *edge)).count() as u32
    };
    mesh.triangles.par_iter().enumerate().map(of_triangle).sum()
}

/// Minimum distance of an edge's ends from a face that it passes through, relative to its length.
const OFF_FACE: f32 = 1e-3;

fn edges(count: u32) -> String {
    match count {
        1 => "an edge".to_owned(),
        count => format!("{count} edges"),
    }
}

/// Returns a warning about the inside of a closed model.
fn inside_warning(mesh: &Mesh) -> Option<&'static str> {
    let (volume, area) = measured(mesh);
    (volume.abs() <= LEAST_VOLUME * area.powf(1.5)).then_some(
        "The model has no inside: its faces lie back to back, so thickness, edges and creases have no effect. Give it a \
         thickness in a modeling program.",
    )
}

/// Computes the enclosed volume, negative where faces point inward, and the area.
fn measured(mesh: &Mesh) -> (f64, f64) {
    let place = |vertex: u32| DVec3::from(mesh.positions[vertex as usize].map(f64::from));
    // Positions are relative to a vertex of the model, so that a model far from the origin loses no precision.
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
