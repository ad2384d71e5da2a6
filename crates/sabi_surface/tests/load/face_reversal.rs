//! Turning of faces that are inside out.

use std::fmt::Write as _;

use sabi_surface::load::{LoadOptions, load_bytes};
use sabi_surface::model::Model;
use serde_json::json;

use crate::builder::{Gltf, nothing};
use crate::promises;

/// Corners of a cube of side 2 about the origin, and its faces, which look outward.
const CORNERS: [[f32; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];
const FACES: [[usize; 3]; 12] = [
    [0, 2, 1],
    [0, 3, 2],
    [4, 5, 6],
    [4, 6, 7],
    [0, 1, 5],
    [0, 5, 4],
    [3, 7, 6],
    [3, 6, 2],
    [0, 4, 7],
    [0, 7, 3],
    [1, 2, 6],
    [1, 6, 5],
];

/// Texture coordinates in which every face has an area.
fn uv([x, y, z]: [f32; 3]) -> [f32; 2] {
    [x + 0.5 * z, y + 0.25 * z]
}

/// Statement of a file about normals.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Normals {
    /// Nothing: they are computed.
    None,
    /// Those of a ball, outward everywhere.
    Outward,
    /// Outward, but inward at corners of faces that look inward.
    AsFaces,
}

fn wound(face: [usize; 3], is_inward: bool) -> [usize; 3] {
    let [a, b, c] = face;
    if is_inward { [a, c, b] } else { face }
}

fn obj(inward: &[usize], normals: Normals) -> Vec<u8> {
    let mut text = String::new();
    for at in CORNERS {
        let ([x, y, z], [u, v]) = (at, uv(at));
        write!(
            text,
            "v {x} {y} {z}\nvt {u} {v}\nvn {x} {y} {z}\nvn {} {} {}\n",
            -x, -y, -z
        )
        .unwrap();
    }
    for (number, face) in FACES.into_iter().enumerate() {
        let is_inward = inward.contains(&number);
        let corner = |corner: usize| match normals {
            Normals::None => format!("{0}/{0}", corner + 1),
            _ => {
                let is_reversed = is_inward && normals == Normals::AsFaces;
                format!("{0}/{0}/{1}", corner + 1, 2 * corner + 1 + usize::from(is_reversed))
            }
        };
        let [a, b, c] = wound(face, is_inward).map(corner);
        writeln!(text, "f {a} {b} {c}").unwrap();
    }
    text.into_bytes()
}

/// The cube, with vertices that all faces share where normals are told, in a primitive for each half of its faces.
fn glb(inward: &[usize], normals: Normals) -> Vec<u8> {
    let mut file = Gltf::new();
    let positions = file.floats("VEC3", CORNERS.as_flattened());
    let uvs: Vec<f32> = CORNERS.iter().flat_map(|at| uv(*at)).collect();
    let uvs = file.floats("VEC2", &uvs);
    let mut primitives = Vec::new();
    for half in [0..6, 6..12] {
        let faces = half.map(|number| wound(FACES[number], inward.contains(&number)));
        let indices: Vec<u8> = faces.flatten().map(|corner| corner as u8).collect();
        let indices = file.accessor(crate::builder::U8, "SCALAR", 18, &indices);
        let mut attributes = json!({ "POSITION": positions, "TEXCOORD_0": uvs });
        if normals != Normals::None {
            attributes["NORMAL"] = json!(positions);
        }
        primitives.push(json!({ "attributes": attributes, "indices": indices }));
    }
    let mesh = file.push("meshes", json!({ "primitives": primitives }));
    // The second one is mirrored, and looks outward as the first one does.
    file.push("nodes", json!({ "mesh": mesh, "translation": [0.25, 0.5, 0.125] }));
    file.push(
        "nodes",
        json!({ "mesh": mesh, "scale": [-1, 1, 1], "translation": [8, 0, 0] }),
    );
    file.glb()
}

fn read(name: &str, bytes: &[u8], options: &LoadOptions) -> Model {
    let model = load_bytes(name, bytes, &mut nothing, options).unwrap();
    promises::check(&model);
    model
}

/// Position, normal and tangent of each corner, each face from its first corner on.
fn corners(model: &Model) -> Vec<[[f32; 3]; 3]> {
    let mesh = &model.mesh;
    let of = |vertex: &u32| {
        let [x, y, z, _] = mesh.tangents[*vertex as usize];
        [
            mesh.positions[*vertex as usize],
            mesh.normals[*vertex as usize],
            [x, y, z],
        ]
    };
    mesh.triangles.as_flattened().iter().map(of).collect()
}

#[test]
fn faces_that_are_turned_are_as_if_they_had_never_been_inside_out() {
    let turning = |smooth_degrees| LoadOptions {
        turns_faces: true,
        smooth_degrees,
        ..LoadOptions::default()
    };
    type File = fn(&[usize], Normals) -> Vec<u8>;
    let files: [(&str, File, usize); 2] = [("a.obj", obj, 1), ("a.glb", glb, 2)];
    let all: Vec<usize> = (0..12).collect();
    for (name, file, instances) in files {
        for normals in [Normals::None, Normals::Outward, Normals::AsFaces] {
            for smooth in [None, Some(100.0)] {
                let good = file(&[], normals);
                let plain = LoadOptions {
                    turns_faces: false,
                    ..turning(smooth)
                };
                let expected = read(name, &good, &plain);
                for inward in [&[][..], &[3], &[0, 1, 5, 8, 9], &all] {
                    let turned = read(name, &file(inward, normals), &turning(smooth));
                    let case = format!("{name} {normals:?} {smooth:?} {inward:?}");
                    assert_eq!(turned.turned_faces, inward.len() * instances, "{case}");
                    let (found, expected) = (corners(&turned), corners(&expected));
                    assert_eq!(found.len(), expected.len(), "{case}");
                    for (found, expected) in found.iter().zip(&expected) {
                        let (found, expected) = (found.as_flattened(), expected.as_flattened());
                        let mut pairs = found.iter().zip(expected);
                        // Tangents are made in the model's space, and not in that of the mesh.
                        assert!(
                            pairs.all(|(a, b)| (a - b).abs() < 1e-5),
                            "{case}: {found:?} {expected:?}"
                        );
                    }
                    let placed = turned.origins.iter().flat_map(|origins| &origins.placed);
                    for (number, placed) in placed.enumerate() {
                        let half = if number % 2 == 0 { 0..6 } else { 6..12 };
                        let has_turned = inward.iter().any(|face| half.contains(face));
                        assert_eq!(placed.is_turned, has_turned, "{case} {number}");
                    }
                }
            }
        }
    }
}

#[test]
fn an_open_sheet_is_not_turned() {
    let options = LoadOptions {
        turns_faces: true,
        ..LoadOptions::default()
    };
    let file = Gltf::triangle();
    let model = file.load_with(&options).unwrap();
    assert_eq!((model.turned_faces, &model.mesh), (0, &file.model().mesh));
}
