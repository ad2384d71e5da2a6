//! Reflections of an environment for surfaces of every roughness, prefiltered once on the device.

use std::f32::consts::PI;

use glam::{Vec3, Vec4, vec3};
use sabi_gpu::{Gpu, shader_module};
use sabi_nodes::wgsl_struct;

use super::panorama::Panorama;
use crate::error::ViewError;
use crate::shaders::ViewShader;

/// Levels of roughness, see [`roughness_of`].
pub(super) const LEVELS: u32 = 6;
/// Number of light directions for each level; 0 for the first level, which is not filtered. Rougher levels have wider lobes
/// and fewer texels.
const DIRECTIONS: [u32; LEVELS as usize] = [0, 128, 512, 1024, 2048, 4096];
/// Texels along a side of a workgroup.
pub(crate) const GROUP: u32 = 8;
/// Samples of the panorama along a side of a texel.
const SAMPLES: u32 = 4;

wgsl_struct! {
    "view/cube" CubePass:
    /// Constants of one pass over the faces of a level.
    pub(crate) struct CubePass {
        side: u32,
        count: u32,
        lod: f32,
        pad: u32,
    }
}

/// Returns the number of texels along a side of a face at roughness 0, enough for the detail of the panorama. It halves
/// from level to level.
pub(super) fn face_side(panorama: &Panorama) -> u32 {
    // A face covers a quarter of the way around.
    if panorama.width() > 512 { 256 } else { 128 }
}

/// Creates a cube map of half floats with these levels. Its content is undefined.
pub(super) fn cube(gpu: &Gpu, label: &str, side: u32, levels: u32) -> Result<wgpu::Texture, ViewError> {
    let cube = gpu.guarded("an environment", |device| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d {
                width: side,
                height: side,
                depth_or_array_layers: 6,
            },
            mip_level_count: levels,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba16Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::STORAGE_BINDING
                | wgpu::TextureUsages::COPY_SRC
                | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        })
    })?;
    Ok(cube)
}

/// Returns a view of the whole cube map, which is read by direction.
pub(super) fn cube_view(cube: &wgpu::Texture) -> wgpu::TextureView {
    cube.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::Cube),
        ..Default::default()
    })
}

/// Returns a view of one level of a cube map, either as faces that are written or as a cube that is read by direction.
fn level_view(cube: &wgpu::Texture, level: u32, dimension: wgpu::TextureViewDimension) -> wgpu::TextureView {
    cube.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(dimension),
        base_mip_level: level,
        mip_level_count: Some(1),
        ..Default::default()
    })
}

/// Returns the perceptual roughness of a level, the square root of the width of GGX. A roughness `r` belongs to level `r (2
/// − r) (LEVELS − 1)`, as `lighting.wgsl` reads it. Levels are close to each other where mirrors become dull, since values
/// between two levels are mixed from both.
fn roughness_of(level: u32) -> f32 {
    1.0 - (1.0 - level as f32 / (LEVELS - 1) as f32).sqrt()
}

/// Creates the prefiltered cube map of a panorama on the device.
pub(super) fn prefilter(gpu: &Gpu, panorama: &wgpu::Texture, side: u32) -> Result<wgpu::Texture, ViewError> {
    use wgpu::TextureViewDimension::{Cube, D2, D2Array};
    let source = cube(gpu, "environment", side, side.ilog2() + 1)?;
    let made = cube(gpu, "prefiltered environment", side, LEVELS)?;
    let mut encoder = CubeEncoder::new(gpu);
    let resample = CubePipeline::new(gpu, ViewShader::PanoramaToCube, D2)?;
    let pixels = f32::max(panorama.width() as f32 / 4.0, panorama.height() as f32 / 2.0);
    let pass = CubePass {
        side,
        count: SAMPLES,
        // Number of pixels of the panorama between two samples.
        lod: (pixels / (side * SAMPLES) as f32).log2().max(0.0),
        pad: 0,
    };
    let picture = panorama.create_view(&Default::default());
    encoder.run(&resample, pass, &picture, &level_view(&source, 0, D2Array), &[])?;
    let halve = CubePipeline::new(gpu, ViewShader::HalveCube, Cube)?;
    for level in 1..source.mip_level_count() {
        let (side, lod) = (side >> level, 0.0);
        let (finer, to) = (
            level_view(&source, level - 1, Cube),
            level_view(&source, level, D2Array),
        );
        encoder.run(&halve, CubePass { side, lod, ..pass }, &finer, &to, &[])?;
    }
    encoder
        .encoder
        .copy_texture_to_texture(source.as_image_copy(), made.as_image_copy(), made.size());
    let gather = CubePipeline::new(gpu, ViewShader::Prefilter, Cube)?;
    for level in 1..LEVELS {
        let roughness = roughness_of(level);
        let lobe = lobe(roughness * roughness, DIRECTIONS[level as usize], side);
        let (side, count) = (side >> level, lobe.len() as u32);
        let to = level_view(&made, level, D2Array);
        encoder.run(
            &gather,
            CubePass { side, count, ..pass },
            &cube_view(&source),
            &to,
            &lobe,
        )?;
    }
    gpu.queue().submit([encoder.encoder.finish()]);
    gpu.wait()?;
    Ok(made)
}

/// Returns directions of light around +Z, distributed as GGX of this width reflects them to a viewer who looks along +Z.
/// Each has the level of the source whose texels are as large as the part of the sphere that the direction represents, plus
/// one, so that these parts overlap (Křivánek and Colbert 2008). The directions form a spiral with the golden angle, which
/// leaves no gaps and shows no rows. `source_side` is the side of a face of the source.
fn lobe(alpha: f32, count: u32, source_side: u32) -> Vec<Vec4> {
    let texel_sr = 4.0 * PI / (6 * source_side * source_side) as f32;
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let direction = |at: u32| {
        let share = (at as f32 + 0.5) / count as f32;
        let around = (golden * f64::from(at) % std::f64::consts::TAU) as f32;
        let squared = alpha * alpha;
        // Walter et al. 2007, Microfacet Models for Refraction, equation 35.
        let cos_half = ((1.0 - share) / (1.0 + (squared - 1.0) * share)).sqrt();
        let sin_half = (1.0 - cos_half * cos_half).max(0.0).sqrt();
        let half = vec3(sin_half * around.cos(), sin_half * around.sin(), cos_half);
        let to: Vec3 = 2.0 * cos_half * half - Vec3::Z;
        let spread = cos_half * cos_half * (squared - 1.0) + 1.0;
        // The density is D / 4, since n·h and v·h are equal here.
        let pdf = squared / (4.0 * PI * spread * spread);
        let lod = 0.5 * (1.0 / (count as f32 * pdf * texel_sr)).log2() + 1.0;
        to.extend(lod.clamp(0.0, source_side.ilog2() as f32))
    };
    (0..count).map(direction).filter(|to| to.z > 0.0).collect()
}

/// Pipeline that computes one level of a cube map.
struct CubePipeline {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
}

fn entry(binding: u32, ty: wgpu::BindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty,
        count: None,
    }
}

fn buffer(binding: u32, ty: wgpu::BufferBindingType) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::Buffer {
        ty,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    entry(binding, ty)
}

impl CubePipeline {
    fn new(gpu: &Gpu, shader: ViewShader, source: wgpu::TextureViewDimension) -> Result<CubePipeline, ViewError> {
        let read = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: source,
            multisampled: false,
        };
        let write = wgpu::BindingType::StorageTexture {
            access: wgpu::StorageTextureAccess::WriteOnly,
            format: wgpu::TextureFormat::Rgba16Float,
            view_dimension: wgpu::TextureViewDimension::D2Array,
        };
        let entries = [
            buffer(0, wgpu::BufferBindingType::Uniform),
            entry(1, read),
            entry(2, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)),
            entry(3, write),
            buffer(4, wgpu::BufferBindingType::Storage { read_only: true }),
        ];
        let spec = shader.spec();
        let label = spec.label;
        let module = shader_module(gpu, &spec)?;
        let made = gpu.guarded(label, |device| {
            let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(label),
                entries: &entries,
            });
            let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            });
            let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(label),
                layout: Some(&pipeline_layout),
                module: &module,
                entry_point: Some("main"),
                compilation_options: Default::default(),
                cache: None,
            });
            CubePipeline { pipeline, layout }
        })?;
        Ok(made)
    }
}

/// Encoder of passes over cube maps.
struct CubeEncoder<'g> {
    gpu: &'g Gpu,
    encoder: wgpu::CommandEncoder,
    sampler: wgpu::Sampler,
}

impl<'g> CubeEncoder<'g> {
    fn new(gpu: &'g Gpu) -> CubeEncoder<'g> {
        let sampler = gpu.device().create_sampler(&wgpu::SamplerDescriptor {
            label: Some("environment"),
            address_mode_u: wgpu::AddressMode::Repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        });
        CubeEncoder {
            gpu,
            encoder: gpu.device().create_command_encoder(&Default::default()),
            sampler,
        }
    }

    fn buffer(&self, bytes: &[u8], usage: wgpu::BufferUsages) -> Result<wgpu::Buffer, ViewError> {
        let buffer = self.gpu.guarded("an environment", |device| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("environment"),
                size: bytes.len() as u64,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        })?;
        self.gpu.queue().write_buffer(&buffer, 0, bytes);
        Ok(buffer)
    }

    /// Encodes a pass that writes `to`, whose size is in `pass`.
    fn run(
        &mut self,
        pipeline: &CubePipeline,
        pass: CubePass,
        read: &wgpu::TextureView,
        to: &wgpu::TextureView,
        lobe: &[Vec4],
    ) -> Result<(), ViewError> {
        // A binding must not be empty.
        let lobe = if lobe.is_empty() { &[Vec4::ZERO] } else { lobe };
        let uniform = self.buffer(bytemuck::bytes_of(&pass), wgpu::BufferUsages::UNIFORM)?;
        let flat: Vec<f32> = lobe.iter().flat_map(Vec4::to_array).collect();
        let lobe = self.buffer(bytemuck::cast_slice(&flat), wgpu::BufferUsages::STORAGE)?;
        let resources = [
            uniform.as_entire_binding(),
            wgpu::BindingResource::TextureView(read),
            wgpu::BindingResource::Sampler(&self.sampler),
            wgpu::BindingResource::TextureView(to),
            lobe.as_entire_binding(),
        ];
        let entries: Vec<_> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        let group = self.gpu.guarded("an environment", |device| {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("environment"),
                layout: &pipeline.layout,
                entries: &entries,
            })
        })?;
        let mut compute = self.encoder.begin_compute_pass(&Default::default());
        compute.set_pipeline(&pipeline.pipeline);
        compute.set_bind_group(0, &group, &[]);
        let groups = pass.side.div_ceil(GROUP);
        compute.dispatch_workgroups(groups, groups, 6);
        Ok(())
    }
}
