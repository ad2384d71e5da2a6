//! `noise/wood` and the pieces cut from it: rings have the requested width, boards keep their wood when they are rotated,
//! and no two boards have the same wood.

use glam::{Mat3, Vec3};
use sabi_tests::{MadeMesh, MeshFile, NodeFolder, OnMesh, Quad};

/// Sides of a board, meters.
const BOARD: [f32; 3] = [0.8, 0.16, 0.05];

/// The faces of a board, turned and moved, with their texture coordinates in a strip of their own.
fn board(turn: Mat3, middle: Vec3, strip: f32) -> Vec<Quad> {
    let half = 0.5 * Vec3::from(BOARD);
    let face = |at: usize| {
        let (axis, sign) = (at / 2, if at.is_multiple_of(2) { 1.0 } else { -1.0 });
        let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[a, b]: [f32; 2]| {
            let mut corner = Vec3::ZERO;
            corner[axis] = sign * half[axis];
            corner[first] = sign * a * half[first];
            corner[second] = b * half[second];
            (turn * corner + middle).to_array()
        });
        let low = [0.02 + 0.16 * at as f32, strip];
        let uvs = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
            .map(|[a, b]: [f32; 2]| [low[0] + 0.12 * a, low[1] + 0.4 * b]);
        Quad { corners, uvs }
    };
    (0..6).map(face).collect()
}

fn made(boards: impl IntoIterator<Item = Vec<Quad>>) -> MadeMesh {
    MeshFile::new(boards.into_iter().flatten().collect()).write()
}

fn graph(params: &str) -> String {
    format!(
        r#"{{ "format": "sabi", "version": 1, "fit": "metres", "nodes": {{ "wood": {{ "kind": "noise/wood", "params": {params} }},
            "box": {{ "kind": "surface/id", "params": {{ "by": "piece" }} }} }} }}"#
    )
}

/// Two turns of a board that keep its axes nearest to the model's own: further on an axis is named the other way.
fn turned() -> Mat3 {
    Mat3::from_rotation_z(37_f32.to_radians()) * Mat3::from_rotation_x(20_f32.to_radians())
}

#[test]
fn a_board_takes_its_wood_along_when_it_turns() {
    let graph = graph(r#"{ "rings": 0.02, "knots": 1, "grain": 1 }"#);
    let straight = made([board(Mat3::IDENTITY, Vec3::ZERO, 0.05)]);
    let turned = made([board(turned(), Vec3::new(0.3, -0.2, 0.5), 0.05)]);
    let [mut straight, mut turned] = [&straight, &turned].map(|mesh| OnMesh::new(&graph, mesh.path(), 512));
    let [one, other] = [&mut straight, &mut turned].map(|on_mesh| on_mesh.evaluate("wood").component("mask"));
    let mut seen = (1.0_f32, 0.0_f32);
    for (index, _) in straight.owned() {
        // Positions round at 2⁻²⁴ of a meter, 3e-6 of a ring; the sharpest edge rises by its whole in 0.07 rings, and
        // pores are 0.13 rings wide.
        assert!(
            (one[index] - other[index]).abs() < 2e-3,
            "{} and {} at texel {:?}",
            one[index],
            other[index],
            straight.texel(index)
        );
        seen = (seen.0.min(one[index]), seen.1.max(one[index]));
    }
    assert!(seen.1 - seen.0 > 0.4, "the wood shows only {seen:?}");
}

/// The texel of the second board that lies as this one does on the first: twelve triangles and half the texture further.
fn partner(on_mesh: &OnMesh, index: usize, triangle: u32) -> usize {
    let atlas = on_mesh.atlas();
    let [from, to] = [triangle, triangle + 12].map(|t| &atlas.charts[atlas.triangle_chart[t as usize] as usize]);
    let [_, x, y] = on_mesh.texel(index);
    let moved = |texel: u32, axis: usize| texel as i32 - from.texel_from_uv[axis] + to.texel_from_uv[axis];
    on_mesh.index([to.page, moved(x, 0) as u32, (moved(y, 1) + 256) as u32])
}

#[test]
fn every_board_is_another_piece_of_wood() {
    let boards = [0, 1].map(|at| {
        board(
            Mat3::IDENTITY,
            Vec3::new(0.0, 0.3 * at as f32, 0.0),
            0.05 + 0.5 * at as f32,
        )
    });
    let mut on_mesh = OnMesh::new(&graph(r#"{ "rings": 0.02 }"#), made(boards).path(), 512);
    assert_eq!(on_mesh.evaluator.linked().pieces.boxes.len(), 2);
    let [mask, id] = ["wood.mask", "wood.id"].map(|port| on_mesh.evaluate(port).component("mask"));
    let piece = |triangle: u32| on_mesh.evaluator.linked().pieces.triangle_piece[triangle as usize];
    let (mut difference, mut count) = (0.0, 0);
    let mut ids = [None; 2];
    for (index, triangle) in on_mesh.owned() {
        let known = ids[piece(triangle) as usize].get_or_insert(id[index]);
        assert_eq!(*known, id[index], "a piece has one id");
        if piece(triangle) == 0 {
            let other = partner(&on_mesh, index, triangle);
            difference += f64::from((mask[index] - mask[other]).abs());
            count += 1;
        }
    }
    assert!(count > 10_000, "only {count} texels have a partner");
    assert!(
        difference / f64::from(count) > 0.05,
        "the boards differ by {difference} over {count} texels"
    );
    assert_ne!(ids[0], ids[1]);
}

/// A straight way outward, so far from the pith that it counts as running from it.
const OUTWARD: &str = "\
//! Outward
//! A straight way.

/// A place on it.
/// @vector
fn place(at: Surface) -> vec3f {
    return vec3f(0.0, 200.0 + 50.0 * at.uv.x, 0.0);
}
";

#[test]
fn rings_are_as_wide_as_asked_for() {
    let quad = Quad {
        corners: [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.0, 0.1, 0.0]],
        uvs: [[0.0, 0.4], [1.0, 0.4], [1.0, 0.3], [0.0, 0.3]],
    };
    let mesh = MeshFile::new(vec![quad]).write();
    let kinds = NodeFolder::new(&[("own/outward", OUTWARD)]).kinds();
    for seed in 0..3 {
        let graph = format!(
            r#"{{ "format": "sabi", "version": 1, "fit": "metres", "nodes": {{
                "way": {{ "kind": "own/outward" }},
                "wood": {{ "kind": "noise/wood", "inputs": {{ "position": "way" }},
                           "params": {{ "rings": 1, "knots": 0, "grain": 0, "seed": {seed} }} }} }} }}"#
        );
        let mut on_mesh = OnMesh::with_kinds(&graph, kinds.clone(), mesh.path(), 1024);
        let mask = on_mesh.evaluate("wood").component("mask");
        let row = on_mesh
            .owned()
            .map(|(index, _)| on_mesh.texel(index))
            .nth(20_000)
            .expect("a row");
        let line: Vec<f32> = on_mesh
            .owned()
            .filter(|(index, _)| on_mesh.texel(*index)[2] == row[2])
            .map(|(index, _)| mask[index])
            .collect();
        assert!(line.len() > 1000, "{} texels", line.len());
        // A year ends where the tone falls by much of what it rose; twenty texels are a ring.
        let (mut ends, mut turn, mut is_rising) = (0.0, line[0], true);
        for tone in line.iter().copied() {
            if is_rising && tone < turn - 0.12 {
                ends += 1.0;
                (turn, is_rising) = (tone, false);
            } else if !is_rising && tone > turn + 0.12 {
                (turn, is_rising) = (tone, true);
            }
            turn = if is_rising { turn.max(tone) } else { turn.min(tone) };
        }
        let rings = 50.0 * line.len() as f64 / 1024.0;
        // Trunks are not round: by 0.4 rings at each end in the mean, and a year may end 0.2 rings later.
        assert!(
            (ends / rings - 1.0).abs() < 0.04,
            "seed {seed}: {ends} years over {rings} rings"
        );
    }
}

/// Node that returns the place in the piece's box as kernels have it.
const HERE: &str = "\
//! Here
//! The place in the piece's box.

/// The place in the piece's box.
/// @vector
fn place(at: Surface) -> vec3f {
    return at.piece_position;
}
";

#[test]
fn a_place_in_a_box_is_the_same_to_kernels_and_to_the_processor() {
    let boards = [
        board(Mat3::IDENTITY, Vec3::ZERO, 0.05),
        board(turned(), Vec3::new(0.0, 0.5, 0.0), 0.55),
    ];
    let graph = r#"{ "format": "sabi", "version": 1, "nodes": { "here": { "kind": "own/here" },
        "box": { "kind": "surface/id", "params": { "by": "piece" } } } }"#;
    let kinds = NodeFolder::new(&[("own/here", HERE)]).kinds();
    let mut on_mesh = OnMesh::with_kinds(graph, kinds, made(boards).path(), 256);
    let scale = on_mesh
        .evaluator
        .linked()
        .fitted(sabi_graph::Fit::Unit)
        .working_from_model() as f32;
    for (axis, name) in ["vector.x", "vector.y", "vector.z"].into_iter().enumerate() {
        let [kernel, processor] = ["here", "box.position"].map(|node| on_mesh.evaluate(node).component(name));
        for index in on_mesh.covered() {
            // Both round at 2⁻²⁴ of the model, a few times.
            assert!((kernel[index] - processor[index]).abs() < 2e-6, "{name} at {index}");
        }
        let reach = on_mesh
            .owned()
            .fold(0.0_f32, |most, (index, _)| most.max(kernel[index].abs()));
        let half = 0.5 * BOARD[axis] * scale;
        // Texels are read at their middles, which end half a texel before the board does.
        assert!(
            reach <= half * 1.0001 && reach > half * 0.9,
            "{name} reaches {reach} of {half}"
        );
    }
}

#[test]
fn a_pick_selects_parts_by_name_and_tells_what_is_not_there() {
    let bench = sabi_tests::project("assets/meshes/bench.glb");
    let graph = |pick: &str| {
        format!(
            r#"{{ "format": "sabi", "version": 1, "nodes": {{ "one": {{ "kind": "surface/id", "params": {{ "pick": "{pick}" }} }} }} }}"#
        )
    };
    let mut on_mesh = OnMesh::new(&graph(""), &bench, 128);
    let all = on_mesh.evaluate("one").component("mask");
    assert!(
        on_mesh.owned().all(|(index, _)| all[index] == 1.0),
        "nothing picked is everything"
    );
    let parts = on_mesh.evaluator.linked().model.parts.clone();
    assert!(parts.len() > 1, "{parts:?}");
    for (part, name) in parts.iter().enumerate() {
        on_mesh.set_graph(&graph(name));
        let mask = on_mesh.evaluate("one").component("mask");
        for (index, triangle) in on_mesh.owned() {
            let own = on_mesh.evaluator.linked().model.mesh.triangle_part[triangle as usize];
            let is_picked = parts[own as usize] == *name || own as usize == part;
            assert_eq!(mask[index], f32::from(u8::from(is_picked)), "{name}");
        }
    }
    let told = on_mesh.warnings().join("\n");
    assert!(!told.contains("picks"), "{told}");
    on_mesh.set_graph(&graph("nothing like it"));
    let mask = on_mesh.evaluate("one").component("mask");
    assert!(on_mesh.owned().all(|(index, _)| mask[index] == 0.0));
    let told = on_mesh.warnings().join("\n");
    assert!(
        told.contains("node 'one' picks 'nothing like it', but the model has no such part"),
        "{told}"
    );
}
