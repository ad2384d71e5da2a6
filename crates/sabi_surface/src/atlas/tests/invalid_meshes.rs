//! Invalid and degenerate meshes.

use super::shapes::*;
use crate::atlas::{Atlas, AtlasError, AtlasOptions, GHOST_BIT};
use crate::model::Mesh;

fn build(mesh: &Mesh, size: u32) -> Result<Atlas, AtlasError> {
    Atlas::build(mesh, &AtlasOptions::new(size))
}

fn told(mesh: &Mesh, options: AtlasOptions) -> String {
    Atlas::build(mesh, &options).unwrap_err().to_string()
}

fn assert_finite(atlas: &Atlas) {
    for ghost in &atlas.ghosts {
        let numbers = ghost.target_texel.iter().chain(ghost.target_from_own.iter().flatten());
        assert!(numbers.into_iter().all(|value| value.is_finite()), "{ghost:?}");
    }
    assert!(atlas.report.coverage.is_finite());
}

#[test]
fn errors_advise_what_to_do() {
    let mesh = cube(1);
    let mut bare = mesh.clone();
    bare.uvs.clear();
    assert_eq!(
        told(&bare, AtlasOptions::new(64)),
        "the model has no texture coordinates, and the maps need a place for every part of it; unwrap it in your \
         modeling program and export it with UVs"
    );
    assert_eq!(
        told(&Mesh::default(), AtlasOptions::new(64)),
        "the model has no triangles, so there is no surface to work on; choose a model with faces"
    );
    assert_eq!(
        told(&mesh, AtlasOptions::new(15)),
        "a size of 15 texels was asked for, but it has to be between 16 and 16384"
    );
    assert_eq!(
        told(
            &mesh,
            AtlasOptions {
                page_limit: 100,
                ..AtlasOptions::new(64)
            }
        ),
        "a page limit of 100 texels was asked for, but it has to be a multiple of 8 between 32 and 16384"
    );
    assert_eq!(
        told(
            &square(PatchFrame::straight([0.5, 0.5], 8.0), 1),
            AtlasOptions::new(2048)
        ),
        "a UV chart (the one with triangle 0) is 16385 × 16385 texels large at size 2048, but a page holds 8188 × 8188"
    );
    assert_eq!(
        told(
            &square(PatchFrame::straight([3e6, 0.5], 0.5), 1),
            AtlasOptions::new(1024)
        ),
        "the texture coordinate (2.9999998e6, 2.5e-1) of vertex 0 lies too far from the unit square to be placed at 1024 \
         texels"
    );
    assert_eq!(
        told(
            &square(PatchFrame::straight([0.5, 0.5], 0.001), 1),
            AtlasOptions::new(64)
        ),
        "the model's texture coordinates cover no texel at 64 texels for the unit square: they have no area, or next \
         to none; unwrap it in your modeling program or bake at a larger size"
    );
    let mut wild = mesh.clone();
    wild.triangles[3][1] = 999;
    assert_eq!(
        told(&wild, AtlasOptions::new(64)),
        "the mesh is damaged: a triangle names vertex 999 of 24; export the model again"
    );
    let mut short = mesh;
    short.triangle_part.pop();
    assert_eq!(
        told(&short, AtlasOptions::new(64)),
        "the mesh is damaged: not every triangle has a material and a part; export the model again"
    );
}

#[test]
fn sizes_that_do_not_fit_into_memory_are_refused_before_allocation() {
    let mut mesh = Mesh::default();
    for layer in 0..300 {
        let place = [f64::from(layer) * 2.0, 0.0, 0.0];
        patch(
            &mut mesh,
            [place, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            PatchFrame::straight([0.25, 0.25], 0.49),
            1,
        );
    }
    assert_eq!(
        told(&mesh, AtlasOptions::new(16384)),
        "at size 16384 the model's 300 UV charts need 19335406280 texels, but at most 536870912 texels can be held"
    );
}

#[test]
fn a_third_triangle_at_an_edge_is_a_border_and_the_sheet_stays_connected() {
    let mut mesh = square(PatchFrame::straight([0.3, 0.5], 0.4), 2);
    // The middle edge of the sheet gets a third triangle with its own vertices.
    let first = mesh.positions.len() as u32;
    mesh.positions
        .extend([[0.5, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.25, 0.4]]);
    mesh.uvs.extend([[0.7, 0.3], [0.7, 0.6], [0.9, 0.45]]);
    triangle(&mut mesh, [first, first + 1, first + 2]);
    let atlas = build(&mesh, 128).unwrap();
    assert_eq!(atlas.report.nonmanifold_edges, 1);
    assert_eq!(atlas.charts.len(), 2);
    let fin = mesh.triangles.len() as u32 - 1;
    for ghost in &atlas.ghosts {
        let own = atlas.triangle_chart[fin as usize] == ghost.chart;
        assert_eq!(ghost.target_triangle == fin, own, "a link crosses the fin");
    }
    assert!(
        atlas.report.warnings.iter().any(|warning| {
            warning == "1 edge is shared by more than two triangles; filters treat those as borders"
        })
    );
    // If all three triangles share their vertices, the connection is ambiguous, and each of them gets a border.
    let last = mesh.triangles.len() - 1;
    mesh.triangles[last] = [1, 4, first + 2];
    let atlas = build(&mesh, 128).unwrap();
    assert_eq!(atlas.report.nonmanifold_edges, 1);
    assert_finite(&atlas);
}

#[test]
fn two_coincident_sheets_stay_separate() {
    let mut mesh = square(PatchFrame::straight([0.3, 0.5], 0.4), 3);
    let front = mesh.triangles.len();
    patch(
        &mut mesh,
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        PatchFrame::straight([0.75, 0.5], 0.4),
        3,
    );
    for corners in &mut mesh.triangles[front..] {
        corners.swap(1, 2);
    }
    let atlas = build(&mesh, 128).unwrap();
    assert_eq!(atlas.charts.len(), 2);
    assert_eq!(atlas.report.unlinked_ghosts, 0);
}

#[test]
fn triangles_without_area_are_handled() {
    let mut mesh = cube(3);
    let vertices = mesh.positions.len() as u32;
    // No area in UV, no area in space, neither, a single point, and a sliver between two neighbors.
    for k in 0..24 {
        let at = k * 7 % vertices;
        triangle(&mut mesh, [at, at, (at + 1) % vertices]);
        triangle(&mut mesh, [at, at, at]);
        let base = mesh.positions.len() as u32;
        let p = mesh.positions[at as usize];
        mesh.positions.extend([p, p, [p[0] + 0.1, p[1], p[2]]]);
        let uv = mesh.uvs[at as usize];
        mesh.uvs.extend([uv, [uv[0] + 0.02, uv[1]], [uv[0], uv[1] + 0.02]]);
        triangle(&mut mesh, [base, base + 1, base + 2]);
        mesh.positions
            .extend([p, [p[0] + 0.1, p[1], p[2]], [p[0], p[1] + 0.1, p[2]]]);
        mesh.uvs.extend([uv, uv, uv]);
        triangle(&mut mesh, [base + 3, base + 4, base + 5]);
    }
    for size in [16, 100, 333] {
        let atlas = build(&mesh, size).unwrap();
        assert_finite(&atlas);
        assert_eq!(atlas.report.degenerate_uv_triangles, 24 * 3);
        assert_eq!(atlas.report.degenerate_triangles, 24 * 3);
    }
}

#[test]
fn nan_and_infinity_are_handled() {
    let mut mesh = cube(4);
    for (k, value) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN_POSITIVE]
        .into_iter()
        .enumerate()
    {
        mesh.positions[k * 9] = [value, 0.0, value];
        if value.abs() < 1e6 || !value.is_finite() {
            mesh.uvs[k * 9 + 4] = [value, 0.5];
        }
    }
    assert_finite(&build(&mesh, 100).unwrap());
}

#[test]
fn links_pass_through_triangles_without_a_place_on_the_maps() {
    // Two patches in a plane, joined by a strip whose UVs lie on a line.
    let mut mesh = Mesh::default();
    patch(
        &mut mesh,
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        PatchFrame::straight([0.25, 0.5], 0.3),
        1,
    );
    patch(
        &mut mesh,
        [[1.0, 0.0, 0.0], [0.001, 0.0, 0.0], [0.0, 1.0, 0.0]],
        PatchFrame::straight([0.5, 0.1], 0.0),
        1,
    );
    patch(
        &mut mesh,
        [[1.001, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        PatchFrame::straight([0.75, 0.5], 0.3),
        1,
    );
    let atlas = build(&mesh, 100).unwrap();
    assert_eq!(atlas.report.degenerate_uv_triangles, 2);
    assert_eq!(atlas.report.unlinked_ghosts, 0);
    let crossing = atlas.ghosts.iter().filter(|ghost| {
        let target = atlas.triangle_chart[ghost.target_triangle as usize];
        ghost.chart != target
    });
    assert!(crossing.count() > 100);
}

#[test]
fn a_folded_chart_becomes_two_charts() {
    let mut mesh = Mesh::default();
    mesh.positions
        .extend([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    // The second triangle folds back over the first.
    mesh.uvs.extend([[0.2, 0.2], [0.6, 0.2], [0.6, 0.6], [0.55, 0.3]]);
    triangle(&mut mesh, [0, 1, 2]);
    triangle(&mut mesh, [0, 2, 3]);
    let atlas = build(&mesh, 64).unwrap();
    assert_eq!(atlas.charts.len(), 2);
    assert_eq!(atlas.charts.iter().filter(|chart| chart.mirrored).count(), 1);
    assert_eq!(atlas.report.overlapping_charts.len(), 1);
}

#[test]
fn charts_too_small_for_a_texel_are_reported() {
    let mut mesh = cube(1);
    patch(
        &mut mesh,
        [[9.0, 0.0, 0.0], [0.3, 0.0, 0.0], [0.0, 0.3, 0.0]],
        PatchFrame::straight([0.9, 0.9], 0.0005),
        1,
    );
    let atlas = build(&mesh, 128).unwrap();
    assert_eq!(atlas.charts[6].texels, 0);
    assert_eq!(atlas.charts[6].bounds, [0; 4]);
    assert_eq!(atlas.report.thin_charts, 1);
    assert!(
        atlas.report.warnings.contains(
            &"1 UV chart is thinner than two texels at size 128; a larger size or fewer, larger charts would help"
                .to_owned()
        )
    );
    assert!(
        atlas
            .owners
            .iter()
            .all(|&owner| owner & GHOST_BIT != 0 || atlas.triangle_chart[owner as usize] != 6)
    );
}

#[test]
fn an_atlas_that_needs_too_much_memory_is_refused_before_allocation() {
    // Charts of the whole square: 4 at 2048 texels have 16 MiB of texels with 8 bytes each.
    let mut mesh = square(PatchFrame::straight([0.0, 0.0], 1.0), 1);
    let one = mesh.clone();
    for copy in 1..4 {
        let first = mesh.positions.len() as u32;
        mesh.positions
            .extend(one.positions.iter().map(|[x, y, z]| [*x, *y, z + copy as f32]));
        mesh.normals.extend(&one.normals);
        mesh.tangents.extend(&one.tangents);
        mesh.uvs.extend(&one.uvs);
        mesh.triangles
            .extend(one.triangles.iter().map(|corners| corners.map(|v| v + first)));
        mesh.triangle_material.extend(&one.triangle_material);
        mesh.triangle_part.extend(&one.triangle_part);
    }
    let limited = |memory_bytes: u64| {
        let options = AtlasOptions {
            memory_bytes,
            ..AtlasOptions::new(2048)
        };
        Atlas::build(&mesh, &options)
    };
    assert!(limited(u64::MAX).is_ok());
    for memory_bytes in [1 << 20, 64 << 20] {
        let told = limited(memory_bytes).unwrap_err();
        assert!(matches!(told, AtlasError::Memory { charts: 4, .. }), "{told}");
    }
    assert_eq!(
        limited(1 << 20).unwrap_err().to_string(),
        "at size 2048 the layout of the model's 4 UV charts needs 7 MiB of memory, and there are 1 for it"
    );
}
