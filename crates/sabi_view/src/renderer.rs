//! Drawing of scenes.

pub(crate) mod bloom;
pub(crate) mod bound_scene;
mod choice;
mod light;
pub(crate) mod passes;
mod pose;

use bound_scene::BoundScene;
use bytemuck::Pod;
pub(crate) use passes::PixelRect;
use passes::{draw_light, draw_raster, for_parts, part_attachment};
use sabi_gpu::Gpu;
use sabi_nodes::wgsl_struct;

use crate::dfg::dfg_texture;
use crate::error::ViewError;
use crate::frame::FrameUniforms;
use crate::pipelines::{Development, Layouts, PipelineKey, Pipelines, Transform};
use crate::render_target::{LIGHT_FORMAT, RenderTarget, SUM_FORMAT};
use crate::scene::{Background, Mode, Scene, Shot, ViewTransform};
use crate::shade::GROUND_FORMAT;
use crate::shadows::ShadowMaps;
use crate::upload::{buffer_of, texture};
pub use choice::MissingPipelines;
pub use pose::ModelPose;

/// Draws scenes on one device.
pub struct Renderer {
    pipelines: Pipelines,
    linear_sampler: wgpu::Sampler,
    /// Sampler that wraps around the seam of a panorama.
    panorama_sampler: wgpu::Sampler,
    shadow_sampler: wgpu::Sampler,
    directional_albedo: wgpu::TextureView,
    /// Bound in place of a missing map.
    empty_map: wgpu::TextureView,
    /// Bound if there is no ground.
    open_ground: wgpu::TextureView,
    /// Bound in place of a sum when there are no earlier samples.
    empty_sum: wgpu::TextureView,
    /// Bound if there is no bloom.
    empty_bloom: wgpu::TextureView,
}

wgsl_struct! {
    "view/display" DisplayUniforms:
    /// Constants of the conversion of light to a picture.
    pub(crate) struct DisplayUniforms {
        backdrop: [f32; 4],
        exposure: f32,
        samples: f32,
        bloom: f32,
        pad: f32,
    }
}

/// Resources shared by all samples of a picture.
pub(crate) struct PictureResources {
    shadows: ShadowMaps,
    bound: BoundScene,
    visibility: wgpu::BindGroup,
}

/// A sample of a picture.
#[derive(Clone, Copy)]
pub(crate) struct PictureSample {
    /// Number, from 0.
    pub(crate) number: u32,
    /// True if the samples so far are encoded as a picture.
    pub(crate) is_shown: bool,
}

impl Renderer {
    /// Creates a renderer. Its pipelines are created when they are first used.
    pub fn new(gpu: &Gpu) -> Result<Renderer, ViewError> {
        let device = gpu.device();
        let linear = |address_mode_u| wgpu::SamplerDescriptor {
            address_mode_u,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        };
        let shadow_sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            compare: Some(wgpu::CompareFunction::LessEqual),
            ..Default::default()
        });
        let empty = |format| texture(gpu, "an empty map", [1, 1, 1], format);
        let empty_map = empty(SUM_FORMAT)?.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let table = dfg_texture(gpu)?;
        Ok(Renderer {
            pipelines: Pipelines::new(gpu)?,
            linear_sampler: device.create_sampler(&linear(wgpu::AddressMode::ClampToEdge)),
            panorama_sampler: device.create_sampler(&linear(wgpu::AddressMode::Repeat)),
            shadow_sampler,
            directional_albedo: table.create_view(&wgpu::TextureViewDescriptor::default()),
            empty_map,
            open_ground: empty(GROUND_FORMAT)?.create_view(&wgpu::TextureViewDescriptor::default()),
            empty_sum: empty(SUM_FORMAT)?.create_view(&wgpu::TextureViewDescriptor::default()),
            empty_bloom: empty(LIGHT_FORMAT)?.create_view(&wgpu::TextureViewDescriptor::default()),
        })
    }

    /// Draws a shot of a scene with all of its samples.
    pub fn draw(&self, gpu: &Gpu, target: &mut RenderTarget, scene: &Scene<'_>, shot: &Shot) -> Result<(), ViewError> {
        let mut prepared = self.prepare(gpu, target, scene, shot, None)?;
        let samples = shot.samples.max(1);
        for sample in 0..samples {
            let next = PictureSample {
                number: sample,
                is_shown: sample + 1 == samples,
            };
            self.add_sample(gpu, target, scene, shot, &mut prepared, next)?;
            if sample % 4 == 3 {
                // Without waiting, drivers slow down or fail because of too much work in the queue.
                gpu.wait()?;
            }
        }
        Ok(())
    }

    /// Prepares the resources shared by all samples of a picture. `before` holds the resources of another picture, whose
    /// shadow maps are reused if they are the same.
    pub(crate) fn prepare(
        &self,
        gpu: &Gpu,
        target: &RenderTarget,
        scene: &Scene<'_>,
        shot: &Shot,
        before: Option<PictureResources>,
    ) -> Result<PictureResources, ViewError> {
        let bound = self.bound(gpu, target.size, scene, shot)?;
        Ok(PictureResources {
            shadows: self.shadow_maps(gpu, scene, shot, &bound, before.map(|before| before.shadows))?,
            bound,
            visibility: self.visibility_group(gpu, &target.visibility, scene),
        })
    }

    /// Draws one sample and, if it is shown, the mean of all samples so far.
    pub(crate) fn add_sample(
        &self,
        gpu: &Gpu,
        target: &mut RenderTarget,
        scene: &Scene<'_>,
        shot: &Shot,
        prepared: &mut PictureResources,
        sample: PictureSample,
    ) -> Result<(), ViewError> {
        let PictureResources {
            shadows,
            bound,
            visibility,
        } = prepared;
        self.cast_again(gpu, scene, shot, sample.number, bound, shadows)?;
        let values = FrameUniforms::new(scene, shot, target.size, sample.number);
        let frame = self.frame_group(gpu, shadows, scene, &values)?;
        let mut encoder = gpu
            .device()
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        draw_raster(&mut encoder, &target.visibility, scene, &frame, bound);
        draw_light(
            &mut encoder,
            &target.light,
            &target.visibility,
            visibility,
            scene,
            &frame,
            bound,
            None,
        );
        self.finish_sample(gpu, &mut encoder, target, shot, sample)?;
        gpu.queue().submit([encoder.finish()]);
        Ok(())
    }

    /// Draws parts of a picture again, as its first sample shows them. Pixels need not be rasterized again if they already
    /// show the model as in the first sample.
    pub(crate) fn draw_part(
        &self,
        gpu: &Gpu,
        target: &mut RenderTarget,
        scene: &Scene<'_>,
        shot: &Shot,
        prepared: &mut PictureResources,
        parts: &[PixelRect],
        is_rastered: bool,
    ) -> Result<(), ViewError> {
        let PictureResources {
            shadows,
            bound,
            visibility,
        } = prepared;
        let values = FrameUniforms::new(scene, shot, target.size, 0);
        let frame = self.frame_group(gpu, shadows, scene, &values)?;
        let mut encoder = gpu
            .device()
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        if !is_rastered {
            draw_raster(&mut encoder, &target.visibility, scene, &frame, bound);
        }
        draw_light(
            &mut encoder,
            &target.light,
            &target.visibility,
            visibility,
            scene,
            &frame,
            bound,
            Some(parts),
        );
        // The bloom is not updated until the whole picture is drawn again.
        let spread = match &target.bloom {
            Some(levels) if shot.has_bloom() => levels.spread().clone(),
            _ => self.empty_bloom.clone(),
        };
        let light = target.light.create_view(&wgpu::TextureViewDescriptor::default());
        let shown = target.shown.create_view(&wgpu::TextureViewDescriptor::default());
        let views = [&light, &self.empty_sum, &spread, &shown];
        let key = PipelineKey::EncodeModel(development(shot));
        // The background has not changed, and shows the shadows of all samples.
        let depth = target
            .visibility
            .depth
            .create_view(&wgpu::TextureViewDescriptor::default());
        let within = Some(ModelParts { parts, depth: &depth });
        self.display(gpu, &mut encoder, key, views, display(shot, 1), within)?;
        gpu.queue().submit([encoder.finish()]);
        Ok(())
    }

    /// Encodes the light of one sample as the picture, or adds it to the sum of samples and encodes their mean.
    fn finish_sample(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &mut RenderTarget,
        shot: &Shot,
        PictureSample {
            number: sample,
            is_shown,
        }: PictureSample,
    ) -> Result<(), ViewError> {
        if sample == 0 && shot.has_bloom() {
            self.spread_light(gpu, encoder, target, shot)?;
        }
        let spread = match &target.bloom {
            Some(levels) if shot.has_bloom() => levels.spread().clone(),
            _ => self.empty_bloom.clone(),
        };
        let light = target.light.create_view(&wgpu::TextureViewDescriptor::default());
        let shown = target.shown.create_view(&wgpu::TextureViewDescriptor::default());
        if shot.samples <= 1 {
            let views = [&light, &self.empty_sum, &spread, &shown];
            return self.display(
                gpu,
                encoder,
                PipelineKey::Encode(development(shot)),
                views,
                display(shot, 1),
                None,
            );
        }
        let sums = target.sums(gpu)?;
        let [before, now] = [sample, sample + 1].map(|at| (at % 2) as usize);
        let earlier = if sample == 0 { &self.empty_sum } else { &sums[before] };
        let values = display(shot, sample + 1);
        let accumulate = PipelineKey::Accumulate(development(shot));
        self.display(
            gpu,
            encoder,
            accumulate,
            [&light, earlier, &spread, &sums[now]],
            values,
            None,
        )?;
        if is_shown {
            self.display(
                gpu,
                encoder,
                PipelineKey::EncodeMean,
                [&light, &sums[now], &spread, &shown],
                values,
                None,
            )?;
        }
        Ok(())
    }

    /// Creates a bind group with these resources at bindings 0, 1, 2, …
    fn bind<'r>(
        &self,
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        resources: impl IntoIterator<Item = wgpu::BindingResource<'r>>,
    ) -> wgpu::BindGroup {
        let entries: Vec<_> = resources
            .into_iter()
            .zip(0..)
            .map(|(resource, binding)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout,
            entries: &entries,
        })
    }

    /// Creates a uniform buffer with these values.
    fn uniform(&self, gpu: &Gpu, values: &impl Pod) -> Result<wgpu::Buffer, ViewError> {
        let bytes = bytemuck::bytes_of(values);
        Ok(buffer_of(
            gpu,
            "the uniforms of a picture",
            wgpu::BufferUsages::UNIFORM,
            bytes,
        )?)
    }

    fn layouts(&self) -> &Layouts {
        &self.pipelines.layouts
    }

    /// Draws light, the sum of earlier samples and the bloom into `target` with a pipeline for displaying. With `within`,
    /// only these parts are drawn, using the depth of the picture.
    fn display(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        key: PipelineKey,
        [light, earlier, spread, target]: [&wgpu::TextureView; 4],
        values: DisplayUniforms,
        within: Option<ModelParts<'_>>,
    ) -> Result<(), ViewError> {
        let uniform = self.uniform(gpu, &values)?;
        let view = wgpu::BindingResource::TextureView;
        let resources = [
            uniform.as_entire_binding(),
            view(light),
            view(earlier),
            view(spread),
            wgpu::BindingResource::Sampler(&self.linear_sampler),
        ];
        let group = self.bind(gpu, &self.layouts().display, resources);
        let pipeline = self.pipelines.get(gpu, key)?;
        let parts = within.map(|within| within.parts);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("display"),
            color_attachments: &[Some(part_attachment(target, parts))],
            // Only read: a stencil of 0 means that the pixel does not show the model.
            depth_stencil_attachment: within.map(|within| wgpu::RenderPassDepthStencilAttachment {
                view: within.depth,
                depth_ops: None,
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_stencil_reference(0);
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        for_parts(&mut pass, parts, |pass| pass.draw(0..3, 0..1));
        Ok(())
    }
}

/// Parts of a picture that are drawn again for the pixels that show the model.
#[derive(Clone, Copy)]
struct ModelParts<'a> {
    parts: &'a [PixelRect],
    /// Depth of the picture. Its stencil is 0 for pixels that do not show the model.
    depth: &'a wgpu::TextureView,
}

fn development(shot: &Shot) -> Development {
    Development {
        transform: transform(shot),
        has_bloom: shot.has_bloom(),
    }
}

fn transform(shot: &Shot) -> Transform {
    match shot.transform {
        _ if shot.mode != Mode::Material => Transform::ENCODED,
        ViewTransform::Standard => Transform::STANDARD,
        ViewTransform::Neutral => Transform::NEUTRAL,
        ViewTransform::AgX => Transform::AGX,
        ViewTransform::PunchyAgX => Transform::AGX_PUNCHY,
        ViewTransform::Aces => Transform::ACES,
    }
}

fn display(shot: &Shot, samples: u32) -> DisplayUniforms {
    let backdrop = match shot.background {
        Background::Plain([r, g, b]) => [r, g, b, 1.0],
        Background::Clear => [0.0; 4],
        // Modes other than the lit material have a uniform gray behind the model.
        Background::Environment | Background::Blurred | Background::Studio => [0.05, 0.05, 0.05, 1.0],
    };
    DisplayUniforms {
        backdrop,
        exposure: shot.exposure_stops.exp2(),
        samples: samples as f32,
        bloom: shot.bloom.clamp(0.0, 1.0),
        pad: 0.0,
    }
}
