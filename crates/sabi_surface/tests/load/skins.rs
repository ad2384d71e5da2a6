//! Skinned meshes are taken as they were bound, where their skeleton holds them.

use serde_json::json;

use crate::builder::{Gltf, floats};

/// The triangle, bound in the plane z = 0 to two bones below an armature that turns z up into y up and doubles it.
/// `swing` moves the second bone away from where it was bound.
fn armature(swing: f32) -> Gltf {
    let mut file = Gltf::triangle();
    let bound = |x: f32, y: f32| {
        [
            1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -x, -y, 0.0, 1.0,
        ]
    };
    let matrices: Vec<f32> = [bound(1.0, 2.0), bound(1.0, 5.0)].concat();
    let matrices = file.accessor(crate::builder::F32, "MAT4", 2, &floats(&matrices));
    let half = std::f32::consts::FRAC_1_SQRT_2;
    file.json["nodes"] = json!([
        { "name": "body", "mesh": 0, "skin": 0, "translation": [7, 7, 7] },
        { "name": "armature", "children": [2], "rotation": [-half, 0, 0, half], "scale": [2, 2, 2] },
        { "translation": [1, 2, 0], "children": [3] },
        { "translation": [swing, 3, 0] },
    ]);
    file.json["skins"] = json!([{ "joints": [2, 3], "inverseBindMatrices": matrices }]);
    file
}

#[test]
fn a_mesh_at_rest_stands_where_its_skeleton_holds_it() {
    for (swing, sentence) in [
        (0.0, "The skin of `body` is left out: it is taken at rest."),
        (
            1.0,
            "The skeleton of `body` stands in a pose; the mesh is taken as it was bound, without it.",
        ),
    ] {
        let model = armature(swing).model();
        let expected = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0]];
        for (position, expected) in model.mesh.positions.iter().zip(expected) {
            assert!(
                glam::Vec3::from(*position).abs_diff_eq(expected.into(), 1e-5),
                "{position:?} is not {expected:?}"
            );
        }
        assert_eq!(model.warnings, [sentence]);
    }
}

#[test]
fn a_broken_skin_takes_nothing_with_it() {
    type Edit = fn(&mut Gltf);
    let cases: [(Edit, &str); 7] = [
        (|f| f.json["skins"] = json!([]), "there is no skins[0]"),
        (|f| f.json["skins"][0] = json!({}), "it has no joints"),
        (
            |f| f.json["skins"][0]["joints"] = json!([2, 9]),
            "its joint 9 is not in the scene",
        ),
        (
            |f| f.json["skins"][0]["joints"] = json!(["hip"]),
            "its joint \"hip\" is not in the scene",
        ),
        (
            |f| f.json["skins"][0]["joints"] = json!([2, 3, 3]),
            "it has 3 joints and 2 matrices",
        ),
        (
            |f| f.json["skins"][0]["inverseBindMatrices"] = json!(0),
            "the file is damaged: accessors[0] (inverse bind matrices) has elements of kind Vec3, not of 16 numbers",
        ),
        (
            |f| f.json["nodes"][1]["scale"] = json!([0, 1, 1]),
            "its joint 2 leaves nothing of it",
        ),
    ];
    for (edit, reason) in cases {
        let mut file = armature(0.0);
        edit(&mut file);
        let model = file.model();
        assert_eq!(model.mesh.positions[1], [1.0, 0.0, 0.0]);
        let sentence = format!("The skin of `body` cannot be read ({reason}); the mesh is taken as it is stored.");
        assert_eq!(model.warnings, [sentence]);
    }
}
