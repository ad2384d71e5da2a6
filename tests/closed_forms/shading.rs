//! Edges as shading shows them: round columns of few sides, and hard edges that should look bevelled.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use sabi_tests::shapes::{PatchDivision, cube, tube};
use sabi_tests::{MeshFile, OnMesh};

use crate::rays::graph;

/// The highest value of edges on a tube of eight sides, away from its ends, where each side turns by 45 degrees.
fn highest_edge(on_mesh: &mut OnMesh, params: &str) -> f32 {
    on_mesh.set_graph(&graph("edges", params));
    let mask = on_mesh.evaluate("rays").component("mask");
    let values = on_mesh
        .owned()
        .filter(|(index, _)| on_mesh.position(*index).is_some_and(|at| at.y.abs() < 0.8))
        .map(|(index, _)| mask[index]);
    values.fold(0.0, f32::max)
}

#[test]
fn facets_of_what_is_shaded_as_round_are_no_edges_unless_asked_for() {
    let quads = tube(8, 0.5);
    let round = |corner: &[f32; 3]| Vec3::new(corner[0], 0.0, corner[2]).normalize().to_array();
    let normals = quads
        .iter()
        .flat_map(|quad| quad.corners.each_ref().map(round))
        .collect();
    let shaded_round = MeshFile {
        normals: Some(normals),
        ..MeshFile::new(quads.clone())
    };
    let params = |groups: &str| format!(r#""width": 0.18, "angle": 20, "rays": 128, "smooth_groups": {groups}"#);
    for (file, groups, is_edge) in [
        (&shaded_round, "true", false),
        (&shaded_round, "false", true),
        (&MeshFile::new(quads), "true", true),
    ] {
        let made = file.write();
        let mut on_mesh = OnMesh::new(&graph("edges", ""), made.path(), 192);
        let highest = highest_edge(&mut on_mesh, &params(groups));
        let is_seen = if is_edge { highest > 0.7 } else { highest == 0.0 };
        assert!(is_seen, "smooth groups {groups}, is an edge {is_edge}: {highest}");
    }
}

/// Sine and cosine parts of the air's mean direction near an edge of a right angle, at a share of the radius from it. A ray
/// below the surface in a direction `u` across the edge leaves the solid after `share / u` of its length, and what is
/// beyond counts by volume.
fn air_beside_edge(share: f64) -> [f64; 2] {
    let steps = 400;
    let middle = |step: i32| (f64::from(step) + 0.5) / f64::from(steps);
    let mut sums = [0.0, 0.25];
    for (up, round) in (0..steps).flat_map(|up| (0..steps).map(move |round| (up, round))) {
        // Down at z, evenly over the lower half of a sphere.
        let (z, turn) = (middle(up), 2.0 * PI * middle(round));
        let across = (1.0 - z * z).sqrt() * turn.cos();
        if across > share {
            let beyond = (1.0 - (share / across).powi(3)) * 0.5 / f64::from(steps * steps);
            sums[0] += across * beyond;
            sums[1] -= z * beyond;
        }
    }
    sums
}

#[test]
fn a_rounded_edge_turns_from_one_side_to_the_other_over_its_radius() {
    let made = MeshFile::new(cube(PatchDivision::even(1))).write();
    let mut on_mesh = OnMesh::new(&graph("occlusion", ""), made.path(), 192);
    on_mesh.set_graph(&graph("rounded_normal", r#""radius": 0.1, "rays": 256"#));
    let result = on_mesh.evaluate("rays");
    let [x, y, z] = ["vector.x", "vector.y", "vector.z"].map(|axis| result.component(axis));
    for share in [0.1, 0.3, 0.5, 0.7, 0.9, 1.2] {
        // On the top, beside the edge toward +x, away from its ends.
        let is_meant = |at: DVec3| {
            let from_edge = (0.5 - at.x) / 0.1;
            at.y > 0.499 && (from_edge - share).abs() < 0.08 && at.z.abs() < 0.35
        };
        let meant: Vec<usize> = on_mesh
            .owned()
            .map(|(index, _)| index)
            .filter(|index| on_mesh.position(*index).is_some_and(is_meant))
            .collect();
        assert!(meant.len() > 30, "{} texels at {share}", meant.len());
        let mut difference = 0.0;
        for &index in &meant {
            let place = on_mesh.position(index).map_or(0.0, |at| (0.5 - at.x) / 0.1);
            let [across, up] = air_beside_edge(place);
            assert!(y[index].abs() < 1e-5, "a slope lies in the surface");
            difference += f64::from(-x[index]).atan() - (across / up).atan();
            assert!(
                share < 1.1 || (x[index] == 0.0 && z[index] == 0.0),
                "flat beyond the radius"
            );
        }
        let degrees = (difference / meant.len() as f64).to_degrees();
        assert!(
            degrees.abs() < 0.5,
            "{share} of the radius from the edge: {degrees} degrees off"
        );
    }
}
