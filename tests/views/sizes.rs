//! Models and pictures of any size.

use sabi_tests::shapes::ball;
use sabi_tests::{DrawableGraph, MeshFile, Quad, device, even_light, project};
use sabi_view::{Lens, RenderTarget, Shot, ViewError, Viewpoint};

use crate::furnace::look;

const SIZE: [u32; 2] = [64, 48];

#[test]
fn a_model_of_any_scale_gives_the_same_picture() {
    let picture = |scale: f32| {
        let scaled = |quad: &Quad| Quad {
            corners: quad.corners.map(|corner| corner.map(|at| at * scale)),
            ..*quad
        };
        let quads: Vec<Quad> = ball(1.0, 6).iter().map(scaled).collect();
        let made = MeshFile::new(quads).write();
        let pictured = DrawableGraph::looking(made.path(), &look(0.6, 0.3, 0.0), &even_light(0.8));
        let shot = Shot::new(pictured.camera(Viewpoint::THREE_QUARTER, SIZE));
        pictured.pixels(&shot, SIZE).rgba
    };
    let expected = picture(1.0);
    for scale in [1e-6, 1e6] {
        let far = picture(scale)
            .iter()
            .zip(&expected)
            .filter(|(a, b)| a.abs_diff(**b) > 1)
            .count();
        // Rounding may move an edge over a pixel's middle.
        assert!(
            far <= SIZE[0] as usize / 8,
            "scale {scale}: {far} of {} codes differ",
            expected.len()
        );
    }
}

#[test]
fn a_picture_without_pixels_or_with_too_many_is_refused_in_a_sentence() {
    let gpu = device();
    for size in [[0, 10], [10, 0], [0, 0], [100_000, 10]] {
        let refused = RenderTarget::new(&gpu, size).err();
        assert!(matches!(refused, Some(ViewError::Size { .. })), "{size:?}: {refused:?}");
    }
    let told = RenderTarget::new(&gpu, [0, 7]).err().map(|error| error.to_string());
    assert_eq!(
        told.as_deref(),
        Some("a picture of 0 × 7 pixels cannot be drawn; each side has 1 to 8192 pixels")
    );
}

#[test]
fn each_frame_may_have_another_size_and_lens() {
    let mesh = project("assets/meshes/cube.glb");
    let pictured = DrawableGraph::looking(&mesh, &look(0.6, 0.3, 0.0), &even_light(0.8));
    for (width, height) in [(1, 1), (1, 200), (200, 1), (33, 17), (64, 64)] {
        for lens in [Lens::Perspective, Lens::Orthographic] {
            let mut camera = pictured.camera(Viewpoint::THREE_QUARTER, [width, height]);
            camera.lens = lens;
            let light = pictured.light(&Shot::new(camera), [width, height]);
            assert_eq!(light.len(), (width * height) as usize);
            assert!(
                light.iter().flatten().all(|value| value.is_finite()),
                "{width} x {height}"
            );
        }
    }
}
