//! Tests: points stay under the pointer, points are framed, and all results are finite.

use proptest::prelude::*;

use super::*;

const BOX: [Vec3; 2] = [Vec3::new(-0.5, -0.2, -0.35), Vec3::new(0.5, 0.2, 0.35)];
/// The corners of the box.
fn corners() -> Vec<Vec3> {
    let side = |corner: u32, axis: usize| BOX[(corner >> axis & 1) as usize][axis];
    (0..8)
        .map(|corner| Vec3::new(side(corner, 0), side(corner, 1), side(corner, 2)))
        .collect()
}

const VIEWPORT: Vec2 = Vec2::new(640.0, 400.0);

fn lenses() -> [Camera; 2] {
    let camera = Camera {
        target: Vec3::new(0.1, -0.05, 0.2),
        yaw_degrees: 31.0,
        pitch_degrees: 22.0,
        distance: 1.7,
        ..Camera::default()
    };
    [Lens::Perspective, Lens::Orthographic].map(|lens| Camera { lens, ..camera })
}

fn project(camera: &Camera, point: Vec3) -> Vec2 {
    camera.project(point, aspect_of(VIEWPORT)).unwrap()
}

/// Returns a point under the pointer, at a distance along its ray.
fn under(camera: &Camera, pointer: Vec2, way: f32) -> Vec3 {
    let ray = camera.ray(pointer, aspect_of(VIEWPORT));
    ray.origin + ray.direction * way
}

fn near(a: Vec2, b: Vec2) -> bool {
    a.abs_diff_eq(b, 1e-4)
}

#[test]
fn each_named_view_looks_along_an_axis_at_the_side_of_its_name() {
    let toward = |name: &str| Camera::seen_from(name.parse().unwrap(), &corners(), 1.0);
    for (name, forward, right) in [
        ("front", Vec3::NEG_Z, Vec3::X),
        ("right", Vec3::NEG_X, Vec3::NEG_Z),
        ("back", Vec3::Z, Vec3::NEG_X),
        ("left", Vec3::X, Vec3::Z),
        ("top", Vec3::NEG_Y, Vec3::X),
        ("bottom", Vec3::Y, Vec3::X),
    ] {
        let camera = toward(name);
        assert!(camera.forward().abs_diff_eq(forward, 1e-6), "{name}");
        assert!(camera.right().abs_diff_eq(right, 1e-6), "{name}");
        let eye = camera.eye() - camera.target;
        assert!(eye.normalize().abs_diff_eq(-forward, 1e-6), "{name}");
    }
    let three_quarter = toward("three-quarter").eye();
    assert!(
        three_quarter.cmpgt(Vec3::ZERO).all(),
        "from the right, from above and from before"
    );
}

#[test]
fn the_point_under_the_pointer_is_on_its_ray() {
    for camera in lenses() {
        for pointer in [Vec2::new(0.5, 0.5), Vec2::new(0.1, 0.8), Vec2::new(1.0, 0.0)] {
            for way in [0.4, 1.5, 9.0] {
                assert!(near(project(&camera, under(&camera, pointer, way)), pointer));
            }
        }
        assert!(near(project(&camera, camera.target), Vec2::splat(0.5)));
        let above = project(&camera, camera.target + Vec3::Y * 0.1);
        assert!(above.y < 0.5, "the pointer grows downward");
    }
}

#[test]
fn a_point_under_the_pointer_stays_there_when_panning() {
    let (from, drag) = (Vec2::new(0.3, 0.6), Vec2::new(70.0, -45.0));
    for mut camera in lenses() {
        let held = under(&camera, from, 1.1);
        camera.pan_holding(held, drag, VIEWPORT);
        assert!(near(project(&camera, held), from + drag / VIEWPORT));
        let target = camera.target;
        camera.pan(drag, VIEWPORT);
        assert!(near(project(&camera, target), Vec2::splat(0.5) + drag / VIEWPORT));
    }
}

#[test]
fn a_point_under_the_pointer_stays_there_when_zooming() {
    let pointer = Vec2::new(0.8, 0.3);
    for camera in lenses() {
        let plane = camera.target.dot(camera.forward());
        let ray = camera.ray(pointer, aspect_of(VIEWPORT));
        let way = (plane - ray.origin.dot(camera.forward())) / ray.direction.dot(camera.forward());
        let point = ray.origin + ray.direction * way;
        let mut nearer = camera;
        nearer.zoom_at(pointer, aspect_of(VIEWPORT), 3.0);
        assert!(near(project(&nearer, point), pointer));
        assert!((nearer.distance - camera.distance / 3.0).abs() < 1e-6);
        let picked = under(&camera, pointer, 0.9);
        let mut nearer = camera;
        nearer.zoom_toward(picked, 0.6);
        assert!(near(project(&nearer, picked), pointer));
        let mut plain = camera;
        plain.zoom(2.0);
        assert_eq!((plain.target, plain.distance), (camera.target, camera.distance / 2.0));
    }
}

#[test]
fn dragging_right_turns_the_near_side_to_the_right_and_pitch_stays_limited() {
    for mut camera in lenses() {
        let near_side = camera.target - camera.forward() * 0.2;
        let before = project(&camera, near_side);
        camera.orbit(Vec2::new(20.0, 0.0), VIEWPORT);
        assert!(project(&camera, near_side).x > before.x);
        let pitch = camera.pitch_degrees;
        camera.orbit(Vec2::new(0.0, 20.0), VIEWPORT);
        assert!(camera.pitch_degrees > pitch, "dragging down shows more from above");
        camera.orbit(Vec2::new(0.0, 1e6), VIEWPORT);
        assert_eq!(camera.pitch_degrees, 90.0);
        assert!(camera.up().is_normalized() && camera.right().y == 0.0);
    }
}

#[test]
fn a_turntable_returns_to_its_start() {
    let mut camera = lenses()[0];
    let begin = camera;
    for _ in 0..8 {
        camera.turn(45.0);
    }
    assert_eq!(camera, begin);
    camera.turn(-3600.0);
    assert_eq!(camera, begin);
}

#[test]
fn framed_points_are_all_in_the_picture_and_fill_it() {
    for lens in [Lens::Perspective, Lens::Orthographic] {
        for aspect in [0.4, 1.0, 2.5] {
            for (name, viewpoint) in Viewpoint::NAMED {
                let mut camera = Camera::seen_from(viewpoint, &corners(), aspect);
                camera.lens = lens;
                camera.frame(&corners(), aspect);
                let places = corners()
                    .into_iter()
                    .map(|corner| camera.project(corner, aspect).unwrap());
                let (low, high) = places.fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(low, high), at| {
                    (low.min(at), high.max(at))
                });
                let shares = if aspect >= 1.0 {
                    Vec2::new(0.84, 0.74)
                } else {
                    Vec2::new(0.74, 0.84)
                };
                let filled = ((high - low) / shares).max_element();
                assert!((filled - 1.0).abs() < 1e-3, "{name} {lens:?} {aspect}: {filled}");
                let middle = (low + high) * 0.5;
                // The side with room is in the middle, at the distance at which it would fill the picture.
                assert!(
                    (middle - 0.5).abs().max_element() < 0.05,
                    "{name} {lens:?} {aspect}: {middle}"
                );
            }
        }
    }
}

#[test]
fn framing_points_in_one_place_keeps_the_distance() {
    let mut camera = lenses()[0];
    camera.frame(&[Vec3::ONE; 3], 1.0);
    assert_eq!((camera.target, camera.distance), (Vec3::ONE, 1.7));
}

#[test]
fn changing_the_lens_keeps_the_size_at_the_target() {
    let [perspective, orthographic] = lenses();
    let beside = perspective.target + perspective.right() * 0.2 + perspective.up() * 0.1;
    assert!(near(project(&perspective, beside), project(&orthographic, beside)));
}

#[test]
fn changing_the_focal_length_keeps_the_size_at_the_target() {
    let mut camera = lenses()[0];
    camera.set_focal_length(70.0);
    assert!((camera.focal_length_mm() - 70.0).abs() < 1e-3);
    let height = camera.height_at_target();
    camera.set_focal_length(24.0);
    assert!((camera.height_at_target() - height).abs() < 1e-4);
    assert!((Camera::default().focal_length_mm() - 70.0).abs() < 0.2);
}

#[test]
fn focus_keeps_the_direction_or_looks_straight_at_a_surface() {
    let mut camera = lenses()[0];
    let (forward, point) = (camera.forward(), Vec3::new(0.3, 0.1, -0.2));
    camera.focus(point, None);
    assert_eq!(
        (camera.target, camera.forward(), camera.distance),
        (point, forward, 1.7)
    );
    let normal = Vec3::new(0.3, -0.5, -0.7).normalize();
    camera.focus(point, Some(normal * 4.0));
    assert!(camera.forward().abs_diff_eq(-normal, 1e-6));
    camera.focus(point, Some(Vec3::Y));
    assert!(camera.forward().abs_diff_eq(Vec3::NEG_Y, 1e-6));
}

#[test]
fn nearer_points_have_greater_depth_and_the_whole_model_is_between_the_planes() {
    for camera in lenses() {
        for distance in [0.9, 1.7, 40.0] {
            let camera = Camera { distance, ..camera };
            let depth = |point: Vec3| camera.clip_from_view(1.5).project_point3(point).z;
            let (front, back) = (
                camera.target - camera.forward() * 0.3,
                camera.target + camera.forward() * 0.8,
            );
            assert!(depth(front) > depth(camera.target) && depth(camera.target) > depth(back));
            for corner in [Vec3::splat(0.5), Vec3::splat(-0.5), Vec3::new(0.5, -0.5, -0.5)] {
                if (corner - camera.eye()).dot(camera.forward()) > 0.01 {
                    assert!((0.0..=1.0).contains(&depth(corner)));
                }
            }
        }
    }
}

fn any_finite() -> impl Strategy<Value = f32> {
    prop_oneof![
        prop::num::f32::NORMAL | prop::num::f32::SUBNORMAL | prop::num::f32::ZERO,
        -10.0..10.0f32,
    ]
}

fn any_place() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(any_finite()).prop_map(Vec3::from)
}

fn any_pair() -> impl Strategy<Value = Vec2> {
    prop::array::uniform2(any_finite()).prop_map(Vec2::from)
}

fn is_sound(camera: &Camera, pointer: Vec2, aspect: f32) -> bool {
    let ray = camera.ray(pointer, aspect);
    let projected = camera.project(ray.origin, aspect);
    camera.clip_from_view(aspect).is_finite()
        && camera.eye_from_view().is_finite()
        && camera.clip_from_eye(aspect).determinant() != 0.0
        && ray.origin.is_finite()
        && ray.direction.is_normalized()
        && projected.is_none_or(Vec2::is_finite)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_input_leads_to_nan(
        target in any_place(),
        angles in any_pair(),
        distance in any_finite(),
        fov_y_degrees in any_finite(),
        is_flat in any::<bool>(),
        pair in any_pair(),
        viewport in any_pair(),
        point in any_place(),
        factor in any_finite(),
    ) {
        let begin = Camera {
            target,
            yaw_degrees: angles.x,
            pitch_degrees: angles.y,
            distance,
            fov_y_degrees,
            lens: if is_flat { Lens::Orthographic } else { Lens::Perspective },
        };
        let aspect = aspect_of(viewport);
        prop_assert!(aspect.is_finite() && aspect > 0.0);
        prop_assert!(is_sound(&begin, pair, factor));
        let does: [&dyn Fn(&mut Camera); 9] = [
            &|camera| camera.orbit(pair, viewport),
            &|camera| camera.pan(pair, viewport),
            &|camera| camera.pan_holding(point, pair, viewport),
            &|camera| camera.zoom(factor),
            &|camera| camera.zoom_at(pair, aspect, factor),
            &|camera| camera.zoom_toward(point, factor),
            &|camera| camera.turn(factor),
            &|camera| camera.focus(point, Some(target)),
            &|camera| camera.frame(&[point, target], aspect),
        ];
        for (number, does) in does.iter().enumerate() {
            let mut camera = begin;
            does(&mut camera);
            prop_assert!(is_sound(&camera, pair, aspect), "{number}: {camera:?}");
        }
    }
}

#[test]
fn viewports_without_area_and_nan_do_no_harm() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0] {
        let begin = lenses()[0];
        let mut camera = begin;
        camera.orbit(Vec2::splat(bad), Vec2::splat(bad));
        camera.pan(Vec2::ONE, Vec2::splat(bad));
        camera.zoom(bad);
        camera.zoom_toward(Vec3::splat(bad), bad);
        assert_eq!(camera, begin, "{bad}");
        camera.zoom_at(Vec2::splat(bad), bad, bad);
        camera.turn(bad);
        camera.focus(Vec3::splat(bad), Some(Vec3::splat(bad)));
        camera.frame(&[Vec3::splat(bad)], bad);
        assert!(is_sound(&camera, Vec2::splat(bad), bad));
        let broken = Camera {
            target: Vec3::splat(bad),
            yaw_degrees: bad,
            pitch_degrees: bad,
            distance: bad,
            fov_y_degrees: bad,
            lens: Lens::Perspective,
        };
        assert!(is_sound(&broken, Vec2::splat(0.5), 1.0));
        assert!(aspect_of(Vec2::new(bad, 3.0)) > 0.0 && aspect_of(Vec2::new(3.0, bad)) > 0.0);
    }
}
