//! Places that balls, sunlight and other pieces reach, compared with closed forms.

use glam::DVec3;
use sabi_tests::OnMesh;

use crate::mean_difference::MeanDifference;
use crate::rays::{faces, graph};

const RAYS: u32 = 64;

fn values(on_mesh: &mut OnMesh, kind: &str, params: &str, port: &str) -> Vec<f32> {
    on_mesh.set_graph(&graph(kind, &format!(r#""rays": {RAYS}, {params}"#)));
    on_mesh.evaluate(port).component("mask")
}

/// A narrow floor along +x from x = 0 on.
const FLOOR: [[f32; 3]; 4] = [[0.0, 0.0, 0.5], [0.2, 0.0, 0.5], [0.2, 0.0, -0.5], [0.0, 0.0, -0.5]];

fn is_floor(at: DVec3) -> bool {
    at.y == 0.0 && at.x > 0.004
}

/// A face from the floor's edge up, `height` long along its own slope.
fn rising(degrees: f64, height: f64) -> [[f32; 3]; 4] {
    let [x, y] = [degrees.to_radians().cos(), degrees.to_radians().sin()].map(|share| (share * height) as f32);
    [[0.0, 0.0, 100.0], [0.0, 0.0, -100.0], [x, y, -100.0], [x, y, 100.0]]
}

#[test]
fn a_ball_in_a_groove_is_touched_by_as_much_as_lies_on_this_side_of_the_other_wall() {
    // Chords whose directions are weighted by the cosine end evenly all over the ball, and a plane cuts off a cap of it whose
    // area is its share of the diameter.
    for degrees in [60.0, 90.0, 120.0_f64] {
        let mut on_mesh = faces(&[FLOOR, rising(degrees, 20.0)]);
        let (sine, cosine) = degrees.to_radians().sin_cos();
        for diameter in [0.06, 0.2] {
            let values = values(&mut on_mesh, "touch", &format!(r#""diameter": {diameter}"#), "rays");
            // Chords are a hundredth shorter, so that a ball that just fits does.
            let radius = 0.5 * 0.99 * diameter;
            let share = |at: DVec3| {
                let to_wall = at.x * sine - radius * cosine;
                (0.5 + 0.5 * to_wall / radius).clamp(0.0, 1.0)
            };
            let expected = |at| is_floor(at).then(|| share(at));
            let held = MeanDifference::new(&on_mesh, &values, RAYS, expected, |share| share * (1.0 - share));
            held.assert(1e-3, &format!("a ball of {diameter} in a groove of {degrees}°"));
        }
    }
}

#[test]
fn the_sky_lights_a_tilted_plane_by_its_share_and_the_sun_by_the_cosine() {
    for degrees in [0.0, 30.0, 60.0, 90.0_f64] {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let (rise, run) = (sine as f32, cosine as f32);
        let tilted = [[0.0, 0.0, 0.5], [run, rise, 0.5], [run, rise, -0.5], [0.0, 0.0, -0.5]];
        let mut on_mesh = faces(&[tilted]);
        let normal = DVec3::new(-sine, cosine, 0.0);
        for spread in [0.0, 20.0_f64] {
            let sun = DVec3::new(-0.5, 0.8, 0.2).normalize();
            // The mean height of a cap, as long as all of it is above the plane and the horizon.
            let of_sun = normal.dot(sun) * 0.5 * (1.0 + spread.to_radians().cos());
            let of_sky = 0.25 * (1.0 + cosine);
            for sky in [0.0, 0.25, 1.0] {
                let params = format!(r#""toward": [-0.5, 0.8, 0.2], "spread": {spread}, "sky": {sky}, "distance": 5"#);
                let values = values(&mut on_mesh, "sunlight", &params, "rays");
                let expected = (1.0 - sky) * of_sun + sky * of_sky;
                let held = MeanDifference::new(&on_mesh, &values, RAYS, |_| Some(expected), |_| 0.1);
                held.assert(1e-3, &format!("{degrees}°, spread {spread}, sky {sky}"));
            }
        }
    }
}

#[test]
fn a_wall_takes_the_sky_behind_it_and_a_sun_below_its_top() {
    let height = 0.1;
    let mut on_mesh = faces(&[FLOOR, rising(90.0, height)]);
    let open = |at: DVec3| 0.5 * (1.0 - 0.5 * (1.0 - at.x / at.x.hypot(height)));
    let sky = values(&mut on_mesh, "sunlight", r#""sky": 1, "distance": 200"#, "rays");
    let held = MeanDifference::new(&on_mesh, &sky, RAYS, |at| is_floor(at).then(|| open(at)), |_| 0.1);
    held.assert(1e-3, "the sky beside a wall");
    // A sun in the direction of the wall, half as steep again as one that would shine over its top at 0.1.
    let params = r#""toward": [-1, 1, 0], "spread": 0, "sky": 0, "distance": 200"#;
    let sun = values(&mut on_mesh, "sunlight", params, "rays");
    let lit = |at: DVec3| {
        let is_known = is_floor(at) && (at.x - height).abs() > 2e-3;
        is_known.then_some(if at.x > height { 0.5_f64.sqrt() } else { 0.0 })
    };
    MeanDifference::new(&on_mesh, &sun, RAYS, lit, |_| 0.0).assert(1e-4, "the sun over a wall");
}

/// Two plates that face each other; the lower one is small.
fn plates(gap: f32) -> OnMesh {
    let lower = [[-0.1, 0.0, 0.1], [0.1, 0.0, 0.1], [0.1, 0.0, -0.1], [-0.1, 0.0, -0.1]];
    let upper = [
        [-50.0, gap, -50.0],
        [50.0, gap, -50.0],
        [50.0, gap, 50.0],
        [-50.0, gap, 50.0],
    ];
    faces(&[lower, upper])
}

#[test]
fn a_plate_close_by_is_in_contact_by_its_distance() {
    for gap in [0.01, 0.025, 0.04] {
        let mut on_mesh = plates(gap as f32);
        let k: f64 = gap / 0.05;
        let is_lower = |at: DVec3| at.y == 0.0;
        // Rays go evenly over the half sphere, so the sines of their angles are even: those above k meet the other plate.
        let cases = [
            (r#""falloff": 0"#, "rays.mask", 2.0 * (1.0 - k)),
            (r#""falloff": 1"#, "rays.mask", 2.0 * (1.0 - k + k * k.ln())),
            (r#""falloff": 1"#, "rays.away", -k * k.ln() / (1.0 - k)),
        ];
        for (params, port, expected) in cases {
            let values = values(&mut on_mesh, "contact", &format!(r#""distance": 0.05, {params}"#), port);
            // A mask is clamped at each place, so random excess above 1 is lost.
            let expected = expected.min(1.0);
            let held = MeanDifference::new(&on_mesh, &values, RAYS, |at| is_lower(at).then_some(expected), |_| 0.3);
            held.assert(0.01, &format!("{port} of {params} at {gap}"));
        }
    }
}

#[test]
fn the_random_value_of_a_neighbor_is_that_of_its_piece() {
    let mut on_mesh = plates(0.01);
    for seed in [0, 7] {
        let near = values(
            &mut on_mesh,
            "contact",
            &format!(r#""distance": 0.05, "seed": {seed}"#),
            "rays.id",
        );
        on_mesh.set_graph(&graph("id", r#""by": "piece""#));
        let own = on_mesh.evaluate("rays.id").component("mask");
        let at = |is_upper: bool| {
            on_mesh
                .owned()
                .find(|(index, _)| (on_mesh.position(*index).unwrap().y > 0.0) == is_upper)
        };
        let [lower, upper] = [false, true].map(|is_upper| at(is_upper).expect("both plates").0);
        assert!((own[lower] - own[upper]).abs() > 1e-3, "the plates are two pieces");
        assert!(
            (near[lower] - own[upper]).abs() < 1e-5,
            "{} for {}",
            near[lower],
            own[upper]
        );
    }
}

#[test]
fn the_sun_on_its_path_lights_level_ground_by_the_mean_of_its_height_from_the_side_that_is_not_behind_a_wall() {
    let mut on_mesh = faces(&[FLOOR]);
    // From one horizon over the zenith to the other: the mean of the cosine over half a circle.
    let params = r#""toward": [0, 0.8, 0.6], "spread": 90, "sky": 0, "moves": "path", "distance": 200"#;
    let values_of = values(&mut on_mesh, "sunlight", params, "rays.mask");
    let expected = 2.0 / std::f64::consts::PI * 0.8;
    let held = MeanDifference::new(
        &on_mesh,
        &values_of,
        RAYS,
        |at| is_floor(at).then_some(expected),
        |_| 0.1,
    );
    held.assert(1e-3, "the path of the sun");
    let mean_direction = |on_mesh: &mut OnMesh| {
        on_mesh.set_graph(&graph("sunlight", &format!(r#""rays": {RAYS}, {params}"#)));
        let found = on_mesh.evaluate("rays.direction");
        let [x, y, z] = ["vector.x", "vector.y", "vector.z"].map(|name| found.component(name));
        let own: Vec<DVec3> = on_mesh
            .owned()
            .filter(|(index, _)| on_mesh.position(*index).is_some_and(is_floor))
            .map(|(index, _)| DVec3::new(x[index].into(), y[index].into(), z[index].into()))
            .collect();
        own.iter().sum::<DVec3>() / own.len() as f64
    };
    let open = mean_direction(&mut on_mesh);
    assert!((open - DVec3::new(0.0, 0.8, 0.6)).length() < 0.03, "{open}");
    let mut on_mesh = faces(&[FLOOR, rising(90.0, 100.0)]);
    let half = mean_direction(&mut on_mesh);
    // The wall takes the half of the path behind it. Over the other half the mean of sin φ cos φ is half that of the angle,
    // and the mean of cos² φ a quarter of π.
    let (sideways, upward) = (0.5, 0.25 * std::f64::consts::PI);
    let expected = DVec3::new(sideways, 0.8 * upward, 0.6 * upward).normalize();
    assert!((half - expected).length() < 0.03, "{half} for {expected}");
}
