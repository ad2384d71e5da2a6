//! Goldens: a small picture of every result for the eye, and exact statistics in text for everything else.
//!
//! They are made on Mesa's software driver. `cargo xtask bless KIND` writes those of a kind, `cargo xtask bless all` all.

use std::fmt::Write;
use std::path::PathBuf;
use std::{env, fs};

use sabi_color::srgb8_from_linear;
use sabi_export::{Cover, SetLayout, set_keys};
use sabi_graph::PortType;
use sabi_image::{PngData, PngOptions, decode, encode_png, quantize_u8};
use sabi_tests::{NodeResult, OnMesh, project};

use crate::specimens::{Specimen, for_each, on_own_mesh, specimens};

/// Maximum difference of a statistic from the stored value, as a share of the larger of 1 and its size. Half floats differ
/// between processors that multiply and add in one step and those that need two.
const STATISTICS_TOLERANCE: f64 = 1.0 / 1024.0;
/// Largest difference of an 8-bit sample from the stored sample.
const CODE_TOLERANCE: u8 = 1;
/// Maximum share of samples with a larger difference: places where rounding decides between two cells.
const OUTLIERS: f64 = 0.002;

/// Side of a mask's picture.
const MASK_SIZE: u32 = 64;
/// Side of a color's picture, and of each picture of a material.
const COLOR_SIZE: u32 = 32;

/// A picture of 8-bit samples.
struct SamplePicture {
    width: u32,
    height: u32,
    channels: u8,
    codes: Vec<u8>,
}

impl SamplePicture {
    fn png(&self) -> Vec<u8> {
        let options = PngOptions {
            channels: self.channels,
            bits: 8,
            srgb_chunk: false,
        };
        encode_png(self.width, self.height, PngData::U8(&self.codes), options).expect("a picture")
    }

    /// Pictures of one size side by side.
    fn beside(parts: &[Vec<u8>], side: u32, channels: u8) -> SamplePicture {
        let row = side as usize * usize::from(channels);
        let codes = (0..side as usize)
            .flat_map(|y| {
                parts
                    .iter()
                    .flat_map(move |part| part[y * row..][..row].iter().copied())
            })
            .collect();
        SamplePicture {
            width: side * parts.len() as u32,
            height: side,
            channels,
            codes,
        }
    }
}

/// Returns a result in the model's own layout; 0 where there is no chart.
fn in_layout(on_mesh: &OnMesh, values: &[f32]) -> Vec<f32> {
    let layout = SetLayout::new(on_mesh.atlas(), set_keys(on_mesh.atlas())[0]);
    let pixels = layout.source.iter().zip(&layout.cover);
    let value = |(source, cover): (&u32, &Cover)| {
        if *cover == Cover::Owned {
            values[*source as usize]
        } else {
            0.0
        }
    };
    pixels.map(value).collect()
}

/// Three components of a result as 8-bit samples, each passed through `code`.
fn triple(on_mesh: &OnMesh, evaluated: &NodeResult, names: [&str; 3], code: fn(f32) -> u8) -> Vec<u8> {
    let planes = names.map(|name| in_layout(on_mesh, &evaluated.component(name)));
    (0..planes[0].len())
        .flat_map(|pixel| planes.each_ref().map(|plane| code(plane[pixel])))
        .collect()
}

fn signed(value: f32) -> u8 {
    quantize_u8(0.5 + 0.5 * value)
}

/// Picture of a result: a mask in gray; a color; a vector; or a material's base color, its roughness with metallic and
/// occlusion, and its normal if it has a relief.
fn sheet(specimen: &Specimen) -> SamplePicture {
    let size = if specimen.ty == PortType::Mask {
        MASK_SIZE
    } else {
        COLOR_SIZE
    };
    let mut on_mesh = on_own_mesh(&specimen.coarse, "cube", size);
    let evaluated = on_mesh.evaluate(&specimen.target());
    let see = |names, code| triple(&on_mesh, &evaluated, names, code);
    match specimen.ty {
        PortType::Mask => {
            let values = in_layout(&on_mesh, &evaluated.component("mask"));
            SamplePicture::beside(&[values.into_iter().map(quantize_u8).collect()], size, 1)
        }
        PortType::Color => SamplePicture::beside(&[see(["color.r", "color.g", "color.b"], srgb8_from_linear)], size, 3),
        PortType::Vector => SamplePicture::beside(&[see(["vector.x", "vector.y", "vector.z"], signed)], size, 3),
        PortType::Material => {
            let mut parts = vec![
                see(["base_color.r", "base_color.g", "base_color.b"], srgb8_from_linear),
                see(["roughness", "metallic", "occlusion"], quantize_u8),
            ];
            if evaluated.normals.is_some() {
                parts.push(see(["normal.x", "normal.y", "normal.z"], signed));
            }
            SamplePicture::beside(&parts, size, 3)
        }
    }
}

/// Mean, lowest, highest and standard deviation of each component over all texels that charts own at 64².
fn statistics(specimen: &Specimen) -> Vec<(String, [f64; 4])> {
    let mut on_mesh = on_own_mesh(&specimen.coarse, "cube", 64);
    let evaluated = on_mesh.evaluate(&specimen.target());
    let of = |values: &[f32]| {
        let owned: Vec<f64> = on_mesh.owned().map(|(index, _)| f64::from(values[index])).collect();
        let count = owned.len() as f64;
        let mean = owned.iter().sum::<f64>() / count;
        let variance = owned.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count;
        let low = owned.iter().copied().fold(f64::INFINITY, f64::min);
        let high = owned.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        [mean, low, high, variance.sqrt()]
    };
    let components = evaluated.components();
    components
        .iter()
        .map(|(name, values)| (name.clone(), of(values)))
        .collect()
}

fn written(statistics: &[(String, [f64; 4])]) -> String {
    let mut text = String::from("component mean lowest highest deviation\n");
    for (name, numbers) in statistics {
        // Adding 0 turns a −0 around.
        let [mean, low, high, deviation] = numbers.map(|x| (x * 1e6).round() / 1e6 + 0.0);
        writeln!(text, "{name} {mean:.6} {low:.6} {high:.6} {deviation:.6}").expect("a text grows");
    }
    text
}

fn read(text: &str) -> Vec<(String, Vec<f64>)> {
    let line = |line: &str| {
        let mut words = line.split(' ');
        let name = words.next().unwrap_or_default().to_owned();
        (name, words.map(|word| word.parse().unwrap_or(f64::NAN)).collect())
    };
    text.lines().skip(1).map(line).collect()
}

fn hold_statistics(expected: &str, got: &[(String, [f64; 4])]) -> Result<(), String> {
    let expected = read(expected);
    let names = |all: Vec<&String>| all.into_iter().cloned().collect::<Vec<_>>().join(", ");
    let [was, is] = [
        names(expected.iter().map(|(name, _)| name).collect()),
        names(got.iter().map(|(name, _)| name).collect()),
    ];
    if was != is {
        return Err(format!("it had the components {was}; now it has {is}"));
    }
    for ((name, was), (_, is)) in expected.iter().zip(got) {
        for ((what, was), is) in ["mean", "lowest", "highest", "deviation"].iter().zip(was).zip(is) {
            let allowed = STATISTICS_TOLERANCE * was.abs().max(1.0);
            // Written so that no number at all is a difference too.
            let is_close = (was - is).abs() <= allowed;
            if !is_close {
                return Err(format!("the {what} of {name} was {was:.6} and is {is:.6}"));
            }
        }
    }
    Ok(())
}

/// Compares samples. If they differ, writes expected, actual and difference side by side below the folder of pictures.
fn hold_picture(name: &str, expected: &[u8], got: &SamplePicture) -> Result<(), String> {
    let picture = decode("golden.png", expected).map_err(|error| error.to_string())?;
    let sabi_image::Pixels::U8(was) = picture.pixels else {
        return Err("the stored picture has not 8 bits".to_owned());
    };
    if [picture.width, picture.height] != [got.width, got.height] || picture.channels != got.channels {
        return Err("the stored picture has another size".to_owned());
    }
    let far = |(was, is): &(&u8, &u8)| was.abs_diff(**is) > CODE_TOLERANCE;
    let outliers = was.iter().zip(&got.codes).filter(far).count();
    if outliers as f64 <= OUTLIERS * was.len() as f64 {
        return Ok(());
    }
    let difference = was
        .iter()
        .zip(&got.codes)
        .map(|(was, is)| was.abs_diff(*is).saturating_mul(8))
        .collect();
    let row = got.width as usize * usize::from(got.channels);
    let parts = [was, got.codes.clone(), difference];
    let codes = (0..got.height as usize)
        .flat_map(|y| {
            parts
                .iter()
                .flat_map(move |part| part[y * row..][..row].iter().copied())
        })
        .collect();
    let contact = SamplePicture {
        width: 3 * got.width,
        codes,
        ..*got
    };
    let path = format!("{}/{name}.png", pictures());
    let file = project(&path);
    fs::create_dir_all(file.parent().expect("a folder")).expect("the folder of pictures");
    fs::write(&file, contact.png()).expect("the difference");
    Err(format!(
        "{outliers} samples differ; {path} shows expected, got and 8 × the difference"
    ))
}

/// Folder for pictures of what differs, from the root: one for each adapter where there are several.
fn pictures() -> String {
    env::var("SABI_PICTURES").unwrap_or_else(|_| "target/golden".to_owned())
}

fn paths(specimen: &Specimen) -> [PathBuf; 2] {
    ["png", "txt"].map(|ending| project(&format!("tests/golden/{}.{ending}", specimen.name())))
}

/// Returns true for kinds whose goldens are written instead of compared.
fn is_blessed(specimen: &Specimen) -> bool {
    env::var("SABI_BLESS").is_ok_and(|kind| kind == "all" || kind == specimen.kind)
}

#[test]
fn every_result_is_what_its_golden_shows() {
    if let Ok(kind) = env::var("SABI_BLESS") {
        let is_known = kind == "all" || specimens().iter().any(|specimen| specimen.kind == kind);
        assert!(is_known, "there is no node kind '{kind}' to bless");
    }
    for_each(|specimen| {
        let (got, numbers) = (sheet(specimen), statistics(specimen));
        let [picture, text] = paths(specimen);
        if is_blessed(specimen) {
            fs::create_dir_all(picture.parent().expect("a folder")).expect("the folder of goldens");
            fs::write(&picture, got.png()).expect("the golden");
            fs::write(&text, written(&numbers)).expect("its statistics");
            return Ok(());
        }
        let (Ok(picture), Ok(text)) = (fs::read(picture), fs::read_to_string(text)) else {
            return Err(format!(
                "there is no golden; look at the result, and if it is right, make one with `cargo xtask bless {}`",
                specimen.kind
            ));
        };
        let statistics = hold_statistics(&text, &numbers);
        let picture = hold_picture(&specimen.name(), &picture, &got);
        statistics
            .and(picture)
            .map_err(|why| format!("{why}; if the change is meant, `cargo xtask bless {}`", specimen.kind))
    });
}

#[test]
fn every_golden_belongs_to_a_result() {
    let known: Vec<PathBuf> = specimens().iter().flat_map(paths).collect();
    let folders = fs::read_dir(project("tests/golden")).expect("the goldens").flatten();
    let files = folders.flat_map(|folder| fs::read_dir(folder.path()).into_iter().flatten().flatten());
    let unknown: Vec<String> = files
        .map(|file| file.path())
        .filter(|path| !known.contains(path))
        .map(|path| path.display().to_string())
        .collect();
    assert!(unknown.is_empty(), "of kinds that are gone: {}", unknown.join(", "));
}
