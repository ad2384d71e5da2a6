//! Tests of unusual kinds of image files that artists' tools write.

use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes, LineOrder,
    SmallVec, WritableImage, f16,
};

use super::*;

/// 8 × 8 pixels of one red in CMYK, as used for printing, stored inverted with Adobe's marker. Hexadecimal.
const CMYK_JPEG: &str = "\
    ffd8ffee000e41646f626500640000000000ffdb004300100b0c0e0c0a100e0d0e1211101318281a181616183123251d283a333d3c393338\
    3740485c4e404457453738506d51575f626768673e4d71797064785c656763ffc000140800080008044311004d11005911004b1100ffc400\
    14000100000000000000000000000000000007ffc40014100100000000000000000000000000000000ffda000e0443004d0059004b00003f\
    00401f8fc80fffd9";

/// 8 × 8 pixels of (200, 100, 50), in several scans. Hexadecimal.
const PROGRESSIVE_JPEG: &str = "\
    ffd8ffe000104a46494600010100000100010000ffdb0043000302020302020303030304030304050805050404050a070706080c0a0c0c0b\
    0a0b0b0d0e12100d0e110e0b0b1016101113141515150c0f171816141812141514ffdb00430103040405040509050509140d0b0d14141414\
    14141414141414141414141414141414141414141414141414141414141414141414141414141414141414141414ffc20011080008000803\
    012200021101031101ffc4001500010100000000000000000000000000000003ffc4001501010100000000000000000000000000000607ff\
    da000c03010002100310000001880f48ffc40014100100000000000000000000000000000000ffda00080101000105027fffc40014110100\
    000000000000000000000000000000ffda0008010301013f017fffc40014110100000000000000000000000000000000ffda000801020101\
    3f017fffc40014100100000000000000000000000000000000ffda0008010100063f027fffc4001410010000000000000000000000000000\
    0000ffda0008010100013f217fffda000c03010002000300000010f3ffc40014110100000000000000000000000000000000ffda00080103\
    01013f107fffc40014110100000000000000000000000000000000ffda0008010201013f107fffc400141001000000000000000000000000\
    00000000ffda0008010100013f107fffd9";

fn from_hexadecimal(text: &str) -> Vec<u8> {
    let digits: Vec<u32> = text.chars().filter_map(|digit| digit.to_digit(16)).collect();
    digits
        .chunks_exact(2)
        .map(|pair| (pair[0] * 16 + pair[1]) as u8)
        .collect()
}

/// Creates a PNG of 2 × 2 pixels from its rows, interlaced or not.
fn png_file(color: u8, depth: u8, rows: [&[u8]; 2], interlaced: bool, more: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut chunk = |kind: &[u8; 4], data: &[u8]| {
        let mut crc = flate2::Crc::new();
        crc.update(kind);
        crc.update(data);
        file.extend((data.len() as u32).to_be_bytes());
        file.extend(kind);
        file.extend(data);
        file.extend(crc.sum().to_be_bytes());
    };
    chunk(
        b"IHDR",
        &[0, 0, 0, 2, 0, 0, 0, 2, depth, color, 0, 0, u8::from(interlaced)],
    );
    for (kind, data) in more {
        chunk(kind, data);
    }
    let pixel = rows[0].len() / 2;
    // Adam7 stores the first pixel in its first pass, the second in its sixth, and the second row in its last.
    let lines = if interlaced {
        vec![&rows[0][..pixel], &rows[0][pixel..], rows[1]]
    } else {
        vec![rows[0], rows[1]]
    };
    let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    for line in lines {
        std::io::Write::write_all(&mut packed, &[0]).unwrap();
        std::io::Write::write_all(&mut packed, line).unwrap();
    }
    chunk(b"IDAT", &packed.finish().unwrap());
    chunk(b"IEND", &[]);
    file
}

#[test]
fn every_color_type_and_depth_of_png_is_read_interlaced_or_not() {
    const GRAY: u8 = 0;
    const RGB: u8 = 2;
    const GRAY_ALPHA: u8 = 4;
    const RGBA: u8 = 6;
    for (color, channels) in [(GRAY, 1), (GRAY_ALPHA, 2), (RGB, 3), (RGBA, 4)] {
        for depth in [8, 16] {
            let samples: Vec<u8> = (0..4 * channels * (depth / 8)).map(|at| at * 7 + 1).collect();
            let rows = samples.split_at(samples.len() / 2);
            let expected = if depth == 8 {
                Pixels::U8(samples.clone())
            } else {
                Pixels::U16(
                    samples
                        .as_chunks()
                        .0
                        .iter()
                        .map(|pair| u16::from_be_bytes(*pair))
                        .collect(),
                )
            };
            for interlaced in [false, true] {
                let picture = decode("a.png", &png_file(color, depth, rows.into(), interlaced, &[])).unwrap();
                assert_eq!(picture.channels, channels, "{color} {depth} {interlaced}");
                assert_eq!(picture.pixels, expected, "{color} {depth} {interlaced}");
            }
        }
    }
}

#[test]
fn a_transparent_color_of_a_png_is_converted_to_alpha() {
    let rows: [&[u8]; 2] = [&[1, 2, 3, 4, 5, 6], &[7, 8, 9, 1, 2, 3]];
    let file = png_file(2, 8, rows, false, &[(b"tRNS", &[0, 1, 0, 2, 0, 3])]);
    let picture = decode("a.png", &file).unwrap();
    let expected = vec![1, 2, 3, 0, 4, 5, 6, 255, 7, 8, 9, 255, 1, 2, 3, 0];
    assert_eq!((picture.channels, picture.pixels), (4, Pixels::U8(expected)));
    let deep: [&[u8]; 2] = [&[0, 9, 1, 0], &[0, 9, 255, 255]];
    let file = png_file(0, 16, deep, false, &[(b"tRNS", &[0, 9])]);
    let picture = decode("a.png", &file).unwrap();
    let expected = vec![9, 0, 256, 65535, 9, 0, 65535, 65535];
    assert_eq!((picture.channels, picture.pixels), (2, Pixels::U16(expected)));
}

#[test]
fn cmyk_and_progressive_jpegs_are_read_as_rgb() {
    // Quantization changes the values by a few codes.
    for (name, text, expected, slack) in [
        ("print.jpg", CMYK_JPEG, [255, 0, 0], 6),
        ("scans.jpg", PROGRESSIVE_JPEG, [200, 100, 50], 4),
    ] {
        let picture = decode(name, &from_hexadecimal(text)).unwrap();
        let Pixels::U8(samples) = &picture.pixels else {
            panic!("{name}")
        };
        assert_eq!((picture.width, picture.height, picture.channels), (8, 8, 3), "{name}");
        for (sample, expected) in samples.iter().zip(expected.iter().cycle()) {
            assert!(
                sample.abs_diff(*expected) <= slack,
                "{name}: {sample} is not {expected}"
            );
        }
    }
}

#[test]
fn kinds_of_jpeg_that_are_not_read_are_not_called_damaged() {
    let baseline = from_hexadecimal(CMYK_JPEG);
    let frame = baseline.windows(2).position(|mark| mark == [0xff, 0xc0]).unwrap();
    let told = |marker: u8, precision: u8| {
        let mut file = baseline.clone();
        file[frame + 1] = marker;
        file[frame + 4] = precision;
        decode("a.jpg", &file).unwrap_err().to_string()
    };
    // ITU-T T.81, table B.1, and T.87 for JPEG-LS.
    for (marker, precision, feature) in [
        (0xc1, 12, "it has 12 bits for each sample, which are not read"),
        (0xc3, 8, "it is a lossless JPEG (SOF3), which is not read"),
        (0xc9, 8, "it has arithmetic coding (SOF9), which is not read"),
        (0xca, 8, "it has arithmetic coding (SOF10), which is not read"),
        (0xc5, 8, "it is a hierarchical JPEG (SOF5), which is not read"),
        (0xf7, 8, "it is a JPEG-LS file (SOF55), which is not read"),
    ] {
        let expected = format!("a.jpg cannot be used: {feature}; save it again as a plain JPEG file");
        assert_eq!(told(marker, precision), expected);
        let mut file = baseline.clone();
        (file[frame + 1], file[frame + 4]) = (marker, precision);
        assert_eq!(check_header("a.jpg", &file).unwrap_err().to_string(), expected);
    }
    assert!(
        told(0xc0, 77).starts_with("a.jpg is a damaged JPEG file"),
        "a precision that does not exist"
    );
}

#[test]
fn the_fourth_byte_of_a_tga_is_alpha_unless_it_is_none_and_says_so() {
    // Two pixels from the top left: blue, green, red and a fourth byte, of which so many bits are alpha.
    let file = |bits: u8, alphas: [u8; 2]| {
        let mut file = vec![0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 32, 0x20 | bits];
        file.extend([30, 20, 10, alphas[0], 60, 50, 40, alphas[1]]);
        let picture = decode("a.tga", &file).unwrap();
        (picture.channels, picture.pixels)
    };
    let opaque = (3, Pixels::U8(vec![10, 20, 30, 40, 50, 60]));
    assert_eq!(file(0, [0, 0]), opaque);
    assert_eq!(file(0, [0, 9]), (4, Pixels::U8(vec![10, 20, 30, 0, 40, 50, 60, 9])));
    assert_eq!(file(8, [0, 0]), opaque);
    assert_eq!(file(8, [0, 9]), (4, Pixels::U8(vec![10, 20, 30, 0, 40, 50, 60, 9])));
}

#[test]
fn the_ending_of_the_name_may_lie() {
    let rows: [&[u8]; 2] = [&[1, 2], &[3, 4]];
    let picture = decode("a.jpg", &png_file(0, 8, rows, false, &[])).unwrap();
    assert_eq!(picture.pixels, Pixels::U8(vec![1, 2, 3, 4]));
    assert_eq!(decode("a.tga", &from_hexadecimal(PROGRESSIVE_JPEG)).unwrap().width, 8);
}

#[test]
fn a_declared_size_that_the_file_cannot_contain_is_refused_before_allocation() {
    let mut jpeg = from_hexadecimal(PROGRESSIVE_JPEG);
    let frame = jpeg.windows(2).position(|mark| mark == [0xff, 0xc2]).unwrap();
    jpeg[frame + 5..frame + 9].copy_from_slice(&[0x3f, 0xff, 0x3f, 0xff]);
    let mut tga = vec![0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0x3f, 0xff, 0x3f, 24, 0];
    tga.extend([0xff, 1, 2, 3].repeat(50));
    let mut png = png_file(0, 8, [&[1, 2], &[3, 4]], false, &[]);
    png[16..24].copy_from_slice(&[0, 0, 0x3f, 0xff, 0, 0, 0x3f, 0xff]);
    let mut crc = flate2::Crc::new();
    crc.update(&png[12..29]);
    png[29..33].copy_from_slice(&crc.sum().to_be_bytes());
    for (name, bytes) in [("a.jpg", jpeg), ("a.tga", tga), ("a.png", png)] {
        let error = decode(name, &bytes).unwrap_err().to_string();
        assert!(
            error.contains("(the file ends too early); open and save it again"),
            "{error}"
        );
    }
}

fn layer(name: &str, samples: FlatSamples, encoding: Encoding) -> Layer<AnyChannels<FlatSamples>> {
    let mut list = SmallVec::new();
    for channel in name.split(' ') {
        list.push(AnyChannel::new(channel, samples.clone()));
    }
    let attributes = LayerAttributes::named(name);
    Layer::new((4, 4), attributes, encoding, AnyChannels::sort(list))
}

fn exr_file(layers: Vec<Layer<AnyChannels<FlatSamples>>>) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let attributes = exr::prelude::ImageAttributes::new(exr::prelude::IntegerBounds::from_dimensions((4, 4)));
    let image: Image<exr::image::Layers<AnyChannels<FlatSamples>>> = Image::from_layers(attributes, layers);
    image.write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

#[test]
fn exr_files_of_every_layout_are_read() {
    let values: Vec<f32> = (0..16).map(|at| at as f32 / 4.0).collect();
    let halves = FlatSamples::F16(values.iter().map(|value| f16::from_f32(*value)).collect());
    let floats = FlatSamples::F32(values.clone());
    let lines = |compression| Encoding {
        compression,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let tiles = Encoding {
        blocks: Blocks::Tiles(exr::math::Vec2(3, 3)),
        ..lines(Compression::ZIP16)
    };
    for (kind, layers) in [
        ("half", vec![layer("Y", halves.clone(), lines(Compression::PIZ))]),
        (
            "float",
            vec![layer("Y", floats.clone(), lines(Compression::Uncompressed))],
        ),
        ("runs", vec![layer("Y", floats.clone(), lines(Compression::RLE))]),
        ("tiles", vec![layer("Y", floats.clone(), tiles)]),
        (
            "lossy",
            vec![layer("Y", halves.clone(), lines(Compression::DWAB(None)))],
        ),
    ] {
        let picture = decode("a.exr", &exr_file(layers)).unwrap();
        let Pixels::F32(samples) = &picture.pixels else {
            panic!("{kind}")
        };
        let slack = if kind == "lossy" { 0.1 } else { 0.0 };
        let close = samples
            .iter()
            .zip(&values)
            .all(|(sample, value)| (sample - value).abs() <= slack);
        assert!(close && samples.len() == 16, "{kind}: {samples:?}");
    }
    let depth = layer("Z", FlatSamples::F32(vec![9.0; 16]), lines(Compression::ZIP16));
    let color = layer("R G B", floats, lines(Compression::ZIP16));
    let picture = decode("a.exr", &exr_file(vec![depth, color])).unwrap();
    let expected = values.iter().flat_map(|value| [*value; 3]).collect();
    assert_eq!((picture.channels, picture.pixels), (3, Pixels::F32(expected)));
}

#[test]
fn infinity_and_not_a_number_are_replaced_by_finite_numbers_and_counted() {
    let mut values = vec![1.0; 16];
    values[..3].copy_from_slice(&[f32::NAN, f32::INFINITY, f32::NEG_INFINITY]);
    let picture = decode(
        "a.exr",
        &crate::encode_exr(4, 4, &[("Y", &values)], crate::ExrSamples::Float).unwrap(),
    )
    .unwrap();
    let Pixels::F32(samples) = picture.pixels else {
        panic!("floats")
    };
    assert_eq!(samples[..4], [0.0, 65504.0, -65504.0, 1.0]);
    assert_eq!(
        picture.remarks.values,
        [
            "has 3 pixels with infinite or undefined numbers; infinite ones count as 65504 and undefined ones as 0, so save it again \
             without them"
        ]
    );
    values[..3].fill(2.0);
    let finite = crate::encode_exr(4, 4, &[("Y", &values)], crate::ExrSamples::Float).unwrap();
    assert_eq!(decode("a.exr", &finite).unwrap().remarks, PictureRemarks::default());
}

#[test]
fn deep_images_are_refused_with_their_name() {
    let mut file = exr_file(vec![layer(
        "Y",
        FlatSamples::F32(vec![1.0; 16]),
        Encoding::UNCOMPRESSED,
    )]);
    file[5] |= 0x08;
    let error = decode("a.exr", &file).unwrap_err().to_string();
    assert_eq!(
        error,
        "a.exr cannot be used: it holds deep samples, several for each pixel; save it again as a plain OpenEXR file"
    );
}
