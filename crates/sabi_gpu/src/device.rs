//! Choosing an adapter and keeping its device.

use std::fmt;
use std::str::FromStr;
use std::sync::{Arc, Mutex};

use crate::error::GpuError;
use crate::pipelines::Pipelines;
use crate::surface::SURFACE_TEXTURES;

/// Which adapter to use; of several that are meant, the first that can run Sabi.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum AdapterChoice {
    /// A discrete card before an integrated one before a software driver.
    #[default]
    Auto,
    /// A software driver.
    Cpu,
    /// A graphics card.
    Gpu,
    /// One whose name contains this, case aside.
    Named(String),
}

impl FromStr for AdapterChoice {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text {
            "auto" => AdapterChoice::Auto,
            "cpu" => AdapterChoice::Cpu,
            "gpu" => AdapterChoice::Gpu,
            name => AdapterChoice::Named(name.to_owned()),
        })
    }
}

impl fmt::Display for AdapterChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            AdapterChoice::Auto => "auto",
            AdapterChoice::Cpu => "cpu",
            AdapterChoice::Gpu => "gpu",
            AdapterChoice::Named(name) => name,
        })
    }
}

/// What kind of adapter it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum AdapterKind {
    /// A graphics card of its own.
    Discrete,
    /// Part of the processor.
    Integrated,
    /// A driver that runs on the processor.
    Cpu,
}

impl fmt::Display for AdapterKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            AdapterKind::Discrete => "discrete",
            AdapterKind::Integrated => "integrated",
            AdapterKind::Cpu => "cpu",
        })
    }
}

/// What is shown of an adapter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterSummary {
    /// Name as the driver gives it.
    pub name: String,
    /// What kind it is.
    pub kind: AdapterKind,
    /// Driver and its version.
    pub driver: String,
    /// Interface it is reached by, such as `vulkan`.
    pub backend: String,
}

impl AdapterSummary {
    fn of(info: &wgpu::AdapterInfo) -> AdapterSummary {
        let kind = match info.device_type {
            wgpu::DeviceType::DiscreteGpu => AdapterKind::Discrete,
            wgpu::DeviceType::Cpu => AdapterKind::Cpu,
            wgpu::DeviceType::IntegratedGpu | wgpu::DeviceType::VirtualGpu | wgpu::DeviceType::Other => {
                AdapterKind::Integrated
            }
        };
        AdapterSummary {
            name: info.name.clone(),
            kind,
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
            backend: info.backend.to_string(),
        }
    }
}

fn found() -> Vec<(AdapterSummary, wgpu::Adapter)> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::PRIMARY;
    let instance = wgpu::Instance::new(descriptor);
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let mut found: Vec<_> = adapters
        .into_iter()
        .map(|adapter| (AdapterSummary::of(&adapter.get_info()), adapter))
        .collect();
    found.sort_by_key(|(summary, _)| summary.kind);
    found
}

/// All adapters, the one that `auto` takes first.
pub fn adapters() -> Vec<AdapterSummary> {
    found().into_iter().map(|(summary, _)| summary).collect()
}

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
        let found = found();
        if found.is_empty() {
            return Err(GpuError::NoAdapter);
        }
        let known = found
            .iter()
            .map(|(summary, _)| summary.name.as_str())
            .collect::<Vec<_>>()
            .join(", ");
        let fits = |summary: &AdapterSummary| match choice {
            AdapterChoice::Auto => true,
            AdapterChoice::Cpu => summary.kind == AdapterKind::Cpu,
            AdapterChoice::Gpu => summary.kind != AdapterKind::Cpu,
            AdapterChoice::Named(name) => summary.name.to_lowercase().contains(&name.to_lowercase()),
        };
        let meant = found.into_iter().filter(|(summary, _)| fits(summary));
        let opened = first_that_opens(meant, |(summary, adapter)| Gpu::adopt(summary, &adapter));
        opened.unwrap_or_else(|| {
            Err(GpuError::NoSuchAdapter {
                wanted: choice.to_string(),
                known,
            })
        })
    }

    fn adopt(summary: AdapterSummary, adapter: &wgpu::Adapter) -> Result<Gpu, GpuError> {
        let unfit = |why: String| GpuError::Unfit {
            adapter: summary.name.clone(),
            why,
        };
        let available = adapter.limits();
        if let Some(why) = shortage(&available) {
            return Err(unfit(why));
        }
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("sabi"),
            required_limits: available.clone(),
            ..Default::default()
        };
        let opened = pollster::block_on(adapter.request_device(&descriptor));
        let (device, queue) = opened.map_err(|error| unfit(error.to_string()))?;
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
            summary,
            limits,
        })
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

/// The first candidate that opens, or why the last one does not; nothing without candidates.
fn first_that_opens<C, T>(
    candidates: impl Iterator<Item = C>,
    open: impl Fn(C) -> Result<T, GpuError>,
) -> Option<Result<T, GpuError>> {
    let mut last = None;
    for candidate in candidates {
        match open(candidate) {
            Ok(opened) => return Some(Ok(opened)),
            Err(error) => last = Some(Err(error)),
        }
    }
    last
}

/// What an adapter has too little of, as a sentence without its end.
fn shortage(limits: &wgpu::Limits) -> Option<String> {
    let needs = [
        // A page of the atlas has up to 8192 texels a side.
        (limits.max_texture_dimension_2d, 8192, "texels along a texture's side"),
        (
            limits.max_storage_buffers_per_shader_stage,
            6,
            "storage buffers in a kernel",
        ),
        // A whole material is written by one kernel.
        (
            limits.max_storage_textures_per_shader_stage,
            5,
            "written textures in a kernel",
        ),
        (
            limits.max_sampled_textures_per_shader_stage,
            16,
            "read textures in a kernel",
        ),
    ];
    let (has, needed, what) = needs.into_iter().find(|(has, needed, _)| has < needed)?;
    Some(format!("it allows {has} {what}, and Sabi needs {needed}"))
}

fn driver_error(error: wgpu::Error, what: &str) -> GpuError {
    match error {
        wgpu::Error::OutOfMemory { .. } => GpuError::OutOfMemory { what: what.to_owned() },
        other => GpuError::Driver(other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::{AdapterChoice, Gpu, GpuError, first_that_opens, shortage};
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
        assert!(error.to_string().ends_with("or choose --adapter cpu"), "{error}");
    }

    #[test]
    fn an_unfit_adapter_makes_way_for_the_next() {
        let unfit = |name: &str| GpuError::Unfit {
            adapter: name.to_owned(),
            why: "it is too small".to_owned(),
        };
        let open = |(name, opens): (&'static str, bool)| if opens { Ok(name) } else { Err(unfit(name)) };
        let chosen = |all: &[(&'static str, bool)]| first_that_opens(all.iter().copied(), open);
        assert_eq!(
            chosen(&[("old", false), ("good", true), ("late", true)]),
            Some(Ok("good"))
        );
        assert_eq!(chosen(&[("old", false), ("older", false)]), Some(Err(unfit("older"))));
        assert_eq!(chosen(&[]), None);
    }

    #[test]
    fn an_adapter_is_told_what_it_lacks() {
        let enough = wgpu::Limits {
            max_storage_textures_per_shader_stage: 5,
            ..wgpu::Limits::default()
        };
        assert_eq!(shortage(&enough), None);
        let few = wgpu::Limits {
            max_storage_textures_per_shader_stage: 4,
            ..wgpu::Limits::default()
        };
        let told = "it allows 4 written textures in a kernel, and Sabi needs 5";
        assert_eq!(shortage(&few).as_deref(), Some(told));
        let small = wgpu::Limits {
            max_texture_dimension_2d: 4096,
            ..enough
        };
        let told = "it allows 4096 texels along a texture's side, and Sabi needs 8192";
        assert_eq!(shortage(&small).as_deref(), Some(told));
    }

    #[test]
    fn a_texture_beyond_the_adapter_is_an_error_and_no_panic() {
        let install = "this test needs a software Vulkan driver: apt-get install mesa-vulkan-drivers libvulkan1";
        let gpu = Gpu::open(&AdapterChoice::Cpu).expect(install);
        assert!(texture(&gpu, [1 << 20, 8, 1], Format::R32Float).is_err());
    }
}
