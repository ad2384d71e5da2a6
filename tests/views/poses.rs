//! A model that is seen once and shown in many looks.

use sabi_tests::{DrawableGraph, device, even_light, project};
use sabi_view::{Background, Light, MaterialLook, Mode, Renderer, STUDIO_LIGHTS, Shot, Viewpoint};

use crate::furnace::look;

const SIZE: [u32; 2] = [48, 40];

const NODES: &str = r#"{ "format": "sabi", "version": 1, "nodes": {
    "clouds": { "kind": "noise/simplex" },
    "plain": { "kind": "source/material" },
    "out": { "kind": "output/material", "inputs": { "material": "plain" } } } }"#;

#[test]
fn each_look_of_a_pose_equals_a_picture_of_that_look_alone() {
    let mesh = project("assets/meshes/cube.glb");
    let mut pictured = DrawableGraph::new(NODES, &mesh, 64, &even_light(0.8));
    // A pose has the lights of a studio, with hard shadows.
    pictured.lights = STUDIO_LIGHTS
        .map(|light| Light {
            size_degrees: 0.0,
            ..light
        })
        .to_vec();
    pictured.show_node("clouds");
    let of_node = pictured.shown.looks.last().expect("a look").clone();
    let clear = MaterialLook {
        color: [0.9, 0.1, 0.1, 0.4],
        is_opaque: false,
        ..look(0.5, 0.5, 0.0)
    };
    let gpu = device();
    let renderer = Renderer::new(&gpu).expect("a renderer");
    for samples in [1, 4] {
        let shot = Shot {
            background: Background::Clear,
            samples,
            ..Shot::new(pictured.camera(Viewpoint::THREE_QUARTER, SIZE))
        };
        let (model, light) = (&pictured.model, &pictured.environment);
        let mut pose = renderer.pose(&gpu, SIZE, model, light, &shot).expect("a pose");
        let looks = [look(0.6, 0.3, 0.0), of_node.clone(), clear.clone(), look(0.2, 0.9, 1.0)];
        let posed: Vec<_> = looks
            .iter()
            .map(|look| {
                let drawn = renderer
                    .draw_look(&gpu, &mut pose, model, light, look)
                    .expect("a picture");
                drawn.read(&gpu).expect("pixels")
            })
            .collect();
        for (look, posed) in looks.iter().zip(posed) {
            pictured.set_look(look);
            let mode = if look.node.is_some() {
                Mode::Node
            } else {
                Mode::Material
            };
            assert!(
                posed == pictured.pixels(&Shot { mode, ..shot.clone() }, SIZE),
                "{look:?}, {samples} samples"
            );
        }
    }
}
