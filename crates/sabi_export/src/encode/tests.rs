use glam::DVec3;
use sabi_image::{Pixels, decode};

use super::*;

const UP: Codes = Codes::Normal { is_down: false };
const DOWN: Codes = Codes::Normal { is_down: true };

fn codes_of(data: Vec<f32>, components: usize, size: u32, codes: Codes, bits: u8, is_dithered: bool) -> Pixels {
    let pixels = ChannelPixels { components, data };
    let encoding = Encoding {
        size: [size; 2],
        format: Format::Png { bits },
        is_srgb: false,
        is_dithered,
    };
    let file = encode(&planes(&pixels, codes), encoding).unwrap();
    decode("a.png", &file).unwrap().pixels
}

#[test]
fn the_flat_normal_is_the_middle_code_rounded_up() {
    let flat = codes_of(vec![0.0, 0.0, 1.0], 3, 1, UP, 16, false);
    assert_eq!(flat, Pixels::U16(vec![32768, 32768, 65535]));
    let long = codes_of(vec![0.0, -3.0, 0.0], 3, 1, UP, 16, false);
    assert_eq!(long, Pixels::U16(vec![32768, 0, 32768]), "unit length");
    let broken = codes_of(vec![0.0; 3], 3, 1, UP, 16, false);
    assert_eq!(broken, Pixels::U16(vec![32768, 32768, 65535]));
}

/// The largest angle between unit vectors and what their codes stand for, degrees.
fn largest_turn(bits: u8) -> f64 {
    let size = 64_u32;
    let vectors: Vec<[f32; 3]> = (0..size * size)
        .map(|i| {
            // Evenly over the half sphere, by the golden angle.
            let z = 1.0 - (f64::from(i) + 0.5) / f64::from(size * size);
            let (around, across) = (2.399_963_229_728_653 * f64::from(i), (1.0 - z * z).sqrt());
            [across * around.cos(), across * around.sin(), z].map(|part| part as f32)
        })
        .collect();
    let codes: Vec<f64> = match codes_of(vectors.concat(), 3, size, UP, bits, false) {
        Pixels::U8(codes) => codes.into_iter().map(|code| f64::from(code) / 255.0).collect(),
        Pixels::U16(codes) => codes.into_iter().map(|code| f64::from(code) / 65535.0).collect(),
        Pixels::F32(_) => panic!("whole numbers"),
    };
    let turn = |(vector, code): (&[f32; 3], &[f64])| {
        let was = DVec3::from(vector.map(f64::from));
        let is = DVec3::from_slice(code) * 2.0 - 1.0;
        (was.dot(is) / (was.length_squared() * is.length_squared()).sqrt())
            .clamp(-1.0, 1.0)
            .acos()
    };
    let turns = vectors.iter().zip(codes.chunks_exact(3)).map(turn);
    turns.fold(0.0, f64::max).to_degrees()
}

#[test]
fn normals_come_back_from_their_codes_as_exactly_as_the_bits_allow() {
    // Half a step of each component, √3/255 and √3/65535 as a vector; and what acos loses near 1.
    let half_step = |codes: f64| (3.0_f64.sqrt() / codes).to_degrees();
    let (at_8, at_16) = (largest_turn(8), largest_turn(16));
    assert!(at_8 < half_step(255.0), "{at_8}");
    assert!(at_16 < half_step(65535.0) + 1e-5, "{at_16}");
    assert!(at_16 < 0.01);
}

#[test]
fn the_flat_normal_is_128_128_255_in_8_bits() {
    let flat = codes_of(vec![0.0, 0.0, 1.0], 3, 1, UP, 8, false);
    assert_eq!(flat, Pixels::U8(vec![128, 128, 255]));
}

#[test]
fn heights_span_their_range() {
    let codes = codes_of(vec![-1.0, 3.0, 1.0, 0.0], 1, 2, Codes::Range([-1.0, 3.0]), 16, false);
    assert_eq!(codes, Pixels::U16(vec![0, 65535, 32768, 16384]));
}

#[test]
fn areas_of_one_value_are_not_dithered_and_gradients_are() {
    let size = 32u32;
    let flat = codes_of(vec![0.7001953; 1024], 1, size, Codes::Unit, 8, true);
    assert_eq!(flat, Pixels::U8(vec![179; 1024]));
    let ramp: Vec<f32> = (0..1024).map(|i| 0.5 + (i % 32) as f32 * 1e-4).collect();
    let Pixels::U8(codes) = codes_of(ramp.clone(), 1, size, Codes::Unit, 8, true) else {
        panic!("8 bits")
    };
    for (code, value) in codes.iter().zip(&ramp) {
        assert!((f32::from(*code) - value * 255.0).abs() < 1.0);
    }
    let mean = codes.iter().map(|&code| f64::from(code)).sum::<f64>() / 1024.0;
    let exact = ramp.iter().map(|&value| f64::from(value) * 255.0).sum::<f64>() / 1024.0;
    assert!((mean - exact).abs() < 0.05, "{mean} {exact}");
}

#[test]
fn green_that_means_downward_is_the_mirror_of_green_that_means_upward() {
    let tilted = |y: f32| vec![0.3, y, (1.0 - 0.09 - y * y).sqrt()];
    for bits in [8, 16] {
        for y in [0.0, 0.25, -0.7] {
            let down = codes_of(tilted(y), 3, 1, DOWN, bits, false);
            assert_eq!(down, codes_of(tilted(-y), 3, 1, UP, bits, false), "{bits} bits, {y}");
        }
    }
    let flat = codes_of(vec![0.0, 0.0, 1.0], 3, 1, DOWN, 8, false);
    assert_eq!(flat, Pixels::U8(vec![128, 128, 255]), "no tilt by rounding");
}

#[test]
fn normals_never_point_inward() {
    let inward = codes_of(vec![0.6, 0.0, -0.8], 3, 1, UP, 8, false);
    assert_eq!(
        inward,
        Pixels::U8(vec![255, 128, 128]),
        "along the surface, of unit length"
    );
    let under = codes_of(vec![0.0, 0.0, -1.0], 3, 1, UP, 8, false);
    assert_eq!(under, Pixels::U8(vec![128, 128, 255]));
}

#[test]
fn inversions_and_constants_are_packed_beside_channels() {
    let pixels = ChannelPixels {
        components: 1,
        data: vec![0.25, 1.0],
    };
    let of = |is_inverted| Plane::Channel {
        pixels: &pixels,
        index: 0,
        codes: Codes::Unit,
        is_inverted,
    };
    let encoding = Encoding {
        size: [2, 1],
        format: Format::Png { bits: 8 },
        is_srgb: true,
        is_dithered: false,
    };
    let codes = codes_8(
        &[of(false), Plane::Constant(0.5), Plane::Constant(0.0), of(true)],
        encoding,
    );
    assert_eq!(codes, [137, 188, 0, 191, 255, 188, 0, 0], "alpha is linear");
}

#[test]
fn floats_are_exact() {
    let pixels = ChannelPixels {
        components: 1,
        data: vec![0.1, -7.25, f32::MIN_POSITIVE, 1e20],
    };
    let encoding = |format| Encoding {
        size: [2, 2],
        format,
        is_srgb: false,
        is_dithered: false,
    };
    let heights = planes(&pixels, Codes::Range([-7.25, 1e20]));
    let file = encode(&heights, encoding(Format::Exr)).unwrap();
    assert_eq!(decode("a.exr", &file).unwrap().pixels, Pixels::F32(pixels.data.clone()));
    let half = encode(&planes(&pixels, Codes::Unit), encoding(Format::ExrHalf)).unwrap();
    let expected = vec![0.099_975_586, -7.25, 0.0, 65504.0];
    assert_eq!(decode("a.exr", &half).unwrap().pixels, Pixels::F32(expected));
}
