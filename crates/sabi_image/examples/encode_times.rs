//! Measures the encoding times of maps: `cargo run --release -p sabi_image --example encode_times -- MAP.png MAP.exr…`.
//!
//! Each file is decoded and encoded again in the same format. Times are the best of three runs.

use std::time::{Duration, Instant};

use sabi_image::{
    DeclaredColorSpace, ExrSamples, ImageError, Picture, Pixels, PngData, PngOptions, decode, encode_exr, encode_png,
};

fn encode(picture: &Picture) -> Result<Vec<u8>, ImageError> {
    let (width, height, channels) = (picture.width, picture.height, picture.channels);
    let options = |bits| PngOptions {
        channels,
        bits,
        srgb_chunk: picture.color_space == DeclaredColorSpace::Srgb,
    };
    match &picture.pixels {
        Pixels::U8(samples) => encode_png(width, height, PngData::U8(samples), options(8)),
        Pixels::U16(samples) => encode_png(width, height, PngData::U16(samples), options(16)),
        Pixels::F32(samples) => {
            let plane = |at: usize| samples.iter().skip(at).step_by(usize::from(channels)).copied();
            let planes: Vec<Vec<f32>> = (0..usize::from(channels)).map(|at| plane(at).collect()).collect();
            let names: &[&str] = if channels == 1 { &["Y"] } else { &["R", "G", "B", "A"] };
            let named: Vec<(&str, &[f32])> = names.iter().copied().zip(planes.iter().map(Vec::as_slice)).collect();
            encode_exr(width, height, &named, ExrSamples::Float)
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut total = Duration::ZERO;
    for path in std::env::args().skip(1) {
        let bytes = std::fs::read(&path)?;
        let picture = decode(&path, &bytes)?;
        let mut best = Duration::MAX;
        let mut length = 0;
        for _ in 0..3 {
            let started = Instant::now();
            length = encode(&picture)?.len();
            best = best.min(started.elapsed());
        }
        total += best;
        eprintln!("{path}: {best:?}, {} bytes became {length}", bytes.len());
    }
    eprintln!("together {total:?}");
    Ok(())
}
