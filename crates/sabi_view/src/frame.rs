//! Uniforms of a sample, shared by all shaders of a picture; see `frame.wgsl`.

use bytemuck::Zeroable;
use glam::{Mat4, Vec3};
use sabi_nodes::wgsl_struct;

use crate::camera::Lens;
use crate::lights::lights_of_sample;
use crate::scene::{Light, LightPlace, MOST_LIGHTS, Scene, Shot};
use crate::shadows::{LAYERS, layers_of, shadow_matrices};

wgsl_struct! {
    "view/frame" Light:
    /// A light.
    pub(crate) struct LightRow {
        place: [f32; 4],
        color: [f32; 4],
    }
}

wgsl_struct! {
    "view/frame" FrameUniforms:
    /// Uniforms of one sample of a picture.
    pub(crate) struct FrameUniforms {
        clip_from_view: [[f32; 4]; 4],
        view_from_clip: [[f32; 4]; 4],
        eye: [f32; 4],
        irradiance: [[f32; 4]; 9],
        lights: [LightRow; MOST_LIGHTS],
        shadow_from_view: [[[f32; 4]; 4]; LAYERS],
        ground: [f32; 4],
        backdrop: [f32; 4],
        environment: [f32; 4],
        sample: u32,
        blur: f32,
        texels_of_uv: f32,
        even_density: f32,
        heights: [f32; 2],
        view_from_working: f32,
        openness_size: f32,
    }
}

/// Level of the reflections that a blurred background shows, divided by the last level.
const BLUR: f32 = 0.42;

/// Light of the middle of a studio's backdrop: about 1.5 stops below a gray of 18 % that is lit like the model.
const BACKDROP: f32 = 0.11;

impl FrameUniforms {
    /// Computes the uniforms of one sample of a picture.
    pub(crate) fn new(scene: &Scene<'_>, shot: &Shot, [width, height]: [u32; 2], sample: u32) -> FrameUniforms {
        let lights = &lights_of_sample(scene, shot, sample);
        let aspect = width as f32 / height as f32;
        let [jitter_x, jitter_y] = jitter(sample, shot.samples);
        let shift = Vec3::new(2.0 * jitter_x / width as f32, 2.0 * jitter_y / height as f32, 0.0);
        let clip_from_view = Mat4::from_translation(shift) * shot.camera.clip_from_view(aspect);
        let mut rows = [LightRow::zeroed(); MOST_LIGHTS];
        let mut first_layer = 0;
        for (row, light) in rows.iter_mut().zip(lights) {
            *row = light_row(light, first_layer);
            first_layer += layers_of(light);
        }
        let mut shadow_from_view = [Mat4::IDENTITY.to_cols_array_2d(); LAYERS];
        for (slot, matrix) in shadow_from_view.iter_mut().zip(shadow_matrices(lights)) {
            *slot = matrix.to_cols_array_2d();
        }
        let (sin, cos) = shot.environment_turn_degrees.to_radians().sin_cos();
        let last_level = scene.environment.specular_levels().saturating_sub(1) as f32;
        FrameUniforms {
            clip_from_view: clip_from_view.to_cols_array_2d(),
            view_from_clip: clip_from_view.inverse().to_cols_array_2d(),
            eye: eye_row(shot),
            irradiance: scene.environment.irradiance(),
            lights: rows,
            shadow_from_view,
            ground: scene
                .ground(shot)
                .map_or([0.0, 1.0, 0.0, 0.0], |ground| [ground.height, ground.radius, 0.0, 0.0]),
            // Dividing by the exposure makes the backdrop equally bright in every exposure.
            backdrop: [BACKDROP / shot.exposure_stops.exp2(); 4],
            environment: [cos, sin, shot.environment_strength, last_level],
            sample,
            blur: BLUR * last_level,
            texels_of_uv: scene.model.texels_of_uv,
            even_density: scene.model.median_density,
            heights: shot.height_range,
            view_from_working: scene.model.view_from_working,
            openness_size: scene.model.openness().map_or(0.0, |openness| openness.size),
        }
    }
}

fn eye_row(shot: &Shot) -> [f32; 4] {
    match shot.camera.lens {
        Lens::Perspective => shot.camera.eye().extend(1.0),
        Lens::Orthographic => (-shot.camera.forward()).extend(0.0),
    }
    .to_array()
}

fn light_row(light: &Light, first_layer: usize) -> LightRow {
    let [r, g, b] = light.color;
    let place = match light.place {
        LightPlace::Directional(towards) => Vec3::from(towards).normalize_or(Vec3::Y).extend(0.0),
        LightPlace::Point(place) => Vec3::from(place).extend(1.0),
    };
    LightRow {
        place: place.to_array(),
        color: [r, g, b, first_layer as f32],
    }
}

/// Returns the offset of a sample from the pixel's center in pixels: Halton points with the density of a tent filter of radius 1.
fn jitter(sample: u32, samples: u32) -> [f32; 2] {
    if samples <= 1 {
        return [0.0; 2];
    }
    [halton(sample + 1, 2), halton(sample + 1, 3)].map(tent)
}

/// Maps a uniform number in 0..1 to −1..1 with the density of a tent.
fn tent(uniform: f32) -> f32 {
    if uniform < 0.5 {
        (2.0 * uniform).sqrt() - 1.0
    } else {
        1.0 - (2.0 - 2.0 * uniform).sqrt()
    }
}

fn halton(mut index: u32, base: u32) -> f32 {
    let (mut share, mut sum) = (1.0, 0.0);
    while index > 0 {
        share /= base as f32;
        sum += share * (index % base) as f32;
        index /= base;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_lie_around_the_middle_of_their_pixel() {
        assert_eq!(jitter(0, 1), [0.0; 2]);
        for samples in [16_u32, 64] {
            let all: Vec<[f32; 2]> = (0..samples).map(|sample| jitter(sample, samples)).collect();
            for axis in 0..2 {
                let mean = all.iter().map(|place| place[axis]).sum::<f32>() / samples as f32;
                assert!(mean.abs() < 0.1, "{samples} samples, axis {axis}: {mean}");
                assert!(all.iter().all(|place| place[axis].abs() <= 1.0));
            }
        }
    }
}
