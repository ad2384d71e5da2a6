//! Normals from height: physical slopes, independent of the texels.

use glam::DVec3;
use sabi_tests::OnMesh;

use crate::waves::{Chart, Waves, decoded_slopes, plane};

/// Width of a texel on a straight chart that fills the unit square.
fn texel(chart: Chart, size: u32) -> f64 {
    let density = f64::from(chart.density[0].min(chart.density[1]));
    1.0 / (density * f64::from(size))
}

/// Away from the border of the plane, where a stencil has nothing to read beyond.
fn is_inside(position: DVec3) -> bool {
    position.x.abs() < 0.45 && position.y.abs() < 0.45
}

/// Largest distance between the decoded slope and the true one, as a share of the steepest slope.
fn largest_error(waves: Waves, chart: Chart, size: u32) -> f64 {
    error_of(waves, waves.on(&plane(chart), size))
}

/// The same of waves that are there.
fn error_of(waves: Waves, mut on_mesh: OnMesh) -> f64 {
    let slopes = decoded_slopes(&mut on_mesh, "waves");
    let inside: Vec<_> = slopes
        .into_iter()
        .filter(|(_, position, _)| is_inside(*position))
        .collect();
    assert!(inside.len() > 1000, "{} texels", inside.len());
    let error = |(_, position, slope): &(usize, DVec3, DVec3)| (*slope - waves.slope(*position)).length();
    inside.iter().map(error).fold(0.0, f64::max) / waves.steepest()
}

#[test]
fn the_slope_of_a_sine_is_its_derivative() {
    let turned = |degrees, is_mirrored| Chart {
        degrees,
        is_mirrored,
        ..Chart::straight(0.65)
    };
    let stretched = Chart {
        density: [0.9, 0.45],
        ..Chart::straight(1.0)
    };
    let charts = [
        ("straight", Chart::straight(1.0)),
        ("turned", turned(30.0, false)),
        ("mirrored", turned(0.0, true)),
        ("turned and mirrored", turned(-50.0, true)),
        ("stretched", stretched),
    ];
    for (name, chart) in charts {
        for degrees in [0.0, 35.0, 90.0] {
            for wavelength in [0.5, 0.25] {
                let waves = Waves::new(degrees, wavelength, 0.02);
                let error = largest_error(waves, chart, 128);
                let step = waves.wave_number() * texel(chart, 128);
                // A central difference along the waves is too flat by (kh)²/6; across them, Scharr's weights average
                // over a texel to each side: 3/16 (kh)².
                let allowed = 0.1875 * step * step + 2e-4;
                assert!(
                    error < allowed,
                    "{name}, waves of {wavelength} at {degrees}°: {error:.5}, allowed {allowed:.5}"
                );
            }
        }
    }
}

#[test]
fn the_slope_of_a_blurred_sine_is_that_of_what_heat_leaves() {
    let turned = Chart {
        degrees: 30.0,
        is_mirrored: true,
        ..Chart::straight(0.65)
    };
    for (name, chart) in [("straight", Chart::straight(1.0)), ("turned", turned)] {
        for degrees in [0.0, 35.0] {
            for texels in [0.5, 1.0] {
                let waves = Waves::new(degrees, 0.25, 0.02);
                let width = texel(chart, 128);
                let radius = texels * width;
                let filter = format!(r#""kind": "filter/blur", "params": {{ "radius": {radius} }}"#);
                let on_mesh = waves.filtered_on(&filter, &plane(chart), 128);
                let error = error_of(waves.blurred(radius), on_mesh);
                // As without a blur.
                let step = waves.wave_number() * width;
                let allowed = 0.1875 * step * step + 2e-4;
                assert!(
                    error < allowed,
                    "{name}, waves at {degrees}°, a blur of {texels} texels: {error:.5}, allowed {allowed:.5}"
                );
            }
        }
    }
}

#[test]
fn stretched_texture_coordinates_and_finer_texels_give_the_same_normals() {
    let waves = Waves::new(20.0, 1.0, 0.02);
    let stretched = Chart {
        density: [1.0, 0.5],
        ..Chart::straight(1.0)
    };
    for (chart, size) in [(Chart::straight(1.0), 64), (stretched, 64), (Chart::straight(1.0), 256)] {
        let error = largest_error(waves, chart, size);
        assert!(error < 0.01, "at {size}: {error}");
    }
}

#[test]
fn an_even_height_is_exactly_flat() {
    let graph = r#"{ "format": "sabi", "version": 1, "nodes": {
        "layer": { "kind": "effect/layer", "params": { "height": 0.0137 } } } }"#;
    for mesh in ["cube", "bench", "figure"] {
        let mut on_mesh = OnMesh::new(graph, &sabi_tests::project(&format!("assets/meshes/{mesh}.glb")), 128);
        let evaluated = on_mesh.evaluate("layer");
        let normal = ["normal.x", "normal.y", "normal.z"].map(|name| evaluated.component(name));
        for (index, _) in on_mesh.owned() {
            let got = normal.each_ref().map(|component| component[index]);
            assert_eq!(got, [0.0, 0.0, 1.0], "{mesh}, texel {:?}", on_mesh.texel(index));
        }
    }
}
