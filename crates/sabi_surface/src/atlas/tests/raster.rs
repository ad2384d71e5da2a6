//! Every texel center belongs to exactly one of the triangles that contain it.

use super::shapes::*;
use crate::atlas::fixed_point_uvs::{UNIT, Uvs};
use crate::atlas::raster::spans;
use crate::atlas::{Atlas, AtlasOptions, EMPTY, GHOST_BIT, Owner};
use crate::model::Mesh;

fn painted(corners: [[i64; 2]; 3], side: usize, counts: &mut [u32]) {
    spans(corners, 0..side as i64, |y, x0, x1| {
        for x in x0..x1 {
            counts[y as usize * side + x as usize] += 1;
        }
    });
}

#[test]
fn a_fan_of_triangles_covers_each_center_exactly_once() {
    let side = 40;
    let mut dice = PcgRandom(7);
    for _ in 0..200 {
        let hub = [dice.between(2000.0, 8000.0) as i64, dice.between(2000.0, 8000.0) as i64];
        // Corners on texel centers and on texel borders are the difficult cases.
        let snap = |value: i64| if value % 3 == 0 { value & -128 } else { value };
        let hub = hub.map(snap);
        let rim = [[128, 128], [9856, 128], [9856, 9856], [128, 9856]];
        let mut counts = vec![0; side * side];
        for k in 0..4 {
            let (a, b) = (rim[k], rim[(k + 1) % 4]);
            painted(
                if dice.next() & 1 == 0 { [hub, a, b] } else { [b, a, hub] },
                side,
                &mut counts,
            );
        }
        let mut whole = vec![0; side * side];
        painted([rim[0], rim[1], rim[2]], side, &mut whole);
        painted([rim[0], rim[2], rim[3]], side, &mut whole);
        assert_eq!(counts, whole);
        assert!(whole.iter().all(|&count| count <= 1));
        assert_eq!(whole.iter().sum::<u32>(), 38 * 38);
    }
}

#[test]
fn spans_contain_the_centers_that_exact_edge_functions_find() {
    let side = 32;
    let mut dice = PcgRandom(3);
    for _ in 0..500 {
        let mut corner = || {
            [
                dice.next() as i64 % (side as i64 * UNIT),
                dice.next() as i64 % (side as i64 * UNIT),
            ]
        };
        let corners = [corner(), corner(), corner()];
        let mut counts = vec![0; side * side];
        painted(corners, side, &mut counts);
        for y in 0..side as i64 {
            for x in 0..side as i64 {
                let center = [x * UNIT + UNIT / 2, y * UNIT + UNIT / 2];
                let sides = [0, 1, 2].map(|k| {
                    let (a, b) = (corners[k], corners[(k + 1) % 3]);
                    ((b[0] - a[0]) * (center[1] - a[1]) - (b[1] - a[1]) * (center[0] - a[0])).signum()
                });
                let inside = sides == [1; 3] || sides == [-1; 3];
                let outside = sides.contains(&1) && sides.contains(&-1);
                let count = counts[y as usize * side + x as usize];
                assert!(
                    count == u32::from(inside) || !(inside || outside),
                    "{corners:?} at {x} {y}"
                );
            }
        }
    }
}

#[test]
fn every_covered_center_belongs_to_a_triangle_that_contains_it() {
    for (mesh, size) in [(cube(5), 200), (ball(9), 128)] {
        let atlas = Atlas::build(&mesh, &AtlasOptions::new(size)).unwrap();
        let uvs = Uvs::check(&mesh, size).unwrap();
        let [width, height] = atlas.page_size;
        let mut expected = vec![EMPTY; atlas.owners.len()];
        for (triangle, &chart) in atlas.triangle_chart.iter().enumerate().rev() {
            let chart = &atlas.charts[chart as usize];
            let [dx, dy] = chart.texel_from_uv.map(i64::from);
            let corners = uvs.fixed(triangle as u32).map(|[x, y]| [x + dx * UNIT, y + dy * UNIT]);
            spans(corners, 0..i64::from(height), |y, x0, x1| {
                let start = (i64::from(chart.page) * i64::from(height) + y) * i64::from(width);
                expected[(start + x0) as usize..(start + x1) as usize].fill(triangle as u32);
            });
        }
        for (texel, (&found, &expected)) in atlas.owners.iter().zip(&expected).enumerate() {
            let found = if found & GHOST_BIT != 0 { EMPTY } else { found };
            assert_eq!(found, expected, "texel {texel}");
        }
        let owned = expected.iter().filter(|&&owner| owner != EMPTY).count();
        assert_eq!(owned as u32, atlas.charts.iter().map(|chart| chart.texels).sum::<u32>());
    }
}

#[test]
fn the_owner_can_be_queried_for_any_texel() {
    let atlas = Atlas::build(&cube(1), &AtlasOptions::new(64)).unwrap();
    assert_eq!(atlas.owner(0, 0, 7), Owner::Empty);
    assert_eq!(atlas.owner(u32::MAX, u32::MAX, 0), Owner::Empty);
    for (index, ghost) in atlas.ghosts.iter().enumerate() {
        let [x, y, page] = ghost.texel;
        assert_eq!(atlas.owner(x, y, page), Owner::Ghost(index as u32));
    }
    let [x, y, _, _] = atlas.charts[0].bounds;
    let inside = atlas.owner(x + 5, y + 5, atlas.charts[0].page);
    assert!(matches!(inside, Owner::Triangle(triangle) if atlas.triangle_chart[triangle as usize] == 0));
}

#[test]
fn moving_the_layout_by_whole_texels_only_moves_the_atlas() {
    let size = 256;
    let build = |shift: [f32; 2]| {
        let mut mesh = Mesh::default();
        patch(
            &mut mesh,
            [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            PatchFrame::straight([0.25, 0.25], 0.25),
            3,
        );
        // Exact in single precision, so that the UVs move by exactly whole texels.
        for uv in &mut mesh.uvs {
            *uv = [0, 1].map(|axis| (uv[axis] * 4096.0).round() / 4096.0 + shift[axis]);
        }
        Atlas::build(&mesh, &AtlasOptions::new(size)).unwrap()
    };
    let (here, there) = (build([0.0, 0.0]), build([32.0 / 256.0, 16.0 / 256.0]));
    assert_eq!(here.page_size, there.page_size);
    assert_eq!(here.ghosts.len(), there.ghosts.len());
    for (a, b) in here.ghosts.iter().zip(&there.ghosts) {
        assert_eq!([a.texel[0] + 32, a.texel[1] + 16], [b.texel[0], b.texel[1]]);
        assert_eq!(a.target_triangle, b.target_triangle);
        assert_eq!([a.target_texel[0] + 32.0, a.target_texel[1] + 16.0], b.target_texel);
    }
}
