//! Measured sizes of cracks, scratches and dots, on flat and on tilted planes.

use std::collections::BTreeMap;

use glam::{DVec3, dvec3};
use sabi_tests::{MadeMesh, MeshFile, OnMesh, Quad};

/// A square over x and y from 0 to 1 that rises along x.
fn plane(degrees: f64) -> MadeMesh {
    let rise = degrees.to_radians().tan() as f32;
    MeshFile::new(vec![Quad {
        corners: [[0.0, 0.0, 0.0], [1.0, 0.0, rise], [1.0, 1.0, rise], [0.0, 1.0, 0.0]],
        uvs: [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
    }])
    .write()
}

const SIZE: u32 = 512;
const TILTS: [f64; 3] = [0.0, 30.0, 40.0];

fn on_plane(degrees: f64, kind: &str, params: &str) -> OnMesh {
    let graph = format!(
        r#"{{ "format": "sabi", "version": 1, "nodes": {{ "noise": {{ "kind": "noise/{kind}", "params": {{ {params} }} }} }} }}"#
    );
    OnMesh::new(&graph, plane(degrees).path(), SIZE)
}

/// Area of a texel of the plane, and its longer side.
fn texel(degrees: f64) -> [f64; 2] {
    let side = 1.0 / f64::from(SIZE);
    let long = side / degrees.to_radians().cos();
    [side * long, long]
}

#[test]
fn a_crack_is_as_wide_on_a_tilted_plane_as_on_a_flat_one() {
    const PIECE: f64 = 0.25;
    for degrees in TILTS {
        for (width, fade) in [(0.012, 1), (0.012, 2), (0.012, 6), (0.001, 2)] {
            // Without jitter the walls are the planes between cubes.
            let straight = r#""levels": 1, "bend": 0, "breaks": 0, "uneven": 0"#;
            let params = format!(r#""size": {PIECE}, "width": {width}, "fade": {fade}, "jitter": 0, {straight}"#);
            let mut on_mesh = on_plane(degrees, "cracks", &params);
            let values = on_mesh.evaluate("noise").component("mask");
            let tilt = degrees.to_radians();
            let (mut inside, mut whole) = (0.0, 0.0);
            // A window across x around each wall, which contains no other wall.
            let half_window = 0.15;
            for (index, _) in on_mesh.owned() {
                let position = on_mesh.position(index).expect("an owned texel");
                let place = position / PIECE + dvec3(0.2713, 0.3137, 0.2299);
                let from_wall = place - place.round();
                let height_at_wall = place.z - from_wall.x * tilt.tan();
                let is_alone = from_wall.y.abs() > 0.2 && (height_at_wall - height_at_wall.round()).abs() > 0.2;
                if is_alone && from_wall.x.abs() < half_window * tilt.cos() {
                    inside += f64::from(values[index]);
                    whole += 1.0;
                }
            }
            assert!(whole > 2000.0, "{degrees} degrees: {whole} texels");
            let measured = inside / whole * 2.0 * half_window * PIECE;
            assert!(
                (measured - width).abs() < texel(degrees)[1].min(0.05 * width),
                "{degrees} degrees, fade {fade}: {measured:.5}, not {width}"
            );
        }
    }
}

/// Texels with one id: their places.
fn marks(on_mesh: &mut OnMesh) -> BTreeMap<u32, Vec<(usize, DVec3)>> {
    let ids = on_mesh.evaluate("noise.id").component("mask");
    let mut marks: BTreeMap<u32, Vec<(usize, DVec3)>> = BTreeMap::new();
    for (index, _) in on_mesh.owned() {
        if ids[index] > 0.0 {
            let position = on_mesh.position(index).expect("an owned texel");
            marks.entry(ids[index].to_bits()).or_default().push((index, position));
        }
    }
    marks
}

/// Longest extent of a mark: its two ends.
fn ends(mark: &[(usize, DVec3)]) -> [DVec3; 2] {
    let furthest = |from: DVec3| {
        let distance = |(_, at): &&(usize, DVec3)| at.distance_squared(from);
        mark.iter()
            .max_by(|a, b| distance(a).total_cmp(&distance(b)))
            .map_or(from, |(_, at)| *at)
    };
    let one = furthest(mark[0].1);
    [one, furthest(one)]
}

#[test]
fn scratches_are_as_long_and_as_wide_as_asked_for() {
    let (length, width) = (0.25, 0.012);
    for degrees in TILTS {
        let params = format!(r#""density": 0.3, "length": {length}, "width": {width}, "bend": 0"#);
        let mut on_mesh = on_plane(degrees, "scratches", &params);
        let directions = on_mesh.evaluate("noise.direction");
        let directions = ["vector.x", "vector.y", "vector.z"].map(|name| directions.component(name));
        let [area, side] = texel(degrees);
        let (mut longest, mut widest) = (0.0_f64, 0.0_f64);
        let (mut along, mut across) = (0, 0);
        for mark in marks(&mut on_mesh).values() {
            let [from, to] = ends(mark);
            let extent = from.distance(to);
            // Part of a scratch that is covered by others, or a scratch that leaves the plane.
            if extent < 0.1 {
                continue;
            }
            longest = longest.max(extent);
            let axis = (to - from) / extent;
            let share = |at: DVec3| (at - from).dot(axis) / extent;
            let middle: Vec<usize> = mark
                .iter()
                .filter(|(_, at)| (share(*at) - 0.5).abs() < 0.1)
                .map(|(index, _)| *index)
                .collect();
            widest = widest.max(middle.len() as f64 * area / (0.2 * extent));
            for index in middle {
                let direction = DVec3::from(directions.each_ref().map(|values| f64::from(values[index])));
                let is_along = direction.dot(axis).abs() > 0.98 * direction.length();
                *(if is_along { &mut along } else { &mut across }) += 1;
            }
        }
        assert!(
            longest < length + 2.0 * side && longest > 0.9 * length,
            "{degrees} degrees: the longest is {longest:.4}"
        );
        assert!(
            widest < width + side && widest > 0.8 * width,
            "{degrees} degrees: the widest is {widest:.5}"
        );
        // Where two cross, their ways are mixed.
        assert!(
            along > 1000 && across < along / 10,
            "{degrees} degrees: {along} and {across}"
        );
    }
}

#[test]
fn scratches_follow_the_way_that_they_are_led() {
    // Along the plane.
    let toward = dvec3(1.0, 0.4, 30.0_f64.to_radians().tan()).normalize();
    let [x, y, z] = toward.to_array();
    // A disk that leans over as far as one may, 17 degrees above the surface, triples the angle.
    for (spread, allowed) in [(0.0, 1.0), (20.0, 36.0)] {
        let graph = format!(
            r#"{{ "format": "sabi", "version": 1, "nodes": {{ "noise": {{ "kind": "noise/scratches",
                "params": {{ "toward": [{x}, {y}, {z}],
                "spread": {spread}, "bend": 0, "length": 0.2, "density": 1 }} }} }} }}"#
        );
        let mut on_mesh = OnMesh::new(&graph, plane(30.0).path(), SIZE);
        let normal = dvec3(-0.5, 0.0, 30.0_f64.to_radians().cos());
        let way = (toward - normal * toward.dot(normal)).normalize();
        let directions = on_mesh.evaluate("noise.direction");
        let directions = ["vector.x", "vector.y", "vector.z"].map(|name| directions.component(name));
        let mut count = 0;
        let mut strays = 0.0_f64;
        for (index, _) in on_mesh.owned() {
            let direction = DVec3::from(directions.each_ref().map(|values| f64::from(values[index])));
            if direction.length() > 0.5 {
                count += 1;
                let angle = direction.normalize().dot(way).abs().min(1.0).acos();
                strays = strays.max(angle.to_degrees());
            }
        }
        assert!(count > 500, "{count} texels");
        assert!(strays < allowed, "spread {spread}: up to {strays:.2} degrees");
        assert!(
            spread == 0.0 || strays > 3.0,
            "spread {spread}: only {strays:.2} degrees"
        );
    }
}

#[test]
fn dots_are_round_of_one_size_and_apart() {
    let (size, spacing) = (0.03, 0.08);
    for degrees in TILTS {
        let params = format!(r#""size": {size}, "spacing": {spacing}, "variation": 0, "sharpness": 1"#);
        let mut on_mesh = on_plane(degrees, "dots", &params);
        let values = on_mesh.evaluate("noise").component("mask");
        let marks = marks(&mut on_mesh);
        let [area, side] = texel(degrees);
        let plane = 1.0 / degrees.to_radians().cos();
        // Dots beyond the border reach in, and where another dot leaves little room a small rest of one stays.
        let expected = plane / (spacing * spacing);
        let count = marks.len() as f64;
        assert!(
            (count / expected - 1.1).abs() < 0.2,
            "{degrees} degrees: {count}, not {expected:.0}"
        );
        let mut whole = 0;
        for mark in marks.values() {
            let [from, to] = ends(mark);
            assert!(
                from.distance(to) < size + side,
                "{degrees} degrees: {}",
                from.distance(to)
            );
            let round = mark.len() as f64 * area / (0.25 * std::f64::consts::PI * size * size);
            whole += usize::from((round - 1.0).abs() < 0.1);
        }
        // The rest lie at the border of the plane, or of the slab that the dots come from.
        assert!(
            whole as f64 > 0.6 * count,
            "{degrees} degrees: {whole} of {count} are whole"
        );
        // A border widened to a texel takes a little from the middle, so that the area stays.
        let full = on_mesh.owned().filter(|(index, _)| values[*index] > 0.995).count();
        assert!(
            full as f64 * area > 0.8 * count * 0.2 * size * size,
            "{full} texels are full"
        );
    }
}

#[test]
fn no_setting_makes_all_dots_vanish() {
    for sharpness in [0.0, 0.5, 1.0] {
        for variation in [0.0, 1.0] {
            for size in [0.002, 0.02, 1.0] {
                let params = format!(r#""size": {size}, "sharpness": {sharpness}, "variation": {variation}"#);
                let mut on_mesh = on_plane(0.0, "dots", &params);
                let values = on_mesh.evaluate("noise").component("mask");
                let highest = on_mesh.owned().map(|(index, _)| values[index]).fold(0.0, f32::max);
                assert!(highest > 0.3, "{params}: {highest}");
            }
        }
    }
}

#[test]
fn stamps_over_one_another_are_whole_wherever_their_shape_lies() {
    // Rings of twice their spacing: dozens of circles lie over each place, of which few cover it.
    let params = r#""shape": "ring", "size": 0.2, "spacing": 0.05, "overlap": 1, "soft": 0"#;
    let graph = format!(
        r#"{{ "format": "sabi", "version": 1, "nodes": {{ "stamp": {{ "kind": "scatter/stamp", "params": {{ {params} }} }} }} }}"#
    );
    let mut on_mesh = OnMesh::new(&graph, plane(0.0).path(), SIZE);
    let away = on_mesh.evaluate("stamp.away").component("mask");
    // The nearest outline of all cannot be much further away from one texel than from the next one.
    let texel = 1.0 / SIZE as f32;
    let steps = on_mesh
        .neighbors()
        .into_iter()
        .map(|(one, other)| (away[other] - away[one]).abs());
    let largest = steps.fold(0.0_f32, f32::max);
    assert!(largest < 1.05 * texel, "{largest} in a step of {texel}");
    let mask = on_mesh.evaluate("stamp").component("mask");
    let torn = on_mesh
        .owned()
        .filter(|(index, _)| away[*index] > texel && mask[*index] < 0.99)
        .count();
    assert_eq!(torn, 0, "places inside of a ring that shows nothing");
}

#[test]
fn a_crack_keeps_its_width_where_a_moved_position_stretches_the_pattern() {
    // Half as fast, twice and three times as fast: the net has another size, and its cracks are as wide.
    let (size, width) = (0.2, 0.012);
    let straight = r#""levels": 1, "bend": 0, "breaks": 0, "uneven": 0, "fade": 1"#;
    for factor in [0.5, 2.0, 3.0] {
        let graph = format!(
            r#"{{ "format": "sabi", "version": 1, "nodes": {{
                "place": {{ "kind": "surface/position" }},
                "moved": {{ "kind": "math/vector", "inputs": {{ "a": "place.position" }},
                    "params": {{ "operation": "scale", "factor": {factor} }} }},
                "warped": {{ "kind": "noise/cracks", "inputs": {{ "position": "moved" }},
                    "params": {{ "size": {}, "width": {width}, {straight} }} }},
                "plain": {{ "kind": "noise/cracks", "params": {{ "size": {size}, "width": {width}, {straight} }} }} }} }}"#,
            size * factor
        );
        let mut on_mesh = OnMesh::new(&graph, plane(0.0).path(), SIZE);
        let [warped, plain] = ["warped", "plain"].map(|node| on_mesh.evaluate(node).component("mask"));
        let [is, expected] = [&warped, &plain].map(|mask| on_mesh.mean(mask));
        assert!(expected > 0.02, "the plane has cracks: {expected}");
        assert!(
            (is - expected).abs() < 0.05 * expected,
            "{is} for {expected} at {factor}"
        );
    }
}
