use glam::DVec3;
use sabi_image::{DitherPattern, Pixels, decode};

use super::*;
use crate::ChannelPixels;

const UP: CodeMapping = CodeMapping::Normal { is_down: false };
const DOWN: CodeMapping = CodeMapping::Normal { is_down: true };

fn codes_of(data: Vec<f32>, components: usize, size: u32, codes: CodeMapping, bits: u8, is_dithered: bool) -> Pixels {
    let pixels = ChannelPixels { components, data };
    let encoding = FileEncoding {
        size: [size; 2],
        format: MapFormat::Png { bits },
        is_srgb: false,
    };
    let mut planes = planes(&pixels, codes);
    for (at, plane) in planes.iter_mut().enumerate() {
        if let ComponentPlane::Channel { dither, .. } = plane {
            *dither = is_dithered.then(|| DitherPattern::new(1, "test", at));
        }
    }
    let file = encode(&planes, encoding).unwrap();
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

/// Returns the largest angle between unit vectors and the vectors that their codes represent, in degrees.
fn largest_turn(bits: u8) -> f64 {
    let size = 64_u32;
    let vectors: Vec<[f32; 3]> = (0..size * size)
        .map(|i| {
            // Evenly distributed over the half sphere by the golden angle.
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
fn normals_are_restored_from_codes_as_exactly_as_the_bits_allow() {
    // Half a step of each component, √3/255 and √3/65535 as a vector, plus the rounding error of acos near 1.
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
    let codes = codes_of(
        vec![-1.0, 3.0, 1.0, 0.0],
        1,
        2,
        CodeMapping::Range([-1.0, 3.0]),
        16,
        false,
    );
    assert_eq!(codes, Pixels::U16(vec![0, 65535, 32768, 16384]));
}

/// 8-bit codes of rows of one width, dithered.
fn dithered(rows: Vec<f32>, size: u32) -> Vec<u8> {
    match codes_of(rows, 1, size, CodeMapping::Unit, 8, true) {
        Pixels::U8(codes) => codes,
        _ => panic!("8 bits"),
    }
}

#[test]
fn areas_of_one_value_are_not_dithered() {
    assert_eq!(dithered(vec![0.7001953; 1024], 32), [179; 1024]);
}

#[test]
fn a_dithered_gradient_has_the_right_mean_everywhere_and_no_pixel_is_off_by_a_code() {
    let size = 128_usize;
    let ramp: Vec<f32> = (0..size * size)
        .map(|at| 0.2 + (at % size) as f32 * 2e-4 + (at / size) as f32 * 1e-5)
        .collect();
    let codes = dithered(ramp.clone(), size as u32);
    let error = |at: usize| f64::from(codes[at]) - f64::from(ramp[at]) * 255.0;
    assert!((0..size * size).all(|at| error(at).abs() < 1.0));
    for block in 0..64 {
        let corner = block / 8 * 16 * size + block % 8 * 16;
        let mean = (0..256).map(|at| error(corner + at / 16 * size + at % 16)).sum::<f64>() / 256.0;
        assert!(mean.abs() < 0.06, "{block}: {mean}");
    }
}

/// Half floats between 0.5 and 1 have a step of an eighth of a code, so a shallow gradient of them has wide plateaus.
#[test]
fn a_shallow_gradient_of_half_floats_has_no_steps() {
    let size = 256_usize;
    let half = |value: f32| (value * 2048.0).round() / 2048.0;
    for is_across in [true, false] {
        let value = |at: usize| {
            let along = if is_across { at % size } else { at / size };
            half(0.5 + 0.03 * along as f32 / size as f32)
        };
        let codes = dithered((0..size * size).map(value).collect(), size as u32);
        for line in 0..size {
            let of_line = (0..size).map(|at| if is_across { at * size + line } else { line * size + at });
            let mean = of_line.map(|at| f64::from(codes[at])).sum::<f64>() / size as f64;
            let expected = f64::from(value(if is_across { line } else { line * size })) * 255.0;
            // A line sees the 64 thresholds of the pattern; plain rounding would be off by up to half a code.
            assert!(
                (mean - expected).abs() < 0.15,
                "{is_across} {line}: {mean}, not {expected}"
            );
        }
    }
}

#[test]
fn dithering_leaves_edges_and_exact_codes_alone() {
    let size = 64_usize;
    // Areas of values between codes that meet in an edge, and one pixel between them.
    let edge: Vec<f32> = (0..size * size)
        .map(|at| match at % size {
            ..=30 => 0.3003,
            31 => 0.5007,
            _ => 0.7004,
        })
        .collect();
    let plain: Vec<u8> = edge.iter().map(|value| (value * 255.0).round() as u8).collect();
    assert_eq!(dithered(edge, size as u32), plain);
    let codes: Vec<f32> = (0..size * size)
        .map(|at| ((at + at / size) % 256) as f32 / 255.0)
        .collect();
    let plain: Vec<u8> = codes.iter().map(|value| (value * 255.0).round() as u8).collect();
    assert_eq!(dithered(codes, size as u32), plain);
}

#[test]
fn dithering_gives_the_same_bytes_on_any_number_of_threads() {
    let ramp: Vec<f32> = (0..128 * 128).map(|at| 0.1 + at as f32 * 3e-5).collect();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| dithered(ramp.clone(), 128))
    };
    assert_eq!(on(1), on(5));
}

#[test]
fn colors_may_be_dithered_after_their_curve() {
    let size = 64_usize;
    let pixels = ChannelPixels {
        components: 1,
        data: (0..size * size)
            .map(|at| sabi_color::linear_from_srgb(0.4 + at as f32 * 1e-6))
            .collect(),
    };
    let plane = ComponentPlane::Channel {
        pixels: &pixels,
        index: 0,
        codes: CodeMapping::Unit,
        is_inverted: false,
        dither: Some(DitherPattern::new(1, "test", 0)),
    };
    let encoding = FileEncoding {
        size: [size as u32; 2],
        format: MapFormat::Png { bits: 8 },
        is_srgb: true,
    };
    let codes = codes_8(&[plane], encoding);
    let mean = codes.iter().map(|code| f64::from(*code)).sum::<f64>() / codes.len() as f64;
    assert!((mean - (0.4 + 2.0475e-3) * 255.0).abs() < 0.02, "{mean}");
}

#[test]
fn green_down_is_the_mirror_image_of_green_up() {
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
fn inverted_and_constant_components_are_packed_beside_channels() {
    let pixels = ChannelPixels {
        components: 1,
        data: vec![0.25, 1.0],
    };
    let of = |is_inverted| ComponentPlane::Channel {
        pixels: &pixels,
        index: 0,
        codes: CodeMapping::Unit,
        is_inverted,
        dither: None,
    };
    let encoding = FileEncoding {
        size: [2, 1],
        format: MapFormat::Png { bits: 8 },
        is_srgb: true,
    };
    let codes = codes_8(
        &[
            of(false),
            ComponentPlane::Constant(0.5),
            ComponentPlane::Constant(0.0),
            of(true),
        ],
        encoding,
    );
    assert_eq!(codes, [137, 188, 0, 191, 255, 188, 0, 0], "alpha is linear");
}

#[test]
fn directions_have_unit_length_in_floats_and_in_codes() {
    let pixels = ChannelPixels {
        components: 3,
        data: vec![0.0, -0.5, 0.0, 0.0, 0.0, 0.0],
    };
    let directions = planes(&pixels, CodeMapping::Direction);
    let of = |format| {
        let encoding = FileEncoding {
            size: [2, 1],
            format,
            is_srgb: false,
        };
        let file = encode(&directions, encoding).unwrap();
        let name = format!("a.{}", format.ending());
        decode(&name, &file).unwrap().pixels
    };
    assert_eq!(of(MapFormat::Exr), Pixels::F32(vec![0.0, -1.0, 0.0, 0.0, 0.0, 0.0]));
    assert_eq!(
        of(MapFormat::Png { bits: 8 }),
        Pixels::U8(vec![128, 0, 128, 128, 128, 128])
    );
}

#[test]
fn floats_are_exact() {
    let pixels = ChannelPixels {
        components: 1,
        data: vec![0.1, -7.25, f32::MIN_POSITIVE, 1e20],
    };
    let encoding = |format| FileEncoding {
        size: [2, 2],
        format,
        is_srgb: false,
    };
    let heights = planes(&pixels, CodeMapping::Range([-7.25, 1e20]));
    let file = encode(&heights, encoding(MapFormat::Exr)).unwrap();
    assert_eq!(decode("a.exr", &file).unwrap().pixels, Pixels::F32(pixels.data.clone()));
    let half = encode(&planes(&pixels, CodeMapping::Unit), encoding(MapFormat::ExrHalf)).unwrap();
    let expected = vec![0.099_975_586, -7.25, 0.0, 65504.0];
    assert_eq!(decode("a.exr", &half).unwrap().pixels, Pixels::F32(expected));
}
