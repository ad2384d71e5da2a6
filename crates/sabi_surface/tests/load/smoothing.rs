//! Smoothing of models that come with the normals of their faces.

use std::f32::consts::PI;
use std::fmt::Write as _;

use sabi_surface::load::{LoadError, LoadOptions, load_bytes};
use sabi_surface::model::Mesh;
use serde_json::json;

use crate::builder::{Gltf, nothing};
use crate::promises;

type Corners = [[f32; 3]; 3];

/// An OBJ file of separate triangles with the normals of their faces, as exporters of plain triangles write it.
fn flat_obj(triangles: &[Corners]) -> String {
    let mut text = String::from("vt 0 0\nvt 1 0\nvt 0.5 1\n");
    for (number, corners) in triangles.iter().enumerate() {
        for [x, y, z] in corners {
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
        let [x, y, z] = face_normal(*corners);
        writeln!(text, "vn {x} {y} {z}").unwrap();
        let (first, normal) = (number * 3 + 1, number + 1);
        let corner = |corner: usize| format!("{}/{}/{normal}", first + corner, corner + 1);
        writeln!(text, "f {} {} {}", corner(0), corner(1), corner(2)).unwrap();
    }
    text
}

fn face_normal([a, b, c]: Corners) -> [f32; 3] {
    let edge = |to: [f32; 3]| [0, 1, 2].map(|axis| to[axis] - a[axis]);
    let ([ux, uy, uz], [vx, vy, vz]) = (edge(b), edge(c));
    unit([uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx])
}

fn unit(vector: [f32; 3]) -> [f32; 3] {
    let length = dot(vector, vector).sqrt();
    vector.map(|value| value / length)
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

fn read(text: &str, degrees: Option<f32>) -> Result<Mesh, LoadError> {
    let options = LoadOptions {
        smooth_degrees: degrees,
        ..LoadOptions::default()
    };
    let model = load_bytes("flat.obj", text.as_bytes(), &mut nothing, &options)?;
    assert_eq!(model.is_smoothed, degrees.is_some());
    assert_eq!(model.warnings, [""; 0]);
    promises::check(&model);
    Ok(model.mesh)
}

fn octahedron() -> Vec<Corners> {
    let signs = [1.0, -1.0];
    let faces = signs
        .into_iter()
        .flat_map(|x| signs.into_iter().flat_map(move |y| signs.map(|z| [x, y, z])));
    faces
        .map(|[x, y, z]| {
            let corners = [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]];
            let [a, b, c] = corners;
            if x * y * z > 0.0 { corners } else { [a, c, b] }
        })
        .collect()
}

/// A sphere of 48 × 24 facets around the origin.
fn sphere() -> Vec<Corners> {
    let at = |column: u32, row: u32| {
        let (around, down) = (column as f32 / 24.0 * PI, row as f32 / 24.0 * PI);
        // One position for all columns, as weld would have it.
        let around = if column == 48 { 0.0 } else { around };
        match row {
            0 => [0.0, 1.0, 0.0],
            24 => [0.0, -1.0, 0.0],
            _ => [down.sin() * around.sin(), down.cos(), down.sin() * around.cos()],
        }
    };
    let cells = (0..48).flat_map(|column| (0..24).map(move |row| (column, row)));
    cells
        .flat_map(|(column, row)| {
            let [a, b] = [at(column, row), at(column + 1, row)];
            let [c, d] = [at(column, row + 1), at(column + 1, row + 1)];
            [(row < 23).then_some([a, c, d]), (row > 0).then_some([a, d, b])]
        })
        .flatten()
        .collect()
}

fn cube() -> Vec<Corners> {
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for side in [-1.0f32, 1.0] {
            let at = |u: f32, v: f32| {
                let mut at = [0.0; 3];
                (at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3]) = (side, u * side, v);
                at
            };
            let [a, b, c, d] = [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles
}

#[test]
fn the_normals_of_a_smoothed_octahedron_are_its_axes() {
    let text = flat_obj(&octahedron());
    let flat = read(&text, None).unwrap();
    assert!(flat.normals.iter().all(|normal| normal[0].abs() < 0.6));
    // Neighbors turn by 70.5 degrees.
    let kept = read(&text, Some(70.0)).unwrap();
    for (kept, flat) in kept.normals.iter().zip(&flat.normals) {
        assert!(dot(*kept, *flat) > 1.0 - 1e-6);
    }
    let smooth = read(&text, Some(71.0)).unwrap();
    for (position, normal) in smooth.positions.iter().zip(&smooth.normals) {
        assert!(dot(*position, *normal) > 1.0 - 1e-6, "{position:?} {normal:?}");
    }
}

#[test]
fn the_normals_of_a_smoothed_sphere_point_away_from_its_middle_and_tangents_follow() {
    let text = flat_obj(&sphere());
    let flat = read(&text, None).unwrap();
    let smooth = read(&text, Some(30.0)).unwrap();
    let worst = |mesh: &Mesh| {
        let along = mesh.positions.iter().zip(&mesh.normals);
        along
            .map(|(position, normal)| dot(*position, *normal))
            .fold(1.0, f32::min)
    };
    assert!(worst(&flat) < 0.998, "facets: {}", worst(&flat));
    assert!(worst(&smooth) > 0.9999, "round: {}", worst(&smooth));
    for (normal, [x, y, z, _]) in smooth.normals.iter().zip(&smooth.tangents) {
        assert!(dot(*normal, [*x, *y, *z]).abs() < 1e-5, "a tangent of the flat face");
    }
    assert_eq!(
        smooth,
        read(&text, Some(30.0)).unwrap(),
        "the same call, the same numbers"
    );
}

#[test]
fn a_cube_stays_a_cube_below_its_right_angles() {
    let text = flat_obj(&cube());
    let flat = read(&text, None).unwrap();
    for degrees in [0.0, 30.0, 90.0] {
        assert_eq!(read(&text, Some(degrees)).unwrap(), flat, "{degrees}");
    }
    let round = read(&text, Some(91.0)).unwrap();
    for (position, normal) in round.positions.iter().zip(&round.normals) {
        let diagonal = unit(*position);
        // Faces count by their angle: two triangles of 45 degrees on a face as one of 90.
        assert!(dot(diagonal, *normal) > 1.0 - 1e-6, "{position:?} {normal:?}");
    }
}

#[test]
fn a_gltf_file_loses_its_own_normals_and_tangents_to_smooth_ones() {
    let mut file = Gltf::triangle();
    let tilted: Vec<f32> = unit([0.3, 0.1, 1.0]).repeat(3);
    let normals = file.floats("VEC3", &tilted);
    let tangents = file.floats("VEC4", &[0.0, 1.0, 0.0, 1.0].repeat(3));
    let attributes = &mut file.primitive()["attributes"];
    attributes["NORMAL"] = json!(normals);
    attributes["TANGENT"] = json!(tangents);
    let options = LoadOptions {
        smooth_degrees: Some(40.0),
        ..LoadOptions::default()
    };
    let mesh = file.load_with(&options).unwrap().mesh;
    let corners = mesh.triangles[0].map(|vertex| mesh.positions[vertex as usize]);
    for normal in &mesh.normals {
        assert!(dot(*normal, face_normal(corners)) > 1.0 - 1e-6);
    }
    // U runs along x.
    assert!(
        mesh.tangents.iter().all(|tangent| tangent[0] > 0.999),
        "{:?}",
        mesh.tangents
    );
}

#[test]
fn an_angle_that_is_none_between_faces_is_refused_with_a_sentence() {
    for degrees in [-1.0, 180.5, f32::INFINITY] {
        let error = read(&flat_obj(&cube()), Some(degrees)).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!(
                "flat.obj: faces cannot be smoothed up to an angle of {degrees}; give degrees from 0 (all flat) to 180 (all \
                 smooth)"
            )
        );
    }
    assert!(read(&flat_obj(&cube()), Some(f32::NAN)).is_err());
}
