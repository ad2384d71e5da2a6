//! Field nodes: reading across a seam gives the values on the other side.

use sabi_tests::{MadeMesh, MeshFile, NodeResult, OnMesh, Quad, extent, project};

/// Smoothing of `source`, `steps` times.
fn smoothing(source: &str, steps: u32) -> String {
    format!(
        r#"{{ "format": "sabi", "version": 1, "nodes": {{
            "source": {source},
            "smooth": {{ "kind": "filter/smooth", "inputs": {{ "source": "source" }}, "params": {{ "steps": {steps} }} }} }} }}"#
    )
}

fn constant(value: f32) -> String {
    format!(r#"{{ "kind": "adjust/levels", "params": {{ "low": {value}, "high": {value} }} }}"#)
}

fn on_model(graph: &str, mesh: &str, size: u32) -> (OnMesh, NodeResult) {
    let mut on_mesh = OnMesh::new(graph, &project(&format!("assets/meshes/{mesh}.glb")), size);
    let evaluated = on_mesh.evaluate("smooth");
    (on_mesh, evaluated)
}

#[test]
fn an_even_mask_stays_as_it_is_to_the_last_bit() {
    for mesh in ["cube", "sphere", "figure"] {
        for value in [0.3, 1.0, 0.123_456_79] {
            let (on_mesh, evaluated) = on_model(&smoothing(&constant(value), 24), mesh, 64);
            let values = evaluated.component("mask");
            for index in on_mesh.covered() {
                let texel = on_mesh.texel(index);
                assert_eq!(values[index].to_bits(), value.to_bits(), "{mesh}, texel {texel:?}");
            }
        }
    }
}

#[test]
fn smoothing_makes_nothing_lower_or_higher_than_it_was() {
    let source = r#"{ "kind": "noise/white", "params": { "size": 0.08, "seed": 3 } }"#;
    for mesh in ["cube", "sphere"] {
        let (mut on_mesh, evaluated) = on_model(&smoothing(source, 8), mesh, 64);
        let before = on_mesh.evaluate("source").component("mask");
        let after = evaluated.component("mask");
        let covered: Vec<usize> = on_mesh.covered().collect();
        let [low, high] = extent(covered.iter().map(|index| before[*index]));
        let [lower, higher] = extent(covered.iter().map(|index| after[*index]));
        assert!(low < lower && higher < high, "{mesh}: {low} {lower} {higher} {high}");
    }
}

/// Texels for one unit of UV of the strips.
const STRIP_SIZE: u32 = 64;

/// A strip of 1 by 0.25 in the plane z = 0: one face for all of it, or two, of which the second one's texture coordinates
/// are given. A texel is 1/64 wide in all of them.
fn strip(second: Option<[[f32; 2]; 4]>) -> MadeMesh {
    let face = |from: f32, to: f32, uvs: [[f32; 2]; 4]| Quad {
        corners: [[from, 0.0, 0.0], [to, 0.0, 0.0], [to, 0.25, 0.0], [from, 0.25, 0.0]],
        uvs,
    };
    let straight = |from: f32, to: f32| [[from, 0.25], [to, 0.25], [to, 0.0], [from, 0.0]];
    let quads = match second {
        None => vec![face(0.0, 1.0, straight(0.0, 1.0))],
        Some(uvs) => vec![face(0.0, 0.5, straight(0.0, 0.5)), face(0.5, 1.0, uvs)],
    };
    MeshFile::new(quads).write()
}

/// The result at the middle of every texel of the uncut strip, row by row.
fn along_the_strip(mesh: &MadeMesh, graph: &str) -> Vec<f64> {
    let mut on_mesh = OnMesh::new(graph, mesh.path(), STRIP_SIZE);
    let values = on_mesh.evaluate("smooth").component("mask");
    let is_cut = on_mesh.evaluator.linked().model.mesh.triangles.len() > 2;
    let texel = 1.0 / f64::from(STRIP_SIZE);
    let mut read = Vec::new();
    for row in 0..STRIP_SIZE / 4 {
        for column in 0..STRIP_SIZE {
            let (x, y) = ((f64::from(column) + 0.5) * texel, (f64::from(row) + 0.5) * texel);
            let (face, from, width) = match (is_cut, x < 0.5) {
                (false, _) => (0, 0.0, 1.0),
                (true, true) => (0, 0.0, 0.5),
                (true, false) => (1, 0.5, 0.5),
            };
            let (s, t) = ((x - from) / width, y / 0.25);
            // The corners of the first triangle of a face are 0 1 2, of the second 0 2 3.
            let (triangle, weights) = if s >= t {
                (2 * face, [1.0 - s, s - t, t])
            } else {
                (2 * face + 1, [1.0 - t, s, t - s])
            };
            read.push(on_mesh.bilinear(&values, triangle, weights));
        }
    }
    read
}

/// Texture coordinates of a point of the strip's second half.
type UvLayout = fn([f32; 2]) -> [f32; 2];

#[test]
fn a_strip_that_is_cut_is_smoothed_like_the_whole_one() {
    let noise = r#"{ "kind": "noise/simplex", "params": { "size": 0.12, "octaves": 1, "seed": 2 } }"#;
    let graph = smoothing(noise, 12);
    let whole = along_the_strip(&strip(None), &graph);
    let corners = [[0.0, 0.0], [0.5, 0.0], [0.5, 0.25], [0.0, 0.25]];
    // Moved by whole texels, turned by a quarter, mirrored.
    let layouts: [(&str, UvLayout); 3] = [
        ("moved", |[x, y]| [x + 0.125, 0.75 - y]),
        ("turned", |[x, y]| [y + 0.125, 0.375 + x]),
        ("mirrored", |[x, y]| [0.75 - x, 0.75 - y]),
    ];
    for (name, layout) in layouts {
        let cut = along_the_strip(&strip(Some(corners.map(layout))), &graph);
        let largest = whole.iter().zip(&cut).map(|(one, other)| (one - other).abs());
        let largest = largest.fold(0.0, f64::max);
        assert!(largest < 1e-4, "{name}: {largest}");
    }
}

/// Two arms side by side on a back, in one chart with `gap` of UV between the arms. In space one arm is bent forward and the
/// other backward.
fn fork(gap: f32) -> MadeMesh {
    let quad = |[left, right]: [f32; 2], [top, bottom]: [f32; 2], bend: f32| {
        let corners = [[left, bottom], [right, bottom], [right, top], [left, top]];
        Quad {
            corners: corners.map(|[x, y]| [x, y, bend * (0.75 - y).max(0.0)]),
            uvs: corners.map(|[x, y]| [x + 0.1, y]),
        }
    };
    let (left, middle, right) = ([0.0, 0.25], [0.25, 0.25 + gap], [0.25 + gap, 0.5 + gap]);
    let mut quads = vec![
        quad(left, [0.75, 1.0], 0.0),
        quad(middle, [0.75, 1.0], 0.0),
        quad(right, [0.75, 1.0], 0.0),
    ];
    for row in 0..3_u8 {
        let top = 0.25 * f32::from(row);
        quads.push(quad(left, [top, top + 0.25], 0.6));
        quads.push(quad(right, [top, top + 0.25], -0.6));
    }
    MeshFile::new(quads).write()
}

#[test]
fn nothing_flows_over_a_narrow_gap_of_a_chart() {
    const SIZE: f32 = 128.0;
    for texels in [0.3, 1.0, 2.0, 3.5] {
        let gap = texels / SIZE;
        let step = (0.25 + gap / 2.0) / (0.5 + gap);
        let source = format!(
            r#"{{ "kind": "surface/position", "params": {{ "along": [1, 0, 0], "low": {step}, "high": {step} }} }}"#
        );
        let mut on_mesh = OnMesh::new(&smoothing(&source, 8), fork(gap).path(), SIZE as u32);
        let values = on_mesh.evaluate("smooth").component("mask");
        let mut counted = [0, 0];
        for index in on_mesh.covered() {
            let place = on_mesh.position(index).unwrap();
            // Further than eight steps from the back.
            if place.y < 0.6 {
                let arm = usize::from(place.x > 0.25 + f64::from(gap) / 2.0);
                assert_eq!(values[index], arm as f32, "{texels} texels apart, at {place}");
                counted[arm] += 1;
            }
        }
        assert!(counted.iter().all(|count| *count > 2000), "{counted:?}");
    }
}

/// Means of a node's mask on each arm of a fork, for sixteen heights of the arm.
fn means_of_arms(node: &str, gap: f32) -> [[f64; 16]; 2] {
    let graph = format!(
        r#"{{ "format": "sabi", "version": 1, "nodes": {{
            "height": {{ "kind": "surface/position", "params": {{ "along": [0, 1, 0], "low": 0, "high": 1 }} }},
            "node": {node} }} }}"#
    );
    let mut on_mesh = OnMesh::new(&graph, fork(gap).path(), 256);
    let values = on_mesh.evaluate("node").component("mask");
    let mut sums = [[[0.0; 2]; 16]; 2];
    for index in on_mesh.covered() {
        let place = on_mesh.position(index).expect("an owned texel");
        if place.y < 0.75 {
            let arm = usize::from(place.x > 0.25 + f64::from(gap) / 2.0);
            let [sum, count] = &mut sums[arm][(place.y * 16.0 / 0.75) as usize];
            *sum += f64::from(values[index]);
            *count += 1.0;
        }
    }
    sums.map(|arm| arm.map(|[sum, count]| sum / count))
}

#[test]
fn wide_results_are_the_same_on_a_chart_that_is_divided_at_a_narrow_gap() {
    for node in [
        r#"{ "kind": "surface/occlusion", "params": { "distance": 0.4, "rays": 64 } }"#,
        r#"{ "kind": "filter/blur", "inputs": { "source": "height" }, "params": { "radius": 0.1 } }"#,
        r#"{ "kind": "filter/grow", "inputs": { "source": "height" }, "params": { "radius": 0.05 } }"#,
    ] {
        let [divided, whole] = [4.0, 5.5].map(|texels| means_of_arms(node, texels / 256.0));
        let both = divided.iter().flatten().zip(whole.iter().flatten());
        for (divided, whole) in both {
            assert!((divided - whole).abs() < 0.02, "{node}: {divided} and {whole}");
        }
        let highest = whole.map(|arm| arm.into_iter().fold(0.0, f64::max));
        assert!(highest.iter().all(|highest| *highest > 0.05), "{node}: {highest:?}");
    }
}

#[test]
fn a_chart_that_is_divided_is_one_part() {
    let graph = r#"{ "format": "sabi", "version": 1, "nodes": {
        "parts": { "kind": "surface/id", "params": { "by": "chart" } } } }"#;
    for texels in [1.0, 2.0, 4.0] {
        let mut on_mesh = OnMesh::new(graph, fork(texels / 256.0).path(), 256);
        let ids = on_mesh.evaluate("parts.id").component("mask");
        let [low, high] = extent(on_mesh.covered().map(|index| ids[index]));
        assert_eq!(low.to_bits(), high.to_bits(), "{texels} texels apart");
    }
}
