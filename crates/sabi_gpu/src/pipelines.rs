//! Pipelines: a kernel is linked at every use, and compiled once for each text that comes of it.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use sabi_nodes::Library;
use sabi_nodes::link::{Format, Kernel, KernelSpec, LinkedModule, link};

use crate::device::Gpu;
use crate::error::GpuError;
use crate::pool::wgpu_format;
use crate::shaders::{FixedShader, in_source, linked};

/// A compiled kernel.
pub(crate) struct CompiledKernel {
    pub(crate) kernel: Kernel,
    pub(crate) pipeline: wgpu::ComputePipeline,
    /// Writes the rays that `pipeline` asks, where there are any.
    pub(crate) shoot: Option<wgpu::ComputePipeline>,
    pub(crate) layout: wgpu::BindGroupLayout,
    /// Set once it ran for the first time, which is when software drivers compile it.
    pub(crate) is_warm: std::sync::atomic::AtomicBool,
}

/// All pipelines of a device.
pub(crate) struct Pipelines {
    pub(crate) surface_layout: wgpu::BindGroupLayout,
    kernels: Mutex<BTreeMap<[u8; 32], Arc<CompiledKernel>>>,
    fixed: Mutex<BTreeMap<FixedShader, Arc<FixedKernel>>>,
}

/// A kernel that is not made of nodes.
pub(crate) struct FixedKernel {
    pub(crate) pipeline: wgpu::ComputePipeline,
    pub(crate) layout: wgpu::BindGroupLayout,
}

fn buffer_entry(binding: u32, ty: wgpu::BufferBindingType) -> wgpu::BindGroupLayoutEntry {
    entry(
        binding,
        wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
    )
}

fn entry(binding: u32, ty: wgpu::BindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty,
        count: None,
    }
}

/// A texture that is read texel by texel.
pub(crate) fn texture_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    let sample_type = wgpu::TextureSampleType::Float { filterable: false };
    sampled_entry(binding, sample_type, wgpu::TextureViewDimension::D2Array)
}

/// Whole numbers for all texels of the atlas.
pub(crate) fn owners_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    let sample_type = wgpu::TextureSampleType::Uint;
    sampled_entry(binding, sample_type, wgpu::TextureViewDimension::D2Array)
}

/// A table of bit patterns.
pub(crate) fn table_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    sampled_entry(binding, wgpu::TextureSampleType::Uint, wgpu::TextureViewDimension::D2)
}

fn sampled_entry(
    binding: u32,
    sample_type: wgpu::TextureSampleType,
    view_dimension: wgpu::TextureViewDimension,
) -> wgpu::BindGroupLayoutEntry {
    entry(
        binding,
        wgpu::BindingType::Texture {
            sample_type,
            view_dimension,
            multisampled: false,
        },
    )
}

/// A texture that is written.
pub(crate) fn storage_entry(binding: u32, format: Format) -> wgpu::BindGroupLayoutEntry {
    storage_texture_entry(binding, format, wgpu::StorageTextureAccess::WriteOnly)
}

/// A texture that is read and written, of a format with which every adapter allows that.
pub(crate) fn update_entry(binding: u32, format: Format) -> wgpu::BindGroupLayoutEntry {
    storage_texture_entry(binding, format, wgpu::StorageTextureAccess::ReadWrite)
}

/// A texture of whole numbers that is written.
pub(crate) fn marks_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    storage_of(
        binding,
        wgpu::TextureFormat::R32Uint,
        wgpu::StorageTextureAccess::WriteOnly,
    )
}

fn storage_texture_entry(
    binding: u32,
    format: Format,
    access: wgpu::StorageTextureAccess,
) -> wgpu::BindGroupLayoutEntry {
    storage_of(binding, wgpu_format(format), access)
}

fn storage_of(
    binding: u32,
    format: wgpu::TextureFormat,
    access: wgpu::StorageTextureAccess,
) -> wgpu::BindGroupLayoutEntry {
    let view_dimension = wgpu::TextureViewDimension::D2Array;
    entry(
        binding,
        wgpu::BindingType::StorageTexture {
            access,
            format,
            view_dimension,
        },
    )
}

/// A buffer that is read.
pub(crate) fn read_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    buffer_entry(binding, wgpu::BufferBindingType::Storage { read_only: true })
}

/// A buffer that is read and written.
pub(crate) fn write_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    buffer_entry(binding, wgpu::BufferBindingType::Storage { read_only: false })
}

/// A small buffer of constants.
pub(crate) fn uniform_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    buffer_entry(binding, wgpu::BufferBindingType::Uniform)
}

impl Pipelines {
    pub(crate) fn new(device: &wgpu::Device) -> Pipelines {
        // The viewport follows relief over seams by the same tables.
        let seen_too = |entry: wgpu::BindGroupLayoutEntry| wgpu::BindGroupLayoutEntry {
            visibility: wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT,
            ..entry
        };
        let entries = [
            uniform_entry(0),
            read_entry(1),
            owners_entry(2),
            table_entry(3),
            table_entry(4),
            table_entry(5),
            read_entry(6),
            owners_entry(7),
        ];
        let surface_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("surface"),
            entries: &entries.map(seen_too),
        });
        Pipelines {
            surface_layout,
            kernels: Mutex::default(),
            fixed: Mutex::default(),
        }
    }
}

impl Gpu {
    /// The compiled kernel of a spec.
    pub(crate) fn kernel(
        &self,
        spec: &KernelSpec,
        library: &Library,
        nodes: &[String],
    ) -> Result<Arc<CompiledKernel>, GpuError> {
        let refused = |why: String| GpuError::Kernel {
            nodes: nodes.join(", "),
            why,
        };
        let kernel =
            link(spec, |id| library.kind(id), library.libraries()).map_err(|error| refused(error.to_string()))?;
        let key = *blake3::hash(kernel.module.wgsl().as_bytes()).as_bytes();
        if let Ok(kernels) = self.pipelines.kernels.lock()
            && let Some(known) = kernels.get(&key)
        {
            return Ok(known.clone());
        }
        let compiled = Arc::new(self.compile(kernel).map_err(|error| match error {
            GpuError::Driver(why) => refused(why),
            other => other,
        })?);
        if let Ok(mut kernels) = self.pipelines.kernels.lock() {
            kernels.insert(key, compiled.clone());
        }
        Ok(compiled)
    }

    fn compile(&self, kernel: Kernel) -> Result<CompiledKernel, GpuError> {
        let reads = kernel.reads as u32;
        let loads = (1..=reads).map(texture_entry);
        let stores = kernel
            .writes
            .iter()
            .enumerate()
            .map(|(at, format)| storage_entry(1 + reads + at as u32, *format));
        let mut entries: Vec<_> = std::iter::once(read_entry(0)).chain(loads).chain(stores).collect();
        if kernel.rays {
            let next = entries.len() as u32;
            entries.extend([write_entry(next), read_entry(next + 1)]);
        }
        let (pipeline, shoot, layout) = if kernel.rays {
            let ([main, shoot], layout) =
                self.compute_pipelines("nodes", &kernel.module, &entries, ["main", "shoot"])?;
            (main, Some(shoot), layout)
        } else {
            let ([main], layout) = self.compute_pipelines("nodes", &kernel.module, &entries, ["main"])?;
            (main, None, layout)
        };
        Ok(CompiledKernel {
            kernel,
            pipeline,
            shoot,
            layout,
            is_warm: false.into(),
        })
    }

    fn compute_pipelines<const N: usize>(
        &self,
        label: &str,
        linked: &LinkedModule,
        entries: &[wgpu::BindGroupLayoutEntry],
        names: [&str; N],
    ) -> Result<([wgpu::ComputePipeline; N], wgpu::BindGroupLayout), GpuError> {
        let made = self.guarded(label, |device| {
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
                bind_group_layouts: &[Some(&self.pipelines.surface_layout), Some(&layout)],
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
        &self,
        shader: FixedShader,
        entries: &[wgpu::BindGroupLayoutEntry],
    ) -> Result<Arc<FixedKernel>, GpuError> {
        if let Ok(fixed) = self.pipelines.fixed.lock()
            && let Some(known) = fixed.get(&shader)
        {
            return Ok(known.clone());
        }
        let linked = linked(&shader.spec())?;
        let ([pipeline], layout) = self.compute_pipelines(shader.label(), &linked, entries, ["main"])?;
        let kernel = Arc::new(FixedKernel { pipeline, layout });
        if let Ok(mut fixed) = self.pipelines.fixed.lock() {
            fixed.insert(shader, kernel.clone());
        }
        Ok(kernel)
    }
}
