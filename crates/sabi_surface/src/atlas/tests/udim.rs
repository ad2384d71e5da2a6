//! UDIM tiles are distinguished from textures that repeat.

use std::collections::BTreeSet;

use crate::atlas::{Atlas, AtlasError, AtlasOptions, Udim, repeats, udim_number};
use crate::model::Mesh;

/// Squares of one material, each with its lower UV corner and its side.
fn squares(charts: &[([f32; 2], f32)]) -> Mesh {
    let mut mesh = Mesh::default();
    for (index, ([u, v], side)) in charts.iter().enumerate() {
        let first = mesh.positions.len() as u32;
        for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            mesh.positions.push([x, y, index as f32]);
            mesh.normals.push([0.0, 0.0, 1.0]);
            mesh.tangents.push([1.0, 0.0, 0.0, 1.0]);
            mesh.uvs.push([u + x * side, v + y * side]);
        }
        mesh.triangles
            .extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        mesh.triangle_material.extend([0; 2]);
        mesh.triangle_part.extend([index as u32; 2]);
    }
    mesh
}

fn is_udim(mesh: &Mesh, udim: Udim) -> bool {
    let options = AtlasOptions {
        udim,
        ..AtlasOptions::new(64)
    };
    let atlas = Atlas::build(mesh, &options).unwrap();
    assert!(atlas.udim_sheets.is_empty() || atlas.udim_sheets == BTreeSet::from([0]));
    let told = atlas
        .report
        .warnings
        .iter()
        .any(|warning| warning.contains("maps repeat there"));
    let is_udim = !atlas.udim_sheets.is_empty();
    assert!(!(told && is_udim), "{:?}", atlas.report.warnings);
    is_udim
}

#[test]
fn several_tiles_are_udim_unless_a_texture_seems_to_repeat() {
    let cases = [
        (
            "different charts in two tiles",
            squares(&[([0.1, 0.1], 0.5), ([1.2, 0.1], 0.6)]),
            true,
        ),
        ("one tile", squares(&[([0.1, 0.1], 0.5), ([0.7, 0.1], 0.2)]), false),
        (
            "a chart over two tiles",
            squares(&[([0.1, 0.1], 0.5), ([1.7, 0.1], 0.6)]),
            false,
        ),
        (
            "a chart a little over the border",
            squares(&[([0.1, 0.1], 0.5), ([1.4, 0.1], 0.605)]),
            true,
        ),
        (
            "alike modulo 1",
            squares(&[([0.1, 0.1], 0.5), ([1.1, 0.1], 0.5), ([2.2, 0.3], 0.3)]),
            false,
        ),
        (
            "two equal bolts at the same place of two of three tiles",
            squares(&[
                ([0.1, 0.1], 0.5),
                ([0.8, 0.8], 0.1),
                ([1.2, 0.1], 0.5),
                ([1.8, 0.8], 0.1),
                ([2.1, 0.3], 0.4),
            ]),
            true,
        ),
        (
            "most of the area alike modulo 1",
            squares(&[
                ([0.1, 0.1], 0.4),
                ([0.8, 0.8], 0.1),
                ([1.1, 0.1], 0.4),
                ([2.1, 0.1], 0.4),
                ([2.6, 0.6], 0.3),
            ]),
            false,
        ),
        (
            "a tile without a number",
            squares(&[([0.1, 0.1], 0.5), ([-0.8, 0.1], 0.6)]),
            false,
        ),
        (
            "tiny and alike modulo 1",
            squares(&[([0.1, 0.1], 0.002), ([1.1, 0.1], 0.002), ([2.2, 0.3], 0.3)]),
            true,
        ),
        (
            "alike in one tile",
            squares(&[([0.1, 0.1], 0.5), ([0.1, 0.1], 0.5), ([1.2, 0.3], 0.3)]),
            true,
        ),
    ];
    for (name, mesh, expected) in cases {
        assert_eq!(is_udim(&mesh, Udim::Auto), expected, "{name}");
    }
}

#[test]
fn corners_on_a_rounding_border_do_not_hide_that_charts_are_congruent() {
    // 0.5 is a border of the comparison; three units further its sum is rounded down.
    let mesh = squares(&[([0.5, 0.25], 0.3), ([3.499_999_8, 0.25], 0.3)]);
    assert!(!is_udim(&mesh, Udim::Auto));
}

#[test]
fn a_model_with_a_repeating_texture_is_not_udim() {
    let mesh = Mesh {
        repeating: BTreeSet::from([0]),
        ..squares(&[([0.1, 0.1], 0.5), ([1.2, 0.1], 0.6)])
    };
    assert!(!is_udim(&mesh, Udim::Auto));
    assert!(is_udim(&mesh, Udim::On), "asked for");
}

#[test]
fn udim_can_be_turned_on_and_off() {
    let alike = squares(&[([0.1, 0.1], 0.5), ([1.1, 0.1], 0.5)]);
    assert!(is_udim(&alike, Udim::On));
    let different = squares(&[([0.1, 0.1], 0.5), ([1.2, 0.1], 0.6)]);
    assert!(!is_udim(&different, Udim::Off));
}

#[test]
fn udim_refuses_tiles_without_a_number() {
    // v grows downward here, but programs that show tiles count it upward.
    for (place, u, v) in [
        ([-0.8, 0.1], -1, 0),
        ([10.2, 0.1], 10, 0),
        ([0.2, 1.1], 0, -1),
        ([-2.9, -3.9], -3, 4),
    ] {
        let mesh = squares(&[([0.1, 0.1], 0.5), (place, 0.3)]);
        let options = AtlasOptions {
            udim: Udim::On,
            ..AtlasOptions::new(64)
        };
        let error = Atlas::build(&mesh, &options).unwrap_err();
        assert_eq!(error, AtlasError::NoUdimNumber { triangle: 2, u, v });
        assert_eq!(udim_number([u, -v]), None);
    }
    let error = AtlasError::NoUdimNumber {
        triangle: 2,
        u: -1,
        v: 0,
    };
    assert_eq!(
        error.to_string(),
        "a UV chart (the one with triangle 2) lies in the UV tile with u from -1 to 0 and v, counted upward, from 0 to 1, which has no \
         UDIM number: those have u from 0 to 10, and v from 0 to 900"
    );
}

#[test]
fn only_uvs_that_repeat_too_often_are_found_not_udim_or_stacks() {
    let times = |mesh: &Mesh, udim: Udim| {
        let found = repeats(mesh, udim);
        found
            .iter()
            .map(|repeats| repeats.times.round() as u32)
            .collect::<Vec<_>>()
    };
    assert_eq!(times(&squares(&[([-1.0, 2.0], 5.0)]), Udim::Auto), [25]);
    assert_eq!(
        times(&squares(&[([0.0, 0.0], 2.5)]), Udim::Auto),
        [0_u32; 0],
        "a few times"
    );
    let stacked: Vec<([f32; 2], f32)> = (0..40).map(|_| ([0.05, 0.05], 0.9)).collect();
    assert_eq!(times(&squares(&stacked), Udim::Auto), [0_u32; 0], "stacked copies");
    let tiles: Vec<([f32; 2], f32)> = (0..10)
        .map(|tile| ([tile as f32 + 0.01, 0.01], 0.98 - 0.01 * tile as f32))
        .collect();
    assert_eq!(times(&squares(&tiles), Udim::Auto), [0_u32; 0], "tiles with numbers");
    assert_eq!(
        times(&squares(&tiles), Udim::Off),
        [9],
        "which repeat if that is asked for"
    );
    let mut two = squares(&[([0.0, 0.0], 4.0), ([0.1, 0.1], 0.5)]);
    two.triangle_material = vec![0, 0, 1, 1];
    let found = repeats(&two, Udim::Auto);
    assert_eq!(found.iter().map(|repeats| repeats.material).collect::<Vec<_>>(), [0]);
    two.is_one_sheet = true;
    assert!(repeats(&two, Udim::Auto).is_empty());
}

#[test]
fn charts_with_too_many_texels_are_refused_before_rasterization() {
    // 256 charts of a whole map of 2048² texels are twice the maximum of an atlas.
    let stacked: Vec<([f32; 2], f32)> = (0..256).map(|_| ([0.0, 0.0], 1.0)).collect();
    let error = Atlas::build(&squares(&stacked), &AtlasOptions::new(2048)).unwrap_err();
    let AtlasError::TooManyTexels { charts, needed, .. } = error else {
        panic!("{error}");
    };
    assert_eq!((charts, needed.as_str()), (256, "1073741824 texels"));
}

#[test]
fn a_chart_that_fills_the_largest_maps_fits_a_page() {
    let options = AtlasOptions::new(8192);
    assert_eq!(options.page_limit, 8208);
    assert_eq!(AtlasOptions::new(4096).page_limit, 8192);
    let atlas = Atlas::build(&squares(&[([0.0, 0.0], 1.0)]), &options).unwrap();
    assert_eq!((atlas.page_size, atlas.pages), ([8208; 2], 1));
    assert_eq!(atlas.charts[0].texels, 8192 * 8192);
}

#[test]
fn charts_overlap_on_the_maps_of_their_own_tile_alone() {
    // Charts 0 and 1 lie on each other in the first tile; 2 and 3 lie at the same place of others.
    let mesh = squares(&[
        ([0.1, 0.1], 0.5),
        ([0.1, 0.1], 0.5),
        ([1.1, 0.1], 0.5),
        ([2.1, 0.1], 0.5),
    ]);
    let overlap = |udim: Udim| {
        let options = AtlasOptions {
            udim,
            ..AtlasOptions::new(64)
        };
        let report = Atlas::build(&mesh, &options).unwrap().report;
        let pairs: Vec<[u32; 2]> = report.overlapping_charts.iter().map(|(a, b, _)| [*a, *b]).collect();
        (pairs, report.overlap_texels, report.stacked_charts, report.coverage)
    };
    // A square of 32 texels along a side.
    let texels = 32 * 32;
    let coverage = |squares: f32| 4.0 * texels as f32 / (squares * 4096.0);
    assert_eq!(overlap(Udim::On), (vec![[0, 1]], 2 * texels, 1, coverage(3.0)));
    let all = vec![[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
    assert_eq!(overlap(Udim::Off), (all, 4 * texels, 3, coverage(1.0)));
}

#[test]
fn a_chart_that_reaches_into_the_next_tile_overlaps_what_lies_there() {
    let overlap = |charts: &[([f32; 2], f32)]| {
        let options = AtlasOptions {
            udim: Udim::On,
            ..AtlasOptions::new(64)
        };
        Atlas::build(&squares(charts), &options).unwrap().report
    };
    // Half of the first one lies in the second tile, 16 columns of 32 rows.
    let report = overlap(&[([0.5, 0.25], 0.75), ([1.0, 0.25], 0.5)]);
    assert_eq!(report.overlapping_charts, [(0, 1, 16 * 32)]);
    assert_eq!((report.overlap_texels, report.stacked_charts), (2 * 16 * 32, 0));
    // Beyond the last tile it comes in again in its own one.
    let report = overlap(&[([0.5, 0.25], 0.75), ([0.0, 0.25], 0.5), ([2.0, 0.25], 0.5)]);
    assert_eq!(report.overlapping_charts, [(0, 1, 16 * 32)]);
}
