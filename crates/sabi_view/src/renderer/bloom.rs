//! Bloom: light above white that is spread over the picture before its view transform.
//!
//! It is found from the first sample of a picture and used for all, so that a still picture pays for it once. The levels
//! depend on the picture's size, so that pictures of all sizes look alike.

use sabi_gpu::Gpu;
use sabi_gpu::wgsl_struct;

use super::Renderer;
use super::passes::color_attachment;
use crate::error::ViewError;
use crate::pipelines::{BloomStep, PipelineKey};
use crate::scene::{Mode, Shot};
use crate::target::{LIGHT_FORMAT, Target};
use crate::upload::texture;

wgsl_struct! {
    "view/bloom" BloomPass:
    /// Constants of one pass of the bloom.
    pub(crate) struct BloomPass {
        exposure: f32,
        coarser_share: f32,
        pad: [f32; 2],
    }
}

/// Pixels of the picture along a side of a texel of the finest level.
const FINEST: u32 = 4;
/// Least texels along the shorter side of the coarsest level.
const LEAST_SIDE: u32 = 8;

/// Levels of the spread light of a picture, the finest first.
pub(crate) struct BloomLevels {
    /// Light of each level alone.
    gathered: Vec<wgpu::TextureView>,
    /// Each level mixed with the coarser ones; of all but the coarsest.
    mixed: Vec<wgpu::TextureView>,
}

impl BloomLevels {
    /// Levels for a picture of a size, without content.
    fn new(gpu: &Gpu, size: [u32; 2]) -> Result<BloomLevels, ViewError> {
        let sizes = level_sizes(size);
        let level = |[width, height]: &[u32; 2]| -> Result<wgpu::TextureView, ViewError> {
            let made = texture(gpu, "the bloom of a picture", [*width, *height, 1], LIGHT_FORMAT)?;
            Ok(made.create_view(&wgpu::TextureViewDescriptor::default()))
        };
        Ok(BloomLevels {
            gathered: sizes.iter().map(level).collect::<Result<_, _>>()?,
            mixed: sizes[..sizes.len() - 1].iter().map(level).collect::<Result<_, _>>()?,
        })
    }

    /// The spread light, a quarter of the picture's size.
    pub(super) fn spread(&self) -> &wgpu::TextureView {
        self.mixed.first().unwrap_or(&self.gathered[0])
    }
}

/// Sizes of the levels, the finest first; never empty.
fn level_sizes(size: [u32; 2]) -> Vec<[u32; 2]> {
    let mut sizes = vec![size.map(|side| side.div_ceil(FINEST))];
    while let Some(&[width, height]) = sizes.last()
        && width.min(height) >= 2 * LEAST_SIDE
    {
        sizes.push([width.div_ceil(2), height.div_ceil(2)]);
    }
    sizes
}

/// Returns true if a shot has bloom.
pub(super) fn has_bloom(shot: &Shot) -> bool {
    shot.mode == Mode::Material && shot.bloom > 0.0
}

impl Renderer {
    /// Spreads the light of a sample over the levels of the target.
    pub(super) fn spread_light(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &mut Target,
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
            // All levels in the end have the same share of the light.
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

#[cfg(test)]
mod tests {
    use super::level_sizes;

    #[test]
    fn levels_halve_from_a_quarter_of_the_picture_to_a_few_texels() {
        assert_eq!(
            level_sizes([1280, 720]),
            [[320, 180], [160, 90], [80, 45], [40, 23], [20, 12]]
        );
        assert_eq!(level_sizes([96, 96]), [[24, 24], [12, 12]]);
        for size in [[1, 1], [1, 8192], [3, 40]] {
            assert_eq!(level_sizes(size).len(), 1, "{size:?}");
        }
    }
}
