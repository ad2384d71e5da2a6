//! The device with its queue and pipelines.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use crate::adapter::{
    AdapterChoice, AdapterSummary, device_descriptor, enumerate_adapters, first_of_choice, missing_limit, unsuitable,
};
use crate::bindings::surface_texture_count;
use crate::driver_errors::{DriverErrors, driver_error};
use crate::error::GpuError;
use crate::pace::InFlight;
use crate::pipeline_cache::PipelineCache;
use crate::waiting::{OF_A_SLICE, Patience, STEP};

/// A device with its queue, the pipelines compiled on it, and the work that is waited for.
///
/// Computations on it, and reading back, are functions of other modules that borrow it.
pub struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) pipelines: PipelineCache,
    driver_errors: Arc<DriverErrors>,
    /// Kernels that were submitted without a wait.
    pub(crate) in_flight: InFlight,
    /// True after a wait was given up, until the device has finished the work that was waited for.
    is_overrun: AtomicBool,
    /// Number of steps after which the wait for a slice of a kernel is given up.
    slice_steps: AtomicU32,
    summary: AdapterSummary,
    limits: sabi_plan::Limits,
}

impl Gpu {
    /// Opens the chosen adapter.
    pub fn open(choice: &AdapterChoice) -> Result<Gpu, GpuError> {
        first_of_choice(choice, &enumerate_adapters(), |adapter| {
            let opened = pollster::block_on(adapter.request_device(&device_descriptor(adapter)?));
            let (device, queue) = opened.map_err(|error| unsuitable(adapter, error.to_string()))?;
            Gpu::adopt_device(adapter, device, queue)
        })
    }

    /// Takes over a device that was opened elsewhere, for example for a window, with [`crate::device_descriptor`]. Replaces
    /// its callbacks for device loss and for uncaptured errors.
    pub fn adopt_device(adapter: &wgpu::Adapter, device: wgpu::Device, queue: wgpu::Queue) -> Result<Gpu, GpuError> {
        let available = device.limits();
        if let Some(reason) = missing_limit(&available) {
            return Err(unsuitable(adapter, reason));
        }
        let driver_errors = Arc::new(DriverErrors::default());
        let lost = driver_errors.clone();
        device.set_device_lost_callback(move |_, message| lost.record(GpuError::Lost(message)));
        let uncaptured = driver_errors.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            uncaptured.record(driver_error(error, "a result"))
        }));
        let limits = sabi_plan::Limits {
            // Every kernel binds the textures of the surface.
            sampled_textures: (available.max_sampled_textures_per_shader_stage as usize).min(64)
                - surface_texture_count(),
            storage_textures: (available.max_storage_textures_per_shader_stage as usize).min(16),
            block_bytes: available.max_uniform_buffer_binding_size,
            ..sabi_plan::Limits::default()
        };
        Ok(Gpu {
            pipelines: PipelineCache::new(&device),
            device,
            queue,
            driver_errors,
            in_flight: InFlight::default(),
            is_overrun: AtomicBool::new(false),
            slice_steps: AtomicU32::new(OF_A_SLICE),
            summary: AdapterSummary::of(&adapter.get_info()),
            limits,
        })
    }

    /// Returns an error if the device is lost, and `None` while it works.
    pub fn loss(&self) -> Option<GpuError> {
        self.loss_after(wgpu::PollType::Poll)
    }

    /// Loss of the device that may have caused another error; none if it works. Waits for up to a tenth of a second, since a loss is
    /// known only once all that was submitted before it is done, while calls on the lost device fail at once.
    pub fn loss_behind_error(&self) -> Option<GpuError> {
        self.loss_after(wgpu::PollType::Wait {
            submission_index: None,
            timeout: Some(STEP),
        })
    }

    fn loss_after(&self, poll: wgpu::PollType) -> Option<GpuError> {
        self.driver_errors.loss().or_else(|| {
            // The loss callback runs when the device is polled.
            let _ = self.device.poll(poll);
            self.driver_errors.loss()
        })
    }

    /// Sets the function to call if the device is lost, in place of the one set before. It is called on the thread that
    /// notices the loss first. It is not called for a loss that was noticed before.
    pub fn when_lost(&self, call: impl FnOnce() + Send + 'static) {
        self.driver_errors.when_lost(call);
    }

    /// The device.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// The device's queue.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// Bind group layout of a surface, which is the same in every kernel; see `shaders/lib/atlas.wgsl`.
    pub fn surface_layout(&self) -> &wgpu::BindGroupLayout {
        &self.pipelines.surface_layout
    }

    /// Description of the adapter.
    pub fn summary(&self) -> &AdapterSummary {
        &self.summary
    }

    /// Limits of what one pass may bind.
    pub fn limits(&self) -> sabi_plan::Limits {
        self.limits
    }

    /// For tests: gives up a kernel if one of its slices takes longer than a tenth of a second, instead of 20 seconds.
    pub fn set_impatient(&self, is_impatient: bool) {
        let steps = if is_impatient { 1 } else { OF_A_SLICE };
        self.slice_steps.store(steps, Ordering::Relaxed);
    }

    /// Waits until all submitted work is done. Returns an error if the driver reported one in the meantime.
    pub fn wait(&self) -> Result<(), GpuError> {
        self.wait_with(Patience::endless())
    }

    /// Waits until all submitted work is done, or until `patience` ends. In the second case the work may continue on the device.
    pub(crate) fn wait_with(&self, patience: Patience<'_>) -> Result<(), GpuError> {
        // A wait for one submission would say nothing about the submissions after it.
        let patience = patience.with_steps_of_a_slice(self.slice_steps.load(Ordering::Relaxed));
        let waited = self.in_flight.settle(|| self.poll(None, patience));
        match &waited {
            Ok(()) => self.is_overrun.store(false, Ordering::Relaxed),
            Err(GpuError::TooLong { .. }) => self.is_overrun.store(true, Ordering::Relaxed),
            Err(_) => {}
        }
        waited
    }

    /// Waits for the work that an earlier run gave up waiting for, so that its errors are not attributed to this run.
    pub(crate) fn wait_for_overrun(&self, is_canceled: &dyn Fn() -> bool) -> Result<(), GpuError> {
        if !self.is_overrun.load(Ordering::Relaxed) {
            return Ok(());
        }
        self.wait_with(Patience::for_compiling(is_canceled))
            .map_err(|error| match error {
                GpuError::TooLong { seconds, .. } => GpuError::Lost(format!(
                    "it has not come back from an earlier step for {seconds} seconds"
                )),
                other => other,
            })
    }

    /// Waits until one submission and all before it are done.
    pub(crate) fn wait_for(&self, submission: wgpu::SubmissionIndex) -> Result<(), GpuError> {
        self.poll(Some(submission), Patience::endless())
    }

    fn poll(&self, submission: Option<wgpu::SubmissionIndex>, patience: Patience<'_>) -> Result<(), GpuError> {
        let polled = patience.wait(|step| {
            // A fault of wgpu 29: when a lost device is polled, all its resources are freed under locks that an
            // uploading thread takes in the opposite order, which is a deadlock. So a lost device is not polled.
            if let Some(loss) = self.driver_errors.loss() {
                return Some(Err(loss));
            }
            let until = wgpu::PollType::Wait {
                submission_index: submission.clone(),
                timeout: Some(step),
            };
            match self.device.poll(until) {
                Err(wgpu::PollError::Timeout) => None,
                polled => Some(polled.map(|_| ()).map_err(|error| GpuError::Lost(error.to_string()))),
            }
        });
        self.driver_errors.take()?;
        polled?
    }

    /// Runs `make` in error scopes, and converts an error of the driver to one that names `what`.
    pub fn guarded<T>(&self, what: &str, make: impl FnOnce(&wgpu::Device) -> T) -> Result<T, GpuError> {
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let made = make(&self.device);
        let errors = [pollster::block_on(validation.pop()), pollster::block_on(memory.pop())];
        if let Some(error) = errors.into_iter().flatten().next() {
            return Err(driver_error(error, what));
        }
        // On a lost device calls succeed; only the loss callback reports the loss.
        self.driver_errors.take()?;
        Ok(made)
    }

    /// Creates a uniform buffer with these bytes.
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

    /// Creates a bind group with these resources at bindings 0, 1, 2, …
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

    /// Encodes and submits one pass. Passes are slow on software drivers, so callers put much work into each.
    pub(crate) fn submit_compute_pass(
        &self,
        encode: impl FnOnce(&mut wgpu::ComputePass<'_>) -> Result<(), GpuError>,
    ) -> Result<(), GpuError> {
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encode(&mut encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default()))?;
        self.queue.submit([encoder.finish()]);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{AdapterChoice, Gpu, GpuError, device_descriptor, enumerate_adapters};
    use crate::pool::texture;
    use sabi_nodes::link::Format;

    #[test]
    fn a_lost_device_is_an_error_and_no_panic() {
        let install = "this test needs a software Vulkan driver: apt-get install mesa-vulkan-drivers libvulkan1";
        let gpu = Gpu::open(&AdapterChoice::Cpu).expect(install);
        assert!(texture(&gpu, [8, 8, 1], Format::R32Float).is_ok());
        gpu.device.destroy();
        let made = texture(&gpu, [8, 8, 1], Format::R32Float);
        let error = made
            .err()
            .or(gpu.wait().err())
            .expect("the loss is told at the next wait, if not before");
        assert!(matches!(error, GpuError::Lost(_)), "{error}");
    }

    #[test]
    fn a_device_that_was_opened_elsewhere_is_adopted_and_its_loss_is_reported() {
        let install = "this test needs a software Vulkan driver: apt-get install mesa-vulkan-drivers libvulkan1";
        let adapter = crate::choose_adapter(&AdapterChoice::Cpu, &enumerate_adapters(), None).expect(install);
        let asked_for = device_descriptor(&adapter).expect("an adapter that was chosen is fit");
        let opened = pollster::block_on(adapter.request_device(&asked_for));
        let (device, queue) = opened.expect("a device");
        let gpu = Gpu::adopt_device(&adapter, device.clone(), queue).expect("it was asked for what Sabi needs");
        assert!(texture(&gpu, [8, 8, 1], Format::R32Float).is_ok());
        assert_eq!(gpu.loss(), None);
        device.destroy();
        // The loss is reported at the next wait at the latest.
        let _ = gpu.wait();
        assert!(matches!(gpu.loss(), Some(GpuError::Lost(_))));
    }

    #[test]
    fn a_device_with_limits_that_are_too_low_is_refused() {
        let install = "this test needs a software Vulkan driver: apt-get install mesa-vulkan-drivers libvulkan1";
        let adapter = crate::choose_adapter(&AdapterChoice::Cpu, &enumerate_adapters(), None).expect(install);
        let opened = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()));
        let (device, queue) = opened.expect("a device");
        let error = Gpu::adopt_device(&adapter, device, queue)
            .err()
            .expect("it allows too little");
        let told = "it allows 4 written textures in a kernel, and Sabi needs 9";
        assert!(error.to_string().contains(told), "{error}");
    }

    #[test]
    fn a_texture_larger_than_the_adapter_allows_is_an_error_and_no_panic() {
        let install = "this test needs a software Vulkan driver: apt-get install mesa-vulkan-drivers libvulkan1";
        let gpu = Gpu::open(&AdapterChoice::Cpu).expect(install);
        assert!(texture(&gpu, [1 << 20, 8, 1], Format::R32Float).is_err());
    }
}
