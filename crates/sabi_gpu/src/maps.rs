//! Maps of a material as textures, for drawing.

use sabi_nodes::kind::Channel as Stored;
use sabi_nodes::link::Plane;
use sabi_plan::SlotRef;

use crate::borders::BorderKind;
use crate::cache::ResultCache;
use crate::device::Gpu;
use crate::error::GpuError;
use crate::made_map::MadeMap;
use crate::run_options::RunOptions;
use crate::run_result::Run;
use crate::shares::Mean;
use crate::shown_maps::{Exported, ShownMap};
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
    /// Direction of fine scratches in model space. Its length is their strength.
    pub anisotropy: Option<SlotRef>,
    /// Linear color and roughness of a sheen.
    pub sheen: Option<SlotRef>,
    /// Shares of light that is scattered below the surface, and transmission.
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
    /// Tangent-space normal, Y up, in the model's MikkTSpace frame. The exported map is computed from it.
    pub normal: Option<wgpu::Texture>,
    /// Share and roughness of a clear coat.
    pub coat: Option<wgpu::Texture>,
    /// Direction in the tangent frame in which highlights are stretched, and strength, as in the exported map.
    pub anisotropy: Option<wgpu::Texture>,
    /// Linear color and roughness of a sheen.
    pub sheen: Option<wgpu::Texture>,
    /// Shares of light that is scattered below the surface, and transmission.
    pub subsurface: Option<wgpu::Texture>,
}

impl MaterialSlots {
    /// Returns the planes that are shown in the form in which they are stored, in the order of their channels.
    fn stored(&self) -> [(Stored, Option<SlotRef>); 7] {
        [
            (Stored::Color, self.color),
            (Stored::Surface, self.surface),
            (Stored::Emission, self.emission),
            (Stored::Height, self.height),
            (Stored::Coat, self.coat),
            (Stored::Sheen, self.sheen),
            (Stored::Subsurface, self.subsurface),
        ]
    }
}

impl Gpu {
    /// Returns the maps of a material of a run, with the changes that exported maps have. They remain valid after the run.
    /// With a cache, only maps that have changed are computed again.
    pub fn device_maps(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        slots: MaterialSlots,
        exported: Exported<'_>,
        options: &RunOptions<'_>,
        mut cache: Option<&mut ResultCache>,
    ) -> Result<DeviceMaps, GpuError> {
        let mut maps = Vec::new();
        for (channel, slot) in slots.stored() {
            if let Some(slot) = slot {
                maps.push(stored_map(surface, run, slot, Plane::Material(channel))?);
            }
        }
        let is_flat = slots.height.is_none() && slots.slope.is_none();
        if !is_flat {
            maps.push(self.shown_normals(surface, run, [slots.height, slots.slope], options, cache.as_deref_mut())?);
        }
        if let Some(slot) = slots.anisotropy {
            maps.push(ShownMap {
                texture: self.anisotropy_texture(surface, run, slot, options)?,
                made: None,
                kind: BorderKind::of(Plane::Material(Stored::Anisotropy)),
                mean: Mean::Plain,
                is_spare: true,
            });
        }
        let mut shown = self.shown_maps(surface, run, exported, maps, cache)?.into_iter();
        // The order is that of the fields above.
        let [color, surface, emission, height, coat, sheen, subsurface] =
            slots.stored().map(|(_, slot)| slot.and_then(|_| shown.next()));
        Ok(DeviceMaps {
            color,
            surface,
            emission,
            height,
            normal: if is_flat { None } else { shown.next() },
            coat,
            anisotropy: slots.anisotropy.and_then(|_| shown.next()),
            sheen,
            subsurface,
        })
    }

    /// Returns the texture of a plane of a result that the plan kept, with the changes that exported maps have. With a
    /// cache, a copy is kept there.
    pub fn shown_result(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        slot: SlotRef,
        plane: Plane,
        exported: Exported<'_>,
        cache: Option<&mut ResultCache>,
    ) -> Result<wgpu::Texture, GpuError> {
        let map = stored_map(surface, run, slot, plane)?;
        let shown = self.shown_maps(surface, run, exported, vec![map], cache)?.pop();
        shown.ok_or_else(|| GpuError::Defect("a map was not shown".into()))
    }

    /// Computes the normals of height and slope.
    fn shown_normals(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        slots: [Option<SlotRef>; 2],
        options: &RunOptions<'_>,
        cache: Option<&mut ResultCache>,
    ) -> Result<ShownMap, GpuError> {
        let [height, slope] = slots;
        let is_spare = cache.is_none();
        let texture = match cache {
            Some(cache) => self.kept_normals(surface, run, slots, options, cache)?,
            None => self.normal_texture(surface, run, height, slope, options)?,
        };
        // Normals depend on the heights around them, and their ghosts on the texels around those.
        let made = MadeMap::of(run, "shown normals", &slots).map(|made| made.grown(surface).grown(surface));
        Ok(ShownMap {
            texture,
            made,
            kind: BorderKind::of(Plane::Vector),
            mean: Mean::Unit,
            is_spare,
        })
    }
}

/// A plane of a result that is shown.
fn stored_map(surface: &GpuSurface, run: &Run, slot: SlotRef, plane: Plane) -> Result<ShownMap, GpuError> {
    Ok(ShownMap {
        texture: run.texture(slot)?,
        // Ghosts depend on the texels of their chart around them.
        made: MadeMap::of(run, "shown", &[Some(slot)]).map(|made| made.grown(surface)),
        kind: BorderKind::of(plane),
        mean: Mean::Plain,
        is_spare: false,
    })
}

impl Run {
    /// Returns the texture of a result that the plan kept. It is an array of pages.
    pub fn texture(&self, slot: SlotRef) -> Result<wgpu::Texture, GpuError> {
        let found = self.textures.get(slot).and_then(Option::as_ref);
        let missing = || GpuError::Defect("a result was requested that the plan did not keep".into());
        found.cloned().ok_or_else(missing)
    }
}
