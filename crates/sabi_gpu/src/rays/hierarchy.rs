//! Ray hierarchy in memory and on the device.

use std::sync::OnceLock;

use sabi_surface::bvh::Bvh;

use crate::device::Gpu;
use crate::error::GpuError;
use crate::uploads::table_texture;

/// Scene that rays are cast into.
#[derive(Clone, Copy)]
pub struct RayScene<'a> {
    /// Hierarchy in model units.
    pub bvh: &'a Bvh,
    /// Factor from model units to working units.
    pub working_from_model: f64,
    /// Hierarchy on the device. It is uploaded when a caster on the device is first used.
    pub on_device: &'a OnceLock<DeviceHierarchy>,
}

/// Hierarchy on the device.
pub struct DeviceHierarchy {
    pub(super) nodes: wgpu::TextureView,
    pub(super) triangles: wgpu::TextureView,
    /// Transform from model units to those of the hierarchy: `(point − center) × scale`.
    pub(super) center: [f32; 3],
    pub(super) scale: f32,
}

/// Maximum number of levels of a hierarchy: `STACK` in `shaders/surface/cast.wgsl` holds one node per level.
pub(crate) const MAX_DEPTH: usize = 24;

impl DeviceHierarchy {
    /// Uploads a hierarchy, five rows per node and three per triangle.
    pub(super) fn upload(gpu: &Gpu, bvh: &Bvh) -> Result<DeviceHierarchy, GpuError> {
        let depth = bvh.depth();
        if depth > MAX_DEPTH {
            return Err(GpuError::TooDeep {
                depth,
                limit: MAX_DEPTH,
            });
        }
        let triangles = bvh.scaled_triangle_rows();
        let (center, scale) = bvh.scaled_from_model();
        let nodes = bytemuck::cast_slice(&bvh.tree().nodes);
        Ok(DeviceHierarchy {
            nodes: table_texture(gpu, "the ray hierarchy", nodes)?,
            triangles: table_texture(gpu, "the ray hierarchy's triangles", bytemuck::cast_slice(&triangles))?,
            center,
            scale,
        })
    }
}
