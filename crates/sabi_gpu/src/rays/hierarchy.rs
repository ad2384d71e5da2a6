//! What rays are followed through, in memory and on the device.

use std::sync::OnceLock;

use sabi_surface::bvh::Bvh;

use crate::device::Gpu;
use crate::error::GpuError;
use crate::uploads::table_texture;

/// What rays are followed through.
#[derive(Clone, Copy)]
pub struct RayScene<'a> {
    /// The hierarchy, in the model's own units.
    pub bvh: &'a Bvh,
    /// Factor from them to working units.
    pub working_from_model: f64,
    /// The same on the device, once a caster there was asked for.
    pub on_device: &'a OnceLock<DeviceHierarchy>,
}

/// The hierarchy on the device.
pub struct DeviceHierarchy {
    pub(super) nodes: wgpu::TextureView,
    pub(super) triangles: wgpu::TextureView,
    /// What turns model units into the hierarchy's own: `(point − center) × scale`.
    pub(super) center: [f32; 3],
    pub(super) scale: f32,
}

/// As `STACK` in `shaders/surface/cast.wgsl`: a node a level may wait.
const DEEPEST: usize = 24;

impl DeviceHierarchy {
    /// Uploads it, five rows a node and three a triangle.
    pub(super) fn upload(gpu: &Gpu, bvh: &Bvh) -> Result<DeviceHierarchy, GpuError> {
        let depth = bvh.depth();
        if depth > DEEPEST {
            return Err(GpuError::TooDeep { depth, limit: DEEPEST });
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
