//! Cache of the compute pipelines of a device.

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};

use sabi_nodes::link::Kernel;

use crate::bindings::surface_layout;
use crate::pace::Pace;
use crate::shaders::FixedShader;

/// A compiled kernel of nodes.
pub(crate) struct CompiledKernel {
    pub(crate) kernel: Kernel,
    /// Nodes for which it was used first, for logs.
    pub(crate) nodes: String,
    pub(crate) pipeline: wgpu::ComputePipeline,
    /// Pipeline that writes the rays whose hits `pipeline` reads; none for kernels without rays.
    pub(crate) ray_generation: Option<wgpu::ComputePipeline>,
    pub(crate) layout: wgpu::BindGroupLayout,
    /// True after its first dispatch, when software drivers have compiled it.
    pub(crate) is_warm: AtomicBool,
    pub(crate) pace: Arc<Pace>,
}

/// A compiled kernel that is not made of nodes.
pub(crate) struct FixedKernel {
    pub(crate) pipeline: wgpu::ComputePipeline,
    pub(crate) layout: wgpu::BindGroupLayout,
    pub(crate) pace: Arc<Pace>,
}

/// Compute pipelines of a device, and the bind group layout that they share.
pub(crate) struct PipelineCache {
    pub(crate) surface_layout: wgpu::BindGroupLayout,
    /// Kernels of nodes by the hash of their text.
    kernels: Mutex<BTreeMap<[u8; 32], Arc<CompiledKernel>>>,
    fixed: Mutex<BTreeMap<FixedShader, Arc<FixedKernel>>>,
}

impl PipelineCache {
    pub(crate) fn new(device: &wgpu::Device) -> PipelineCache {
        PipelineCache {
            surface_layout: surface_layout(device),
            kernels: Mutex::default(),
            fixed: Mutex::default(),
        }
    }

    /// The kernel of nodes with this hash of its text.
    pub(crate) fn kernel(&self, key: &[u8; 32]) -> Option<Arc<CompiledKernel>> {
        self.kernels.lock().ok()?.get(key).cloned()
    }

    /// Caches a kernel of nodes under the hash of its text.
    pub(crate) fn insert_kernel(&self, key: [u8; 32], kernel: &Arc<CompiledKernel>) {
        if let Ok(mut kernels) = self.kernels.lock() {
            kernels.insert(key, kernel.clone());
        }
    }

    /// Forgets a kernel of nodes. It is compiled again if it is needed again.
    pub(crate) fn forget_kernel(&self, kernel: &Arc<CompiledKernel>) {
        if let Ok(mut kernels) = self.kernels.lock() {
            kernels.retain(|_, known| !Arc::ptr_eq(known, kernel));
        }
    }

    /// The kernel of a fixed shader.
    pub(crate) fn fixed_kernel(&self, shader: FixedShader) -> Option<Arc<FixedKernel>> {
        self.fixed.lock().ok()?.get(&shader).cloned()
    }

    /// Caches the kernel of a fixed shader.
    pub(crate) fn insert_fixed_kernel(&self, shader: FixedShader, kernel: &Arc<FixedKernel>) {
        if let Ok(mut fixed) = self.fixed.lock() {
            fixed.insert(shader, kernel.clone());
        }
    }
}
