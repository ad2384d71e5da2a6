//! A cube and a single triangle, picked from all sides and at all sizes.

use std::path::Path;

use glam::Vec2;
use sabi_surface::atlas::{AtlasOptions, Owner};
use sabi_surface::load::{LoadOptions, load};

use super::*;
use crate::{Camera, Lens, Viewpoint};

struct Stand {
    mesh: Mesh,
    bvh: Bvh,
    atlas: Atlas,
    placement: Placement,
}

impl Stand {
    fn new(mesh: Mesh) -> Stand {
        Stand {
            bvh: Bvh::build(&mesh),
            atlas: Atlas::build(&mesh, &AtlasOptions::new(256)).unwrap(),
            placement: Placement::of(&mesh),
            mesh,
        }
    }

    fn pick(&self, ray: Ray) -> Option<PickedPoint> {
        pick(&self.bvh, &self.mesh, &self.atlas, ray, &self.placement)
    }
}

/// Corners of the cube that models fill.
fn corners() -> Vec<Vec3> {
    let side = |corner: u32, axis: u32| if corner >> axis & 1 == 1 { 0.5 } else { -0.5 };
    (0..8)
        .map(|corner| Vec3::new(side(corner, 0), side(corner, 1), side(corner, 2)))
        .collect()
}

/// Returns the cube of the assets with changed positions.
fn cube(change: impl Fn(f32) -> f32) -> Stand {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/meshes/cube.glb");
    let mut mesh = load(&path, &LoadOptions::default()).unwrap().mesh;
    for value in mesh.positions.as_flattened_mut() {
        *value = change(*value);
    }
    Stand::new(mesh)
}

fn views() -> impl Iterator<Item = (Camera, &'static str)> {
    let views = Viewpoint::NAMED.map(|(name, viewpoint)| {
        let camera = Camera::seen_from(viewpoint, &corners(), 1.0);
        [Lens::Perspective, Lens::Orthographic].map(|lens| (Camera { lens, ..camera }, name))
    });
    views.into_iter().flatten()
}

#[test]
fn each_side_of_a_cube_is_picked_with_its_normal_and_place() {
    let stand = cube(|value| value);
    for (camera, name) in views().filter(|(_, name)| *name != "three-quarter") {
        let picked = stand.pick(camera.ray(Vec2::new(0.4, 0.3), 1.0)).unwrap();
        assert!(picked.face_normal.abs_diff_eq(-camera.forward(), 1e-6), "{name}");
        assert!(
            picked.normal.is_normalized() && picked.normal.dot(picked.face_normal) > 0.5,
            "{name}"
        );
        assert!(!picked.is_back_face);
        let pointer = camera.project(picked.position_view, 1.0).unwrap();
        assert!(pointer.abs_diff_eq(Vec2::new(0.4, 0.3), 1e-5), "{name}");
        let way = (picked.position_view - camera.ray(Vec2::new(0.4, 0.3), 1.0).origin).length();
        assert!((way - picked.distance).abs() < 1e-5);
    }
}

#[test]
fn texture_coordinates_and_texels_are_those_of_the_point_picked() {
    let stand = cube(|value| value);
    for (camera, name) in views() {
        for pointer in [Vec2::new(0.5, 0.5), Vec2::new(0.31, 0.62), Vec2::new(0.66, 0.35)] {
            let picked = stand.pick(camera.ray(pointer, 1.0)).unwrap();
            let corners = stand.mesh.triangles[picked.triangle as usize];
            let place = |of: &dyn Fn(usize) -> Vec3| {
                (0..3).fold(Vec3::ZERO, |sum, corner| {
                    sum + of(corners[corner] as usize) * picked.barycentric[corner]
                })
            };
            let position = place(&|vertex| stand.mesh.positions[vertex].into());
            assert!(position.abs_diff_eq(picked.position, 1e-6), "{name}");
            let uv = place(&|vertex| Vec2::from(stand.mesh.uvs[vertex]).extend(0.0));
            assert!(uv.truncate().abs_diff_eq(picked.uv.into(), 1e-6));
            let chart = &stand.atlas.charts[picked.chart as usize];
            let texel = uv.truncate() * 256.0 + Vec2::from(chart.texel_from_uv.map(|offset| offset as f32));
            assert!(texel.abs_diff_eq(picked.texel.into(), 1e-3));
            let [x, y] = picked.texel.map(|at| at as u32);
            let owner = stand.atlas.owner(x, y, picked.page);
            let Owner::Triangle(triangle) = owner else {
                panic!("{name}: {owner:?}")
            };
            assert_eq!(stand.atlas.triangle_chart[triangle as usize], picked.chart);
            assert!(Vec2::from(picked.map_texel).abs_diff_eq(uv.truncate() * 256.0, 1e-3));
        }
    }
}

#[test]
fn the_same_point_is_picked_at_any_size_and_far_from_the_origin() {
    let plain = cube(|value| value);
    let changed = [
        cube(|value| value * 1e-6),
        cube(|value| value * 1e6),
        cube(|value| value * 1024.0 + 1e6),
    ];
    for (camera, name) in views() {
        for pointer in [Vec2::new(0.5, 0.47), Vec2::new(0.31, 0.62)] {
            for camera in [
                camera,
                Camera {
                    distance: 90.0,
                    ..camera
                },
            ] {
                let pointer = (pointer - 0.5) * 3.0 / camera.distance + 0.5;
                let expected = plain.pick(camera.ray(pointer, 1.0)).unwrap();
                for (number, stand) in changed.iter().enumerate() {
                    let picked = stand.pick(camera.ray(pointer, 1.0)).unwrap();
                    let apart = Vec2::from(picked.uv).distance(expected.uv.into());
                    // At 1e6 the corners themselves are rounded to multiples of 1/16.
                    assert!(
                        apart < if number == 2 { 1e-4 } else { 1e-6 },
                        "{name} {number}: {apart}"
                    );
                    assert!(picked.normal.abs_diff_eq(expected.normal, 1e-3));
                }
            }
        }
    }
}

fn single() -> Stand {
    Stand::new(Mesh {
        positions: vec![[0.0; 3], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 3],
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; 3],
        uvs: vec![[2.0, 1.0], [3.0, 1.0], [2.0, 0.0]],
        triangles: vec![[0, 1, 2]],
        triangle_material: vec![4],
        triangle_part: vec![2],
        ..Mesh::default()
    })
}

#[test]
fn the_back_of_a_surface_is_picked_like_its_front() {
    let stand = single();
    let toward = |z: f32| Ray {
        origin: Vec3::new(-0.25, -0.25, z),
        direction: Vec3::new(0.0, 0.0, -z),
    };
    let [front, back] = [2.0, -2.0].map(|z| stand.pick(toward(z)).unwrap());
    assert_eq!((front.is_back_face, back.is_back_face), (false, true));
    assert_eq!((front.uv, front.normal), (back.uv, back.normal));
    assert_eq!(front.face_normal, Vec3::Z);
    assert_eq!((front.material, front.part), (4, 2));
    assert_eq!(front.position, Vec3::new(0.5, 0.5, 0.0));
    assert_eq!(front.uv, [2.25, 0.75]);
    assert_eq!(front.map_texel, [64.0, 192.0], "of a map that repeats");
}

#[test]
fn rays_that_miss_or_are_invalid_pick_nothing() {
    let stand = single();
    let ray = |origin, direction| stand.pick(Ray { origin, direction });
    assert_eq!(ray(Vec3::new(0.4, 0.4, 2.0), Vec3::NEG_Z), None);
    assert_eq!(ray(Vec3::Z, Vec3::ZERO), None);
    assert_eq!(ray(Vec3::Z, Vec3::NAN), None);
    assert_eq!(ray(Vec3::NAN, Vec3::NEG_Z), None);
    assert_eq!(ray(Vec3::INFINITY, Vec3::NEG_Z), None);
    let grazing = ray(Vec3::new(-2.0, -0.25, 0.0), Vec3::X);
    assert!(grazing.is_none_or(|picked| picked.barycentric.iter().all(|share| share.is_finite())));
}
