//! Wide filters on a body of a hundred charts, compared with another unwrap of it and with heat flow over its triangles.

use std::collections::BTreeMap;

use sabi_tests::{MadeMesh, MeshFile, NodeFolder, OnMesh, Quad, project, range};

/// Quads along a side of each face of the cube that the body was blown up from.
const QUADS: usize = 32;
const SIZE: u32 = 512;

/// Point of the body, at `[s, t]` from -1 to 1 on a face of the cube: a ball with dents and a waist.
fn body(face: usize, [s, t]: [f64; 2]) -> [f32; 3] {
    let sign = if face.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut place = [0.0; 3];
    place[face / 2] = sign;
    place[(face / 2 + 1) % 3] = (s * std::f64::consts::FRAC_PI_4).tan() * sign;
    place[(face / 2 + 2) % 3] = (t * std::f64::consts::FRAC_PI_4).tan();
    let length = place.map(|x| x * x).iter().sum::<f64>().sqrt();
    let [x, y, z] = place.map(|x| x / length);
    let radius = 0.5 - 0.12 * (-8.0 * y * y).exp() + 0.05 * (5.0 * x).sin() * (4.0 * z).cos();
    // Rounded, so that what two faces share is at the same place.
    [x, y, z].map(|x| ((x * radius * 65536.0).round() / 65536.0) as f32)
}

/// The body, each face of the cube cut into `blocks × blocks` charts, which are turned by what looks like chance, every third
/// of them mirrored.
fn charts(blocks: usize) -> MadeMesh {
    let number = 6 * blocks * blocks;
    let columns = (number as f64).sqrt().ceil() as usize;
    let cell = 1.0 / columns as f64;
    let mut quads = Vec::new();
    for face in 0..6 {
        for row in 0..QUADS {
            for column in 0..QUADS {
                let at = |x: usize, y: usize| [x, y].map(|at| 2.0 * at as f64 / QUADS as f64 - 1.0);
                let corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[x, y]| [column + x, row + y]);
                let block = [column, row].map(|at| at * blocks / QUADS);
                let chart = (face * blocks + block[1]) * blocks + block[0];
                let first = block.map(|block| (block * QUADS).div_ceil(blocks));
                let end = block.map(|block| ((block + 1) * QUADS).div_ceil(blocks));
                let (sine, cosine) = (chart as f64 * 2.399).sin_cos();
                let center = [chart % columns, chart / columns].map(|at| (at as f64 + 0.5) * cell);
                let uv = |[x, y]: [usize; 2]| {
                    let inside = |at: usize, axis: usize| {
                        let middle = 0.5 * (first[axis] + end[axis]) as f64;
                        (at as f64 - middle) / (QUADS as f64 / blocks as f64) * cell * 0.62
                    };
                    let [u, v] = [inside(x, 0), inside(y, 1)];
                    let u = if chart.is_multiple_of(3) { -u } else { u };
                    [center[0] + cosine * u - sine * v, center[1] + sine * u + cosine * v].map(|value| value as f32)
                };
                quads.push(Quad {
                    corners: corners.map(|[x, y]| body(face, at(x, y))),
                    uvs: corners.map(uv),
                });
            }
        }
    }
    MeshFile::new(quads).write()
}

/// Inputs of a node that filters the noise.
const OF_NOISE: &str = r#""source": "noise""#;

/// A graph with a noise, the same as bumps, and these nodes.
fn graph_of(nodes: &str) -> String {
    format!(
        r#"{{ "format": "sabi", "version": 1, "nodes": {{
            "noise": {{ "kind": "noise/simplex", "params": {{ "size": 0.3, "octaves": 3 }} }},
            "bumps": {{ "kind": "adjust/levels", "inputs": {{ "source": "noise" }}, "params": {{ "high": 0.05 }} }},
            {nodes} }} }}"#
    )
}

/// A graph with a filter of the noise, `wide`.
fn graph(filter: &str) -> String {
    graph_of(&format!(r#""wide": {{ {filter}, "inputs": {{ {OF_NOISE} }} }}"#))
}

/// Values at the corners of the body, by place: the mean of what all charts have there.
fn at_corners(on_mesh: &OnMesh, values: &[f32]) -> BTreeMap<[u32; 3], f64> {
    let mesh = &on_mesh.evaluator.linked().model.mesh;
    let mut sums: BTreeMap<[u32; 3], (f64, f64)> = BTreeMap::new();
    for (number, triangle) in (0..).zip(&mesh.triangles) {
        for (corner, vertex) in triangle.iter().enumerate() {
            let weights = std::array::from_fn(|at| if at == corner { 1.0 } else { 0.0 });
            let sum = sums.entry(key(mesh.positions[*vertex as usize])).or_default();
            sum.0 += on_mesh.bilinear(values, number, weights);
            sum.1 += 1.0;
        }
    }
    sums.into_iter().map(|(at, (sum, count))| (at, sum / count)).collect()
}

/// Values in the middles of the triangles, by place.
fn at_middles(on_mesh: &OnMesh, values: &[f32]) -> BTreeMap<[u32; 3], f64> {
    let mesh = &on_mesh.evaluator.linked().model.mesh;
    let middle = |triangle: &[u32; 3]| {
        let sum = |axis: usize| {
            triangle
                .iter()
                .map(|vertex| mesh.positions[*vertex as usize][axis])
                .sum()
        };
        std::array::from_fn(sum)
    };
    let numbered = (0..).zip(&mesh.triangles);
    let valued =
        numbered.map(|(number, triangle)| (key(middle(triangle)), on_mesh.bilinear(values, number, [1.0 / 3.0; 3])));
    valued.collect()
}

fn key(position: [f32; 3]) -> [u32; 3] {
    // Zero has two signs.
    position.map(|x| (x + 0.0).to_bits())
}

/// Root mean square of the difference as a share of the range of the first.
fn difference(one: &BTreeMap<[u32; 3], f64>, other: &BTreeMap<[u32; 3], f64>) -> f64 {
    assert_eq!(one.len(), other.len());
    let squares: f64 = one.values().zip(other.values()).map(|(a, b)| (a - b) * (a - b)).sum();
    (squares / one.len() as f64).sqrt()
        / range(
            one.values()
                .map(|value| *value as f32)
                .fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], value| {
                    [low.min(value), high.max(value)]
                }),
        )
}

#[test]
fn wide_filters_are_the_same_on_two_unwraps_of_a_hundred_charts() {
    let meshes = [4, 5].map(charts);
    for node in [
        r#""kind": "filter/blur", "params": { "radius": 0.05 }"#,
        r#""kind": "filter/blur", "params": { "radius": 0.1 }"#,
        r#""kind": "filter/blur", "params": { "radius": 0.2 }"#,
        r#""kind": "filter/blur", "params": { "radius": 0.4 }"#,
        r#""kind": "filter/sharpen", "params": { "radius": 0.1 }"#,
        r#""kind": "filter/distance", "params": { "width": 0.2 }"#,
    ] {
        let [one, other] = meshes.each_ref().map(|mesh| {
            let mut on_mesh = OnMesh::new(&graph(node), mesh.path(), SIZE);
            let values = on_mesh.evaluate("wide").component("mask");
            at_corners(&on_mesh, &values)
        });
        let rms = difference(&one, &other);
        assert!(rms < 0.01, "{node} differs by {rms} of its range");
    }
}

#[test]
fn patterns_marks_and_masks_are_the_same_on_two_unwraps_of_a_hundred_charts() {
    // Those with borders about a texel wide, or of slopes over a texel, may differ by twice as much.
    let all = [
        ("cells", r#""kind": "noise/cells", "params": { "size": 0.2 }"#, "", 0.01),
        (
            "occlusion",
            r#""kind": "surface/occlusion", "params": { "distance": 0.3, "rays": 128 }"#,
            "",
            0.01,
        ),
        (
            "distance",
            r#""kind": "filter/distance", "params": { "width": 0.1 }"#,
            OF_NOISE,
            0.01,
        ),
        (
            "coverage",
            r#""kind": "adjust/coverage", "params": { "amount": 0.3 }"#,
            OF_NOISE,
            0.02,
        ),
        ("streak", r#""kind": "filter/streak""#, OF_NOISE, 0.02),
        (
            "grow",
            r#""kind": "filter/grow", "params": { "radius": 0.05 }"#,
            OF_NOISE,
            0.02,
        ),
        (
            "edges",
            r#""kind": "relief/edges", "params": { "width": 0.05 }"#,
            r#""height": "bumps""#,
            0.02,
        ),
        (
            "scratches",
            r#""kind": "noise/scratches", "params": { "width": 0.03 }"#,
            "",
            0.02,
        ),
    ];
    let nodes = all.map(|(name, node, inputs, _)| format!(r#"{name:?}: {{ {node}, "inputs": {{ {inputs} }} }}"#));
    let results = [4, 5].map(|blocks| {
        let mesh = charts(blocks);
        let mut on_mesh = OnMesh::new(&graph_of(&nodes.join(",")), mesh.path(), 2 * SIZE);
        all.map(|(name, ..)| {
            let values = on_mesh.evaluate(name).component("mask");
            at_middles(&on_mesh, &values)
        })
    });
    let [first, second] = &results;
    for ((name, _, _, most), (one, other)) in all.iter().zip(first.iter().zip(second)) {
        let rms = difference(one, other);
        assert!(rms < *most, "{name} differs by {rms} of its range");
    }
}

#[test]
fn a_survey_in_slices_measures_each_of_a_hundred_charts_as_in_one() {
    let coverage = std::fs::read_to_string(project("shaders/nodes/adjust/coverage.wgsl")).expect("a node");
    // So much to compute that the first slice has 64 charts.
    let rounds = "var x = params.amount;\n    for (var i = 0; i < 30000; i++) { x = fract(sin(x) + 1.3); }\n    return max(x - 100.0, 0.0) + survey";
    let slow = coverage.replacen("return survey", rounds, 1);
    assert_ne!(slow, coverage);
    let nodes = NodeFolder::new(&[("own/slow", &slow)]);
    let params = r#""inputs": { "source": "noise" }, "params": { "each": "chart" }"#;
    let graph = graph_of(&format!(
        r#""quick": {{ "kind": "adjust/coverage", {params} }}, "slow": {{ "kind": "own/slow", {params} }}"#
    ));
    let mesh = charts(5);
    let mut on_mesh = OnMesh::with_kinds(&graph, nodes.kinds(), mesh.path(), SIZE);
    let [quick, slow] = ["quick", "slow"].map(|name| on_mesh.evaluate(name).component("mask"));
    assert!(quick.iter().any(|value| *value > 0.5));
    assert_eq!(quick, slow);
}

/// A symmetric matrix over the corners of the body, and the area of each.
struct Flow {
    rows: Vec<Vec<(usize, f64)>>,
    areas: Vec<f64>,
}

impl Flow {
    /// The cotangent Laplacian of the triangles of a mesh (Pinkall, Polthier 1993), its vertices joined by place.
    fn of(on_mesh: &OnMesh, numbers: &BTreeMap<[u32; 3], usize>) -> Flow {
        let mesh = &on_mesh.evaluator.linked().model.mesh;
        let mut rows = vec![BTreeMap::<usize, f64>::new(); numbers.len()];
        let mut areas = vec![0.0; numbers.len()];
        for triangle in &mesh.triangles {
            let places = triangle.map(|vertex| mesh.positions[vertex as usize]);
            let own = places.map(|place| numbers[&key(place)]);
            for corner in 0..3 {
                let [at, from, to] = [0, 1, 2].map(|step| (corner + step) % 3);
                let side = |end: usize| -> [f64; 3] {
                    std::array::from_fn(|axis| f64::from(places[end][axis]) - f64::from(places[at][axis]))
                };
                let [a, b] = [side(from), side(to)];
                let dot: f64 = (0..3).map(|axis| a[axis] * b[axis]).sum();
                let [aa, bb] = [a, b].map(|v| v.iter().map(|x| x * x).sum::<f64>());
                let twice = (aa * bb - dot * dot).max(0.0).sqrt();
                areas[own[at]] += twice / 6.0;
                let weight = 0.5 * dot / twice.max(1e-12);
                for [from, to] in [[own[from], own[to]], [own[to], own[from]]] {
                    *rows[from].entry(to).or_default() += weight;
                }
            }
        }
        let rows = rows.into_iter().map(|row| row.into_iter().collect()).collect();
        Flow { rows, areas }
    }

    /// `areas × values + time × (what flows away)`.
    fn step_back(&self, values: &[f64], time: f64) -> Vec<f64> {
        let of_row = |(at, row): (usize, &Vec<(usize, f64)>)| {
            let flow: f64 = row
                .iter()
                .map(|(other, weight)| weight * (values[at] - values[*other]))
                .sum();
            self.areas[at] * values[at] + time * flow
        };
        self.rows.iter().enumerate().map(of_row).collect()
    }

    /// An implicit step of time, by conjugate gradients.
    fn step(&self, values: &[f64], time: f64) -> Vec<f64> {
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let mut found = values.to_vec();
        let mut rest: Vec<f64> = values
            .iter()
            .zip(&self.areas)
            .map(|(value, area)| value * area)
            .collect();
        let back = self.step_back(&found, time);
        rest.iter_mut().zip(&back).for_each(|(rest, back)| *rest -= back);
        let mut way = rest.clone();
        let mut square = dot(&rest, &rest);
        for _ in 0..500 {
            if square < 1e-20 {
                break;
            }
            let back = self.step_back(&way, time);
            let length = square / dot(&way, &back);
            found
                .iter_mut()
                .zip(&way)
                .for_each(|(found, way)| *found += length * way);
            rest.iter_mut()
                .zip(&back)
                .for_each(|(rest, back)| *rest -= length * back);
            let next = dot(&rest, &rest);
            way.iter_mut()
                .zip(&rest)
                .for_each(|(way, rest)| *way = rest + next / square * *way);
            square = next;
        }
        found
    }
}

#[test]
fn a_blur_is_heat_that_flows_over_the_triangles() {
    let mesh = charts(4);
    for radius in [0.05, 0.1, 0.2] {
        let node = format!(r#""kind": "filter/blur", "params": {{ "radius": {radius} }}"#);
        let mut on_mesh = OnMesh::new(&graph(&node), mesh.path(), SIZE);
        let [noise, blurred] = ["noise", "wide"].map(|node| {
            let values = on_mesh.evaluate(node).component("mask");
            at_corners(&on_mesh, &values)
        });
        let numbers: BTreeMap<[u32; 3], usize> = noise.keys().copied().zip(0..).collect();
        let flow = Flow::of(&on_mesh, &numbers);
        let largest_side = on_mesh.evaluator.linked().largest_side;
        let time = 0.5 * (radius * largest_side).powi(2);
        // Half the error of a step is that of two halves of it: their double less it has none of first order.
        let steps = |count: u32| {
            let start: Vec<f64> = noise.values().copied().collect();
            (0..count).fold(start, |values, _| flow.step(&values, time / f64::from(count)))
        };
        let heat = steps(48)
            .into_iter()
            .zip(steps(24))
            .map(|(fine, coarse)| 2.0 * fine - coarse);
        let heat = noise.keys().copied().zip(heat).collect();
        let rms = difference(&heat, &blurred);
        assert!(rms < 0.01, "a blur of {radius} differs from heat by {rms} of its range");
    }
}
