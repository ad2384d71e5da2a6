//! Numbers that programs write in odd ways, and positions that are none.

use sabi_surface::load::{LoadOptions, load_bytes};
use sabi_surface::model::Model;
use serde_json::json;

use crate::builder::{Gltf, nothing};
use crate::faults::said;
use crate::fbx_builder::{Fbx, FbxValue};
use crate::promises;

const COMMAS: &str = "The file writes numbers with decimal commas, such as `0,5`; they are read as decimal points.";

/// A square with UVs; `unit` are meters.
fn dae(unit: &str, positions: &str, uvs: &str) -> String {
    format!(
        r##"<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit meter="{unit}"/></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="12">{positions}</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"/></technique_common></source>
<source id="t"><float_array id="ta" count="8">{uvs}</float_array>
<technique_common><accessor source="#ta" count="4" stride="2"/></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><polylist count="1">
<input semantic="VERTEX" source="#v" offset="0"/><input semantic="TEXCOORD" source="#t" offset="1" set="0"/>
<vcount>4</vcount><p>0 0 1 1 2 2 3 3</p></polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"##
    )
}

const POSITIONS: &str = "0.0 0.0 0.0 50.0 0.0 0.0 50.0 50.0 0.5 0.0 50.0 0.5";
const UVS: &str = "0.0 0.0 1.0 0.0 1.0 1.0 0.0 1.0";
const OBJ: &str = "v 0.0 0.0 0.0\nv 0.5 0.0 0.0\nv 0.5 0.5 0.0\nvt 0.0 0.0\nvt 0.5 0.0\nvt 0.5 0.5\nvn 0.0 0.0 1.0\nf 1/1/1 2/2/1 3/3/1\n";
const STL: &str = "solid a\nfacet normal 0.0 0.0 1.0\nouter loop\nvertex 0.0 0.0 0.0\nvertex 0.5 0.0 0.0\nvertex 0.5 0.5 0.0\nendloop\nendfacet\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float s\n\
    property float t\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
    0.0 0.0 0.0 0.0 0.0\n0.5 0.0 0.0 0.5 0.0\n0.5 0.5 0.0 0.5 0.5\n3 0 1 2\n";

fn read(name: &str, text: &str) -> Model {
    let model = load_bytes(name, text.as_bytes(), &mut nothing, &LoadOptions::default()).unwrap();
    promises::check(&model);
    model
}

#[test]
fn decimal_commas_are_read_as_points_and_told() {
    let commas = |text: &str| text.replace('.', ",");
    for (name, points, commas) in [
        (
            "a.dae",
            dae("0.01", POSITIONS, UVS),
            dae("0,01", &commas(POSITIONS), &commas(UVS)),
        ),
        ("a.obj", OBJ.to_owned(), commas(OBJ)),
        ("a.stl", STL.to_owned(), commas(STL)),
        ("a.ply", PLY.to_owned(), commas(PLY).replace("1,0\n", "1.0\n")),
    ] {
        let (points, commas) = (read(name, &points), read(name, &commas));
        assert_eq!(points.mesh, commas.mesh, "{name}");
        assert!(points.warnings.is_empty(), "{name}: {:?}", points.warnings);
        assert_eq!(commas.warnings, [COMMAS], "{name}");
    }
}

#[test]
fn a_unit_that_is_no_length_is_told() {
    for (unit, warnings) in [
        ("0.01", &[][..]),
        (" 0,01 ", &[COMMAS][..]),
        (
            "inch",
            &["The unit of the file is `inch` meters, which is no length; it is taken as 1 meter."],
        ),
        (
            "0",
            &["The unit of the file is `0` meters, which is no length; it is taken as 1 meter."],
        ),
    ] {
        let model = read("a.dae", &dae(unit, POSITIONS, UVS));
        let size = if warnings.is_empty() || warnings == [COMMAS] {
            0.5
        } else {
            50.0
        };
        assert_eq!(model.warnings, warnings, "{unit}");
        assert_eq!(model.mesh.positions[2][0], size, "{unit}");
    }
}

#[test]
fn a_model_without_any_good_position_says_so() {
    let broken = |text: &str| text.replace("0.5 0.0 0.0", "0.5 nan 0.0");
    let mut gltf = Gltf::triangle();
    let positions = gltf.floats("VEC3", &[0.0, f32::NAN, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    gltf.primitive()["attributes"]["POSITION"] = json!(positions);
    let mut fbx = Fbx::square();
    let vertices = fbx.geometry().below.iter_mut().find(|list| list.name == "Vertices");
    vertices.unwrap().values = vec![FbxValue::Numbers(vec![f64::NAN; 12])];
    let nan = "nan nan nan ".repeat(4);
    for (name, bytes, who) in [
        ("a.glb", gltf.glb(), "1 triangle of mesh `leaf`"),
        ("a.fbx", fbx.binary(), "2 triangles of mesh `board`"),
        ("a.dae", dae("1", &nan, UVS).into_bytes(), "2 triangles of mesh `g`"),
        (
            "a.dae",
            dae("1", &nan.replace("nan", "1..5"), UVS).into_bytes(),
            "2 triangles of mesh `g`",
        ),
        ("a.obj", broken(OBJ).into_bytes(), "1 triangle of the model"),
        ("a.stl", broken(STL).into_bytes(), "1 triangle of the model"),
        (
            "a.ply",
            PLY.replace("0.5 0.0 0.0 0.5", "0.5 -nan(ind) 0.0 0.5").into_bytes(),
            "1 triangle of the model",
        ),
    ] {
        assert_eq!(
            said(name, &bytes),
            format!("{name}: it has no triangles; {who} had positions that are no numbers and had to be left out"),
        );
    }
}

#[test]
fn a_uv_set_that_only_broken_triangles_have_is_not_denied_and_named() {
    let mut file = Gltf::triangle();
    let broken = file.floats("VEC3", &[f32::NAN; 9]);
    let bare = file.primitive()["attributes"]["POSITION"].clone();
    file.primitive()["attributes"]["POSITION"] = json!(broken);
    file.place("bare", json!({ "attributes": { "POSITION": bare } }));
    let model = file.model();
    assert_eq!((model.mesh.uv_set, model.mesh.triangles.len()), (None, 1));
    let uvs = file.primitive()["attributes"]["TEXCOORD_0"].clone();
    file.primitive()["attributes"]["TEXCOORD_1"] = uvs;
    let options = LoadOptions {
        uv_set: 1,
        ..LoadOptions::default()
    };
    assert_eq!(
        file.load_with(&options).unwrap_err().to_string(),
        "test.glb: it has no UV set 1; all triangles with that set had to be left out"
    );
}

#[test]
fn transforms_of_collada_without_their_numbers_are_told() {
    let good = dae("1", POSITIONS, UVS);
    for step in [
        "<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0</matrix>",
        "<translate>0 zero 0</translate>",
    ] {
        let model = read(
            "a.dae",
            &good.replace("<node id=\"n\">", &format!("<node id=\"n\">{step}")),
        );
        let kind = &step[1..step.find('>').unwrap()];
        assert_eq!(
            model.warnings,
            [format!(
                "A `{kind}` of node `n` has not the numbers that it needs and is left out."
            )]
        );
        assert_eq!(model.mesh, read("a.dae", &good).mesh);
    }
    let model = read("a.dae", &good.replace("<asset>", "<asset><up_axis>z</up_axis>"));
    assert_eq!(
        model.warnings,
        ["The file has the unknown axis `z` up; +Y is taken to point up."]
    );
}

#[test]
fn marks_and_line_ends_of_all_systems_are_read() {
    let dae = dae("1", POSITIONS, UVS);
    for (name, text) in [("a.dae", dae.as_str()), ("a.obj", OBJ), ("a.stl", STL), ("a.ply", PLY)] {
        let plain = read(name, text).mesh;
        for end in ["\r\n", "\r"] {
            assert_eq!(read(name, &text.replace('\n', end)).mesh, plain, "{name} {end:?}");
        }
        let mixed = text.replacen('\n', "\r", 3);
        assert_eq!(read(name, &mixed).mesh, plain, "{name} {mixed:?}");
        assert_eq!(read(name, &format!("\u{feff}{text}")).mesh, plain, "{name}");
        for order in [u16::to_le_bytes, u16::to_be_bytes] {
            let wide: Vec<u8> = format!("\u{feff}{text}").encode_utf16().flat_map(order).collect();
            let model = load_bytes(name, &wide, &mut nothing, &LoadOptions::default()).unwrap();
            assert_eq!(model.mesh, plain, "{name}");
        }
    }
    let fbx = Fbx::square();
    let plain = fbx.model().mesh;
    let text = String::from_utf8(fbx.text()).unwrap();
    let wide = |order: fn(u16) -> [u8; 2]| format!("\u{feff}{text}").encode_utf16().flat_map(order).collect();
    for bytes in [
        text.replace('\n', "\r\n").into_bytes(),
        text.replace('\n', "\r").into_bytes(),
        format!("\u{feff}{text}").into_bytes(),
        wide(u16::to_le_bytes),
    ] {
        let model = load_bytes("a.fbx", &bytes, &mut nothing, &LoadOptions::default()).unwrap();
        assert_eq!(model.mesh, plain, "{}", String::from_utf8_lossy(&bytes[..20]));
    }
    let mut gltf = Gltf::triangle();
    let bytes = std::mem::take(&mut gltf.bytes);
    gltf.json["buffers"][0]["uri"] = json!("b.bin");
    let mut beside = |_: &str| Ok(bytes.clone());
    let text = format!("\u{feff}{}", gltf.json);
    assert!(load_bytes("a.gltf", text.as_bytes(), &mut beside, &LoadOptions::default()).is_ok());
    let wide: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_eq!(
        said("a.gltf", &wide),
        "a.gltf: it is text in UTF-16, and glTF is UTF-8; save it as UTF-8 or export it as .glb"
    );
}
