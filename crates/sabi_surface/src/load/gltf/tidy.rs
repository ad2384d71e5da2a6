//! The JSON of glTF files with what the format forbids and programs write all the same.

use serde_json::Value;

/// Members whose numbers are integers.
const INTEGERS: [&str; 34] = [
    "buffer",
    "bufferView",
    "byteLength",
    "byteOffset",
    "byteStride",
    "camera",
    "children",
    "componentType",
    "count",
    "index",
    "indices",
    "input",
    "inverseBindMatrices",
    "joints",
    "light",
    "magFilter",
    "material",
    "mesh",
    "minFilter",
    "mode",
    "node",
    "nodes",
    "output",
    "sampler",
    "scene",
    "skeleton",
    "skin",
    "source",
    "target",
    "texCoord",
    "variants",
    "view",
    "wrapS",
    "wrapT",
];
/// Members whose own members are integers, by the names of attributes.
const ATTRIBUTES: [&str; 2] = ["attributes", "targets"];
/// Member that holds what the format leaves to programs.
const FREE: &str = "extras";
/// Number below which all integers are exact as floats.
const EXACT: f64 = (1u64 << 53) as f64;

/// Parses the JSON of a glTF file, which may have a byte order mark and end in zeros that fill up a chunk. Members that are null are
/// absent, and integers may be written as `24.0`.
pub fn gltf_json(text: &[u8]) -> serde_json::Result<Value> {
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    let end = text.iter().rposition(|byte| *byte != 0).map_or(0, |last| last + 1);
    let mut document = serde_json::from_slice(&text[..end])?;
    tidy(&mut document, "", false);
    Ok(document)
}

/// Removes members that are null, and turns whole numbers of members that are integers into such. The value is one of the member
/// `key`, and `of_attribute` where it is the number of an attribute.
fn tidy(value: &mut Value, key: &str, of_attribute: bool) {
    match value {
        Value::Object(members) => {
            members.retain(|_, member| !member.is_null());
            for (key, member) in members.iter_mut().filter(|(key, _)| *key != FREE) {
                tidy(member, key, of_attribute || ATTRIBUTES.contains(&key.as_str()));
            }
        }
        Value::Array(values) => values.iter_mut().for_each(|value| tidy(value, key, of_attribute)),
        Value::Number(number) if number.is_f64() && (of_attribute || INTEGERS.contains(&key)) => {
            let float = number
                .as_f64()
                .filter(|float| float.fract() == 0.0 && float.abs() < EXACT);
            if let Some(float) = float {
                *value = Value::from(float as i64);
            }
        }
        Value::Number(_) | Value::Null | Value::Bool(_) | Value::String(_) => {}
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn integers_written_as_floats_and_absent_members_written_as_null_are_read() {
        let text = r#"{ "scene": 0.0, "materials": null, "nodes": [{ "children": [1.0, 2.0], "mesh": null, "scale": [1.0, 2.5, 1.0] }],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0.0 }, "indices": 1.5 }] }],
            "extras": { "mesh": 1.0, "none": null } }"#;
        let mut padded = b"\xef\xbb\xbf".to_vec();
        padded.extend(text.as_bytes());
        padded.extend([0; 3]);
        assert_eq!(
            gltf_json(&padded).unwrap(),
            json!({
                "scene": 0, "nodes": [{ "children": [1, 2], "scale": [1.0, 2.5, 1.0] }],
                "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1.5 }] }],
                "extras": { "mesh": 1.0, "none": null }
            })
        );
    }
}
