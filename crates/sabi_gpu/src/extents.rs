//! The lowest and the highest value of a result, found on the device.

use sabi_nodes::wgsl_struct;

use crate::bindings::{texture_entry, uniform_entry, write_entry};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::pool::array_view;
use crate::run_options::RunOptions;
use crate::shaders::FixedShader;
use crate::surface::GpuSurface;
use crate::tiles::Slices;

/// Range of one component of a result over the texels of the model, without ghosts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueExtent {
    /// Lowest and highest number; none where no texel holds a number.
    pub range: Option<[f32; 2]>,
    /// Number of texels that are not a number.
    pub not_numbers: u32,
}

wgsl_struct! {
    "surface/extent" Asked:
    /// Constants of the extent of one component.
    pub(crate) struct ExtentConstants {
        component: u32,
        place: u32,
        pad: [u32; 2],
    }
}

/// Words of each extent: lowest key, highest key, texels that are not a number.
const EXTENT_WORDS: usize = 3;

impl Gpu {
    /// Extents of components of textures on the atlas, each given with the number of its component.
    pub fn extents(
        &self,
        surface: &GpuSurface,
        of: &[(&wgpu::Texture, u32)],
        options: &RunOptions<'_>,
    ) -> Result<Vec<ValueExtent>, GpuError> {
        if of.is_empty() {
            return Ok(Vec::new());
        }
        let bytes = (of.len() * EXTENT_WORDS * size_of::<u32>()) as u64;
        let extents = self.guarded("the extents of results", |device| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("extents"),
                size: bytes,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            })
        })?;
        let start = [u32::MAX, 0, 0].repeat(of.len());
        self.queue.write_buffer(&extents, 0, bytemuck::cast_slice(&start));
        let entries = [uniform_entry(0), texture_entry(1), write_entry(2)];
        let kernel = self.fixed_kernel(FixedShader::Extent, &entries)?;
        let slices = Slices::new(self, surface, options.submission);
        for (at, (texture, component)) in of.iter().enumerate() {
            let constants = self.uniform(bytemuck::bytes_of(&ExtentConstants {
                component: *component,
                place: (at * EXTENT_WORDS) as u32,
                pad: [0; 2],
            }));
            let view = array_view(texture);
            let resources = [
                constants.as_entire_binding(),
                wgpu::BindingResource::TextureView(&view),
                extents.as_entire_binding(),
            ];
            let group = self.bind(&kernel.layout, resources);
            slices.run(&kernel.pipeline, &kernel.pace, &group, options.is_canceled)?;
        }
        let readback = self.readback_buffer(bytes)?;
        let mapping = self.start_mapping(&extents, &readback, bytes);
        self.finish_mapping(mapping, &readback, |bytes| {
            let (words, _) = bytes.as_chunks::<4>();
            let words: Vec<u32> = words.iter().map(|word| u32::from_le_bytes(*word)).collect();
            words.as_chunks::<EXTENT_WORDS>().0.iter().map(extent).collect()
        })
    }
}

fn extent(&[low, high, not_numbers]: &[u32; EXTENT_WORDS]) -> ValueExtent {
    ValueExtent {
        range: (low <= high).then(|| [low, high].map(value_of)),
        not_numbers,
    }
}

/// The value of a key; see `key_of` in `extent.wgsl`.
fn value_of(key: u32) -> f32 {
    let sign = 1 << 31;
    let value = f32::from_bits(if key & sign == 0 { !key } else { key ^ sign });
    // Turns −0 into 0.
    value + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_decode_to_their_values_and_sort_like_them() {
        let key = |value: f32| {
            let bits = value.to_bits();
            if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
        };
        let rising = [f32::NEG_INFINITY, -2.5, -1e-40, 0.0, 1e-40, 0.3, 7.0, f32::INFINITY];
        assert!(rising.windows(2).all(|pair| key(pair[0]) < key(pair[1])));
        assert_eq!(rising.map(|value| value_of(key(value))), rising);
        assert_eq!(value_of(key(-0.0)).to_bits(), 0);
    }

    #[test]
    fn a_surface_without_numbers_has_no_range() {
        let nothing = extent(&[u32::MAX, 0, 4]);
        assert_eq!((nothing.range, nothing.not_numbers), (None, 4));
    }
}
