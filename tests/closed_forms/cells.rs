//! `noise/cells` and `noise/cracks`, compared with a search of all points of the surrounding 7 × 7 × 7 cells on the processor.

use glam::{DMat3, DVec3, IVec3, UVec3, Vec3, dvec2, dvec3, ivec3};
use sabi_tests::{OnMesh, project};

/// The hash of `lib/hash.wgsl`, implemented again: Jarzynski and Olano, "Hash Functions for GPU Rendering" (2020).
fn pcg3d(key: [u32; 3]) -> [u32; 3] {
    let [mut x, mut y, mut z] = key.map(|part| part.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    for round in 0..2 {
        if round == 1 {
            [x, y, z] = [x, y, z].map(|part| part ^ (part >> 16));
        }
        x = x.wrapping_add(y.wrapping_mul(z));
        y = y.wrapping_add(z.wrapping_mul(x));
        z = z.wrapping_add(x.wrapping_mul(y));
    }
    [x, y, z]
}

#[test]
fn the_hash_never_changes() {
    // Computed independently of this code, with integers of arbitrary size.
    assert_eq!(pcg3d([0, 0, 0]), HASH_OF_ZERO);
    assert_eq!(pcg3d([1, 2, 3]), HASH_OF_ONE_TWO_THREE);
}

const HASH_OF_ZERO: [u32; 3] = [2_611_992_518, 2_833_812_075, 1_058_359_340];
const HASH_OF_ONE_TWO_THREE: [u32; 3] = [4_204_755_366, 1_223_881_804, 1_500_469_937];

/// Computes the effective seed of a node in a document of seed 0.
fn effective_seed(own: u32) -> u32 {
    sabi_plan::pcg(sabi_plan::pcg(0) ^ own)
}

/// The point of a cell, in cells from the cell's corner, and its random number.
fn point(cell: IVec3, seed: u32, jitter: f32) -> (Vec3, u32) {
    let key = [
        seed,
        seed.wrapping_mul(747_796_405).wrapping_add(2_891_336_453),
        seed.wrapping_mul(277_803_737).wrapping_add(1_831_565_813),
    ];
    let folded: UVec3 = cell.as_uvec3() & UVec3::splat(65_535);
    let parts = folded.to_array();
    let random = pcg3d([0, 1, 2].map(|axis| parts[axis].wrapping_add(key[axis])));
    (
        Vec3::splat(0.5) + jitter * (Vec3::from(random.map(unit)) - 0.5),
        random[0],
    )
}

/// Placement of the cells, with their stretch and rotation.
struct Pattern {
    size: f64,
    own_seed: u32,
    jitter: f32,
    stretch: DVec3,
    /// Degrees.
    rotate: DVec3,
}

impl Pattern {
    fn params(&self) -> String {
        let list = |v: DVec3| format!("[{}, {}, {}]", v.x, v.y, v.z);
        format!(
            r#""size": {}, "seed": {}, "jitter": {}, "stretch": {}, "rotate": {}"#,
            self.size,
            self.own_seed,
            self.jitter,
            list(self.stretch),
            list(self.rotate)
        )
    }

    /// Turns the pattern about x, then y, then z.
    fn turn(&self) -> DMat3 {
        let [x, y, z] = self.rotate.to_array().map(f64::to_radians);
        DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x)
    }

    fn place(&self, position: DVec3) -> DVec3 {
        self.turn().transpose() * position / self.stretch / self.size + DVec3::new(0.2713, 0.3137, 0.2299)
    }

    /// Returns all surrounding points relative to the position, with their random numbers, the nearest first.
    fn around(&self, position: DVec3) -> Vec<(DVec3, u32)> {
        let place = self.place(position);
        let cell = place.floor().as_ivec3();
        let mut points: Vec<(DVec3, u32)> = (0..343)
            .map(|at| {
                let step = ivec3(at % 7 - 3, at / 7 % 7 - 3, at / 49 - 3);
                let (point, id) = point(cell + step, effective_seed(self.own_seed), self.jitter);
                (point.as_dvec3() + (cell + step).as_dvec3() - place, id)
            })
            .collect();
        let lengths: Vec<f64> = points.iter().map(|(offset, _)| offset.length_squared()).collect();
        let nearest = (0..343).min_by(|a, b| lengths[*a].total_cmp(&lengths[*b]));
        points.swap(0, nearest.unwrap_or(0));
        points
    }

    /// Returns the distances along the plane of `normal` to the planes halfway between the nearest point and each other point of the 27
    /// surrounding cells, and the vectors there. Planes that are almost parallel to it are not walls of cracks.
    fn walls(&self, position: DVec3, points: &[(DVec3, u32)], normal: DVec3) -> Vec<(f64, DVec3)> {
        let (place, own) = (self.place(position), points[0].0);
        let turn = self.turn();
        // The plane's normal in the pattern's own space.
        let up = (turn.transpose() * normal * self.stretch).normalize();
        let away = |(other, _): &(DVec3, u32)| {
            let across = (*other - own).normalize();
            // The wall's normal in the model, and how steeply the distance grows along the plane.
            let slope = turn * (across / self.stretch) / self.size;
            let along = slope - normal * slope.dot(normal);
            let distance = (0.5 * (own + *other)).dot(across) / along.length();
            let is_around = ((place + *other).floor() - place.floor()).abs().max_element() < 1.5;
            (is_around && 1.0 - across.dot(up).powi(2) > 0.06).then(|| (distance, along.normalize()))
        };
        points[1..].iter().filter_map(away).collect()
    }
}

fn unit(bits: u32) -> f32 {
    (bits >> 8) as f32 / 16_777_216.0
}

fn patterns() -> [Pattern; 4] {
    let pattern = |jitter: f32, own_seed: u32, size: f64, stretch: DVec3, rotate: DVec3| Pattern {
        size,
        own_seed,
        jitter,
        stretch,
        rotate,
    };
    [
        pattern(1.0, 0, 0.12, DVec3::ONE, DVec3::ZERO),
        pattern(0.6, 7, 0.15, DVec3::ONE, DVec3::ZERO),
        pattern(0.0, 3, 0.2, DVec3::ONE, DVec3::ZERO),
        pattern(1.0, 5, 0.1, dvec3(1.0, 2.0, 3.0), dvec3(20.0, -35.0, 50.0)),
    ]
}

/// Number of places that are examined for each pattern.
const PLACES: usize = 100_000;
/// Size at which the cube owns more texels than that.
const SIZE: u32 = 512;

fn on_cube(kind: &str, params: &str) -> OnMesh {
    let graph = format!(
        r#"{{ "format": "sabi", "version": 1, "nodes": {{ "noise": {{ "kind": "noise/{kind}", "params": {{ {params} }} }} }} }}"#
    );
    OnMesh::new(&graph, &project("assets/meshes/cube.glb"), SIZE)
}

/// Returns the texels to examine, and their triangles.
fn places(on_mesh: &OnMesh) -> Vec<(usize, u32)> {
    let owned: Vec<(usize, u32)> = on_mesh.owned().collect();
    assert!(owned.len() >= PLACES, "{} texels", owned.len());
    let step = owned.len() / PLACES;
    owned.into_iter().step_by(step).take(PLACES).collect()
}

#[test]
fn cells_find_the_nearest_point_of_all() {
    for pattern in patterns() {
        let mut on_mesh = on_cube("cells", &pattern.params());
        let distances = on_mesh.evaluate("noise").component("mask");
        let ids = on_mesh.evaluate("noise.id").component("mask");
        let jitter = pattern.jitter;
        let longest = 0.866_025_4 + (1.0 - 0.866_025_4) * f64::from(jitter);
        let mut other_ids = 0;
        for (index, _) in places(&on_mesh) {
            let position = on_mesh.position(index).expect("an owned texel");
            let (offset, id) = pattern.around(position)[0];
            let expected = (offset.length() / longest).min(1.0);
            let got = f64::from(distances[index]);
            assert!(
                (expected - got).abs() < 2e-5,
                "jitter {jitter} at {position}: {got}, not {expected}"
            );
            other_ids += usize::from((unit(id) - ids[index]).abs() > 1e-6);
        }
        // If two points are equally far, rounding decides which one is nearer.
        let allowed = if jitter > 0.0 { PLACES / 1000 } else { PLACES / 50 };
        assert!(other_ids <= allowed, "jitter {jitter}: {other_ids} other cells");
    }
}

/// Returns the share of a crack in a square texel whose sides have these widths across it, by summing 32 × 32 parts.
fn seen(distance: f64, [inner, outer]: [f64; 2], sides: [f64; 2]) -> f64 {
    let middle = |at: u32| (f64::from(at) + 0.5) / 32.0 - 0.5;
    let part = |at: u32| {
        let away = (distance + sides[0] * middle(at % 32) + sides[1] * middle(at / 32)).abs();
        ((outer - away) / (outer - inner)).clamp(0.0, 1.0)
    };
    (0..1024).map(part).sum::<f64>() / 1024.0
}

#[test]
fn cracks_are_where_the_walls_between_the_pieces_are() {
    // So wide and soft that the mask gives the distance wherever there is a wall.
    const FADE: f64 = 100.0;
    for pattern in patterns() {
        let width = 0.4 * pattern.size;
        let straight = r#""levels": 1, "bend": 0, "breaks": 0, "uneven": 0"#;
        let params = format!(r#"{}, {straight}, "width": {width}, "fade": {FADE}"#, pattern.params());
        let mut on_mesh = on_cube("cracks", &params);
        let cracks = on_mesh.evaluate("noise").component("mask");
        let ids = on_mesh.evaluate("noise.id").component("mask");
        let borders = [width / (1.0 + FADE), width * FADE / (1.0 + FADE)];
        let mut other_ids = 0;
        for (index, triangle) in places(&on_mesh) {
            let position = on_mesh.position(index).expect("an owned texel");
            let [_, x, y] = on_mesh.texel(index);
            let at = dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let [tangent, bitangent, normal] = on_mesh.frame_at(triangle, at).map(DVec3::normalize);
            let texel = f64::from(on_mesh.tables.geometry[6 * triangle as usize + 2][3].abs());
            let points = pattern.around(position);
            let left = |(distance, way): (f64, DVec3)| {
                let sides = [tangent, bitangent].map(|side| texel * side.dot(way));
                1.0 - seen(distance, borders, sides)
            };
            let walls = pattern.walls(position, &points, normal).into_iter();
            // Cracks overlap as if each lay at random.
            let near = walls.filter(|wall| wall.0 < borders[1] + texel);
            let expected = 1.0 - near.map(left).product::<f64>();
            let got = f64::from(cracks[index]);
            // In the middle and at the ends, where the profile has a kink, the node takes the mean of two windows for that
            // over the texel.
            assert!(
                (expected - got).abs() < 3e-3,
                "size {} at {position}: {got}, not {expected}",
                pattern.size
            );
            let id = pcg3d([effective_seed(pattern.own_seed), points[0].1, 0x5eed_0007])[0];
            other_ids += usize::from((unit(id) - ids[index]).abs() > 1e-6);
        }
        let allowed = if pattern.jitter > 0.0 {
            PLACES / 1000
        } else {
            PLACES / 50
        };
        assert!(other_ids <= allowed, "size {}: {other_ids} other pieces", pattern.size);
    }
}
