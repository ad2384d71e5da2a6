//! The viewport shows the same values as the export.

use glam::{Vec2, Vec3};
use sabi_export::{BorderRule, ChartBorders};
use sabi_gpu::PlaneData;
use sabi_tests::{DrawableGraph, OnMesh, even_light, project};
use sabi_view::{Mode, PickedPoint, Shot, Viewpoint};

use crate::{is_inside, seen};

const SIZE: [u32; 2] = [160, 120];

/// Dents and a color on a material.
const GRAPH: &str = r##"{ "format": "sabi", "version": 1, "name": "dents", "nodes": {
    "clouds": { "kind": "noise/simplex", "params": { "size": 0.2, "octaves": 3 } },
    "base": { "kind": "source/material", "params": { "color": "#7a4a30", "roughness": 0.4 } },
    "coat": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "clouds" },
        "params": { "color": "#3050a0", "roughness": 0.9, "height": 0.02 } },
    "out": { "kind": "output/material", "inputs": { "material": "coat" } } } }"##;

/// Values of a plane's texels as they are stored.
pub(crate) fn stored(plane: &PlaneData) -> Vec<[f32; 4]> {
    (0..plane.len()).map(|texel| plane.texel(texel)).collect()
}

/// Values of a plane's texels as they are exported: ghosts repeat their chart where the data jumps. The first three numbers of a texel
/// belong together.
fn exported(plane: &PlaneData, on_mesh: &OnMesh) -> Vec<[f32; 4]> {
    let mut texels = stored(plane);
    let borders = ChartBorders::of_atlas(&on_mesh.evaluator.linked().atlas);
    borders.repeat_values(BorderRule::AtJumps, 4, 0..3, texels.as_flattened_mut());
    texels
}

/// Values between the four texels around a picked place, as a texture filter of an engine would read the map.
pub(crate) fn between(texels: &[[f32; 4]], on_mesh: &OnMesh, picked: &PickedPoint) -> [f32; 4] {
    let at = Vec2::from(picked.texel) - 0.5;
    let (corner, weight) = (at.floor(), at - at.floor());
    let [x, y] = [corner.x as u32, corner.y as u32];
    let value = |dx: u32, dy: u32| glam::Vec4::from(texels[on_mesh.index([picked.page, x + dx, y + dy])]);
    let top = value(0, 0).lerp(value(1, 0), weight.x);
    let bottom = value(0, 1).lerp(value(1, 1), weight.x);
    top.lerp(bottom, weight.y).to_array()
}

/// The frame of a normal map at a picked place: tangent, bitangent and normal, interpolated.
fn basis(on_mesh: &OnMesh, picked: &PickedPoint) -> [Vec3; 3] {
    let mesh = &on_mesh.evaluator.linked().model.mesh;
    let corners = mesh.triangles[picked.triangle as usize].map(|vertex| vertex as usize);
    let mixed = |of: &dyn Fn(usize) -> Vec3| -> Vec3 {
        (0..3)
            .map(|corner| of(corners[corner]) * picked.barycentric[corner])
            .sum()
    };
    let normal = mixed(&|vertex| Vec3::from(mesh.normals[vertex]));
    let tangent = mixed(&|vertex| Vec3::from_slice(&mesh.tangents[vertex]));
    let sign = mesh.tangents[corners[0]][3];
    [tangent, normal.cross(tangent) * sign, normal]
}

/// Maps a picture's values from 0..1 to −1..1.
fn signed([x, y, z, _]: [f32; 4]) -> Vec3 {
    Vec3::new(x, y, z) * 2.0 - 1.0
}

#[test]
fn normals_are_those_of_the_exported_map_decoded_in_its_frame() {
    for mesh in ["bench", "figure"] {
        let mesh = project(&format!("assets/meshes/{mesh}.glb"));
        let mut pictured = DrawableGraph::new(GRAPH, &mesh, 256, &even_light(1.0));
        let normals = pictured.on_mesh.evaluate("coat").normals.expect("normals");
        let normals = exported(&normals, &pictured.on_mesh);
        let camera = pictured.camera(Viewpoint::THREE_QUARTER, SIZE);
        let of_mode = |mode| Shot {
            mode,
            ..Shot::new(camera)
        };
        let mapped = pictured.light(&of_mode(Mode::Normal), SIZE);
        let bent = pictured.light(&of_mode(Mode::ModelNormal), SIZE);
        let (mut compared, mut others) = (0, 0);
        for (pixel, picked) in seen(&pictured, &camera, SIZE).filter(|(_, picked)| is_inside(picked)) {
            let [x, y, z, _] = between(&normals, &pictured.on_mesh, &picked);
            let [tangent, bitangent, normal] = basis(&pictured.on_mesh, &picked);
            let expected = (tangent * x + bitangent * y + normal * z).normalize();
            // The tolerance covers the steps of a half float, 1/2048 at 1, and the tiny distance between the picked and
            // the drawn place.
            let apart = (signed(mapped[pixel]) - Vec3::new(x, y, z)).abs().max_element();
            let apart_bent = (signed(bent[pixel]) - expected).abs().max_element();
            others += i32::from(apart.max(apart_bent) >= 4e-3);
            compared += 1;
        }
        // Of triangles that lie on each other, a picture may show the other one.
        assert!(
            1000 * others <= compared,
            "{}: {others} normals of {compared}",
            mesh.display()
        );
        assert!(compared > 500, "only {compared} pixels were compared");
    }
}

#[test]
fn channels_have_the_codes_that_are_exported() {
    let mesh = project("assets/meshes/bench.glb");
    let mut pictured = DrawableGraph::new(GRAPH, &mesh, 256, &even_light(1.0));
    let evaluated = pictured.on_mesh.evaluate("coat");
    let color = stored(&evaluated.planes[0].1);
    let surface = stored(&evaluated.planes[1].1);
    let camera = pictured.camera(Viewpoint::FRONT, SIZE);
    let shot = |mode| Shot {
        mode,
        ..Shot::new(camera)
    };
    let base_color = pictured.pixels(&shot(Mode::BaseColor), SIZE);
    let roughness = pictured.pixels(&shot(Mode::Roughness), SIZE);
    let code = |value: f32| (value.clamp(0.0, 1.0) * 255.0).round() as i32;
    let mut compared = 0;
    for (pixel, picked) in seen(&pictured, &camera, SIZE).filter(|(_, picked)| is_inside(picked)) {
        let linear = between(&color, &pictured.on_mesh, &picked);
        let codes = base_color.rgba[4 * pixel..].iter();
        for (value, shown) in linear.into_iter().zip(codes).take(3) {
            let expected = i32::from(sabi_color::srgb8_from_linear(value));
            let shown = i32::from(*shown);
            assert!(
                (shown - expected).abs() <= 1,
                "color at {pixel}: {shown} and not {expected}"
            );
        }
        let expected = code(between(&surface, &pictured.on_mesh, &picked)[0]);
        let shown = i32::from(roughness.rgba[4 * pixel]);
        assert!(
            (shown - expected).abs() <= 1,
            "roughness at {pixel}: {shown} and not {expected}"
        );
        compared += 1;
    }
    assert!(compared > 500, "only {compared} pixels were compared");
}

#[test]
fn the_same_scene_gives_the_same_bytes() {
    let mesh = project("assets/meshes/bench.glb");
    let pictured = DrawableGraph::new(GRAPH, &mesh, 128, &even_light(1.0));
    let shot = Shot {
        samples: 3,
        ..Shot::new(pictured.camera(Viewpoint::THREE_QUARTER, SIZE))
    };
    assert_eq!(pictured.pixels(&shot, SIZE), pictured.pixels(&shot, SIZE));
}
