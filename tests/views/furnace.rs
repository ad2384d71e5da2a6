//! The white furnace: in even light a body that absorbs nothing cannot be seen.

use sabi_gpu::DeviceMaps;
use sabi_tests::{DrawableGraph, MeshFile, Quad, even_light, project};
use sabi_view::{MaterialLook, Shot, Viewpoint};

/// A plain material.
pub(crate) fn look(color: f32, roughness: f32, metallic: f32) -> MaterialLook {
    MaterialLook {
        maps: DeviceMaps::default(),
        color: [color, color, color, 1.0],
        surface: [roughness, metallic, 1.0],
        is_opaque: true,
        node: None,
    }
}

const SIZE: [u32; 2] = [96, 96];

#[test]
fn white_bodies_of_any_roughness_vanish_in_even_light() {
    let mesh = project("assets/meshes/sphere.glb");
    let mut pictured = DrawableGraph::looking(&mesh, &look(1.0, 0.0, 0.0), &even_light(1.0));
    let shot = Shot::new(pictured.camera(Viewpoint::THREE_QUARTER, SIZE));
    for metallic in [0.0, 1.0] {
        for step in 0..=10 {
            let roughness = step as f32 / 10.0;
            pictured.set_look(&look(1.0, roughness, metallic));
            let light = pictured.light(&shot, SIZE);
            for (pixel, [r, g, b, cover]) in light.iter().enumerate() {
                assert_eq!(*cover, 1.0, "the background is lit, too");
                for channel in [r, g, b] {
                    assert!(
                        (channel - 1.0).abs() < 0.01,
                        "roughness {roughness}, metallic {metallic}, pixel {pixel}: {channel}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_gray_body_never_sends_out_more_than_falls_on_it() {
    let mesh = project("assets/meshes/sphere.glb");
    let mut pictured = DrawableGraph::looking(&mesh, &look(0.5, 0.0, 0.0), &even_light(2.0));
    let shot = Shot::new(pictured.camera(Viewpoint::FRONT, SIZE));
    for (roughness, metallic) in [(0.0, 0.0), (0.3, 1.0), (0.7, 0.5), (1.0, 0.0), (1.0, 1.0)] {
        pictured.set_look(&look(0.5, roughness, metallic));
        let light = pictured.light(&shot, SIZE);
        let brightest = light.iter().map(|pixel| pixel[0]).fold(0.0, f32::max);
        let middle = light[(SIZE[0] * SIZE[1] / 2 + SIZE[0] / 2) as usize][0];
        assert!(
            brightest <= 2.02,
            "roughness {roughness}, metallic {metallic}: {brightest}"
        );
        // Light that bounces between the facets of rough metal loses half of itself each time.
        assert!(
            (0.4..1.2).contains(&middle),
            "roughness {roughness}, metallic {metallic}: {middle}"
        );
    }
}

/// Hills steeper than the line of sight.
fn steep_hills(metallic: u8) -> String {
    format!(
        r##"{{ "format": "sabi", "version": 1, "name": "steep", "nodes": {{
    "clouds": {{ "kind": "noise/simplex", "params": {{ "size": 0.2, "octaves": 1 }} }},
    "coat": {{ "kind": "effect/layer", "inputs": {{ "mask": "clouds" }}, "params": {{ "height": 0.3, "color_on": false,
        "roughness_on": false, "metallic_on": false }} }},
    "white": {{ "kind": "effect/layer", "inputs": {{ "base": "coat" }}, "params": {{ "color": "#ffffff", "roughness": 0.3,
        "metallic": {metallic} }} }},
    "out": {{ "kind": "output/material", "inputs": {{ "material": "white" }} }} }} }}"##
    )
}

#[test]
fn bumps_that_face_away_from_the_eye_vanish_in_even_light_too() {
    let square = MeshFile::new(vec![Quad {
        corners: [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]],
        uvs: [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
    }]);
    let made = square.write();
    for metallic in [0, 1] {
        let pictured = DrawableGraph::new(&steep_hills(metallic), made.path(), 128, &even_light(1.0));
        let shot = Shot::new(pictured.camera(Viewpoint::at(65.0, 20.0), SIZE));
        for (pixel, [red, ..]) in pictured.light(&shot, SIZE).iter().enumerate() {
            assert!((red - 1.0).abs() < 0.01, "metallic {metallic}, pixel {pixel}: {red}");
        }
    }
}

#[test]
fn a_buried_place_is_as_dark_as_its_occlusion_says() {
    let mesh = project("assets/meshes/sphere.glb");
    let mut pictured = DrawableGraph::looking(&mesh, &look(1.0, 1.0, 0.0), &even_light(1.0));
    let shot = Shot::new(pictured.camera(Viewpoint::FRONT, SIZE));
    for open in [0.0, 0.25, 0.5, 1.0] {
        let mut buried = look(1.0, 1.0, 0.0);
        buried.surface[2] = open;
        pictured.set_look(&buried);
        let light = pictured.light(&shot, SIZE);
        let middle = light[(SIZE[0] * SIZE[1] / 2 + SIZE[0] / 2) as usize][0];
        // The specular lobe, a twentieth of the light here, has a rule of its own for occlusion.
        assert!((middle - open).abs() < 0.05, "open {open}: {middle}");
    }
}
