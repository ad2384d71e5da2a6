//! The viewport draws when it has to, and not otherwise.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::Vec3;
use sabi_gpu::{AdapterKind, Gpu};
use sabi_tests::{DrawableGraph, device, even_light, project};
use sabi_view::{Mode, Quality, Renderer, SceneRevision, Shot, Viewpoint, Viewport};

use crate::furnace::look;
use crate::seen;

/// A viewport with a renderer of its own, and with the quality that suits a software driver, on any adapter.
fn viewport(gpu: &Gpu) -> Viewport {
    let mut viewport = Viewport::new(gpu, Arc::new(Renderer::new(gpu).expect("a renderer")));
    viewport.quality = Quality::of(AdapterKind::Cpu);
    viewport
}

const SIZE: [u32; 2] = [61, 40];

/// A revision of a scene that does not say which parts have changed.
fn numbered(number: u64) -> SceneRevision {
    SceneRevision {
        number,
        ..SceneRevision::default()
    }
}

#[test]
fn a_picture_is_drawn_again_only_when_something_changed() {
    let mesh = project("assets/meshes/cube.glb");
    let pictured = DrawableGraph::looking(&mesh, &look(0.6, 0.3, 0.0), &even_light(0.8));
    let gpu = device();
    let mut viewport = viewport(&gpu);
    let mut shot = Shot::new(pictured.camera(Viewpoint::THREE_QUARTER, SIZE));
    let mut draws = |revision: u64, shot: &Shot, size: [u32; 2], is_moving: bool| {
        let drew = viewport.show(&gpu, &pictured.scene(), &numbered(revision), shot, size, is_moving);
        let size = viewport.picture().map(|picture| picture.size());
        (drew.expect("a picture"), size)
    };
    assert_eq!(draws(0, &shot, [0, 40], false), (false, None), "a window without area");
    assert_eq!(draws(0, &shot, SIZE, false), (true, Some(SIZE)));
    assert_eq!(draws(0, &shot, SIZE, false), (false, Some(SIZE)));
    assert_eq!(draws(1, &shot, SIZE, false), (true, Some(SIZE)), "another scene");
    assert_eq!(
        draws(1, &shot, SIZE, true),
        (false, Some(SIZE)),
        "a drag begins, and nothing has changed yet"
    );
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
    let pictured = DrawableGraph::looking(&mesh, &look(0.6, 0.3, 0.0), &even_light(0.8));
    let gpu = device();
    let mut viewport = viewport(&gpu);
    let shot = Shot {
        samples: 5,
        ..Shot::new(pictured.camera(Viewpoint::THREE_QUARTER, SIZE))
    };
    let mut pictures = Vec::new();
    while viewport
        .show(&gpu, &pictured.scene(), &numbered(0), &shot, SIZE, false)
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
fn a_picture_needs_no_more_pipelines_once_the_missing_ones_are_made() {
    let mesh = project("assets/meshes/cube.glb");
    let pictured = DrawableGraph::looking(&mesh, &look(0.6, 0.3, 0.0), &even_light(0.8));
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
    assert!(
        first
            .show(&gpu, &scene, &numbered(0), &lit, SIZE, false)
            .expect("a picture")
    );
    // Drawing pictures makes the pipelines that are still missing.
    while first
        .show(&gpu, &scene, &numbered(1), &normals, SIZE, false)
        .expect("a picture")
    {}
    assert!(
        first
            .show(&gpu, &scene, &numbered(2), &normals, SIZE, true)
            .expect("a picture")
    );
    let part = SceneRevision {
        number: 3,
        changed: vec![(2, vec![[Vec3::splat(-0.1), Vec3::splat(0.1)]])],
    };
    assert!(first.show(&gpu, &scene, &part, &normals, SIZE, true).expect("a part"));
    assert_eq!(first.missing(&scene, &normals), None);
}

#[test]
fn only_the_changed_part_of_a_scene_is_drawn_again_if_it_is_known() {
    let mesh = project("assets/meshes/cube.glb");
    let before = DrawableGraph::looking(&mesh, &look(0.6, 0.3, 0.0), &even_light(0.8));
    let after = DrawableGraph::looking(&mesh, &look(0.1, 0.3, 0.0), &even_light(0.8));
    let gpu = device();
    let shot = Shot {
        bloom: 0.0,
        ..Shot::new(before.camera(Viewpoint::FRONT, SIZE))
    };
    let mut viewport = viewport(&gpu);
    let still = Shot {
        samples: 4,
        ..shot.clone()
    };
    while viewport
        .show(&gpu, &before.scene(), &numbered(0), &still, SIZE, false)
        .expect("a sample")
    {}
    let old = viewport.picture().expect("a picture").read(&gpu).expect("pixels");
    // The upper right quarter of the view.
    let bounds = [Vec3::new(0.0, 0.0, -0.5), Vec3::splat(0.5)];
    let revision = SceneRevision {
        number: 1,
        changed: vec![(0, vec![bounds])],
    };
    assert!(
        viewport
            .show(&gpu, &after.scene(), &revision, &still, SIZE, true)
            .expect("a picture")
    );
    let new = viewport.picture().expect("a picture").read(&gpu).expect("pixels");
    assert_eq!(new.size, SIZE, "not coarser");
    let whole = after.pixels(&shot, SIZE);
    let [left, top, right, bottom] = shot.camera.part_of_picture(bounds, SIZE).expect("before the eye");
    assert!(
        left > 20 && right < 60 && top < 15 && bottom < 25,
        "{left} {top} {right} {bottom}"
    );
    let shown: BTreeSet<usize> = seen(&after, &shot.camera, SIZE).map(|(pixel, _)| pixel).collect();
    for (at, pixel) in new.rgba.chunks_exact(4).enumerate() {
        let (x, y) = (at as u32 % SIZE[0], at as u32 / SIZE[0]);
        let is_part = (left..right).contains(&x) && (top..bottom).contains(&y);
        let expected = if is_part && shown.contains(&at) { &whole } else { &old };
        assert_eq!(pixel, &expected.rgba[4 * at..4 * at + 4], "at {x}, {y}");
    }
    assert!(
        !viewport
            .show(&gpu, &after.scene(), &revision, &still, SIZE, true)
            .expect("nothing")
    );
    // A scene is drawn as a whole if it is not known what has changed in it.
    assert!(
        viewport
            .show(&gpu, &before.scene(), &numbered(2), &still, SIZE, true)
            .expect("a picture")
    );
    assert_eq!(viewport.picture().expect("a picture").size(), [31, 20]);
}
