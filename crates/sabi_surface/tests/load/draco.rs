//! Primitives packed by Draco.

use serde_json::{Value, json};

use crate::builder::{Gltf, GltfEdit, I8, I16, U8, floats};
use crate::packed_quad::{CORNERS, QuadCorner, check, draco};

const DRACO: &str = "KHR_draco_mesh_compression";

fn extension(file: &mut Gltf) -> &mut Value {
    &mut file.primitive()["extensions"][DRACO]
}

/// First byte of the Draco data.
fn start(file: &Gltf) -> usize {
    file.json["bufferViews"][1]["byteOffset"].as_u64().unwrap() as usize
}

#[test]
fn a_strip_is_unrolled_already() {
    let mut file = draco();
    file.primitive()["mode"] = json!(5);
    file.json["accessors"][0]["count"] = json!(4);
    let model = file.model();
    check(&model);
    assert_eq!(model.warnings, [""; 0]);
}

#[test]
fn numbers_are_stored_as_the_accessor_says() {
    let mut file = draco();
    file.json["extensionsRequired"] = json!([DRACO, "KHR_mesh_quantization"]);
    for (accessor, component, normalized) in [(1, I16, true), (1, I16, false), (2, I8, true), (3, U8, true)] {
        let mut file = file.clone();
        file.json["accessors"][accessor]["componentType"] = json!(component);
        file.json["accessors"][accessor]["normalized"] = json!(normalized);
        let model = file.model();
        check(&model);
        assert_eq!(model.warnings, [""; 0], "{accessor} {component}");
    }
}

#[test]
fn sparse_values_replace_those_of_draco() {
    let mut file = draco();
    let indices = file.view(&[2]);
    let values = file.view(&floats(&[5.0, 6.0, 7.0]));
    file.json["accessors"][1]["sparse"] = json!({ "count": 1,
        "indices": { "bufferView": indices, "componentType": U8 }, "values": { "bufferView": values } });
    let (is, was) = (file.model().mesh.positions, draco().model().mesh.positions);
    let changed: Vec<usize> = (0..4).filter(|vertex| is[*vertex] != was[*vertex]).collect();
    assert_eq!((&changed[..], is[changed[0]]), (&[2][..], [5.0, 6.0, 7.0]));
}

#[test]
fn an_accessor_that_is_not_packed_is_read_beside_those_that_are() {
    let mut file = draco();
    extension(&mut file)["attributes"]
        .as_object_mut()
        .unwrap()
        .remove("COLOR_0");
    let model = file.model();
    assert_eq!(model.mesh.colors, [[0.0; 4]; 4], "an accessor without bytes has zeros");
    let color = file.floats("VEC4", &[0.5; 16]);
    file.primitive()["attributes"]["COLOR_0"] = json!(color);
    assert_eq!(file.model().mesh.colors, [[0.5; 4]; 4]);
}

#[test]
fn plain_data_are_read_where_draco_is_not_required() {
    let mut file = draco();
    file.json.as_object_mut().unwrap().remove("extensionsRequired");
    check(&file.model());
    let corner = |part: fn(&QuadCorner) -> Vec<f32>| -> Vec<f32> { CORNERS.iter().flat_map(part).collect() };
    let plain = [
        file.accessor(U8, "SCALAR", 6, &[0, 1, 2, 0, 2, 3]),
        file.floats("VEC3", &corner(|(position, ..)| position.to_vec())),
        file.floats("VEC3", &[0.0, 0.0, 1.0].repeat(4)),
        file.floats("VEC2", &corner(|(_, uv, _)| uv.to_vec())),
        file.floats("VEC4", &corner(|(.., color)| color.to_vec())),
    ];
    for (accessor, plain) in plain.into_iter().enumerate() {
        file.json["accessors"][accessor] = file.json["accessors"][plain].clone();
    }
    let start = start(&file);
    file.bytes[start] = b'?';
    let model = file.model();
    check(&model);
    assert_eq!(model.mesh.positions, CORNERS.map(|(position, ..)| position));
    file.json["extensionsRequired"] = json!([DRACO]);
    assert!(file.load().is_err(), "what is required has no plain data to rely on");
}

#[test]
fn another_number_of_vertices_is_told() {
    let mut file = draco();
    for accessor in 1..5 {
        file.json["accessors"][accessor]["count"] = json!(3);
    }
    let model = file.model();
    check(&model);
    let sentence = "The accessor of the positions of mesh `leaf` says 3, and its Draco data has 4; these are taken.";
    assert_eq!(model.warnings[0], sentence);
}

const FAULTS: &[(GltfEdit, &str)] = &[
    (
        |f| *extension(f) = json!({}),
        "mesh `leaf` has no `bufferView` or no `attributes` in its KHR_draco_mesh_compression",
    ),
    (|f| extension(f)["bufferView"] = json!(9), "there is no bufferViews[9]"),
    (
        |f| extension(f)["attributes"]["POSITION"] = json!(7),
        "accessors[1] (positions of mesh `leaf`) is attribute 7 of its Draco data, which is not there",
    ),
    (
        |f| extension(f)["attributes"]["POSITION"] = json!(2),
        "accessors[1] (positions of mesh `leaf`) has elements of 3 numbers, and its Draco data has elements of 2",
    ),
    (
        |f| {
            let start = start(f);
            f.bytes[start] = b'?';
        },
        "the Draco data of mesh `leaf` cannot be unpacked (Invalid magic)",
    ),
    (
        |f| f.json["accessors"][0]["count"] = json!(5),
        "the Draco data of mesh `leaf` has more triangles or vertices than its accessors (1 and 4)",
    ),
    (
        |f| f.json["accessors"][1]["count"] = json!(0),
        "the Draco data of mesh `leaf` has more triangles or vertices than its accessors (2 and 0)",
    ),
    (
        |f| f.json["accessors"][1]["count"] = json!(u64::MAX),
        "its primitives share vertices until there are 18446744073709551615 of them; export it with vertices of their own",
    ),
];

#[test]
fn each_fault_of_draco_data_has_its_sentence() {
    for (edit, sentence) in FAULTS {
        let mut file = draco();
        edit(&mut file);
        let error = file.load().unwrap_err().to_string();
        assert_eq!(error, format!("test.glb: the file is damaged: {sentence}"));
    }
}

#[test]
fn lines_of_a_packed_primitive_are_left_out() {
    let mut file = draco();
    file.primitive()["mode"] = json!(1);
    let error = file.load().unwrap_err().to_string();
    assert_eq!(
        error,
        "test.glb: it has no triangles; Points and lines of mesh `leaf` are left out"
    );
}

#[test]
fn draco_data_cut_short_anywhere_is_an_error() {
    let file = draco();
    let length = file.json["bufferViews"][1]["byteLength"].as_u64().unwrap();
    for length in 0..length {
        let mut file = file.clone();
        file.json["bufferViews"][1]["byteLength"] = json!(length);
        let error = file.load().err().map(|error| error.to_string());
        assert!(
            error.is_some_and(|error| error.contains("the Draco data of mesh `leaf`")),
            "{length}"
        );
    }
}
