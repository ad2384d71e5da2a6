//! FBX files.

use glam::Vec3;
use sabi_surface::load::{LoadOptions, Up, load_bytes};
use sabi_surface::model::{Model, ModelMaterial};

use crate::faults::said;
use crate::fbx_builder::{Fbx, FbxElement, FbxValue, element, layer, mesh, properties, text};

/// Positions of the model, in the order of its vertices.
fn corners(model: &Model) -> Vec<Vec3> {
    model.mesh.positions.iter().copied().map(Vec3::from).collect()
}

fn assert_close(model: &Model, expected: &[[f32; 3]]) {
    let corners = corners(model);
    assert_eq!(corners.len(), expected.len(), "{corners:?}");
    for (corner, expected) in corners.iter().zip(expected) {
        assert!(corner.abs_diff_eq(Vec3::from(*expected), 1e-5), "{corners:?}");
    }
}

/// Normal of the first triangle by its winding.
fn outside(model: &Model) -> Vec3 {
    let corners = corners(model);
    let [a, b, c] = model.mesh.triangles[0].map(|vertex| corners[vertex as usize]);
    (b - a).cross(c - a).normalize()
}

const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

#[test]
fn text_and_binary_give_the_same_model_in_meters() {
    let file = Fbx::square();
    let model = file.model();
    assert_close(&model, &SQUARE);
    assert_eq!(model.mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(model.mesh.uvs, [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]);
    assert_eq!(
        (model.stem.as_str(), &model.parts[..]),
        ("test", &["board".to_string()][..])
    );
    assert_eq!(
        model.materials,
        [ModelMaterial {
            base_color_factor: [0.5, 0.5, 0.5, 1.0],
            metallic_factor: 0.0,
            ..ModelMaterial::default()
        }]
    );
    assert!(model.warnings.is_empty() && !model.is_gltf, "{:?}", model.warnings);
    // A file under another name is known by its content.
    for (name, bytes) in [
        ("test.fbx", file.text()),
        ("test.obj", file.text()),
        ("test", file.binary()),
    ] {
        let other = load_bytes(name, &bytes, &mut crate::builder::nothing, &LoadOptions::default()).unwrap();
        assert_eq!(other.mesh, model.mesh, "{name}");
    }
}

#[test]
fn units_and_axes_of_the_file_are_followed() {
    let mut inches = Fbx::square();
    inches.unit_cm = 2.54;
    assert!(corners(&inches.model())[2].abs_diff_eq(Vec3::new(2.54, 2.54, 0.0), 1e-5));
    // Z up, with −Y to the front.
    let mut upright = Fbx::square();
    upright.axes = [2, -2, 0];
    assert_close(&upright.model(), &SQUARE.map(|[x, y, z]| [x, z, -y]));
    // The option turns what the file said is +Y.
    let options = LoadOptions {
        up: Up::Z,
        ..LoadOptions::default()
    };
    let turned = Fbx::square().load_with(&options).unwrap();
    assert_close(&turned, &SQUARE.map(|[x, y, z]| [x, z, -y]));
}

#[test]
fn a_left_handed_file_keeps_its_outside_and_its_front() {
    let mut file = Fbx::square();
    file.axes = [1, 2, -1];
    let model = file.model();
    assert_close(
        &model,
        &[[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, 0.0, 0.0]],
    );
    assert!(outside(&model).abs_diff_eq(Vec3::Z, 1e-5));
    assert_eq!(
        model.warnings,
        ["The axes of the file are left-handed: the model was mirrored at x = 0, up and front stay where they are."]
    );
}

#[test]
fn each_instance_is_a_part_and_a_mirrored_one_keeps_its_outside() {
    let mut file = Fbx::square();
    let entries: [(&str, &str, &[f64]); 2] = [
        ("Lcl Translation", "Lcl Translation", &[0.0, 0.0, 300.0]),
        ("Lcl Scaling", "Lcl Scaling", &[-1.0, 1.0, 1.0]),
    ];
    file.place(3, "mirrored", &entries);
    file.connect(1, 3, None);
    let model = file.model();
    assert_eq!(model.parts, ["board", "mirrored"]);
    assert_eq!(model.mesh.triangle_part, [0, 0, 1, 1]);
    assert!(corners(&model)[5].abs_diff_eq(Vec3::new(-1.0, 0.0, 3.0), 1e-5));
    let [a, b, c] = model.mesh.triangles[2].map(|vertex| corners(&model)[vertex as usize]);
    assert!((b - a).cross(c - a).z > 0.0, "the outside faces the same way");
    assert!(model.mesh.normals.iter().all(|normal| normal[2] > 0.99));
}

#[test]
fn a_geometric_transform_moves_the_mesh_of_its_node_alone() {
    let mut file = Fbx::square();
    file.objects.pop();
    file.connections.pop();
    file.place(2, "board", &[("GeometricTranslation", "Vector3D", &[0.0, 0.0, 50.0])]);
    assert!(corners(&file.model())[0].abs_diff_eq(Vec3::new(0.0, 0.0, 0.5), 1e-5));
}

#[test]
fn vertices_far_from_the_origin_of_their_mesh_keep_their_shape() {
    let mut file = Fbx::square();
    let far = 4e9;
    let corners = [0.0, 0.0, 0.0, 100.0, 0.0, 0.0, 100.0, 100.0, 0.0, 0.0, 100.0, 0.0].map(|x| x + far);
    *file.geometry() = mesh(1, &corners, &[0, 1, 2, -4], vec![]);
    let model = file.model();
    assert!(
        (model.middle[0] - (far / 100.0 + 0.5)).abs() < 1e-3,
        "{:?}",
        model.middle
    );
    assert_close(&model, &SQUARE.map(|[x, y, _]| [x - 0.5, y - 0.5, 0.0]));
}

/// Two squares that meet at a right angle in the y axis, with a layer of smoothing.
fn folded(smoothing: Option<FbxElement>) -> Model {
    let corners = [
        -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, -1.0,
    ];
    let mut file = Fbx::square();
    *file.geometry() = mesh(
        1,
        &corners,
        &[0, 1, 2, -4, 1, 4, 5, -3],
        smoothing.into_iter().collect(),
    );
    file.model()
}

#[test]
fn missing_normals_follow_the_smoothing_of_the_file_or_the_crease() {
    let by_polygon = |values: Vec<i32>| {
        let below = vec![
            element("MappingInformationType", vec![text("ByPolygon")], vec![]),
            element("ReferenceInformationType", vec![text("Direct")], vec![]),
            element("Smoothing", vec![FbxValue::Indices(values)], vec![]),
        ];
        element("LayerElementSmoothing", vec![FbxValue::Id(0)], below)
    };
    for (smoothing, vertices, why) in [
        (None, 8, "90° are a crease"),
        (Some(by_polygon(vec![1, 1])), 6, "one group"),
        (Some(by_polygon(vec![0, 0])), 8, "no group"),
    ] {
        assert_eq!(folded(smoothing).mesh.positions.len(), vertices, "{why}");
    }
    let normals = [[0.0, 0.0, 1.0]; 8].concat();
    let own = folded(Some(layer("LayerElementNormal", 0, "Normals", normals, None)));
    assert_eq!(own.mesh.normals, [[0.0, 0.0, 1.0]; 6], "those of the file are kept");
}

#[test]
fn faces_of_many_corners_are_cut_and_holes_left_open() {
    let corners = [
        0.0, 0.0, 0.0, 2.0, 1.0, 0.0, 0.0, 2.0, 0.0, 1.0, 1.0, 0.0, 3.0, 3.0, 0.0,
    ];
    let mut file = Fbx::square();
    *file.geometry() = mesh(1, &corners, &[0, 1, 2, -4, 0, -5, 1, 4, -3], vec![]);
    let model = file.model();
    assert_eq!(model.mesh.triangles.len(), 3);
    assert_eq!(model.warnings, ["Points and lines of mesh `board` are left out."]);
    let area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|vertex| corners_of(&model, vertex));
        (b - a).cross(c - a).z
    };
    assert!(model.mesh.triangles.iter().all(|triangle| area(triangle) > 0.0));
}

fn corners_of(model: &Model, vertex: u32) -> Vec3 {
    Vec3::from(model.mesh.positions[vertex as usize])
}

#[test]
fn vertex_colors_are_taken_as_srgb() {
    let mut file = Fbx::square();
    let colors = layer("LayerElementColor", 0, "Colors", [1.0, 0.5, 0.0, 0.5].repeat(4), None);
    *file.geometry() = mesh(
        1,
        &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0],
        &[0, 1, 2, -4],
        vec![colors],
    );
    let [r, g, b, a] = file.model().mesh.colors[0];
    assert!((g - 0.214_041).abs() < 1e-5 && [r, b, a] == [1.0, 0.0, 0.5], "{g}");
}

#[test]
fn hidden_nodes_are_left_out_and_said() {
    let mut file = Fbx::square();
    file.place(3, "hidden", &[("Visibility", "Visibility", &[0.0])]);
    file.connect(1, 3, None);
    let model = file.model();
    assert_eq!(model.parts, ["board"]);
    assert_eq!(model.warnings, ["Nodes that the file hides are left out."]);
}

/// The board, bound to two bones; `swing` moves the second one away from where it was bound.
fn boned(swing: f64) -> Fbx {
    let mut file = Fbx::square();
    file.add("Deformer", 30, "skin", "Skin", vec![]);
    file.connect(30, 1, None);
    let matrix = |x: f64, y: f64| {
        let rows = [
            1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, y, 0.0, 1.0,
        ];
        vec![FbxValue::Numbers(rows.to_vec())]
    };
    for (bone, y, swing) in [(40, 0.0, 0.0), (41, 50.0, swing)] {
        file.add(
            "Model",
            bone,
            "bone",
            "LimbNode",
            vec![properties(&[("Lcl Translation", "Lcl Translation", &[swing, y, 0.0])])],
        );
        file.connect(bone, 0, None);
        let below = vec![
            element("Indexes", vec![FbxValue::Indices(vec![0, 1, 2, 3])], vec![]),
            element("Weights", vec![FbxValue::Numbers(vec![0.5; 4])], vec![]),
            element("Transform", matrix(0.0, -y), vec![]),
            element("TransformLink", matrix(0.0, y), vec![]),
        ];
        file.add("Deformer", bone + 10, "cluster", "Cluster", below);
        file.connect(bone + 10, 30, None);
        file.connect(bone, bone + 10, None);
    }
    file
}

#[test]
fn a_skinned_mesh_stands_where_it_was_bound() {
    for (swing, sentence) in [
        (0.0, "The skin of `board` is left out: it is taken at rest."),
        (
            30.0,
            "The skeleton of `board` stands in a pose; the mesh is taken as it was bound, without it.",
        ),
    ] {
        let model = boned(swing).model();
        assert_close(&model, &SQUARE);
        assert_eq!(model.warnings, [sentence]);
    }
}

#[test]
fn damage_is_said() {
    let whole = Fbx::square().binary();
    for (bytes, sentence) in [
        (
            &whole[..whole.len() / 2],
            "the file is damaged: it contradicts the rules of FBX, or was cut off",
        ),
        (&whole[..25], "the file is damaged: it was cut off"),
        (
            b"hello, I am a letter and no model at all",
            "the file is damaged: it contradicts the rules of FBX, or was cut off",
        ),
    ] {
        assert_eq!(said("a.fbx", bytes), format!("a.fbx: {sentence}"));
    }
    let mut empty = Fbx::square();
    empty.connections.clear();
    let error = empty.load_with(&LoadOptions::default()).unwrap_err();
    assert_eq!(error.to_string(), "test.fbx: it has no triangles");
}

#[test]
fn a_list_that_promises_billions_takes_no_memory() {
    let mut file = Fbx::square().binary();
    let at = file.windows(8).position(|window| window == b"Vertices").unwrap() + 8;
    assert_eq!(file[at], b'd');
    file[at + 1..at + 5].copy_from_slice(&0xffff_fff0u32.to_le_bytes());
    let said = said("a.fbx", &file);
    assert!(said.starts_with("a.fbx: the file is damaged: "), "{said}");
}

#[test]
fn too_many_instances_are_refused_before_they_are_placed() {
    let mut file = Fbx::square();
    let side = 700;
    let corners: Vec<f64> = (0..side)
        .flat_map(|at| [f64::from(at), 0.0, 0.0, f64::from(at), 1.0, 0.0])
        .collect();
    let polygons: Vec<i32> = (0..side - 1)
        .flat_map(|at| [2 * at, 2 * at + 2, 2 * at + 3, -2 - 2 * at])
        .collect();
    *file.geometry() = mesh(1, &corners, &polygons, vec![]);
    for node in 0..36_000 {
        file.place(100 + node, "copy", &[]);
        file.connect(1, 100 + node, None);
    }
    let error = file.load_with(&LoadOptions::default()).unwrap_err().to_string();
    assert_eq!(
        error,
        "test.fbx: it has 50329398 triangles, and at most 50000000 are handled; reduce it or split it"
    );
}

#[test]
fn decimal_commas_of_a_text_are_told() {
    let text = "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXVersion: 7400\n}\nObjects:  {\n\tGeometry: 1, \"Geometry::\", \"Mesh\" {\n\
                \t\tVertices: *9 {\n\t\t\ta: 0,0,0,1,5,0,0,0,2,5,0\n\t\t}\n\t\tPolygonVertexIndex: *3 {\n\t\t\ta: 0,1,-3\n\t\t}\n\t}\n}\n";
    let read = |text: &str| {
        let mut nothing = crate::builder::nothing;
        load_bytes("test.fbx", text.as_bytes(), &mut nothing, &LoadOptions::default()).map(|_| ())
    };
    let told = read(text).unwrap_err().to_string();
    assert!(
        told.contains("it writes numbers with decimal commas, such as `0,5`"),
        "{told}"
    );
    let whole = read(&text.replace("0,0,0,1,5,0,0,0,2,5,0", "0,0,0,1,0,0,0,2,0"));
    let told = whole.map_or_else(|error| error.to_string(), |()| String::new());
    assert!(!told.contains("commas"), "{told}");
}
