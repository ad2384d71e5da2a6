//! A displaced copy is drawn like the model: in the same place, on the same charts, with the same materials and the same lines.

use std::path::Path;

use sabi_surface::atlas::AtlasOptions;
use sabi_surface::displace::{DisplaceOptions, displaced};
use sabi_surface::load::{LoadOptions, load};
use sabi_surface::model::ModelMaterial;

use super::*;

fn asset(name: &str) -> (Model, Atlas) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../assets/meshes")
        .join(name);
    let model = load(&path, &LoadOptions::default()).unwrap();
    let atlas = Atlas::build(&model.mesh, &AtlasOptions::new(128)).unwrap();
    (model, atlas)
}

/// Returns two arms on a back, in one chart. In UV a gap of a hundredth separates the arms; in space one is bent forward
/// and the other backward.
fn fork() -> Model {
    let columns = [0.0131, 0.4113, 0.4217, 0.8391];
    let rows = [0.017, 0.293, 0.571, 0.731, 0.919];
    let mut mesh = Mesh::default();
    for y in rows {
        for (column, x) in columns.into_iter().enumerate() {
            let bend = if column < 2 { 1.0 } else { -1.0 };
            mesh.positions.push([x, y, bend * (rows[3] - y).max(0.0)]);
            mesh.normals.push([0.0, 0.0, 1.0]);
            mesh.tangents.push([1.0, 0.0, 0.0, 1.0]);
            mesh.uvs.push([x, y]);
        }
    }
    for row in 0..4 {
        for column in (0..3).filter(|&column| column != 1 || row == 3) {
            let [a, b, c, d] = [0, 1, 5, 4].map(|corner| 4 * row + column + corner);
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh.triangle_material = vec![0; mesh.triangles.len()];
    mesh.triangle_part = vec![0; mesh.triangles.len()];
    Model {
        mesh,
        materials: vec![ModelMaterial::default()],
        ..Model::default()
    }
}

/// Returns a copy that is cut into many triangles and raised everywhere by `height` model units.
fn raised(model: &Model, atlas: &Atlas, height: f32) -> DisplacedMesh {
    let options = DisplaceOptions {
        edge_length: 0.0,
        triangle_budget: 40_000,
    };
    displaced(&model.mesh, atlas, &options, |_, _| Some(height))
}

/// Length of all lines together, view units.
fn length(lines: &[Line]) -> f64 {
    let each = lines.iter().map(|line| {
        let [from, to] = [line.first, line.second].map(glam::Vec3::from);
        f64::from(from.distance(to))
    });
    each.sum()
}

#[test]
fn a_copy_that_is_not_raised_covers_each_material_like_the_model() {
    let (model, atlas) = asset("bench.glb");
    let placement = Placement::of(&model.mesh);
    let area_of_materials = |made: &DrawMesh| -> Vec<(u32, bool, f32)> {
        let area = |range: &MaterialRange| {
            let indices = &made.indices[range.indices.start as usize..range.indices.end as usize];
            let areas = indices.chunks(3).map(|corners| {
                let [a, b, c] = [0, 1, 2].map(|at| glam::Vec3::from(made.vertices[corners[at] as usize].position));
                (b - a).cross(c - a).length()
            });
            areas.sum()
        };
        let ranges = made.ranges.iter();
        ranges
            .map(|range| (range.material, range.is_double_sided, area(range)))
            .collect()
    };
    let copy = raised(&model, &atlas, 0.0);
    assert!(copy.triangles.len() > 2 * model.mesh.triangles.len());
    let whole = area_of_materials(&DrawMesh::of(&model, &atlas, &placement));
    let cut = area_of_materials(&DrawMesh::of_displaced(&copy, &model, &atlas, &placement));
    assert_eq!(whole.len(), cut.len());
    for ((material, sides, area), (of_copy, sides_of_copy, area_of_copy)) in whole.into_iter().zip(cut) {
        assert_eq!((material, sides), (of_copy, sides_of_copy));
        assert!((area - area_of_copy).abs() <= 1e-3 * area, "{area} {area_of_copy}");
    }
}

#[test]
fn each_corner_of_a_copy_is_on_the_chart_of_its_original_triangle() {
    let (model, atlas) = asset("cube.glb");
    let copy = raised(&model, &atlas, 0.0);
    let made = DrawMesh::of_displaced(&copy, &model, &atlas, &Placement::of(&model.mesh));
    assert_eq!(made.vertices.len(), copy.positions.len());
    for (corners, &from) in copy.triangles.iter().zip(&copy.triangle_from) {
        for &corner in corners {
            assert_eq!(
                made.vertices[corner as usize].chart,
                atlas.triangle_chart[from as usize]
            );
        }
    }
}

#[test]
fn a_raised_copy_extends_beyond_the_model() {
    let (model, atlas) = asset("sphere.glb");
    let placement = Placement::of(&model.mesh);
    let height = (0.1 / placement.scale) as f32;
    let made = DrawMesh::of_displaced(&raised(&model, &atlas, height), &model, &atlas, &placement);
    for corner in &made.vertices {
        let radius = glam::Vec3::from(corner.position).length();
        assert!((0.59..0.61).contains(&radius), "{radius}");
    }
}

#[test]
fn cuts_at_narrow_gaps_of_a_chart_are_no_seams() {
    let model = fork();
    let placement = Placement::of(&model.mesh);
    let of_size = |size: u32| {
        let atlas = Atlas::build(&model.mesh, &AtlasOptions::new(size)).unwrap();
        let copy = raised(&model, &atlas, 0.0);
        let of_model = lines(half_edges(&model.mesh, &atlas), &placement);
        let of_copy = lines(displaced_half_edges(&copy, &atlas), &placement);
        let parts = atlas.charts.len() - atlas.uv_charts().len();
        (parts, [of_model, of_copy].map(|[_, seams]| length(&seams)))
    };
    let (whole, expected) = of_size(1024);
    let (parts, seams) = of_size(256);
    assert_eq!(whole, 0);
    assert!(parts > 0);
    for (length, expected) in seams.into_iter().zip(expected) {
        assert!((length - expected).abs() < 1e-4 * expected, "{length} {expected}");
    }
}

#[test]
fn a_copy_has_the_lines_of_the_model_at_its_raised_edges() {
    let (model, atlas) = asset("cube.glb");
    let placement = Placement::of(&model.mesh);
    let [edges, seams] = lines(half_edges(&model.mesh, &atlas), &placement);
    let flat = raised(&model, &atlas, 0.0);
    let [cut_edges, cut_seams] = lines(displaced_half_edges(&flat, &atlas), &placement);
    assert!(cut_edges.len() > 4 * edges.len(), "in pieces, so that they bend");
    assert!((length(&edges) - length(&cut_edges)).abs() < 1e-4 * length(&edges));
    assert!((length(&seams) - length(&cut_seams)).abs() < 1e-4 * length(&seams));
    let height = (0.25 / placement.scale) as f32;
    let [risen, _] = lines(
        displaced_half_edges(&raised(&model, &atlas, height), &atlas),
        &placement,
    );
    let reach = |lines: &[Line]| {
        let places = lines.iter().flat_map(|line| [line.first, line.second]).flatten();
        places.fold(0.0, |reach: f32, place| reach.max(place.abs()))
    };
    assert!(reach(&risen) > reach(&edges) + 0.1);
}
