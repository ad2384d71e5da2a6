//! The pages say what the nodes say, and the pictures are what the scene makes of their textures.

use serde_json::{Value, json};

use super::pages::{pages, pictures_of};
use super::scene::SIDE;
use super::specimen::specimen;
use super::studio::MOST_BYTES;
use crate::small_png::encode;

fn node() -> Value {
    json!({
        "id": "noise/dots", "label": "Dots", "summary": "Round dots.", "description": "They lie on the surface.",
        "aliases": ["spots", "rivets"], "shape": "point",
        "inputs": [
            { "name": "position", "type": "vector", "doc": "Where.", "required": false, "default": "at.position" },
            { "name": "source", "type": "mask", "doc": "How | many.", "required": true, "default": null },
        ],
        "outputs": [
            { "name": "mask", "type": "mask", "doc": "The dots." },
            { "name": "id", "type": "mask", "doc": "A value for each." },
        ],
        "params": [{ "name": "size", "label": "Size", "doc": "Across.", "takes": "length", "default": 0.02,
            "range": [0.0, 10.0], "soft": [0.001, 0.1], "takes_mask": true }],
    })
}

#[test]
fn a_page_says_everything_about_its_node() {
    let exists = |path: &str| matches!(path, "shaders/nodes/noise/dots.wgsl" | "docs/nodes/noise/dots.id.png");
    let pages = pages(&[node()], &exists);
    let [(_, index), (name, page)] = pages.as_slice() else {
        panic!("{pages:?}")
    };
    assert_eq!(name, "noise/dots.md");
    for line in [
        "# Dots",
        "`noise/dots` · also found as spots, rivets",
        "They lie on the surface.",
        "<img src=\"dots.id.png\" width=\"288\" alt=\"id\" title=\"id\">",
        "| `position` | vector | Where. | `at.position` |",
        "| `source` | mask | How \\| many. | must be connected |",
        "| Size<br>`size` | length, 0 to 10; slider 0.001 to 0.1; takes a mask | Across. | `0.02` |",
        "| `id` | mask | A value for each. |",
        "Its source is [dots.wgsl](../../../shaders/nodes/noise/dots.wgsl).",
    ] {
        assert!(page.lines().any(|own| own == line), "no line {line:?} in\n{page}");
    }
    assert!(
        !page.contains("dots.png"),
        "a picture that is not there is linked:\n{page}"
    );
    assert!(
        index.contains("| [<img src=\"noise/dots.id.png\" width=\"96\" alt=\"\">](noise/dots.md) |"),
        "{index}"
    );
}

#[test]
fn the_first_result_has_the_name_of_its_node() {
    let node = node();
    let names: Vec<String> = pictures_of(&node).into_iter().map(|(_, name)| name).collect();
    assert_eq!(names, ["noise/dots.png", "noise/dots.id.png"]);
}

#[test]
fn the_hand_made_specimens_can_be_read_and_name_models_that_exist() {
    let all: Value = serde_json::from_str(include_str!("specimens.json")).unwrap();
    for (id, specimen) in all.as_object().unwrap() {
        if let Some(mesh) = specimen["mesh"].as_str() {
            let file = format!("{}/../../assets/meshes/{mesh}.glb", env!("CARGO_MANIFEST_DIR"));
            assert!(
                std::path::Path::new(&file).is_file(),
                "{id} is shown on {mesh}, which there is not"
            );
        }
    }
}

#[test]
fn an_open_place_stays_open_and_any_other_input_is_connected() {
    let specimen = specimen(&node(), "mask").unwrap();
    let inputs = &specimen.graph["nodes"]["node"]["inputs"];
    assert_eq!(*inputs, json!({ "source": "into_source" }));
    assert_eq!(specimen.graph["nodes"]["into_source"]["kind"], "noise/simplex");
    assert_eq!((specimen.target.as_str(), specimen.is_material), ("node.mask", false));
}

#[test]
fn a_picture_is_small_whatever_it_shows_and_exact_when_it_is_plain() {
    let mut state = 1u32;
    let noise: Vec<[u8; 3]> = (0..SIDE * SIDE)
        .map(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            [(state >> 24) as u8, (state >> 16) as u8, (state >> 25) as u8]
        })
        .collect();
    let even: Vec<[u8; 3]> = (0..SIDE * SIDE).map(|at| [(at % 40) as u8 * 6, 100, 30]).collect();
    // Pure noise of eight colors takes three bits a pixel, more than any picture may: that is told, not written.
    assert!(encode(&noise, [SIDE; 2], MOST_BYTES).is_err());
    let bytes = encode(&even, [SIDE; 2], MOST_BYTES).unwrap();
    assert!(bytes.len() <= MOST_BYTES);
    let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    let palette = reader.info().palette.clone().unwrap().into_owned();
    let mut indices = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut indices).unwrap();
    for (color, &index) in even.iter().zip(&indices) {
        assert_eq!(palette[usize::from(index) * 3..][..3], *color);
    }
}
