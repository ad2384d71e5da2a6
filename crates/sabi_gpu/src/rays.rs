//! Rays between two kernels: one shoots them, the caster follows them, and the other asks what they hit.

use bytemuck::{Pod, Zeroable};
use sabi_plan::RayCount;

use crate::device::Gpu;
use crate::error::GpuError;
use crate::run::SourceFill;
use crate::tiles::Slices;

/// A ray, as `Ray` in `shaders/lib/rays.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct RayRow {
    /// Where it starts, working units.
    pub origin: [f32; 3],
    /// How far it goes; 0 hits nothing.
    pub reach: f32,
    /// Its direction.
    pub direction: [f32; 3],
    /// Not used.
    pub pad: f32,
}

/// What a ray hit, as `RayHit` in `shaders/lib/rays.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct HitRow {
    /// How far away, working units; below 0 where nothing is hit.
    pub distance: f32,
    /// Which triangle.
    pub triangle: u32,
}

impl HitRow {
    /// Nothing is hit.
    pub const MISS: HitRow = HitRow {
        distance: -1.0,
        triangle: u32::MAX,
    };
}

/// Rays of one slice: bounds what rays take, and how long one slice takes.
const MOST_RAYS: usize = 1 << 18;
/// Texels of a tile.
const TILE_TEXELS: usize = 64;

/// Room for the rays of a slice of tiles, and for what they hit.
pub(crate) struct RayBuffers<'a> {
    gpu: &'a Gpu,
    rays: RayCount,
    tiles: usize,
    shot: wgpu::Buffer,
    hits: wgpu::Buffer,
    /// By which rays come into memory.
    mapped: wgpu::Buffer,
}

impl<'a> RayBuffers<'a> {
    pub(crate) fn new(gpu: &'a Gpu, rays: RayCount) -> Result<RayBuffers<'a>, GpuError> {
        let of_tile = TILE_TEXELS * rays.count.max(1) as usize;
        let tiles = (MOST_RAYS / of_tile).max(1);
        let buffer = |what: &'static str, row: usize, usage| {
            gpu.guarded(what, |device| {
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some(what),
                    size: (tiles * of_tile * row) as u64,
                    usage: wgpu::BufferUsages::STORAGE | usage,
                    mapped_at_creation: false,
                })
            })
        };
        Ok(RayBuffers {
            gpu,
            rays,
            tiles,
            shot: buffer("the rays", size_of::<RayRow>(), wgpu::BufferUsages::COPY_SRC)?,
            hits: buffer("what rays hit", size_of::<HitRow>(), wgpu::BufferUsages::COPY_DST)?,
            mapped: gpu.readback_buffer((tiles * of_tile * size_of::<RayRow>()) as u64)?,
        })
    }

    pub(crate) fn bindings(&self) -> [wgpu::BindingResource<'_>; 2] {
        [self.shot.as_entire_binding(), self.hits.as_entire_binding()]
    }

    /// Shoots, follows and asks, slice by slice. Each texel's rays are in one slice, so its mean is summed in one order.
    pub(crate) fn run(
        &self,
        slices: &Slices<'_>,
        [shoot, ask]: [&wgpu::ComputePipeline; 2],
        group: &wgpu::BindGroup,
        is_canceled: &dyn Fn() -> bool,
        caster: &mut dyn SourceFill,
    ) -> Result<(), GpuError> {
        let count = slices.tile_count() as usize;
        let mut hits = vec![HitRow::MISS; self.tiles * TILE_TEXELS * self.rays.count as usize];
        for first in (0..count).step_by(self.tiles) {
            if is_canceled() {
                return Err(GpuError::Canceled);
            }
            let end = (first + self.tiles).min(count);
            slices.submit(shoot, group, first as u32, end as u32);
            let rows = (end - first) * TILE_TEXELS * self.rays.count as usize;
            let hits = &mut hits[..rows];
            let bytes = (rows * size_of::<RayRow>()) as u64;
            // Rays are followed where they are mapped: there are hundreds of megabytes of them.
            let cast = self.gpu.look_at(&self.shot, &self.mapped, bytes, |bytes| {
                caster.cast(bytemuck::cast_slice(bytes), self.rays.finds, hits)
            })?;
            cast.map_err(GpuError::Source)?;
            self.gpu.queue.write_buffer(&self.hits, 0, bytemuck::cast_slice(hits));
            slices.submit(ask, group, first as u32, end as u32);
        }
        self.gpu.wait()
    }
}
