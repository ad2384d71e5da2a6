//! Shadow maps: matrices and depths of each light.

use glam::camera::rh::proj::directx::{orthographic, perspective};
use glam::camera::rh::view::look_to_mat4;
use glam::{Mat4, Vec3};
use sabi_gpu::Gpu;

use crate::error::ViewError;
use crate::scene::{Light, LightPlace, MOST_LIGHTS};

/// Number of layers of all shadows together. A point light has six, the faces of a cube around it.
pub(crate) const LAYERS: usize = 6 * MOST_LIGHTS;
/// Format of the depths.
pub(crate) const SHADOW_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Texels along a side of a layer.
const SIDE: u32 = 2048;
/// Radius of the model around the middle of view space: half the diagonal of a unit cube, and a small margin.
const RADIUS: f32 = 0.9;
/// Near plane of a point light.
const NEAREST: f32 = 0.02;

/// Layers that a light's shadow takes.
pub(crate) fn layers_of(light: &Light) -> usize {
    match light {
        Light { has_shadow: false, .. } => 0,
        Light {
            place: LightPlace::Directional(_),
            ..
        } => 1,
        Light {
            place: LightPlace::Point(_),
            ..
        } => 6,
    }
}

/// Returns matrices from view space to the shadow layers of the lights, layer by layer.
pub(crate) fn shadow_matrices(lights: &[Light]) -> Vec<Mat4> {
    let with_shadow = lights.iter().filter(|light| light.has_shadow);
    with_shadow
        .flat_map(|light| match light.place {
            LightPlace::Directional(towards) => vec![directional_matrix(Vec3::from(towards).normalize_or(Vec3::Y))],
            LightPlace::Point(place) => point_matrices(Vec3::from(place)),
        })
        .collect()
}

fn directional_matrix(towards: Vec3) -> Mat4 {
    let up = if towards.y.abs() > 0.99 { Vec3::Z } else { Vec3::Y };
    let light_from_view = look_to_mat4(towards * 2.0 * RADIUS, -towards, up);
    orthographic(-RADIUS, RADIUS, -RADIUS, RADIUS, RADIUS, 3.0 * RADIUS) * light_from_view
}

/// Returns the matrices of the faces of a cube around a light, in the order of `layer_of` in `shadow.wgsl`.
fn point_matrices(place: Vec3) -> Vec<Mat4> {
    let farthest = place.length() + RADIUS + NEAREST;
    let clip = perspective(std::f32::consts::FRAC_PI_2, 1.0, NEAREST, farthest);
    let faces = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
    let face = |towards: Vec3| {
        let up = if towards.y.abs() > 0.5 { Vec3::Z } else { Vec3::Y };
        clip * look_to_mat4(place, towards, up)
    };
    faces.into_iter().map(face).collect()
}

/// Shadow maps of all lights, in consecutive layers.
pub(crate) struct ShadowMaps {
    texture: wgpu::Texture,
    /// All layers, for shaders.
    pub(crate) view: wgpu::TextureView,
    /// Vertices of the opaque model and lights whose shadows the maps show.
    pub(crate) cast: Option<(wgpu::Buffer, Vec<Light>)>,
}

impl ShadowMaps {
    /// Creates shadow maps with a number of layers; at least one, since a binding must not be empty.
    pub(crate) fn new(gpu: &Gpu, layers: usize) -> Result<ShadowMaps, ViewError> {
        let side = if layers == 0 { 1 } else { SIDE };
        let texture = gpu.guarded("the shadows", |device| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some("shadows"),
                size: wgpu::Extent3d {
                    width: side,
                    height: side,
                    depth_or_array_layers: layers.max(1) as u32,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: SHADOW_FORMAT,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        })?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        Ok(ShadowMaps {
            texture,
            view,
            cast: None,
        })
    }

    /// Returns true if there are this many layers.
    pub(crate) fn has_layers(&self, layers: usize) -> bool {
        let side = if layers == 0 { 1 } else { SIDE };
        (self.texture.width(), self.texture.depth_or_array_layers()) == (side, layers.max(1) as u32)
    }

    /// Returns one layer as a render target.
    pub(crate) fn layer(&self, layer: usize) -> wgpu::TextureView {
        self.texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: layer as u32,
            array_layer_count: Some(1),
            ..Default::default()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light(place: LightPlace) -> Light {
        Light {
            place,
            color: [1.0; 3],
            has_shadow: true,
            size_degrees: 0.0,
            follows_camera: false,
        }
    }

    #[test]
    fn a_directional_light_covers_the_whole_model() {
        for towards in [[0.0, 1.0, 0.0], [0.3, 0.5, -0.7], [-1.0, 0.0, 0.0]] {
            let matrix = shadow_matrices(&[light(LightPlace::Directional(towards))])[0];
            for corner in 0..8 {
                let side = |bit: u32| if corner >> bit & 1 == 1 { 0.5 } else { -0.5 };
                let seen = matrix.project_point3(Vec3::new(side(0), side(1), side(2)));
                assert!(
                    seen.x.abs() <= 1.0 && seen.y.abs() <= 1.0 && (0.0..=1.0).contains(&seen.z),
                    "{seen}"
                );
            }
        }
    }

    #[test]
    fn each_position_is_on_the_face_that_looks_at_it() {
        let place = Vec3::new(0.2, 0.4, 0.1);
        let faces = shadow_matrices(&[light(LightPlace::Point(place.to_array()))]);
        let towards = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
        for (face, towards) in faces.iter().zip(towards) {
            let seen = face.project_point3(place + towards * 0.5);
            assert!(
                seen.x.abs() < 1e-5 && seen.y.abs() < 1e-5 && (0.0..1.0).contains(&seen.z),
                "{seen}"
            );
        }
    }
}
