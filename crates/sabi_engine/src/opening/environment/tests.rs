//! Environments by name and from valid and invalid files of all kinds, and their cache.

use std::fs;
use std::path::Path;

use glam::{Vec3, vec2};
use sabi_image::{PngData, PngOptions, encode_exr, encode_png};
use sabi_view::Panorama;

use super::{BUILT_IN, load_environment, read_panorama};
use crate::ErrorKind;
use sabi_gpu::{AdapterChoice, Gpu};

/// Returns a file in a folder of its own, and its path as text.
fn file(name: &str, bytes: &[u8]) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    let path = path.to_str().unwrap().to_owned();
    (folder, path)
}

/// A Radiance file without run lengths, from the four bytes of each pixel.
fn hdr(width: usize, height: usize, pixels: &[[u8; 4]]) -> Vec<u8> {
    let mut bytes = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    bytes.extend(pixels.as_flattened());
    bytes
}

fn refused(choice: &str) -> (ErrorKind, String) {
    let error = read_panorama(choice).unwrap_err();
    (error.kind, error.to_string())
}

#[test]
fn built_in_environments_are_read_without_a_warning() {
    for (name, _) in BUILT_IN {
        let (panorama, remarks) = read_panorama(name).unwrap();
        assert_eq!((panorama.width(), panorama.height()), (512, 256), "{name}");
        assert!(remarks.is_empty(), "{name}: {remarks:?}");
    }
}

#[test]
fn an_error_for_an_unknown_name_lists_the_known_ones() {
    let (kind, sentence) = refused("studoi");
    assert_eq!(kind, ErrorKind::Usage);
    assert_eq!(
        sentence,
        "there is no environment 'studoi', and no file of that name; Sabi has studio, overcast, low_sun, interior, softboxes; did you mean \
         studio?"
    );
    let (_, sentence) = refused("beach");
    assert!(
        sentence.ends_with("choose one of those, or give the path of a picture"),
        "{sentence}"
    );
    let (kind, sentence) = refused("skies/beach.hdr");
    assert_eq!(kind, ErrorKind::MissingInput);
    assert_eq!(
        sentence,
        "there is no environment skies/beach.hdr; check the path, or choose one of Sabi's own: studio, overcast, low_sun, interior, softboxes"
    );
    let folder = tempfile::tempdir().unwrap();
    let (kind, sentence) = refused(folder.path().to_str().unwrap());
    assert_eq!(kind, ErrorKind::MissingInput);
    assert!(sentence.contains("is a folder"), "{sentence}");
}

#[test]
fn damaged_files_are_errors() {
    let whole = BUILT_IN[0].1;
    let mut claims_much = whole.to_vec();
    let size = b"-Y 256 +X 512";
    let at = claims_much.windows(size.len()).position(|bytes| bytes == size).unwrap();
    claims_much.splice(at..at + size.len(), *b"-Y 99999 +X 199998");
    for (name, bytes) in [
        ("cut.hdr", &whole[..whole.len() / 2]),
        ("head.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 0\n"),
        ("claims.hdr", &claims_much),
        ("empty.hdr", b""),
        ("text.exr", b"this is no picture"),
    ] {
        let (_folder, path) = file(name, bytes);
        let (kind, sentence) = refused(&path);
        assert_eq!(kind, ErrorKind::BadInput, "{sentence}");
        assert!(sentence.contains(name), "{sentence}");
        println!("{}", sentence.rsplit_once(name).unwrap().1);
    }
}

#[test]
fn invalid_light_is_replaced_with_a_warning() {
    let odd = [[f32::NAN, 1.0, -1.0], [1e9, 2.0, 3.0]];
    let channel = |at: usize| odd.map(|pixel: [f32; 3]| pixel[at]);
    let [r, g, b] = [0, 1, 2].map(channel);
    let channels: [(&str, &[f32]); 3] = [("R", &r), ("G", &g), ("B", &b)];
    let (_folder, path) = file(
        "odd.exr",
        &encode_exr(2, 1, &channels, sabi_image::ExrSamples::Float).unwrap(),
    );
    let (panorama, remarks) = read_panorama(&path).unwrap();
    assert_eq!(panorama.rgb(), [[0.0, 1.0, 0.0], [65504.0, 2.0, 3.0]]);
    assert_eq!(remarks.len(), 3, "{remarks:?}");
    assert!(
        remarks[0].contains("odd.exr: 1 pixel of the environment is negative or no number"),
        "{remarks:?}"
    );
    assert!(
        remarks[1].contains("odd.exr: 1 pixel of the environment is brighter than 65504"),
        "{remarks:?}"
    );
}

#[test]
fn infinite_and_undefined_pixels_are_counted() {
    let lone = |odd: f32| {
        let mut red = vec![1.0_f32; 8];
        red[3] = odd;
        let channels: [(&str, &[f32]); 3] = [("R", &red), ("G", &[1.0; 8]), ("B", &[1.0; 8])];
        let exr = encode_exr(4, 2, &channels, sabi_image::ExrSamples::Float).unwrap();
        let (_folder, path) = file("odd.exr", &exr);
        let (panorama, remarks) = read_panorama(&path).unwrap();
        assert!(
            remarks.len() == 1 && remarks[0].contains("odd.exr: it has 1 pixel with infinite or undefined numbers"),
            "{remarks:?}"
        );
        panorama.rgb()[3]
    };
    assert_eq!(lone(f32::INFINITY), [65504.0, 1.0, 1.0]);
    assert_eq!(lone(f32::NAN), [0.0, 1.0, 1.0]);
}

#[test]
fn one_pixel_lights_uniformly_and_an_odd_shape_has_a_warning() {
    let (_folder, path) = file("one.hdr", &hdr(1, 1, &[[64, 128, 255, 130]]));
    let (panorama, remarks) = read_panorama(&path).unwrap();
    assert_eq!(panorama.rgb(), [[1.0, 2.0, 255.0 / 64.0]]);
    assert!(remarks.is_empty(), "{remarks:?}");
    let (_folder, path) = file("square.hdr", &hdr(2, 2, &[[128, 128, 128, 129]; 4]));
    let (panorama, remarks) = read_panorama(&path).unwrap();
    assert_eq!(panorama.rgb(), [[1.0; 3]; 4]);
    assert!(
        remarks[0].contains("square.hdr: the environment has 2 × 2 pixels and is stretched"),
        "{remarks:?}"
    );
}

#[test]
fn a_picture_of_integers_is_srgb_and_has_a_warning() {
    let options = PngOptions {
        channels: 3,
        bits: 8,
        srgb_chunk: false,
    };
    let png = encode_png(2, 1, PngData::U8(&[188, 188, 188, 255, 0, 0]), options).unwrap();
    let (_folder, path) = file("codes.png", &png);
    let (panorama, remarks) = read_panorama(&path).unwrap();
    assert!((panorama.rgb()[0][0] - 0.503).abs() < 0.001, "{:?}", panorama.rgb());
    assert_eq!(panorama.rgb()[1], [1.0, 0.0, 0.0]);
    assert!(remarks[0].contains("no light brighter than white"), "{remarks:?}");
}

#[test]
fn prefiltered_light_is_cached_and_made_again_if_damaged() {
    let install = "this test needs a software Vulkan driver: apt-get install mesa-vulkan-drivers libvulkan1";
    let gpu = Gpu::open(&AdapterChoice::Cpu).expect(install);
    let cache = tempfile::tempdir().unwrap();
    let load = || {
        let (environment, remarks) = load_environment(&gpu, "overcast", Some(cache.path())).unwrap();
        assert!(remarks.is_empty(), "{remarks:?}");
        environment.prefiltered_bytes(&gpu).unwrap()
    };
    let first = load();
    let kept: Vec<_> = fs::read_dir(cache.path().join("light")).unwrap().collect();
    assert_eq!(kept.len(), 1);
    let kept = kept.into_iter().next().unwrap().unwrap().path();
    let whole = fs::read(&kept).unwrap();
    assert_eq!(load(), first);
    let mut flipped = whole.clone();
    *flipped.last_mut().unwrap() ^= 1;
    for damaged in [&whole[..whole.len() - 1], &flipped, b""] {
        fs::write(&kept, damaged).unwrap();
        assert_eq!(load(), first);
        assert!(fs::read(&kept).unwrap() == whole, "it is whole again");
    }
}

/// Returns true if a dark pixel is in a direction or next to it.
fn is_dark(panorama: &Panorama, to: Vec3) -> bool {
    let size = vec2(panorama.width() as f32, panorama.height() as f32);
    let [column, row] = (Panorama::place(to) * size).to_array().map(|at| at as i32);
    let near = (-1..=1).flat_map(|down| (-1..=1).map(move |along| (column + along, row + down)));
    near.into_iter().any(|(column, row)| {
        let column = column.rem_euclid(panorama.width() as i32);
        let row = row.clamp(0, panorama.height() as i32 - 1);
        panorama.rgb()[(row * panorama.width() as i32 + column) as usize][1] < 0.25
    })
}

/// In this picture, dark lines lead from the middle of each side to the positive directions of the other axes.
#[test]
#[ignore = "reads files that SABI_TEST_DATA names"]
fn openexrs_picture_of_axes_has_them_where_its_labels_say() {
    let data = std::env::var_os("SABI_TEST_DATA").expect("SABI_TEST_DATA names the folder of the files");
    let data = Path::new(&data);
    let file = data.join("env/openexr-latlong/OrientationLatLong.exr");
    let (panorama, remarks) = read_panorama(file.to_str().unwrap()).unwrap();
    assert!(remarks.is_empty(), "{remarks:?}");
    for axis in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z] {
        for other in [Vec3::X, Vec3::Y, Vec3::Z] {
            if axis.dot(other) == 0.0 {
                assert!(is_dark(&panorama, axis + 0.06 * other), "from {axis} to {other}");
                assert!(
                    !is_dark(&panorama, axis - 0.06 * other),
                    "from {axis} away from {other}"
                );
            }
        }
    }
}
