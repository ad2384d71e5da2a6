//! Scenes and views of them. They are plain values, created by the caller.

use std::str::FromStr;

use sabi_gpu::DeviceMaps;

use crate::camera::Camera;
use crate::environment::Environment;
use crate::model::ViewModel;
use crate::shade::GroundShade;

/// Bloom of pictures that do not set their own: it is visible only around highlights and emission.
pub const USUAL_BLOOM: f32 = 0.1;
/// Maximum number of lights of a scene.
pub const MOST_LIGHTS: usize = 4;

/// Model with its materials and lights.
pub struct Scene<'a> {
    /// The model.
    pub model: &'a ViewModel,
    /// Looks of its materials, at most 255.
    pub looks: &'a [MaterialLook],
    /// Number of the look of each material of the model; triangles of other materials are not drawn.
    pub look_of_material: &'a [usize],
    /// Environment light.
    pub environment: &'a Environment,
    /// Lights in addition to the environment, at most [`MOST_LIGHTS`]. Further lights are ignored.
    pub lights: &'a [Light],
}

impl Scene<'_> {
    /// Returns the ground of a shot that shows it.
    pub(crate) fn ground(&self, shot: &Shot) -> Option<&GroundShade> {
        self.model.ground().filter(|_| shot.has_ground)
    }
}

/// Look of a material.
#[derive(Clone, Debug)]
pub struct MaterialLook {
    /// Its maps.
    pub maps: DeviceMaps,
    /// Linear base color and alpha, used if there is no map.
    pub color: [f32; 4],
    /// Roughness, metallic and occlusion, used if there are no maps.
    pub surface: [f32; 3],
    /// True if alpha is 1 everywhere, so that the surface hides everything behind it.
    pub is_opaque: bool,
    /// Result of a single node, for [`Mode::Node`] and [`Mode::NodeOnClay`].
    pub node: Option<NodeLook>,
}

impl MaterialLook {
    /// Returns the node's result in the modes that show it.
    pub(crate) fn shown_node(&self, mode: Mode) -> Option<&NodeLook> {
        self.node
            .as_ref()
            .filter(|_| matches!(mode, Mode::Node | Mode::NodeOnClay))
    }

    /// Returns the textures to bind as the maps of `maps.wgsl`, in their order. A node's result replaces the color map.
    pub(crate) fn bound_maps(&self, mode: Mode) -> [Option<&wgpu::Texture>; 9] {
        let DeviceMaps {
            color,
            surface,
            emission,
            height,
            normal,
            coat,
            anisotropy,
            sheen,
            subsurface,
        } = &self.maps;
        let first = self.shown_node(mode).map(|node| &node.texture).or(color.as_ref());
        let others = [surface, emission, normal, height, coat, anisotropy, sheen, subsurface];
        let [surface, emission, normal, height, coat, anisotropy, sheen, subsurface] = others.map(Option::as_ref);
        [
            first, surface, emission, normal, height, coat, anisotropy, sheen, subsurface,
        ]
    }
}

/// Result of a single node on the linked atlas.
#[derive(Clone, Debug)]
pub struct NodeLook {
    /// Its texture, an array of pages.
    pub texture: wgpu::Texture,
    /// Type of its values.
    pub value_type: NodeType,
}

/// Type of the values of a node's result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeType {
    /// One number, shown as gray.
    Mask,
    /// A linear color.
    Color,
    /// A vector. −1..1 is shown as 0..1.
    Vector,
}

/// A light in addition to the environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Position or direction.
    pub place: LightPlace,
    /// Linear color: for a directional light the irradiance on a surface that faces it, for a point light the same at distance 1.
    pub color: [f32; 3],
    /// True if the model casts a shadow in this light.
    pub has_shadow: bool,
    /// Angle across the disc of a directional light in degrees. The larger it is, the softer is the shadow; 0 is a point.
    pub size_degrees: f32,
    /// True if it turns with the camera around the model.
    pub follows_camera: bool,
}

impl Light {
    /// Returns the light turned about +Y, for lights that orbit the model or follow the camera.
    pub fn turned(self, degrees: f32) -> Light {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let turned = |[x, y, z]: [f32; 3]| [cos * x + sin * z, y, cos * z - sin * x];
        Light {
            place: match self.place {
                LightPlace::Directional(towards) => LightPlace::Directional(turned(towards)),
                LightPlace::Point(place) => LightPlace::Point(turned(place)),
            },
            ..self
        }
    }
}

/// Position or direction of a light in view space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightPlace {
    /// Directional light. The direction points toward the light.
    Directional([f32; 3]),
    /// Point light at this position.
    Point([f32; 3]),
}

impl LightPlace {
    /// Returns a directional light from two angles: around +Y from +Z towards +X, and above the horizon.
    pub fn from_angles(yaw_degrees: f32, pitch_degrees: f32) -> LightPlace {
        let (sin_yaw, cos_yaw) = yaw_degrees.to_radians().sin_cos();
        let (sin_pitch, cos_pitch) = pitch_degrees.to_radians().sin_cos();
        LightPlace::Directional([sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch])
    }
}

/// View of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// Camera.
    pub camera: Camera,
    /// Rotation of the environment about +Y, degrees.
    pub environment_turn_degrees: f32,
    /// Factor of the environment's light.
    pub environment_strength: f32,
    /// Exposure, stops.
    pub exposure_stops: f32,
    /// Share of the light above white that is spread around it before the view transform, 0 to 1: the glow of highlights
    /// and emission. Alpha is not changed, so that no light reaches transparent places.
    pub bloom: f32,
    /// View transform.
    pub transform: ViewTransform,
    /// Background.
    pub background: Background,
    /// True if the ground below the model shows its shade.
    pub has_ground: bool,
    /// Mode.
    pub mode: Mode,
    /// True if heights are ray-marched, so that they occlude each other and cast shadows. This is slow on software drivers.
    pub has_relief: bool,
    /// Lowest and highest height in working units.
    pub height_range: [f32; 2],
    /// Lines over the model.
    pub lines: Vec<Lines>,
    /// Samples per pixel, whose mean is shown: 1 is quick, 16 gives clean edges.
    pub samples: u32,
}

impl Shot {
    /// Returns true if light above white is spread.
    pub(crate) fn has_bloom(&self) -> bool {
        self.mode == Mode::Material && self.bloom > 0.0
    }

    /// The lit material with default settings.
    pub fn new(camera: Camera) -> Shot {
        Shot {
            camera,
            environment_turn_degrees: 0.0,
            environment_strength: 1.0,
            exposure_stops: 0.0,
            bloom: USUAL_BLOOM,
            transform: ViewTransform::default(),
            background: Background::Blurred,
            has_ground: false,
            mode: Mode::Material,
            has_relief: false,
            height_range: [0.0, 0.0],
            lines: Vec::new(),
            samples: 1,
        }
    }
}

/// View transform from light to display values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ViewTransform {
    /// Only the sRGB curve: values brighter than white are clipped.
    Standard,
    /// PBR Neutral of the Khronos Group: colors are kept, and only highlights are compressed.
    #[default]
    Neutral,
    /// AgX: bright colors fade to white as on film.
    AgX,
    /// AgX with its punchy look: more contrast and saturation.
    PunchyAgX,
    /// The ACES reference rendering for sRGB displays.
    Aces,
}

/// Background of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// The environment, sharp.
    Environment,
    /// The environment, out of focus.
    Blurred,
    /// A uniform gray that darkens towards the corners, the same in every light.
    Studio,
    /// One color, linear and display-referred.
    Plain([f32; 3]),
    /// No background: the picture is transparent there.
    Clear,
}

/// Aspect of the model that is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// The lit material.
    #[default]
    Material,
    /// The base color, as it is exported.
    BaseColor,
    /// Opacity.
    Opacity,
    /// Roughness.
    Roughness,
    /// Metallic.
    Metallic,
    /// Occlusion; 1 is open.
    Occlusion,
    /// Height, scaled between two bounds.
    Height,
    /// Tangent-space normal.
    Normal,
    /// Normal used for lighting, in model space.
    ModelNormal,
    /// Emission.
    Emission,
    /// Share of the surface below a clear coat.
    Coat,
    /// Roughness of the clear coat.
    CoatRoughness,
    /// Direction in the tangent frame in which highlights are stretched, and strength.
    Anisotropy,
    /// Color of the sheen.
    Sheen,
    /// Roughness of the sheen.
    SheenRoughness,
    /// Shares of light that is scattered below the surface.
    Subsurface,
    /// Share of the light that passes through the surface.
    Transmission,
    /// Result of a single node.
    Node,
    /// Mask of a single node on clay, dark where the mask is 0, so that the shape is visible during painting. Other results
    /// are shown without clay.
    NodeOnClay,
    /// Squares along the texture coordinates.
    Checker,
    /// Density of texels relative to the mean.
    Density,
    /// Front faces blue, back faces red.
    Facing,
    /// Plain clay, which shows only the shape.
    Clay,
    /// Shift of the visible point by relief, in texels along u and v; for tests.
    Shift,
}

/// Names of modes, with their numbers in `modes.wgsl`.
const MODES: [(&str, Mode, u32); 24] = [
    ("material", Mode::Material, 0),
    ("base_color", Mode::BaseColor, 1),
    ("opacity", Mode::Opacity, 2),
    ("roughness", Mode::Roughness, 3),
    ("metallic", Mode::Metallic, 4),
    ("occlusion", Mode::Occlusion, 5),
    ("height", Mode::Height, 6),
    ("normal", Mode::Normal, 7),
    ("model_normal", Mode::ModelNormal, 15),
    ("emission", Mode::Emission, 8),
    ("coat", Mode::Coat, 16),
    ("coat_roughness", Mode::CoatRoughness, 17),
    ("anisotropy", Mode::Anisotropy, 18),
    ("sheen", Mode::Sheen, 19),
    ("sheen_roughness", Mode::SheenRoughness, 20),
    ("subsurface", Mode::Subsurface, 21),
    ("transmission", Mode::Transmission, 22),
    ("node", Mode::Node, 9),
    ("node_on_clay", Mode::NodeOnClay, 23),
    ("checker", Mode::Checker, 10),
    ("density", Mode::Density, 11),
    ("facing", Mode::Facing, 12),
    ("clay", Mode::Clay, 13),
    ("shift", Mode::Shift, 14),
];

impl Mode {
    /// Returns the names of all modes that need only a model with its maps.
    pub fn names() -> impl Iterator<Item = &'static str> {
        MODES
            .iter()
            .filter(|(_, mode, _)| mode.can_be_chosen())
            .map(|(name, ..)| *name)
    }

    /// Returns true if the mode can be chosen by its name alone.
    fn can_be_chosen(self) -> bool {
        !matches!(self, Mode::Node | Mode::NodeOnClay | Mode::Shift)
    }

    /// Names of all modes with their numbers in `modes.wgsl`.
    pub(crate) fn numbers() -> impl Iterator<Item = (&'static str, u32)> {
        MODES.iter().map(|(name, _, number)| (*name, *number))
    }

    /// Its number in `modes.wgsl`.
    pub(crate) fn number(self) -> u32 {
        MODES
            .iter()
            .find(|(_, mode, _)| *mode == self)
            .map_or(0, |(.., number)| *number)
    }
}

impl FromStr for Mode {
    type Err = String;

    fn from_str(text: &str) -> Result<Mode, String> {
        let named = MODES
            .iter()
            .find(|(name, mode, _)| *name == text && mode.can_be_chosen());
        named.map(|(_, mode, _)| *mode).ok_or_else(|| {
            let names: Vec<&str> = Mode::names().collect();
            format!("there is no view '{text}'; there are {}, and node:ID", names.join(", "))
        })
    }
}

/// Lines over the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lines {
    /// The edges of all triangles.
    Wires,
    /// Borders of charts.
    Seams,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mode_is_found_by_its_name_and_a_wrong_name_lists_them() {
        assert_eq!("base_color".parse(), Ok(Mode::BaseColor));
        assert_eq!(
            "color".parse::<Mode>(),
            Err(
                "there is no view 'color'; there are material, base_color, opacity, roughness, metallic, occlusion, \
                 height, normal, model_normal, emission, coat, coat_roughness, anisotropy, sheen, sheen_roughness, \
                 subsurface, transmission, checker, density, facing, clay, and node:ID"
                    .to_owned()
            )
        );
    }
}
