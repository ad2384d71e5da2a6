use super::*;

/// Colors of the corners of the images below. The last one is half transparent if the image has alpha.
const CORNERS: [[u8; 3]; 4] = [[200, 40, 30], [20, 180, 60], [30, 50, 210], [240, 240, 240]];

/// 7 × 6 texels in four colors, packed as ETC1S by `basisu -ktx2`. Hexadecimal.
const ETC1S: &str = "\
    ab4b5458203230bb0d0a1a0a000000000100000007000000060000000000000000000000010000000100000001000000680000003c000000\
    a400000024000000c80000000000000098000000000000006001000000000000030000000000000000000000000000003c00000000000000\
    02003800a301020003030000000000000000000000003f000000000000000000ffffffff40003f0f0000000000000000ffffffff1f000000\
    4b545877726974657200426173697320556e6976657273616c20312e3135000006000300350000000d0000002e0000000000000000000000\
    000000000200000002000000010000001c40dc00010000008817940d0830110000000000802c38e001cc0d180000000260a358b8a0084014\
    0000000040881ad8c3610a3c6dfcffffff57555555adaaaaaa0200c144000000000000f2df27880130054000000000806420022204080000\
    0040c23401c004000000000000020800d7052c";

/// The same image by `basisu -ktx2 -uastc`. Hexadecimal.
const UASTC_ZSTANDARD: &str = "\
    ab4b5458203230bb0d0a1a0a000000000100000007000000060000000000000000000000010000000100000002000000680000002c000000\
    940000002400000000000000000000000000000000000000b800000000000000340000000000000040000000000000002c00000000000000\
    02002800a601020003030000000000000000000000007f030000000000000000ffffffff1f0000004b545877726974657200426173697320\
    556e6976657273616c20312e3135000028b52ffd20405d0100f81719c5e37fd0c700978296e77f14f5d74346fa7f224703171e1e1e1074ce\
    010400807040f8cc6208c005";

/// The same image without alpha and not sRGB, by `basisu -ktx2 -uastc -linear -ktx2_no_zstandard`. Hexadecimal.
const UASTC: &str = "\
    ab4b5458203230bb0d0a1a0a000000000100000007000000060000000000000000000000010000000100000000000000680000002c000000\
    940000002c00000000000000000000000000000000000000c000000000000000400000000000000040000000000000002c00000000000000\
    02002800a601010003030000100000000000000000007f000000000000000000ffffffff1f0000004b545877726974657200426173697320\
    556e6976657273616c20312e31350000040000007f7f00001719c5e37fd0c7000000000000000000978296e77f14f5000000000000000000\
    d74346fa7f2247030000000000000000171e1efe1f74ce010000000000000000";

fn from_hexadecimal(text: &str) -> Vec<u8> {
    let digits: Vec<u32> = text.chars().filter_map(|digit| digit.to_digit(16)).collect();
    digits
        .chunks_exact(2)
        .map(|pair| (pair[0] * 16 + pair[1]) as u8)
        .collect()
}

/// Creates a texture of 2 × 2 uncompressed texels of `size` bytes.
fn plain_file(vk_format: u32, scheme: u32, size: u32, level: &[u8]) -> Vec<u8> {
    let mut file = IDENTIFIER.to_vec();
    let descriptor = [0, 0, 44 << 16 | 2, u32::from(TRANSFER_SRGB) << 16 | 1];
    let level_at = 104 + 4 * descriptor.len() as u32;
    let sizes = [vk_format, 1, 2, 2, 0, 0, 1, 1, scheme, 104, 44, 0, 0, 0, 0, 0, 0];
    let index = [level_at, 0, level.len() as u32, 0, size, 0];
    for number in sizes.into_iter().chain(index).chain(descriptor) {
        file.extend(number.to_le_bytes());
    }
    file.extend(level);
    file
}

/// Texels of these textures.
const RGBA: [u8; 16] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];

/// Creates a Zstandard frame (RFC 8878) with one uncompressed block.
fn zstandard_frame(content: &[u8]) -> Vec<u8> {
    let size = content.len() as u8;
    let header = [0x28, 0xb5, 0x2f, 0xfd, 0x20, size, size << 3 | 1, 0, 0];
    [&header, content].concat()
}

fn edited(mut file: Vec<u8>, at: usize, number: u32) -> Vec<u8> {
    file[at..at + 4].copy_from_slice(&number.to_le_bytes());
    file
}

fn said(file: &[u8]) -> String {
    let error = decode_ktx2("a.ktx2", file).unwrap_err();
    assert_eq!(check_ktx2("a.ktx2", file), Err(error.clone()));
    error.to_string()
}

#[test]
fn basis_textures_have_the_expected_colors() {
    for (name, text, tolerance, alpha, declared) in [
        ("ETC1S", ETC1S, 4, 128, DeclaredColorSpace::Srgb),
        ("UASTC, Zstandard", UASTC_ZSTANDARD, 0, 128, DeclaredColorSpace::Srgb),
        ("UASTC", UASTC, 0, 255, DeclaredColorSpace::Linear),
    ] {
        let file = from_hexadecimal(text);
        let picture = crate::decode("a.png", &file).unwrap();
        assert_eq!((picture.width, picture.height, picture.channels), (7, 6, 4), "{name}");
        assert_eq!(picture.color_space, declared, "{name}");
        let Pixels::U8(samples) = picture.pixels else {
            panic!("{name} has 8 bits");
        };
        for (index, pixel) in samples.as_chunks::<4>().0.iter().enumerate() {
            let corner = usize::from(index % 7 >= 4) + 2 * usize::from(index / 7 >= 4);
            for (value, expected) in pixel.iter().zip(CORNERS[corner]) {
                assert!(value.abs_diff(expected) <= tolerance, "{name}: {index} {pixel:?}");
            }
            assert_eq!(pixel[3], if corner == 3 { alpha } else { 255 }, "{name}: {index}");
        }
    }
}

#[test]
fn uncompressed_texels_are_read_with_and_without_zstandard() {
    let rgb = &RGBA[..12];
    for (vk_format, scheme, level, channels, expected) in [
        (37, 0, RGBA.to_vec(), 4, &RGBA[..]),
        (43, 2, zstandard_frame(&RGBA), 4, &RGBA),
        (23, 0, [rgb, &[99; 5]].concat(), 3, rgb),
        (29, 2, zstandard_frame(rgb), 3, rgb),
    ] {
        let picture = decode_ktx2("a.ktx2", &plain_file(vk_format, scheme, expected.len() as u32, &level)).unwrap();
        assert_eq!(picture.channels, channels, "{vk_format}");
        assert_eq!(picture.pixels, Pixels::U8(expected.to_vec()), "{vk_format}");
        assert_eq!(picture.color_space, DeclaredColorSpace::Srgb);
    }
}

#[test]
fn textures_that_are_not_images_are_refused_with_the_reason() {
    let file = || plain_file(37, 0, 16, &RGBA);
    for (file, feature) in [
        (edited(file(), SIZE[2], 2), "it holds several pictures or a volume"),
        (edited(file(), LAYERS, 3), "it holds several pictures or a volume"),
        (edited(file(), FACES, 6), "it holds several pictures or a volume"),
        (edited(file(), SCHEME, 3), "it is compressed in the way 3 of KTX2"),
        (edited(file(), VK_FORMAT, 145), "its texels are of Vulkan's format 145"),
        (
            edited(from_hexadecimal(UASTC), 116, 167),
            "its texels are of the color model 167",
        ),
    ] {
        let sentence = format!("a.ktx2 cannot be used: {feature}; save it again as a plain PNG file");
        assert_eq!(said(&file), sentence);
    }
}

#[test]
fn declared_sizes_are_checked_before_allocation() {
    let damaged = |detail: &str| {
        format!("a.ktx2 is a damaged KTX2 file ({detail}); open and save it again in a paint program, or copy it anew")
    };
    let zstandard = from_hexadecimal(UASTC_ZSTANDARD);
    let contradiction = damaged("the size of its first level contradicts its pixels");
    // More than 4 GiB, and 16 bytes too few.
    assert_eq!(said(&edited(zstandard.clone(), FIRST_LEVEL + 20, 1)), contradiction);
    assert_eq!(said(&edited(zstandard.clone(), FIRST_LEVEL + 16, 48)), contradiction);
    assert_eq!(
        said(&edited(zstandard, FIRST_LEVEL, u32::MAX)),
        damaged("the file ends too early")
    );
    let plain = || plain_file(37, 0, 16, &RGBA);
    assert_eq!(said(&edited(plain(), SIZE[0], 0)), damaged("it has no pixels"));
    assert_eq!(
        said(&edited(plain(), SIZE[0], 3)),
        damaged("its first level ends too early")
    );
    assert!(said(&edited(plain(), SIZE[1], 16385)).contains("claims 2 × 16385 pixels"));
    let short = plain_file(37, 2, 16, &zstandard_frame(&RGBA[..12]));
    let error = decode_ktx2("a.ktx2", &short).unwrap_err().to_string();
    assert_eq!(error, damaged("its first level ends too early"));
    let scattered = edited(from_hexadecimal(ETC1S), GLOBAL_DATA, 300);
    assert_eq!(said(&scattered), damaged("the file ends too early"));
}

#[test]
fn a_truncated_texture_is_an_error() {
    for text in [ETC1S, UASTC_ZSTANDARD, UASTC] {
        let file = from_hexadecimal(text);
        for end in 1..file.len() {
            assert!(
                crate::decode("a.ktx2", &file[..end]).is_err(),
                "{end} of {}",
                file.len()
            );
        }
    }
}
