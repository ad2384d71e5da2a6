//! Pipelines. A kernel is linked at every use, and compiled once for each resulting text.

use std::sync::Arc;

use sabi_nodes::Library;
use sabi_nodes::link::{Kernel, KernelSpec, LinkedModule, ModuleSpec, link};

use crate::bindings::{read_entry, storage_entry, texture_entry, uniform_entry, write_entry};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::pace::Pace;
use crate::pipeline_cache::{CompiledKernel, FixedKernel};
use crate::shaders::{FixedShader, in_source, linked};

/// The compiled kernel of a spec.
pub(crate) fn node_kernel(
    gpu: &Gpu,
    spec: &KernelSpec,
    library: &Library,
    nodes: &[String],
) -> Result<Arc<CompiledKernel>, GpuError> {
    let refused = |reason: String| GpuError::Kernel {
        nodes: nodes.join(", "),
        reason,
    };
    let kernel = link(spec, |id| library.kind(id), library.libraries()).map_err(|error| refused(error.to_string()))?;
    let key = *blake3::hash(kernel.module.wgsl().as_bytes()).as_bytes();
    if let Some(known) = gpu.pipelines.kernel(&key) {
        return Ok(known);
    }
    let works = spec
        .calls
        .iter()
        .filter_map(|call| Some(library.kind(&call.kind)?.work));
    let work = works.fold(0, u64::saturating_add);
    let compiled = Arc::new(
        compile(gpu, kernel, nodes.join(", "), work).map_err(|error| match error {
            GpuError::Driver(reason) => refused(reason),
            other => other,
        })?,
    );
    gpu.pipelines.insert_kernel(key, &compiled);
    Ok(compiled)
}

fn compile(gpu: &Gpu, kernel: Kernel, nodes: String, work: u64) -> Result<CompiledKernel, GpuError> {
    let reads = kernel.reads as u32;
    let loads = (1..=reads).map(texture_entry);
    let stores = kernel
        .writes
        .iter()
        .enumerate()
        .map(|(at, format)| storage_entry(1 + reads + at as u32, *format));
    let mut entries: Vec<_> = std::iter::once(uniform_entry(0)).chain(loads).chain(stores).collect();
    if kernel.rays {
        let next = entries.len() as u32;
        entries.extend([write_entry(next), read_entry(next + 1)]);
    }
    let (pipeline, ray_generation, layout) = if kernel.rays {
        let ([main, ray_generation], layout) =
            compute_pipelines(gpu, "nodes", &kernel.module, &entries, ["main", "shoot"])?;
        (main, Some(ray_generation), layout)
    } else {
        let ([main], layout) = compute_pipelines(gpu, "nodes", &kernel.module, &entries, ["main"])?;
        (main, None, layout)
    };
    Ok(CompiledKernel {
        kernel,
        nodes,
        pipeline,
        ray_generation,
        layout,
        is_warm: false.into(),
        pace: Arc::new(Pace::of_work(work)),
    })
}

fn compute_pipelines<const N: usize>(
    gpu: &Gpu,
    label: &str,
    linked: &LinkedModule,
    entries: &[wgpu::BindGroupLayoutEntry],
    names: [&str; N],
) -> Result<([wgpu::ComputePipeline; N], wgpu::BindGroupLayout), GpuError> {
    let made = gpu.guarded(label, |device| {
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries,
        });
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(label),
            source: wgpu::ShaderSource::Wgsl(linked.wgsl().into()),
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(label),
            bind_group_layouts: &[Some(&gpu.pipelines.surface_layout), Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = |name: &str| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(label),
                layout: Some(&pipeline_layout),
                module: &module,
                entry_point: Some(name),
                compilation_options: wgpu::PipelineCompilationOptions {
                    // Kernels have no workgroup memory to clear.
                    zero_initialize_workgroup_memory: false,
                    ..Default::default()
                },
                cache: None,
            })
        };
        (names.map(pipeline), layout)
    });
    made.map_err(|error| in_source(error, linked))
}

/// A compiled kernel of Sabi's own.
pub(crate) fn fixed_kernel(
    gpu: &Gpu,
    shader: FixedShader,
    entries: &[wgpu::BindGroupLayoutEntry],
) -> Result<Arc<FixedKernel>, GpuError> {
    if let Some(known) = gpu.pipelines.fixed_kernel(shader) {
        return Ok(known);
    }
    let linked = linked(&shader.spec())?;
    let ([pipeline], layout) = compute_pipelines(gpu, shader.label(), &linked, entries, ["main"])?;
    let kernel = Arc::new(FixedKernel {
        pipeline,
        layout,
        pace: Arc::default(),
    });
    gpu.pipelines.insert_fixed_kernel(shader, &kernel);
    Ok(kernel)
}

/// Links and compiles a module. If the mistake is in a source file, the error names file and line.
pub fn shader_module(gpu: &Gpu, spec: &ModuleSpec) -> Result<wgpu::ShaderModule, GpuError> {
    let linked = linked(spec)?;
    let made = gpu.guarded(spec.label, |device| {
        device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(spec.label),
            source: wgpu::ShaderSource::Wgsl(linked.wgsl().into()),
        })
    });
    made.map_err(|error| in_source(error, &linked))
}
