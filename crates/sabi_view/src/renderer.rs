//! Drawing of scenes.

pub(crate) mod bound;
mod choice;
mod light;
mod passes;
mod pose;

use bound::Bound;
use bytemuck::Pod;
use passes::{color_attachment, draw_light, draw_raster};
use sabi_gpu::Gpu;
use sabi_gpu::wgsl_struct;

use crate::dfg::dfg_texture;
use crate::error::ViewError;
use crate::frame::Frame;
use crate::pipelines::{Draws, Layouts, Pipelines, Transform};
use crate::scene::{Background, Mode, Scene, Shot, ViewTransform};
use crate::shadows::ShadowMaps;
use crate::target::{SUM, Target};
use crate::upload::{buffer_of, texture};
pub use choice::Missing;
pub use pose::Pose;

/// Draws scenes on one device.
pub struct Renderer {
    pipelines: Pipelines,
    smooth: wgpu::Sampler,
    /// Sampler that wraps around the seam of a panorama.
    round: wgpu::Sampler,
    compare: wgpu::Sampler,
    directional_albedo: wgpu::TextureView,
    /// Bound in place of a missing map.
    no_map: wgpu::TextureView,
    /// Bound in place of a sum when there are no earlier samples.
    no_sum: wgpu::TextureView,
}

wgsl_struct! {
    "view/display" Display:
    /// Constants of the way from light to a picture.
    pub(crate) struct Display {
        backdrop: [f32; 4],
        exposure: f32,
        samples: f32,
        pad: [f32; 2],
    }
}

/// Resources shared by all samples of a picture.
pub(crate) struct Prepared {
    shadows: ShadowMaps,
    bound: Bound,
    seen: wgpu::BindGroup,
}

/// One sample of a picture.
#[derive(Clone, Copy)]
pub(crate) struct Sample {
    /// Number, from 0.
    pub(crate) number: u32,
    /// True if the samples so far are encoded as a picture.
    pub(crate) is_shown: bool,
}

impl Renderer {
    /// A renderer; its pipelines are made when they are first used.
    pub fn new(gpu: &Gpu) -> Result<Renderer, ViewError> {
        let device = gpu.device();
        let smooth = |address_mode_u| wgpu::SamplerDescriptor {
            address_mode_u,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        };
        let compare = device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            compare: Some(wgpu::CompareFunction::LessEqual),
            ..Default::default()
        });
        let one = |format| texture(gpu, "nothing", [1, 1, 1], format);
        let no_map = one(SUM)?.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let table = dfg_texture(gpu)?;
        Ok(Renderer {
            pipelines: Pipelines::new(gpu)?,
            smooth: device.create_sampler(&smooth(wgpu::AddressMode::ClampToEdge)),
            round: device.create_sampler(&smooth(wgpu::AddressMode::Repeat)),
            compare,
            directional_albedo: table.create_view(&wgpu::TextureViewDescriptor::default()),
            no_map,
            no_sum: one(SUM)?.create_view(&wgpu::TextureViewDescriptor::default()),
        })
    }

    /// Draws a scene as a shot shows it, with all of its samples.
    pub fn draw(&self, gpu: &Gpu, target: &mut Target, scene: &Scene<'_>, shot: &Shot) -> Result<(), ViewError> {
        let prepared = self.prepare(gpu, target, scene, shot)?;
        let samples = shot.samples.max(1);
        for sample in 0..samples {
            let next = Sample {
                number: sample,
                is_shown: sample + 1 == samples,
            };
            self.add_sample(gpu, target, scene, shot, &prepared, next)?;
            if sample % 4 == 3 {
                // Not more in the queue than a driver is glad to take.
                gpu.wait()?;
            }
        }
        Ok(())
    }

    /// Prepares the resources shared by all samples of a picture.
    pub(crate) fn prepare(
        &self,
        gpu: &Gpu,
        target: &Target,
        scene: &Scene<'_>,
        shot: &Shot,
    ) -> Result<Prepared, ViewError> {
        Ok(Prepared {
            shadows: self.cast_shadows(gpu, scene)?,
            bound: self.bound(gpu, target.size, scene, shot)?,
            seen: self.seen_group(gpu, &target.sight, scene),
        })
    }

    /// Draws one sample, and if it is shown the mean of all so far.
    pub(crate) fn add_sample(
        &self,
        gpu: &Gpu,
        target: &mut Target,
        scene: &Scene<'_>,
        shot: &Shot,
        prepared: &Prepared,
        sample: Sample,
    ) -> Result<(), ViewError> {
        let Prepared { shadows, bound, seen } = prepared;
        let numbers = Frame::new(scene, shot, target.size, sample.number);
        let frame = self.frame_group(gpu, shadows, scene, &numbers)?;
        let mut encoder = gpu
            .device()
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        draw_raster(&mut encoder, &target.sight, scene, &frame, bound);
        draw_light(&mut encoder, &target.light, (&target.sight, seen), scene, &frame, bound);
        self.finish_sample(gpu, &mut encoder, target, shot, sample)?;
        gpu.queue().submit([encoder.finish()]);
        Ok(())
    }

    /// The light of one sample goes into the picture, or into the sum of those so far and from there into the picture.
    fn finish_sample(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &mut Target,
        shot: &Shot,
        Sample {
            number: sample,
            is_shown,
        }: Sample,
    ) -> Result<(), ViewError> {
        let light = target.light.create_view(&wgpu::TextureViewDescriptor::default());
        let shown = target.shown.create_view(&wgpu::TextureViewDescriptor::default());
        if shot.samples <= 1 {
            let views = [&light, &self.no_sum, &shown];
            return self.display(gpu, encoder, Draws::Encode(transform(shot)), views, display(shot, 1));
        }
        let sums = target.sums(gpu)?;
        let [before, now] = [sample, sample + 1].map(|at| (at % 2) as usize);
        let earlier = if sample == 0 { &self.no_sum } else { &sums[before] };
        let numbers = display(shot, sample + 1);
        let gather = Draws::Gather(transform(shot));
        self.display(gpu, encoder, gather, [&light, earlier, &sums[now]], numbers)?;
        if is_shown {
            self.display(gpu, encoder, Draws::EncodeSum, [&light, &sums[now], &shown], numbers)?;
        }
        Ok(())
    }

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

    fn numbers(&self, gpu: &Gpu, numbers: &impl Pod) -> Result<wgpu::Buffer, ViewError> {
        let bytes = bytemuck::bytes_of(numbers);
        Ok(buffer_of(
            gpu,
            "the numbers of a picture",
            wgpu::BufferUsages::UNIFORM,
            bytes,
        )?)
    }

    fn layouts(&self) -> &Layouts {
        &self.pipelines.layouts
    }

    /// Light and a sum of earlier samples become something that is written.
    fn display(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        draws: Draws,
        [light, earlier, goal]: [&wgpu::TextureView; 3],
        numbers: Display,
    ) -> Result<(), ViewError> {
        let numbers = self.numbers(gpu, &numbers)?;
        let view = wgpu::BindingResource::TextureView;
        let resources = [numbers.as_entire_binding(), view(light), view(earlier)];
        let group = self.bind(gpu, &self.layouts().display, resources);
        let pipeline = self.pipelines.get(gpu, draws)?;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("display"),
            color_attachments: &[Some(color_attachment(goal))],
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }
}

fn transform(shot: &Shot) -> Transform {
    match shot.transform {
        _ if shot.mode != Mode::Material => Transform::ENCODED,
        ViewTransform::Standard => Transform::STANDARD,
        ViewTransform::AgX => Transform::AGX,
        ViewTransform::Aces => Transform::ACES,
    }
}

fn display(shot: &Shot, samples: u32) -> Display {
    let backdrop = match shot.background {
        Background::Plain([r, g, b]) => [r, g, b, 1.0],
        Background::Clear => [0.0; 4],
        // Channels are looked at before an even gray.
        Background::Environment | Background::Blurred => [0.05, 0.05, 0.05, 1.0],
    };
    Display {
        backdrop,
        exposure: shot.exposure_stops.exp2(),
        samples: samples as f32,
        pad: [0.0; 2],
    }
}
