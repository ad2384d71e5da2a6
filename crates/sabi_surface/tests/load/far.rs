//! Models whose coordinates are far from the origin, as those of map projections are.

use glam::{DVec3, Vec3};
use sabi_surface::load::{LoadOptions, load_bytes};
use sabi_surface::model::Model;
use serde_json::json;

use crate::builder::{Gltf, nothing};
use crate::promises;

/// Corners of an octahedron around the origin, all at [`RADIUS`].
const CORNERS: [[f64; 3]; 6] = [
    [0.3, 0.4, 0.0],
    [-0.3, -0.4, 0.0],
    [-0.4, 0.3, 0.0],
    [0.4, -0.3, 0.0],
    [0.0, 0.0, 0.5],
    [0.0, 0.0, -0.5],
];
const RADIUS: f64 = 0.5;
const FACES: [[usize; 3]; 8] = [
    [0, 2, 4],
    [2, 1, 4],
    [1, 3, 4],
    [3, 0, 4],
    [2, 0, 5],
    [1, 2, 5],
    [3, 1, 5],
    [0, 3, 5],
];
/// A place in Germany in UTM coordinates, where 32-bit floats are half a meter apart.
const MIDDLE: [f64; 3] = [432_100.125, 5_412_345.25, 310.5];

/// The octahedron as text in its place: the coordinates of each corner, with six digits behind the point.
fn corners(middle: [f64; 3]) -> [String; 6] {
    CORNERS.map(|corner| {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|axis| corner[axis] + middle[axis]);
        format!("{x:.6} {y:.6} {z:.6}")
    })
}

fn obj(middle: [f64; 3]) -> String {
    let vertices: String = corners(middle).iter().map(|corner| format!("v {corner}\n")).collect();
    let face = |[a, b, c]: [usize; 3]| format!("f {} {} {}\n", a + 1, b + 1, c + 1);
    vertices + &FACES.map(face).concat()
}

fn stl(middle: [f64; 3]) -> String {
    let corners = corners(middle);
    let facet = |face: [usize; 3]| {
        let vertices = face.map(|corner| format!("vertex {}\n", corners[corner]));
        format!(
            "facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n",
            vertices.concat()
        )
    };
    format!("solid ball\n{}endsolid\n", FACES.map(facet).concat())
}

fn ply_header(format: &str, kind: &str) -> String {
    let properties = ["x", "y", "z"].map(|axis| format!("property {kind} {axis}\n"));
    format!(
        "ply\nformat {format} 1.0\nelement vertex 6\n{}element face 8\nproperty list uchar int vertex_indices\nend_header\n",
        properties.concat()
    )
}

fn ply(middle: [f64; 3]) -> String {
    let face = |[a, b, c]: [usize; 3]| format!("3 {a} {b} {c}\n");
    format!(
        "{}{}\n{}",
        ply_header("ascii", "double"),
        corners(middle).join("\n"),
        FACES.map(face).concat()
    )
}

/// `number` gives the bytes of a coordinate.
fn binary_ply(kind: &str, number: impl Fn(f64) -> Vec<u8>) -> Vec<u8> {
    let mut file = ply_header("binary_little_endian", kind).into_bytes();
    for corner in CORNERS {
        for axis in 0..3 {
            file.extend(number(corner[axis] + MIDDLE[axis]));
        }
    }
    for face in FACES {
        file.push(3);
        face.iter()
            .for_each(|corner| file.extend((*corner as i32).to_le_bytes()));
    }
    file
}

/// The octahedron around `middle`, shown by a node with a transform.
fn dae(middle: [f64; 3], transform: &str) -> String {
    let indices = FACES
        .map(|face| face.map(|corner| format!("{corner} ")).concat())
        .concat();
    format!(
        r##"<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><library_geometries>
<geometry id="ball"><mesh><source id="at"><float_array id="a" count="18">{}</float_array><technique_common>
<accessor source="#a" count="6" stride="3"/></technique_common></source><vertices id="v"><input semantic="POSITION"
source="#at"/></vertices><triangles count="8"><input semantic="VERTEX" source="#v" offset="0"/><p>{indices}</p></triangles>
</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node id="n">{transform}
<instance_geometry url="#ball"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene>
</COLLADA>"##,
        corners(middle).join(" ")
    )
}

fn read(name: &str, bytes: &[u8]) -> Model {
    let model = load_bytes(name, bytes, &mut nothing, &LoadOptions::default()).unwrap();
    promises::check(&model);
    model
}

#[test]
fn a_ball_far_away_stays_a_ball_in_all_formats() {
    let [x, y, z] = MIDDLE;
    let origin = [0.0; 3];
    let files: [(&str, Vec<u8>); 7] = [
        ("ball.obj", obj(MIDDLE).into_bytes()),
        ("ball.stl", stl(MIDDLE).into_bytes()),
        ("ball.ply", ply(MIDDLE).into_bytes()),
        ("ball.ply", binary_ply("double", |x| x.to_le_bytes().to_vec())),
        ("ball.dae", dae(MIDDLE, "").into_bytes()),
        (
            "ball.dae",
            dae(origin, &format!("<translate>{x} {y} {z}</translate>")).into_bytes(),
        ),
        (
            "ball.dae",
            dae(
                origin,
                &format!("<matrix>1 0 0 {x} 0 1 0 {y} 0 0 1 {z} 0 0 0 1</matrix>"),
            )
            .into_bytes(),
        ),
    ];
    for (name, bytes) in files {
        let model = read(name, &bytes);
        assert!(
            DVec3::from(model.middle).distance(MIDDLE.into()) < 1e-9,
            "{name}: {:?}",
            model.middle
        );
        assert_eq!(
            (model.mesh.triangles.len(), &model.warnings[..]),
            (8, &[][..]),
            "{name}"
        );
        for at in &model.mesh.positions {
            let off = (Vec3::from(*at).as_dvec3().length() - RADIUS).abs();
            assert!(off < 2e-6, "{name}: a corner is {off} off");
        }
    }
}

#[test]
fn unused_vertices_do_not_prevent_recentering() {
    let idle = format!("{}v 0 0 0\nv nan 0 0\n", obj(MIDDLE));
    assert!(DVec3::from(read("ball.obj", idle.as_bytes()).middle).distance(MIDDLE.into()) < 1e-9);
    // Nor does a face without an area, but one with an area does.
    let without_area = format!("{idle}f 7 7 7\n");
    assert!(DVec3::from(read("ball.obj", without_area.as_bytes()).middle).distance(MIDDLE.into()) < 1e-9);
    let named = format!("{}v 0 0 0\nv 1 0 0\nv 0 1 0\nf 7 8 9\n", obj(MIDDLE));
    assert_eq!(read("ball.obj", named.as_bytes()).middle, [0.0; 3]);
}

#[test]
fn a_loss_of_shape_after_recentering_is_reported() {
    let reaching = format!("{}v 0 0 0\nv 1 0 0\nv 0 1 0\nf 7 8 9\n", obj(MIDDLE));
    let told = "The shape of 8 triangles is lost: the model reaches so far that positions of 32 bits are too coarse for it. \
                Export parts that are far apart as models of their own, and leave out what lies far away.";
    // What has no shape has no area, and is left out.
    let left_out = "8 triangles without an area, away from the surface, had to be left out.";
    assert_eq!(read("two.obj", reaching.as_bytes()).warnings, [told, left_out]);

    let mut apart = Gltf::triangle();
    apart.json["nodes"] =
        json!([{ "mesh": 0 }, { "mesh": 0, "translation": [3e7, 0.0, 0.3], "scale": [0.7, 0.7, 0.7] }]);
    let told = told.replace("8 triangles", "1 triangle");
    let left_out = "What has no area, such as a part that is scaled to nothing, is left out: `leaf`.";
    assert_eq!(apart.model().warnings, [told.as_str(), left_out]);
}

#[test]
fn a_loss_of_shape_in_the_file_is_reported() {
    let told = "The shape of 8 triangles of the model is lost in the file: it stores positions in 32 bits, which are too coarse so \
                far from its origin. Export the model near the origin.";
    let binary = binary_ply("float", |x| (x as f32).to_le_bytes().to_vec());
    assert_eq!(read("ball.ply", &binary).warnings, [told]);

    let far = |middle: [f64; 3]| {
        let mut file = Gltf::new();
        let positions: Vec<f32> = FACES
            .as_flattened()
            .iter()
            .flat_map(|corner| {
                std::array::from_fn::<f32, 3, _>(|axis| (2.0 * CORNERS[*corner][axis] + middle[axis]) as f32)
            })
            .collect();
        let positions = file.floats("VEC3", &positions);
        file.place("ball", json!({ "attributes": { "POSITION": positions } }));
        file.model().warnings
    };
    assert_eq!(far(MIDDLE), [told.replace("the model is", "mesh `ball` is")]);
    assert!(far([100.1, 200.2, 0.3]).is_empty());

    // Numbers that 32 bits hold exactly are no loss, however far away they are.
    let mut blocks = Gltf::triangle();
    let positions = [5e6, 5e6, 0.0, 5e6 + 1.0, 5e6, 0.0, 5e6, 5e6 + 1.0, 0.0];
    let positions = blocks.floats("VEC3", &positions);
    blocks.primitive()["attributes"]["POSITION"] = json!(positions);
    assert!(blocks.model().warnings.is_empty());
}

#[test]
fn far_nodes_of_gltf_keep_their_distances() {
    let mut file = Gltf::triangle();
    let second = [MIDDLE[0] + 1.125, MIDDLE[1] + 0.0625, MIDDLE[2]];
    let [x, y, z] = second;
    file.json["nodes"] = json!([
        { "mesh": 0, "translation": MIDDLE },
        { "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1] }
    ]);
    let mesh = file.model().mesh;
    let apart = Vec3::from(mesh.positions[3]) - Vec3::from(mesh.positions[0]);
    assert!(apart.abs_diff_eq(Vec3::new(1.125, 0.0625, 0.0), 1e-6), "{apart}");
}
