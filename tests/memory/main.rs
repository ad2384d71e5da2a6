//! Memory that pictures keep, measured in a process of its own.
#![cfg(target_os = "linux")]

use sabi_tests::{DrawableGraph, even_light, project};
use sabi_view::{Background, Light, LightPlace, Lines, Mode, Shot, ViewTransform, Viewpoint};

const SIZE: [u32; 2] = [48, 32];
/// Most bytes that pictures may keep. With a shader branch on a uniform buffer, Mesa 22.3 kept 198 MB of shaders.
const MOST_KEPT: u64 = 4 << 20;
const PICTURES: usize = 120;

/// A material of all maps, clear here and there.
const COATED: &str = r##"{ "format": "sabi", "version": 1, "name": "coated", "nodes": {
    "clouds": { "kind": "noise/simplex", "params": { "size": 0.25, "octaves": 1 } },
    "base": { "kind": "source/material", "params": { "opacity": 0.5 } },
    "coat": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "clouds", "height_map": "clouds" },
      "params": { "color": "#6b3a1e", "height": 0.04 } },
    "out": { "kind": "output/material", "inputs": { "material": "coat" } } } }"##;

/// Bytes of this process that are in memory.
fn resident_bytes() -> u64 {
    let pages = std::fs::read_to_string("/proc/self/statm").expect("the system's numbers");
    let pages: u64 = pages
        .split_whitespace()
        .nth(1)
        .and_then(|pages| pages.parse().ok())
        .expect("a number of pages");
    pages * 4096
}

fn lights() -> Vec<Light> {
    [
        (LightPlace::Directional([0.3, 0.8, 0.4]), true),
        (LightPlace::Point([0.9, 0.9, 0.0]), false),
    ]
    .into_iter()
    .map(|(place, has_shadow)| Light {
        place,
        color: [0.7, 0.6, 0.5],
        has_shadow,
        size_degrees: 0.0,
        follows_camera: false,
    })
    .collect()
}

#[test]
fn pictures_from_ever_other_places_keep_no_memory() {
    let mesh = project("assets/meshes/cube.glb");
    let mut pictured = DrawableGraph::new(COATED, &mesh, 64, &even_light(0.8));
    pictured.lights = lights();
    let first = Shot {
        height_range: pictured.shown.height_range,
        has_relief: true,
        samples: 2,
        ..Shot::new(pictured.camera(Viewpoint::THREE_QUARTER, SIZE))
    };
    let shots = [
        ("relief", first.clone()),
        (
            "even",
            Shot {
                has_relief: false,
                background: Background::Environment,
                transform: ViewTransform::Aces,
                samples: 1,
                ..first.clone()
            },
        ),
        (
            "lines on heights",
            Shot {
                mode: Mode::Height,
                lines: vec![Lines::Wires],
                ..first.clone()
            },
        ),
        (
            "clay",
            Shot {
                mode: Mode::Clay,
                background: Background::Clear,
                ..first
            },
        ),
    ];
    for (name, mut shot) in shots {
        // What is kept once is kept after the first round, and a driver takes memory in blocks, one of which may come late. What is
        // leaked is leaked in every round.
        let mut kept = u64::MAX;
        for _ in 0..4 {
            let before = resident_bytes();
            for _ in 0..PICTURES {
                shot.camera.turn(1.0);
                shot.height_range[1] *= 1.001;
                shot.exposure_stops += 0.001;
                pictured.draw(&shot, SIZE);
            }
            kept = kept.min(resident_bytes().saturating_sub(before));
        }
        assert!(kept < MOST_KEPT, "{name}: {kept} bytes after {PICTURES} pictures");
    }
}
