//! Maps of a material as textures, for drawing.

use sabi_nodes::link::Format;
use sabi_plan::SlotRef;

use crate::cache::ResultCache;
use crate::device::Gpu;
use crate::error::GpuError;
use crate::made_map::MadeMap;
use crate::run_options::RunOptions;
use crate::run_result::Run;
use crate::shares::{Mean, Shares};
use crate::surface::GpuSurface;

/// Slots of the planes of a material in a run; none for channels that the material does not set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MaterialSlots {
    /// Linear base color and alpha.
    pub color: Option<SlotRef>,
    /// Roughness, metallic, occlusion.
    pub surface: Option<SlotRef>,
    /// Height, working units.
    pub height: Option<SlotRef>,
    /// Slope of the model's own normal map.
    pub slope: Option<SlotRef>,
    /// Linear emission.
    pub emission: Option<SlotRef>,
    /// Share and roughness of a clear coat.
    pub coat: Option<SlotRef>,
    /// Direction of fine scratches in model space, as long as they are strong.
    pub anisotropy: Option<SlotRef>,
    /// Linear color and roughness of a sheen.
    pub sheen: Option<SlotRef>,
    /// Shares of light that spread below the surface, and transmission.
    pub subsurface: Option<SlotRef>,
}

/// Maps of a material on the linked atlas, as arrays of pages; none for channels that the material does not set.
#[derive(Clone, Debug, Default)]
pub struct DeviceMaps {
    /// Linear base color and alpha.
    pub color: Option<wgpu::Texture>,
    /// Roughness, metallic, occlusion.
    pub surface: Option<wgpu::Texture>,
    /// Linear emission.
    pub emission: Option<wgpu::Texture>,
    /// Height, working units.
    pub height: Option<wgpu::Texture>,
    /// Tangent-space normal, Y up, in the model's MikkTSpace frame, from which the exported map is made.
    pub normal: Option<wgpu::Texture>,
    /// Share and roughness of a clear coat.
    pub coat: Option<wgpu::Texture>,
    /// Direction in the tangent frame along which highlights are drawn out, and strength, as it is exported.
    pub anisotropy: Option<wgpu::Texture>,
    /// Linear color and roughness of a sheen.
    pub sheen: Option<wgpu::Texture>,
    /// Shares of light that spread below the surface, and transmission.
    pub subsurface: Option<wgpu::Texture>,
}

impl Gpu {
    /// Maps of a material of a run. Where charts share a place they hold the exported values, or without `shares` the result
    /// of each chart. They outlive the run. With a cache, only what has changed is made again.
    pub fn device_maps(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        slots: MaterialSlots,
        shares: Option<&Shares>,
        options: &RunOptions<'_>,
        mut cache: Option<&mut ResultCache>,
    ) -> Result<DeviceMaps, GpuError> {
        let MaterialSlots { height, slope, .. } = slots;
        let is_flat = height.is_none() && slope.is_none();
        let normal = match (is_flat, cache.as_deref_mut()) {
            (true, _) => None,
            (false, Some(cache)) => {
                Some(self.kept_result_normals(surface, run, [height, slope], shares, options, cache)?)
            }
            (false, None) => Some(self.result_normals(surface, run, [height, slope], shares, options)?),
        };
        let anisotropy = slots
            .anisotropy
            .map(|slot| {
                let made = self.anisotropy_texture(surface, run, slot, options)?;
                self.shown(surface, run, made, shares, Mean::Plain)
            })
            .transpose()?;
        let mut of = |slot: Option<SlotRef>| {
            slot.map(|slot| self.kept_result_texture(surface, run, slot, shares, cache.as_deref_mut()))
                .transpose()
        };
        Ok(DeviceMaps {
            color: of(slots.color)?,
            surface: of(slots.surface)?,
            emission: of(slots.emission)?,
            height: of(height)?,
            normal,
            coat: of(slots.coat)?,
            anisotropy,
            sheen: of(slots.sheen)?,
            subsurface: of(slots.subsurface)?,
        })
    }

    /// Texture of a result that the plan kept; with `shares` a copy with the exported values where charts share a place.
    pub fn result_texture(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        slot: SlotRef,
        shares: Option<&Shares>,
    ) -> Result<wgpu::Texture, GpuError> {
        let texture = run.texture(slot)?;
        match shares {
            Some(shares) => self.shared(surface, run, shares, &texture, Mean::Plain),
            None => Ok(texture),
        }
    }

    /// As [`Gpu::result_texture`]; a cache keeps the copy.
    pub fn kept_result_texture(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        slot: SlotRef,
        shares: Option<&Shares>,
        cache: Option<&mut ResultCache>,
    ) -> Result<wgpu::Texture, GpuError> {
        let (Some(shares), Some(cache)) = (shares, cache) else {
            return self.result_texture(surface, run, slot, shares);
        };
        let made = MadeMap::of(run, "shown", &[Some(slot)]);
        let texture = run.texture(slot)?;
        self.kept_shared(surface, run, shares, &texture, made, Mean::Plain, cache)
    }

    /// Normals of height and slope that a cache keeps, with `shares` as in [`Gpu::result_texture`].
    fn kept_result_normals(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        slots: [Option<SlotRef>; 2],
        shares: Option<&Shares>,
        options: &RunOptions<'_>,
        cache: &mut ResultCache,
    ) -> Result<wgpu::Texture, GpuError> {
        let normals = self.kept_normals(surface, run, slots, options, cache)?;
        let Some(shares) = shares else {
            return Ok(normals);
        };
        let made = MadeMap::of(run, "shown normals", &slots).map(|made| made.grown(surface));
        self.kept_shared(surface, run, shares, &normals, made, Mean::Unit, cache)
    }

    /// Normals of height and slope, with `shares` as in [`Gpu::result_texture`].
    fn result_normals(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        [height, slope]: [Option<SlotRef>; 2],
        shares: Option<&Shares>,
        options: &RunOptions<'_>,
    ) -> Result<wgpu::Texture, GpuError> {
        let normals = self.normal_texture(surface, run, height, slope, options)?;
        self.shown(surface, run, normals, shares, Mean::Unit)
    }

    /// A tangent-space map, with `shares` as in [`Gpu::result_texture`].
    fn shown(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        made: wgpu::Texture,
        shares: Option<&Shares>,
        mean: Mean,
    ) -> Result<wgpu::Texture, GpuError> {
        let Some(shares) = shares else {
            return Ok(made);
        };
        let shown = self.shared(surface, run, shares, &made, mean)?;
        run.pool.release(Format::Rgba32Float, made);
        Ok(shown)
    }
}

impl Run {
    /// Texture of a result that the plan kept, an array of pages.
    pub fn texture(&self, slot: SlotRef) -> Result<wgpu::Texture, GpuError> {
        let found = self.textures.get(slot).and_then(Option::as_ref);
        let missing = || GpuError::Defect("a result was requested that the plan did not keep".into());
        found.cloned().ok_or_else(missing)
    }
}
