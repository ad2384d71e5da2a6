//! Whole bakes: the values that a renderer reads on both sides of the seams of a map, with and without seam erasure.

use glam::{DVec2, DVec3};
use sabi_engine::baking::Seams;
use sabi_image::{Pixels, decode};
use sabi_tests::{BakeOutput, OnMesh, Seam, project};

const SIZE: u32 = 512;

/// A relief whose waves are a few texels long, where two grids of texels agree the least.
const RELIEF: &str = r#"{ "format": "sabi", "version": 1, "nodes": {
    "noise": { "kind": "noise/simplex", "params": { "size": 0.03, "octaves": 2 } },
    "layer": { "kind": "effect/layer", "inputs": { "height_map": "noise" }, "params": { "height": 0.005 } },
    "out": { "kind": "output/material", "inputs": { "material": "layer" } } } }"#;

/// A map as a file has it, between its texels.
struct InterpolatedMap {
    components: usize,
    values: Vec<f64>,
}

impl InterpolatedMap {
    fn new(name: &str, file: &[u8]) -> InterpolatedMap {
        let picture = decode(name, file).expect("a map");
        let values: Vec<f64> = match picture.pixels {
            Pixels::U16(codes) => codes.into_iter().map(|code| f64::from(code) / 32767.5 - 1.0).collect(),
            Pixels::F32(values) => values.into_iter().map(f64::from).collect(),
            Pixels::U8(_) => panic!("heights and normals have more bits"),
        };
        InterpolatedMap {
            components: values.len() / (SIZE * SIZE) as usize,
            values,
        }
    }

    /// Reads the map as a renderer does: bilinear, repeating.
    fn read(&self, uv: DVec2) -> Vec<f64> {
        let place = uv * f64::from(SIZE) - 0.5;
        let (corner, share) = (place.floor(), place - place.floor());
        let mut read = vec![0.0; self.components];
        for (step, weight) in [
            (DVec2::new(0.0, 0.0), (1.0 - share.x) * (1.0 - share.y)),
            (DVec2::new(1.0, 0.0), share.x * (1.0 - share.y)),
            (DVec2::new(0.0, 1.0), (1.0 - share.x) * share.y),
            (DVec2::new(1.0, 1.0), share.x * share.y),
        ] {
            let [x, y] = (corner + step)
                .to_array()
                .map(|at| (at as i64).rem_euclid(i64::from(SIZE)));
            let first = (y * i64::from(SIZE) + x) as usize * self.components;
            for (read, value) in read.iter_mut().zip(&self.values[first..]) {
                *read += weight * value;
            }
        }
        read
    }
}

/// Returns the root mean square of a comparison of both sides of the seams, in a map without erasure and in one with erasure.
fn compared(mesh: &str, name: &str, difference: impl Fn(&OnMesh, &InterpolatedMap, &Seam, f64) -> f64) -> [f64; 2] {
    let path = project(&format!("assets/meshes/{mesh}.glb"));
    let on_mesh = OnMesh::new(RELIEF, &path, SIZE);
    [Seams::Keep, Seams::Erase].map(|seams| {
        let map = InterpolatedMap::new(name, &BakeOutput::with_seams(RELIEF, &path, SIZE, seams).map(name));
        let (mut sum, mut count) = (0.0, 0.0);
        for seam in on_mesh.seams() {
            for sample in 0..48 {
                let along = (f64::from(sample) + 0.5) / 48.0;
                sum += difference(&on_mesh, &map, &seam, along).powi(2);
                count += 1.0;
            }
        }
        f64::sqrt(sum / count)
    })
}

/// Position on the map of a point of a seam, according to one of its two sides.
fn uv(on_mesh: &OnMesh, seam: &Seam, side: usize, along: f64) -> DVec2 {
    let mesh = &on_mesh.evaluator.linked().model.mesh;
    let corners = mesh.triangles[seam.triangles[side] as usize];
    let weights = seam.weights(side, along).into_iter();
    let uvs = corners.map(|vertex| DVec2::from(mesh.uvs[vertex as usize].map(f64::from)));
    weights.zip(uvs).map(|(weight, uv)| uv * weight).sum()
}

fn height_step(on_mesh: &OnMesh, map: &InterpolatedMap, seam: &Seam, along: f64) -> f64 {
    let [one, other] = [0, 1].map(|side| map.read(uv(on_mesh, seam, side, along))[0]);
    one - other
}

/// Returns the angle between the normals of both sides in radians.
fn turn(on_mesh: &OnMesh, map: &InterpolatedMap, seam: &Seam, along: f64) -> f64 {
    let [one, other] = [0, 1].map(|side| {
        let (triangle, weights) = (seam.triangles[side], seam.weights(side, along));
        let (_, at) = on_mesh.on_page(triangle, weights);
        let frame = on_mesh.frame_at(triangle, at);
        let read = map.read(uv(on_mesh, seam, side, along));
        frame.iter().zip(read).map(|(axis, value)| *axis * value).sum::<DVec3>()
    });
    one.angle_between(other)
}

#[test]
fn heights_agree_on_both_sides_of_a_seam() {
    for mesh in ["sphere", "cube", "figure"] {
        let [kept, erased] = compared(mesh, "height.exr", height_step);
        assert!(erased < 0.4 * kept, "{mesh}: {erased} of {kept}");
    }
}

#[test]
fn normals_agree_on_both_sides_of_a_smooth_seam() {
    for mesh in ["sphere", "figure"] {
        let [kept, erased] = compared(mesh, "normal.png", turn);
        assert!(erased < 0.3 * kept, "{mesh}: {erased} of {kept}");
    }
}
