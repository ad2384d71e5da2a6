//! Textures over which the bloom of a picture is spread.

use sabi_gpu::Gpu;

use super::LIGHT_FORMAT;
use crate::error::ViewError;
use crate::upload::texture;

/// Pixels of the picture along a side of a texel of the finest level.
const FINEST: u32 = 4;
/// Minimum number of texels along the shorter side of the coarsest level.
const LEAST_SIDE: u32 = 8;

/// Levels of the spread light of a picture, the finest first.
pub(crate) struct BloomLevels {
    /// Light of each level without the others.
    pub(crate) gathered: Vec<wgpu::TextureView>,
    /// Each level mixed with the coarser ones; all levels but the coarsest.
    pub(crate) mixed: Vec<wgpu::TextureView>,
}

impl BloomLevels {
    /// Creates the levels for a picture of this size, without content.
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2]) -> Result<BloomLevels, ViewError> {
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

    /// Returns the spread light, with a quarter of the picture's width and height.
    pub(crate) fn spread(&self) -> &wgpu::TextureView {
        self.mixed.first().unwrap_or(&self.gathered[0])
    }
}

/// Returns the sizes of the levels, the finest first. There is at least one.
fn level_sizes(size: [u32; 2]) -> Vec<[u32; 2]> {
    let mut sizes = vec![size.map(|side| side.div_ceil(FINEST))];
    while let Some(&[width, height]) = sizes.last()
        && width.min(height) >= 2 * LEAST_SIDE
    {
        sizes.push([width.div_ceil(2), height.div_ceil(2)]);
    }
    sizes
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
