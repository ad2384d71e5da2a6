//! Curvature, edges and cavity, compared with geometry. They must not depend on the triangles.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use sabi_tests::shapes::{PatchDivision, PatchUvs, ball, cube, patch, tube, turned_in};
use sabi_tests::{MeshFile, OnMesh, Quad};

use crate::mean_difference::MeanDifference;
use crate::rays::graph;

const RAYS: u32 = 64;

fn on(quads: Vec<Quad>, size: u32) -> OnMesh {
    OnMesh::new(&graph("curvature", ""), MeshFile::new(quads).write().path(), size)
}

/// Curvature within a radius.
fn bend_of(on_mesh: &mut OnMesh, radius: f64) -> Vec<f32> {
    let params = format!(r#""rays": {RAYS}, "radius": {radius}"#);
    on_mesh.set_graph(&graph("curvature", &params));
    on_mesh.evaluate("rays").component("mask")
}

/// Compares a bend with the expected value of each texel that has one. Rays are stopped on one side only, and each stopped ray counts 2.
fn held(on_mesh: &OnMesh, bend: &[f32], expected: impl Fn(DVec3) -> Option<f64>) -> MeanDifference {
    MeanDifference::new(on_mesh, bend, RAYS, expected, |bend| 2.0 * bend.abs() - bend * bend)
}

/// Expected curvature at a distance from an edge that turns by `turn`, the distance as a share of the radius: the mean
/// over directions inside, each of which meets the other side after `sin turn / sin (turn - direction)` of the
/// distance. Beside a sharp edge that is nearer than the edge.
fn beside_edge(turn: f64, distance: f64) -> f64 {
    let steps = 2000;
    let open = |step: i32| {
        let direction = turn * (f64::from(step) + 0.5) / f64::from(steps);
        let reach = distance * turn.sin() / (turn - direction).sin();
        (1.0 - reach * reach).max(0.0).sqrt()
    };
    (0..steps).map(open).sum::<f64>() / f64::from(steps) * turn / PI
}

/// Texels along a side of the sheet of tubes.
const SIZE: u32 = 128;
/// Spread along an axis of the texels whose means are fitted by a plane: the weighted mean of their squared distances.
const DENOISED_SPREAD: f64 = 1.767;

#[test]
fn an_edge_gives_its_share_of_a_half_turn_out_and_in_and_falls_off_as_it_turns() {
    for sides in [3, 4, 6, 8, 12] {
        let turn = TAU / f64::from(sides);
        let side = 2.0 * 0.5 * (turn / 2.0).sin();
        let radius = 0.3 * side;
        // The profile is tabulated, since it is needed for each texel.
        let profile: Vec<f64> = (0..=260).map(|at| beside_edge(turn, f64::from(at) / 200.0)).collect();
        for sign in [1.0, -1.0] {
            let quads = tube(sides, 0.5);
            let mut on_mesh = on(if sign > 0.0 { quads } else { turned_in(quads) }, SIZE);
            let bend = bend_of(&mut on_mesh, radius);
            let expected = |at: DVec3| {
                // The way along its side to the nearest of the two edges.
                let around = (at.x.atan2(at.z) + TAU) % turn - turn / 2.0;
                let from_middle = 0.5 * (turn / 2.0).cos() * around.tan().abs();
                let share = ((side / 2.0 - from_middle) / radius).max(0.0);
                let place = share * 200.0;
                let [below, above] = [place.floor(), place.floor() + 1.0].map(|at| profile.get(at as usize));
                let between = |below: &f64, above: &f64| below + (above - below) * place.fract();
                let bend = below.zip(above).map_or(0.0, |(below, above)| between(below, above));
                (at.y.abs() < 1.0 - radius).then_some(sign * bend)
            };
            // The profile bends up at the end of the radius, twice a side; a plane through texels rounds that.
            let texel = f64::from(sides) * side / (0.96 * f64::from(SIZE));
            let rounded = turn / PI / radius * DENOISED_SPREAD * texel * texel / side;
            held(&on_mesh, &bend, expected).assert(rounded, &format!("{sides} sides, sign {sign}"));
            let on_edge = |at: DVec3| expected(at).filter(|bend| bend.abs() > 0.9 * turn / PI);
            held(&on_mesh, &bend, on_edge).assert(0.0, &format!("edges of {sides} sides, sign {sign}"));
        }
    }
}

#[test]
fn a_ball_and_a_tube_bend_as_their_radius_says() {
    // R / 2S of a ball, and half of that of a tube, which is true to a hundredth while the radius is half of its own.
    let (out, inward) = (ball(0.5, 32), turned_in(ball(0.5, 32)));
    for (quads, expected, slack) in [(out, 0.25, 0.0), (inward, -0.25, 0.0), (tube(256, 0.5), 0.125, 0.00125)] {
        let mut on_mesh = on(quads, 96);
        let bend = bend_of(&mut on_mesh, 0.25);
        held(&on_mesh, &bend, |at| (at.y.abs() < 0.7).then_some(expected)).assert(slack, &format!("{expected}"));
    }
}

#[test]
fn a_saddle_bends_as_much_inward_as_outward() {
    let radius = 0.15;
    let height = |s: f64, t: f64| DVec3::new(s - 0.5, (s - 0.5).powi(2) - (0.5 - t).powi(2), 0.5 - t);
    let mut on_mesh = on(patch(height, PLACE, PatchDivision::even(64)), 96);
    let bend = bend_of(&mut on_mesh, radius);
    let inside = |at: DVec3| (at.x.abs() < 0.3 && at.z.abs() < 0.3).then_some(0.0);
    // Its slices bend by 2 cos 2φ, 4/π in the mean over all ways, to one side or the other: each way stops a share of the
    // radius' half of that.
    let stopped = 4.0 / PI * radius / 2.0;
    MeanDifference::new(&on_mesh, &bend, RAYS, inside, |_| 2.0 * stopped).assert(0.0, "a saddle");
}

const PLACE: PatchUvs = [[0.02; 2], [0.98; 2]];

#[test]
fn a_plane_is_exactly_flat_in_any_orientation_and_triangulation() {
    let (right, up) = (DVec3::new(0.6, 0.48, 0.64), DVec3::new(-0.8, 0.36, 0.48));
    for cut in [
        PatchDivision::even(1),
        PatchDivision::even(24),
        PatchDivision::scattered(24, 7),
    ] {
        let quads = patch(|s, t| right * s + up * t + DVec3::new(0.3, 0.2, -0.7), PLACE, cut);
        let mut on_mesh = on(quads, 96);
        for kind in ["curvature", "edges", "cavity"] {
            let params = if kind == "curvature" {
                r#""radius": 0.3"#
            } else {
                r#""width": 0.3"#
            };
            on_mesh.set_graph(&graph(kind, params));
            let values = on_mesh.evaluate("rays").component("mask");
            let bent = on_mesh.owned().filter(|(index, _)| values[*index] != 0.0).count();
            assert_eq!(bent, 0, "texels of {kind}, {cut:?}");
        }
    }
}

/// Curvature and the mask of edges, which are creases of a cube seen from inside, for each owned texel.
fn masks_of_cube(is_inward: bool, cut: PatchDivision) -> [Vec<(usize, f32)>; 2] {
    let quads = cube(cut);
    let mut on_mesh = on(if is_inward { turned_in(quads) } else { quads }, 96);
    let marks = if is_inward { "cavity" } else { "edges" };
    [("curvature", "radius"), (marks, "width")].map(|(kind, length)| {
        let params = format!(r#""rays": {RAYS}, "{length}": 0.2"#);
        on_mesh.set_graph(&graph(kind, &params));
        let values = on_mesh.evaluate("rays").component("mask");
        on_mesh.owned().map(|(index, _)| (index, values[index])).collect()
    })
}

#[test]
fn masks_of_a_cube_are_the_same_whatever_its_triangles() {
    for is_inward in [false, true] {
        let expected = masks_of_cube(is_inward, PatchDivision::even(1));
        for values in &expected {
            let marked = values.iter().filter(|(_, value)| value.abs() > 0.1).count();
            assert!(4 * marked > values.len(), "only {marked} texels of {}", values.len());
        }
        // 1 200 and 12 288 triangles.
        for cut in [
            PatchDivision::even(10),
            PatchDivision::even(32),
            PatchDivision::scattered(10, 1),
            PatchDivision::scattered(32, 2),
        ] {
            for (expected, found) in expected.iter().zip(&masks_of_cube(is_inward, cut)) {
                assert_eq!(expected.len(), found.len());
                let pairs = expected.iter().zip(found);
                let differences: Vec<f32> = pairs
                    .inspect(|((one, _), (other, _))| assert_eq!(one, other, "the same texels are owned"))
                    .map(|((_, one), (_, other))| (one - other).abs())
                    .collect();
                // The same texels shoot the same rays; those that pass an edge within rounding may see it or not. None does
                // where this was measured.
                let differ = differences.iter().filter(|difference| **difference > 0.0).count();
                let share = differ as f64 / differences.len() as f64;
                assert!(share <= 0.001, "inward {is_inward}, {cut:?}: {differ} texels");
            }
        }
    }
}
