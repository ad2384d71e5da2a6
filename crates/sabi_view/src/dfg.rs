//! Table of the directional albedo of a rough specular surface: the second half of the split sum.

use std::f64::consts::PI;
use std::sync::OnceLock;

use half::f16;
use rayon::prelude::*;
use sabi_gpu::Gpu;

use crate::error::ViewError;

/// Entries along a side of the table.
const SIDE: u32 = 128;
/// Circles of the disk of microfacets.
const CIRCLES: u32 = 16;
/// Samples on half of each circle.
const CIRCLE_SAMPLES: u32 = 12;

/// Sample of the disk of visible microfacets: across and along the plane of view, and its share of the disk.
struct DiskSample {
    across: f64,
    along: f64,
    share: f64,
}

/// Samples of half of the disk; the other half is its mirror image. Radii grow with the sine, since microfacets turn fast at
/// the disk's edge, and each sample has a radius of its own, since the border between light from above and from below the
/// surface may run along a circle. 192 such samples are as accurate as thousands on a regular grid.
fn disk_samples() -> Vec<DiskSample> {
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let sample = |circle: u32, at: u32| {
        let step = f64::from(at) + 0.5;
        let angle = 0.5 * PI * (f64::from(circle) + (step * golden).fract()) / f64::from(CIRCLES);
        let (sin, cos) = (PI * (step / f64::from(CIRCLE_SAMPLES) - 0.5)).sin_cos();
        DiskSample {
            across: angle.sin() * cos,
            along: angle.sin() * sin,
            share: (2.0 * angle).sin(),
        }
    };
    let mut samples: Vec<_> = (0..CIRCLES * CIRCLE_SAMPLES)
        .map(|at| sample(at / CIRCLE_SAMPLES, at % CIRCLE_SAMPLES))
        .collect();
    let total: f64 = samples.iter().map(|sample| sample.share).sum();
    samples.iter_mut().for_each(|sample| sample.share /= total);
    samples
}

/// Scale and bias of F0: with Schlick's Fresnel, GGX with Smith's height-correlated masking reflects `F0 · scale + bias` of
/// uniform light from all directions (Karis 2013, Real Shading in Unreal Engine 4). `n_v` is the cosine of the view's
/// angle, above 0; `roughness` is perceptual, the square root of alpha, above 0. Microfacets are sampled
/// by their visibility (Heitz 2018, Sampling the GGX Distribution of Visible Normals).
fn integrate(samples: &[DiskSample], n_v: f64, roughness: f64) -> [f64; 2] {
    let alpha = roughness * roughness;
    let squared = alpha * alpha;
    let view = [(1.0 - n_v * n_v).max(0.0).sqrt(), n_v];
    // The view where the surface is stretched to a half sphere.
    let length = (alpha * view[0]).hypot(view[1]);
    let stretched = [alpha * view[0] / length, view[1] / length];
    let lift = 0.5 * (1.0 + stretched[1]);
    let masking = (squared + (1.0 - squared) * n_v * n_v).sqrt();
    let mut sums = [0.0; 2];
    for DiskSample { across, along, share } in samples {
        let level = 1.0 - across * across;
        let up = (1.0 - lift) * level.sqrt() + lift * along;
        let forward = (level - up * up).max(0.0).sqrt();
        // The half vector: stretched back, it has unit length again.
        let half = [
            alpha * (forward * stretched[0] - up * stretched[1]),
            alpha * across,
            (forward * stretched[1] + up * stretched[0]).max(0.0),
        ];
        let length = (half[0] * half[0] + half[1] * half[1] + half[2] * half[2]).sqrt();
        let v_h = (view[0] * half[0] + view[1] * half[2]) / length;
        let n_l = 2.0 * v_h * half[2] / length - n_v;
        if n_l > 0.0 && v_h > 0.0 {
            let shadowing = (squared + (1.0 - squared) * n_l * n_l).sqrt();
            // Masking and shadowing over masking alone.
            let weight = share * n_l * (n_v + masking) / (n_v * shadowing + n_l * masking);
            let fresnel = (1.0 - v_h).powi(5);
            sums[0] += weight * (1.0 - fresnel);
            sums[1] += weight * fresnel;
        }
    }
    sums
}

/// The table, row by row: `n_v` grows along a row and the roughness from row to row; an entry stands for the middle of its
/// square.
fn table() -> &'static [[f32; 2]] {
    static TABLE: OnceLock<Vec<[f32; 2]>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let samples = disk_samples();
        let middle = |at: u32| (f64::from(at) + 0.5) / f64::from(SIDE);
        (0..SIDE * SIDE)
            .into_par_iter()
            .map(|at| integrate(&samples, middle(at % SIDE), middle(at / SIDE)).map(|value| value as f32))
            .collect()
    })
}

/// Scale and bias of F0 by the cosine of the view, along x, and perceptual roughness, along y.
pub(crate) fn dfg_texture(gpu: &Gpu) -> Result<wgpu::Texture, ViewError> {
    let size = wgpu::Extent3d {
        width: SIDE,
        height: SIDE,
        depth_or_array_layers: 1,
    };
    let texture = gpu.guarded("the table of what rough surfaces mirror", |device| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: Some("dfg"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rg16Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        })
    })?;
    let bits: Vec<u16> = table()
        .iter()
        .flatten()
        .map(|value| f16::from_f32(*value).to_bits())
        .collect();
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(4 * SIDE),
        rows_per_image: None,
    };
    gpu.queue()
        .write_texture(texture.as_image_copy(), bytemuck::cast_slice(&bits), layout, size);
    Ok(texture)
}

#[cfg(test)]
mod tests;
