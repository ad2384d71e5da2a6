//! Reflections of an environment on surfaces of every roughness, compared with integrals over the sphere.

use std::f32::consts::PI;

use glam::{Vec3, vec2, vec3};
use half::f16;
use sabi_tests::device;
use sabi_view::{Environment, Panorama};

/// A prefiltered cube map in memory.
struct Cube {
    /// Texels along a side of a face of the first level.
    side: usize,
    levels: [Vec<Vec3>; LEVELS],
}

/// As an environment has.
const LEVELS: usize = 6;

impl Cube {
    fn of(panorama: &Panorama) -> Cube {
        let bytes = made(panorama);
        let mut values = bytes
            .as_chunks::<2>()
            .0
            .iter()
            .map(|half| f16::from_le_bytes(*half).to_f32());
        let mut texel = || {
            let [r, g, b, a] = std::array::from_fn(|_| values.next().expect("there are as many bytes as texels"));
            assert_eq!(a, 1.0);
            vec3(r, g, b)
        };
        let side: usize = if panorama.width() > 512 { 256 } else { 128 };
        let count = |level: usize| 6 * (side >> level).pow(2);
        let levels = std::array::from_fn(|level| (0..count(level)).map(|_| texel()).collect());
        assert!(values.next().is_none());
        Cube { side, levels }
    }

    /// Texels of a level with their directions.
    fn texels(&self, level: usize) -> impl Iterator<Item = (Vec3, Vec3)> {
        let side = self.side >> level;
        self.levels[level].iter().enumerate().map(move |(at, color)| {
            let place = vec2((at % side) as f32 + 0.5, (at / side % side) as f32 + 0.5) / side as f32 * 2.0 - 1.0;
            (of_face(at / (side * side), place.x, place.y).normalize(), *color)
        })
    }
}

/// Returns the prefiltered bytes of a panorama.
fn made(panorama: &Panorama) -> Vec<u8> {
    let environment = Environment::new(&device(), panorama).expect("it can be made");
    environment.prefiltered_bytes(&device()).expect("it can be read")
}

/// Directions of a cube map's faces as Vulkan has them (Vulkan 1.3, table of cube map faces).
fn of_face(face: usize, s: f32, t: f32) -> Vec3 {
    match face {
        0 => vec3(1.0, -t, -s),
        1 => vec3(-1.0, -t, s),
        2 => vec3(s, 1.0, t),
        3 => vec3(s, -1.0, -t),
        4 => vec3(s, -t, 1.0),
        _ => vec3(-s, -t, -1.0),
    }
}

/// A panorama whose pixels have the color of their direction.
fn panorama([width, height]: [u32; 2], color: impl Fn(Vec3) -> Vec3) -> Panorama {
    let pixel = |at: u32| {
        let place = vec2((at % width) as f32 + 0.5, (at / width) as f32 + 0.5);
        let place = place / vec2(width as f32, height as f32);
        color(Panorama::direction(place)).extend(1.0).to_array()
    };
    let rgba: Vec<_> = (0..width * height).map(pixel).collect();
    Panorama::new(width, height, &rgba).expect("the sizes fit").0
}

#[test]
fn even_light_is_mirrored_evenly_by_every_roughness() {
    for size in [[1, 1], [64, 32], [5, 9]] {
        let cube = Cube::of(&panorama(size, |_| vec3(1.0, 0.25, 60_000.0)));
        for level in 0..LEVELS {
            for (to, color) in cube.texels(level) {
                let error = color / vec3(1.0, 0.25, 60_000.0) - 1.0;
                // Half floats may be truncated instead of rounded, twice.
                assert!(error.abs().max_element() < 2e-3, "level {level}: {color} at {to}");
            }
        }
    }
}

#[test]
fn a_direction_finds_in_the_cube_map_what_the_panorama_has_there() {
    for size in [[256, 128], [1024, 512]] {
        let cube = Cube::of(&panorama(size, |to| 0.5 + 0.5 * to));
        for level in 0..2 {
            for (to, color) in cube.texels(level) {
                let error = (color - (0.5 + 0.5 * to)).abs().max_element();
                assert!(error < 0.02, "level {level}: {color} at {to}");
            }
        }
    }
}

/// Returns the light that a surface of GGX width `alpha` reflects at an angle from a small light whose mean over the sphere
/// is 1. It is divided by the mean of the lobe over all angles, so that uniform light stays uniform.
fn lobe(alpha: f64, cos: f64) -> f64 {
    let shape = |cos: f64| {
        // The half vector lies halfway.
        let squared = 0.5 * (1.0 + cos);
        cos.max(0.0) / (squared * (alpha * alpha - 1.0) + 1.0).powi(2)
    };
    let steps = 20_000;
    let mean = (0..steps)
        .map(|step| shape(2.0 * (f64::from(step) + 0.5) / f64::from(steps) - 1.0))
        .sum::<f64>();
    shape(cos) / (mean / f64::from(steps))
}

#[test]
fn a_sun_of_one_pixel_is_a_smooth_lobe_of_the_right_light() {
    let (width, height) = (512, 256);
    for (column, row) in [(200, 90), (256, 128), (65, 30), (320, 70)] {
        let pixel = vec2(column as f32 + 0.5, row as f32 + 0.5) / vec2(width as f32, height as f32);
        let sun = Panorama::direction(pixel);
        let cube = Cube::of(&panorama([width, height], |to| {
            Vec3::splat(if to.dot(sun) > 0.999_99 { 60_000.0 } else { 0.0 })
        }));
        let step = PI / height as f32;
        let share = ((row as f32 * step).cos() - ((row + 1) as f32 * step).cos()) / (2.0 * width as f32);
        let mean = f64::from(60_000.0 * share);
        for level in 1..LEVELS {
            let roughness = 1.0 - (1.0 - level as f64 / 5.0).sqrt();
            let peak = lobe(roughness.powi(2), 1.0) * mean;
            let mut worst = 0.0f64;
            let (mut light, mut solid) = (0.0, 0.0);
            for (to, color) in cube.texels(level) {
                let expected = lobe(roughness.powi(2), f64::from(to.dot(sun))) * mean;
                worst = worst.max((f64::from(color.x) - expected).abs() / peak);
                let weight = f64::from(to.abs().max_element()).powi(3);
                light += weight * f64::from(color.x);
                solid += weight;
            }
            let light = light / solid / mean;
            println!("roughness {roughness}: off by {worst:.3} of the peak at most, light {light:.3}");
            // A pixel of the sun is as large as a texel, and the narrowest lobe is hardly wider.
            let allowed = if level == 1 { 0.2 } else { 0.06 };
            assert!(worst < allowed, "roughness {roughness}: off by {worst} of the peak");
            assert!((light - 1.0).abs() < 0.035, "roughness {roughness}: light {light}");
        }
    }
}

/// From the middle of the lobe outward, the light never becomes brighter.
#[test]
fn a_strong_sun_leaves_no_speckles() {
    let sun = vec3(0.3, 0.8, 0.5).normalize();
    let cube = Cube::of(&panorama([512, 256], |to| {
        Vec3::splat(if to.dot(sun) > 0.999_97 { 65_504.0 } else { 0.0 })
    }));
    for level in 2..LEVELS {
        let mut texels: Vec<(f32, f32)> = cube.texels(level).map(|(to, color)| (to.dot(sun), color.x)).collect();
        texels.sort_by(|one, other| other.0.total_cmp(&one.0));
        let peak = texels[0].1;
        let (mut least, mut worst) = (f32::INFINITY, 0.0f32);
        for (_, value) in texels {
            worst = worst.max((value - least) / peak);
            least = least.min(value);
        }
        println!("level {level}: brighter by {worst:.3} of the peak outward at most");
        assert!(worst < 0.05, "level {level}: {worst}");
    }
}

#[test]
fn what_is_kept_comes_back_and_what_is_damaged_does_not() {
    let (gpu, panorama) = (device(), panorama([64, 32], |to| 1.0 + to));
    let bytes = made(&panorama);
    assert_eq!(bytes, made(&panorama), "the same light gives the same bytes");
    let kept = Environment::from_prefiltered(&gpu, &panorama, &bytes).expect("it is whole");
    assert_eq!(kept.prefiltered_bytes(&gpu).expect("it can be read"), bytes);
    let up = kept.irradiance_at(Vec3::Y);
    assert!(up.abs_diff_eq(1.0 + 2.0 / 3.0 * Vec3::Y, 2e-3), "{up}");
    let told = |bytes: &[u8]| match Environment::from_prefiltered(&gpu, &panorama, bytes) {
        Ok(_) => String::new(),
        Err(error) => error.to_string(),
    };
    let short = told(&bytes[1..]);
    assert!(
        short.starts_with("the prefiltered environment is damaged (it has"),
        "{short}"
    );
    for value in [f16::NAN, f16::INFINITY, f16::NEG_ONE] {
        let mut odd = bytes.clone();
        odd[2000..2002].copy_from_slice(&value.to_le_bytes());
        assert!(told(&odd).contains("no light"), "{value}");
    }
}
