//! Field nodes: what they read over seams is what lies there.

use sabi_tests::{Evaluated, MadeMesh, MeshFile, OnMesh, Quad, extent, project};

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

fn on_model(graph: &str, mesh: &str, size: u32) -> (OnMesh, Evaluated) {
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
type Layout = fn([f32; 2]) -> [f32; 2];

#[test]
fn a_strip_that_is_cut_is_smoothed_like_the_whole_one() {
    let noise = r#"{ "kind": "noise/simplex", "params": { "size": 0.12, "octaves": 1, "seed": 2 } }"#;
    let graph = smoothing(noise, 12);
    let whole = along_the_strip(&strip(None), &graph);
    let corners = [[0.0, 0.0], [0.5, 0.0], [0.5, 0.25], [0.0, 0.25]];
    // Moved by whole texels, turned by a quarter, mirrored.
    let layouts: [(&str, Layout); 3] = [
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
