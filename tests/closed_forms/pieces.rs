//! Lengths that are shares of each piece: on each piece, a node gives the same result as with that piece's own length.

use sabi_tests::{OnMesh, project};
use serde_json::{Value, json};

/// The source is the same under every fit, so that only lengths of the node differ.
fn graph(fit: &str, kind: &str, params: &Value) -> String {
    let nodes = json!({
        "tops": { "kind": "surface/direction", "params": { "reach": 50, "fade": 0 } },
        "node": { "kind": kind, "params": params, "inputs": { "source": "tops" } },
    });
    json!({ "format": "sabi", "version": 1, "fit": fit, "nodes": nodes }).to_string()
}

const SIZE: u32 = 512;

/// Sizes of the pieces of the bench in working units, the number of texels of each, and the piece of each texel.
fn pieces(on_mesh: &OnMesh) -> (Vec<f64>, Vec<usize>, Vec<(usize, usize)>) {
    let linked = on_mesh.evaluator.linked();
    let sides = linked.pieces.boxes.iter().map(|piece| f64::from(piece.typical_size()));
    let sizes: Vec<f64> = sides.map(|size| size / linked.largest_side).collect();
    let of_texel: Vec<(usize, usize)> = on_mesh
        .owned()
        .map(|(index, triangle)| (index, linked.pieces.triangle_piece[triangle as usize] as usize))
        .collect();
    let mut counts = vec![0; sizes.len()];
    for (_, piece) in &of_texel {
        counts[*piece] += 1;
    }
    (sizes, counts, of_texel)
}

/// Returns the mean and the largest difference, as shares of the range of a result, between a length that is a share of
/// each piece and the same absolute length, on a small, a middle and the largest piece.
fn differences(kind: &str, name: &str, share: f64, port: &str) -> [(f64, f64, f64); 3] {
    let bench = project("assets/meshes/bench.glb");
    let mut by_piece = OnMesh::new(&graph("piece", kind, &json!({ name: share })), &bench, SIZE);
    let result = by_piece.evaluate(port).component("mask");
    let (sizes, counts, of_texel) = pieces(&by_piece);
    let mut seen: Vec<usize> = (0..sizes.len()).filter(|piece| counts[*piece] > 200).collect();
    seen.sort_by(|a, b| sizes[*a].total_cmp(&sizes[*b]));
    assert!(
        sizes[seen[seen.len() - 1]] > 2.0 * sizes[seen[0]],
        "the bench has pieces of many sizes"
    );
    [seen[0], seen[seen.len() / 2], seen[seen.len() - 1]].map(|piece| {
        let length = share * sizes[piece];
        let mut alone = OnMesh::new(&graph("unit", kind, &json!({ name: length })), &bench, SIZE);
        let expected = alone.evaluate(port).component("mask");
        let own = of_texel.iter().filter(|(_, of)| *of == piece);
        let off: Vec<f64> = own
            .map(|(index, _)| f64::from((result[*index] - expected[*index]).abs()))
            .collect();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        let unit = if port.ends_with("distance") { length } else { 1.0 };
        let largest = off.iter().copied().fold(0.0, f64::max);
        (sizes[piece], mean / unit, largest / unit)
    })
}

#[test]
fn a_distance_that_is_a_share_of_the_piece_is_measured_in_each_pieces_own_size() {
    for port in ["node.distance", "node.mask"] {
        for (size, mean, largest) in differences("filter/distance", "width", 0.3, port) {
            assert!(
                mean < 0.01 && largest < 0.12,
                "{port} on a piece of size {size}: {mean} and at most {largest}"
            );
        }
    }
}

#[test]
fn a_mask_grows_and_blurs_by_each_pieces_own_size() {
    for (size, mean, _) in differences("filter/grow", "radius", 0.15, "node.mask") {
        assert!(mean < 0.01, "grown on a piece of size {size}: {mean}");
    }
    for (size, mean, _) in differences("filter/blur", "radius", 0.1, "node.mask") {
        // Small pieces have the level of the largest one, on which their radius is few texels.
        assert!(mean < 0.03, "blurred on a piece of size {size}: {mean}");
    }
}

#[test]
fn the_size_of_pieces_is_measured_alike_whether_lengths_are_shares_of_pieces_or_of_the_model() {
    let bench = project("assets/meshes/bench.glb");
    let of = |fit: &str| {
        let node = json!({ "node": { "kind": "surface/size", "params": { "small": 0.01, "large": 0.3 } } });
        let graph = json!({ "format": "sabi", "version": 1, "fit": fit, "nodes": node }).to_string();
        let mut on_mesh = OnMesh::new(&graph, &bench, 128);
        let values = on_mesh.evaluate("node").component("mask");
        let own: Vec<f32> = on_mesh.owned().map(|(index, _)| values[index]).collect();
        own
    };
    let [by_piece, by_model] = ["piece", "unit"].map(of);
    assert_eq!(by_piece, by_model);
    let [low, high] = sabi_tests::extent(by_piece);
    assert!(high - low > 0.2, "the pieces differ: {low} to {high}");
}

#[test]
fn nothing_breaks_off_where_no_edge_is_near() {
    let nodes = json!({
        "none": { "kind": "math/mask", "params": { "operation": "add", "a": 0, "b": 0 } },
        "away": { "kind": "filter/distance", "params": { "width": 0.02 }, "inputs": { "source": "none" } },
        "broken": {
            "kind": "relief/fracture", "params": { "size": 0.3, "depth": 0.2, "big": 1, "mid": 1, "small": 1 },
            "inputs": { "edge": "away.distance" },
        },
    });
    let graph = json!({ "format": "sabi", "version": 1, "nodes": nodes }).to_string();
    let mut on_mesh = OnMesh::new(&graph, &project("assets/meshes/cube.glb"), 256);
    let broken = on_mesh.evaluate("broken.mask").component("mask");
    let count = on_mesh.owned().filter(|(index, _)| broken[*index] > 0.0).count();
    assert_eq!(count, 0, "texels are broken off");
}
