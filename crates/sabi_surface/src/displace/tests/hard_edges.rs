//! Tests of displacement at hard edges, against closed forms.

use super::*;

/// Half the side of the cube.
fn half_side(mesh: &Mesh) -> f32 {
    let values = mesh.positions.iter().flatten();
    values.fold(0.0, |most: f32, at| most.max(at.abs()))
}

/// Returns the point of the mesh at a texel of a chart, extrapolated from the nearest triangle if it is outside of the chart.
fn place_of(mesh: &Mesh, atlas: &Atlas, chart: u32, texel: [f32; 2]) -> Vec3 {
    let of_chart = (0..mesh.triangles.len()).filter(|triangle| atlas.triangle_chart[*triangle] == chart);
    let places = of_chart.map(|triangle| {
        let [a, b, c] = atlas.triangle_texels[triangle].map(|at| DVec2::from(at.map(f64::from)));
        let at = DVec2::from(texel.map(f64::from)) - a;
        let whole = (b - a).perp_dot(c - a);
        let [v, w] = [at.perp_dot(c - a) / whole, (b - a).perp_dot(at) / whole];
        let [a, b, c] = mesh.triangles[triangle].map(|vertex| Vec3::from(mesh.positions[vertex as usize]));
        let inside = (1.0 - v - w).min(v).min(w);
        (inside, a + (b - a) * v as f32 + (c - a) * w as f32)
    });
    places.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap().1
}

#[test]
fn a_cube_with_constant_heights_becomes_a_smaller_or_larger_cube() {
    let (mesh, atlas) = asset("cube.glb");
    let half = half_side(&mesh);
    for height in [-0.1, -0.02, 0.05] {
        let made = displaced(&mesh, &atlas, &options(0.03, 200_000), |_, _| Some(height));
        assert!(made.positions.len() > 10_000);
        for at in &made.positions {
            let largest = at.map(f32::abs).into_iter().fold(0.0, f32::max);
            assert!((largest - half - height).abs() < 1e-5, "{at:?} with height {height}");
        }
    }
}

#[test]
fn places_keep_their_order_beside_a_sunk_edge() {
    let (mesh, atlas) = asset("cube.glb");
    let plain = displaced(&mesh, &atlas, &options(0.03, 200_000), |_, _| Some(0.0));
    let sunk = displaced(&mesh, &atlas, &options(0.03, 200_000), |_, _| Some(-0.1));
    for &[a, b, c] in &sunk.triangles {
        let normal = |copy: &DisplacedMesh| {
            let [a, b, c] = [a, b, c].map(|vertex| Vec3::from(copy.positions[vertex as usize]));
            (b - a).cross(c - a)
        };
        let (was, is) = (normal(&plain), normal(&sunk));
        assert!(was.dot(is) > 0.2 * was.length_squared(), "{was} {is}");
    }
}

#[test]
fn chamfer_heights_give_a_plane_over_the_edge() {
    let (mesh, atlas) = asset("cube.glb");
    let (half, width) = (half_side(&mesh), 0.2);
    // The two largest coordinates: that of the face, and that of the nearest edge.
    let sorted = |at: Vec3| {
        let mut values = at.abs().to_array();
        values.sort_by(|a, b| b.total_cmp(a));
        values
    };
    let chamfer = |chart: u32, texel: [f32; 2]| {
        let [_, second, _] = sorted(place_of(&mesh, &atlas, chart, texel));
        Some((half - second - width).min(0.0))
    };
    let made = displaced(&mesh, &atlas, &options(0.03, 200_000), chamfer);
    let (mut flat, mut cut) = (0, 0);
    for &at in &made.positions {
        let [first, second, _] = sorted(at.into());
        let beyond_plane = first + second - (2.0 * half - width);
        assert!(first <= half + 1e-5 && beyond_plane < 2e-3, "{at:?} stands out");
        let is_on_face = (first - half).abs() < 1e-5;
        let is_on_plane = beyond_plane.abs() < 2e-3;
        assert!(is_on_face || is_on_plane, "{at:?} lies in a pit by {beyond_plane}");
        flat += u32::from(is_on_face);
        cut += u32::from(is_on_plane && !is_on_face);
    }
    assert!(flat > 5_000 && cut > 2_000, "{flat} {cut}");
}

#[test]
fn a_cube_with_sunk_cracks_stays_inside_its_faces() {
    let (mesh, atlas) = asset("cube.glb");
    let half = half_side(&mesh);
    let rough = |chart: u32, [x, y]: [f32; 2]| Some(-0.08 * noise(&[chart, x as u32 / 4, y as u32 / 4]));
    let made = displaced(&mesh, &atlas, &options(0.02, 400_000), rough);
    for at in &made.positions {
        assert!(at.iter().all(|value| value.abs() <= half + 1e-6), "{at:?}");
    }
}
