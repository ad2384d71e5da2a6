//! Handedness: an image that is read at a place of a stamp or of a cell of a pattern is seen as it is, and not in a mirror.

use glam::{DVec3, dvec2};
use sabi_surface::atlas::Owner;
use sabi_tests::{OnMesh, project};

/// A graph of one node.
fn graph(kind: &str, params: &str) -> String {
    format!(
        r#"{{ "format": "sabi", "version": 1, "nodes": {{ "node": {{ "kind": "{kind}", "params": {{ {params} }} }} }} }}"#
    )
}

/// Number of the side of the cube that a normal looks from: -x, x, -y, y, -z, z.
fn side(normal: DVec3) -> usize {
    let axis = (0..3).max_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs()));
    let axis = axis.expect("three axes");
    2 * axis + usize::from(normal[axis] > 0.0)
}

/// Returns counts of right and left hands on each side of the cube: the number of places where x and y of a result have the
/// same orientation as in a picture seen from outside, and of those where the orientation is reversed.
fn hands(kind: &str, params: &str, port: &str) -> [[usize; 2]; 6] {
    let mut on_mesh = OnMesh::new(&graph(kind, params), &project("assets/meshes/cube.glb"), 256);
    let place = on_mesh.evaluate(&format!("node.{port}"));
    let [right, up] = ["vector.x", "vector.y"].map(|name| place.component(name));
    let at = |index: usize| dvec2(f64::from(right[index]), f64::from(up[index]));
    let mut counts = [[0; 2]; 6];
    for (index, triangle) in on_mesh.owned() {
        let [page, x, y] = on_mesh.texel(index);
        let beside = [[page, x + 1, y], [page, x, y + 1]];
        let is_owned = |[page, x, y]: [u32; 3]| matches!(on_mesh.atlas().owner(x, y, page), Owner::Triangle(_));
        let beside = beside.map(|texel| is_owned(texel).then(|| on_mesh.index(texel)));
        let [Some(one), Some(other)] = beside else { continue };
        let ways =
            [one, other].map(|to| on_mesh.position(to).expect("a place") - on_mesh.position(index).expect("a place"));
        let steps = [one, other].map(|to| at(to) - at(index));
        // Steps across the border of a stamp or a cell are not part of a picture.
        if steps.iter().any(|step| step.length() > 0.1) {
            continue;
        }
        let here = dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let normal = on_mesh.frame_at(triangle, here)[2];
        let turn = ways[0].cross(ways[1]).dot(normal) * steps[0].perp_dot(steps[1]);
        if turn.abs() > 1e-12 {
            counts[side(normal)][usize::from(turn < 0.0)] += 1;
        }
    }
    counts
}

#[test]
fn pictures_on_stamps_and_in_cells_are_seen_as_they_are_on_all_six_sides() {
    let cases = [
        (
            "scatter/stamp",
            r#""shape": "disc", "size": 0.3, "spacing": 0.4"#,
            "place",
        ),
        ("pattern/bricks", r#""length": 0.4, "row_height": 0.2"#, "uv"),
        (
            "pattern/bricks",
            r#""length": 0.4, "row_height": 0.2, "rotate": 30"#,
            "uv",
        ),
        ("pattern/bricks", r#""length": 0.4, "row_height": 0.2"#, "place"),
        ("pattern/tiles", r#""width": 0.3"#, "uv"),
        ("pattern/hex", r#""size": 0.3"#, "uv"),
        ("pattern/planks", r#""width": 0.3, "space": "piece""#, "uv"),
        ("pattern/grid", r#""size": 0.3"#, "uv"),
        ("pattern/checker", r#""size": 0.3"#, "place"),
    ];
    for (kind, params, port) in cases {
        for (side, [right, left]) in hands(kind, params, port).into_iter().enumerate() {
            // A short step from one stamp to another looks like any.
            assert!(
                right > 300 && 100 * left < right,
                "{port} of {kind} with {params} on side {side}: {right} right and {left} left"
            );
        }
    }
}

#[test]
fn pictures_in_cells_stand_upright_on_the_four_upright_sides() {
    let mut on_mesh = OnMesh::new(
        &graph("pattern/bricks", r#""length": 0.4, "row_height": 0.2"#),
        &project("assets/meshes/cube.glb"),
        256,
    );
    let up = on_mesh.evaluate("node.uv").component("vector.y");
    let mut counts = [0; 6];
    for (one, other) in on_mesh.neighbors() {
        let [from, to] = [one, other].map(|index| on_mesh.position(index).expect("a place"));
        let (rise, step) = (to.y - from.y, up[other] - up[one]);
        if rise.abs() < 1e-4 || step.abs() > 0.2 {
            continue;
        }
        let [_, x, y] = on_mesh.texel(one);
        let Owner::Triangle(triangle) = on_mesh.owner(one) else {
            continue;
        };
        let normal = on_mesh.frame_at(triangle, dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5))[2];
        assert!(
            f64::from(step) * rise > 0.0,
            "{step} for {rise} of height, seen from {normal}"
        );
        counts[side(normal)] += 1;
    }
    assert!([0, 1, 4, 5].into_iter().all(|side| counts[side] > 500), "{counts:?}");
}

#[test]
fn pictures_on_stripes_and_threads_are_seen_as_they_are_on_all_six_sides() {
    let cases = [
        ("pattern/stripes", r#""size": 0.4"#),
        ("pattern/stripes", r#""size": 0.4, "rotate": 30"#),
        ("pattern/weave", r#""size": 0.8"#),
        ("pattern/weave", r#""size": 0.8, "kind": "twill", "rotate": 30"#),
        ("pattern/weave", r#""size": 0.8, "kind": "satin""#),
    ];
    for (kind, params) in cases {
        for port in ["uv", "place"] {
            for (side, [right, left]) in hands(kind, params, port).into_iter().enumerate() {
                assert!(
                    right > 300 && 100 * left < right,
                    "{port} of {kind} with {params} on side {side}: {right} right and {left} left"
                );
            }
        }
    }
}
