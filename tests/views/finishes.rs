//! Coat, anisotropy, sheen and light below the surface: their effects, and that they add no energy.

use sabi_nodes::kind::Channel;
use sabi_nodes::link::Plane;
use sabi_tests::{DrawableGraph, even_light, project};
use sabi_view::{Mode, Shot, Viewpoint};

use crate::agreement::{between, stored};
use crate::{is_inside, seen};

const SIZE: [u32; 2] = [96, 96];

/// A material of a color with these parameters of a layer.
fn graph(color: &str, params: &str, roughness: f32, metallic: f32) -> String {
    format!(
        r##"{{ "format": "sabi", "version": 1, "nodes": {{
    "base": {{ "kind": "source/material", "params": {{ "color": "{color}", "roughness": {roughness}, "metallic": {metallic} }} }},
    "fibers": {{ "kind": "noise/anisotropic" }},
    "finish": {{ "kind": "effect/layer", "inputs": {{ "base": "base", "anisotropy_direction": "fibers.direction" }},
        "params": {{ "color_on": false, "roughness_on": false, "metallic_on": false, {params} }} }},
    "out": {{ "kind": "output/material", "inputs": {{ "material": "finish" }} }} }} }}"##
    )
}

/// Lowest and highest light of a white sphere in even light of 1.
fn range_in_even_light(params: &str, roughness: f32, metallic: f32) -> [f32; 2] {
    let sphere = project("assets/meshes/sphere.glb");
    let pictured = DrawableGraph::new(
        &graph("#ffffff", params, roughness, metallic),
        &sphere,
        64,
        &even_light(1.0),
    );
    let shot = Shot::new(pictured.camera(Viewpoint::THREE_QUARTER, SIZE));
    let light = pictured.light(&shot, SIZE);
    let fold = |pick: fn(f32, f32) -> f32, start: f32| light.iter().map(|pixel| pixel[0]).fold(start, pick);
    [fold(f32::min, f32::INFINITY), fold(f32::max, 0.0)]
}

#[test]
fn no_finish_sends_out_more_light_than_falls_on_it() {
    for params in [
        r#""coat": 1, "coat_roughness": 0"#,
        r#""coat": 1, "coat_roughness": 0.6"#,
        r##""sheen": "#ffffff", "sheen_roughness": 0.3"##,
        r##""sheen": "#ffffff", "sheen_roughness": 1"##,
        r#""anisotropy": 1"#,
        r##""subsurface": "#ffffff""##,
        r#""subsurface_transmission": 1"#,
    ] {
        for (roughness, metallic) in [(0.2, 0.0), (0.8, 0.0), (0.3, 1.0)] {
            let [low, high] = range_in_even_light(params, roughness, metallic);
            assert!(
                high < 1.01,
                "{params}, roughness {roughness}, metallic {metallic}: {high}"
            );
            // A sheen takes as much light from below as it reflects in its strongest direction; nothing else loses
            // light.
            let least = if params.contains("sheen\"") { 0.6 } else { 0.98 };
            assert!(
                low > least,
                "{params}, roughness {roughness}, metallic {metallic}: {low}"
            );
        }
    }
}

#[test]
fn a_coat_over_a_dark_body_adds_its_reflection_in_proportion_to_its_strength() {
    let sphere = project("assets/meshes/sphere.glb");
    let middle = |params: &str| {
        let pictured = DrawableGraph::new(&graph("#000000", params, 1.0, 0.0), &sphere, 64, &even_light(1.0));
        let shot = Shot::new(pictured.camera(Viewpoint::FRONT, SIZE));
        pictured.light(&shot, SIZE)[(SIZE[0] * SIZE[1] / 2 + SIZE[0] / 2) as usize][0]
    };
    let plain = middle(r#""coat": 0"#);
    let none = middle(r#""coat": 0.5, "opacity": 0"#);
    assert_eq!(none, plain);
    // Seen straight on, a mirror of a refractive index of 1.5 reflects 0.04 of the light, and lets the rest through.
    for coat in [0.5, 1.0] {
        let coated = middle(&format!(r#""coat": {coat}, "coat_roughness": 0"#));
        let expected = plain + coat * 0.04 * (1.0 - plain);
        assert!(
            (coated - expected).abs() < 2e-3,
            "coat {coat}: {coated}, not {expected}"
        );
    }
}

#[test]
fn rare_channels_are_shown_as_they_are_exported() {
    let graph = r##"{ "format": "sabi", "version": 1, "nodes": {
    "clouds": { "kind": "noise/simplex", "params": { "size": 0.4 } },
    "fibers": { "kind": "noise/anisotropic" },
    "finish": { "kind": "effect/layer", "inputs": { "mask": "clouds", "anisotropy_direction": "fibers.direction" }, "params": {
        "coat": 0.9, "coat_roughness": 0.6, "anisotropy": 0.8, "sheen": "#c08040", "sheen_roughness": 0.7,
        "subsurface": "#80c0ff", "subsurface_transmission": 0.5 } },
    "out": { "kind": "output/material", "inputs": { "material": "finish" } } } }"##;
    let mut pictured = DrawableGraph::new(graph, &project("assets/meshes/figure.glb"), 256, &even_light(1.0));
    let planes = pictured.on_mesh.evaluate("finish").planes;
    let plane_of = |channel: Channel| {
        let found = planes.iter().find(|(plane, _)| *plane == Plane::Material(channel));
        &found.expect("the channel is set").1
    };
    let camera = pictured.camera(Viewpoint::FRONT, SIZE);
    for (mode, channel, at, is_color) in [
        (Mode::Coat, Channel::Coat, 0, false),
        (Mode::CoatRoughness, Channel::Coat, 1, false),
        (Mode::Sheen, Channel::Sheen, 0, true),
        (Mode::SheenRoughness, Channel::Sheen, 3, false),
        (Mode::Subsurface, Channel::Subsurface, 0, true),
        (Mode::Transmission, Channel::Subsurface, 3, false),
    ] {
        let plane = stored(plane_of(channel));
        let shown = pictured.pixels(
            &Shot {
                mode,
                ..Shot::new(camera)
            },
            SIZE,
        );
        let mut compared = 0;
        for (pixel, picked) in seen(&pictured, &camera, SIZE).filter(|(_, picked)| is_inside(picked)) {
            let value = between(&plane, &pictured.on_mesh, &picked)[at];
            let expected = match is_color {
                true => i32::from(sabi_color::srgb8_from_linear(value)),
                false => (value.clamp(0.0, 1.0) * 255.0).round() as i32,
            };
            let code = i32::from(shown.rgba[4 * pixel]);
            assert!(
                (code - expected).abs() <= 1,
                "{mode:?} at {pixel}: {code}, not {expected}"
            );
            compared += 1;
        }
        assert!(compared > 500, "only {compared} pixels were compared");
    }
}
