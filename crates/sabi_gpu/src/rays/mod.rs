//! Ray passes of a node: a kernel that writes rays, a caster that finds their hits, and a kernel that reads the hits.

mod caster;
pub(crate) mod device;
pub(crate) mod hierarchy;
mod hit_cache;
mod processor;
mod tile_caster;

use std::time::{Duration, Instant};

use sabi_nodes::kind::Finds;
use sabi_nodes::wgsl_struct;
use sabi_plan::StepRays;
use sabi_surface::atlas::TILE;

use crate::device::Gpu;
use crate::error::GpuError;
use crate::readback::StagingBuffer;
use crate::tiles::Slices;
use crate::waiting::Patience;

pub use caster::CasterChoice;
pub(crate) use caster::{Caster, caster, casts_on_device};
pub use hierarchy::{DeviceHierarchy, RayScene};
pub use hit_cache::Hits;
pub(crate) use hit_cache::{CachedHits, HitCache};

wgsl_struct! {
    "rays" StoredRay:
    /// A ray as kernels and casters exchange it.
    #[derive(Default)]
    pub(crate) struct RayRow {
        /// Origin, working units.
        pub origin: [f32; 3],
        /// Length, working units; 0 hits nothing.
        pub reach: f32,
        /// Unit direction.
        pub direction: [f32; 3],
        /// Triangle that it starts on.
        pub triangle: u32,
    }
}

wgsl_struct! {
    "rays" RayHit:
    /// A hit as kernels and casters exchange it.
    #[derive(Default)]
    pub(crate) struct HitRow {
        /// Distance, working units; below 0 where nothing is hit.
        pub distance: f32,
        /// Number of the triangle.
        pub triangle: u32,
    }
}

impl HitRow {
    /// No hit.
    pub(crate) const MISS: HitRow = HitRow {
        distance: -1.0,
        triangle: u32::MAX,
    };
}

/// Rays that a caster gets.
#[derive(Clone, Copy)]
pub(crate) struct CastRays {
    /// Rays of a tile.
    pub(crate) of_tile: usize,
    /// Rotation of a triangle's normal, in radians: hits on triangles that turn less count for nothing and need not be found.
    pub(crate) least_turn: Option<f32>,
}

/// Maximum number of rays of one slice. It limits the memory and the time of a slice.
const MAX_SLICE_RAYS: usize = 1 << 18;
/// Number of rays of the first slice, while the speed of the caster is unknown.
const FIRST_RAYS: usize = 1 << 16;
/// Texels of a tile.
const TILE_TEXELS: usize = (TILE * TILE) as usize;

/// Buffers for the rays of a slice of tiles and their hits.
pub(crate) struct RayBufferSet {
    pub(crate) rays: wgpu::Buffer,
    pub(crate) hits: wgpu::Buffer,
    /// Buffer through which rays are read back.
    staging: StagingBuffer,
}

/// A slice of the surface's tiles.
#[derive(Clone, Copy, Debug)]
struct Slice {
    first: usize,
    end: usize,
    /// Index of the buffers that hold its rays.
    set: usize,
}

/// Two sets of buffers, used alternately: the rays of one slice are written while those of the previous slice are cast.
pub(crate) struct RayBuffers<'a> {
    gpu: &'a Gpu,
    rays: &'a StepRays,
    /// Tiles whose rays fit into one set of buffers.
    tiles: usize,
    sets: [RayBufferSet; 2],
}

/// Bind groups of a kernel, one for each set of buffers.
pub(crate) type BufferSetGroups = [wgpu::BindGroup; 2];

/// Kernels and bind groups of a ray step.
pub(crate) struct RayPass<'a> {
    pub(crate) slices: &'a Slices<'a>,
    /// Writes rays.
    pub(crate) generation: &'a wgpu::ComputePipeline,
    /// Reads their hits.
    pub(crate) evaluation: &'a wgpu::ComputePipeline,
    pub(crate) groups: BufferSetGroups,
    /// Tiles of the first slice.
    pub(crate) first_tiles: usize,
    pub(crate) is_canceled: &'a dyn Fn() -> bool,
}

impl RayPass<'_> {
    fn generate(&self, groups: &BufferSetGroups, slice: Slice) {
        let [first, end] = [slice.first as u32, slice.end as u32];
        self.slices.submit(self.generation, &groups[slice.set], first, end);
    }

    fn evaluate(&self, slice: Slice) {
        let [first, end] = [slice.first as u32, slice.end as u32];
        self.slices.submit(self.evaluation, &self.groups[slice.set], first, end);
    }
}

impl<'a> RayBuffers<'a> {
    pub(crate) fn new(gpu: &'a Gpu, rays: &'a StepRays) -> Result<RayBuffers<'a>, GpuError> {
        let of_tile = TILE_TEXELS * rays.count as usize;
        let tiles = (MAX_SLICE_RAYS / of_tile).max(1);
        let buffer = |what: &'static str, row: usize| {
            gpu.guarded(what, |device| {
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some(what),
                    size: (tiles * of_tile * row) as u64,
                    usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                })
            })
        };
        let set = || {
            Ok::<_, GpuError>(RayBufferSet {
                rays: buffer("the rays", size_of::<RayRow>())?,
                hits: buffer("what rays hit", size_of::<HitRow>())?,
                staging: StagingBuffer::new(gpu, (tiles * of_tile * size_of::<RayRow>()) as u64)?,
            })
        };
        Ok(RayBuffers {
            gpu,
            rays,
            tiles,
            sets: [set()?, set()?],
        })
    }

    /// Bindings of one set of buffers.
    pub(crate) fn bindings(&self, set: usize) -> [wgpu::BindingResource<'_>; 2] {
        let set = &self.sets[set];
        [set.rays.as_entire_binding(), set.hits.as_entire_binding()]
    }

    /// Writes, casts and evaluates rays slice by slice. All rays of a texel are in one slice, so its sum has a fixed order.
    pub(crate) fn run(&self, pass: &RayPass<'_>, caster: &mut Caster<'_>) -> Result<(), GpuError> {
        self.cast_slices(pass, &pass.groups, self.rays.finds, caster, |slice, _| {
            pass.evaluate(slice);
            Ok(())
        })
    }

    /// Casts rays of the longest reach, with the parameters that `longest` binds, and returns their nearest hits.
    pub(crate) fn cast_longest(
        &self,
        pass: &RayPass<'_>,
        longest: &BufferSetGroups,
        caster: &mut Caster<'_>,
    ) -> Result<Vec<CachedHits>, GpuError> {
        let mut slices = Vec::new();
        self.cast_slices(pass, longest, Finds::Nearest, caster, |slice, set| {
            let tiles = [slice.first, slice.end];
            slices.push(hit_cache::copied_hits(self.gpu, tiles, self.rays.count, &set.hits)?);
            Ok(())
        })?;
        Ok(slices)
    }

    /// Evaluates rays with cached hits of longer rays.
    pub(crate) fn evaluate_cached(&self, pass: &RayPass<'_>, cached: &[CachedHits]) -> Result<(), GpuError> {
        for (at, cached) in cached.iter().enumerate() {
            if (pass.is_canceled)() {
                return Err(GpuError::Canceled);
            }
            let slice = Slice {
                first: cached.first,
                end: cached.end,
                set: at % 2,
            };
            pass.generate(&pass.groups, slice);
            hit_cache::copy_buffer(self.gpu, &cached.hits, &self.sets[slice.set].hits, cached.hits.size());
            pass.evaluate(slice);
            self.gpu.wait_with(Patience::for_slice(pass.is_canceled))?;
        }
        Ok(())
    }

    /// Writes and casts rays slice by slice. `then` is called for each slice once later submissions can read its hits.
    fn cast_slices(
        &self,
        pass: &RayPass<'_>,
        groups: &BufferSetGroups,
        finds: Finds,
        caster: &mut Caster<'_>,
        mut then: impl FnMut(Slice, &RayBufferSet) -> Result<(), GpuError>,
    ) -> Result<(), GpuError> {
        let count = pass.slices.tile_count() as usize;
        let begin = |caster: &mut Caster<'_>, [first, set]: [usize; 2], length: usize| {
            let end = (first + length).min(count);
            let slice = Slice { first, end, set };
            if first < end {
                pass.generate(groups, slice);
                caster.begin(self.gpu, pass.slices, &self.sets[set], self.rows(slice), finds)?;
            }
            Ok::<_, GpuError>((first < end).then_some(slice))
        };
        // The time that the node takes for each ray is unknown at first.
        let mut length = (FIRST_RAYS / self.of_tile()).clamp(1, self.tiles.min(pass.first_tiles));
        let mut ahead = begin(caster, [0, 0], length)?;
        while let Some(slice) = ahead {
            if (pass.is_canceled)() {
                return Err(GpuError::Canceled);
            }
            let started = Instant::now();
            ahead = begin(caster, [slice.end, 1 - slice.set], length)?;
            let set = &self.sets[slice.set];
            caster.finish(self.gpu, set, self.rows(slice), finds)?;
            then(slice, set)?;
            if caster.is_on_device() {
                // If a window shares the queue, slices must not pile up in it.
                self.gpu.wait_with(Patience::for_slice(pass.is_canceled))?;
            }
            length = self.length_after(slice, started.elapsed(), pass.slices.target());
        }
        self.gpu.wait_with(Patience::for_slice(pass.is_canceled))
    }

    /// Rays of a slice.
    fn rows(&self, slice: Slice) -> usize {
        (slice.end - slice.first) * self.of_tile()
    }

    /// Returns the facts about the rays that a caster needs.
    pub(crate) fn cast_rays(&self, least_turn: Option<f32>) -> CastRays {
        CastRays {
            of_tile: self.of_tile(),
            least_turn,
        }
    }

    /// Rays of a tile.
    fn of_tile(&self) -> usize {
        TILE_TEXELS * self.rays.count as usize
    }

    /// Returns the number of tiles of the next slice, given the time that the last one took.
    fn length_after(&self, slice: Slice, taken: Duration, target: Duration) -> usize {
        let tiles = (slice.end - slice.first) as f64;
        let scale = target.as_secs_f64() / taken.as_secs_f64().max(1e-5);
        // Limits the growth, since two slices are processed at the same time.
        ((tiles * scale.min(2.0)) as usize).clamp(1, self.tiles)
    }
}
