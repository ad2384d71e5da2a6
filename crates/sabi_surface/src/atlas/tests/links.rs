//! Links lead to the point that a straight line over the surface reaches.

use glam::{DMat2, DVec2, DVec3};

use super::shapes::*;
use crate::atlas::fixed_point_uvs::Uvs;
use crate::atlas::topology::Topology;
use crate::atlas::walk::WalkMesh;
use crate::atlas::{Atlas, AtlasOptions, EMPTY, GHOST_BIT, Ghost};
use crate::model::Mesh;

fn atlas(mesh: &Mesh, size: u32) -> Atlas {
    Atlas::build(mesh, &AtlasOptions::new(size)).unwrap()
}

/// The anchor of a ghost, found by brute force, and its triangle.
fn anchor(atlas: &Atlas, ghost: &Ghost) -> (DVec2, u32) {
    let [x, y, page] = ghost.texel.map(i64::from);
    let [width, height] = atlas.page_size.map(i64::from);
    let mut best: Option<(i64, i64, i64, u32)> = None;
    for dy in -2..=2 {
        for dx in -2..=2 {
            let (ax, ay) = (x + dx, y + dy);
            if ax < 0 || ay < 0 || ax >= width || ay >= height {
                continue;
            }
            let owner = atlas.owners[((page * height + ay) * width + ax) as usize];
            if owner == EMPTY || owner & GHOST_BIT != 0 {
                continue;
            }
            let candidate = (dx * dx + dy * dy, ay, ax, owner);
            if best.is_none_or(|best| candidate < best) {
                best = Some(candidate);
            }
        }
    }
    let (_, y, x, owner) = best.unwrap();
    (DVec2::new(x as f64, y as f64) + 0.5, owner)
}

fn offset(atlas: &Atlas, triangle: u32) -> [i32; 2] {
    atlas.charts[atlas.triangle_chart[triangle as usize] as usize].texel_from_uv
}

struct WalkCase {
    start: DVec3,
    step: DVec3,
    /// The anchor triangle's texel axes in space.
    axes: [DVec3; 2],
    end: DVec3,
    /// These axes after the walk.
    carried: [DVec3; 2],
    start_metric: [f64; 3],
    end_metric: [f64; 3],
    transport: DMat2,
}

fn cases(mesh: &Mesh, atlas: &Atlas) -> Vec<WalkCase> {
    let case = |ghost: &Ghost| {
        let (anchor, triangle) = anchor(atlas, ghost);
        let from = Affine::new(mesh, atlas.size, offset(atlas, triangle), triangle);
        let to = Affine::new(
            mesh,
            atlas.size,
            offset(atlas, ghost.target_triangle),
            ghost.target_triangle,
        );
        let [x, y, _] = ghost.texel.map(f64::from);
        let center = DVec2::new(x, y) + 0.5;
        let transport = DMat2::from_cols_array_2d(&ghost.target_from_own.map(|column| column.map(f64::from)));
        WalkCase {
            start: from.position(anchor),
            step: from.vector(center - anchor),
            axes: from.axes,
            end: to.position(DVec2::from(ghost.target_texel.map(f64::from))),
            carried: [to.vector(transport.x_axis), to.vector(transport.y_axis)],
            start_metric: from.metric(),
            end_metric: to.metric(),
            transport,
        }
    };
    atlas.ghosts.iter().map(case).collect()
}

/// Returns the end of a straight line over the cube from −½ to ½, and the vectors transported along it, computed from the
/// geometry of the cube.
fn over_the_cube(mut at: DVec3, mut step: DVec3, mut vectors: [DVec3; 2]) -> (DVec3, [DVec3; 2]) {
    let mut face = (0..3).max_by(|&a, &b| at[a].abs().total_cmp(&at[b].abs())).unwrap();
    let mut normal = DVec3::ZERO;
    normal[face] = at[face].signum();
    for _ in 0..8 {
        let reach = |axis: usize| {
            if step[axis] == 0.0 {
                f64::MAX
            } else {
                (0.5 - at[axis] * step[axis].signum()) / step[axis].abs()
            }
        };
        let axis = (0..3)
            .filter(|&axis| axis != face)
            .min_by(|&a, &b| reach(a).total_cmp(&reach(b)))
            .unwrap();
        let time = reach(axis);
        if time >= 1.0 {
            return (at + step, vectors);
        }
        at += step * time;
        let mut over = DVec3::ZERO;
        over[axis] = step[axis].signum();
        // The component across the edge is rotated into the plane of the next face.
        let turn = |v: DVec3| {
            let out = v.dot(over);
            v - over * out - normal * out
        };
        let left = step * (1.0 - time);
        let [u, v] = vectors;
        let [turned, u, v] = [left, u, v].map(turn);
        (step, vectors) = (turned, [u, v]);
        (face, normal) = (axis, over);
    }
    panic!("a step that never ends");
}

#[test]
fn links_over_a_cube_of_turned_and_mirrored_charts_end_where_straight_lines_end() {
    let mut compared = 0;
    for (cells, size) in [(1, 400), (3, 256), (7, 512)] {
        let mesh = cube(cells);
        let atlas = atlas(&mesh, size);
        assert_eq!(atlas.charts.len(), 6);
        assert_eq!(atlas.report.unlinked_ghosts, 0);
        let mut pulled = 0;
        for case in cases(&mesh, &atlas) {
            let (end, carried) = over_the_cube(case.start, case.step, case.axes);
            if case.end.distance(end) > 1e-5 {
                // Through a corner of the cube, both ways around are straight.
                pulled += u32::from(case.start.abs().min_element() < 0.47);
                continue;
            }
            compared += 1;
            for (found, expected) in case.carried.iter().zip(&carried) {
                assert!(found.distance(*expected) < 1e-4 * expected.length());
            }
        }
        assert!(
            pulled <= atlas.report.pulled_ghosts,
            "{pulled} of {} are elsewhere",
            atlas.report.pulled_ghosts
        );
        assert!(
            atlas.report.pulled_ghosts as usize * 50 < atlas.ghosts.len(),
            "{}",
            atlas.report.pulled_ghosts
        );
    }
    assert!(compared > 10_000);
}

#[test]
fn carrying_vectors_keeps_their_lengths_and_angles() {
    for (mesh, size) in [(cube(4), 300), (ball(12), 256)] {
        let atlas = atlas(&mesh, size);
        let (mut linked, mut all) = (0, 0);
        for case in cases(&mesh, &atlas) {
            let (u, v) = (case.transport.x_axis, case.transport.y_axis);
            let [e, f, g] = case.end_metric;
            let product = |a: DVec2, b: DVec2| a.x * b.x * e + (a.x * b.y + a.y * b.x) * f + a.y * b.y * g;
            let found = [product(u, u), product(u, v), product(v, v)];
            let scale = case.start_metric[0].max(case.start_metric[2]);
            all += 1;
            linked += usize::from((0..3).all(|k| (found[k] - case.start_metric[k]).abs() <= 1e-4 * scale));
        }
        // Unlinked ghosts read their anchor with the identity matrix.
        assert!(
            linked + atlas.report.unlinked_ghosts as usize >= all,
            "{linked} of {all}"
        );
        assert!((atlas.report.unlinked_ghosts as usize) < all / 20);
    }
}

#[test]
fn a_strip_cut_into_two_charts_is_one_plane_for_its_links() {
    let mut mesh = Mesh::default();
    let left = PatchFrame {
        center: [0.25, 0.3],
        scale: 0.3,
        turn: 0.5,
        mirrored: false,
    };
    let right = PatchFrame {
        center: [0.7, 0.6],
        scale: 0.22,
        turn: 2.1,
        mirrored: true,
    };
    patch(&mut mesh, [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], left, 3);
    patch(&mut mesh, [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], right, 3);
    let atlas = atlas(&mesh, 256);
    // Beyond the border of the strip the line is mirrored.
    let fold = |value: f64, high: f64| {
        if value < 0.0 {
            -value
        } else if value > high {
            2.0 * high - value
        } else {
            value
        }
    };
    let mut elsewhere = 0;
    for case in cases(&mesh, &atlas) {
        let straight = case.start + case.step;
        let expected = DVec3::new(fold(straight.x, 2.0), fold(straight.y, 1.0), 0.0);
        elsewhere += u32::from(case.end.distance(expected) > 1e-5);
    }
    assert!(elsewhere <= atlas.report.pulled_ghosts);
    assert!(atlas.report.pulled_ghosts < 20);
}

#[test]
fn links_bend_over_the_edge_of_two_sheets_at_a_right_angle() {
    let mut mesh = Mesh::default();
    patch(
        &mut mesh,
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        PatchFrame::straight([0.25, 0.25], 0.3),
        2,
    );
    patch(
        &mut mesh,
        [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
        PatchFrame::straight([0.7, 0.7], 0.4),
        2,
    );
    let atlas = atlas(&mesh, 200);
    let mut folded = 0;
    for case in cases(&mesh, &atlas) {
        let straight = case.start + case.step;
        // From the flat sheet over its right edge, away from the borders.
        if case.start.z == 0.0 && straight.x > 1.0 && (0.0..=1.0).contains(&straight.y) {
            let expected = DVec3::new(1.0, straight.y, 1.0 - straight.x);
            assert!(case.end.distance(expected) < 1e-5);
            folded += 1;
        }
    }
    assert!(folded > 100);
}

#[test]
fn links_are_mirrored_at_a_border() {
    let mesh = square(
        PatchFrame {
            center: [0.5, 0.5],
            scale: 0.7,
            turn: 0.3,
            mirrored: false,
        },
        4,
    );
    let atlas = atlas(&mesh, 128);
    let fold = |value: f64| {
        if value < 0.0 {
            -value
        } else if value > 1.0 {
            2.0 - value
        } else {
            value
        }
    };
    let mut elsewhere = 0;
    for case in cases(&mesh, &atlas) {
        let straight = case.start + case.step;
        let expected = DVec3::new(fold(straight.x), fold(straight.y), 0.0);
        elsewhere += u32::from(case.end.distance(expected) > 1e-5);
        let turned = case.transport.determinant();
        let corner = [0, 1].iter().all(|&axis| !(0.0..=1.0).contains(&straight[axis]));
        // Mirrored once, or twice at a corner.
        assert!(
            (turned - if corner { 1.0 } else { -1.0 }).abs() < 1e-4,
            "{turned} at {straight:?}"
        );
    }
    assert!(elsewhere <= atlas.report.pulled_ghosts && elsewhere < 10);
}

#[test]
fn walking_back_along_a_link_returns_to_its_anchor() {
    let mesh = cube(5);
    let atlas = atlas(&mesh, 300);
    let uvs = Uvs::check(&mesh, atlas.size).unwrap();
    let topology = Topology::new(&mesh);
    let usable = vec![true; mesh.triangles.len()];
    let walker = WalkMesh {
        mesh: &mesh,
        topology: &topology,
        uvs,
        usable: &usable,
    };
    for ghost in &atlas.ghosts {
        let (anchor, triangle) = anchor(&atlas, ghost);
        let start = anchor - DVec2::from(offset(&atlas, triangle).map(f64::from));
        let [x, y, _] = ghost.texel.map(f64::from);
        let step = DVec2::new(x, y) + 0.5 - anchor;
        let there = walker.walk(triangle, start, step).unwrap();
        let again = walker
            .walk(there.triangle, there.texel, -(there.transport * step))
            .unwrap();
        assert_eq!(atlas.triangle_chart[again.triangle as usize], ghost.chart);
        let distance = again.texel.distance(start);
        assert!(distance < 1e-3, "{distance} for {ghost:?}");
    }
}

#[test]
fn every_link_can_be_sampled() {
    for mesh in [cube(6), ball(16)] {
        for size in [32, 100, 512] {
            let atlas = atlas(&mesh, size);
            let [width, _] = atlas.page_size;
            for ghost in &atlas.ghosts {
                let chart = atlas.triangle_chart[ghost.target_triangle as usize];
                let page = atlas.charts[chart as usize].page;
                let [x, y] = ghost.target_texel.map(|value| (f64::from(value) - 0.5).floor());
                let owned = [(0, 0), (1, 0), (0, 1), (1, 1)].into_iter().any(|(dx, dy)| {
                    let (column, row) = (x as u32 + dx, y as u32 + dy + page * atlas.page_size[1]);
                    let owner = atlas.owners[(row * width + column) as usize];
                    owner & GHOST_BIT == 0 && atlas.triangle_chart[owner as usize] == chart
                });
                assert!(owned, "{ghost:?} at size {size}");
            }
        }
    }
}
