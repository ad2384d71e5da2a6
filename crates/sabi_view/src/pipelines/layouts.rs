//! Bind group layouts.

use super::switches::MAP_BITS;

/// Bind group layouts of the viewport.
pub(crate) struct Layouts {
    /// Values shared by all shaders of a picture.
    pub(crate) frame: wgpu::BindGroupLayout,
    /// Maps of a material.
    pub(crate) material: wgpu::BindGroupLayout,
    /// Table of charts.
    pub(crate) charts: wgpu::BindGroupLayout,
    /// Table of charts and the visibility buffer.
    pub(crate) visibility: wgpu::BindGroupLayout,
    /// Panorama of the environment.
    pub(crate) panorama: wgpu::BindGroupLayout,
    /// One uniform buffer.
    pub(crate) uniform: wgpu::BindGroupLayout,
    /// Two textures that are read with interpolation.
    pub(crate) bloom: wgpu::BindGroupLayout,
    /// Light, the sum of earlier samples, and the bloom.
    pub(crate) display: wgpu::BindGroupLayout,
}

fn entry(binding: u32, ty: wgpu::BindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty,
        count: None,
    }
}

fn uniform(binding: u32) -> wgpu::BindGroupLayoutEntry {
    entry(
        binding,
        wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
    )
}

fn sampled(
    binding: u32,
    sample_type: wgpu::TextureSampleType,
    view_dimension: wgpu::TextureViewDimension,
) -> wgpu::BindGroupLayoutEntry {
    entry(
        binding,
        wgpu::BindingType::Texture {
            sample_type,
            view_dimension,
            multisampled: false,
        },
    )
}

const FILTERABLE: wgpu::TextureSampleType = wgpu::TextureSampleType::Float { filterable: true };
const UNFILTERABLE: wgpu::TextureSampleType = wgpu::TextureSampleType::Float { filterable: false };

const SMOOTH: wgpu::SamplerBindingType = wgpu::SamplerBindingType::Filtering;

/// Returns the entries for the values and the maps of a material, as in `maps.wgsl`.
fn material_entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    let map = |binding| sampled(binding, UNFILTERABLE, wgpu::TextureViewDimension::D2Array);
    let maps = 1..=MAP_BITS.len() as u32;
    std::iter::once(uniform(0)).chain(maps.map(map)).collect()
}

fn bloom_entries() -> [wgpu::BindGroupLayoutEntry; 4] {
    let light = |binding| sampled(binding, FILTERABLE, wgpu::TextureViewDimension::D2);
    let smooth = entry(3, wgpu::BindingType::Sampler(SMOOTH));
    [uniform(0), light(1), light(2), smooth]
}

impl Layouts {
    pub(crate) fn new(device: &wgpu::Device) -> Layouts {
        use wgpu::TextureViewDimension::{Cube, D2, D2Array};
        let layout = |label: &str, entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(label),
                entries,
            })
        };
        let sampler = |binding, kind| entry(binding, wgpu::BindingType::Sampler(kind));
        let depth = |binding, dimension| sampled(binding, wgpu::TextureSampleType::Depth, dimension);
        Layouts {
            frame: layout(
                "picture",
                &[
                    uniform(0),
                    sampler(1, SMOOTH),
                    sampled(2, FILTERABLE, Cube),
                    sampled(3, FILTERABLE, D2),
                    depth(4, D2Array),
                    sampler(5, wgpu::SamplerBindingType::Comparison),
                    sampled(6, FILTERABLE, D2),
                ],
            ),
            material: layout("material", &material_entries()),
            charts: layout("charts", &[sampled(0, UNFILTERABLE, D2)]),
            visibility: layout(
                "visibility",
                &[
                    sampled(0, UNFILTERABLE, D2),
                    sampled(1, wgpu::TextureSampleType::Uint, D2Array),
                    depth(2, D2),
                    sampled(3, UNFILTERABLE, D2Array),
                    sampled(4, UNFILTERABLE, D2),
                ],
            ),
            panorama: layout("panorama", &[sampled(0, FILTERABLE, D2), sampler(1, SMOOTH)]),
            uniform: layout("uniform", &[uniform(0)]),
            bloom: layout("bloom", &bloom_entries()),
            display: layout(
                "display",
                &[
                    uniform(0),
                    sampled(1, UNFILTERABLE, D2),
                    sampled(2, UNFILTERABLE, D2),
                    sampled(3, FILTERABLE, D2),
                    sampler(4, SMOOTH),
                ],
            ),
        }
    }
}
