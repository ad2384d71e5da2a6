//! What a result looks like, still on the device, for those that draw it.

use sabi_nodes::link::Format;
use sabi_plan::SlotRef;

use crate::device::Gpu;
use crate::error::GpuError;
use crate::run::{Run, RunOptions};
use crate::shares::{Mean, Shares};
use crate::surface::GpuSurface;

/// Where a run has the planes of a material.
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
}

/// The maps of a material on the linked atlas, as arrays of pages; none where a channel is what it is without being set.
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
    /// Tangent-space normal, Y up, in the model's MikkTSpace frame: what the exported map is made of.
    pub normal: Option<wgpu::Texture>,
}

impl Gpu {
    /// The maps of a material that a run has made. Where charts share a place, they hold what the exported ones do; without
    /// `shares`, each chart's own result. They stay what they are when the run is dropped.
    pub fn device_maps(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        slots: MaterialSlots,
        shares: Option<&Shares>,
        options: &RunOptions<'_>,
    ) -> Result<DeviceMaps, GpuError> {
        let MaterialSlots { height, slope, .. } = slots;
        let is_flat = height.is_none() && slope.is_none();
        let normal = match is_flat {
            true => None,
            false => Some(self.shown_normals(surface, run, [height, slope], shares, options)?),
        };
        let mut of = |slot: Option<SlotRef>| {
            slot.map(|slot| self.shown_texture(surface, run, slot, shares))
                .transpose()
        };
        Ok(DeviceMaps {
            color: of(slots.color)?,
            surface: of(slots.surface)?,
            emission: of(slots.emission)?,
            height: of(height)?,
            normal,
        })
    }

    /// The texture of a result that the plan kept; with `shares` a copy with what is exported where charts share a place.
    pub fn shown_texture(
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

    /// The same of the normals that height and slope make.
    fn shown_normals(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        [height, slope]: [Option<SlotRef>; 2],
        shares: Option<&Shares>,
        options: &RunOptions<'_>,
    ) -> Result<wgpu::Texture, GpuError> {
        let normals = self.normal_texture(surface, run, height, slope, options)?;
        let Some(shares) = shares else {
            return Ok(normals);
        };
        let shown = self.shared(surface, run, shares, &normals, Mean::Unit)?;
        run.pool.release(Format::Rgba32Float, normals);
        Ok(shown)
    }
}

impl Run {
    /// The texture of a result that the plan kept, as an array of pages.
    pub fn texture(&self, slot: SlotRef) -> Result<wgpu::Texture, GpuError> {
        let found = self.textures.get(slot).and_then(Option::as_ref);
        let missing = || GpuError::Defect("a result was requested that the plan did not keep".into());
        found.cloned().ok_or_else(missing)
    }
}
