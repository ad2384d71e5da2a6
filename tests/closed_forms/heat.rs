//! Blur as heat flow, compared with the flow of heat on a ball and on a cube.

use sabi_tests::{OnMesh, extent, project};

/// A blur of a source, given as the members of its node.
fn graph(source: &str, radius: f64) -> String {
    format!(
        r#"{{ "format": "sabi", "version": 1, "fit": "metres", "nodes": {{
            "source": {{ {source} }},
            "blur": {{ "kind": "filter/blur", "inputs": {{ "source": "source" }}, "params": {{ "radius": {radius} }} }} }} }}"#
    )
}

const WHITE: &str = r#""kind": "noise/white", "params": { "size": 0.08, "seed": 3 }"#;

fn on(mesh: &str, graph: &str, size: u32) -> OnMesh {
    OnMesh::new(graph, &project(&format!("assets/meshes/{mesh}.glb")), size)
}

#[test]
fn an_even_mask_stays_as_it_is_to_the_last_bit() {
    for (mesh, radius) in [("cube", 0.3), ("figure", 0.02), ("sphere", 0.002), ("barrel", 0.2)] {
        let even = r#""kind": "adjust/levels", "params": { "low": 0.3, "high": 0.3 }"#;
        let mut on_mesh = on(mesh, &graph(even, radius), 64);
        let blurred = on_mesh.evaluate("blur").component("mask");
        for index in on_mesh.covered() {
            let texel = on_mesh.texel(index);
            assert_eq!(blurred[index].to_bits(), 0.3_f32.to_bits(), "{mesh}, texel {texel:?}");
        }
    }
}

#[test]
fn a_ramp_over_a_ball_decays_as_the_square_of_the_radius_says() {
    // The height over the middle is an eigenfunction of the ball: exp(-2 T / S²), and T is half the radius' square.
    let ramp = r#""kind": "surface/position", "params": { "along": [0, 1, 0] }"#;
    let mut on_mesh = on("sphere", &graph(ramp, 0.0), 256);
    let before = on_mesh.evaluate("source").component("mask");
    let areas = on_mesh.areas();
    let ball = areas.iter().filter_map(|(index, _)| on_mesh.position(*index));
    let reach = ball.fold(0.0, |reach: f64, at| reach.max(at.y));
    // Both sides are compared where they have most to say.
    let decay = |on_mesh: &OnMesh, after: &[f32]| {
        let product = |values: &[f32]| -> f64 {
            let own = on_mesh.mean(values);
            areas
                .iter()
                .map(|(index, area)| area * (f64::from(values[*index]) - own) * (f64::from(before[*index]) - 0.5))
                .sum()
        };
        product(after) / product(&before)
    };
    for share in [0.02, 0.05, 0.1, 0.2, 0.4, 0.6] {
        on_mesh.set_graph(&graph(ramp, share * reach));
        let after = on_mesh.evaluate("blur").component("mask");
        let (seen, expected) = (decay(&on_mesh, &after), (-share * share).exp());
        // The coarsest of these maps has ten texels for a side of the ball's charts.
        assert!((seen - expected).abs() < 0.01, "{share}: {seen} for {expected}");
    }
}

#[test]
fn a_ramp_over_a_ball_is_blurred_as_heat_flows_at_every_place() {
    let ramp = r#""kind": "surface/position", "params": { "along": [0, 1, 0] }"#;
    // Radii of 3 to 30 % of the ball.
    for radius in [0.03, 0.06, 0.1, 0.2, 0.3] {
        let mut on_mesh = on("sphere", &graph(ramp, radius), 512);
        let [before, after] = ["source", "blur"].map(|node| on_mesh.evaluate(node).component("mask"));
        let left = (-(radius / 0.5_f64).powi(2)).exp();
        let error =
            |(index, _): &(usize, f64)| f64::from(after[*index]) - 0.5 - left * (f64::from(before[*index]) - 0.5);
        let errors: Vec<f64> = on_mesh.areas().iter().map(error).collect();
        let largest = errors.iter().fold(0.0, |largest: f64, error| largest.max(error.abs()));
        let rms = (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt();
        assert!(
            largest < 0.01 && rms < 0.002,
            "radius {radius}: largest {largest}, rms {rms}"
        );
    }
}

#[test]
fn what_one_place_gains_another_loses_and_nothing_goes_beyond_what_was() {
    for (mesh, radius) in [("sphere", 0.03), ("cube", 0.02), ("cube", 0.3), ("figure", 0.05)] {
        let mut on_mesh = on(mesh, &graph(WHITE, radius), 128);
        let [before, after] = ["source", "blur"].map(|node| on_mesh.evaluate(node).component("mask"));
        let areas = on_mesh.areas();
        let [low, high] = extent(areas.iter().map(|(index, _)| before[*index]));
        let [lower, higher] = extent(areas.iter().map(|(index, _)| after[*index]));
        assert!(low < lower && higher < high, "{mesh}: {low} {lower} {higher} {high}");
        let lost = on_mesh.mean(&before) - on_mesh.mean(&after);
        assert!(lost.abs() < 0.005, "{mesh} at {radius}: the mean lost {lost}");
    }
}

#[test]
fn both_sides_of_the_seams_of_a_cube_agree() {
    for radius in [0.03, 0.08, 0.2] {
        let mut on_mesh = on("cube", &graph(WHITE, radius), 512);
        let blurred = on_mesh.evaluate("blur").component("mask");
        let (mut squares, mut largest, mut count) = (0.0, 0.0_f64, 0.0);
        for seam in on_mesh.seams() {
            for sample in 0..64 {
                let along = (f64::from(sample) + 0.5) / 64.0;
                let side = |side: usize| on_mesh.bilinear(&blurred, seam.triangles[side], seam.weights(side, along));
                let step = side(0) - side(1);
                squares += step * step;
                largest = largest.max(step.abs());
                count += 1.0;
            }
        }
        let rms = f64::sqrt(squares / count);
        assert!(
            rms <= 0.001 && largest <= 0.015,
            "radius {radius}: rms {rms}, largest {largest}"
        );
    }
}

/// A blur of a source at radii of a map, given as the members of its node.
fn mapped(source: &str, radius: f64, map: &str) -> String {
    format!(
        r#"{{ "format": "sabi", "version": 1, "fit": "metres", "nodes": {{
            "source": {{ {source} }}, "map": {{ {map} }},
            "plain": {{ "kind": "filter/blur", "inputs": {{ "source": "source" }}, "params": {{ "radius": {radius} }} }},
            "blur": {{ "kind": "filter/blur", "inputs": {{ "source": "source", "radius_map": "map" }},
                "params": {{ "radius": {radius} }} }} }} }}"#
    )
}

#[test]
fn a_map_blurs_as_its_share_of_the_radius_does_alone() {
    let ramp = r#""kind": "surface/position", "params": { "along": [0, 1, 0] }"#;
    let radius = 0.2;
    for share in [0.06, 0.125, 0.3, 0.5, 0.8] {
        let map = format!(r#""kind": "adjust/levels", "params": {{ "low": {share}, "high": {share} }}"#);
        let mut on_mesh = on("sphere", &mapped(ramp, radius, &map), 256);
        let seen = on_mesh.evaluate("blur").component("mask");
        let before = on_mesh.evaluate("source").component("mask");
        on_mesh.set_graph(&graph(ramp, share * radius));
        let expected = on_mesh.evaluate("blur").component("mask");
        // The part that the blur takes from the ramp, which is a Gaussian's variance, and not what it adds here and takes there, which
        // differs between levels.
        let taken = |after: &[f32]| -> f64 {
            let lost = |(index, area): &(usize, f64)| {
                area * f64::from((before[*index] - after[*index]) * (before[*index] - 0.5))
            };
            on_mesh.areas().iter().map(lost).sum()
        };
        let [seen, expected] = [taken(&seen), taken(&expected)];
        assert!(
            (seen - expected).abs() < 0.1 * expected + 1e-5,
            "{share}: {seen} for {expected}"
        );
    }
}

#[test]
fn ends_of_a_map_are_the_mask_itself_and_the_whole_blur_to_the_last_bit() {
    let step = r#""kind": "surface/position", "params": { "along": [1, 0, 0], "low": 0.5, "high": 0.5001 }"#;
    for (mesh, radius) in [("sphere", 0.05), ("cube", 0.2)] {
        let mut on_mesh = on(mesh, &mapped(WHITE, radius, step), 128);
        let [source, plain, blur, map] =
            ["source", "plain", "blur", "map"].map(|node| on_mesh.evaluate(node).component("mask"));
        for (index, _) in on_mesh.owned() {
            let expected = match map[index] {
                share if share <= 0.0 => source[index],
                share if share >= 1.0 => plain[index],
                _ => continue,
            };
            assert_eq!(
                blur[index].to_bits(),
                expected.to_bits(),
                "{mesh} at {:?}",
                on_mesh.texel(index)
            );
        }
    }
}
