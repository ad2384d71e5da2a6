use std::fs;
use std::path::{Path, PathBuf};

use super::*;
use crate::declared_color::profile_chunk;

fn png_bytes(
    color: png::ColorType,
    depth: png::BitDepth,
    data: &[u8],
    more: impl Fn(&mut png::Encoder<'_, &mut Vec<u8>>),
) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, 2, 2);
    encoder.set_color(color);
    encoder.set_depth(depth);
    more(&mut encoder);
    encoder.write_header().unwrap().write_image_data(data).unwrap();
    file
}

#[test]
fn palettes_single_bits_and_transparent_colors_are_expanded() {
    let palette = png_bytes(
        png::ColorType::Indexed,
        png::BitDepth::Two,
        &[0b0001_0000, 0b1000_0000],
        |encoder| {
            encoder.set_palette(vec![10, 20, 30, 40, 50, 60, 70, 80, 90]);
            encoder.set_trns(vec![0]);
        },
    );
    let picture = decode("p.png", &palette).unwrap();
    assert_eq!(picture.channels, 4);
    let expected = vec![10, 20, 30, 0, 40, 50, 60, 255, 70, 80, 90, 255, 10, 20, 30, 0];
    assert_eq!(picture.pixels, Pixels::U8(expected));
    let bits = png_bytes(
        png::ColorType::Grayscale,
        png::BitDepth::One,
        &[0b0100_0000, 0b1000_0000],
        |_| (),
    );
    assert_eq!(decode("b.png", &bits).unwrap().pixels, Pixels::U8(vec![0, 255, 255, 0]));
}

#[test]
fn chunks_declare_the_transfer_curve_of_a_png() {
    let with = |more: fn(&mut png::Encoder<'_, &mut Vec<u8>>)| {
        let file = png_bytes(png::ColorType::Grayscale, png::BitDepth::Eight, &[0; 4], more);
        decode("g.png", &file).unwrap().color_space
    };
    assert_eq!(with(|_| ()), DeclaredColorSpace::Unknown);
    assert_eq!(
        with(|e| e.set_source_srgb(png::SrgbRenderingIntent::Perceptual)),
        DeclaredColorSpace::Srgb
    );
    assert_eq!(
        with(|e| e.set_source_gamma(png::ScaledFloat::new(1.0))),
        DeclaredColorSpace::Linear
    );
    assert_eq!(
        with(|e| e.set_source_gamma(png::ScaledFloat::new(0.45455))),
        DeclaredColorSpace::Srgb
    );
    assert_eq!(
        with(|e| e.set_source_gamma(png::ScaledFloat::new(0.5))),
        DeclaredColorSpace::Power(2.0)
    );
}

#[test]
fn a_huge_color_profile_is_told_without_unpacking_it() {
    let mut info = png::Info::with_size(2, 2);
    info.color_type = png::ColorType::Grayscale;
    info.bit_depth = png::BitDepth::Eight;
    info.icc_profile = Some(vec![0; 32 << 20].into());
    let mut file = Vec::new();
    let encoder = png::Encoder::with_info(&mut file, info).unwrap();
    encoder.write_header().unwrap().write_image_data(&[9; 4]).unwrap();
    assert!(file.len() < 1 << 16, "a small file");
    assert!(profile_chunk(&file).is_some());
    assert_eq!([&file[..40], b""].map(profile_chunk), [None; 2]);
    let picture = decode("profile.png", &file).unwrap();
    assert_eq!(
        (picture.pixels, picture.color_space),
        (Pixels::U8(vec![9; 4]), DeclaredColorSpace::Unknown)
    );
    assert_eq!(
        picture.remarks.color,
        [
            "declares a color profile whose curves are not simple ones (iCCP), which Sabi does not apply; convert the picture to sRGB \
             to see the same colors"
        ]
    );
    // The same for a profile that cannot be unpacked.
    let start = file.windows(4).position(|window| window == b"iCCP").unwrap();
    file[start + 8..start + 200].fill(7);
    assert_eq!(decode("profile.png", &file).unwrap().remarks, picture.remarks);
}

fn encoded(format: ImageFormat) -> Vec<u8> {
    let picture = image::RgbImage::from_fn(40, 30, |x, y| image::Rgb([(x * 6) as u8, (y * 8) as u8, 99]));
    let mut bytes = Cursor::new(Vec::new());
    let picture = DynamicImage::ImageRgb8(picture);
    if format == ImageFormat::Hdr {
        DynamicImage::ImageRgb32F(picture.to_rgb32f())
            .write_to(&mut bytes, format)
            .unwrap();
    } else {
        picture.write_to(&mut bytes, format).unwrap();
    }
    bytes.into_inner()
}

const FORMATS: [(&str, ImageFormat); 5] = [
    ("a.jpg", ImageFormat::Jpeg),
    ("a.webp", ImageFormat::WebP),
    ("a.tga", ImageFormat::Tga),
    ("a.bmp", ImageFormat::Bmp),
    ("a.hdr", ImageFormat::Hdr),
];

#[test]
fn the_other_formats_are_read_by_content() {
    for (name, format) in FORMATS {
        let picture = decode(name, &encoded(format)).unwrap();
        assert_eq!((picture.width, picture.height, picture.channels), (40, 30, 3), "{name}");
        let first = picture.linear_rgba(crate::TransferCurve::Linear).rgba[20];
        assert!(
            (first[0] - 120.0 / 255.0).abs() < 0.03 && (first[2] - 99.0 / 255.0).abs() < 0.03,
            "{name}: {first:?}"
        );
        let declared = if format == ImageFormat::Hdr {
            DeclaredColorSpace::Linear
        } else {
            DeclaredColorSpace::Unknown
        };
        assert_eq!(picture.color_space, declared, "{name}");
    }
}

#[test]
fn a_truncated_file_gives_an_error_that_names_it() {
    let mut files: Vec<(&str, Vec<u8>)> = FORMATS.iter().map(|&(name, format)| (name, encoded(format))).collect();
    let options = crate::PngOptions {
        channels: 1,
        bits: 8,
        srgb_chunk: true,
    };
    // Gray levels that do not compress, so that the last chunk, without which a PNG is whole, is less than a tenth of the file.
    let levels: Vec<u8> = (0..256_u32).map(|i| (i * i * 31 % 251) as u8).collect();
    files.push((
        "a.png",
        crate::encode_png(64, 4, crate::PngData::U8(&levels), options).unwrap(),
    ));
    let values: Vec<f32> = (0..900).map(|i| i as f32).collect();
    files.push((
        "a.exr",
        crate::encode_exr(30, 30, &[("Y", &values)], crate::ExrSamples::Float).unwrap(),
    ));
    for (name, bytes) in files {
        for length in 0..bytes.len() * 9 / 10 {
            let error = decode(name, &bytes[..length]).expect_err(&format!("{name} at {length}"));
            assert!(error.to_string().starts_with(&format!("{name} ")), "{error}");
        }
    }
}

#[test]
fn a_file_with_any_flipped_byte_gives_an_image_or_an_error() {
    let mut files: Vec<(&str, Vec<u8>)> = FORMATS.iter().map(|&(name, format)| (name, encoded(format))).collect();
    let values: Vec<f32> = (0..900).map(|i| i as f32).collect();
    files.push((
        "a.exr",
        crate::encode_exr(30, 30, &[("Y", &values)], crate::ExrSamples::Float).unwrap(),
    ));
    for (name, bytes) in files {
        for place in (0..bytes.len()).step_by(bytes.len() / 150 + 1) {
            let mut broken = bytes.clone();
            broken[place] ^= 0xff;
            if let Err(error) = decode(name, &broken) {
                assert!(
                    !error.to_string().contains("contradict"),
                    "a decoder panicked: {name} at {place}"
                );
            }
        }
    }
}

#[test]
fn errors_are_clear_sentences() {
    let says = |name, bytes: &[u8]| decode(name, bytes).unwrap_err().to_string();
    assert_eq!(
        says("a.png", b""),
        "a.png is empty; check that it was saved or copied completely"
    );
    assert_eq!(
        says("a.tif", b"II*\0rest"),
        "a.tif is a TIFF picture, which Sabi does not read; save it as PNG, JPEG, WebP, TGA, BMP, HDR or OpenEXR and use \
         that file"
    );
    assert_eq!(
        says(
            "a.png",
            b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n"
        ),
        "a.png is a Git LFS pointer instead of the picture itself; run `git lfs pull` where it came from"
    );
    assert!(says("a.png", b"hello").starts_with("a.png is no picture of a known kind"));
    for (bytes, kind) in [
        (&b"\0\0\0\x20ftypavif"[..], "an AVIF picture"),
        (b"\0\0\0\x18ftypheic", "an HEIC picture"),
        (b"\xff\x0a", "a JPEG XL picture"),
        (b"II+\0", "a BigTIFF picture"),
        (b"P6\n1 1\n255\n", "a PPM picture"),
        (b"<?xml version='1.0'?>\n<svg/>", "an SVG drawing"),
        (b"<!DOCTYPE html>", "a web page"),
        (b"BA\0\0\0\0\0\0\0\0\0\0\0\0BM", "an array of OS/2 bitmaps"),
    ] {
        let told = says("a.png", bytes);
        assert!(
            told.starts_with(&format!("a.png is {kind}, which Sabi does not read")),
            "{told}"
        );
    }
    let options = crate::PngOptions {
        channels: 1,
        bits: 8,
        srgb_chunk: false,
    };
    let mut file = crate::encode_png(1, 1, crate::PngData::U8(&[0]), options).unwrap();
    file[32] ^= 0xff;
    let checksum = says("a.png", &file);
    assert!(
        checksum.contains("while decoding IHDR chunk); open and save it again"),
        "{checksum}"
    );
    assert!(says("a.png", b"\x89PNG\r\n\x1a\n").starts_with("a.png is a damaged PNG file ("));
}

#[test]
fn a_png_without_its_last_chunk_is_read_and_one_without_its_last_pixels_is_not() {
    let options = crate::PngOptions {
        channels: 1,
        bits: 8,
        srgb_chunk: false,
    };
    let whole = crate::encode_png(2, 2, crate::PngData::U8(&[1, 2, 3, 4]), options).unwrap();
    let without_end = &whole[..whole.len() - 12];
    assert_eq!(
        decode("a.png", without_end).unwrap().pixels,
        Pixels::U8(vec![1, 2, 3, 4])
    );
    for cut in [1, 5, 10] {
        let told = decode("a.png", &without_end[..without_end.len() - cut])
            .unwrap_err()
            .to_string();
        assert!(told.starts_with("a.png is a damaged PNG file ("), "{cut}: {told}");
    }
}

#[test]
fn a_huge_declared_size_is_refused_before_allocation() {
    let options = crate::PngOptions {
        channels: 1,
        bits: 8,
        srgb_chunk: false,
    };
    let mut file = crate::encode_png(1, 1, crate::PngData::U8(&[0]), options).unwrap();
    file[16..20].copy_from_slice(&70_000u32.to_be_bytes());
    // The checksum of the header must be correct, otherwise the checksum would be reported.
    let mut crc = flate2::Crc::new();
    crc.update(&file[12..29]);
    let sum = crc.sum();
    file[29..33].copy_from_slice(&sum.to_be_bytes());
    assert_eq!(
        decode("big.png", &file).unwrap_err().to_string(),
        "big.png claims 70000 × 1 pixels; pictures of up to 16384 × 16384 and 1 GiB decoded are read, so make it smaller"
    );
    assert!(check_size("a", 16384, 16384, 4).is_ok());
    assert!(check_size("a", 16384, 16384, 8).is_err());
    assert!(check_size("a", u64::MAX, u64::MAX, 8).is_err());
}

fn files_below(folder: &Path, files: &mut Vec<PathBuf>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let path = entry.path();
        if path.is_dir() {
            files_below(&path, files)
        } else {
            files.push(path)
        }
    }
}

#[test]
#[ignore = "reads files that SABI_TEST_DATA names"]
fn known_hostile_files_never_cause_a_panic() {
    let data = std::env::var_os("SABI_TEST_DATA").expect("SABI_TEST_DATA names the folder of the files");
    let data = Path::new(&data);
    let mut files = Vec::new();
    for folder in [
        "hostile/png-tests",
        "hostile/png-fuzz-corpus",
        "hostile/openexr-damaged",
        "hostile/imagers",
        "images",
        "env",
    ] {
        files_below(&data.join(folder), &mut files);
    }
    files.sort();
    let (mut pictures, mut sentences) = (0, 0);
    for path in &files {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let bytes = fs::read(path).unwrap();
        let decoded = decode(&name, &bytes);
        if let Err(early) = check_header(&name, &bytes) {
            assert_eq!(decoded.as_ref().err(), Some(&early), "{name}");
        }
        match decoded {
            Ok(picture) => {
                let samples = match &picture.pixels {
                    Pixels::U8(list) => list.len(),
                    Pixels::U16(list) => list.len(),
                    Pixels::F32(list) => list.len(),
                };
                let expected = picture.width as usize * picture.height as usize * usize::from(picture.channels);
                assert_eq!(samples, expected, "{name}");
                pictures += 1;
            }
            Err(error) => {
                assert!(!error.to_string().contains("contradict"), "a decoder panicked: {name}");
                println!("{error}");
                sentences += 1;
            }
        }
    }
    println!("{pictures} pictures, {sentences} sentences");
    assert!(pictures > 100 && sentences > 100);
}
