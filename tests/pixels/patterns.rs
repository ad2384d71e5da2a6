//! Patterns: laid around the corners of boxes, of the share that they say, and the same on every unwrap.

use std::collections::{BTreeMap, BTreeSet};

use sabi_tests::{MeshFile, OnMesh, Quad};

use crate::specimens::{Specimen, on_own_mesh, specimens};

/// Results of all patterns.
fn patterns() -> Vec<Specimen> {
    let all = specimens().into_iter().filter(Specimen::is_pattern);
    let found: Vec<Specimen> = all.collect();
    assert!(found.len() > 30, "{} results of patterns", found.len());
    found
}

/// Graph of a pattern with parameters.
pub(crate) fn graph(kind: &str, params: &str) -> String {
    format!(
        r#"{{ "format": "sabi", "version": 1, "nodes": {{ "node": {{ "kind": "{kind}", "params": {{ {params} }} }} }} }}"#
    )
}

/// Normal of a triangle's first corner.
fn normal(on_mesh: &OnMesh, triangle: u32) -> [f32; 3] {
    let mesh = &on_mesh.evaluator.linked().model.mesh;
    mesh.normals[mesh.triangles[triangle as usize][0] as usize]
}

#[test]
fn a_pattern_goes_on_around_the_upright_corners_of_a_box() {
    for specimen in patterns() {
        let mut on_mesh = on_own_mesh(&specimen.coarse, "cube", 384);
        let components = on_mesh.evaluate(&specimen.target()).components();
        for (name, values) in &components {
            let mut differences = [Vec::new(), Vec::new()];
            for seam in on_mesh.seams() {
                let normals = seam.triangles.map(|of| normal(&on_mesh, of));
                let is_upright = normals.iter().all(|normal| normal[1].abs() < 0.5);
                // Rows run to the right on the sides of x and z, and to the left on those opposite: where the two meet a cell
                // is seen as in a mirror, and a picture in it, which is not to be mirrored, begins anew.
                let [one, other] = normals.map(|normal| normal[0] + normal[2] > 0.0);
                if is_upright && name == "vector.x" && one != other {
                    continue;
                }
                for sample in 0..64 {
                    let along = (f64::from(sample) + 0.5) / 64.0;
                    let side = |side: usize| on_mesh.bilinear(values, seam.triangles[side], seam.weights(side, along));
                    differences[usize::from(is_upright)].push((side(0) - side(1)).abs());
                }
            }
            let [others, upright] = differences.map(|all| {
                assert!(!all.is_empty(), "the cube has upright corners and others");
                let many = all.len() as f64;
                all.into_iter().sum::<f64>() / many
            });
            let (low, high) = values
                .iter()
                .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), value| {
                    (low.min(*value), high.max(*value))
                });
            let range = f64::from(high - low);
            // A few samples lie on the border of a cell, which each side reads from its own texels.
            assert!(
                upright < 0.05 * range,
                "{} {name}: {upright:.4} of {range:.4} around upright corners, {others:.4} around others",
                specimen.name()
            );
        }
    }
}

#[test]
fn cells_cover_what_their_lengths_say() {
    for (kind, params, share) in [
        (
            "pattern/bricks",
            r#""length": 0.25, "row_height": 0.1, "joint": 0.02, "bevel": 0"#,
            0.92 * 0.8,
        ),
        (
            "pattern/bricks",
            r#""length": 0.25, "row_height": 0.1, "joint": 0.02, "bevel": 0, "bond": "stack", "uneven": 0"#,
            0.92 * 0.8,
        ),
        ("pattern/tiles", r#""width": 0.1, "joint": 0.02, "bevel": 0"#, 0.8 * 0.8),
        (
            "pattern/tiles",
            r#""width": 0.1, "joint": 0.02, "bevel": 0, "laid": "herringbone""#,
            0.8 * 0.9,
        ),
        (
            "pattern/tiles",
            r#""width": 0.1, "joint": 0.02, "bevel": 0, "laid": "basket""#,
            0.8 * 0.9,
        ),
        (
            "pattern/planks",
            r#""width": 0.1, "length": 0.5, "joint": 0.02, "bevel": 0"#,
            0.8 * 0.96,
        ),
        ("pattern/hex", r#""size": 0.1, "joint": 0.02, "bevel": 0"#, 0.64),
        ("pattern/weave", r#""size": 0.1, "thread": 0.8, "uneven": 0"#, 0.96),
        ("pattern/stripes", r#""size": 0.1, "width": 0.3"#, 0.3),
        ("pattern/grid", r#""size": 0.1, "width": 0.02"#, 0.36),
        ("pattern/checker", r#""size": 0.1"#, 0.5),
    ] {
        let mut means = Vec::new();
        // Cells of many texels, and cells that are far below one.
        for size in [512, 16] {
            let mut on_mesh = on_own_mesh(&graph(kind, params), "cube", size);
            let values = on_mesh.evaluate("node.mask").component("mask");
            let (sum, area) = on_mesh.areas().iter().fold((0.0, 0.0), |(sum, area), (index, own)| {
                (sum + own * f64::from(values[*index]), area + own)
            });
            means.push(sum / area);
        }
        for mean in means {
            assert!(
                (mean - share).abs() < 0.03,
                "{kind} {params}: {mean:.3} and not {share:.3}"
            );
        }
    }
}

#[test]
fn two_tiles_of_herringbone_never_share_a_square() {
    // Random values of cells: each tile of two squares has one, and neighbors others.
    let params = r#""width": 0.25, "joint": 0.05, "laid": "herringbone""#;
    let mut on_mesh = on_own_mesh(&graph("pattern/tiles", params), "cube", 256);
    let ids = on_mesh.evaluate("node.id").component("mask");
    let mask = on_mesh.evaluate("node.mask").component("mask");
    let mut areas = BTreeMap::<u32, f64>::new();
    // One side, since the others show the same tiles where they go on around its corners.
    let front: BTreeSet<usize> = on_mesh
        .owned()
        .filter(|(_, triangle)| normal(&on_mesh, *triangle)[2] > 0.5)
        .map(|(index, _)| index)
        .collect();
    for (index, area) in on_mesh.areas() {
        if mask[index] > 0.5 && front.contains(&index) {
            *areas.entry(ids[index].to_bits()).or_default() += area;
        }
    }
    // A whole tile is 0.2 by 0.45; those at corners are cut.
    let whole = 0.2 * 0.45;
    assert!(areas.len() > 6, "{} tiles", areas.len());
    assert!(areas.values().all(|area| *area < 1.2 * whole), "{areas:?}");
    let count = areas
        .values()
        .filter(|area| (**area - whole).abs() < 0.1 * whole)
        .count();
    assert!(count * 3 > areas.len(), "{count} of {} are whole", areas.len());
}

/// Widths of the joints along a line of texels in the middle of a plane that is tilted about one of its axes, measured on the
/// surface.
fn joint_share(degrees: f64, params: &str) -> f64 {
    let rise = degrees.to_radians().tan() as f32;
    let made = MeshFile::new(vec![Quad {
        corners: [[0.0, 0.0, 0.0], [1.0, 0.0, rise], [1.0, 1.0, rise], [0.0, 1.0, 0.0]],
        uvs: [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
    }]);
    let mut on_mesh = OnMesh::new(&graph("pattern/hex", params), made.write().path(), 1024);
    let away = on_mesh.evaluate("node.mask").component("mask");
    1.0 - on_mesh.mean(&away)
}

#[test]
fn joints_of_hexagons_are_as_wide_on_slopes_as_on_flat_ground() {
    // Two thirds of the sides of a hexagon lean, and run along a slope at another pace than the others. The share of joints is
    // their length in the pattern times their width: on a slope both the area and the sides have another length.
    let (size, joint) = (0.2, 0.03);
    for degrees in [0.0, 30.0, 45.0_f64] {
        for rotate in [0, 90] {
            let params = format!(r#""size": {size}, "joint": {joint}, "bevel": 0, "rotate": {rotate}"#);
            // The rows of a side that looks along z and against x run along x + z.
            let longer = 1.0 / (degrees.to_radians().cos() + degrees.to_radians().sin());
            // Lengths of the three pairs of sides in a hexagon with the rows along x, in sizes, as they lie on the slope.
            let side = 1.0 / 3.0_f64.sqrt();
            let (along, across) = if rotate == 0 { (longer, 1.0) } else { (1.0, longer) };
            let upright = side * across;
            let leaning = side * (0.75_f64 * along * along + 0.25 * across * across).sqrt();
            let border = upright + 2.0 * leaning;
            let area = 0.5 * 3.0_f64.sqrt() * along * across;
            // Corners, where joints meet, count once.
            let lines = border * joint / (size * area);
            let share = joint_share(degrees, &params);
            let corners = lines * lines / 4.0;
            assert!(
                (share - (lines - corners)).abs() < 0.012,
                "{share:.4} and not {:.4} at {degrees}°, turned by {rotate}°",
                lines - corners
            );
        }
    }
}

#[test]
fn uneven_bricks_differ_in_length_in_every_bond() {
    for bond in ["running", "stack", "third", "flemish", "english"] {
        let params = |uneven: f64| {
            format!(r#""bond": "{bond}", "length": 0.25, "row_height": 1.5, "joint": 0.004, "uneven": {uneven}"#)
        };
        // Half the length of a brick: what is left of its place in it where its uv is 1.
        let halves = |uneven: f64| -> BTreeSet<u32> {
            let mut on_mesh = on_own_mesh(&graph("pattern/bricks", &params(uneven)), "cube", 256);
            let [place, uv] = ["node.place", "node.uv"].map(|port| on_mesh.evaluate(port).component("vector.x"));
            let front = on_mesh
                .owned()
                .filter(|(_, triangle)| normal(&on_mesh, *triangle)[2] > 0.5);
            let far = front.filter(|(index, _)| (uv[*index] - 0.5).abs() > 0.2);
            far.map(|(index, _)| (500.0 * place[index] / (uv[index] - 0.5)).round() as u32)
                .collect()
        };
        let (even, uneven) = (halves(0.0).len(), halves(1.0).len());
        assert!(
            even <= 4 && uneven > even,
            "{bond}: {uneven} lengths and {even} where all are alike"
        );
    }
}

/// Areas of the cells of a pattern with these ids, for those that do not reach the ends of a tube of 64 sides.
fn areas_on_tube(kind: &str, params: &str) -> Vec<f64> {
    let made = MeshFile::new(sabi_tests::shapes::tube(64, 0.4)).write();
    let mut on_mesh = OnMesh::new(&graph(kind, params), made.path(), 1024);
    let id = on_mesh.evaluate("node.id").component("mask");
    let mut cells = BTreeMap::<u32, (f64, f64)>::new();
    for (index, area) in on_mesh.areas() {
        let cell = cells.entry(id[index].to_bits()).or_default();
        let high = on_mesh.position(index).expect("a place").y.abs();
        *cell = (cell.0 + area, cell.1.max(high));
    }
    let end = cells.values().map(|(_, high)| *high).fold(0.0, f64::max);
    let whole = cells.into_values().filter(|(_, high)| *high < end - 0.01);
    whole.map(|(area, _)| area).collect()
}

#[test]
fn patterns_around_a_tube_close_up_without_a_cut_cell() {
    let cases = [
        ("pattern/bricks", r#""length": 0.2, "row_height": 0.1, "uneven": 0"#),
        (
            "pattern/bricks",
            r#""length": 0.2, "row_height": 0.1, "uneven": 0, "bond": "third""#,
        ),
        (
            "pattern/bricks",
            r#""length": 0.2, "row_height": 0.1, "uneven": 0, "rotate": 90"#,
        ),
        ("pattern/tiles", r#""width": 0.1"#),
        ("pattern/tiles", r#""width": 0.06, "laid": "herringbone""#),
        ("pattern/tiles", r#""width": 0.06, "laid": "basket""#),
        ("pattern/hex", r#""size": 0.1"#),
        ("pattern/grid", r#""size": 0.1"#),
        ("pattern/checker", r#""size": 0.1, "rotate": 90"#),
    ];
    for (kind, params) in cases {
        let areas = areas_on_tube(kind, &format!(r#"{params}, "space": "around""#));
        assert!(areas.len() > 20, "{kind} {params}: {} cells", areas.len());
        let mean = areas.iter().sum::<f64>() / areas.len() as f64;
        let off = areas.iter().map(|area| (area / mean - 1.0).abs()).fold(0.0, f64::max);
        assert!(
            off < 0.12,
            "{kind} {params}: a cell of {off:.3} more or less than the mean"
        );
    }
    // On the sides of a box cells are cut where one side ends.
    let areas = areas_on_tube("pattern/tiles", r#""width": 0.1, "space": "piece""#);
    let mean = areas.iter().sum::<f64>() / areas.len() as f64;
    assert!(areas.iter().any(|area| (area / mean - 1.0).abs() > 0.3));
}

#[test]
fn tiles_on_a_ball_are_squares_at_its_equator_and_as_high_everywhere() {
    let made = MeshFile::new(sabi_tests::shapes::ball(0.5, 24)).write();
    let params = r#""width": 0.1, "joint": 0.02, "bevel": 0, "space": "ball""#;
    let mut on_mesh = OnMesh::new(&graph("pattern/tiles", params), made.path(), 512);
    let uv = on_mesh.evaluate("node.uv");
    let [right, up] = ["vector.x", "vector.y"].map(|name| uv.component(name));
    // Steps of the place across a tile for a step on the ball: the same height at every latitude.
    let (mut across, mut along) = (Vec::new(), Vec::new());
    for (one, other) in on_mesh.neighbors() {
        let [from, to] = [one, other].map(|index| on_mesh.position(index).expect("a place"));
        let latitude = |at: glam::DVec3| (at.y / at.length()).asin();
        let rise = 0.5 * (latitude(to) - latitude(from));
        let step = f64::from(up[other] - up[one]);
        if rise.abs() > 2e-4 && step.abs() < 0.5 && latitude(from).abs() < 1.3 {
            across.push(step / rise);
        }
        let around = |at: glam::DVec3| at.x.atan2(at.z);
        let turn = 0.5 * (around(to) - around(from));
        let step = f64::from(right[other] - right[one]);
        if turn.abs() > 2e-4 && turn.abs() < 0.1 && step.abs() < 0.5 && latitude(from).abs() < 0.1 {
            along.push(step / turn);
        }
    }
    for steps in [across, along] {
        assert!(steps.len() > 500);
        let mean = steps.iter().sum::<f64>() / steps.len() as f64;
        assert!((mean - 10.0).abs() < 0.6, "{mean} tiles for a length of 1");
    }
}

#[test]
fn a_pattern_by_texture_coordinates_lies_where_they_say() {
    // Turned by a right angle and mirrored on the sheet: the pattern follows the sheet, and pictures in it are seen as they are.
    let made = MeshFile::new(vec![Quad {
        corners: [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        uvs: [[0.1, 0.1], [0.1, 0.9], [0.9, 0.9], [0.9, 0.1]],
    }])
    .write();
    let mut on_mesh = OnMesh::new(
        &graph("pattern/grid", r#""size": 0.2, "space": "uv""#),
        made.path(),
        256,
    );
    let uv = on_mesh.evaluate("node.uv");
    let [x, y] = ["vector.x", "vector.y"].map(|name| uv.component(name));
    for (index, _) in on_mesh.owned() {
        let at = on_mesh.position(index).expect("a place");
        // u grows along y here, and v along x; cells are shifted, so that no joint lies along the middle.
        let (u, v) = (0.1 + 0.8 * at.y, 0.1 + 0.8 * at.x);
        let expected = [(u / 0.2 + 0.237).fract(), (-v / 0.2 + 0.137).rem_euclid(1.0)];
        for (is, expected) in [x[index], y[index]].into_iter().zip(expected) {
            let is_known = (0.01..0.99).contains(&expected);
            // A mirrored chart reads to the left.
            let off = (f64::from(is) - expected)
                .abs()
                .min((1.0 - f64::from(is) - expected).abs());
            assert!(!is_known || off < 2e-3, "{is} for {expected} at {at}");
        }
    }
}
