//! Defects of the thesis' tool that cannot occur here: changes of values on their way into files.

use sabi_image::{Picture, TransferCurve, decode};
use sabi_tests::BakeOutput;
use serde_json::{Value as Json, json};

use crate::waves::{Chart, plane};

/// The plane's chart covers the middle half of the map, across and down.
const DENSITY: f32 = 0.5;

fn baked(size: u32, nodes: Json) -> BakeOutput {
    baked_at(DENSITY, size, nodes)
}

/// A bake of these nodes on a plane, with masks `across` and `up` from 0 to 1 and `half`, which is 0 on the left and 1 on
/// the right.
fn baked_at(density: f32, size: u32, mut nodes: Json) -> BakeOutput {
    nodes["across"] = json!({ "kind": "surface/position", "params": { "along": [1, 0, 0] } });
    nodes["up"] = json!({ "kind": "surface/position", "params": { "along": [0, 1, 0] } });
    nodes["half"] = json!({ "kind": "adjust/remap", "inputs": { "source": "across" },
                            "params": { "from_low": 0.5, "from_high": 0.5 } });
    nodes["out"] = json!({ "kind": "output/material", "inputs": { "material": "material" } });
    let graph = json!({ "format": "sabi", "version": 1, "nodes": nodes });
    BakeOutput::new(&graph.to_string(), plane(Chart::straight(density)).path(), size)
}

fn combine(inputs: Json) -> Json {
    json!({ "kind": "material/combine", "inputs": inputs })
}

/// `source` stretched from 0..1 to these values.
fn stretched(source: &str, low: f64, high: f64) -> Json {
    json!({ "kind": "adjust/remap", "inputs": { "source": source }, "params": { "to_low": low, "to_high": high } })
}

/// A map as numbers, 1 for the highest code.
struct MapPixels {
    size: u32,
    rgba: Vec<[f32; 4]>,
}

impl MapPixels {
    fn of(baked: &BakeOutput, name: &str, size: u32) -> MapPixels {
        let picture: Picture = decode(name, &baked.map(name)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!([picture.width, picture.height], [size; 2], "{name}");
        let rgba = picture.linear_rgba(TransferCurve::Linear).rgba;
        MapPixels { size, rgba }
    }

    /// All pixels of the plane: place on it, 0 to 1 across and up, and value.
    fn on_the_plane(&self) -> Vec<([f64; 2], [f32; 4])> {
        let size = self.size as usize;
        let inside = size / 4..size - size / 4;
        let at = |pixel: usize| ((pixel as f64 + 0.5) / size as f64 - 0.25) / f64::from(DENSITY);
        let rows = inside
            .clone()
            .flat_map(|row| inside.clone().map(move |column| (column, row)));
        rows.map(|(column, row)| ([at(column), 1.0 - at(row)], self.rgba[row * size + column]))
            .collect()
    }

    /// The same without the pixels at the plane's border, where no slope can be measured.
    fn away_from_borders(&self) -> Vec<[f32; 4]> {
        let is_inside = |place: [f64; 2]| place.iter().all(|at| (0.1..0.9).contains(at));
        let inside = self.on_the_plane().into_iter().filter(|(place, _)| is_inside(*place));
        inside.map(|(_, value)| value).collect()
    }
}

#[test]
fn a_value_of_0_is_no_hole_to_be_filled() {
    let size = 64;
    let baked = baked(
        size,
        json!({
            "other": { "kind": "adjust/invert", "inputs": { "source": "half" } },
            "depth": stretched("half", -0.25, 0.5),
            "material": combine(json!({ "roughness": "half", "metallic": "other", "height": "depth" })),
        }),
    );
    for (name, left, right) in [
        ("roughness.png", 0.0, 1.0),
        ("metallic.png", 1.0, 0.0),
        ("height.exr", -0.25, 0.5),
        ("height.png", 0.0, 1.0),
    ] {
        let map = MapPixels::of(&baked, name, size);
        for ([across, _], [value, ..]) in map.on_the_plane() {
            let expected = if across < 0.5 { left } else { right };
            assert_eq!(value, expected, "{name} at {across}");
        }
        // Padding has the values of the nearest pixels, including zeros.
        for (pixel, [value, ..]) in map.rgba.iter().enumerate() {
            let is_left = pixel as u32 % size < size / 2;
            assert_eq!(*value, if is_left { left } else { right }, "{name}, pixel {pixel}");
        }
    }
}

#[test]
fn a_half_is_exported_as_a_half_and_no_value_is_squared() {
    let size = 64;
    let baked = baked(
        size,
        json!({
            "wide": stretched("across", -0.01, 0.01),
            "material": combine(json!({ "roughness": "across", "metallic": "up", "height": "wide" })),
        }),
    );
    let (roughness, metallic) = (
        MapPixels::of(&baked, "roughness.png", size),
        MapPixels::of(&baked, "metallic.png", size),
    );
    for (axis, map) in [roughness, metallic].iter().enumerate() {
        for (place, [value, ..]) in map.on_the_plane() {
            // Half a code, and another half for the dither; these places are exact as half floats.
            assert!(
                (f64::from(value) - place[axis]).abs() <= 1.001 / 255.0,
                "{value} at {place:?}"
            );
        }
    }
    let (exact, coded) = (
        MapPixels::of(&baked, "height.exr", size),
        MapPixels::of(&baked, "height.png", size),
    );
    for (([across, _], [height, ..]), (_, [code, ..])) in exact.on_the_plane().into_iter().zip(coded.on_the_plane()) {
        let expected = 0.02 * (across - 0.5);
        assert!((f64::from(height) - expected).abs() < 1e-8, "{height} at {across}");
        // The lowest and the highest pixel, half a texel inside, are 0 and 1.
        let share = (across - 1.0 / 64.0) / (1.0 - 1.0 / 32.0);
        assert!((f64::from(code) - share).abs() < 2.0 / 65535.0, "{code} at {across}");
    }
}

#[test]
fn a_neutral_height_and_an_even_half_are_told_as_such() {
    let nodes = json!({ "material": { "kind": "source/material", "params": { "roughness": 0.5 } } });
    let report = baked(64, nodes).report;
    let constants = report["constants"].as_array().expect("constants");
    let of = |channel: &str| constants.iter().find(|constant| constant["channel"] == channel);
    assert_eq!(of("roughness").expect("a constant")["value"], 0.5);
    assert!(report["outputs"].as_array().is_some_and(Vec::is_empty), "{report}");
    assert!(of("height").is_none_or(|height| height["value"] == 0.0), "{report}");
}

#[test]
fn a_size_that_is_no_power_of_two_works_like_any_other() {
    for size in [48, 96, 100] {
        let nodes = json!({ "material": combine(json!({ "roughness": "across", "height": "up" })) });
        let baked = baked(size, nodes);
        // A code for rounding with a dither, and what half floats round below 1.
        for (name, axis, allowed) in [
            ("roughness.png", 0, 1.0 / 255.0 + 1.0 / 2048.0),
            ("height.exr", 1, 1e-6),
        ] {
            let map = MapPixels::of(&baked, name, size);
            for (place, [value, ..]) in map.on_the_plane() {
                assert!(
                    (f64::from(value) - place[axis]).abs() <= allowed,
                    "{size}: {name} at {place:?}"
                );
            }
            let least = 0.5 / f64::from(size / 2) - allowed;
            let is_empty = |value: &[f32; 4]| f64::from(value[0]) < least;
            assert!(!map.rgba.iter().any(is_empty), "{size}: {name} has empty padding");
        }
    }
}

#[test]
fn heights_keep_more_than_8_bits() {
    let size = 64;
    let nodes = json!({
        "low": stretched("across", 0.1, 0.1001),
        "material": combine(json!({ "height": "low" })),
    });
    let baked = baked(size, nodes);
    for ([across, _], [height, ..]) in MapPixels::of(&baked, "height.exr", size).on_the_plane() {
        let expected = 0.1 + 0.0001 * across;
        // Four steps of a 32-bit float at 0.1.
        assert!((f64::from(height) - expected).abs() < 3e-8, "{height} at {across}");
    }
    let codes = MapPixels::of(&baked, "height.png", size).on_the_plane();
    let mut codes: Vec<u32> = codes.iter().map(|(_, value)| (value[0] * 65535.0) as u32).collect();
    codes.sort_unstable();
    codes.dedup();
    assert_eq!(codes.len(), size as usize / 2, "one for each column");
}

/// Red, green and blue of the normals of a slope, as exported: Y+, 0.5 is none.
fn normals(size: u32, source: &str, rise: f64) -> Vec<[f32; 4]> {
    let nodes = json!({ "slope": stretched(source, 0.0, rise), "material": combine(json!({ "height": "slope" })) });
    MapPixels::of(&baked(size, nodes), "normal.png", size).away_from_borders()
}

#[test]
fn normals_lean_away_from_the_rise_in_x_and_in_y() {
    for (source, tilted, level) in [("across", 0, 1), ("up", 1, 0)] {
        for [red, green, blue, _] in normals(64, source, 0.1) {
            let code = [red, green];
            let expected = 0.5 - 0.5 * 0.1 / 1.01_f32.sqrt();
            // A few 16-bit codes: heights of 0.1 in 32-bit floats, differences over a texel of 1/32.
            assert!(
                (code[tilted] - expected).abs() < 1e-4,
                "{source}: {code:?}, not {expected}"
            );
            assert!((code[level] - 0.5).abs() < 1e-4, "{source}: {code:?}");
            assert!((blue - (0.5 + 0.5 / 1.01_f32.sqrt())).abs() < 1e-4, "{source}: {blue}");
        }
    }
}

#[test]
fn the_tilt_of_a_normal_depends_on_the_slope_and_not_on_the_size_of_the_map() {
    let tilt = |size: u32| {
        let reds = normals(size, "across", 0.3).into_iter().map(|[red, ..]| red);
        reds.fold([f32::INFINITY, 0.0_f32], |[low, high], red| {
            [low.min(red), high.max(red)]
        })
    };
    let expected = 0.5 - 0.5 * 0.3 / 1.09_f32.sqrt();
    for size in [32, 64, 192] {
        let [low, high] = tilt(size);
        assert!(
            low > expected - 2e-4 && high < expected + 2e-4,
            "{size}: {low} to {high}, not {expected}"
        );
    }
}

#[test]
fn a_gentle_slope_has_no_terraces() {
    // All of it is less than one 8-bit level.
    for [red, ..] in normals(64, "across", 0.002) {
        let expected = 0.5 - 0.5 * 0.002;
        assert!((red - expected).abs() < 3.0 / 65535.0, "{red}, not {expected}");
    }
}

#[test]
fn half_of_white_over_black_is_half_the_light() {
    let size = 64;
    let nodes = json!({
        "base": { "kind": "source/material", "params": { "color": "#000000" } },
        "material": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "half" },
                      "params": { "color": "#ffffff", "opacity": 0.5 } },
    });
    let map = MapPixels::of(&baked(size, nodes), "base_color.png", size);
    for ([across, _], [red, ..]) in map.on_the_plane() {
        // IEC 61966-2-1 encodes 0.5 as 187.5 of 255; mixing codes would give 128.
        let expected = if across < 0.5 { [0.0, 0.0] } else { [187.0, 188.0] };
        assert!(expected.contains(&(red * 255.0).round()), "{red} at {across}");
    }
}
