//! Lights and the shadows they throw.

use sabi_tests::{DrawableGraph, MeshFile, Quad, even_light};
use sabi_view::{Background, Light, LightPlace, Shot, Viewpoint};

use crate::furnace::look;
use crate::seen;

const SIZE: [u32; 2] = [96, 96];

/// A floor at height 0 and a small square above its middle.
fn floor_and_roof() -> MeshFile {
    let flat = |half: f32, height: f32, uv: f32| Quad {
        corners: [
            [-half, height, half],
            [half, height, half],
            [half, height, -half],
            [-half, height, -half],
        ],
        uvs: [[uv, 0.4], [uv + 0.4, 0.4], [uv + 0.4, 0.0], [uv, 0.0]],
    };
    MeshFile {
        factors: serde_json::json!({ "doubleSided": true }),
        ..MeshFile::new(vec![flat(1.0, 0.0, 0.0), flat(0.3, 0.5, 0.5)])
    }
}

/// Light that leaves the floor in the roof's shadow, and outside of it.
fn floor_light(lights: Vec<Light>) -> [f32; 2] {
    let made = floor_and_roof().write();
    let mut pictured = DrawableGraph::looking(made.path(), &look(0.5, 1.0, 0.0), &even_light(0.0));
    pictured.lights = lights;
    light_of(&pictured, 1)
}

fn light_of(pictured: &DrawableGraph, samples: u32) -> [f32; 2] {
    let camera = pictured.camera(Viewpoint::at(20.0, 30.0), SIZE);
    let shot = Shot {
        background: Background::Clear,
        samples,
        ..Shot::new(camera)
    };
    let light = pictured.light(&shot, SIZE);
    let mut sums = [[0.0, 0.0]; 2];
    for (pixel, picked) in seen(pictured, &camera, SIZE) {
        let [x, y, z] = picked.position.to_array();
        let farthest = x.abs().max(z.abs());
        if y.abs() < 1e-4 && !(0.2..0.4).contains(&farthest) && farthest < 0.9 {
            let sum = &mut sums[usize::from(farthest > 0.3)];
            sum[0] += light[pixel][0];
            sum[1] += 1.0;
        }
    }
    sums.map(|[sum, count]| {
        assert!(count > 20.0, "too little of the floor is seen");
        sum / count
    })
}

#[test]
fn a_floor_under_a_roof_is_dark_in_light_from_above() {
    let far = Light {
        place: LightPlace::Directional([0.0, 1.0, 0.0]),
        color: [3.0; 3],
        has_shadow: true,
        size_degrees: 0.0,
        follows_camera: false,
    };
    let [shaded, open] = floor_light(vec![far]);
    assert!(shaded < 0.02 * open, "{shaded} under the roof, {open} beside it");
    // A matte floor that faces the light reflects its color over pi of the light that falls on it, and its lobe adds a
    // little.
    let matte = 0.5 * 3.0 / std::f32::consts::PI;
    assert!(
        (matte * 0.85..matte * 1.25).contains(&open),
        "{open}, and a matte floor {matte}"
    );
    let [shaded, open] = floor_light(vec![Light {
        has_shadow: false,
        size_degrees: 0.0,
        follows_camera: false,
        ..far
    }]);
    assert!(
        (shaded - open).abs() < 0.1 * open,
        "{shaded} and {open} without shadows"
    );
}

/// Takes opacity from the colors of vertices.
const VEILED: &str = r##"{ "format": "sabi", "version": 1, "nodes": {
    "colors": {"kind": "source/vertex_color"},
    "material": {"kind": "material/combine", "inputs": {"alpha": "colors.alpha"}},
    "out": {"kind": "output/material", "inputs": {"material": "material"}}
} }"##;

#[test]
fn a_roof_blocks_light_in_proportion_to_its_opacity() {
    let far = Light {
        place: LightPlace::Directional([0.0, 1.0, 0.0]),
        color: [3.0; 3],
        has_shadow: true,
        size_degrees: 0.0,
        follows_camera: false,
    };
    for opacity in [0.0, 0.25, 0.5, 0.75] {
        let of_corners = |alpha: f32| [[1.0, 1.0, 1.0, alpha]; 4];
        let made = MeshFile {
            colors: [of_corners(1.0), of_corners(opacity)].concat(),
            ..floor_and_roof()
        };
        let made = made.write();
        let mut pictured = DrawableGraph::new(VEILED, made.path(), 64, &even_light(0.0));
        pictured.lights = vec![far];
        let [shaded, open] = light_of(&pictured, 16);
        let kept = 1.0 - shaded / open;
        assert!(
            (kept - opacity).abs() < 0.05,
            "{kept} of the light where the roof has {opacity}"
        );
    }
}

#[test]
fn a_near_light_throws_shadows_on_all_sides() {
    let near = Light {
        place: LightPlace::Point([0.0, 0.6, 0.0]),
        color: [1.0; 3],
        has_shadow: true,
        size_degrees: 0.0,
        follows_camera: false,
    };
    let [shaded, open] = floor_light(vec![near]);
    assert!(
        open > 0.05 && shaded < 0.02 * open,
        "{shaded} under the roof, {open} beside it"
    );
}

#[test]
fn lights_add_up() {
    let light = |color: f32| Light {
        place: LightPlace::Directional([0.3, 1.0, 0.2]),
        color: [color; 3],
        has_shadow: true,
        size_degrees: 0.0,
        follows_camera: false,
    };
    let [_, twice] = floor_light(vec![light(2.0)]);
    let [_, both] = floor_light(vec![light(1.0), light(1.0)]);
    assert!((twice - both).abs() < 1e-2 * twice, "{twice} and {both}");
}
