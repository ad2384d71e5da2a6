use super::*;
use crate::{DeclaredColorSpace, Pixels, decode};

fn wavy(samples: usize) -> Vec<u8> {
    (0..samples)
        .map(|i| ((i as f32 * 0.013).sin() * 100.0 + 120.0 + (i % 7) as f32) as u8)
        .collect()
}

/// Parses the types and contents of the chunks.
fn chunks(file: &[u8]) -> Vec<(String, Vec<u8>)> {
    assert_eq!(&file[..8], b"\x89PNG\r\n\x1a\n");
    let mut rest = &file[8..];
    let mut found = Vec::new();
    while !rest.is_empty() {
        let length = u32::from_be_bytes(rest[..4].try_into().unwrap()) as usize;
        found.push((
            String::from_utf8(rest[4..8].to_vec()).unwrap(),
            rest[8..8 + length].to_vec(),
        ));
        rest = &rest[12 + length..];
    }
    found
}

/// Returns the zlib stream of all `IDAT` chunks.
fn stream(file: &[u8]) -> Vec<u8> {
    let parts = chunks(file).into_iter().filter(|(kind, _)| kind == "IDAT");
    parts.flat_map(|(_, content)| content).collect()
}

fn inflated(file: &[u8]) -> Vec<u8> {
    let mut raw = Vec::new();
    std::io::Read::read_to_end(&mut flate2::read::ZlibDecoder::new(&stream(file)[..]), &mut raw).unwrap();
    raw
}

fn kinds(file: &[u8]) -> Vec<String> {
    chunks(file).into_iter().map(|(kind, _)| kind).collect()
}

#[test]
fn all_channel_counts_and_depths_are_restored_exactly() {
    for channels in 1..=4u8 {
        let data8 = wavy(67 * 45 * usize::from(channels));
        let data16: Vec<u16> = data8
            .iter()
            .enumerate()
            .map(|(i, &b)| u16::from(b) << 8 | (i % 251) as u16)
            .collect();
        let options = PngOptions {
            channels,
            bits: 8,
            srgb_chunk: false,
        };
        let file = encode_png(67, 45, PngData::U8(&data8), options).unwrap();
        let picture = decode("a.png", &file).unwrap();
        assert_eq!((picture.width, picture.height, picture.channels), (67, 45, channels));
        assert_eq!(picture.pixels, Pixels::U8(data8));
        let file = encode_png(67, 45, PngData::U16(&data16), PngOptions { bits: 16, ..options }).unwrap();
        assert_eq!(decode("a.png", &file).unwrap().pixels, Pixels::U16(data16));
    }
}

#[test]
fn another_decoder_reads_files_of_several_strips() {
    let data = wavy(1024 * 700 * 3);
    let options = PngOptions {
        channels: 3,
        bits: 8,
        srgb_chunk: true,
    };
    let file = encode_png(1024, 700, PngData::U8(&data), options).unwrap();
    // `inflate` verifies the checksum that was combined from the strips.
    assert_eq!(inflated(&file).len(), 700 * (1024 * 3 + 1));
    assert_eq!(image::load_from_memory(&file).unwrap().to_rgb8().into_raw(), data);
}

#[test]
fn only_a_requested_srgb_chunk_describes_the_color_space() {
    let options = PngOptions {
        channels: 1,
        bits: 8,
        srgb_chunk: true,
    };
    let color = encode_png(2, 1, PngData::U8(&[1, 2]), options).unwrap();
    assert_eq!(kinds(&color), ["IHDR", "sRGB", "IDAT", "IEND"]);
    assert_eq!(chunks(&color)[1].1, [0], "perceptual");
    assert_eq!(decode("a.png", &color).unwrap().color_space, DeclaredColorSpace::Srgb);
    let data = encode_png(
        2,
        1,
        PngData::U8(&[1, 2]),
        PngOptions {
            srgb_chunk: false,
            ..options
        },
    )
    .unwrap();
    assert_eq!(kinds(&data), ["IHDR", "IDAT", "IEND"]);
    assert_eq!(decode("a.png", &data).unwrap().color_space, DeclaredColorSpace::Unknown);
}

#[test]
fn sixteen_bits_are_big_endian_in_the_file() {
    let options = PngOptions {
        channels: 1,
        bits: 16,
        srgb_chunk: false,
    };
    let file = encode_png(1, 1, PngData::U16(&[0x1234]), options).unwrap();
    assert_eq!(inflated(&file), [0, 0x12, 0x34]);
}

#[test]
fn the_bytes_do_not_depend_on_the_number_of_threads() {
    let data = wavy(900 * 900 * 3);
    let options = PngOptions {
        channels: 3,
        bits: 8,
        srgb_chunk: true,
    };
    let encode = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| encode_png(900, 900, PngData::U8(&data), options).unwrap())
    };
    assert_eq!(encode(1), encode(3));
}

#[test]
fn noise_and_flat_images_of_any_strip_length_are_restored() {
    let mut state = 1u32;
    for (width, height) in [(1, 1), (1, 3000), (5000, 1), (1025, 513)] {
        let noise: Vec<u8> = (0..width * height)
            .map(|_| {
                state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
                (state >> 24) as u8
            })
            .collect();
        for data in [noise, vec![77; (width * height) as usize]] {
            let options = PngOptions {
                channels: 1,
                bits: 8,
                srgb_chunk: false,
            };
            let file = encode_png(width, height, PngData::U8(&data), options).unwrap();
            assert_eq!(decode("a.png", &file).unwrap().pixels, Pixels::U8(data));
        }
    }
}

#[test]
fn a_request_that_does_not_match_the_samples_is_an_error() {
    let options = PngOptions {
        channels: 3,
        bits: 8,
        srgb_chunk: false,
    };
    let error = |data, options| encode_png(2, 2, data, options).unwrap_err().to_string();
    assert_eq!(
        error(PngData::U8(&[0; 11]), options),
        "cannot encode a 2 × 2 picture: 11 samples were given instead of 12"
    );
    assert_eq!(
        error(PngData::U16(&[0; 12]), options),
        "cannot encode a 2 × 2 picture: 8 bits were asked for and 16 bits given"
    );
    assert!(error(PngData::U8(&[]), PngOptions { channels: 5, ..options }).ends_with("not 5"));
}
