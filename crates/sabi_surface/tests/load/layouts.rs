//! Every legal way to store numbers reads as the same numbers.

use serde_json::{Value, json};

use crate::builder::{F32, Gltf, I16, U8, U16, U32, floats, shorts};

const CORNERS: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// Adds positions to a file and gives their accessor.
type StorePositions = fn(&mut Gltf) -> usize;

/// The triangle with its positions stored by `store`, which gives their accessor.
fn stored(store: StorePositions) -> Gltf {
    let mut file = Gltf::new();
    let positions = store(&mut file);
    file.place("leaf", json!({ "attributes": { "POSITION": positions } }));
    file
}

fn edited(file: &mut Gltf, accessor: usize, edit: Value) -> usize {
    for (key, value) in edit.as_object().unwrap() {
        file.json["accessors"][accessor][key] = value.clone();
    }
    accessor
}

#[test]
fn positions_read_the_same_however_they_are_stored() {
    let ways: [(&str, StorePositions); 9] = [
        ("floats", |file| file.floats("VEC3", CORNERS.as_flattened())),
        ("floats apart", |file| {
            let padded: Vec<f32> = CORNERS.iter().flat_map(|[x, y, z]| [*x, *y, *z, 7.0, 7.0]).collect();
            let accessor = file.accessor(F32, "VEC3", 3, &floats(&padded));
            file.json["bufferViews"][0]["byteStride"] = json!(20);
            accessor
        }),
        ("the last element without its gap", |file| {
            let padded: Vec<f32> = CORNERS.iter().flat_map(|[x, y, z]| [*x, *y, *z, 7.0]).collect();
            let accessor = file.accessor(F32, "VEC3", 3, &floats(&padded[..11]));
            file.json["bufferViews"][0]["byteStride"] = json!(16);
            accessor
        }),
        ("floats behind an offset", |file| {
            let values = [&[9.0, 9.0][..], CORNERS.as_flattened()].concat();
            let accessor = file.accessor(F32, "VEC3", 3, &floats(&values));
            edited(file, accessor, json!({ "byteOffset": 8 }))
        }),
        ("plain bytes", |file| {
            file.accessor(U8, "VEC3", 3, &[0, 0, 0, 1, 0, 0, 0, 1, 0])
        }),
        ("normalized unsigned", |file| {
            let accessor = file.accessor(U16, "VEC3", 3, &shorts(&[0, 0, 0, 65535, 0, 0, 0, 65535, 0]));
            edited(file, accessor, json!({ "normalized": true }))
        }),
        ("normalized signed", |file| {
            let accessor = file.accessor(I16, "VEC3", 3, &shorts(&[0, 0, 0, 32767, 0, 0, 0, 32767, 0]));
            edited(file, accessor, json!({ "normalized": true }))
        }),
        ("sparse over values", |file| {
            let base = file.floats("VEC3", &[0.0; 9]);
            sparse_over(file, base, &[1, 2], U8)
        }),
        ("sparse over nothing", |file| {
            let base = file.push("accessors", json!({ "componentType": F32, "type": "VEC3", "count": 3 }));
            sparse_over(file, base, &shorts(&[1, 2]), U16)
        }),
    ];
    for (way, store) in ways {
        let model = stored(store).model();
        assert_eq!(model.mesh.positions, CORNERS, "{way}");
        assert_eq!(model.mesh.triangles, [[0, 1, 2]], "{way}");
        assert_eq!(model.mesh.normals, [[0.0, 0.0, 1.0]; 3], "{way}");
    }
}

fn sparse_over(file: &mut Gltf, base: usize, indices: &[u8], component: u32) -> usize {
    let indices = file.view(indices);
    let values = file.view(&floats(&CORNERS.as_flattened()[3..]));
    let sparse = json!({ "count": 2, "indices": { "bufferView": indices, "componentType": component },
        "values": { "bufferView": values } });
    edited(file, base, json!({ "sparse": sparse }))
}

#[test]
fn signed_integers_reach_exactly_minus_one() {
    let file = stored(|file| {
        let accessor = file.accessor(I16, "VEC3", 3, &shorts(&[0x8000, 0, 0, 0x8001, 0, 32767, 0, 32767, 0]));
        edited(file, accessor, json!({ "normalized": true }))
    });
    assert_eq!(
        file.model().mesh.positions,
        [[-1.0, 0.0, 0.0], [-1.0, 0.0, 1.0], [0.0, 1.0, 0.0]]
    );
}

#[test]
fn indices_read_the_same_however_they_are_stored() {
    let shorts = shorts(&[2, 0, 1]);
    let words: Vec<u8> = [2u32, 0, 1].iter().flat_map(|index| index.to_le_bytes()).collect();
    for (component, bytes) in [(U8, &[2, 0, 1][..]), (U16, &shorts), (U32, &words)] {
        let mut file = Gltf::triangle();
        let indices = file.accessor(component, "SCALAR", 3, bytes);
        file.primitive()["indices"] = json!(indices);
        assert_eq!(file.model().mesh.triangles, [[2, 0, 1]]);
    }
}

#[test]
fn strips_and_fans_are_unrolled_and_lines_left_out() {
    let mut file = Gltf::new();
    let square = [
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.5, 2.0, 0.0,
    ];
    let positions = file.floats("VEC3", &square);
    file.place("leaf", json!({ "attributes": { "POSITION": positions } }));
    for (mode, order, triangles) in [
        (4, vec![0, 1, 2, 0, 2, 3, 1], vec![[0, 1, 2], [0, 2, 3]]),
        (5, vec![0, 1, 3, 2, 4], vec![[0, 1, 3], [1, 2, 3], [3, 2, 4]]),
        (6, vec![0, 1, 2, 3], vec![[1, 2, 0], [2, 3, 0]]),
    ] {
        let mut file = file.clone();
        let indices = file.accessor(U8, "SCALAR", order.len(), &order);
        let primitive = file.primitive();
        primitive["indices"] = json!(indices);
        primitive["mode"] = json!(mode);
        let mesh = file.model().mesh;
        let corners = |triangle: &[u32; 3]| triangle.map(|vertex| mesh.positions[vertex as usize]);
        let expected: Vec<[[f32; 3]; 3]> = triangles
            .iter()
            .map(|triangle| triangle.map(|vertex| square.as_chunks().0[vertex]))
            .collect();
        assert_eq!(
            mesh.triangles.iter().map(corners).collect::<Vec<_>>(),
            expected,
            "mode {mode}"
        );
        assert_eq!(mesh.normals, vec![[0.0, 0.0, 1.0]; mesh.positions.len()], "mode {mode}");
    }
    let mut file = Gltf::triangle();
    let lines = file.primitive().clone();
    file.place("wire", lines);
    file.json["meshes"][1]["primitives"][0]["mode"] = json!(3);
    let model = file.model();
    assert_eq!(model.mesh.triangles.len(), 1);
    assert_eq!(model.warnings, ["Points and lines of mesh `wire` are left out."]);
}

#[test]
fn vertices_that_no_triangle_uses_are_dropped() {
    let mut file = Gltf::new();
    let positions = file.floats("VEC3", &[9.0, 9.0, 9.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let indices = file.accessor(U8, "SCALAR", 3, &[1, 2, 3]);
    file.place(
        "leaf",
        json!({ "attributes": { "POSITION": positions }, "indices": indices }),
    );
    assert_eq!(file.model().mesh.positions, CORNERS);
}

#[test]
fn vertex_colors_are_rgba_whether_alpha_is_stored_or_not() {
    for (shape, bytes) in [("VEC3", [255, 0, 51].repeat(3)), ("VEC4", [255, 0, 51, 255].repeat(3))] {
        let mut file = Gltf::triangle();
        let colors = file.accessor(U8, shape, 3, &bytes);
        edited(&mut file, colors, json!({ "normalized": true }));
        file.primitive()["attributes"]["COLOR_0"] = json!(colors);
        assert_eq!(file.model().mesh.colors, [[1.0, 0.0, 0.2, 1.0]; 3]);
    }
}
