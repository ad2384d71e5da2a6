//! Outputs of patterns in addition to their masks: common outputs, distances to joints, and positions around a tube.

use std::collections::BTreeSet;

use sabi_nodes::Library;
use sabi_tests::{MeshFile, OnMesh, Quad};

use crate::patterns::graph;

#[test]
fn every_pattern_gives_the_same_results_of_its_cells() {
    let library = Library::builtin();
    let patterns = library.kinds().filter(|kind| kind.id.starts_with("pattern/"));
    let mut count = 0;
    for kind in patterns {
        let ports: BTreeSet<&str> = kind.outputs.iter().map(|output| output.name.as_str()).collect();
        for port in ["mask", "height", "id", "tilt", "away", "place", "uv"] {
            assert!(ports.contains(port), "{} has no result '{port}'", kind.id);
        }
        count += 1;
    }
    assert!(count >= 8, "{count} patterns");
}

/// A square from 0 to 1 that looks along z.
fn plane() -> MeshFile {
    MeshFile::new(vec![Quad {
        corners: [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        uvs: [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
    }])
}

#[test]
fn away_is_the_distance_to_the_joint_on_a_plane() {
    // From the nearest of regular borders, in lengths; cells are shifted so that no joint lies along the middle.
    let border = |at: f64, size: f64, shift: f64| {
        let place = (at / size + shift).rem_euclid(1.0);
        place.min(1.0 - place) * size
    };
    let grid = |x: f64, y: f64| (border(x, 0.25, 0.237).min(border(y, 0.25, 0.137)) - 0.015) / (0.125 - 0.015);
    let checker = |x: f64, y: f64| border(x, 0.2, 0.237).min(border(y, 0.4, 0.137)) / 0.1;
    // Stripes of 0.6 of the distance lie in the middle between borders, and begin 0.05 from them.
    let stripes = |_: f64, y: f64| (border(y, 0.25, 0.137) - 0.05) / 0.075;
    // The upper one of two threads, each in the middle of its row: even squares have the one along the row on top.
    let weave = |x: f64, y: f64| {
        let square = [(x / 0.25 + 0.237).floor(), (y / 0.25 + 0.137).floor()];
        let away = [(x, 0.237), (y, 0.137)].map(|(at, shift)| (border(at, 0.25, shift) - 0.025) / 0.1);
        let is_row_up = (square[0] + square[1]).rem_euclid(2.0) < 0.5;
        let [upper, lower] = if is_row_up { [away[1], away[0]] } else { away };
        if upper > 0.0 { upper } else { lower }
    };
    type Case<'c> = (&'c str, &'c str, &'c dyn Fn(f64, f64) -> f64);
    let cases: [Case<'_>; 4] = [
        ("pattern/grid", r#""size": 0.25, "width": 0.03"#, &grid),
        ("pattern/checker", r#""size": 0.2, "aspect": 2"#, &checker),
        ("pattern/stripes", r#""size": 0.25, "width": 0.6"#, &stripes),
        ("pattern/weave", r#""size": 0.25, "thread": 0.8, "uneven": 0"#, &weave),
    ];
    for (kind, params, expected) in cases {
        let mut on_mesh = OnMesh::new(&graph(kind, params), plane().write().path(), 256);
        let away = on_mesh.evaluate("node.away").component("mask");
        let (mut largest, mut off, mut count) = (0.0_f64, 0, 0);
        for (index, _) in on_mesh.owned() {
            let at = on_mesh.position(index).expect("a place");
            let difference = (f64::from(away[index]) - expected(at.x, at.y).clamp(0.0, 1.0)).abs();
            // Which thread lies on top is told to the middle of a texel.
            if kind == "pattern/weave" && difference > 1e-3 {
                off += 1;
            } else {
                largest = largest.max(difference);
            }
            count += 1;
        }
        assert!(
            largest < 1e-3 && off * 200 < count && count > 10_000,
            "{kind}: {largest}, and {off} of {count}"
        );
    }
}

#[test]
fn places_in_stripes_and_threads_close_up_around_a_tube() {
    let made = MeshFile::new(sabi_tests::shapes::tube(64, 0.4)).write();
    for kind in ["pattern/stripes", "pattern/weave"] {
        let params = r#""size": 0.2, "uneven": 0, "space": "around""#;
        let mut on_mesh = OnMesh::new(&graph(kind, params), made.path(), 512);
        let place = on_mesh.evaluate("node.place");
        let parts = ["vector.x", "vector.y", "vector.z"].map(|name| place.component(name));
        let id = on_mesh.evaluate("node.id").component("mask");
        let at = |index: usize| glam::DVec3::from(parts.each_ref().map(|part| f64::from(part[index])));
        let (mut behind, mut largest) = (0, 0.0_f64);
        for (one, other) in on_mesh.neighbors() {
            if id[one].to_bits() != id[other].to_bits() {
                continue;
            }
            let [from, to] = [one, other].map(|index| on_mesh.position(index).expect("a place"));
            // A step in the place is one on the tube.
            largest = largest.max(at(one).distance(at(other)) / from.distance(to));
            // Where the turn from the front ends: along z, by the order of the axes.
            let is_cut = [from.x * to.x, from.z * to.z].into_iter().any(|product| product <= 0.0);
            behind += usize::from(is_cut);
        }
        assert!(
            behind > 100 && largest < 1.1,
            "{kind}: a step is {largest} times as long; {behind} at quarters of a turn"
        );
    }
}
