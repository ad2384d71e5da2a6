//! Filters that follow the surface, compared with paths on a ball and on a cube.

use glam::DVec3;
use sabi_tests::{MeshFile, OnMesh, Quad, project};

/// The ball has this radius.
const RADIUS: f64 = 0.5;

fn on(mesh: &str, nodes: &str, size: u32) -> OnMesh {
    let graph = format!(r#"{{ "format": "sabi", "version": 1, "fit": "metres", "nodes": {{ {nodes} }} }}"#);
    OnMesh::new(&graph, &project(&format!("assets/meshes/{mesh}.glb")), size)
}

/// Owned texels of the ball with their latitude.
fn latitudes(on_mesh: &OnMesh) -> Vec<(usize, f64)> {
    let owned = on_mesh.owned();
    owned
        .filter_map(|(index, _)| Some((index, (on_mesh.position(index)?.y / RADIUS).clamp(-1.0, 1.0).asin())))
        .collect()
}

#[test]
fn a_walk_up_a_ball_ends_where_its_meridian_says() {
    // The source and what moves it are the height, from 0 at the lowest to 1 at the highest point of the ball.
    for distance in [0.05, 0.3, -0.3, 0.6] {
        let mut on_mesh = on(
            "sphere",
            &format!(
                r#""height": {{ "kind": "surface/position", "params": {{ "along": [0, 1, 0] }} }},
                "warp": {{ "kind": "filter/warp", "inputs": {{ "source": "height", "by": "height" }},
                    "params": {{ "distance": {distance} }} }}"#
            ),
            256,
        );
        let warped = on_mesh.evaluate("warp").component("mask");
        let (mut squares, mut count) = (0.0, 0.0);
        for (index, latitude) in latitudes(&on_mesh) {
            let steep: f64 = latitude.cos() / (2.0 * RADIUS) * f64::abs(distance);
            let way = distance * steep / (1.0 + steep * steep).sqrt();
            let expected = 0.5 + 0.5 * (latitude + way / RADIUS).sin();
            squares += (f64::from(warped[index]) - expected).powi(2);
            count += 1.0;
        }
        let rms = f64::sqrt(squares / count);
        // Slopes are those of a map whose texels are up to a quarter of the way wide.
        assert!(rms < 0.006, "{distance}: {rms}");
    }
}

#[test]
fn distances_on_a_ball_are_those_along_great_circles() {
    // From a cap around the pole; its border is a threshold of the height, exact between texels.
    for (size, width) in [(256, 0.2), (256, 0.6), (512, 0.1)] {
        let mut on_mesh = on(
            "sphere",
            &format!(
                r#""height": {{ "kind": "surface/position", "params": {{ "along": [0.3, 1, 0.2] }} }},
                "distance": {{ "kind": "filter/distance", "inputs": {{ "source": "height" }},
                    "params": {{ "width": {width}, "threshold": 0.8 }} }}"#
            ),
            size,
        );
        let distances = on_mesh.evaluate("distance.distance").component("mask");
        let pole = DVec3::new(0.3, 1.0, 0.2).normalize();
        let rim = (0.6_f64).acos();
        let texel = 1.74 / f64::from(size);
        let mut largest = 0.0_f64;
        for (index, _) in latitudes(&on_mesh) {
            let Some(at) = on_mesh.position(index) else { continue };
            let away = (at.normalize().dot(pole).acos() - rim) * RADIUS;
            if away > 0.0 && away < 0.95 * width {
                largest = largest.max((f64::from(distances[index]) - away).abs());
            }
        }
        assert!(largest < 1.5 * texel, "{size}, {width}: {}", largest / texel);
    }
}

/// Returns a filter of a cap around the pole, once with a constant map and once without a map.
fn of_cap(filter: &str, map: f64) -> String {
    format!(
        r#""height": {{ "kind": "surface/position", "params": {{ "along": [0.3, 1, 0.2] }} }},
        "cap": {{ "kind": "adjust/threshold", "inputs": {{ "source": "height" }}, "params": {{ "at": 0.8 }} }},
        "map": {{ "kind": "adjust/levels", "params": {{ "low": {map}, "high": {map} }} }},
        "plain": {{ {filter}, "inputs": {{ "source": "cap" }} }},
        "filtered": {{ {filter}, "inputs": {{ "source": "cap", "MAP": "map" }} }}"#
    )
}

#[test]
fn a_map_of_one_changes_nothing_and_a_map_of_none_leaves_the_mask() {
    for (filter, input) in [
        (r#""kind": "filter/grow", "params": { "radius": 0.05 }"#, "radius_map"),
        (r#""kind": "filter/grow", "params": { "radius": -0.05 }"#, "radius_map"),
        (r#""kind": "filter/streak", "params": { "length": 0.2 }"#, "length_map"),
        (r#""kind": "filter/blur", "params": { "radius": 0.05 }"#, "radius_map"),
    ] {
        let mut on_mesh = on("sphere", &of_cap(filter, 1.0).replace("MAP", input), 128);
        let [plain, filtered] = ["plain", "filtered"].map(|node| on_mesh.evaluate(node).bytes());
        assert_eq!(plain, filtered, "{filter}");
        let mut on_mesh = on("sphere", &of_cap(filter, 0.0).replace("MAP", input), 128);
        let [cap, filtered] = ["cap", "filtered"].map(|node| on_mesh.evaluate(node).component("mask"));
        let areas = on_mesh.areas();
        let whole: f64 = areas.iter().map(|(_, area)| area).sum();
        let changed = |(index, area): &(usize, f64)| area * f64::from((cap[*index] - filtered[*index]).abs());
        let changed = areas.iter().map(changed).sum::<f64>() / whole;
        // Grown masks have a border of a texel, and the cap has a soft one.
        assert!(changed < 0.01, "{filter}: {changed}");
    }
}

#[test]
fn a_cap_grows_by_the_share_of_the_radius_that_a_map_gives() {
    for share in [0.25, 0.5, 0.9] {
        let filter = r#""kind": "filter/grow", "params": { "radius": 0.2 }"#;
        let mut on_mesh = on("sphere", &of_cap(filter, share).replace("MAP", "radius_map"), 256);
        let [cap, grown] = ["cap", "filtered"].map(|node| on_mesh.evaluate(node).component("mask"));
        // Shares of the ball above a height: (1 - cos) / 2 of the angle at its middle.
        let angle = |mean: f64| (1.0 - 2.0 * mean).acos();
        let way = (angle(on_mesh.mean(&grown)) - angle(on_mesh.mean(&cap))) * RADIUS;
        assert!((way - 0.2 * share).abs() < 0.006, "{share}: grown by {way}");
    }
}

#[test]
fn a_streak_is_as_long_as_the_share_of_the_length_that_a_map_gives() {
    let streak = |length: f64, share: f64| {
        let filter = format!(r#""kind": "filter/streak", "params": {{ "length": {length}, "fade": 0.3 }}"#);
        let mut on_mesh = on("sphere", &of_cap(&filter, share).replace("MAP", "length_map"), 256);
        let run = on_mesh.evaluate("filtered").component("mask");
        on_mesh.mean(&run)
    };
    for share in [0.25, 0.5, 0.75] {
        let [mapped, alone] = [streak(0.4, share), streak(0.4 * share, 1.0)];
        assert!((mapped - alone).abs() < 0.01, "{share}: {mapped} for {alone}");
    }
}

/// Returns the amount of water (depth times area) that runs down an upright square from its upper edge. The source is as
/// wide as the square.
fn water(length: f64, params: &str) -> f64 {
    let made = MeshFile::new(vec![Quad {
        corners: [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        uvs: [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
    }]);
    let graph = format!(
        r#"{{ "format": "sabi", "version": 1, "fit": "metres", "nodes": {{
        "up": {{ "kind": "surface/position", "params": {{ "along": [0, 1, 0] }} }},
        "source": {{ "kind": "adjust/levels", "inputs": {{ "source": "up" }},
            "params": {{ "black": 0.849, "white": 0.851 }} }},
        "flow": {{ "kind": "filter/flow", "inputs": {{ "source": "source" }},
            "params": {{ "width": 0.008, "length": {length}, "absorb": 0, "drip": 0, {params} }} }} }} }}"#
    );
    let mut on_mesh = OnMesh::new(&graph, made.write().path(), 512);
    let wet = on_mesh.evaluate("flow").component("mask");
    // The mask is 1 - exp(-depth smoothstep(0, 0.5, depth)).
    let seen = |depth: f64| {
        let share = (2.0 * depth).min(1.0);
        depth * share * share * (3.0 - 2.0 * share)
    };
    let depth = |mask: f64| {
        let told = -(1.0 - mask).ln();
        let (mut low, mut high) = (0.0, 64.0);
        for _ in 0..48 {
            let middle = 0.5 * (low + high);
            if seen(middle) < told {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    };
    let areas = on_mesh.areas().into_iter();
    areas.map(|(index, area)| area * depth(f64::from(wet[index]))).sum()
}

#[test]
fn a_film_that_does_not_dry_holds_all_water_that_has_come_in() {
    // A wide source is filled up to 1 / 0.8 of its value, and the film leaves it at the speed of 1. It runs for 1.15 of Length.
    let film = |length: f64, evaporate: f64| {
        let params = format!(r#""gather": 0, "wander": 0, "evaporate": {evaporate}"#);
        water(length, &params)
    };
    let entered = 1.25 * 1.15 * 0.3;
    let more = film(0.5, 0.0) - film(0.2, 0.0);
    assert!((more / entered - 1.0).abs() < 0.02, "{more} of {entered}");
    let dried = film(0.5, 1.0) - film(0.2, 1.0);
    assert!(dried < 0.7 * entered, "{dried} of {entered}");
}

#[test]
fn water_that_nothing_takes_away_stays_a_number_on_a_model_of_many_bends() {
    let nodes = r#""edges": { "kind": "surface/edges", "params": { "rays": 4, "width": 0.05 } },
        "flow": { "kind": "filter/flow", "inputs": { "source": "edges" },
            "params": { "width": 0.026, "length": 2, "absorb": 0, "evaporate": 0 } }"#;
    let mut on_mesh = on("chain", nodes, 128);
    for port in ["flow", "flow.deposit"] {
        let wet = on_mesh.evaluate(port).component("mask");
        let owned: Vec<f32> = on_mesh.owned().map(|(index, _)| wet[index]).collect();
        assert!(owned.iter().all(|wet| (0.0..=1.0).contains(wet)), "{port}");
        assert!(owned.iter().any(|wet| *wet > 0.5), "{port}");
    }
}
