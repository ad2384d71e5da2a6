//! Maps of a material as textures, for drawing.

use sabi_nodes::kind::Channel as Stored;
use sabi_plan::SlotRef;

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
    pub(crate) fn stored(&self) -> [(Stored, Option<SlotRef>); 7] {
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
