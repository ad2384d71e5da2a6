//! The device, and what it says when something goes wrong.

use std::sync::{Arc, Mutex};

use crate::adapter::{AdapterChoice, AdapterSummary, device_descriptor, first_of_choice, found, shortage, unfit};
use crate::error::GpuError;
use crate::pipelines::Pipelines;
use crate::surface::SURFACE_TEXTURES;

/// What the driver said outside of any call.
#[derive(Debug, Default)]
pub(crate) struct Complaints {
    first: Mutex<Option<GpuError>>,
}

impl Complaints {
    fn put(&self, error: GpuError) {
        if let Ok(mut first) = self.first.lock() {
            // A loss is the cause of what else is said.
            if first.is_none() || matches!(error, GpuError::Lost(_)) {
                *first = Some(error);
            }
        }
    }

    /// The first complaint since the last call; a loss is told at every call, since nothing heals it.
    fn take(&self) -> Result<(), GpuError> {
        let Ok(mut first) = self.first.lock() else {
            return Ok(());
        };
        let error = match &*first {
            Some(GpuError::Lost(message)) => Some(GpuError::Lost(message.clone())),
            _ => first.take(),
        };
        error.map_or(Ok(()), Err)
    }
}

/// A device with its queue and pipelines.
pub struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) pipelines: Pipelines,
    pub(crate) complaints: Arc<Complaints>,
    summary: AdapterSummary,
    limits: sabi_plan::Limits,
}

impl Gpu {
    /// Opens the adapter of choice.
    pub fn open(choice: &AdapterChoice) -> Result<Gpu, GpuError> {
        first_of_choice(choice, &found(), |adapter| {
            let opened = pollster::block_on(adapter.request_device(&device_descriptor(adapter)?));
            let (device, queue) = opened.map_err(|error| unfit(adapter, error.to_string()))?;
            Gpu::adopt_device(adapter, device, queue)
        })
    }

    /// Takes a device that somebody else draws with too, such as a window's. It must have been asked for by
    /// [`crate::device_descriptor`]; what it says when it is lost or complains outside of any call is heard here from now on.
    pub fn adopt_device(adapter: &wgpu::Adapter, device: wgpu::Device, queue: wgpu::Queue) -> Result<Gpu, GpuError> {
        let available = device.limits();
        if let Some(why) = shortage(&available) {
            return Err(unfit(adapter, why));
        }
        let complaints = Arc::new(Complaints::default());
        let lost = complaints.clone();
        device.set_device_lost_callback(move |_, message| lost.put(GpuError::Lost(message)));
        let uncaptured = complaints.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            uncaptured.put(driver_error(error, "a result"))
        }));
        let limits = sabi_plan::Limits {
            // The surface takes some for itself.
            sampled_textures: (available.max_sampled_textures_per_shader_stage as usize).min(64) - SURFACE_TEXTURES,
            storage_textures: (available.max_storage_textures_per_shader_stage as usize).min(16),
            ..sabi_plan::Limits::default()
        };
        Ok(Gpu {
            pipelines: Pipelines::new(&device),
            device,
            queue,
            complaints,
            summary: AdapterSummary::of(&adapter.get_info()),
            limits,
        })
    }

    /// Why the device is gone, if it is; nothing brings it back.
    pub fn loss(&self) -> Option<GpuError> {
        self.heard_loss().or_else(|| {
            // A loss is told to those who ask what is done.
            let _ = self.device.poll(wgpu::PollType::Poll);
            self.heard_loss()
        })
    }

    fn heard_loss(&self) -> Option<GpuError> {
        let first = self.complaints.first.lock().ok()?;
        first.clone().filter(|error| matches!(error, GpuError::Lost(_)))
    }

    /// The device, for those that draw with it too.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// The device's queue.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// The adapter in use.
    pub fn summary(&self) -> &AdapterSummary {
        &self.summary
    }

    /// What a pass may bind here.
    pub fn limits(&self) -> sabi_plan::Limits {
        self.limits
    }

    /// Waits until all submitted work is done; reports what the driver complained about meanwhile.
    pub fn wait(&self) -> Result<(), GpuError> {
        self.polled(wgpu::PollType::wait_indefinitely())
    }

    /// Waits until one submission and all before it are done.
    pub(crate) fn wait_for(&self, submission: wgpu::SubmissionIndex) -> Result<(), GpuError> {
        self.polled(wgpu::PollType::Wait {
            submission_index: Some(submission),
            timeout: None,
        })
    }

    fn polled(&self, until: wgpu::PollType) -> Result<(), GpuError> {
        // wgpu 29 gives all resources of a lost device free when it is polled, under locks that a thread which is just
        // uploading takes the other way round: the two would wait for each other.
        if let Some(loss) = self.heard_loss() {
            return Err(loss);
        }
        let polled = self.device.poll(until);
        self.complaints.take()?;
        polled.map(|_| ()).map_err(|error| GpuError::Lost(error.to_string()))
    }

    /// Runs `make` and turns what the driver says about it into an error that names `what` was made.
    pub fn guarded<T>(&self, what: &str, make: impl FnOnce(&wgpu::Device) -> T) -> Result<T, GpuError> {
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let made = make(&self.device);
        let errors = [pollster::block_on(validation.pop()), pollster::block_on(memory.pop())];
        if let Some(error) = errors.into_iter().flatten().next() {
            return Err(driver_error(error, what));
        }
        // A device that is lost takes everything without a word; only its own report tells.
        self.complaints.take()?;
        Ok(made)
    }
}

fn driver_error(error: wgpu::Error, what: &str) -> GpuError {
    match error {
        wgpu::Error::OutOfMemory { .. } => GpuError::OutOfMemory { what: what.to_owned() },
        other => GpuError::Driver(other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::{AdapterChoice, Gpu, GpuError, device_descriptor, found};
    use crate::pool::texture;
    use sabi_nodes::link::Format;

    #[test]
    fn a_device_that_is_gone_is_an_error_and_no_panic() {
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
    fn a_device_that_somebody_else_opened_is_taken_and_its_loss_is_heard() {
        let install = "this test needs a software Vulkan driver: apt-get install mesa-vulkan-drivers libvulkan1";
        let adapter = crate::choose_adapter(&AdapterChoice::Cpu, &found(), None).expect(install);
        let asked_for = device_descriptor(&adapter).expect("an adapter that was chosen is fit");
        let opened = pollster::block_on(adapter.request_device(&asked_for));
        let (device, queue) = opened.expect("a device");
        let gpu = Gpu::adopt_device(&adapter, device.clone(), queue).expect("it was asked for what Sabi needs");
        assert!(texture(&gpu, [8, 8, 1], Format::R32Float).is_ok());
        assert_eq!(gpu.loss(), None);
        device.destroy();
        // The loss is told at the next wait, if not before.
        let _ = gpu.wait();
        assert!(matches!(gpu.loss(), Some(GpuError::Lost(_))));
    }

    #[test]
    fn a_device_that_was_asked_for_too_little_is_refused() {
        let install = "this test needs a software Vulkan driver: apt-get install mesa-vulkan-drivers libvulkan1";
        let adapter = crate::choose_adapter(&AdapterChoice::Cpu, &found(), None).expect(install);
        let opened = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()));
        let (device, queue) = opened.expect("a device");
        let error = Gpu::adopt_device(&adapter, device, queue)
            .err()
            .expect("it allows too little");
        let told = "it allows 4 written textures in a kernel, and Sabi needs 5";
        assert!(error.to_string().contains(told), "{error}");
    }

    #[test]
    fn a_texture_beyond_the_adapter_is_an_error_and_no_panic() {
        let install = "this test needs a software Vulkan driver: apt-get install mesa-vulkan-drivers libvulkan1";
        let gpu = Gpu::open(&AdapterChoice::Cpu).expect(install);
        assert!(texture(&gpu, [1 << 20, 8, 1], Format::R32Float).is_err());
    }
}
