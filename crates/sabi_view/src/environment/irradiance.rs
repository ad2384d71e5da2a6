//! Irradiance of an environment as nine spherical-harmonic coefficients per channel.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::panorama::Panorama;

/// Returns the basis functions of the coefficients of irradiance at a direction of unit length: the spherical harmonics up
/// to the second degree without their factors.
fn basis([x, y, z]: [f64; 3]) -> [f64; 9] {
    [1.0, x, y, z, x * y, y * z, z * x, 3.0 * y * y - 1.0, x * x - z * z]
}

/// Squares of the factors of the harmonics, times the factors of the cosine lobe for each degree: pi, 2 pi / 3 and pi / 4
/// (Ramamoorthi and Hanrahan 2001, An Efficient Representation for Irradiance Environment Maps), divided by pi.
const FACTORS: [f64; 9] = {
    let degree_1 = 3.0 / (4.0 * PI) * 2.0 / 3.0;
    let degree_2 = 15.0 / (4.0 * PI) / 4.0;
    [
        1.0 / (4.0 * PI),
        degree_1,
        degree_1,
        degree_1,
        degree_2,
        degree_2,
        degree_2,
        degree_2 / 12.0,
        degree_2 / 4.0,
    ]
};
/// Degree of each basis function.
const DEGREES: [i32; 9] = [0, 1, 1, 1, 2, 2, 2, 2, 2];

/// Coefficients, each of which is a color.
pub(super) type Coefficients = [DVec3; 9];

/// Returns irradiance divided by pi, the radiance of a white diffuse surface, at a normal of unit length.
pub(super) fn evaluate(coefficients: &Coefficients, normal: Vec3) -> DVec3 {
    let basis = basis(normal.to_array().map(f64::from));
    basis
        .iter()
        .zip(coefficients)
        .map(|(basis, color)| *basis * *color)
        .sum()
}

/// Returns the irradiance of a panorama, which is nowhere negative. With strong light from one side, the expansion alone would be negative
/// on the far side. In that case higher degrees are damped by the smallest amount that prevents it, after Sloan 2008, Stupid Spherical
/// Harmonics Tricks: the square of the Laplacian is minimized along with the error. The mean is not changed.
pub(super) fn irradiance(panorama: &Panorama) -> Coefficients {
    let plain = projected(panorama);
    if lowest(&plain) >= 0.0 {
        return plain;
    }
    // The loop ends, since degree 1 alone is negative only if its amplitude is more than twice the mean, which is impossible for light.
    let (mut low, mut high) = (0.0, 1.0);
    while lowest(&damped(&plain, high)) < 0.0 && high < 1e6 {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if lowest(&damped(&plain, middle)) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    damped(&plain, high)
}

fn damped(coefficients: &Coefficients, strength: f64) -> Coefficients {
    let mut damped = *coefficients;
    for (color, degree) in damped.iter_mut().zip(DEGREES) {
        let laplacian = f64::from(degree * (degree + 1));
        *color /= 1.0 + strength * laplacian * laplacian;
    }
    damped
}

/// Returns the lowest value of any channel: the lowest of many directions, refined by descent.
fn lowest(coefficients: &Coefficients) -> f64 {
    const DIRECTIONS: u32 = 1024;
    let golden = PI * (3.0 - 5f64.sqrt());
    let spiral = (0..DIRECTIONS).map(|at| {
        let y = 1.0 - (2.0 * f64::from(at) + 1.0) / f64::from(DIRECTIONS);
        let (sin, cos) = (golden * f64::from(at)).sin_cos();
        let level = (1.0 - y * y).sqrt();
        (Vec3::new((level * sin) as f32, y as f32, (level * cos) as f32)).normalize()
    });
    let mut low = [(f64::INFINITY, Vec3::Y); 3];
    for normal in spiral {
        let color = evaluate(coefficients, normal).to_array();
        for (low, value) in low.iter_mut().zip(color) {
            if value < low.0 {
                *low = (value, normal);
            }
        }
    }
    let channels = low.into_iter().enumerate();
    let downhill = channels.map(|(channel, (mut value, mut normal))| {
        let mut stride = 0.1;
        while stride > 1e-4 {
            let (side, up) = normal.any_orthonormal_pair();
            let steps = [side, -side, up, -up].map(|step| (normal + stride * step).normalize());
            let lower = steps
                .map(|step| (evaluate(coefficients, step)[channel], step))
                .into_iter()
                .min_by(|one, other| one.0.total_cmp(&other.0));
            match lower {
                Some(lower) if lower.0 < value => (value, normal) = lower,
                _ => stride *= 0.5,
            }
        }
        value
    });
    downhill.fold(f64::INFINITY, f64::min)
}

/// Returns the coefficients of a panorama. Integrals over pixels are exact, since both the harmonics and the area of the
/// sphere are products of a function of the latitude and one of the longitude. Rows are added from the top, so that the sum
/// does not depend on threads.
fn projected(panorama: &Panorama) -> Coefficients {
    let width = f64::from(panorama.width());
    let columns: Vec<[f64; 5]> = (0..panorama.width())
        .map(|column| {
            let [west, east] = [0.0, 1.0].map(|side| PI * (1.0 - 2.0 * (f64::from(column) + side) / width));
            let between = |integral: fn(f64) -> f64| integral(west) - integral(east);
            [
                between(|longitude| longitude),
                between(|longitude| -longitude.cos()),
                between(f64::sin),
                between(|longitude| 0.5 * longitude.sin().powi(2)),
                between(|longitude| -0.5 * (2.0 * longitude).sin()),
            ]
        })
        .collect();
    let row = |(row, pixels): (usize, &[[f32; 3]])| {
        let mut sums = [DVec3::ZERO; 5];
        for (pixel, column) in pixels.iter().zip(&columns) {
            let color = Vec3::from(*pixel).as_dvec3();
            for (sum, share) in sums.iter_mut().zip(column) {
                *sum += *share * color;
            }
        }
        let [north, south] = [0.0, 1.0].map(|side| PI * (0.5 - (row as f64 + side) / f64::from(panorama.height())));
        of_row(sums, north, south)
    };
    let rows: Vec<Coefficients> = panorama
        .rgb()
        .par_chunks(panorama.width() as usize)
        .enumerate()
        .map(row)
        .collect();
    let mut total = [DVec3::ZERO; 9];
    for row in rows {
        for ((total, own), factor) in total.iter_mut().zip(row).zip(FACTORS) {
            *total += factor * own;
        }
    }
    total
}

/// Returns the integrals of a row's light times the basis. The arguments are the integrals along the row of 1, the sine and
/// the cosine of the longitude, their product, and the difference of their squares.
fn of_row([plain, sine, cosine, product, difference]: [DVec3; 5], north: f64, south: f64) -> Coefficients {
    let between = |integral: fn(f64) -> f64| integral(north) - integral(south);
    let level = between(f64::sin);
    let squared = between(|latitude| 0.5 * (latitude + latitude.sin() * latitude.cos()));
    let cubed = between(|latitude| latitude.sin() - latitude.sin().powi(3) / 3.0);
    let up = between(|latitude| 0.5 * latitude.sin().powi(2));
    let up_squared = between(|latitude| -latitude.cos().powi(3) / 3.0);
    let polar = between(|latitude| latitude.sin().powi(3) - latitude.sin());
    [
        level * plain,
        squared * sine,
        up * plain,
        squared * cosine,
        up_squared * sine,
        up_squared * cosine,
        cubed * product,
        polar * plain,
        cubed * difference,
    ]
}

#[cfg(test)]
mod tests {
    use glam::vec2;

    use super::*;

    fn panorama([width, height]: [u32; 2], color: impl Fn(Vec3) -> [f32; 3]) -> Panorama {
        let pixel = |at: u32| {
            let place = vec2((at % width) as f32 + 0.5, (at / width) as f32 + 0.5);
            let [r, g, b] = color(Panorama::direction(place / vec2(width as f32, height as f32)));
            [r, g, b, 1.0]
        };
        let rgba: Vec<_> = (0..width * height).map(pixel).collect();
        Panorama::new(width, height, &rgba).unwrap().0
    }

    fn normals() -> impl Iterator<Item = Vec3> {
        let place = |at: u32| vec2((at as f32 * 0.618_034).fract(), (at as f32 + 0.5) / 20_000.0);
        (0..20_000).map(move |at| Panorama::direction(place(at)))
    }

    #[test]
    fn uniform_light_gives_uniform_irradiance() {
        for size in [[1, 1], [3, 2], [64, 32], [201, 77]] {
            let coefficients = irradiance(&panorama(size, |_| [1.0, 0.5, 40.0]));
            for normal in normals().step_by(50) {
                let error = evaluate(&coefficients, normal) / DVec3::new(1.0, 0.5, 40.0) - 1.0;
                assert!(error.abs().max_element() < 1e-5, "{size:?}: {error} at {normal}");
            }
        }
    }

    /// A hemisphere that shines gives a normal the share (1 + cos) / 2. The second degree contributes nothing.
    #[test]
    fn light_from_one_hemisphere_agrees_with_its_closed_form() {
        for axis in [Vec3::X, Vec3::NEG_Y, Vec3::Z] {
            let coefficients = irradiance(&panorama([256, 128], |to| [f32::from(to.dot(axis) > 0.0); 3]));
            for normal in normals().step_by(50) {
                let expected = 0.5 + 0.5 * f64::from(normal.dot(axis));
                let error = evaluate(&coefficients, normal).x - expected;
                assert!(error.abs() < 1e-3, "{axis}: {error} at {normal}");
            }
        }
    }

    #[test]
    fn a_low_strong_sun_gives_no_negative_irradiance() {
        let sun = Vec3::new(0.8, 0.1, -0.5).normalize();
        let sky = panorama([512, 256], |to| {
            let sun = if to.dot(sun) > 0.9995 { 20_000.0 } else { 0.0 };
            [0.2 + sun, 0.3 + 0.7 * sun, 0.5 + 0.4 * sun]
        });
        assert!(lowest(&projected(&sky)) < -0.1);
        let coefficients = irradiance(&sky);
        let least = normals().map(|normal| evaluate(&coefficients, normal).min_element());
        let least = least.fold(f64::INFINITY, f64::min);
        let mean = coefficients[0].min_element();
        assert!(
            (-1e-6 * mean..0.02 * mean).contains(&least),
            "{least} of a mean of {mean}"
        );
        let brightest = normals().max_by(|one, other| {
            let red = |normal| evaluate(&coefficients, normal).x;
            red(*one).total_cmp(&red(*other))
        });
        assert!(brightest.unwrap().dot(sun) > 0.99);
        assert_eq!(coefficients[0], projected(&sky)[0], "the mean is kept");
    }

    #[test]
    fn soft_light_is_not_damped() {
        let sky = panorama([64, 32], |to| {
            [1.0 + 0.5 * to.y, 1.0 + 0.3 * to.x * to.z, 1.0 + 0.2 * to.z]
        });
        assert_eq!(irradiance(&sky), projected(&sky));
    }
}
