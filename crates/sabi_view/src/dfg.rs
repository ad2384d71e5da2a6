//! Table of the share of even light that a rough surface mirrors: the second half of the split sum.

use std::f64::consts::PI;
use std::sync::OnceLock;

use half::f16;
use rayon::prelude::*;
use sabi_gpu::Gpu;

use crate::error::ViewError;

/// Entries along a side of the table.
const SIDE: u32 = 128;
/// Circles of the disk of microfacets, and places on half of each.
const CIRCLES: u32 = 16;
const PLACES: u32 = 12;

/// A place on the disk from which visible microfacets are taken: across and along the plane of view, and its share of the
/// disk.
struct Place {
    across: f64,
    along: f64,
    share: f64,
}

/// Places over half of the disk; the other half is its mirror image. Circles grow with the sine, as at the disk's edge
/// microfacets turn fast, and each place has a radius of its own, since the border between light from above and from below
/// the surface may run along a circle. 192 such places are as good as some thousands on a plain grid.
fn places() -> Vec<Place> {
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let place = |circle: u32, at: u32| {
        let step = f64::from(at) + 0.5;
        let angle = 0.5 * PI * (f64::from(circle) + (step * golden).fract()) / f64::from(CIRCLES);
        let (sin, cos) = (PI * (step / f64::from(PLACES) - 0.5)).sin_cos();
        Place {
            across: angle.sin() * cos,
            along: angle.sin() * sin,
            share: (2.0 * angle).sin(),
        }
    };
    let mut places: Vec<_> = (0..CIRCLES * PLACES)
        .map(|at| place(at / PLACES, at % PLACES))
        .collect();
    let total: f64 = places.iter().map(|place| place.share).sum();
    places.iter_mut().for_each(|place| place.share /= total);
    places
}

/// Scale and bias of F0: with Schlick's Fresnel, GGX with Smith's height-correlated masking mirrors `F0 · scale + bias` of
/// light that comes evenly from all around (Karis 2013, Real Shading in Unreal Engine 4). `n_v` is the cosine of the angle
/// at which one looks, above 0; `roughness` is perceptual, the square root of alpha, above 0. Microfacets are taken as often
/// as they are seen (Heitz 2018, Sampling the GGX Distribution of Visible Normals).
fn integrate(places: &[Place], n_v: f64, roughness: f64) -> [f64; 2] {
    let alpha = roughness * roughness;
    let squared = alpha * alpha;
    let view = [(1.0 - n_v * n_v).max(0.0).sqrt(), n_v];
    // The view where the surface is stretched to a half sphere.
    let length = (alpha * view[0]).hypot(view[1]);
    let stretched = [alpha * view[0] / length, view[1] / length];
    let lift = 0.5 * (1.0 + stretched[1]);
    let seen = (squared + (1.0 - squared) * n_v * n_v).sqrt();
    let mut sums = [0.0; 2];
    for Place { across, along, share } in places {
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
            let lit = (squared + (1.0 - squared) * n_l * n_l).sqrt();
            // Masking and shadowing over masking alone.
            let weight = share * n_l * (n_v + seen) / (n_v * lit + n_l * seen);
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
        let places = places();
        let middle = |at: u32| (f64::from(at) + 0.5) / f64::from(SIDE);
        (0..SIDE * SIDE)
            .into_par_iter()
            .map(|at| integrate(&places, middle(at % SIDE), middle(at / SIDE)).map(|value| value as f32))
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
