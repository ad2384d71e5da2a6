//! A quad of two triangles with a picture, which the packed files of the tests hold. They were written by gltf-transform
//! with Google's encoder of Draco 1.5.7 and that of meshoptimizer 1.3.

use sabi_surface::model::Model;

use crate::builder::Gltf;

const DRACO: &[u8] = include_bytes!("../../../../fuzz/seeds/gltf/draco.glb");
const DRACO_SEQUENTIAL: &[u8] = include_bytes!("../../../../fuzz/seeds/gltf/draco_sequential.glb");
const MESHOPT: &[u8] = include_bytes!("../../../../fuzz/seeds/gltf/meshopt.glb");

/// Packed by Draco as one run of triangles that share edges.
pub(crate) fn draco() -> Gltf {
    Gltf::of_glb(DRACO)
}

/// Packed by meshoptimizer.
pub(crate) fn meshopt() -> Gltf {
    Gltf::of_glb(MESHOPT)
}

/// Position, UV and color.
pub(crate) type QuadCorner = ([f32; 3], [f32; 2], [f32; 4]);

/// The corners of the quad, whose normals are +z.
pub(crate) const CORNERS: [QuadCorner; 4] = [
    ([0.0, 0.0, 0.0], [0.0, 1.0], [1.0, 0.0, 0.0, 1.0]),
    ([1.0, 0.0, 0.0], [1.0, 1.0], [0.0, 1.0, 0.0, 1.0]),
    ([1.0, 1.0, 0.0], [1.0, 0.0], [0.0, 0.0, 1.0, 1.0]),
    ([0.0, 1.0, 0.0], [0.0, 0.0], [0.2, 0.4, 0.6, 0.8]),
];

/// Checks that a model is the quad, up to the order of vertices and the rounding of packed numbers.
pub(crate) fn check(model: &Model) {
    let mesh = &model.mesh;
    let near = |a: &[f32], b: &[f32]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.004);
    let mut faces: Vec<Vec<usize>> = Vec::new();
    for corners in &mesh.triangles {
        let corner = |vertex: &u32| {
            let at = *vertex as usize;
            let is_there = |(position, uv, color): &QuadCorner| {
                near(&mesh.positions[at], position) && near(&mesh.uvs[at], uv) && near(&mesh.colors[at], color)
            };
            assert!(near(&mesh.normals[at], &[0.0, 0.0, 1.0]), "{:?}", mesh.normals[at]);
            CORNERS.iter().position(is_there).unwrap()
        };
        let mut face: Vec<usize> = corners.iter().map(corner).collect();
        let first = (0..3).min_by_key(|at| face[*at]).unwrap();
        face.rotate_left(first);
        faces.push(face);
    }
    faces.sort();
    assert_eq!(faces, [[0, 1, 2], [0, 2, 3]]);
}

#[test]
fn a_packed_quad_is_what_it_was() {
    for (way, file) in [
        ("Draco", DRACO),
        ("Draco, vertex by vertex", DRACO_SEQUENTIAL),
        ("meshopt", MESHOPT),
    ] {
        let model = Gltf::of_glb(file).model();
        check(&model);
        assert_eq!(model.warnings, [""; 0], "{way}");
        assert!(model.images[0].bytes.as_ref().unwrap().starts_with(b"\x89PNG"), "{way}");
    }
}
