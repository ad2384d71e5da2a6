//! The lowest and the highest value of a result, found on the device.

use sabi_nodes::wgsl_struct;
use sabi_plan::SlotRef;

use crate::bindings::{texture_entry, uniform_entry, write_entry};
use crate::cache::{ResultCache, TileExtent};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::pipelines::fixed_kernel;
use crate::pool::array_view;
use crate::readback::StagingBuffer;
use crate::run_options::RunOptions;
use crate::run_result::Run;
use crate::shaders::FixedShader;
use crate::shown_tiles::ShownTiles;
use crate::surface::GpuSurface;
use crate::tile_set::TileSet;
use crate::tiles::Slices;

/// Range of one component of a result over the texels of the model, without ghosts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueExtent {
    /// Lowest and highest number; `None` if no texel has a number.
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

/// Extent of no texel.
const NOTHING: TileExtent = [u32::MAX, 0, 0];

/// A component of a texture, and the tiles that are examined; `None` for all.
type Asking<'a> = (&'a wgpu::Texture, u32, Option<&'a TileSet>);

/// Returns the extents of components of textures on the atlas. Each texture is given with the number of its component.
pub fn texture_extents(
    gpu: &Gpu,
    surface: &GpuSurface,
    of: &[(&wgpu::Texture, u32)],
    options: &RunOptions<'_>,
) -> Result<Vec<ValueExtent>, GpuError> {
    let tiles = options.shown.map(ShownTiles::tiles);
    let all: Vec<Asking<'_>> = of
        .iter()
        .map(|(texture, component)| (*texture, *component, tiles))
        .collect();
    let found = tile_extents(gpu, surface, &all, options)?;
    Ok(found.iter().map(|tiles| extent(tiles)).collect())
}

/// Returns the extents of components of the results of a run. With a cache, only tiles that differ from the earlier
/// results are examined.
pub fn result_extents(
    gpu: &Gpu,
    surface: &GpuSurface,
    run: &Run,
    of: &[(SlotRef, u32)],
    options: &RunOptions<'_>,
    cache: Option<&mut ResultCache>,
) -> Result<Vec<ValueExtent>, GpuError> {
    let textures = of
        .iter()
        .map(|(slot, _)| run.texture(*slot))
        .collect::<Result<Vec<wgpu::Texture>, GpuError>>()?;
    let Some(cache) = cache else {
        let of: Vec<(&wgpu::Texture, u32)> = textures
            .iter()
            .zip(of)
            .map(|(texture, (_, at))| (texture, *at))
            .collect();
        return texture_extents(gpu, surface, &of, options);
    };
    let known: Vec<Option<(Vec<TileExtent>, TileSet)>> = of
        .iter()
        .map(|(slot, component)| known_extents(surface, run, cache, *slot, *component))
        .collect();
    let asked: Vec<Asking<'_>> = textures
        .iter()
        .zip(of)
        .zip(&known)
        .map(|((texture, (_, component)), known)| (texture, *component, known.as_ref().map(|(_, tiles)| tiles)))
        .collect();
    let found = tile_extents(gpu, surface, &asked, options)?;
    let mut extents = Vec::new();
    for (((slot, component), known), found) in of.iter().zip(known).zip(found) {
        let all = match known {
            Some((mut all, tiles)) => {
                for (index, extent) in tiles.indices(&surface.tile_numbers).into_iter().zip(found) {
                    all[index] = extent;
                }
                all
            }
            None => found,
        };
        extents.push(match options.shown {
            Some(shown) => {
                let indices = shown.tiles().indices(&surface.tile_numbers).into_iter();
                extent(&indices.map(|index| all[index]).collect::<Vec<TileExtent>>())
            }
            None => extent(&all),
        });
        if let Some(key) = run.keys.get(slot) {
            cache.put_extents((*key, *component), all);
        }
    }
    Ok(extents)
}

/// Extents of tiles of components of textures, in the order of the tiles.
fn tile_extents(
    gpu: &Gpu,
    surface: &GpuSurface,
    of: &[Asking<'_>],
    options: &RunOptions<'_>,
) -> Result<Vec<Vec<TileExtent>>, GpuError> {
    let counts: Vec<usize> = of
        .iter()
        .map(|(_, _, tiles)| tiles.map_or(surface.tile_count, TileSet::count) as usize)
        .collect();
    let total: usize = counts.iter().sum();
    if total == 0 {
        return Ok(counts.iter().map(|_| Vec::new()).collect());
    }
    let bytes = (total * size_of::<TileExtent>()) as u64;
    let extents = gpu.guarded("the extents of results", |device| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("extents"),
            size: bytes,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        })
    })?;
    gpu.queue
        .write_buffer(&extents, 0, bytemuck::cast_slice(&vec![NOTHING; total]));
    let entries = [uniform_entry(0), texture_entry(1), write_entry(2)];
    let kernel = fixed_kernel(gpu, FixedShader::Extent, &entries)?;
    let mut first = 0;
    for ((texture, component, tiles), count) in of.iter().zip(&counts) {
        let constants = gpu.uniform(bytemuck::bytes_of(&ExtentConstants {
            component: *component,
            place: (first * NOTHING.len()) as u32,
            pad: [0; 2],
        }));
        first += count;
        let view = array_view(texture);
        let resources = [
            constants.as_entire_binding(),
            wgpu::BindingResource::TextureView(&view),
            extents.as_entire_binding(),
        ];
        let group = gpu.bind(&kernel.layout, resources);
        let slices = match tiles {
            Some(tiles) => Slices::over(gpu, surface, tiles, options.submission)?,
            None => Slices::new(gpu, surface, options.submission),
        };
        slices.run(&kernel.pipeline, &kernel.pace, &group, options.is_canceled)?;
    }
    let staging = StagingBuffer::new(gpu, bytes)?;
    let copy = staging.copy_buffer(gpu, &extents, bytes);
    staging.read(gpu, copy, |bytes| parted(bytes, &counts))
}

/// Splits words into the extents of tiles: for each count, that many tiles.
fn parted(bytes: &[u8], counts: &[usize]) -> Vec<Vec<TileExtent>> {
    let (words, _) = bytes.as_chunks::<4>();
    let words: Vec<u32> = words.iter().map(|word| u32::from_le_bytes(*word)).collect();
    let mut tiles = words.as_chunks::<3>().0;
    let of_count = |count: &usize| {
        let (own, rest) = tiles.split_at(*count);
        tiles = rest;
        own.to_vec()
    };
    counts.iter().map(of_count).collect()
}

/// Returns the extents of all tiles of a component of a result, as far as they are known, and the tiles whose extents are unknown.
fn known_extents(
    surface: &GpuSurface,
    run: &Run,
    cache: &ResultCache,
    slot: SlotRef,
    component: u32,
) -> Option<(Vec<TileExtent>, TileSet)> {
    let key = run.keys.get(&slot)?;
    let own = cache.extents(&(*key, component)).map(|all| (all, TileSet::default()));
    let before = || {
        let (before, tiles) = run.changed.get(&slot)?;
        Some((cache.extents(&(*before, component))?, tiles.clone()))
    };
    let (all, tiles) = own.or_else(before)?;
    (all.len() == surface.tile_count as usize).then(|| (all.clone(), tiles))
}

/// Extent over some tiles.
fn extent(tiles: &[TileExtent]) -> ValueExtent {
    let [low, high, not_numbers] = tiles.iter().fold(NOTHING, |[low, high, not_numbers], tile| {
        [low.min(tile[0]), high.max(tile[1]), not_numbers.saturating_add(tile[2])]
    });
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
        let nothing = extent(&[[u32::MAX, 0, 1], [u32::MAX, 0, 3]]);
        assert_eq!((nothing.range, nothing.not_numbers), (None, 4));
    }
}
