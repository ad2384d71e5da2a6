//! Table of the directional albedo of a rough specular surface (the second half of the split sum) and of a sheen.

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

/// Entries along a side of the table of a sheen. It is coarser, since a sheen changes slowly.
const SHEEN_SIDE: u32 = 32;
/// Number of light directions above the surface over which a sheen is summed: from the horizon up, and around half of it.
const SHEEN_SAMPLES: [u32; 2] = [48, 32];

/// Sample of the disk of visible microfacets: position across and along the plane of view, and its share of the disk.
struct DiskSample {
    across: f64,
    along: f64,
    share: f64,
}

/// Returns samples of half of the disk; the other half is its mirror image. Radii grow with the sine, since microfacets change their
/// direction quickly near the disk's edge. Each sample has its own radius, since the border between light from above and from below the
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

/// Returns scale and bias of F0: with Schlick's Fresnel, GGX with Smith's height-correlated masking reflects `F0 · scale +
/// bias` of uniform light from all directions (Karis 2013, Real Shading in Unreal Engine 4). `n_v` is the cosine of the
/// view's angle, above 0. `roughness` is perceptual, the square root of alpha, above 0. Microfacets are sampled by their
/// visibility (Heitz 2018, Sampling the GGX Distribution of Visible Normals).
fn integrate(samples: &[DiskSample], n_v: f64, roughness: f64) -> [f64; 2] {
    let alpha = roughness * roughness;
    let squared = alpha * alpha;
    let view = [(1.0 - n_v * n_v).max(0.0).sqrt(), n_v];
    // The view direction in the space in which the surface is stretched to a half sphere.
    let length = (alpha * view[0]).hypot(view[1]);
    let stretched = [alpha * view[0] / length, view[1] / length];
    let lift = 0.5 * (1.0 + stretched[1]);
    let masking = (squared + (1.0 - squared) * n_v * n_v).sqrt();
    let mut sums = [0.0; 2];
    for DiskSample { across, along, share } in samples {
        let level = 1.0 - across * across;
        let up = (1.0 - lift) * level.sqrt() + lift * along;
        let forward = (level - up * up).max(0.0).sqrt();
        // The half vector. Stretched back, it has unit length again.
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
            // Masking and shadowing, divided by masking alone.
            let weight = share * n_l * (n_v + masking) / (n_v * shadowing + n_l * masking);
            let fresnel = (1.0 - v_h).powi(5);
            sums[0] += weight * (1.0 - fresnel);
            sums[1] += weight * fresnel;
        }
    }
    sums
}

/// Returns the share of uniform light from all directions that a sheen of white fibers reflects: the distribution of
/// Estevez and Kulla 2017, "Production friendly microfacet sheen BRDF", with the masking of Neubelt and Pettineo 2013,
/// "Crafting a next-gen material pipeline", as in `view/finish.wgsl`. Arguments as in [`integrate`].
fn integrate_sheen(n_v: f64, roughness: f64) -> f64 {
    let power = 1.0 / (roughness * roughness).max(0.005);
    let n_v = n_v.max(1e-3);
    let sin_v = (1.0 - n_v * n_v).max(0.0).sqrt();
    let [heights, turns] = SHEEN_SAMPLES;
    let middle = |at: u32, of: u32| (f64::from(at) + 0.5) / f64::from(of);
    let mut sum = 0.0;
    for (up, around) in (0..heights).flat_map(|up| (0..turns).map(move |around| (up, around))) {
        let n_l = middle(up, heights);
        let forward = (1.0 - n_l * n_l).sqrt() * (PI * middle(around, turns)).cos();
        let v_l = sin_v * forward + n_v * n_l;
        // Cosine for the half vector. The divisor is the length of the sum of both directions.
        let cos = ((n_l + n_v) / (2.0 + 2.0 * v_l).sqrt()).min(1.0);
        let facets = (2.0 + power) * (1.0 - cos * cos).max(1e-6).powf(0.5 * power) / (2.0 * PI);
        sum += facets / (4.0 * (n_l + n_v - n_l * n_v)) * n_l;
    }
    (sum * 2.0 * PI / f64::from(heights * turns)).min(1.0)
}

/// Interpolates a value of a square table from four of its entries. Entries are values at the middles of their squares.
fn between(table: &[f64], side: u32, x: f64, y: f64) -> f64 {
    let corner = |at: f64| (at * f64::from(side) - 0.5).clamp(0.0, f64::from(side - 1));
    let (x, y) = (corner(x), corner(y));
    let entry = |column: f64, row: f64| {
        let last = f64::from(side - 1);
        table[(row.min(last) as usize) * side as usize + column.min(last) as usize]
    };
    let row = |row: f64| {
        let (left, right) = (entry(x.floor(), row), entry(x.floor() + 1.0, row));
        left + (right - left) * x.fract()
    };
    let (top, bottom) = (row(y.floor()), row(y.floor() + 1.0));
    top + (bottom - top) * y.fract()
}

/// Returns the table, row by row: `n_v` grows along a row and the roughness from row to row. An entry is the value at the
/// middle of its square.
fn table() -> &'static [[f32; 3]] {
    static TABLE: OnceLock<Vec<[f32; 3]>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let samples = disk_samples();
        let middle = |at: u32, side: u32| (f64::from(at) + 0.5) / f64::from(side);
        let sheen: Vec<f64> = (0..SHEEN_SIDE * SHEEN_SIDE)
            .into_par_iter()
            .map(|at| integrate_sheen(middle(at % SHEEN_SIDE, SHEEN_SIDE), middle(at / SHEEN_SIDE, SHEEN_SIDE)))
            .collect();
        let entry = |at: u32| {
            let (n_v, roughness) = (middle(at % SIDE, SIDE), middle(at / SIDE, SIDE));
            let [scale, bias] = integrate(&samples, n_v, roughness);
            [scale, bias, between(&sheen, SHEEN_SIDE, n_v, roughness)].map(|value| value as f32)
        };
        (0..SIDE * SIDE).into_par_iter().map(entry).collect()
    })
}

/// Returns scale and bias of F0, and the albedo of a sheen, by the cosine of the view's angle along x, and perceptual roughness along y.
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
            format: wgpu::TextureFormat::Rgba16Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        })
    })?;
    let bits: Vec<u16> = table()
        .iter()
        .flat_map(|[scale, bias, sheen]| [*scale, *bias, *sheen, 1.0])
        .map(|value| f16::from_f32(value).to_bits())
        .collect();
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(8 * SIDE),
        rows_per_image: None,
    };
    gpu.queue()
        .write_texture(texture.as_image_copy(), bytemuck::cast_slice(&bits), layout, size);
    Ok(texture)
}

#[cfg(test)]
mod tests;
