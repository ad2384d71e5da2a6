//! A node's own mask on clay, as it is painted on: the shape of the model is seen whatever the mask is.

use sabi_tests::{DrawableGraph, even_light, project};
use sabi_view::{Mode, Shot, Viewpoint};

use crate::seen;

const SIZE: [u32; 2] = [96, 72];

const GRAPH: &str = r##"{ "format": "sabi", "version": 1, "name": "clay", "nodes": {
    "zero": { "kind": "adjust/levels", "params": { "low": 0 } },
    "one": { "kind": "adjust/levels", "params": { "low": 1, "high": 1 } },
    "red": { "kind": "color/constant", "params": { "color": "#ff0000" } },
    "base": { "kind": "source/material" },
    "out": { "kind": "output/material", "inputs": { "material": "base" } } } }"##;

#[test]
fn the_shape_is_seen_where_a_mask_is_black_and_where_it_is_white() {
    let mut pictured = DrawableGraph::new(GRAPH, &project("assets/meshes/cube.glb"), 64, &even_light(1.0));
    let camera = pictured.camera(Viewpoint::THREE_QUARTER, SIZE);
    let mut values = |node: &str| {
        pictured.show_node(node);
        let shot = Shot {
            mode: Mode::NodeOnClay,
            ..Shot::new(camera)
        };
        let shown = pictured.light(&shot, SIZE);
        let model = seen(&pictured, &camera, SIZE);
        model.map(|(pixel, _)| shown[pixel]).collect::<Vec<[f32; 4]>>()
    };
    let [zero, one, red] = ["zero", "one", "red"].map(&mut values);
    let ends = |values: &[[f32; 4]]| {
        let of_gray = values.iter().map(|value| value[0]);
        of_gray.fold([1.0_f32, 0.0], |[low, high], value| [low.min(value), high.max(value)])
    };
    let ([dark, less_dark], [light, lighter]) = (ends(&zero), ends(&one));
    // The brightness of clay is 0.3 for a mask of 0 and 0.95 for 1, times 1 where it faces the eye, down to 0.55 at the
    // rim.
    assert!(dark > 0.3 * 0.54 && less_dark < 0.301, "{dark} {less_dark}");
    assert!(light > 0.95 * 0.54 && lighter < 0.951, "{light} {lighter}");
    assert!(
        less_dark / dark > 1.1 && lighter / light > 1.1,
        "the sides of the cube differ"
    );
    assert!(light > less_dark, "no place that is painted looks like one that is not");
    let is_red = |value: &[f32; 4]| value[0] > 0.99 && value[1] < 0.01;
    assert!(red.iter().all(is_red), "colors are shown as they are");
}
