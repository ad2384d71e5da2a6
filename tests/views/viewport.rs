//! The viewport draws when it has to, and not otherwise.

use std::sync::Arc;

use sabi_engine::Gpu;
use sabi_tests::{Pictured, device, even_light, project};
use sabi_view::{Mode, Renderer, Shot, Viewpoint, Viewport};

use crate::furnace::look;

/// A viewport with a renderer of its own.
fn viewport(gpu: &Gpu) -> Viewport {
    Viewport::new(gpu, Arc::new(Renderer::new(gpu).expect("a renderer")))
}

const SIZE: [u32; 2] = [61, 40];

#[test]
fn a_picture_is_drawn_again_only_when_something_changed() {
    let mesh = project("assets/meshes/cube.glb");
    let pictured = Pictured::looking(&mesh, &look(0.6, 0.3, 0.0), &even_light(0.8));
    let gpu = device();
    let mut viewport = viewport(&gpu);
    let mut shot = Shot::new(pictured.camera(Viewpoint::THREE_QUARTER, SIZE));
    let mut draws = |revision: u64, shot: &Shot, size: [u32; 2], is_moving: bool| {
        let drew = viewport.show(&gpu, &pictured.scene(), revision, shot, size, is_moving);
        let size = viewport.picture().map(|picture| picture.size());
        (drew.expect("a picture"), size)
    };
    assert_eq!(draws(0, &shot, [0, 40], false), (false, None), "a window without area");
    assert_eq!(draws(0, &shot, SIZE, false), (true, Some(SIZE)));
    assert_eq!(draws(0, &shot, SIZE, false), (false, Some(SIZE)));
    assert_eq!(draws(1, &shot, SIZE, false), (true, Some(SIZE)), "another scene");
    shot.camera.turn(10.0);
    assert_eq!(
        draws(1, &shot, SIZE, true),
        (true, Some([31, 20])),
        "half the size while moving"
    );
    shot.camera.turn(10.0);
    assert_eq!(draws(1, &shot, SIZE, true), (true, Some([31, 20])));
    assert_eq!(
        draws(1, &shot, SIZE, false),
        (true, Some(SIZE)),
        "the rest is drawn in full"
    );
    assert_eq!(
        draws(1, &shot, [0, 0], false),
        (false, Some(SIZE)),
        "the last picture stays"
    );
    assert_eq!(draws(1, &shot, SIZE, false), (false, Some(SIZE)));
}

#[test]
fn a_picture_at_rest_is_refined_to_the_one_that_is_drawn_at_once() {
    let mesh = project("assets/meshes/cube.glb");
    let pictured = Pictured::looking(&mesh, &look(0.6, 0.3, 0.0), &even_light(0.8));
    let gpu = device();
    let mut viewport = viewport(&gpu);
    let shot = Shot {
        samples: 5,
        ..Shot::new(pictured.camera(Viewpoint::THREE_QUARTER, SIZE))
    };
    let mut pictures = Vec::new();
    while viewport
        .show(&gpu, &pictured.scene(), 0, &shot, SIZE, false)
        .expect("a sample")
    {
        let picture = viewport.picture().expect("a picture");
        pictures.push(picture.read(&gpu).expect("pixels"));
    }
    assert_eq!(pictures.len(), 5);
    assert!(
        pictures.windows(2).all(|pair| pair[0] != pair[1]),
        "every sample adds something"
    );
    assert_eq!(pictures.last(), Some(&pictured.pixels(&shot, SIZE)));
}

#[test]
fn a_picture_needs_nothing_more_once_what_was_missing_is_made() {
    let mesh = project("assets/meshes/cube.glb");
    let pictured = Pictured::looking(&mesh, &look(0.6, 0.3, 0.0), &even_light(0.8));
    let gpu = device();
    let renderer = Arc::new(Renderer::new(&gpu).expect("a renderer"));
    let mut first = Viewport::new(&gpu, renderer.clone());
    let other = Viewport::new(&gpu, renderer.clone());
    let lit = Shot {
        samples: 3,
        ..Shot::new(pictured.camera(Viewpoint::THREE_QUARTER, SIZE))
    };
    let scene = pictured.scene();
    let missing = first.missing(&scene, &lit).expect("nothing is made yet");
    renderer.make(&gpu, &missing).expect("pipelines");
    assert_eq!(first.missing(&scene, &lit), None);
    assert_eq!(other.missing(&scene, &lit), None, "it is made for all that share it");
    let normals = Shot {
        mode: Mode::Normal,
        ..lit.clone()
    };
    let more = first.missing(&scene, &normals);
    assert!(
        more.is_some() && more != Some(missing),
        "another mode is painted otherwise"
    );
    assert!(first.show(&gpu, &scene, 0, &lit, SIZE, false).expect("a picture"));
    // What nobody made before is made when it is drawn, and it is what was missing.
    while first.show(&gpu, &scene, 1, &normals, SIZE, false).expect("a picture") {}
    assert!(first.show(&gpu, &scene, 1, &normals, SIZE, true).expect("a picture"));
    assert_eq!(first.missing(&scene, &normals), None);
}
