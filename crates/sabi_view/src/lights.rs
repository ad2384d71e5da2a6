//! Lights in a sample of a picture, and the lights of a studio.

use glam::Vec3;

use crate::scene::{Light, LightPlace, MOST_LIGHTS, Scene, Shot};

/// Strength of the environment when it is used with the lights of a studio. It fills the shadows.
pub const STUDIO_ENVIRONMENT_STRENGTH: f32 = 0.6;

/// Key and rim light of a studio, fixed relative to the camera: from the left above, and from behind.
pub const STUDIO_LIGHTS: [Light; 2] = [
    Light {
        place: LightPlace::Directional([-0.573, 0.574, 0.586]),
        color: [2.3, 2.2, 2.1],
        has_shadow: true,
        size_degrees: 9.0,
        follows_camera: true,
    },
    Light {
        place: LightPlace::Directional([0.643, 0.5, -0.58]),
        color: [2.0, 2.15, 2.4],
        has_shadow: true,
        size_degrees: 14.0,
        follows_camera: true,
    },
];

/// Returns the lights of a scene in a sample. Lights that follow the camera are turned with it. Each light is moved to a point of its
/// disc, so that the mean of the samples has soft shadows. In a picture of one sample all lights are at the middles of their discs.
pub(crate) fn lights_of_sample(scene: &Scene<'_>, shot: &Shot, sample: u32) -> Vec<Light> {
    let lights = &scene.lights[..scene.lights.len().min(MOST_LIGHTS)];
    let placed = |light: &Light| {
        let light = match light.follows_camera {
            true => light.turned(shot.camera.yaw_degrees),
            false => *light,
        };
        match light.place {
            LightPlace::Directional(towards) => Light {
                place: LightPlace::Directional(on_disc(towards, light.size_degrees, sample)),
                ..light
            },
            LightPlace::Point(_) => light,
        }
    };
    lights.iter().map(placed).collect()
}

/// Returns true if a light of the scene has a different position in each sample.
pub(crate) fn move_between_samples(scene: &Scene<'_>, shot: &Shot) -> bool {
    shot.samples > 1 && scene.lights.iter().any(|light| light.size_degrees > 0.0)
}

/// Returns the direction to a point of the disc of a far light: the middle in the first sample, then points that fill the disc evenly.
fn on_disc(towards: [f32; 3], size_degrees: f32, sample: u32) -> [f32; 3] {
    let middle = Vec3::from(towards).normalize_or(Vec3::Y);
    if sample == 0 || size_degrees <= 0.0 {
        return middle.to_array();
    }
    // The sequence of the plastic number (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
    let share = |step: f64| (0.5 + f64::from(sample) * step).fract() as f32;
    let radius = share(0.754_877_666_246_693).sqrt() * (0.5 * size_degrees).to_radians().tan();
    let (sin, cos) = (share(0.569_840_290_998_053) * std::f32::consts::TAU).sin_cos();
    let (side, up) = middle.any_orthonormal_pair();
    (middle + (side * cos + up * sin) * radius).normalize().to_array()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_of_a_light_fill_its_disc_around_its_middle() {
        let middle = Vec3::new(0.3, 0.8, -0.2).normalize();
        assert!(Vec3::from(on_disc(middle.to_array(), 10.0, 0)).abs_diff_eq(middle, 1e-6));
        let samples: Vec<Vec3> = (1..=64)
            .map(|sample| on_disc(middle.to_array(), 10.0, sample).into())
            .collect();
        let angle = |at: &Vec3| at.dot(middle).clamp(-1.0, 1.0).acos().to_degrees();
        assert!(samples.iter().all(|at| angle(at) <= 5.001));
        assert!(
            samples.iter().filter(|at| angle(at) > 3.5).count() > 20,
            "half of the area is far out"
        );
        let mean = samples.iter().sum::<Vec3>() / samples.len() as f32;
        assert!(angle(&mean.normalize()) < 0.4);
    }
}
