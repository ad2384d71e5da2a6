//! The report counts correctly.

use super::shapes::*;
use crate::atlas::{Atlas, AtlasOptions};
use crate::model::Mesh;

const FLAT: [[f64; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

fn at(x: f64) -> [[f64; 3]; 3] {
    [[x, 0.0, 0.0], FLAT[0], FLAT[1]]
}

fn build(mesh: &Mesh, size: u32) -> Atlas {
    Atlas::build(mesh, &AtlasOptions::new(size)).unwrap()
}

#[test]
fn stacked_and_mirrored_copies_are_found() {
    let mut mesh = Mesh::default();
    let frame = PatchFrame::straight([0.25, 0.25], 0.25);
    patch(&mut mesh, at(0.0), frame, 2);
    patch(&mut mesh, at(2.0), frame, 2);
    patch(
        &mut mesh,
        at(4.0),
        PatchFrame {
            mirrored: true,
            ..frame
        },
        2,
    );
    patch(&mut mesh, at(6.0), PatchFrame::straight([0.75, 0.75], 0.25), 2);
    let atlas = build(&mesh, 64);
    let report = &atlas.report;
    assert_eq!(report.overlapping_charts, [(0, 1, 256), (0, 2, 256), (1, 2, 256)]);
    assert_eq!(report.overlap_texels, 3 * 256);
    // The mirrored copy has its diagonals in the other direction, but covers the same texels.
    assert_eq!(report.stacked_charts, 2);
    // By glTF's convention, a patch whose v grows upward counts as mirrored, and its mirror image does not.
    assert_eq!(report.mirrored_charts, 3);
    assert_eq!(report.coverage, 4.0 * 256.0 / 4096.0);
    assert_eq!(report.border_edges, 4 * 8);
    assert!(report.moved_charts >= 2);
    assert_eq!(
        report.warnings, [""; 0],
        "what to do about it is told by who knows the maps"
    );
}

#[test]
fn charts_in_other_tiles_overlap_as_repeating_textures_do() {
    let mut mesh = Mesh::default();
    patch(&mut mesh, at(0.0), PatchFrame::straight([0.25, 0.25], 0.25), 1);
    patch(&mut mesh, at(2.0), PatchFrame::straight([3.25, -1.75], 0.25), 1);
    // Across the border of the square: half of it is wrapped to the left side.
    patch(&mut mesh, at(4.0), PatchFrame::straight([1.0, 0.75], 0.25), 1);
    patch(&mut mesh, at(6.0), PatchFrame::straight([0.0, 0.75], 0.25), 1);
    let atlas = build(&mesh, 64);
    assert_eq!(atlas.charts[1].uv_tile, [3, -2]);
    assert_eq!(atlas.report.overlapping_charts, [(0, 1, 256), (2, 3, 256)]);
    assert_eq!(atlas.report.stacked_charts, 2);
    assert!(
        atlas
            .report
            .warnings
            .contains(&"2 UV charts lie outside of the unit square; maps repeat there".to_owned())
    );
}

#[test]
fn each_material_has_its_own_unit_square_and_links_cross_between_them() {
    let mut mesh = Mesh::default();
    patch(&mut mesh, at(0.0), PatchFrame::straight([0.5, 0.5], 0.5), 1);
    patch(&mut mesh, at(1.0), PatchFrame::straight([0.5, 0.5], 0.5), 1);
    mesh.triangle_material[2..].fill(1);
    let atlas = build(&mesh, 64);
    assert_eq!(
        atlas.charts.iter().map(|chart| chart.material).collect::<Vec<_>>(),
        [0, 1]
    );
    assert_eq!(atlas.report.overlap_texels, 0);
    assert_eq!(atlas.report.coverage, 0.25);
    let crossing = |ghost: &&crate::atlas::Ghost| atlas.triangle_chart[ghost.target_triangle as usize] != ghost.chart;
    assert!(atlas.ghosts.iter().filter(crossing).count() >= 2 * 2 * 32);
}

#[test]
fn a_texture_that_repeats_within_one_chart_does_not_count_as_overlap() {
    let atlas = build(&square(PatchFrame::straight([0.5, 0.5], 3.0), 2), 64);
    assert_eq!(atlas.charts.len(), 1);
    assert_eq!(atlas.report.overlap_texels, 0);
    assert_eq!(atlas.report.coverage, 9.0);
}

#[test]
fn texels_of_uneven_size_are_reported() {
    let mut mesh = Mesh::default();
    patch(&mut mesh, at(0.0), PatchFrame::straight([0.3, 0.3], 0.5), 1);
    patch(&mut mesh, at(2.0), PatchFrame::straight([0.8, 0.8], 0.1), 1);
    assert_eq!(
        build(&mesh, 128).report.warnings,
        ["texels are up to 5.0 times as dense on some UV charts as on others; scale them alike when you unwrap"]
    );
}

#[test]
fn many_stacked_charts_of_a_tiling_wall_are_counted_in_limited_time() {
    let mut mesh = Mesh::default();
    for brick in 0..400 {
        patch(
            &mut mesh,
            at(f64::from(brick) * 2.0),
            PatchFrame::straight([0.5, 0.5], 0.9),
            1,
        );
    }
    let atlas = build(&mesh, 16);
    assert_eq!(atlas.report.stacked_charts, 399);
    assert_eq!(atlas.report.overlapping_charts.len(), 10_000);
}
