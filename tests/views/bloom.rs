//! Bloom: light above white glows over its surroundings, and nothing else changes.

use std::sync::Arc;

use sabi_tests::{DrawableGraph, device, even_light, project};
use sabi_view::{Background, Pixels, Renderer, SceneRevision, Shot, ViewTransform, Viewpoint, Viewport};

use crate::furnace::look;

const SIZE: [u32; 2] = [160, 120];
/// A plain background without light.
const BLACK: Background = Background::Plain([0.0; 3]);

/// A white sphere in even light.
fn sphere(radiance: f32) -> DrawableGraph {
    DrawableGraph::looking(
        &project("assets/meshes/sphere.glb"),
        &look(0.8, 1.0, 0.0),
        &even_light(radiance),
    )
}

fn shot(pictured: &DrawableGraph, bloom: f32, background: Background) -> Shot {
    Shot {
        bloom,
        background,
        transform: ViewTransform::Standard,
        samples: 3,
        ..Shot::new(pictured.camera(Viewpoint::FRONT, SIZE))
    }
}

/// Linear light of the codes of a row of pixels, from the left.
fn row(pixels: &Pixels, number: u32) -> Vec<f32> {
    let [width, _] = pixels.size;
    let (codes, _) = pixels.rgba.as_chunks::<4>();
    let first = (number * width) as usize;
    codes[first..first + width as usize]
        .iter()
        .map(|[code, ..]| match f32::from(*code) / 255.0 {
            code if code <= 0.04045 => code / 12.92,
            code => ((code + 0.055) / 1.055).powf(2.4),
        })
        .collect()
}

#[test]
fn a_picture_without_light_above_white_has_no_bloom() {
    let pictured = sphere(0.7);
    for background in [BLACK, Background::Clear, Background::Environment] {
        let [without, with] = [0.0, 1.0].map(|bloom| pictured.pixels(&shot(&pictured, bloom, background), SIZE));
        assert!(without == with, "{background:?}");
    }
}

#[test]
fn light_above_white_glows_in_proportion_and_less_with_distance() {
    let pictured = sphere(4.0);
    let of = |bloom: f32| pictured.pixels(&shot(&pictured, bloom, BLACK), SIZE);
    let (none, some, twice) = (of(0.0), of(0.1), of(0.2));
    let middle = SIZE[1] / 2;
    let [none_row, some_row, twice_row] = [&none, &some, &twice].map(|pixels| row(pixels, middle));
    let edge = none_row.iter().position(|light| *light > 0.0).expect("the sphere");
    assert!(edge > 20 && none_row[SIZE[0] as usize / 2] > 0.99, "{none_row:?}");
    let glow = &some_row[..edge - 1];
    assert!(glow[edge - 2] > 0.02, "beside the sphere: {glow:?}");
    assert!(glow[0] < glow[edge - 2] * 0.25, "far from it: {glow:?}");
    // Neighboring codes of 8 bits are up to 0.009 of linear light apart.
    assert!(glow.windows(2).all(|pair| pair[0] <= pair[1] + 0.009), "{glow:?}");
    for (some, twice) in glow.iter().zip(&twice_row) {
        assert!((twice - 2.0 * some).abs() < 0.02, "{twice} for twice {some}");
    }
    assert!(some == of(0.1), "the same bytes again");
}

#[test]
fn bloom_leaves_alpha_as_it_is() {
    let pictured = sphere(4.0);
    let [without, with] = [0.0, 1.0].map(|bloom| pictured.pixels(&shot(&pictured, bloom, Background::Clear), SIZE));
    let alpha = |pixels: &Pixels| -> Vec<u8> { pixels.rgba.iter().skip(3).step_by(4).copied().collect() };
    assert_eq!(alpha(&without), alpha(&with));
    let (clear, _) = with.rgba.as_chunks::<4>();
    assert!(clear.iter().any(|pixel| pixel[3] == 0) && clear.iter().any(|pixel| pixel[3] == 255));
}

#[test]
fn the_light_of_a_picture_is_that_before_its_bloom() {
    let pictured = sphere(4.0);
    let [without, with] = [0.0, 1.0].map(|bloom| pictured.light(&shot(&pictured, bloom, BLACK), SIZE));
    assert!(without == with);
}

#[test]
fn the_viewport_glows_as_a_picture_does() {
    let pictured = sphere(4.0);
    let gpu = device();
    let renderer = Arc::new(Renderer::new(&gpu).expect("a renderer"));
    let mut viewport = Viewport::new(&gpu, renderer.clone());
    let shot = shot(&pictured, 0.3, BLACK);
    let missing = viewport.missing(&pictured.scene(), &shot).expect("nothing is made yet");
    renderer.make(&gpu, &missing).expect("pipelines");
    assert_eq!(viewport.missing(&pictured.scene(), &shot), None);
    while viewport
        .show(&gpu, &pictured.scene(), &SceneRevision::default(), &shot, SIZE, false)
        .expect("a sample")
    {}
    let shown = viewport.picture().expect("a picture").read(&gpu).expect("pixels");
    assert!(shown == pictured.pixels(&shot, SIZE));
}
