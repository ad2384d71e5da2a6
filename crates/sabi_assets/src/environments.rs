//! The project's own environments: what stands around a model to light it, written as Radiance HDR.
//!
//! Latitude by longitude: the top row looks to +Y, the middle to +Z, a quarter of the way from the left to +X. Models face
//! +Z and are seen from there: what is at +Z is in front of them and behind the camera.

mod clouds;
mod interior;
mod lamps;
mod low_sun;
mod overcast;
mod radiance;
mod softboxes;
mod studio;
#[cfg(test)]
mod tests;

use std::f64::consts::PI;

use glam::{DVec3, dvec3};

use xtask::project::{Project, TaskError, create_folder, write_file};

const WIDTH: usize = 512;
const HEIGHT: usize = 256;
/// Places along a pixel's side that it is the mean of.
const PLACES: usize = 3;

/// Linear light from a direction of unit length, in sRGB's primaries; its scale does not matter.
type LightFunction = fn(DVec3) -> DVec3;

/// Every environment, and how bright its mean is: 1 shows a surface of 18 % at about 18 % from most sides.
const MAKERS: [(&str, LightFunction, f64); 5] = [
    ("studio", studio::light, 0.75),
    ("overcast", overcast::light, 1.0),
    ("low_sun", low_sun::light, 0.75),
    ("interior", interior::light, 0.8),
    ("softboxes", softboxes::light, 0.75),
];

/// Writes all of them into the project.
pub(crate) fn write_all(project: &Project) -> Result<(), TaskError> {
    let folder = project.root.join("assets/environments");
    for (name, light, mean) in MAKERS {
        let file = folder.join(format!("{name}.hdr"));
        let bytes = radiance::encode(WIDTH, &picture(light, mean));
        create_folder(&folder)?;
        write_file(&file, &bytes)?;
        eprintln!(
            "{}: {WIDTH} × {HEIGHT} pixels, {} KiB",
            file.display(),
            bytes.len().div_ceil(1024)
        );
    }
    Ok(())
}

/// Rec. 709 luminance.
fn luminance(color: DVec3) -> f64 {
    color.dot(dvec3(0.2126, 0.7152, 0.0722))
}

/// Pixels row by row from the top, scaled so that the mean luminance over the sphere is `mean`.
fn picture(light: LightFunction, mean: f64) -> Vec<DVec3> {
    let pixel = |at: usize| {
        let place = |sample: usize| {
            let inside = |at: usize| (at as f64 + 0.5) / PLACES as f64;
            let u = ((at % WIDTH) as f64 + inside(sample % PLACES)) / WIDTH as f64;
            let v = ((at / WIDTH) as f64 + inside(sample / PLACES)) / HEIGHT as f64;
            light(direction(u, v))
        };
        (0..PLACES * PLACES).map(place).sum::<DVec3>() / (PLACES * PLACES) as f64
    };
    let mut pixels: Vec<DVec3> = (0..WIDTH * HEIGHT).map(pixel).collect();
    let scale = mean / mean_luminance(&pixels);
    pixels.iter_mut().for_each(|pixel| *pixel *= scale);
    pixels
}

/// The direction at a place from 0 to 1 from the left and from the top.
fn direction(u: f64, v: f64) -> DVec3 {
    let ((sin, cos), latitude) = ((PI * (1.0 - 2.0 * u)).sin_cos(), PI * (0.5 - v));
    dvec3(sin * latitude.cos(), latitude.sin(), cos * latitude.cos())
}

/// Over the sphere.
fn mean_luminance(pixels: &[DVec3]) -> f64 {
    let step = PI / HEIGHT as f64;
    let row = |(row, pixels): (usize, &[DVec3])| {
        let share = ((step * row as f64).cos() - (step * (row + 1) as f64).cos()) / (2 * WIDTH) as f64;
        share * pixels.iter().map(|pixel| luminance(*pixel)).sum::<f64>()
    };
    pixels.chunks_exact(WIDTH).enumerate().map(row).sum()
}

/// 0 below `low`, 1 above `high`, smooth between; the other way around where `low` is higher.
fn smooth(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
