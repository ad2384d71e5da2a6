//! Encoding of a channel as a file.

use rayon::prelude::*;
use sabi_image::{
    Dither, ImageError, PngData, PngOptions, encode_exr, encode_png, quantize_u8, quantize_u16, srgb8_from_linear,
};

use crate::ChannelPixels;
use crate::preset::{Codes, Format};

/// An encoded file with its sample format.
pub(crate) struct Encoded {
    pub(crate) bytes: Vec<u8>,
    pub(crate) bits: u8,
    pub(crate) color_space: &'static str,
}

/// The file of a square channel; `range` is what [`Codes::Range`] spans.
pub(crate) fn encode(
    pixels: &ChannelPixels,
    size: u32,
    format: Format,
    range: [f32; 2],
) -> Result<Encoded, ImageError> {
    match format {
        Format::Exr => {
            let planes: Vec<Vec<f32>> = (0..pixels.components)
                .map(|index| {
                    pixels
                        .data
                        .iter()
                        .skip(index)
                        .step_by(pixels.components)
                        .copied()
                        .collect()
                })
                .collect();
            let names: &[&str] = if pixels.components == 3 {
                &["R", "G", "B"]
            } else {
                &["Y"]
            };
            let channels: Vec<(&str, &[f32])> = names.iter().copied().zip(planes.iter().map(Vec::as_slice)).collect();
            let bytes = encode_exr(size, size, &channels)?;
            Ok(Encoded {
                bytes,
                bits: 32,
                color_space: "linear",
            })
        }
        Format::Png { bits, codes, dither } => {
            let srgb = codes == Codes::Srgb;
            let options = PngOptions {
                channels: pixels.components as u8,
                bits,
                srgb_chunk: srgb,
            };
            let bytes = if bits == 16 {
                encode_png(size, size, PngData::U16(&codes_16(pixels, codes, range)), options)?
            } else {
                encode_png(
                    size,
                    size,
                    PngData::U8(&codes_8(pixels, size, codes, dither, range)),
                    options,
                )?
            };
            Ok(Encoded {
                bytes,
                bits,
                color_space: if srgb { "srgb" } else { "linear" },
            })
        }
    }
}

/// Values between 0 and 1 for the codes of all components of a pixel. Normals get unit length first: padding and 16-bit
/// storage may have bent them.
fn to_unit(values: &[f32], codes: Codes, range: [f32; 2], mut give: impl FnMut(f32)) {
    match codes {
        Codes::Srgb | Codes::Unit => values.iter().for_each(|&value| give(value)),
        Codes::Signed => {
            let length = values.iter().map(|value| value * value).sum::<f32>().sqrt();
            let usable = length > 1e-6 && length.is_finite();
            for (index, value) in values.iter().enumerate() {
                let flat = if index == 2 { 1.0 } else { 0.0 };
                give(if usable {
                    value / length * 0.5 + 0.5
                } else {
                    flat * 0.5 + 0.5
                });
            }
        }
        Codes::Range => {
            let span = range[1] - range[0];
            values
                .iter()
                .for_each(|&value| give(if span > 0.0 { (value - range[0]) / span } else { 0.0 }));
        }
    }
}

fn codes_16(pixels: &ChannelPixels, codes: Codes, range: [f32; 2]) -> Vec<u16> {
    let components = pixels.components.max(1);
    let mut out = vec![0u16; pixels.data.len()];
    let pairs = out
        .par_chunks_mut(components)
        .zip(pixels.data.par_chunks(components))
        .with_min_len(4096);
    pairs.for_each(|(out, values)| {
        let mut slots = out.iter_mut();
        to_unit(values, codes, range, |unit| {
            if let Some(slot) = slots.next() {
                *slot = quantize_u16(unit);
            }
        });
    });
    out
}

pub(crate) fn codes_8(pixels: &ChannelPixels, size: u32, codes: Codes, dither: bool, range: [f32; 2]) -> Vec<u8> {
    let components = pixels.components.max(1);
    let row_length = size as usize * components;
    let mut out = vec![0u8; pixels.data.len()];
    if codes == Codes::Srgb {
        let pairs = out.par_iter_mut().zip(&pixels.data).with_min_len(8192);
        pairs.for_each(|(out, &value)| *out = srgb8_from_linear(value));
        return out;
    }
    out.par_chunks_mut(row_length.max(1)).enumerate().for_each(|(y, out)| {
        for x in 0..size as usize {
            let place = (y * size as usize + x) * components;
            let values = &pixels.data[place..place + components];
            let vary = dither && is_on_a_gradient(&pixels.data, place, components, x, size as usize);
            let mode = if vary { Dither::Ordered } else { Dither::Off };
            let mut slots = out[x * components..(x + 1) * components].iter_mut();
            to_unit(values, codes, range, |unit| {
                if let Some(slot) = slots.next() {
                    *slot = if vary {
                        mode.quantize_u8(unit, x as u32, y as u32)
                    } else {
                        quantize_u8(unit)
                    };
                }
            });
        }
    });
    out
}

/// Returns true if a neighbor has another value. An area of one value would only get noise from dithering.
fn is_on_a_gradient(data: &[f32], place: usize, components: usize, x: usize, size: usize) -> bool {
    let row = size * components;
    let differs = |other: usize| {
        data.get(other..other + components)
            .is_some_and(|other| other != &data[place..place + components])
    };
    (x > 0 && differs(place - components))
        || (x + 1 < size && differs(place + components))
        || (place >= row && differs(place - row))
        || differs(place + row)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use sabi_image::{Pixels, decode};

    use super::*;

    fn codes_of(data: Vec<f32>, components: usize, size: u32, codes: Codes, bits: u8, dither: bool) -> Pixels {
        let pixels = ChannelPixels { components, data };
        let format = Format::Png { bits, codes, dither };
        decode("a.png", &encode(&pixels, size, format, [-1.0, 3.0]).unwrap().bytes)
            .unwrap()
            .pixels
    }

    #[test]
    fn the_flat_normal_is_the_middle_code_rounded_up() {
        let flat = codes_of(vec![0.0, 0.0, 1.0], 3, 1, Codes::Signed, 16, false);
        assert_eq!(flat, Pixels::U16(vec![32768, 32768, 65535]));
        let long = codes_of(vec![0.0, -3.0, 0.0], 3, 1, Codes::Signed, 16, false);
        assert_eq!(long, Pixels::U16(vec![32768, 0, 32768]), "unit length");
        let broken = codes_of(vec![0.0; 3], 3, 1, Codes::Signed, 16, false);
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
        let codes: Vec<f64> = match codes_of(vectors.concat(), 3, size, Codes::Signed, bits, false) {
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
        let flat = codes_of(vec![0.0, 0.0, 1.0], 3, 1, Codes::Signed, 8, false);
        assert_eq!(flat, Pixels::U8(vec![128, 128, 255]));
    }

    #[test]
    fn heights_span_their_range() {
        let codes = codes_of(vec![-1.0, 3.0, 1.0, 0.0], 1, 2, Codes::Range, 16, false);
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
    fn floats_are_exact() {
        let data = vec![0.1, -7.25, f32::MIN_POSITIVE, 1e20];
        let pixels = ChannelPixels {
            components: 1,
            data: data.clone(),
        };
        let file = encode(&pixels, 2, Format::Exr, [0.0; 2]).unwrap();
        assert_eq!(decode("a.exr", &file.bytes).unwrap().pixels, Pixels::F32(data));
        assert_eq!((file.bits, file.color_space), (32, "linear"));
    }
}
