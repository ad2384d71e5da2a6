//! Fills ghost texels over their links, after a field has written the owned ones.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use sabi_nodes::link::Format;

use crate::device::Gpu;
use crate::error::GpuError;
use crate::pipelines::{FixedKernel, read_entry, storage_entry, texture_entry, uniform_entry, write_entry};
use crate::pool::array_view;
use crate::surface::GpuSurface;

/// The first fill reads owned texels only; the second one reads the ghosts that the first has filled.
const ROUNDS: u32 = 2;
/// Ghosts a workgroup.
const GROUP: u32 = 64;
/// Workgroups in a row of a dispatch.
const ROW: u32 = 32_768;

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Constants {
    ghost_count: u32,
    with_ghosts: u32,
    row_length: u32,
    pad: u32,
}

impl Gpu {
    /// Refreshes the ghosts of one texture.
    pub(crate) fn fill_ghosts(
        &self,
        surface: &GpuSurface,
        surface_group: &wgpu::BindGroup,
        texture: &wgpu::Texture,
        format: Format,
    ) -> Result<(), GpuError> {
        if surface.ghost_count == 0 {
            return Ok(());
        }
        let [gather, scatter] = self.ghost_kernels(format)?;
        // All rounds of all fields take turns with it: what one submission gathers, the same one writes.
        let values = &surface.ghost_values;
        let view = array_view(texture);
        let groups = surface.ghost_count.div_ceil(GROUP);
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for round in 0..ROUNDS {
            let constants = Constants {
                ghost_count: surface.ghost_count,
                with_ghosts: u32::from(round > 0),
                row_length: ROW.min(groups),
                pad: 0,
            };
            let constants = self.uniform(bytemuck::bytes_of(&constants));
            let view = wgpu::BindingResource::TextureView(&view);
            let constants = constants.as_entire_binding();
            let steps = [
                (&gather, [constants.clone(), view.clone(), values.as_entire_binding()]),
                (&scatter, [constants, values.as_entire_binding(), view]),
            ];
            for (kernel, resources) in steps {
                let group = self.bind(&kernel.layout, resources);
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
                pass.set_pipeline(&kernel.pipeline);
                pass.set_bind_group(0, surface_group, &[]);
                pass.set_bind_group(1, &group, &[]);
                pass.dispatch_workgroups(ROW.min(groups), groups.div_ceil(ROW), 1);
            }
        }
        self.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// The kernel that computes ghosts, and the one that writes them to textures of a format.
    fn ghost_kernels(&self, format: Format) -> Result<[Arc<FixedKernel>; 2], GpuError> {
        let gather_text = include_str!("../../../shaders/surface/gather_ghosts.wgsl");
        let gather_entries = [uniform_entry(0), texture_entry(1), write_entry(2)];
        let scatter_text =
            include_str!("../../../shaders/surface/scatter_ghosts.wgsl").replace("FORMAT", format.wgsl());
        let scatter_entries = [uniform_entry(0), read_entry(1), storage_entry(2, format)];
        Ok([
            self.fixed_kernel("gather ghosts", None, gather_text, &gather_entries)?,
            self.fixed_kernel("scatter ghosts", Some(format), &scatter_text, &scatter_entries)?,
        ])
    }

    /// A small buffer of constants.
    pub(crate) fn uniform(&self, bytes: &[u8]) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes.len() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }

    /// A bind group with these resources at 0, 1, 2, …
    pub(crate) fn bind<'r>(
        &self,
        layout: &wgpu::BindGroupLayout,
        resources: impl IntoIterator<Item = wgpu::BindingResource<'r>>,
    ) -> wgpu::BindGroup {
        let entry = |(binding, resource)| wgpu::BindGroupEntry {
            binding: binding as u32,
            resource,
        };
        let entries: Vec<_> = resources.into_iter().enumerate().map(entry).collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout,
            entries: &entries,
        })
    }
}
