//! Nodes that cast rays, compared with closed forms. Each texel casts its own rays, and results are averaged over equivalent texels.

use std::f64::consts::PI;

use glam::DVec3;
use sabi_tests::{MeshFile, OnMesh, Quad, project};

pub(crate) fn graph(kind: &str, params: &str) -> String {
    format!(
        r#"{{ "format": "sabi", "version": 1, "fit": "metres", "nodes": {{
            "rays": {{ "kind": "surface/{kind}", "params": {{ {params} }} }} }} }}"#
    )
}

/// Returns faces without thickness, each alone on its part of the sheet, seen from the side that counts.
pub(crate) fn faces(corners: &[[[f32; 3]; 4]]) -> OnMesh {
    let side = 1.0 / corners.len() as f32;
    let quads = corners.iter().enumerate().map(|(at, corners)| {
        let [left, right] = [(at as f32 + 0.05) * side, (at as f32 + 0.95) * side];
        Quad {
            corners: *corners,
            uvs: [[left, 0.95], [right, 0.95], [right, 0.05], [left, 0.05]],
        }
    });
    let made = MeshFile::new(quads.collect()).write();
    OnMesh::new(&graph("occlusion", ""), made.path(), 384)
}

const FLOOR: [[f32; 3]; 4] = [[0.0, 0.0, 3.0], [2.0, 0.0, 3.0], [2.0, 0.0, -3.0], [0.0, 0.0, -3.0]];
const WALL: [[f32; 3]; 4] = [[0.0, 0.0, 3.0], [0.0, 0.0, -3.0], [0.0, 3.0, -3.0], [0.0, 3.0, 3.0]];

/// Returns the mean of a result over the owned texels selected by `is_meant`, and their number.
fn mean(on_mesh: &mut OnMesh, result: &str, component: &str, is_meant: impl Fn(DVec3) -> bool) -> (f64, usize) {
    let values = on_mesh.evaluate(result).component(component);
    let meant = on_mesh
        .owned()
        .filter(|(index, _)| on_mesh.position(*index).is_some_and(&is_meant));
    let (sum, count) = meant.fold((0.0, 0), |(sum, count), (index, _)| {
        (sum + f64::from(values[index]), count + 1)
    });
    (sum / f64::from(count), count as usize)
}

#[test]
fn beside_a_wall_occlusion_falls_off_as_the_cut_disk_does() {
    let mut on_mesh = faces(&[FLOOR, WALL]);
    for (params, share) in [
        (r#""rays": 64, "distance": 0.8"#, cut_disk as fn(f64) -> f64),
        (r#""rays": 64, "distance": 0.8, "falloff": "linear""#, faded_disk),
    ] {
        on_mesh.set_graph(&graph("occlusion", params));
        for away in [0.1, 0.3, 0.5, 0.7] {
            let strip = move |at: DVec3| at.y == 0.0 && (at.x - away).abs() < 0.03 && at.z.abs() < 2.0;
            let (occlusion, count) = mean(&mut on_mesh, "rays", "mask", strip);
            assert!(count > 100);
            let expected = share(away / 0.8);
            assert!(
                (occlusion - expected).abs() < 0.01,
                "{params} at {away}: {occlusion} for {expected}"
            );
            let (open, _) = mean(&mut on_mesh, "rays.ao", "mask", strip);
            assert!((occlusion + open - 1.0).abs() < 1e-6);
        }
    }
}

/// Cosine-weighted occlusion on a floor beside an endless wall, at a distance as a share of the rays' length.
fn cut_disk(k: f64) -> f64 {
    (k.acos() - k * (1.0 - k * k).sqrt()) / PI
}

/// The same where rays end anywhere along their length: the mean over all lengths.
fn faded_disk(k: f64) -> f64 {
    let steps = 1000;
    let length = |step: i32| (f64::from(step) + 0.5) / f64::from(steps);
    let at = |length: f64| if length > k { cut_disk(k / length) } else { 0.0 };
    (0..steps).map(|step| at(length(step))).sum::<f64>() / f64::from(steps)
}

#[test]
fn in_a_corner_the_open_way_is_bent_by_the_mean_of_a_quarter() {
    let mut on_mesh = faces(&[FLOOR, WALL]);
    on_mesh.set_graph(&graph("bent_normal", r#""rays": 256, "distance": 2.0"#));
    let near = |at: DVec3| at.y == 0.0 && at.x < 0.04 && at.z.abs() < 0.5;
    let [x, y] = ["vector.x", "vector.y"].map(|part| mean(&mut on_mesh, "rays.direction", part, near).0);
    let bent = x.atan2(y).to_degrees();
    assert!((bent - (2.0 / PI).atan().to_degrees()).abs() < 1.5, "{bent}");
}

#[test]
fn a_slab_is_as_thick_as_the_cosine_says() {
    let below = FLOOR.map(|[x, _, z]| [x, -0.1, z]);
    let mut on_mesh = faces(&[FLOOR, [below[3], below[2], below[1], below[0]]]);
    on_mesh.set_graph(&graph("thickness", r#""rays": 64, "distance": 0.5"#));
    let middle = |at: DVec3| at.y == 0.0 && (at.x - 1.0).abs() < 0.3 && at.z.abs() < 2.0;
    // Mean of T / cos over a cosine lobe, held at D: 2 T - T² / D.
    let (depth, _) = mean(&mut on_mesh, "rays.depth", "mask", middle);
    assert!((depth - (0.2 - 0.01 / 0.5)).abs() < 0.002, "{depth}");
    let (share, _) = mean(&mut on_mesh, "rays", "mask", middle);
    assert!((share - depth / 0.5).abs() < 1e-5);
}

#[test]
fn a_ball_bends_as_its_radius_says_and_sees_nothing_of_itself() {
    let mut on_mesh = OnMesh::new(
        &graph("occlusion", r#""distance": 2"#),
        &project("assets/meshes/sphere.glb"),
        128,
    );
    let center = |on_mesh: &OnMesh| {
        let places: Vec<DVec3> = on_mesh
            .owned()
            .filter_map(|(index, _)| on_mesh.position(index))
            .collect();
        let low = places.iter().copied().reduce(DVec3::min).expect("texels");
        let high = places.iter().copied().reduce(DVec3::max).expect("texels");
        ((low + high) / 2.0, (high - low).max_element() / 2.0)
    };
    let (_, radius) = center(&on_mesh);
    let (occlusion, _) = mean(&mut on_mesh, "rays", "mask", |_| true);
    assert!(occlusion < 1e-4, "{occlusion}");
    on_mesh.set_graph(&graph(
        "curvature",
        &format!(r#""rays": 64, "radius": {}"#, 0.5 * radius),
    ));
    let (bend, _) = mean(&mut on_mesh, "rays", "mask", |_| true);
    assert!((bend - 0.25).abs() < 0.005, "{bend}");
}

#[test]
fn an_edge_bends_by_its_share_of_a_half_turn_and_evenly_less_beside_it() {
    let mut on_mesh = OnMesh::new(&graph("occlusion", ""), &project("assets/meshes/cube.glb"), 256);
    let half = on_mesh
        .owned()
        .filter_map(|(index, _)| on_mesh.position(index))
        .map(|at| at.x)
        .fold(0.0, f64::max);
    on_mesh.set_graph(&graph("curvature", &format!(r#""rays": 64, "radius": {}"#, 0.5 * half)));
    for share in [0.1, 0.5, 0.9, 1.5] {
        let from_edge = move |at: DVec3| {
            // On the side x = half, near its edge toward +z, far from the other edges.
            let away = (half - at.z) / (0.5 * half);
            (at.x - half).abs() < 1e-4 * half && (away - share).abs() < 0.04 && at.y.abs() < 0.4 * half
        };
        let (bend, count) = mean(&mut on_mesh, "rays", "mask", from_edge);
        assert!(count > 20, "{count}");
        let expected = (0.5 * (1.0 - share)).max(0.0);
        assert!((bend - expected).abs() < 0.015, "{share}: {bend} for {expected}");
    }
    on_mesh.set_graph(&graph(
        "edges",
        &format!(r#""rays": 64, "softness": 1, "width": {}"#, 0.5 * half),
    ));
    let (on_edge, _) = mean(&mut on_mesh, "rays", "mask", |at| {
        (at.x - half).abs() < 1e-4 * half && half - at.z < 0.02 * half && at.y.abs() < 0.4 * half
    });
    assert!(on_edge > 0.9, "{on_edge}");
    on_mesh.set_graph(&graph("cavity", &format!(r#""rays": 64, "width": {}"#, 0.5 * half)));
    let (hollow, _) = mean(&mut on_mesh, "rays", "mask", |_| true);
    assert_eq!(hollow, 0.0, "a cube has no creases");
}

#[test]
fn what_shoots_rays_gives_the_same_bytes_twice() {
    let mesh = project("assets/meshes/figure.glb");
    let bytes = || {
        OnMesh::new(&graph("occlusion", r#""rays": 4"#), &mesh, 128)
            .evaluate("rays")
            .bytes()
    };
    assert_eq!(bytes(), bytes());
}

/// Returns the warnings about a box of the first `faces` faces, turned outward or inward, when rays are shot at it.
fn told(faces_out: bool, faces: usize) -> Vec<String> {
    const SIDES: [[[f32; 3]; 3]; 6] = [
        [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
        [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
    ];
    let quads = SIDES[..faces].iter().enumerate().map(|(at, [right, up, out])| {
        let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
        let mut corners =
            corners.map(|[x, y]| std::array::from_fn(|axis| 0.5 * out[axis] + x * right[axis] + y * up[axis]));
        if !faces_out {
            corners.reverse();
        }
        let [left, right] = [(at as f32 + 0.1) / 6.0, (at as f32 + 0.9) / 6.0];
        Quad {
            corners,
            uvs: [[left, 0.9], [right, 0.9], [right, 0.1], [left, 0.1]],
        }
    });
    let made = MeshFile::new(quads.collect()).write();
    let mut on_mesh = OnMesh::new(&graph("occlusion", ""), made.path(), 64);
    on_mesh.evaluate("rays");
    on_mesh.warnings()
}

#[test]
fn rays_say_what_they_cannot_rely_on() {
    assert_eq!(told(true, 6), [] as [String; 0]);
    let open = told(true, 5);
    assert!(
        open.len() == 1 && open[0].starts_with("The model is open at 4 edges:"),
        "{open:?}"
    );
    let inward = told(false, 6);
    assert!(
        inward.len() == 1 && inward[0].starts_with("The model is inside out:"),
        "{inward:?}"
    );
}
