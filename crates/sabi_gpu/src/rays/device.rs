//! Ray caster that runs as a kernel on the device.

use std::sync::Arc;

use sabi_nodes::kind::Finds;
use sabi_nodes::wgsl_struct;

use super::RayBufferSet;
use super::hierarchy::{DeviceHierarchy, RayScene};
use crate::bindings::{read_entry, table_entry, uniform_entry, write_entry};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::pipeline_cache::FixedKernel;
use crate::pipelines::fixed_kernel;
use crate::shaders::FixedShader;
use crate::tiles::Slices;

/// Rays per workgroup, as in `shaders/surface/cast.wgsl`.
pub(crate) const GROUP: u32 = 64;
/// Workgroups in a row of a dispatch; adapters allow 65 535.
const ROW: u32 = 32_768;

wgsl_struct! {
    "surface/cast" Casting:
    /// Constants of the caster.
    pub(crate) struct CastConstants {
        center: [f32; 3],
        scale: f32,
        rays: u32,
        row_length: u32,
        is_nearest: u32,
        pad: u32,
    }
}

/// Ray caster that runs as a kernel on the device.
pub(crate) struct DeviceCaster<'a> {
    hierarchy: &'a DeviceHierarchy,
    working_from_model: f64,
    kernel: Arc<FixedKernel>,
    constants: wgpu::Buffer,
}

impl<'a> DeviceCaster<'a> {
    pub(super) fn new(gpu: &Gpu, scene: RayScene<'a>) -> Result<DeviceCaster<'a>, GpuError> {
        let hierarchy = match scene.on_device.get() {
            Some(known) => known,
            None => {
                let made = DeviceHierarchy::upload(gpu, scene.bvh)?;
                scene.on_device.get_or_init(|| made)
            }
        };
        let entries = [
            uniform_entry(0),
            table_entry(1),
            table_entry(2),
            read_entry(3),
            write_entry(4),
        ];
        Ok(DeviceCaster {
            hierarchy,
            working_from_model: scene.working_from_model,
            kernel: fixed_kernel(gpu, FixedShader::Cast, &entries)?,
            constants: gpu.uniform(&[0; size_of::<CastConstants>()]),
        })
    }

    /// Submits the kernel over the rays in a buffer.
    pub(super) fn begin(
        &mut self,
        gpu: &Gpu,
        slices: &Slices<'_>,
        set: &RayBufferSet,
        rays: usize,
        finds: Finds,
    ) -> Result<(), GpuError> {
        let groups = (rays as u32).div_ceil(GROUP);
        let scale = self.working_from_model;
        let constants = CastConstants {
            center: self.hierarchy.center.map(|x| (f64::from(x) * scale) as f32),
            scale: (f64::from(self.hierarchy.scale) / scale) as f32,
            rays: rays as u32,
            row_length: groups.min(ROW),
            is_nearest: u32::from(finds == Finds::Nearest),
            pad: 0,
        };
        gpu.queue
            .write_buffer(&self.constants, 0, bytemuck::bytes_of(&constants));
        let group = gpu.bind(
            &self.kernel.layout,
            [
                self.constants.as_entire_binding(),
                wgpu::BindingResource::TextureView(&self.hierarchy.nodes),
                wgpu::BindingResource::TextureView(&self.hierarchy.triangles),
                set.rays.as_entire_binding(),
                set.hits.as_entire_binding(),
            ],
        );
        slices.dispatch(&self.kernel.pipeline, &group, [groups.min(ROW), groups.div_ceil(ROW)]);
        Ok(())
    }
}
