//! Relief against a march on the processor through the same heights.

use glam::Vec3;
use sabi_tests::{DrawableGraph, MeshFile, Quad, even_light};
use sabi_view::relief::{ReliefFrame, march};
use sabi_view::{Mode, Shot, Viewpoint};

use crate::seen;

const SIZE: [u32; 2] = [96, 96];

/// Smooth hills on a square that faces +Z.
const HILLS: &str = r##"{ "format": "sabi", "version": 1, "name": "hills", "nodes": {
    "clouds": { "kind": "noise/simplex", "params": { "size": 0.25, "octaves": 1 } },
    "base": { "kind": "source/material" },
    "coat": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "clouds" }, "params": { "height": 0.04 } },
    "out": { "kind": "output/material", "inputs": { "material": "coat" } } } }"##;

fn square() -> MeshFile {
    MeshFile::new(vec![Quad {
        corners: [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]],
        uvs: [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
    }])
}

/// Interpolates between the four texels around a place of a page.
fn between(texels: &[f32], width: usize, [x, y]: [f64; 2]) -> f64 {
    let (left, top) = ((x - 0.5).floor(), (y - 0.5).floor());
    let (u, v) = (x - 0.5 - left, y - 0.5 - top);
    let at = |dx: f64, dy: f64| f64::from(texels[(top + dy) as usize * width + (left + dx) as usize]);
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    mix(
        mix(at(0.0, 0.0), at(1.0, 0.0), u),
        mix(at(0.0, 1.0), at(1.0, 1.0), u),
        v,
    )
}

#[test]
fn lines_of_sight_hit_relief_where_a_march_on_the_processor_hits_it() {
    let made = square().write();
    let texels = 128;
    let mut pictured = DrawableGraph::new(HILLS, made.path(), texels, &even_light(1.0));
    let heights = pictured.on_mesh.evaluate("coat").component("height");
    let width = pictured.on_mesh.evaluator.linked().atlas.page_size[0] as usize;
    for viewpoint in [
        Viewpoint::at(0.0, 0.0),
        Viewpoint::at(40.0, 25.0),
        Viewpoint::at(-65.0, -10.0),
    ] {
        let camera = pictured.camera(viewpoint, SIZE);
        let shot = Shot {
            mode: Mode::Shift,
            has_relief: true,
            height_range: pictured.shown.height_range,
            ..Shot::new(camera)
        };
        let shifts = pictured.light(&shot, SIZE);
        let height = |place: [f64; 2]| between(&heights, width, place);
        // The square is two model units wide, which are one working unit.
        let texel = 1.0 / f64::from(texels);
        let frame = ReliefFrame {
            model_from_texel_u: [texel, 0.0, 0.0],
            model_from_texel_v: [0.0, -texel, 0.0],
            normal: [0.0, 0.0, 1.0],
        };
        let range = pictured.shown.height_range.map(f64::from);
        let (mut compared, mut others) = (0, 0);
        for (pixel, picked) in seen(&pictured, &camera, SIZE) {
            let place = picked.texel.map(f64::from);
            // Near the border, a line of sight may hit hills beyond it, which are not compared.
            let margin = 40.0;
            let is_far_in = picked
                .map_texel
                .iter()
                .all(|at| (margin..texels as f32 - margin).contains(at));
            if !is_far_in {
                continue;
            }
            let sight = (picked.position_view - camera.eye()).normalize();
            let direction = frame.relief_from_model(sight.as_dvec3().to_array()).expect("a frame");
            let hit = march(height, place, direction, range).expect("a hit");
            let shift = Vec3::from_slice(&shifts[pixel]).as_dvec3();
            let apart = (shift.x - (hit.texel[0] - place[0])).hypot(shift.y - (hit.texel[1] - place[1]));
            others += i32::from(apart >= 1.0);
            compared += 1;
        }
        // A line of sight that just touches a hilltop meets it in one precision and misses it in the other.
        assert!(200 * others <= compared, "{viewpoint:?}: {others} hits of {compared}");
        assert!(compared > 100, "only {compared} pixels were compared");
    }
}

#[test]
fn without_heights_relief_changes_nothing() {
    let made = square().write();
    let flat = HILLS.replace("0.04", "0.0");
    let pictured = DrawableGraph::new(&flat, made.path(), 64, &even_light(1.0));
    let plain = Shot::new(pictured.camera(Viewpoint::THREE_QUARTER, SIZE));
    let with_relief = Shot {
        has_relief: true,
        height_range: pictured.shown.height_range,
        ..plain.clone()
    };
    assert_eq!(pictured.pixels(&plain, SIZE), pictured.pixels(&with_relief, SIZE));
}
