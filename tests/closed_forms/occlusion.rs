//! Occlusion against closed forms: in wedges, beside walls, below ceilings, inside of balls and boxes, on convex bodies.

use std::f64::consts::TAU;

use glam::DVec3;
use sabi_tests::shapes::{PatchDivision, ball, cube, patch, tube, turned_in};
use sabi_tests::{MeshFile, OnMesh, Quad};

use crate::mean_difference::MeanDifference;
use crate::rays::{faces, graph};

const RAYS: u32 = 64;
/// Longer than any of these models.
const FAR: f64 = 1000.0;

/// Compares occlusion within a distance with the expected value of each texel that has one.
fn held(on_mesh: &mut OnMesh, distance: f64, expected: impl Fn(DVec3) -> Option<f64>) -> MeanDifference {
    let params = format!(r#""rays": {RAYS}, "distance": {distance}"#);
    on_mesh.set_graph(&graph("occlusion", &params));
    let values = on_mesh.evaluate("rays").component("mask");
    MeanDifference::new(on_mesh, &values, RAYS, expected, |share| share * (1.0 - share))
}

/// A narrow floor along +x from x = 0 on.
const FLOOR: [[f32; 3]; 4] = [[0.0, 0.0, 0.5], [0.2, 0.0, 0.5], [0.2, 0.0, -0.5], [0.0, 0.0, -0.5]];

fn is_floor(at: DVec3) -> bool {
    at.y == 0.0 && at.x > 0.01
}

/// A face from the floor's edge up, `height` long along its own slope and `half` to either side.
fn rising(degrees: f64, height: f64, half: f32) -> [[f32; 3]; 4] {
    let [x, y] = [degrees.to_radians().cos(), degrees.to_radians().sin()].map(|share| (share * height) as f32);
    [[0.0, 0.0, half], [0.0, 0.0, -half], [x, y, -half], [x, y, half]]
}

#[test]
fn a_wedge_lies_open_by_half_of_one_less_its_cosine() {
    for degrees in [60.0, 90.0, 120.0_f64] {
        let mut on_mesh = faces(&[FLOOR, rising(degrees, 100.0, 1000.0)]);
        let open = 0.5 * (1.0 - degrees.to_radians().cos());
        // The face ends after five hundred times the way to it, which leaves less than that share open.
        let expected = |at| is_floor(at).then_some(1.0 - open);
        held(&mut on_mesh, FAR, expected).assert(0.001, &format!("{degrees}°"));
    }
}

#[test]
fn a_wall_covers_what_is_below_its_top() {
    for height in [0.03, 0.1, 0.3] {
        let mut on_mesh = faces(&[FLOOR, rising(90.0, height, 100.0)]);
        let expected = |at: DVec3| is_floor(at).then(|| 0.5 * (1.0 - at.x / at.x.hypot(height)));
        held(&mut on_mesh, FAR, expected).assert(0.0, &format!("a wall of {height}"));
    }
}

#[test]
fn a_ceiling_covers_what_is_near_enough_and_an_eave_what_is_beneath_it() {
    let height = 0.1_f32;
    let above = |from: f32| {
        let [near, far] = [from, 50.0];
        [[near, -50.0], [far, -50.0], [far, 50.0], [near, 50.0]].map(|[x, z]| [x, height, z])
    };
    let mut on_mesh = faces(&[FLOOR, above(-50.0)]);
    for distance in [0.08, 0.11, 0.15, 0.3] {
        let share = f64::from(height) / distance;
        let covered = (1.0 - share * share).max(0.0);
        // Rays start a millionth of the largest coordinate above the floor, and as much nearer to the ceiling.
        let lifted = 2.0 * share * 50.0 * 1e-6 / distance;
        held(&mut on_mesh, distance, |at| is_floor(at).then_some(covered))
            .assert(lifted, &format!("within {distance}"));
    }
    let mut on_mesh = faces(&[FLOOR, above(0.1)]);
    let beneath = |at: DVec3| 0.5 * (1.0 + (at.x - 0.1) / (at.x - 0.1).hypot(f64::from(height)));
    // It is no longer than five hundred times its height.
    held(&mut on_mesh, FAR, |at| is_floor(at).then(|| beneath(at))).assert(1e-5, "an eave");
}

fn on(quads: Vec<Quad>, size: u32) -> OnMesh {
    OnMesh::new(&graph("occlusion", ""), MeshFile::new(quads).write().path(), size)
}

#[test]
fn inside_of_a_ball_occlusion_is_the_square_of_the_rays_share_of_its_width() {
    let mut on_mesh = on(turned_in(ball(0.5, 32)), 96);
    for share in [0.25, 0.5, 0.75, 1.1_f64] {
        let inside = (share * share).min(1.0);
        // Its faces are chords of it, at most 0.0006 of the radius nearer to the middle.
        held(&mut on_mesh, share, |_| Some(inside)).assert(0.002, &format!("{share} of the width"));
    }
}

#[test]
fn in_a_closed_box_no_ray_as_long_as_its_diagonal_gets_out() {
    for cut in [
        PatchDivision::even(1),
        PatchDivision::even(10),
        PatchDivision::scattered(10, 5),
    ] {
        // Long rays start from texels twice as wide; the scattered charts are two of those wide.
        let mut on_mesh = on(turned_in(cube(cut)), 192);
        on_mesh.set_graph(&graph("occlusion", r#""rays": 64, "distance": 1.74"#));
        let values = on_mesh.evaluate("rays").component("mask");
        let least = on_mesh.owned().map(|(index, _)| values[index]).fold(1.0, f32::min);
        assert_eq!(least, 1.0, "{cut:?}");
    }
}

/// A ball without its poles. Cut along circles, its faces are flat: a ball of bent ones would have hollow diagonals.
fn barrel() -> Vec<Quad> {
    let at = |s: f64, t: f64| {
        let (turn, rise) = (TAU * s, 2.4 * (t - 0.5));
        0.5 * DVec3::new(rise.cos() * turn.sin(), rise.sin(), rise.cos() * turn.cos())
    };
    patch(at, [[0.02; 2], [0.98; 2]], PatchDivision::even(48))
}

#[test]
fn a_convex_body_covers_nothing_of_itself() {
    let bodies = [
        ("a cube", cube(PatchDivision::even(1))),
        ("a cube of many faces", cube(PatchDivision::scattered(32, 3))),
        ("a barrel", barrel()),
        ("a tube of three sides", tube(3, 0.5)),
        ("a tube of 48 sides", tube(48, 0.5)),
    ];
    for (name, quads) in bodies {
        let mut on_mesh = on(quads, 96);
        on_mesh.set_graph(&graph("occlusion", r#""rays": 64, "distance": 3"#));
        let values = on_mesh.evaluate("rays").component("mask");
        let covered = on_mesh.owned().filter(|(index, _)| values[*index] > 0.0).count();
        assert_eq!(covered, 0, "texels of {name}");
    }
}
