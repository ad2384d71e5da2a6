//! Pictures that are read at a connected position, or tiled at random.

use super::*;

/// A graph of a picture with these parameters whose position is that of a node.
fn read_at(params: &Value, position: &str, mut nodes: Value) -> String {
    nodes["image"] = json!({ "kind": "source/image", "params": params, "inputs": { "position": position } });
    json!({ "format": "sabi", "version": 1, "fit": "metres", "nodes": nodes }).to_string()
}

/// The surface's own position, moved.
fn moved(by: [f64; 3]) -> Value {
    json!({
        "place": { "kind": "surface/position" },
        "moved": {
            "kind": "math/vector", "params": { "operation": "add", "b": by }, "inputs": { "a": "place.position" },
        },
    })
}

fn largest_difference(one: &mut OnMesh, other: &mut OnMesh, port: &str) -> f32 {
    let [one_parts, other_parts] = [&mut *one, &mut *other].map(|on_mesh| on_mesh.evaluate(port).components());
    let mut largest = 0.0_f32;
    for (index, _) in one.owned() {
        for ((_, left), (_, right)) in one_parts.iter().zip(&other_parts) {
            largest = largest.max((left[index] - right[index]).abs());
        }
    }
    largest
}

#[test]
fn the_position_of_the_surface_itself_gives_every_projection_as_it_is() {
    let folder = Folder::new();
    let file = normal_map(&folder, 0.4, true, false);
    let made = MeshFile::new(vec![square()]).write();
    // The square is 1 wide with its middle at the origin, so half of it away lie its texture coordinates.
    let cases = [
        (json!({ "projection": "uv" }), [0.5, 0.5, 0.0]),
        (
            json!({ "projection": "uv", "tiles": [2, 1], "rotate": 30, "offset": [0.2, 0.1] }),
            [0.5, 0.5, 0.0],
        ),
        (
            json!({ "projection": "triplanar", "size": 0.7, "rotate": 20 }),
            [0.0; 3],
        ),
        (json!({ "projection": "decal", "size": 0.6 }), [0.0; 3]),
    ];
    for (mut params, by) in cases {
        params["file"] = json!(file);
        let mut plain = OnMesh::new(&graph(&params), made.path(), 128);
        let mut read = OnMesh::new(&read_at(&params, "moved", moved(by)), made.path(), 128);
        for port in ["image.color", "image.slope", "image.alpha", "image.r"] {
            let off = largest_difference(&mut plain, &mut read, port);
            // Positions have single precision, which at the border of a decal's pixel is a 500th of it.
            assert!(off < 4e-3, "{port} of {params} is off by {off}");
        }
    }
}

#[test]
fn each_cell_of_a_pattern_shows_the_whole_picture() {
    let folder = Folder::new();
    let params = json!({ "file": waves(&folder), "color_space": "linear" });
    let cells = json!({ "cells": { "kind": "pattern/grid", "params": { "size": 0.25 } } });
    let made = MeshFile::new(vec![square()]).write();
    let mut on_mesh = OnMesh::new(&read_at(&params, "cells.uv", cells), made.path(), 256);
    let place = on_mesh.evaluate("cells.uv");
    let [right, up] = ["vector.x", "vector.y"].map(|name| place.component(name));
    let [red, green] = ["image.r", "image.g"].map(|port| on_mesh.evaluate(port).component("mask"));
    let mut ends = [1.0_f32, 0.0];
    for (index, _) in on_mesh.owned() {
        ends = [ends[0].min(right[index]), ends[1].max(right[index])];
        let expected = [wave(f64::from(right[index])), wave(1.0 - f64::from(up[index]))];
        for (is, expected) in [red[index], green[index]].into_iter().zip(expected) {
            assert!((f64::from(is) - expected).abs() < WAVE_TOLERANCE, "{is} for {expected}");
        }
    }
    assert!(ends[0] < 0.02 && ends[1] > 0.98, "a cell reaches from 0 to 1: {ends:?}");
}

#[test]
fn channels_are_masks_of_their_own() {
    let folder = Folder::new();
    let codes: Vec<u8> = (0..4 * SIDE * SIDE)
        .map(|at| ((at * 31 + at / 97) % 256) as u8)
        .collect();
    let params = json!({ "file": folder.write("channels.png", png(SIDE, 4, false, &codes)) });
    for (at, port) in ["r", "g", "b", "a"].into_iter().enumerate() {
        assert_pixels(&params, port, "mask", |pixel| f32::from(codes[4 * pixel + at]) / 255.0);
    }
}

/// Mean, deviation, and correlation of a mask on a square with itself one tile of a quarter further.
fn statistics(params: &Value) -> [f64; 3] {
    let side = 1024;
    let mut on_mesh = on_square(params, side);
    let values = on_mesh.evaluate("image.mask").component("mask");
    let mut rows = vec![0.0; (side * side) as usize];
    for (index, pixel) in pixels(&on_mesh, side) {
        rows[pixel] = f64::from(values[index]);
    }
    let count = rows.len() as f64;
    let mean = rows.iter().sum::<f64>() / count;
    let variance = rows.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
    let (side, lag) = (side as usize, side as usize / 4);
    let pairs = (0..side).flat_map(|row| (0..side - lag).map(move |column| row * side + column));
    let products: Vec<f64> = pairs.map(|at| (rows[at] - mean) * (rows[at + lag] - mean)).collect();
    let correlation = products.iter().sum::<f64>() / products.len() as f64 / variance;
    [mean, variance.sqrt(), correlation]
}

#[test]
fn random_tiling_keeps_mean_and_spread_and_shows_no_repetition() {
    let folder = Folder::new();
    // Gray noise in squares of 16 pixels, so that few texels lie between two of them; a quarter of the values is black.
    let noise = |x: u32, y: u32| {
        let hash = (x / 16).wrapping_mul(0x9e37_79b9) ^ (y / 16).wrapping_mul(0x85eb_ca6b);
        let hash = (hash ^ (hash >> 15)).wrapping_mul(0x2c1b_3c6d);
        let code = ((hash ^ (hash >> 12)).wrapping_mul(0x297a_2d39) >> 24) as u8;
        code.saturating_sub(64)
    };
    let codes: Vec<u8> = (0..256 * 256_u32).map(|at| noise(at % 256, at / 256)).collect();
    let file = folder.write("noise.png", png(256, 1, false, &codes));
    let with = |tiling: &str, turn: u32| json!({ "file": file, "tiles": [4, 4], "tiling": tiling, "turn": turn });
    let [mean, deviation, repeated] = statistics(&with("repeat", 180));
    assert!(repeated > 0.99, "{repeated}");
    for turn in [0, 180] {
        let [own_mean, own_deviation, correlation] = statistics(&with("random", turn));
        // Four standard errors of the 4096 squares that are seen.
        assert!(
            (own_mean - mean).abs() < 4.0 * deviation / 64.0,
            "mean {own_mean} for {mean}"
        );
        let off = (own_deviation - deviation).abs();
        assert!(off < 0.05 * deviation, "deviation {own_deviation} for {deviation}");
        assert!(correlation.abs() < 0.1, "correlation {correlation}");
    }
}

#[test]
fn an_even_picture_stays_even_under_random_tiling() {
    let folder = Folder::new();
    let file = folder.write("even.png", png(16, 3, false, &[128; 16 * 16 * 3]));
    let mut on_mesh = on_square(&json!({ "file": file, "tiles": [3, 3], "tiling": "random" }), 64);
    let values = on_mesh.evaluate("image.mask").component("mask");
    for (index, _) in on_mesh.owned() {
        assert!((values[index] - 128.0 / 255.0).abs() < 1e-6);
    }
}

#[test]
fn triplanar_normals_on_a_sphere_are_the_gradients_of_three_heights_added_by_weight() {
    let folder = Folder::new();
    let (depth, sharpness, size) = (0.4, 8.0, 0.5);
    let params = json!({
        "file": normal_map(&folder, depth, false, false), "projection": "triplanar", "size": size, "sharpness": sharpness,
    });
    let mut on_mesh = OnMesh::new(&graph(&params), &project("assets/meshes/sphere.glb"), 128);
    let slope = on_mesh.evaluate("image.slope");
    let slope = ["vector.x", "vector.y", "vector.z"].map(|name| slope.component(name));
    for (index, triangle) in on_mesh.owned() {
        let at = on_mesh.position(index).expect("a place");
        let [_, x, y] = on_mesh.texel(index);
        let here = glam::dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let normal = on_mesh.frame_at(triangle, here)[2].normalize();
        let weights = normal.abs().to_array().map(|part| part.powf(sharpness));
        let sum: f64 = weights.iter().sum();
        let side = normal.signum();
        // The way to the right in each picture, seen from outside.
        let rights = [
            glam::DVec3::NEG_Z * side.x,
            glam::DVec3::X * side.y,
            glam::DVec3::X * side.z,
        ];
        let mut gradient = glam::DVec3::ZERO;
        for (weight, right) in weights.into_iter().zip(rights) {
            let steep = -depth * (TAU * (at.dot(right) / size + 0.5)).sin();
            gradient += weight / sum * steep * right;
        }
        let expected = gradient - normal * gradient.dot(normal);
        let is = glam::DVec3::from(slope.each_ref().map(|part| f64::from(part[index])));
        assert!((is - expected).length() < 0.03, "at {at}: {is} for {expected}");
    }
}

/// A file of three columns and two rows whose pictures are even grays, each lighter than the one before.
fn sheet(folder: &Folder) -> String {
    let (columns, rows, side) = (3, 2, 20);
    let code = |x: u32, y: u32| (40 * (y / side * columns + x / side) + 20) as u8;
    let codes: Vec<u8> = (0..rows * side)
        .flat_map(|y| (0..columns * side).map(move |x| code(x, y)))
        .collect();
    let options = PngOptions {
        channels: 1,
        bits: 8,
        srgb_chunk: false,
    };
    let file = encode_png(columns * side, rows * side, PngData::U8(&codes), options).expect("a picture");
    folder.write("sheet.png", file)
}

#[test]
fn one_of_several_pictures_in_a_file_is_seen_as_far_as_its_border() {
    let folder = Folder::new();
    let file = sheet(&folder);
    let params = json!({ "file": file, "color_space": "linear", "columns": 3, "rows": 2 });
    for (number, cell) in [0.0, 0.2, 0.45, 0.6, 0.7, 1.0].into_iter().enumerate() {
        for projection in ["uv", "decal"] {
            let mut params = params.clone();
            params["projection"] = json!(projection);
            params["size"] = json!(1);
            let nodes = json!({
                "which": { "kind": "math/mask", "params": { "operation": "add", "a": cell, "b": 0 } },
                "image": { "kind": "source/image", "params": params, "inputs": { "cell": "which" } },
            });
            let graph = json!({ "format": "sabi", "version": 1, "fit": "metres", "nodes": nodes }).to_string();
            let made = MeshFile::new(vec![square()]).write();
            let mut on_mesh = OnMesh::new(&graph, made.path(), 64);
            let [mask, alpha] = ["image.mask", "image.alpha"].map(|port| on_mesh.evaluate(port).component("mask"));
            let expected = (40 * number + 20) as f32 / 255.0;
            for (index, _) in on_mesh.owned().filter(|(index, _)| alpha[*index] > 0.99) {
                assert!(
                    (mask[index] - expected).abs() < 1e-5,
                    "{} of picture {number} by {projection}",
                    mask[index]
                );
            }
        }
    }
}

#[test]
fn each_stamp_and_each_brick_shows_one_picture_of_a_file() {
    let folder = Folder::new();
    let params = json!({ "file": sheet(&folder), "color_space": "linear", "columns": 3, "rows": 2 });
    for (kind, place, within) in [
        ("scatter/stamp", "cells.place", "cells.mask"),
        ("pattern/bricks", "cells.uv", "cells.mask"),
    ] {
        let cells = json!({ "cells": { "kind": kind, "params": { "seed": 3 } } });
        let made = MeshFile::new(vec![square()]).write();
        let mut on_mesh = OnMesh::new(&read_at(&params, place, cells), made.path(), 256);
        let [mask, id, inside] =
            ["image.mask", "cells.id", within].map(|port| on_mesh.evaluate(port).component("mask"));
        let mut seen = std::collections::BTreeSet::new();
        for (index, _) in on_mesh.owned().filter(|(index, _)| inside[*index] > 0.99) {
            let number = (f64::from(id[index]) * 6.0).floor().min(5.0);
            let expected = (40.0 * number + 20.0) / 255.0;
            let off = (f64::from(mask[index]) - expected).abs();
            assert!(off < 1e-4, "{} of picture {number} in {kind}", mask[index]);
            seen.insert(number as u32);
        }
        assert!(seen.len() > 3, "{kind} shows the pictures {seen:?}");
    }
}
