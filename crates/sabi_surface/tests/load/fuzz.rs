//! Damage of every kind gives a whole model or a fault, never a panic.

use proptest::prelude::*;
use sabi_surface::load::{LoadOptions, load_bytes};
use serde_json::json;

use crate::builder::{Gltf, U8, nothing};
use crate::{packed_quad, promises};

/// A file with a bit of everything.
fn rich() -> Gltf {
    let mut file = Gltf::triangle();
    let normals = file.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3));
    let tangents = file.floats("VEC4", &[1.0, 0.0, 0.0, 1.0].repeat(3));
    let indices = file.accessor(U8, "SCALAR", 3, &[0, 1, 2]);
    let picture = file.view(&[1, 2, 3]);
    file.push("images", json!({ "bufferView": picture }));
    file.push("textures", json!({ "source": 0 }));
    let texture = json!({ "index": 0, "extensions": { "KHR_texture_transform": { "rotation": 1.0 } } });
    file.push(
        "materials",
        json!({ "pbrMetallicRoughness": { "baseColorTexture": texture } }),
    );
    let primitive = file.primitive();
    primitive["attributes"]["NORMAL"] = json!(normals);
    primitive["attributes"]["TANGENT"] = json!(tangents);
    primitive["indices"] = json!(indices);
    primitive["material"] = json!(0);
    file.json["nodes"] = json!([{ "children": [1], "scale": [1, -2, 3] }, { "mesh": 0, "rotation": [0, 0, 1, 0] }]);
    file
}

/// Plain and packed files.
fn any_file() -> impl Strategy<Value = Gltf> {
    prop::sample::select(vec![rich(), packed_quad::draco(), packed_quad::meshopt()])
}

const OBJ: &str = "mtllib a.mtl\no part\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n\
    usemtl a\ns 1\nf 1/1/1 2/2/1 3/3/1 -1/-1/-1\ns off\nf 1 2 \\\n 3\nl 1 2\n";

fn survives(name: &str, bytes: &[u8]) {
    if let Ok(model) = load_bytes(name, bytes, &mut nothing, &LoadOptions::default()) {
        promises::check(&model);
    }
}

/// Any bits at all, and more often the values that break arithmetic.
fn any_float() -> impl Strategy<Value = f32> {
    let odd = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        f32::MAX,
        f32::MIN,
        f32::MIN_POSITIVE,
        1e-45,
        1e20,
        1e-20,
        f32::NAN,
        f32::INFINITY,
    ];
    prop_oneof![
        prop::sample::select(odd.to_vec()),
        any::<u32>().prop_map(f32::from_bits),
        -1.0f32..1.0
    ]
}

proptest! {
    #[test]
    fn bytes_of_a_glb_may_be_anything(file in any_file(), edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
                                      cut in any::<prop::sample::Index>(), does_cut in any::<bool>()) {
        let mut file = file.glb();
        for (at, byte) in edits {
            let at = at.index(file.len());
            file[at] = byte;
        }
        if does_cut {
            file.truncate(cut.index(file.len()));
        }
        survives("a.glb", &file);
    }

    #[test]
    fn packed_bytes_may_be_anything(is_draco in any::<bool>(), edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)) {
        let mut file = if is_draco { packed_quad::draco() } else { packed_quad::meshopt() };
        for (at, byte) in edits {
            let at = at.index(file.bytes.len());
            file.bytes[at] = byte;
        }
        survives("a.glb", &file.glb());
    }

    #[test]
    fn numbers_in_the_json_may_be_anything(file in any_file(), at in any::<prop::sample::Index>(), number in prop_oneof![0u64..9, any::<u64>()]) {
        let text = file.json.to_string();
        let digits: Vec<usize> = text.match_indices(|c: char| c.is_ascii_digit()).map(|(at, _)| at).collect();
        let at = digits[at.index(digits.len())];
        let json = format!("{}{number}{}", &text[..at], &text[at + 1..]);
        if let Ok(json) = serde_json::from_str(&json) {
            survives("a.glb", &Gltf { json, bytes: file.bytes }.glb());
        }
    }

    #[test]
    fn vertices_may_be_anything(positions in prop::collection::vec(any_float(), 36), uvs in prop::collection::vec(any_float(), 24),
                                normals in prop::collection::vec(any_float(), 36),
                                corners in prop::collection::vec(0u8..12, 30), with_normals in any::<bool>()) {
        let mut file = Gltf::new();
        let positions = file.floats("VEC3", &positions);
        let uvs = file.floats("VEC2", &uvs);
        let normals = file.floats("VEC3", &normals);
        let indices = file.accessor(U8, "SCALAR", corners.len(), &corners);
        let mut attributes = json!({ "POSITION": positions, "TEXCOORD_0": uvs });
        if with_normals {
            attributes["NORMAL"] = json!(normals);
        }
        file.place("leaf", json!({ "attributes": attributes, "indices": indices }));
        survives("a.glb", &file.glb());
    }

    #[test]
    fn an_obj_may_be_anything(edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)) {
        let mut file = OBJ.as_bytes().to_vec();
        for (at, byte) in edits {
            let at = at.index(file.len());
            file[at] = byte;
        }
        survives("a.obj", &file);
    }
}
