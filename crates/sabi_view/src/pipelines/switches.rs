//! Overrides for which pipelines of the model are specialized.

use crate::scene::{MOST_LIGHTS, MaterialLook, Mode, NodeType, Scene, Shot};

/// Bits of `MAPS` with their names in WGSL, in the order of [`MaterialLook::bound_maps`].
pub(crate) const MAP_BITS: [(&str, u32); 9] = [
    ("COLOR_MAP", 1),
    ("SURFACE_MAP", 2),
    ("EMISSION_MAP", 4),
    ("NORMAL_MAP", 8),
    ("HEIGHT_MAP", 16),
    ("COAT_MAP", 32),
    ("ANISOTROPY_MAP", 64),
    ("SHEEN_MAP", 128),
    ("SUBSURFACE_MAP", 256),
];
/// Bit of the color map.
const COLORS: u32 = MAP_BITS[0].1;
/// Values of `SHOWN_TYPE` other than that of a mask, which is 0.
pub(crate) const SHOWN_COLOR: u32 = 1;
pub(crate) const SHOWN_VECTOR: u32 = 2;

/// Properties of a surface that decide which of its points a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum RasterVariant {
    /// Opaque triangles.
    Opaque,
    /// Triangles with transparent places.
    Transparent,
    /// Triangles with heights.
    Relief,
    /// Triangles with transparent places and heights.
    TransparentRelief,
}

/// Values of the overrides of `switches.wgsl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Switches {
    pub(crate) mode: u32,
    pub(crate) maps: u32,
    pub(crate) shown_type: u32,
    pub(crate) light_count: u32,
    pub(crate) shadows_of: u32,
    pub(crate) openness: u32,
}

impl Switches {
    /// Values for a raster.
    pub(crate) fn of_raster(look: &MaterialLook, mode: Mode, variant: RasterVariant) -> Switches {
        let is_transparent = matches!(variant, RasterVariant::Transparent | RasterVariant::TransparentRelief);
        Switches {
            // Other modes do not change what the raster writes.
            mode: match mode {
                Mode::Density | Mode::Shift => mode.number(),
                _ => Mode::Material.number(),
            },
            maps: if is_transparent {
                bits_of(look, mode) & COLORS
            } else {
                0
            },
            ..Switches::default()
        }
    }

    /// Values for the lights of a picture.
    pub(crate) fn lights_of(scene: &Scene<'_>, shot: &Shot) -> Switches {
        let lights = &scene.lights[..scene.lights.len().min(MOST_LIGHTS)];
        let shadows = lights.iter().zip(0..).filter(|(light, _)| light.has_shadow);
        let (light_count, shadows_of) = match shot.mode {
            Mode::Material => (lights.len() as u32, shadows.map(|(_, bit)| 1 << bit).sum()),
            _ => (0, 0),
        };
        Switches {
            light_count,
            shadows_of,
            ..Switches::default()
        }
    }

    /// Values for the shading of a pixel.
    pub(crate) fn of_shading(look: &MaterialLook, scene: &Scene<'_>, shot: &Shot) -> Switches {
        Switches {
            mode: shot.mode.number(),
            maps: bits_of(look, shot.mode),
            shown_type: match look.shown_node(shot.mode).map(|node| node.value_type) {
                None | Some(NodeType::Mask) => 0,
                Some(NodeType::Color) => SHOWN_COLOR,
                Some(NodeType::Vector) => SHOWN_VECTOR,
            },
            openness: u32::from(shot.mode == Mode::Material && scene.model.openness().is_some()),
            ..Switches::lights_of(scene, shot)
        }
    }

    /// Returns the values about lights, with the names of their overrides.
    pub(crate) fn of_lights(self) -> [(&'static str, f64); 2] {
        let [.., count, shadows, _] = self.named();
        [count, shadows]
    }

    /// Returns the values with the names of their overrides.
    pub(crate) fn named(self) -> [(&'static str, f64); 6] {
        [
            ("MODE", self.mode),
            ("MAPS", self.maps),
            ("SHOWN_TYPE", self.shown_type),
            ("LIGHT_COUNT", self.light_count),
            ("SHADOWS_OF", self.shadows_of),
            ("OPENNESS", self.openness),
        ]
        .map(|(name, value)| (name, f64::from(value)))
    }
}

fn bits_of(look: &MaterialLook, mode: Mode) -> u32 {
    let maps = look.bound_maps(mode).into_iter().zip(MAP_BITS);
    maps.filter(|(map, _)| map.is_some()).map(|(_, (_, bit))| bit).sum()
}
