//! The look that pictures start with: framing, colors, ground and shade.

use sabi_tests::{DrawableGraph, even_light, project};
use sabi_view::{Background, Pixels, STUDIO_ENVIRONMENT_STRENGTH, STUDIO_LIGHTS, Shot, ViewTransform, Viewpoint};

use crate::furnace::look;

/// A model of the project in one material, with the lights of the studio and the shade of the model.
fn in_studio(mesh: &str, color: [f32; 3], roughness: f32) -> DrawableGraph {
    let mesh = project(&format!("assets/meshes/{mesh}.glb"));
    let mut look = look(0.5, roughness, 0.0);
    look.color = [color[0], color[1], color[2], 1.0];
    let mut pictured = DrawableGraph::looking(&mesh, &look, &even_light(0.5));
    pictured.lights = STUDIO_LIGHTS.to_vec();
    pictured
        .on_mesh
        .evaluator
        .add_shade(&pictured.model, None)
        .expect("the shade");
    pictured
}

fn studio_shot(pictured: &DrawableGraph, size: [u32; 2]) -> Shot {
    Shot {
        environment_strength: STUDIO_ENVIRONMENT_STRENGTH,
        background: Background::Clear,
        samples: 4,
        ..Shot::new(pictured.camera(Viewpoint::THREE_QUARTER, size))
    }
}

/// Pixels that the model covers, by row.
fn covered(pixels: &Pixels, [width, _]: [u32; 2]) -> Vec<Vec<[f32; 3]>> {
    let rows = pixels.rgba.chunks(4 * width as usize);
    let color = |pixel: &[u8]| [0, 1, 2].map(|part| f32::from(pixel[part]) / 255.0);
    rows.map(|row| {
        let covered = row.chunks(4).filter(|pixel| pixel[3] > 250);
        covered.map(color).collect()
    })
    .collect()
}

#[test]
fn a_model_fills_55_to_75_percent_of_the_shorter_side_of_a_picture() {
    for mesh in ["crate", "bench", "figure", "column", "chain", "barrel"] {
        let pictured = in_studio(mesh, [0.5; 3], 0.5);
        for size in [[160, 90], [120, 90]] {
            let rows = covered(&pictured.pixels(&studio_shot(&pictured, size), size), size);
            let filled = rows.iter().filter(|row| !row.is_empty()).count();
            let share = filled as f32 / size[1] as f32;
            assert!((0.55..=0.76).contains(&share), "{mesh} at {size:?} fills {share}");
        }
    }
}

/// Median of the saturation of a paint of saturation 0.59, `#2f5d73`, on a ball in the studio.
fn saturation(transform: ViewTransform) -> f32 {
    let size = [64, 64];
    let pictured = in_studio("sphere", [0.0284, 0.1095, 0.1714], 0.5);
    let shot = Shot {
        transform,
        ..studio_shot(&pictured, size)
    };
    let colors = covered(&pictured.pixels(&shot, size), size).concat();
    let mut saturations: Vec<f32> = colors
        .iter()
        .map(|color| {
            let [high, low] = [
                color.iter().copied().fold(0.0, f32::max),
                color.iter().copied().fold(1.0, f32::min),
            ];
            (high - low) / high.max(1e-3)
        })
        .collect();
    saturations.sort_by(f32::total_cmp);
    saturations[saturations.len() / 2]
}

#[test]
fn the_default_transform_keeps_the_saturation_of_a_paint_and_agx_reduces_it() {
    let [neutral, agx] = [ViewTransform::default(), ViewTransform::AgX].map(saturation);
    assert!(neutral > 0.5, "{neutral} of 0.59");
    assert!(agx < neutral - 0.1, "{agx} through AgX, {neutral} by default");
}

#[test]
fn the_ground_is_darkest_beside_the_model_and_clear_far_from_it() {
    let size = [120, 90];
    let pictured = in_studio("crate", [0.5; 3], 0.8);
    let with = Shot {
        has_ground: true,
        ..studio_shot(&pictured, size)
    };
    let without = studio_shot(&pictured, size);
    let [with, without] = [with, without].map(|shot| pictured.pixels(&shot, size).rgba);
    let at = |pixels: &[u8], x: usize, y: usize| pixels[4 * (y * 120 + x) + 3];
    // The lowest row of the model in each column, and the shade right below it.
    let below = (20..100).filter_map(|x| {
        let low = (0..90).rev().find(|y| at(&without, x, *y) == 255)?;
        (low + 2 < 90).then(|| at(&with, x, low + 2))
    });
    let below: Vec<u8> = below.collect();
    assert!(below.len() > 40, "{} columns show the foot of the crate", below.len());
    let mean = below.iter().map(|alpha| f64::from(*alpha)).sum::<f64>() / below.len() as f64;
    assert!(mean > 60.0, "the shade beside the model covers {mean} of 255");
    assert!(at(&with, 1, 1) < 8 && at(&with, 118, 88) < 40, "the corners stay clear");
    assert!(
        without
            .chunks(4)
            .zip(with.chunks(4))
            .all(|(without, with)| without[3] <= with[3]),
        "the ground only adds shade"
    );
}

#[test]
fn the_shade_of_the_model_darkens_what_its_parts_enclose() {
    let mesh = project("assets/meshes/bench.glb");
    let size = [96, 64];
    let look = look(0.5, 1.0, 0.0);
    let picture = |has_shade: bool| {
        let pictured = DrawableGraph::looking(&mesh, &look, &even_light(0.8));
        if has_shade {
            pictured
                .on_mesh
                .evaluator
                .add_shade(&pictured.model, None)
                .expect("the shade");
        }
        covered(&pictured.pixels(&studio_shot(&pictured, size), size), size).concat()
    };
    let [bare, shaded] = [picture(false), picture(true)];
    assert_eq!(bare.len(), shaded.len());
    let mut ratios: Vec<f32> = bare
        .iter()
        .zip(&shaded)
        .map(|(bare, shaded)| shaded[1] / bare[1].max(1e-3))
        .collect();
    ratios.sort_by(f32::total_cmp);
    let quantile = |share: f32| ratios[(share * (ratios.len() - 1) as f32) as usize];
    assert!(quantile(0.05) < 0.85, "the darkest twentieth keeps {}", quantile(0.05));
    assert!(quantile(0.9) > 0.9, "open places keep {}", quantile(0.9));
}
