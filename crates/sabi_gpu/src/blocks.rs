//! Parameter blocks of kernels.

use sabi_plan::{KernelStep, Reach};

use crate::device::Gpu;
use crate::pipeline_cache::CompiledKernel;

/// Returns the parameter block of a step in the layout of its kernel. If `reach` is given, its parameter is set to the longest reach.
pub(crate) fn block_buffer(
    gpu: &Gpu,
    compiled: &CompiledKernel,
    step: &KernelStep,
    reach: Option<Reach>,
) -> wgpu::Buffer {
    let layout = &compiled.kernel.layout;
    let mut bytes = vec![0_u8; layout.size as usize];
    let mut put = |offset: u32, data: &[u8]| bytes[offset as usize..][..data.len()].copy_from_slice(data);
    if let Some(flags) = layout.flags {
        put(flags, bytemuck::cast_slice(&step.flags));
    }
    for (call, values) in layout.calls.iter().zip(&step.blocks) {
        if let Some(params) = call.params {
            put(params, &values.params);
            if let Some(reach) = reach {
                put(params + reach.offset as u32, &reach.longest.to_le_bytes());
            }
        }
        for (offset, knob) in call.knobs.iter().zip(&values.knobs) {
            if let (Some(offset), Some(knob)) = (offset, knob) {
                put(*offset, bytemuck::cast_slice(knob));
            }
        }
    }
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("parameters"),
        size: u64::from(layout.size),
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, &bytes);
    buffer
}
