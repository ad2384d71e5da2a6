//! UDIM tiles told apart from textures that repeat.

use std::collections::BTreeSet;

use crate::atlas::Udim;
use crate::atlas::{Atlas, AtlasOptions};
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
fn several_tiles_are_udim_unless_something_tells_of_a_repeating_texture() {
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
fn a_corner_on_a_border_between_steps_does_not_hide_that_charts_are_alike() {
    // 0.5 is a border of the comparison; three units further its sum is rounded down.
    let mesh = squares(&[([0.5, 0.25], 0.3), ([3.499_999_8, 0.25], 0.3)]);
    assert!(!is_udim(&mesh, Udim::Auto));
}

#[test]
fn a_texture_of_the_model_that_repeats_is_no_udim() {
    let mesh = Mesh {
        repeating: BTreeSet::from([0]),
        ..squares(&[([0.1, 0.1], 0.5), ([1.2, 0.1], 0.6)])
    };
    assert!(!is_udim(&mesh, Udim::Auto));
    assert!(is_udim(&mesh, Udim::On), "asked for");
}

#[test]
fn udim_can_be_asked_for_and_refused() {
    let alike = squares(&[([0.1, 0.1], 0.5), ([1.1, 0.1], 0.5)]);
    assert!(is_udim(&alike, Udim::On));
    let different = squares(&[([0.1, 0.1], 0.5), ([1.2, 0.1], 0.6)]);
    assert!(!is_udim(&different, Udim::Off));
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
