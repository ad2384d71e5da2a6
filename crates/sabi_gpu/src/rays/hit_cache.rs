//! Cached hits of the longest rays that a knob allows. Shorter rays with the same origin and direction need not be cast.

use std::collections::BTreeMap;

use super::{HitRow, TILE_TEXELS};
use crate::device::Gpu;
use crate::error::GpuError;

/// Origin of ray hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hits {
    /// Rays are cast in this run with the length that the parameters give.
    #[default]
    Cast,
    /// For use while a knob is moved: rays are cast once with the largest length that the knob allows. Their hits are kept
    /// in the result cache, and hits of shorter rays are derived from them. Results differ from those of [`Hits::Cast`] by
    /// rounding, so they are not cached. Without a cache, or if it has no room, rays are cast as usual.
    Cached,
}

/// Hits of a range of tiles.
pub(crate) struct CachedHits {
    pub(crate) first: usize,
    pub(crate) end: usize,
    pub(crate) hits: wgpu::Buffer,
}

struct CachedRays {
    slices: Vec<CachedHits>,
    bytes: u64,
    last_used: u64,
}

/// Cached hits by the key of their rays; the least recently used are dropped first.
pub(crate) struct HitCache {
    budget_bytes: u64,
    uses: u64,
    rays: BTreeMap<[u8; 32], CachedRays>,
}

impl HitCache {
    pub(crate) fn new(budget_bytes: u64) -> HitCache {
        HitCache {
            budget_bytes,
            uses: 0,
            rays: BTreeMap::new(),
        }
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> u64 {
        self.rays.values().map(|rays| rays.bytes).sum()
    }

    /// Returns true if the hits of `rays` rays for each texel of `tiles` tiles fit into the budget.
    pub(crate) fn fits(&self, tiles: usize, rays: u32) -> bool {
        bytes_of(tiles, rays) <= self.budget_bytes
    }

    /// Returns true if hits of a key are cached.
    pub(crate) fn contains(&self, key: &[u8; 32]) -> bool {
        self.rays.contains_key(key)
    }

    /// Returns the cached hits of a key; empty if there are none.
    pub(crate) fn get(&mut self, key: &[u8; 32]) -> &[CachedHits] {
        self.uses += 1;
        match self.rays.get_mut(key) {
            Some(rays) => {
                rays.last_used = self.uses;
                &rays.slices
            }
            None => &[],
        }
    }

    /// Caches hits and drops the least recently used ones over the budget.
    pub(crate) fn insert(&mut self, key: [u8; 32], slices: Vec<CachedHits>) {
        let bytes = slices.iter().map(|slice| slice.hits.size()).sum();
        while self.bytes() + bytes > self.budget_bytes {
            let oldest = self.rays.iter().min_by_key(|(_, rays)| rays.last_used);
            let Some(oldest) = oldest.map(|(key, _)| *key) else {
                break;
            };
            self.rays.remove(&oldest);
        }
        self.uses += 1;
        let last_used = self.uses;
        let rays = CachedRays {
            slices,
            bytes,
            last_used,
        };
        self.rays.insert(key, rays);
    }
}

/// Bytes of the hits of `rays` rays for each texel of `tiles` tiles.
pub(super) fn bytes_of(tiles: usize, rays: u32) -> u64 {
    (tiles * TILE_TEXELS * size_of::<HitRow>()) as u64 * u64::from(rays)
}

/// Copies hits of a range of tiles to a buffer of their own.
pub(super) fn copied_hits(
    gpu: &Gpu,
    [first, end]: [usize; 2],
    rays: u32,
    from: &wgpu::Buffer,
) -> Result<CachedHits, GpuError> {
    let bytes = bytes_of(end - first, rays);
    let hits = gpu.guarded("what rays hit", |device| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("cached hits"),
            size: bytes,
            usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    })?;
    copy_buffer(gpu, from, &hits, bytes);
    Ok(CachedHits { first, end, hits })
}

/// Copies the first bytes of a buffer to another.
pub(super) fn copy_buffer(gpu: &Gpu, from: &wgpu::Buffer, to: &wgpu::Buffer, bytes: u64) {
    let mut encoder = gpu
        .device
        .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_buffer_to_buffer(from, 0, to, 0, bytes);
    gpu.queue.submit([encoder.finish()]);
}
