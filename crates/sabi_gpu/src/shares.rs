//! Charts that share a place on the maps: their texels are set to the value that the maps have there.

use std::collections::BTreeSet;

use sabi_nodes::link::Format;
use sabi_nodes::wgsl_struct;

use crate::bindings::{read_entry, storage_entry, texture_entry, uniform_entry};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::formats::format_of;
use crate::pipelines::fixed_kernel;
use crate::pool::array_view;
use crate::shaders::FixedShader;
use crate::surface::GpuSurface;
use crate::tile_set::{TileSet, tile_of};
use crate::uploads::storage_buffer;

/// Groups per workgroup.
pub(crate) const GROUP: u32 = 64;
/// Workgroups in a row of a dispatch.
const ROW: u32 = 32_768;
/// Maximum number of 32-bit words for the texels of a part, unless a single group has more: 16 MiB, which takes a fraction
/// of a second on software drivers.
const MAX_PART_WORDS: usize = 4 << 20;

/// Kind of values whose mean is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mean {
    /// Numbers.
    Plain,
    /// Unit vectors, whose mean is normalized.
    Unit,
}

/// Groups of texels of an atlas, on the device. In each group, the targets are set to the mean of the sources.
pub struct Shares {
    parts: Vec<ShareDispatch>,
    /// Tiles of sources, each paired with a tile of their targets.
    tiles: BTreeSet<[[u32; 3]; 2]>,
}

/// Groups that one dispatch processes.
struct ShareDispatch {
    count: u32,
    /// First index in `texels` of each group, as `share.wgsl` reads it.
    starts: wgpu::Buffer,
    texels: wgpu::Buffer,
}

wgsl_struct! {
    "surface/share" Share:
    /// Constants of one part of the groups.
    pub(crate) struct ShareConstants {
        group_count: u32,
        row_length: u32,
        has_unit_vectors: u32,
        pad: u32,
    }
}

impl Shares {
    /// Uploads the sources and targets of each group as texel indices, page by page and row by row. A texel may be a target
    /// only once.
    pub fn upload<'t>(
        gpu: &Gpu,
        surface: &GpuSurface,
        groups: impl IntoIterator<Item = [&'t [u32]; 2]>,
    ) -> Result<Shares, GpuError> {
        let [width, height, _] = surface.extent;
        let tile = |texel: &u32| tile_of(*texel, [width, height]);
        let mut tiles = BTreeSet::new();
        let mut parts = Vec::new();
        let (mut starts, mut texels) = (vec![0], Vec::new());
        for [sources, targets] in groups {
            if texels.len() + sources.len() + targets.len() >= MAX_PART_WORDS && starts.len() > 1 {
                parts.push(ShareDispatch::upload(gpu, &starts, &texels)?);
                starts.truncate(1);
                texels.clear();
            }
            for target in targets {
                tiles.extend(sources.iter().map(|source| [tile(source), tile(target)]));
            }
            texels.push(sources.len() as u32);
            texels.extend(sources);
            texels.extend(targets);
            starts.push(texels.len() as u32);
        }
        if starts.len() > 1 {
            parts.push(ShareDispatch::upload(gpu, &starts, &texels)?);
        }
        Ok(Shares { parts, tiles })
    }

    /// Returns the tiles, and those whose texels are set from values in them.
    pub fn spread(&self, tiles: &TileSet) -> TileSet {
        let places: BTreeSet<[u32; 3]> = tiles.places().collect();
        let shown = self.tiles.iter().filter(|[source, _]| places.contains(source));
        let targets: Vec<[u32; 3]> = shown.map(|[_, target]| *target).collect();
        tiles.and(&TileSet::new(targets))
    }

    /// Sets all targets in a copy of a texture on the atlas. The texture itself is not changed, since it may be cached.
    pub(crate) fn apply(
        &self,
        gpu: &Gpu,
        surface: &GpuSurface,
        textures: [&wgpu::Texture; 2],
        mean: Mean,
    ) -> Result<(), GpuError> {
        let format = format_of(textures[0])?;
        let mut parts = self.parts.iter();
        parts.try_for_each(|part| part.apply(gpu, surface, textures, format, mean))
    }
}

impl ShareDispatch {
    fn upload(gpu: &Gpu, starts: &[u32], texels: &[u32]) -> Result<ShareDispatch, GpuError> {
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        let buffer = |numbers: &[u32]| {
            let buffer = storage_buffer(gpu, "the texels that share a place", 4 * numbers.len() as u64, limit)?;
            gpu.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(numbers));
            Ok::<_, GpuError>(buffer)
        };
        Ok(ShareDispatch {
            count: starts.len() as u32 - 1,
            starts: buffer(starts)?,
            texels: buffer(texels)?,
        })
    }

    /// Sets the targets of these groups.
    fn apply(
        &self,
        gpu: &Gpu,
        surface: &GpuSurface,
        [texture, shown]: [&wgpu::Texture; 2],
        format: Format,
        mean: Mean,
    ) -> Result<(), GpuError> {
        let kernel = fixed_kernel(
            gpu,
            FixedShader::Share(format),
            &[
                uniform_entry(0),
                read_entry(1),
                read_entry(2),
                texture_entry(3),
                storage_entry(4, format),
            ],
        )?;
        let groups = self.count.div_ceil(GROUP);
        let constants = gpu.uniform(bytemuck::bytes_of(&ShareConstants {
            group_count: self.count,
            row_length: ROW.min(groups),
            has_unit_vectors: u32::from(mean == Mean::Unit),
            pad: 0,
        }));
        let [texture, shown] = [texture, shown].map(array_view);
        let group = gpu.bind(
            &kernel.layout,
            [
                constants.as_entire_binding(),
                self.starts.as_entire_binding(),
                self.texels.as_entire_binding(),
                wgpu::BindingResource::TextureView(&texture),
                wgpu::BindingResource::TextureView(&shown),
            ],
        );
        let bound = surface.bindings(gpu);
        gpu.submit_compute_pass(|pass| {
            pass.set_pipeline(&kernel.pipeline);
            pass.set_bind_group(0, &bound, &[]);
            pass.set_bind_group(1, &group, &[]);
            pass.dispatch_workgroups(ROW.min(groups), groups.div_ceil(ROW), 1);
            Ok(())
        })
    }
}
