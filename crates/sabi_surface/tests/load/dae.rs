//! COLLADA files.

use glam::Vec3;
use sabi_surface::load::{LoadError, LoadOptions, Up, load_bytes};
use sabi_surface::model::{Model, ModelMaterial};

use crate::faults::said;
use crate::promises;

const SOURCES: &str = r##"<source id="at"><float_array id="at-a" count="12">0 0 0 1 0 0 1 1 0 0 1 0</float_array>
  <technique_common><accessor source="#at-a" count="4" stride="3"/></technique_common></source>
<source id="uv"><float_array id="uv-a" count="8">0 0 1 0 1 1 0 1</float_array>
  <technique_common><accessor source="#uv-a" count="4" stride="2"/></technique_common></source>
<source id="half"><float_array id="half-a" count="8">0 0 0.5 0 0.5 0.5 0 0.5</float_array>
  <technique_common><accessor source="#half-a" count="4" stride="2"/></technique_common></source>
<source id="tint"><float_array id="tint-a" count="3">1 0.5 0</float_array>
  <technique_common><accessor source="#tint-a" count="1" stride="3"/></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#at"/></vertices>"##;

/// One face over all inputs: positions, two UV sets, a color.
const FACE: &str = r##"<polylist material="skin" count="1"><input semantic="VERTEX" source="#v" offset="0"/>
  <input semantic="TEXCOORD" source="#uv" offset="1" set="3"/><input semantic="TEXCOORD" source="#half" offset="1" set="7"/>
  <input semantic="COLOR" source="#tint" offset="2"/><vcount>4</vcount><p>0 0 0 1 1 0 2 2 0 3 3 0</p></polylist>"##;

const NODE: &str = r##"<node name="board"><instance_geometry url="#shape"/></node>"##;

/// A file with an asset, libraries, the lists of its mesh and the nodes of its scene.
fn file(asset: &str, libraries: &str, lists: &str, nodes: &str) -> String {
    format!(
        r##"<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>{asset}</asset>{libraries}
<library_geometries><geometry id="shape" name="board">
<mesh>{SOURCES}{lists}</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="other"/><visual_scene id="scene">{nodes}</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#scene"/></scene></COLLADA>"##
    )
}

fn read_with(text: &str, options: &LoadOptions) -> Result<Model, LoadError> {
    let mut beside = |path: &str| match path {
        "my paint.png" | "bumps.png" => Ok(path.as_bytes().to_vec()),
        _ => Err("there is no such file".to_string()),
    };
    let model = load_bytes("thing.dae", text.as_bytes(), &mut beside, options)?;
    promises::check(&model);
    Ok(model)
}

fn read(text: &str) -> Model {
    read_with(text, &LoadOptions::default()).unwrap()
}

fn assert_close(model: &Model, expected: &[[f32; 3]]) {
    let is = &model.mesh.positions;
    assert_eq!(is.len(), expected.len());
    for (is, expected) in is.iter().zip(expected) {
        assert!(
            Vec3::from(*is).abs_diff_eq(Vec3::from(*expected), 1e-5),
            "{is:?} is not {expected:?}"
        );
    }
}

const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

#[test]
fn a_face_has_its_attributes() {
    let text = file("", "", FACE, NODE);
    let model = read(&text);
    assert_close(&model, &SQUARE);
    assert_eq!(model.mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(model.mesh.uvs, [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]);
    assert!((model.mesh.colors[0][1] - 0.214_041).abs() < 1e-5);
    assert_eq!(
        (model.stem.as_str(), &model.parts[..]),
        ("thing", &["board".to_string()][..])
    );
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    let renamed = load_bytes(
        "thing.obj",
        text.as_bytes(),
        &mut crate::builder::nothing,
        &LoadOptions::default(),
    );
    assert_eq!(renamed.unwrap().mesh, model.mesh);
}

#[test]
fn uv_sets_have_numbers_in_the_order_of_their_names() {
    let text = file("", "", FACE, NODE);
    let options = |uv_set| LoadOptions {
        uv_set,
        ..LoadOptions::default()
    };
    let second = read_with(&text, &options(1)).unwrap();
    assert_eq!((second.mesh.uv_set, second.mesh.uvs[2]), (Some(1), [0.5, 0.5]));
    let error = read_with(&text, &options(2)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "thing.dae: it has no UV set 2; it has the sets 0 and 1"
    );
}

#[test]
fn all_lists_of_polygons_are_read() {
    let inputs = r##"<input semantic="VERTEX" source="#v" offset="0"/>"##;
    for (list, triangles) in [
        (format!("<triangles>{inputs}<p>0 1 2 0 2 3</p></triangles>"), 2),
        (format!("<polygons>{inputs}<p>0 1 2 3</p><p>0 1 2</p></polygons>"), 3),
        (format!("<trifans>{inputs}<p>0 1 2 3</p></trifans>"), 2),
        (format!("<tristrips>{inputs}<p>0 1 3 2</p></tristrips>"), 2),
        (
            format!("<polylist>{inputs}<vcount>3 2 4</vcount><p>0 1 2 0 1 0 1 2 3</p></polylist>"),
            3,
        ),
    ] {
        let model = read(&file("", "", &list, NODE));
        assert_eq!(model.mesh.triangles.len(), triangles, "{list}");
        assert!(
            model.mesh.normals.iter().all(|normal| *normal == [0.0, 0.0, 1.0]),
            "{list}"
        );
    }
    let holed =
        format!("<polygons>{inputs}<ph><p>0 1 2 3</p><h>0 1 2</h></ph></polygons><lines>{inputs}<p>0 1</p></lines>");
    let model = read(&file("", "", &holed, NODE));
    assert_eq!(
        model.warnings,
        [
            "Holes in the faces of mesh `board` are left out; triangulate the model on export.",
            "Points and lines of mesh `board` are left out.",
        ]
    );
}

#[test]
fn units_and_axes_of_the_file_are_followed() {
    let inches = read(&file(r#"<unit meter="0.0254" name="inch"/>"#, "", FACE, NODE));
    assert_close(&inches, &SQUARE.map(|corner| corner.map(|x| x * 0.0254)));
    let upright = file("<up_axis>Z_UP</up_axis>", "", FACE, NODE);
    assert_close(&read(&upright), &SQUARE.map(|[x, y, z]| [x, z, -y]));
    let options = LoadOptions {
        up: Up::Z,
        ..LoadOptions::default()
    };
    let turned = read_with(&file("", "", FACE, NODE), &options).unwrap();
    assert_close(&turned, &SQUARE.map(|[x, y, z]| [x, z, -y]));
}

#[test]
fn rows_without_a_stride_have_one_number_for_each_parameter() {
    let text = file("", "", FACE, NODE);
    let params = r#"count="4"><param name="X"/><param name="Y"/><param name="Z"/></accessor>"#;
    let bare = text.replacen(r#"count="4" stride="3"/>"#, params, 1);
    assert_ne!(bare, text);
    assert_eq!(read(&bare).mesh, read(&text).mesh);
}

#[test]
fn transforms_and_instances_of_nodes_are_followed() {
    let nodes = r##"<node id="one" name="one"><translate>0 0 1</translate><rotate>0 0 1 90</rotate><scale>2 1 1</scale>
        <instance_geometry url="#shape"/></node>
        <node name="two"><matrix>-1 0 0 0 0 1 0 0 0 0 1 5 0 0 0 1</matrix><instance_geometry url="#shape"/></node>
        <node name="three"><translate>0 0 9</translate><instance_node url="#one"/></node>"##;
    let model = read(&file("", "", FACE, nodes));
    assert_eq!(model.parts, ["one", "two", "one"]);
    let one = SQUARE.map(|[x, y, z]| [-y, 2.0 * x, z + 1.0]);
    let two = SQUARE.map(|[x, y, z]| [-x, y, z + 5.0]);
    let three = one.map(|[x, y, z]| [x, y, z + 9.0]);
    assert_close(&model, &[one, two, three].concat());
    assert!(
        model.mesh.normals.iter().all(|normal| normal[2] > 0.99),
        "a mirrored instance keeps its outside"
    );
    let [a, b, c] = model.mesh.triangles[2].map(|vertex| Vec3::from(model.mesh.positions[vertex as usize]));
    assert!((b - a).cross(c - a).z > 0.0);
}

const LOOKS: &str = r##"<library_images><image id="paint"><init_from>file:///C:/store/my paint.png</init_from></image>
    <image id="bumps"><init_from>bumps.png</init_from></image></library_images>
  <library_effects><effect id="fx"><profile_COMMON>
    <newparam sid="s"><surface type="2D"><init_from>paint</init_from></surface></newparam>
    <newparam sid="t"><sampler2D><source>s</source></sampler2D></newparam>
    <technique sid="common"><phong><emission><color>0.5 0.25 0 1</color></emission>
      <diffuse><texture texture="t" texcoord="SECOND"/></diffuse>
      <transparent opaque="A_ONE"><color>1 1 1 1</color></transparent><transparency><float>0.5</float></transparency></phong>
      <extra><technique profile="X"><bump bumptype="NORMALMAP"><texture texture="bumps" texcoord="FIRST"/></bump>
        <double_sided>0</double_sided></technique></extra></technique></profile_COMMON></effect>
  <effect id="plain"><profile_COMMON><technique sid="common"><lambert><diffuse><color>0.1 0.2 0.3 1</color></diffuse>
    </lambert></technique></profile_COMMON></effect></library_effects>
  <library_materials><material id="m0" name="unused"><instance_effect url="#plain"/></material>
    <material id="m1" name="painted"><instance_effect url="#fx"/></material>
    <material id="m2" name="plain"><instance_effect url="#plain"/></material></library_materials>"##;

/// The board with a material for its symbol.
fn bound(material: &str) -> String {
    format!(
        r##"<node name="{material}"><instance_geometry url="#shape"><bind_material><technique_common>
        <instance_material symbol="skin" target="#{material}"><bind_vertex_input semantic="SECOND" input_semantic="TEXCOORD"
        input_set="7"/></instance_material></technique_common></bind_material></instance_geometry></node>"##
    )
}

#[test]
fn instances_of_a_mesh_have_materials_of_their_own() {
    let model = read(&file("", LOOKS, FACE, &format!("{}{}{NODE}", bound("m2"), bound("m1"))));
    let names: Vec<&str> = model.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["painted", "plain", ""]);
    assert_eq!(model.mesh.triangle_material, [1, 1, 0, 0, 2, 2]);
    let painted = &model.materials[0];
    assert_eq!(painted.base_color_factor, [1.0, 1.0, 1.0, 0.5]);
    assert_eq!(model.materials[2].base_color_factor, [0.5, 0.5, 0.5, 1.0]);
    assert_eq!(
        (painted.emission_factor, painted.is_double_sided),
        ([0.5, 0.25, 0.0], false)
    );
    let sets = [&painted.base_color, &painted.normal].map(|texture| texture.as_ref().unwrap().uv_set);
    assert_eq!(sets, [1, 0]);
    let pictures: Vec<&str> = model.images.iter().map(|image| image.name.as_str()).collect();
    assert_eq!(pictures, ["my paint.png", "bumps.png"]);
    assert!(
        model.images.iter().all(|image| image.bytes.is_ok()),
        "{:?}",
        model.warnings
    );
    assert_eq!(model.mesh.texture_uvs[0].uvs[2], [0.5, 0.5]);
    let plain = ModelMaterial {
        name: "plain".into(),
        base_color_factor: [0.1, 0.2, 0.3, 1.0],
        metallic_factor: 0.0,
        ignores_alpha: true,
        ..ModelMaterial::default()
    };
    assert_eq!(model.materials[1], plain);
}

#[test]
fn opacity_and_colors_of_materials_have_the_rules_of_all_formats() {
    let looks = |from: &str, to: &str| read(&file("", &LOOKS.replace(from, to), FACE, &bound("m1")));
    let unseen = looks("<float>0.5</float>", "<float>0</float>");
    assert_eq!(
        (
            unseen.materials[0].base_color_factor[3],
            unseen.materials[0].ignores_alpha
        ),
        (1.0, true)
    );
    assert_eq!(
        unseen.warnings,
        ["The file has material `painted` invisible; it is taken as opaque."]
    );
    let short = looks("<color>0.5 0.25 0 1</color>", "<color>0.5 0.25 0</color>");
    assert_eq!(short.materials[0].emission_factor, [0.5, 0.25, 0.0]);
    let codes = file("", &LOOKS.replace("0.1 0.2 0.3 1", "255 -1 0.3 1"), FACE, &bound("m2"));
    let codes = read(&codes);
    assert_eq!(codes.materials[0].base_color_factor, [1.0, 0.0, 0.3, 1.0]);
    // The material `unused` has the same color, and comes first.
    assert_eq!(
        codes.warnings[2..],
        [
            "The base color of material `plain` cannot be 255; 1 is taken.",
            "The base color of material `plain` cannot be -1; 0 is taken.",
        ]
    );
    let lost = looks("<color>0.5 0.25 0 1</color>", "<color>bright</color>");
    assert_eq!(
        lost.warnings,
        ["The emission of material `painted` is no color of three or four numbers and is left out."]
    );
}

/// The board, bound to a bone; `swing` moves a second bone away from where it was bound.
fn boned(swing: f32) -> String {
    let skin = r##"<library_controllers><controller id="skin"><skin source="#shape">
      <bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 3 0 0 0 1</bind_shape_matrix>
      <source id="j"><Name_array id="j-a" count="2">hip knee</Name_array></source>
      <source id="b"><float_array id="b-a" count="32">1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 0 1 0 -2 0 0 1 0 0 0 0 1</float_array>
      </source><joints><input semantic="JOINT" source="#j"/><input semantic="INV_BIND_MATRIX" source="#b"/></joints>
      </skin></controller></library_controllers>"##;
    let nodes = format!(
        r##"<node sid="hip" type="JOINT"><node sid="knee" type="JOINT"><translate>{swing} 2 0</translate></node></node>
        <node name="body"><instance_controller url="#skin"/></node>"##
    );
    file("", skin, FACE, &nodes)
}

#[test]
fn a_skinned_mesh_stands_where_it_was_bound() {
    for (swing, sentence) in [
        (0.0, "The skin of `body` is left out: it is taken at rest."),
        (
            1.0,
            "The skeleton of `body` stands in a pose; the mesh is taken as it was bound, without it.",
        ),
    ] {
        let model = read(&boned(swing));
        assert_close(&model, &SQUARE.map(|[x, y, z]| [x, y, z + 3.0]));
        assert_eq!(model.warnings, [sentence]);
    }
}

/// The board, shown by this many nodes through skins: all through one, or each through its own, which share their joints.
fn shared_skin(nodes: usize, is_one: bool) -> String {
    // The size of forty thousand matrices with a number each.
    let long = format!("{} ", "0".repeat(31)).repeat(40_000);
    let sources = format!(
        r##"<library_animations><source id="j"><Name_array id="j-a" count="0"/></source>
        <source id="b"><float_array id="b-a" count="0">{long}</float_array></source></library_animations>"##
    );
    let skin = |number: usize| {
        format!(
            r##"<controller id="skin{number}"><skin source="#shape"><joints><input semantic="JOINT" source="#j"/>
            <input semantic="INV_BIND_MATRIX" source="#b"/></joints></skin></controller>"##
        )
    };
    let skins: String = (0..nodes).map(skin).collect();
    let shown = |number| {
        let skin = if is_one { 0 } else { number };
        format!(r##"<node name="body{number}"><instance_controller url="#skin{skin}"/></node>"##)
    };
    let shown: String = (0..nodes).map(shown).collect();
    let libraries = format!("{sources}<library_controllers>{skins}</library_controllers>");
    file("", &libraries, FACE, &shown)
}

#[test]
fn skins_have_a_limit_in_sum_and_one_skin_is_read_once() {
    let told = "The skin of `body104` cannot be read (the skins of the file have too many joints together); the mesh is taken as \
                it was bound.";
    let is_told = |model: Model| model.warnings.iter().any(|warning| warning == told);
    assert!(is_told(read(&shared_skin(110, false))));
    assert!(!is_told(read(&shared_skin(110, true))));
}

/// Nodes of which each shows the one below it twice, and has many comments.
fn doubling_nodes() -> String {
    let comments = "<!---->".repeat(600);
    let node = |level: usize| {
        let below = format!(r##"<instance_node url="#n{}"/>"##, level + 1).repeat(2);
        format!(r#"<node id="n{level}">{comments}{below}</node>"#)
    };
    (0..18).map(node).collect()
}

#[test]
fn each_fault_has_its_sentence() {
    let whole = file("", "", FACE, NODE);
    let endless = r##"<node id="a"><instance_node url="#a"/><instance_node url="#a"/></node>"##;
    for (text, sentence) in [
        (
            whole.replace("</COLLADA>", ""),
            "the file is damaged: its XML cannot be read (the root node was opened but never closed)",
        ),
        (
            "hello".to_string(),
            "the file is damaged: its XML cannot be read (unknown token at 1:1)",
        ),
        ("<svg/>".to_string(), "the file is damaged: it is no COLLADA file"),
        (
            whole.replace("3 3 0</p>", "4 3 0</p>"),
            "the file is damaged: mesh `board` names position 4, which is not there",
        ),
        (
            whole.replace("3 3 0</p>", "x 3 0</p>"),
            "the file is damaged: `x` is not an index",
        ),
        (
            whole.replace("<vcount>4", "<vcount>4000000000"),
            "the file is damaged: a polygon promises 4000000000 corners, and there are fewer",
        ),
        (
            whole.replace("offset=\"2\"", "offset=\"4000000000\""),
            "the file is damaged: a corner of mesh `board` has 4000000001 indices",
        ),
        (
            file("", "", FACE, endless),
            "the file is damaged: its nodes use each other until there are more than 1048576 of them",
        ),
        (
            file("", "", FACE, &doubling_nodes()),
            "the file is damaged: its nodes use each other until they have more than 67108864 elements",
        ),
        (file("", "", "", NODE), "it has no triangles"),
        (file("", "", FACE, ""), "it has no triangles"),
    ] {
        assert_eq!(said("thing.dae", text.as_bytes()), format!("thing.dae: {sentence}"));
    }
    let bomb = whole.replace("<COLLADA", "<!DOCTYPE a [<!ENTITY b \"c\">]><COLLADA");
    assert!(said("thing.dae", bomb.as_bytes()).contains("it defines entities"));
}

#[test]
fn a_document_type_without_entities_changes_nothing() {
    let plain = file("", "", FACE, NODE);
    let typed = plain.replace("<COLLADA", "<!DOCTYPE COLLADA SYSTEM \"collada_schema.dtd\">\n<COLLADA");
    let read = |text: &str| {
        load_bytes(
            "a.dae",
            text.as_bytes(),
            &mut crate::builder::nothing,
            &LoadOptions::default(),
        )
    };
    assert_eq!(read(&typed).unwrap().mesh, read(&plain).unwrap().mesh);
}

/// Markup that divides a text without ending it: a comment, a processing instruction, a section of characters.
const DIVIDERS: [&str; 3] = ["<!-- 9 9 9 -->", "<?exporter 9 9 9?>", "<![CDATA[]]>"];

#[test]
fn comments_and_instructions_do_not_end_a_text() {
    let asset = "<up_axis>Z_UP</up_axis>";
    let node = r##"<node name="board"><translate>1 2 3</translate><instance_geometry url="#shape"/></node>"##;
    let whole = file(asset, "", FACE, node);
    let expected = read(&whole);
    for divider in DIVIDERS {
        for (text, divided) in [
            ("Z_UP", format!("{divider}Z_{divider}UP")),
            ("<translate>1 2 ", format!("<translate>1 {divider} 2 {divider}")),
            (">0 0 0 1 0 0 1 1 0", format!(">0 0 0 {divider} 1 0 0{divider} 1 1 0")),
            ("<vcount>4", format!("<vcount>{divider}4")),
            ("<p>0 0 0 1 1 0", format!("<p>0 0 0 {divider}1 1 {divider}0")),
        ] {
            assert!(whole.contains(text));
            let model = read(&whole.replace(text, &divided));
            assert_eq!(model.mesh, expected.mesh, "{divided}");
            assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        }
    }
    let painted = file("", LOOKS, FACE, &bound("m1"));
    for (text, divided) in [
        ("/my paint", "/my <!-- new -->paint"),
        ("<color>0.5 0.25 0 1", "<color>0.5 <!-- dim --> 0.25 0 1"),
        ("<source>", "<source><!-- of the paint -->"),
        ("<double_sided>", "<double_sided><!-- no -->"),
    ] {
        assert!(painted.contains(text), "{text}");
        assert_eq!(
            read(&painted.replace(text, divided)).materials,
            read(&painted).materials,
            "{divided}"
        );
    }
}

#[test]
fn references_that_lead_nowhere_are_told_by_kind() {
    let gone = r##"<node><instance_geometry url="#gone"/><instance_geometry url="other.dae#shape"/><instance_node url="#n"/>
        <instance_controller url="#bones"/></node>"##;
    let none = file("", "", FACE, gone);
    assert_eq!(
        said("thing.dae", none.as_bytes()),
        "thing.dae: it has no triangles; The file refers to meshes that it does not have, which are left out: `#gone`; The file refers to \
         nodes that it does not have, which are left out: `#n`; The file refers to skins or morph targets that it does not have, which \
         are left out: `#bones`"
    );
    let elsewhere = file(
        "",
        "",
        FACE,
        r##"<node><instance_geometry url="other.dae#shape"/></node>"##,
    );
    assert_eq!(
        said("thing.dae", elsewhere.as_bytes()),
        "thing.dae: it has no triangles; The file refers to meshes of other files, which are not read and left out: \
         `other.dae#shape`; export all as one file"
    );
    for (text, wrong, what) in [
        (
            "target=\"#m1\"",
            "target=\"#m9\"",
            "materials that it does not have, which are left out: `#m9`.",
        ),
        (
            "url=\"#fx\"",
            "url=\"#\"",
            "effects of materials that it does not have, which are left out: `#`.",
        ),
        (
            "source=\"#half\"",
            "source=\"#uvs\"",
            "sources that it does not have, which are left out: `#uvs`.",
        ),
        (
            "url=\"#scene\"",
            "url=\"#stage\"",
            "scenes that it does not have, which are left out: `#stage`.",
        ),
    ] {
        // The first scene is taken where the chosen one is not there.
        let whole = file("", LOOKS, FACE, &bound("m1")).replace("<visual_scene id=\"other\"/>", "");
        assert!(whole.contains(text), "{text}");
        let warnings = read(&whole.replace(text, wrong)).warnings;
        assert_eq!(warnings[0], format!("The file refers to {what}"), "{warnings:?}");
    }
    let many: String = (0..9000)
        .map(|n| format!(r##"<instance_geometry url="#g{n:04}"/>"##))
        .collect();
    let model = read(&file("", "", FACE, &format!("<node>{many}</node>{NODE}")));
    assert_eq!(
        model.warnings,
        [
            "The file refers to meshes that it does not have, which are left out: `#g0000`, `#g0001`, `#g0002`, `#g0003`, `#g0004` \
          and 8995 more."
        ]
    );
}
