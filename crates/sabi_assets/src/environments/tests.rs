//! The committed environments are what the code writes, and light as they are meant to.

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use glam::{DVec3, dvec3};

use super::radiance::encode;
use super::{HEIGHT, MAKERS, WIDTH, direction, luminance, mean_luminance, picture};

/// Made once: each takes a moment.
static PICTURES: LazyLock<Vec<(&str, Vec<DVec3>)>> =
    LazyLock::new(|| MAKERS.map(|(name, light, mean)| (name, picture(light, mean))).into());

#[test]
fn the_committed_environments_are_what_the_code_writes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/environments");
    for (name, pixels) in &*PICTURES {
        let written = encode(WIDTH, pixels);
        assert!(written.len() <= 300 * 1024, "{name}.hdr takes {} bytes", written.len());
        assert!(
            fs::read(folder.join(format!("{name}.hdr"))).unwrap_or_default() == written,
            "{name}.hdr differs from what the code writes: run `cargo xtask assets`."
        );
    }
}

#[test]
fn the_mean_is_as_promised_and_nothing_is_too_bright_or_no_light() {
    for ((name, pixels), (.., mean)) in PICTURES.iter().zip(MAKERS) {
        assert!((mean_luminance(pixels) - mean).abs() < 1e-9, "{name}");
        assert!(pixels.iter().all(|pixel| pixel.is_finite()), "{name}");
        let (low, high) = pixels.iter().fold((f64::MAX, 0.0f64), |(low, high), pixel| {
            (low.min(pixel.min_element()), high.max(pixel.max_element()))
        });
        assert!(low > 0.005 && high < 30_000.0, "{name}: from {low} to {high}");
    }
}

/// Computes the luminance of a matte white surface with this normal.
fn irradiance(pixels: &[DVec3], normal: DVec3) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for (at, pixel) in pixels.iter().enumerate() {
        let (u, v) = ((at % WIDTH) as f64 + 0.5, (at / WIDTH) as f64 + 0.5);
        let to = direction(u / WIDTH as f64, v / HEIGHT as f64);
        let weight = to.dot(normal).max(0.0) * (1.0 - to.y * to.y).sqrt();
        sum += weight * luminance(*pixel);
        total += weight;
    }
    sum / total
}

#[test]
fn light_comes_from_where_it_should() {
    for (name, pixels) in &*PICTURES {
        let at = |x: f64, y: f64, z: f64| irradiance(pixels, dvec3(x, y, z).normalize());
        let (front, back) = (at(0.0, 0.0, 1.0), at(0.0, 0.0, -1.0));
        let (left, right) = (at(-1.0, 0.0, 0.3), at(1.0, 0.0, 0.3));
        let (up, down) = (at(0.0, 1.0, 0.0), at(0.0, -1.0, 0.0));
        println!("{name}: front {front:.2} back {back:.2} left {left:.2} right {right:.2} up {up:.2} down {down:.2}");
        assert!(
            front > 0.6 && front < 2.0,
            "{name} shows what it lights too dark or too bright"
        );
        assert!(up > 1.5 * down, "{name}");
        if *name == "overcast" {
            assert!((left / right - 1.0).abs() < 0.1 && (front / back - 1.0).abs() < 0.1);
        } else {
            assert!(left > 1.3 * right && front > back, "{name}");
        }
    }
}

/// The same numbers come out of a file, by the rules of the format.
#[test]
fn a_file_says_what_the_pixels_are_to_half_a_percent() {
    for (name, pixels) in &*PICTURES {
        let file = encode(WIDTH, pixels);
        let head = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {HEIGHT} +X {WIDTH}\n");
        let mut rest = file.strip_prefix(head.as_bytes()).unwrap();
        for row in pixels.chunks_exact(WIDTH) {
            rest = rest.strip_prefix(&[2, 2, (WIDTH >> 8) as u8, WIDTH as u8]).unwrap();
            let mut channels = [const { Vec::new() }; 4];
            for channel in &mut channels {
                while channel.len() < WIDTH {
                    let count = usize::from(rest[0]);
                    let (bytes, length) = if count > 128 {
                        (vec![rest[1]; count - 128], 2)
                    } else {
                        (rest[1..=count].to_vec(), count + 1)
                    };
                    channel.extend(bytes);
                    rest = &rest[length..];
                }
                assert_eq!(channel.len(), WIDTH);
            }
            for (at, pixel) in row.iter().enumerate() {
                let scale = (f64::from(channels[3][at]) - 136.0).exp2();
                let read = [0, 1, 2].map(|channel| f64::from(channels[channel][at]) * scale);
                let error = (DVec3::from(read) - *pixel).abs().max_element();
                assert!(error <= 0.0045 * pixel.max_element(), "{name}: {read:?} for {pixel}");
            }
        }
        assert!(rest.is_empty());
    }
}
