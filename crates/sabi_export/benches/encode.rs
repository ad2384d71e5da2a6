//! `cargo bench -p sabi_export` measures the time to encode the files of a texture set of 4096², and their sizes.
//!
//! `cargo bench -p sabi_export -- FOLDER` encodes the maps of an earlier bake again and compares their sizes with those in that folder.

#![allow(clippy::print_stdout, reason = "a bench's table is its output")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot run may stop")]

use std::path::{Path, PathBuf};
use std::time::Instant;
use std::{env, fs};

use rayon::prelude::*;
use sabi_export::{BakeWriter, Channel, ChannelPixels, Cover, SetKey, SetLayout, SetOptions};
use sabi_image::{TransferCurve, decode};

const SIZE: u32 = 4096;
const RUNS: usize = 3;

fn main() {
    let folders: Vec<PathBuf> = env::args()
        .skip(1)
        .map(PathBuf::from)
        .filter(|arg| arg.is_dir())
        .collect();
    println!("file                                        MB    before       ms");
    if folders.is_empty() {
        write_set("made", &made_maps(), None);
    }
    for folder in folders {
        let mut names: Vec<PathBuf> = fs::read_dir(&folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .collect();
        names.sort();
        for file in names {
            if let Some((stem, map)) = earlier_map(&file) {
                write_set(&stem, &[map], Some(&folder));
            }
        }
    }
}

/// Writes maps as one set, and prints for each channel its files and the median time to write all of them.
fn write_set(name: &str, maps: &[(Channel, ChannelPixels)], before: Option<&Path>) {
    let pixels = maps[0].1.data.len() / maps[0].1.components;
    let size = pixels.isqrt();
    let layout = SetLayout {
        key: SetKey {
            material: 0,
            uv_tile: [0, 0],
            udim: None,
        },
        size: size as u32,
        source: (0..pixels as u32).collect(),
        cover: vec![Cover::Owned; pixels],
        shared: Vec::new(),
        collisions: 0,
    };
    let folder = tempfile::tempdir().unwrap();
    for (channel, pixels) in maps {
        let mut times = Vec::new();
        let mut files = Vec::new();
        for _ in 0..RUNS {
            let copy = pixels.clone();
            let mut writer = BakeWriter::create(folder.path()).unwrap();
            let started = Instant::now();
            let written = writer
                .set(&layout, name, &SetOptions::raw().unwrap())
                .channel(channel, copy, true)
                .unwrap();
            times.push(started.elapsed().as_secs_f64() * 1000.0);
            writer.commit().unwrap();
            files = written.outputs;
        }
        times.sort_by(f64::total_cmp);
        for file in &files {
            let bytes = |folder: &Path| fs::metadata(folder.join(&file.path)).unwrap().len() as f64;
            let new = bytes(folder.path());
            let change = before.map_or_else(String::new, |folder| {
                format!("{:+.1} %", (new / bytes(folder) - 1.0) * 100.0)
            });
            let time = if file.path == files[0].path {
                format!("{:8.0}", times[RUNS / 2])
            } else {
                String::new()
            };
            println!("{:38} {:7.2} {change:>9} {time}", file.path, new / 1e6);
        }
    }
}

/// Returns a map of an earlier bake with its channel and the stem of its name; `None` for other files.
fn earlier_map(file: &Path) -> Option<(String, (Channel, ChannelPixels))> {
    let name = file.file_name()?.to_str()?;
    let (stem, ending) = name.rsplit_once('.')?;
    let channel = Channel::ALL
        .into_iter()
        .find(|channel| stem.ends_with(&format!("_{}", channel.name())))?;
    if channel == Channel::Height && ending != "exr" {
        return None;
    }
    let picture = decode(name, &fs::read(file).unwrap()).ok()?;
    let is_color = matches!(
        channel,
        Channel::BaseColor | Channel::Emission | Channel::Sheen | Channel::Subsurface
    );
    let components = channel.components();
    let curve = if is_color && ending == "png" {
        TransferCurve::Srgb
    } else {
        TransferCurve::Linear
    };
    let data = picture.linear_rgba(curve).rgba;
    let is_normal = channel == Channel::Normal;
    let value = |value: &f32| if is_normal { value * 2.0 - 1.0 } else { *value };
    let data = data
        .iter()
        .flat_map(|pixel| pixel[..components].iter().map(value))
        .collect();
    let stem = stem.strip_suffix(&format!("_{}", channel.name()))?.to_owned();
    Some((stem, (channel, ChannelPixels { components, data })))
}

/// Fractal noise: rough, finely colored, and with the normals of its relief.
fn made_maps() -> Vec<(Channel, ChannelPixels)> {
    let map = |channel: Channel, value: &(dyn Fn(u32, u32) -> [f32; 3] + Sync)| {
        let components = channel.components();
        let row = |y: u32| (0..SIZE).flat_map(move |x| value(x, y).into_iter().take(components));
        let data = (0..SIZE).into_par_iter().flat_map_iter(row).collect();
        (channel, ChannelPixels { components, data })
    };
    let height = |x: u32, y: u32| clouds(x, y, 0) * 0.02;
    vec![
        map(Channel::BaseColor, &|x, y| {
            let (light, hue) = (clouds(x, y, 1), clouds(x, y, 2));
            [0.1 + 0.3 * light, 0.08 + 0.2 * light, 0.05 + 0.1 * hue]
        }),
        map(Channel::Roughness, &|x, y| [0.4 + 0.4 * clouds(x, y, 3); 3]),
        map(Channel::Metallic, &|x, y| {
            [if clouds(x, y, 4) > 0.6 { 1.0 } else { 0.0 }; 3]
        }),
        map(Channel::Occlusion, &|x, y| {
            [(0.5 + clouds(x / 4, y / 4, 5)).min(1.0); 3]
        }),
        map(Channel::Height, &|x, y| [height(x, y); 3]),
        map(Channel::Normal, &|x, y| {
            let here = height(x, y);
            let [across, down] = [height(x + 1, y), height(x, y + 1)].map(|there| (there - here) * 400.0);
            let length = (across * across + down * down + 1.0).sqrt();
            [-across / length, down / length, 1.0 / length]
        }),
    ]
}

/// Value noise of eight octaves, 0..1.
fn clouds(x: u32, y: u32, seed: u32) -> f32 {
    let (mut sum, mut share) = (0.0, 0.5);
    for octave in 0..8 {
        let cell = 512 >> octave;
        let corner = |right, below| random(x / cell + right, y / cell + below, seed + 16 * octave);
        let [u, v] = [x, y]
            .map(|at| (at % cell) as f32 / cell as f32)
            .map(|t| t * t * (3.0 - 2.0 * t));
        let [upper, lower] = [0, 1].map(|below| corner(0, below) * (1.0 - u) + corner(1, below) * u);
        sum += share * (upper * (1.0 - v) + lower * v);
        share /= 2.0;
    }
    sum
}

fn random(x: u32, y: u32, seed: u32) -> f32 {
    let mut state = x.wrapping_mul(0x9e37_79b9) ^ y.wrapping_mul(0x85eb_ca6b) ^ seed.wrapping_mul(0xc2b2_ae35);
    state = (state ^ state >> 15).wrapping_mul(0x2c1b_3c6d);
    state = (state ^ state >> 12).wrapping_mul(0x297a_2d39);
    (state ^ state >> 15) as f32 / u32::MAX as f32
}
