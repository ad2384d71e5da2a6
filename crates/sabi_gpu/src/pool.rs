//! Pool of textures that are reused by format and extent, within a budget of bytes.

use std::collections::BTreeMap;

use sabi_nodes::link::Format;

use crate::device::Gpu;
use crate::error::GpuError;
use crate::formats::wgpu_format;
use crate::texture_budget::TextureBudget;

/// Default budget for textures, those of the surface included.
pub const DEFAULT_BUDGET_BYTES: u64 = 4 << 30;

/// Width, height and pages of a texture.
pub(crate) type Extent = [u32; 3];

/// Texture memory of a run: its own textures and those of the surface. Cached results of earlier runs are not counted; the
/// cache has its own budget.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PoolReport {
    /// Bytes held now.
    pub bytes: u64,
    /// Highest number of bytes held.
    pub peak_bytes: u64,
}

/// Textures by format and extent.
#[derive(Debug)]
pub(crate) struct TexturePool {
    budget: TextureBudget,
    /// Number of bytes above which free textures are dropped before another one is created.
    aim_bytes: u64,
    free: BTreeMap<(Format, Extent), Vec<wgpu::Texture>>,
    report: PoolReport,
}

impl TexturePool {
    /// Creates an empty pool with a budget, of which `used_bytes` are in use already.
    pub(crate) fn new(budget: TextureBudget, used_bytes: u64) -> TexturePool {
        TexturePool {
            budget,
            aim_bytes: budget.bytes(),
            free: BTreeMap::new(),
            report: PoolReport {
                bytes: used_bytes,
                peak_bytes: used_bytes,
            },
        }
    }

    pub(crate) fn report(&self) -> PoolReport {
        self.report
    }

    /// Sets the number of bytes that will be needed at the same time, in addition to those held now. Free textures are kept
    /// up to this total.
    pub(crate) fn aim_at(&mut self, needed_bytes: u64) {
        self.aim_bytes = (self.report.bytes + needed_bytes).min(self.budget.bytes());
    }

    /// Drops free textures, the largest first, until a new texture would fit. Drops none if a free texture can be used.
    /// Returns true if any was dropped.
    pub(crate) fn make_room(&mut self, format: Format, extent: Extent) -> bool {
        if self.free.get(&(format, extent)).is_some_and(|free| !free.is_empty()) {
            return false;
        }
        let needed = bytes_of(format, extent);
        let mut dropped = false;
        while self.report.bytes + needed > self.aim_bytes {
            let of = self.free.iter().filter(|(_, textures)| !textures.is_empty());
            let Some(largest) = of
                .map(|(key, _)| *key)
                .max_by_key(|(format, extent)| bytes_of(*format, *extent))
            else {
                break;
            };
            if let Some(texture) = self.free.get_mut(&largest).and_then(Vec::pop) {
                self.discard(largest.0, &texture);
                dropped = true;
            }
        }
        dropped
    }

    /// Takes a texture with undefined content.
    pub(crate) fn take(&mut self, gpu: &Gpu, format: Format, extent: Extent) -> Result<wgpu::Texture, GpuError> {
        if let Some(texture) = self.free.get_mut(&(format, extent)).and_then(Vec::pop) {
            return Ok(texture);
        }
        self.make_room(format, extent);
        let bytes = bytes_of(format, extent);
        let needed = self.within_budget(bytes)?;
        let texture = texture(gpu, extent, format)?;
        self.report.bytes = needed;
        self.report.peak_bytes = self.report.peak_bytes.max(needed);
        Ok(texture)
    }

    /// Counts bytes of a texture that is held outside of the pool.
    pub(crate) fn count(&mut self, bytes: u64) -> Result<(), GpuError> {
        self.report.bytes = self.within_budget(bytes)?;
        self.report.peak_bytes = self.report.peak_bytes.max(self.report.bytes);
        Ok(())
    }

    /// Returns the number of bytes held after adding `bytes`, or an error if that is over the budget.
    fn within_budget(&self, bytes: u64) -> Result<u64, GpuError> {
        let needed = self.report.bytes + bytes;
        if needed <= self.budget.bytes() {
            return Ok(needed);
        }
        let needed_mib = needed.div_ceil(1 << 20);
        Err(match self.budget {
            TextureBudget::Textures(bytes) => GpuError::OverBudget {
                needed_mib,
                budget_mib: bytes >> 20,
            },
            TextureBudget::Process(bytes) => GpuError::OverMemory {
                needed_mib,
                left_mib: bytes >> 20,
            },
        })
    }

    /// Returns a texture to the pool.
    pub(crate) fn release(&mut self, format: Format, texture: wgpu::Texture) {
        let extent = [texture.width(), texture.height(), texture.depth_or_array_layers()];
        self.free.entry((format, extent)).or_default().push(texture);
    }

    /// Drops a texture that was taken and is no longer used.
    pub(crate) fn discard(&mut self, format: Format, texture: &wgpu::Texture) {
        let extent = [texture.width(), texture.height(), texture.depth_or_array_layers()];
        self.report.bytes -= bytes_of(format, extent);
        texture.destroy();
    }

    /// Drops the free textures.
    pub(crate) fn drop_free(&mut self) {
        for ((format, extent), textures) in std::mem::take(&mut self.free) {
            self.report.bytes -= textures.len() as u64 * bytes_of(format, extent);
            textures.iter().for_each(wgpu::Texture::destroy);
        }
    }
}

/// Bytes of a texture.
pub(crate) fn bytes_of(format: Format, extent: Extent) -> u64 {
    extent.iter().map(|side| u64::from(*side)).product::<u64>() * format.texel_bytes()
}

/// A texture that kernels read and write.
pub(crate) fn texture(gpu: &Gpu, [width, height, pages]: Extent, format: Format) -> Result<wgpu::Texture, GpuError> {
    gpu.guarded("a texture", |device| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: pages,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu_format(format),
            usage: wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::STORAGE_BINDING
                | wgpu::TextureUsages::COPY_SRC
                | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        })
    })
}

/// Returns a view of the whole texture as an array of pages.
pub(crate) fn array_view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}
