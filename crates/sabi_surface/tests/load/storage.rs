//! Every way to store a vertex that glTF 2.0 (3.7.2.1) or KHR_mesh_quantization allows reads as the same numbers; the others
//! are repaired with a warning or refused.

use serde_json::json;

use crate::builder::{F32, Gltf, I8, I16, U8, U16, U32};

/// Outcome of reading an attribute in one form of storage.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fate {
    /// Read without a word.
    Legal,
    /// Read without a word where KHR_mesh_quantization is required, else with one.
    Quantized,
    /// Read as fractions although the file does not mark them so, with a warning.
    Repaired,
    Refused,
}
use Fate::{Legal, Quantized, Refused, Repaired};

const COMPONENTS: [u32; 6] = [F32, I8, U8, I16, U16, U32];
/// Attribute, its shape, and its fate by component: first without, then with the mark `normalized`.
const FATES: [(&str, &str, [[Fate; 2]; 6]); 6] = [
    (
        "POSITION",
        "VEC3",
        [
            [Legal; 2],
            [Quantized; 2],
            [Quantized; 2],
            [Quantized; 2],
            [Quantized; 2],
            [Refused; 2],
        ],
    ),
    ("NORMAL", "VEC3", DIRECTION),
    ("TANGENT", "VEC4", DIRECTION),
    (
        "TEXCOORD_0",
        "VEC2",
        [
            [Legal; 2],
            [Quantized; 2],
            [Quantized, Legal],
            [Quantized; 2],
            [Quantized, Legal],
            [Refused; 2],
        ],
    ),
    ("COLOR_0", "VEC3", COLOR),
    ("COLOR_0", "VEC4", COLOR),
];
const DIRECTION: [[Fate; 2]; 6] = [
    [Legal; 2],
    [Repaired, Quantized],
    [Refused; 2],
    [Repaired, Quantized],
    [Refused; 2],
    [Refused; 2],
];
const COLOR: [[Fate; 2]; 6] = [
    [Legal; 2],
    [Refused; 2],
    [Repaired, Legal],
    [Refused; 2],
    [Repaired, Legal],
    [Refused; 2],
];

/// The largest number of a component type, which is 1 where normalized.
fn one(component: u32) -> u32 {
    match component {
        I8 => 127,
        U8 => 255,
        I16 => 32767,
        U16 => 65535,
        _ => u32::MAX,
    }
}

/// The values as a file stores them: 1 as the largest number where they stand for fractions, 1 otherwise.
fn stored(values: &[u8], component: u32, as_fractions: bool) -> Vec<u8> {
    let number = |value: &u8| {
        if as_fractions {
            u32::from(*value) * one(component)
        } else {
            u32::from(*value)
        }
    };
    match component {
        F32 => values
            .iter()
            .flat_map(|value| f32::from(*value).to_le_bytes())
            .collect(),
        I8 | U8 => values.iter().map(|value| number(value) as u8).collect(),
        I16 | U16 => values
            .iter()
            .flat_map(|value| (number(value) as u16).to_le_bytes())
            .collect(),
        _ => values.iter().flat_map(|value| number(value).to_le_bytes()).collect(),
    }
}

/// Zeros and ones that make sense for each attribute of a triangle in the plane z = 0.
fn values(attribute: &str, shape: &str) -> Vec<u8> {
    match (attribute, shape) {
        ("POSITION", _) => vec![0, 0, 0, 1, 0, 0, 0, 1, 0],
        ("NORMAL", _) => [0, 0, 1].repeat(3),
        ("TANGENT", _) => [0, 1, 0, 1].repeat(3),
        ("TEXCOORD_0", _) => vec![0, 1, 1, 1, 0, 0],
        (_, "VEC3") => vec![1, 0, 0, 0, 1, 0, 0, 0, 1],
        _ => vec![1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 0],
    }
}

/// The triangle with one attribute stored in a way of its own.
fn triangle(attribute: &str, shape: &str, component: u32, normalized: bool, fate: Fate) -> Gltf {
    let mut file = Gltf::triangle();
    let normals = file.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3));
    file.primitive()["attributes"]["NORMAL"] = json!(normals);
    let as_fractions = normalized || fate == Repaired;
    let bytes = stored(&values(attribute, shape), component, as_fractions);
    let accessor = file.accessor(component, shape, 3, &bytes);
    file.json["accessors"][accessor]["normalized"] = json!(normalized);
    file.primitive()["attributes"][attribute] = json!(accessor);
    file
}

#[test]
fn every_component_type_reads_as_the_same_numbers_or_is_answered() {
    for (attribute, shape, fates) in FATES {
        let reference = triangle(attribute, shape, F32, false, Legal).model().mesh;
        for (component, fates) in COMPONENTS.into_iter().zip(fates) {
            for (normalized, fate) in [false, true].into_iter().zip(fates) {
                let case = format!("{attribute} {shape} {component} {normalized}: {fate:?}");
                let mut file = triangle(attribute, shape, component, normalized, fate);
                if fate == Refused {
                    let error = file.load().unwrap_err().to_string();
                    assert!(error.contains("which glTF does not allow for "), "{case}: {error}");
                    continue;
                }
                let model = file.model();
                assert_eq!(model.mesh, reference, "{case}");
                let said = model.warnings.join(" ");
                match fate {
                    Legal => assert_eq!(said, "", "{case}"),
                    Quantized => assert!(
                        said.contains("should require KHR_mesh_quantization; they are read"),
                        "{case}: {said}"
                    ),
                    _ => assert!(
                        said.contains("without the mark that fractions of 1 are meant"),
                        "{case}: {said}"
                    ),
                }
                file.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
                assert_eq!(file.model().warnings.is_empty(), fate != Repaired, "{case}");
            }
        }
    }
}

#[test]
fn the_smallest_signed_numbers_are_minus_one() {
    let mut file = Gltf::triangle();
    let accessor = file.accessor(I8, "VEC3", 3, &[0x80, 0, 0, 0x81, 0, 127, 0, 127, 0]);
    file.json["accessors"][accessor]["normalized"] = json!(true);
    file.primitive()["attributes"]["POSITION"] = json!(accessor);
    let mesh = file.model().mesh;
    assert_eq!(mesh.positions, [[-1.0, 0.0, 0.0], [-1.0, 0.0, 1.0], [0.0, 1.0, 0.0]]);
}

#[test]
fn indices_of_every_size_read_the_same() {
    for (component, bytes) in [
        (U8, vec![2, 0, 1]),
        (U16, vec![2, 0, 0, 0, 1, 0]),
        (U32, vec![2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0]),
    ] {
        let mut file = Gltf::triangle();
        let indices = file.accessor(component, "SCALAR", 3, &bytes);
        file.primitive()["indices"] = json!(indices);
        assert_eq!(file.model().mesh.triangles, [[2, 0, 1]], "{component}");
        for other in [I8, I16, F32] {
            file.json["accessors"][indices]["componentType"] = json!(other);
            assert!(
                file.load()
                    .unwrap_err()
                    .to_string()
                    .contains("not as unsigned integers"),
                "{other}"
            );
        }
    }
}
