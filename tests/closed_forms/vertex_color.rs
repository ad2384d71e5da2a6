//! Vertex colors are interpolated between the corners of each triangle, also across seams.

use sabi_tests::{MeshFile, OnMesh, Quad};

const GRAPH: &str = r#"{ "format": "sabi", "version": 1, "nodes": {
    "colors": { "kind": "source/vertex_color" } } }"#;

/// Two faces that meet at a right angle in one edge of the fold; their charts lie apart.
fn fold() -> Vec<Quad> {
    vec![
        Quad {
            corners: [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
            uvs: [[0.05, 0.45], [0.45, 0.45], [0.45, 0.05], [0.05, 0.05]],
        },
        Quad {
            corners: [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
            uvs: [[0.95, 0.95], [0.95, 0.55], [0.55, 0.55], [0.55, 0.95]],
        },
    ]
}

/// A color that is linear in the place, so that it is known between the corners as well.
fn color([x, y, z]: [f64; 3]) -> [f64; 4] {
    [x, y, 0.5 * z + 0.25, 1.0 - 0.5 * x]
}

#[test]
fn colors_and_alpha_are_those_of_the_place_on_texels_and_on_ghosts() {
    let corners = fold().into_iter().flat_map(|quad| quad.corners);
    let made = MeshFile {
        quads: fold(),
        colors: corners
            .map(|corner| color(corner.map(f64::from)).map(|part| part as f32))
            .collect(),
        ..MeshFile::default()
    };
    let made = made.write();
    let mut on_mesh = OnMesh::new(GRAPH, made.path(), 64);
    assert!(!on_mesh.atlas().ghosts.is_empty());
    let rgb = on_mesh.evaluate("colors.color");
    let rgb = ["color.r", "color.g", "color.b"].map(|name| rgb.component(name));
    let alpha = on_mesh.evaluate("colors.alpha").component("mask");
    let texel = 1.0 / (0.4 * 64.0);
    for index in on_mesh.covered() {
        let place = on_mesh.position(index).expect("a place").to_array();
        let expected = color(place);
        let is = [rgb[0][index], rgb[1][index], rgb[2][index], alpha[index]];
        for (is, expected) in is.into_iter().zip(expected) {
            // A texel's middle may lie outside of its triangle by up to half a texel, where the color stays that of the
            // border.
            assert!(
                (f64::from(is) - expected).abs() < 0.75 * texel,
                "at {place:?}: {is} for {expected}"
            );
        }
    }
    assert!(on_mesh.evaluator.warnings().is_empty());
}

#[test]
fn a_model_without_colors_is_white_and_says_so() {
    let made = MeshFile::new(fold()).write();
    let mut on_mesh = OnMesh::new(GRAPH, made.path(), 32);
    let white = on_mesh.evaluate("colors.color").component("color.g");
    assert!(on_mesh.covered().all(|index| white[index] == 1.0));
    assert_eq!(
        on_mesh.warnings(),
        [
            "node 'colors' (source/vertex_color) gives white: the model has no vertex colors; add some in a modeling \
          program"
        ]
    );
}
