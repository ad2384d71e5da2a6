//! Layers on a surface and parts that break off: a coat at a straight border, settled layers, and breaks at one edge.

use glam::DVec3;
use sabi_tests::{MadeMesh, MeshFile, OnMesh, Quad};
use serde_json::{Value, json};

/// A level square over x and z from -0.5 to 0.5 that faces up.
fn ground() -> MadeMesh {
    MeshFile::new(vec![Quad {
        corners: [[-0.5, 0.0, 0.5], [0.5, 0.0, 0.5], [0.5, 0.0, -0.5], [-0.5, 0.0, -0.5]],
        uvs: [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
    }])
    .write()
}

const SIZE: u32 = 512;
const TEXEL: f64 = 1.0 / SIZE as f64;

fn on_ground(nodes: &Value) -> OnMesh {
    let graph = json!({ "format": "sabi", "version": 1, "nodes": nodes }).to_string();
    OnMesh::new(&graph, ground().path(), SIZE)
}

/// A mask that is 1 on the side of growing x, with a border as wide as two texels at x = 0.
fn half() -> Value {
    json!({
        "ramp": { "kind": "surface/position", "params": { "along": [1, 0, 0] } },
        "half": {
            "kind": "adjust/levels", "inputs": { "source": "ramp" },
            "params": { "black": 0.5 - TEXEL, "white": 0.5 + TEXEL },
        },
    })
}

/// The complementary error function (Abramowitz and Stegun 7.1.26, within 1.5e-7).
fn erfc(x: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.327_591_1 * x);
    let sum =
        t * (0.254_829_592 + t * (-0.284_496_736 + t * (1.421_413_741 + t * (-1.453_152_027 + t * 1.061_405_429))));
    sum * (-x * x).exp()
}

#[test]
fn the_height_of_a_coat_at_a_straight_border_is_its_thickness_and_the_lift_that_is_left_at_a_distance() {
    let (thickness, width, lift) = (0.004, 0.1, 0.02);
    for curl in [0.0, lift] {
        let mut nodes = half();
        nodes["coat"] = json!({
            "kind": "effect/coat", "inputs": { "gone": "half" },
            "params": {
                "thickness": thickness, "curl_width": width, "curl_height": curl, "uneven": 0, "ragged": 0, "old": 0,
            },
        });
        let mut on_mesh = on_ground(&nodes);
        let height = on_mesh.evaluate("coat.height").component("mask");
        for (index, _) in on_mesh.owned() {
            let at = on_mesh.position(index).expect("a place");
            let is_beside = at.x.abs() < 3.0 * TEXEL || at.z.abs() > 0.3;
            if is_beside {
                continue;
            }
            let away = -at.x;
            // What pulls at a place is the share of lost coat around it, with the weights of a Gaussian; the free end rolls over.
            let pull = erfc(away.max(0.0) / (0.5 * width * 2.0_f64.sqrt()));
            let lip = 1.0 - (away / (0.22 * width)).clamp(0.0, 1.0);
            let lifted = curl * pull.powf(1.5) * (1.0 - 0.45 * lip * lip);
            let expected = if away < 0.0 { 0.0 } else { thickness + lifted };
            let off = (f64::from(height[index]) - expected).abs();
            assert!(
                off < 1e-5 + 0.05 * curl,
                "{} for {expected} at {away} from the border",
                height[index]
            );
        }
    }
}

#[test]
fn as_much_settles_as_falls() {
    for (mode, params) in [
        ("powder", json!({ "mode": "powder", "amount": 0.01, "reach": 0.1 })),
        (
            "puddle",
            json!({ "mode": "puddle", "amount": 0.01, "reach": 0.1, "smooth_edges": 0 }),
        ),
        (
            "film",
            json!({ "mode": "film", "amount": 0.01, "reach": 0.1, "smooth_edges": 0 }),
        ),
    ] {
        // Round bumps that are twice as high as the layer is thick.
        let nodes = json!({
            "bumps": { "kind": "noise/simplex", "params": { "size": 0.2, "octaves": 1 } },
            "high": { "kind": "math/mask", "inputs": { "a": "bumps" }, "params": { "b": 0.02 } },
            "fill": { "kind": "relief/fill", "inputs": { "height": "high" }, "params": params },
        });
        let mut on_mesh = on_ground(&nodes);
        let height = on_mesh.evaluate("fill.height").component("mask");
        let volume = on_mesh.mean(&height);
        assert!((volume - 0.01).abs() < 0.0004, "{mode}: {volume} for 0.01");
    }
}

#[test]
fn the_edges_of_puddles_and_films_run_out_where_they_are_smooth() {
    for mode in ["puddle", "film"] {
        let thickness = |smooth: f64| {
            let mut nodes = half();
            nodes["fill"] = json!({
                "kind": "relief/fill", "inputs": { "source": "half" },
                "params": { "mode": mode, "amount": 0.01, "reach": 0.2, "smooth_edges": smooth },
            });
            let mut on_mesh = on_ground(&nodes);
            let height = on_mesh.evaluate("fill.height").component("mask");
            let own: Vec<f32> = on_mesh.owned().map(|(index, _)| height[index]).collect();
            own
        };
        let [sharp, smooth] = [0.0, 1.0].map(thickness);
        let thinner = sharp
            .iter()
            .zip(&smooth)
            .filter(|(sharp, smooth)| **smooth < 0.9 * **sharp)
            .count();
        let share = thinner as f64 / sharp.len() as f64;
        assert!(share > 0.02 && share < 0.6, "{mode}: {share} of the surface is thinner");
        assert!(
            sharp.iter().zip(&smooth).all(|(sharp, smooth)| smooth <= sharp),
            "{mode} grows nowhere"
        );
    }
}

#[test]
fn breaks_at_one_edge_are_no_deeper_than_they_should_be_and_reach_no_further() {
    let (depth, steep) = (0.05, 0.7);
    let nodes = json!({
        "ramp": { "kind": "surface/position", "params": { "along": [1, 0, 0] } },
        "broken": {
            "kind": "relief/fracture", "inputs": { "edge": "ramp" },
            "params": { "size": 0.2, "depth": depth, "big": 1, "mid": 0, "small": 0, "slant": 0, "steep": steep, "rim": 0 },
        },
    });
    let mut on_mesh = on_ground(&nodes);
    let [ramp, height] = ["ramp", "broken.height"].map(|node| on_mesh.evaluate(node).component("mask"));
    let mut deepest = 0.0_f64;
    for (index, _) in on_mesh.owned() {
        // A face that is parallel to the edge: as deep as the depth at the edge, less by its slope further in.
        let (away, deep) = (f64::from(ramp[index]), -f64::from(height[index]));
        let most = (depth - steep * away).max(0.0);
        assert!(
            deep <= most + 1e-6,
            "{deep} deep at {away} from the edge, where {most} is the most"
        );
        deepest = deepest.max(deep);
    }
    assert!(deepest > 0.5 * depth, "the deepest break is {deepest}");
}

#[test]
fn distances_on_a_ball_point_back_to_their_spot_and_carry_its_value() {
    let radius = 0.5_f64;
    let made = MeshFile::new(sabi_tests::shapes::ball(radius, 48)).write();
    // Two caps, of which each has a value of its own.
    let cap = |toward: [f64; 3]| {
        json!({
            "kind": "surface/direction", "params": { "toward": toward, "reach": 15, "fade": 0 },
        })
    };
    let nodes = json!({
        "one": cap([0.3, 1.0, 0.2]), "other": cap([-0.3, -1.0, -0.2]),
        "caps": { "kind": "blend/mask", "inputs": { "below": "one", "above": "other" }, "params": { "mode": "max" } },
        "height": { "kind": "surface/position", "params": { "along": [0.3, 1.0, 0.2] } },
        "values": { "kind": "adjust/threshold", "inputs": { "source": "height" }, "params": { "at": 0.5, "softness": 0 } },
        "away": { "kind": "filter/distance", "inputs": { "source": "caps", "carry": "values" }, "params": { "width": 0.6 } },
    });
    let graph = json!({ "format": "sabi", "version": 1, "fit": "metres", "nodes": nodes }).to_string();
    let mut on_mesh = OnMesh::new(&graph, made.path(), 256);
    let distance = on_mesh.evaluate("away.distance").component("mask");
    let id = on_mesh.evaluate("away.id").component("mask");
    let way = on_mesh.evaluate("away.direction");
    let way = ["vector.x", "vector.y", "vector.z"].map(|name| way.component(name));
    let pole = DVec3::new(0.3, 1.0, 0.2).normalize();
    let (mut counted, mut turned, mut sum) = (0, 0, 0.0);
    for (index, _) in on_mesh.owned() {
        let at = on_mesh.position(index).expect("a place").normalize();
        let near = if at.dot(pole) > 0.0 { pole } else { -pole };
        let angle = at.dot(near).acos();
        let expected = (radius * (angle - 15.0_f64.to_radians())).clamp(0.0, 0.6);
        // A cap ends with whole faces, which are up to 0.02 wide.
        let off = (f64::from(distance[index]) - expected).abs();
        assert!(off < 0.03, "{} for {expected} at {at}", distance[index]);
        // The border of a cap is jagged, as its faces are.
        if !(0.15..=0.5).contains(&expected) || angle > 85.0_f64.to_radians() {
            continue;
        }
        counted += 1;
        let toward = (near - at * at.dot(near)).normalize();
        let is = DVec3::from(way.each_ref().map(|part| f64::from(part[index])));
        sum += is.dot(toward);
        turned += u32::from(is.dot(toward) < 0.9);
        let carried = f32::from(u8::from(at.dot(pole) > 0.0));
        assert!(
            (id[index] - carried).abs() < 0.01,
            "{} for {carried} at {at}",
            id[index]
        );
    }
    assert!(counted > 10_000, "{counted} places");
    let mean = sum / f64::from(counted);
    assert!(mean > 0.99, "the mean cosine of directions is {mean}");
    // Coarse texels at the borders of charts turn single ones.
    assert!(
        100 * turned < counted,
        "{turned} of {counted} directions are off by more than 26°"
    );
}
