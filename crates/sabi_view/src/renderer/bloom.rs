//! Bloom: light above white that is spread over the picture before its view transform.
//!
//! It is computed from the first sample of a picture and used for all samples, so that a still picture needs it only once.
//! The levels depend on the picture's size, so that pictures of all sizes look alike.

use sabi_gpu::Gpu;
use sabi_nodes::wgsl_struct;

use super::Renderer;
use super::passes::color_attachment;
use crate::error::ViewError;
use crate::pipelines::{BloomStep, PipelineKey};
use crate::render_target::{BloomLevels, RenderTarget};
use crate::scene::Shot;

wgsl_struct! {
    "view/bloom" BloomPass:
    /// Constants of one pass of the bloom.
    pub(crate) struct BloomPass {
        exposure: f32,
        coarser_share: f32,
        pad: [f32; 2],
    }
}

impl Renderer {
    /// Spreads the light of a sample over the levels of the target.
    pub(super) fn spread_light(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &mut RenderTarget,
        shot: &Shot,
    ) -> Result<(), ViewError> {
        let levels = match target.bloom.take() {
            Some(levels) => levels,
            None => BloomLevels::new(gpu, target.size)?,
        };
        let light = target.light.create_view(&wgpu::TextureViewDescriptor::default());
        let constants = |coarser_share| BloomPass {
            exposure: shot.exposure_stops.exp2(),
            coarser_share,
            pad: [0.0; 2],
        };
        let BloomLevels { gathered, mixed } = &levels;
        let none = &self.empty_bloom;
        self.bloom_pass(
            gpu,
            encoder,
            BloomStep::Gather,
            [&light, none, &gathered[0]],
            constants(0.0),
        )?;
        for pair in gathered.windows(2) {
            self.bloom_pass(
                gpu,
                encoder,
                BloomStep::Halve,
                [&pair[0], none, &pair[1]],
                constants(0.0),
            )?;
        }
        for (level, to) in mixed.iter().enumerate().rev() {
            let coarser = mixed.get(level + 1).unwrap_or(&gathered[level + 1]);
            // With these factors, all levels have the same share of the light in the end.
            let left = (gathered.len() - level) as f32;
            let constants = constants((left - 1.0) / left);
            self.bloom_pass(gpu, encoder, BloomStep::Mix, [&gathered[level], coarser, to], constants)?;
        }
        target.bloom = Some(levels);
        Ok(())
    }

    fn bloom_pass(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        step: BloomStep,
        [source, coarser, to]: [&wgpu::TextureView; 3],
        constants: BloomPass,
    ) -> Result<(), ViewError> {
        let uniform = self.uniform(gpu, &constants)?;
        let view = wgpu::BindingResource::TextureView;
        let resources = [
            uniform.as_entire_binding(),
            view(source),
            view(coarser),
            wgpu::BindingResource::Sampler(&self.linear_sampler),
        ];
        let group = self.bind(gpu, &self.layouts().bloom, resources);
        let pipeline = self.pipelines.get(gpu, PipelineKey::Bloom(step))?;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("bloom"),
            color_attachments: &[Some(color_attachment(to))],
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }
}
