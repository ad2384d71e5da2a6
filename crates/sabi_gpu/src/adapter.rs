//! Adapters: enumeration, choice, and the limits that a device is requested with.

use std::fmt;
use std::str::FromStr;
use std::sync::OnceLock;

use sabi_nodes::kind::Channel;

use crate::bindings::surface_texture_count;
use crate::error::GpuError;

/// Adapter to run on. If several match, the first one that can run Sabi is used.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum AdapterChoice {
    /// Prefers a discrete card to an integrated one, and that to a software driver.
    #[default]
    Auto,
    /// A software driver.
    Cpu,
    /// A graphics card.
    Gpu,
    /// An adapter whose name contains this text, without regard to case.
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

impl AdapterChoice {
    fn matches(&self, summary: &AdapterSummary) -> bool {
        match self {
            AdapterChoice::Auto => true,
            AdapterChoice::Cpu => summary.kind == AdapterKind::Cpu,
            AdapterChoice::Gpu => summary.kind != AdapterKind::Cpu,
            AdapterChoice::Named(name) => summary.name.to_lowercase().contains(&name.to_lowercase()),
        }
    }
}

/// Kind of an adapter, best first.
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

/// Description of an adapter for people.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterSummary {
    /// Name as the driver gives it.
    pub name: String,
    /// Kind of adapter.
    pub kind: AdapterKind,
    /// Driver and its version, as the driver reports them.
    pub driver: String,
    /// Graphics API that it is reached through, such as `vulkan`.
    pub backend: String,
}

impl AdapterSummary {
    pub(crate) fn of(info: &wgpu::AdapterInfo) -> AdapterSummary {
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

/// Summaries of all adapters, in the order in which [`AdapterChoice::Auto`] tries them.
pub fn adapters() -> Vec<AdapterSummary> {
    sorted_by_kind(&enumerate_adapters())
        .into_iter()
        .map(|(summary, _)| summary)
        .collect()
}

/// All adapters in the order of the system.
pub(crate) fn enumerate_adapters() -> Vec<wgpu::Adapter> {
    // One instance is shared by all devices: a driver that is loaded and unloaded dozens of times is no longer found (NVIDIA 580).
    static INSTANCE: OnceLock<wgpu::Instance> = OnceLock::new();
    let instance = INSTANCE.get_or_init(|| {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = wgpu::Backends::PRIMARY;
        // In debug builds this flag adds line numbers to every kernel, which means searching its text again and again.
        descriptor.flags.remove(wgpu::InstanceFlags::DEBUG);
        wgpu::Instance::new(descriptor)
    });
    pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY))
}

fn sorted_by_kind(adapters: &[wgpu::Adapter]) -> Vec<(AdapterSummary, &wgpu::Adapter)> {
    let summary = |adapter: &wgpu::Adapter| AdapterSummary::of(&adapter.get_info());
    let mut found: Vec<_> = adapters.iter().map(|adapter| (summary(adapter), adapter)).collect();
    found.sort_by_key(|(summary, _)| summary.kind);
    found
}

/// Chooses among adapters that the caller enumerated, for example those of a window. Skips adapters that cannot run Sabi
/// and, if a surface is given, those that cannot draw on it.
pub fn choose_adapter(
    choice: &AdapterChoice,
    adapters: &[wgpu::Adapter],
    surface: Option<&wgpu::Surface<'_>>,
) -> Result<wgpu::Adapter, GpuError> {
    let can_present = |adapter: &&wgpu::Adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface));
    let presenting: Vec<wgpu::Adapter> = adapters.iter().filter(can_present).cloned().collect();
    first_of_choice(choice, &presenting, |adapter| {
        device_descriptor(adapter).map(|_| adapter.clone())
    })
}

/// Returns the first adapter that matches the choice and can be opened, or the error of the last one tried.
pub(crate) fn first_of_choice<T>(
    choice: &AdapterChoice,
    adapters: &[wgpu::Adapter],
    open: impl Fn(&wgpu::Adapter) -> Result<T, GpuError>,
) -> Result<T, GpuError> {
    let found = sorted_by_kind(adapters);
    if found.is_empty() {
        return Err(GpuError::NoAdapter);
    }
    let names = || found.iter().map(|(summary, _)| summary.name.as_str());
    let matching = found.iter().filter(|(summary, _)| choice.matches(summary));
    let opened = first_opened(matching, |(_, adapter)| open(adapter));
    opened.unwrap_or_else(|| {
        Err(GpuError::NoSuchAdapter {
            wanted: choice.to_string(),
            known: names().collect::<Vec<_>>().join(", "),
        })
    })
}

/// Size of a memory block that small textures and buffers share, in bytes.
const BLOCK_BYTES: u64 = 8 << 20;

/// Returns the descriptor of a device that [`crate::Gpu::adopt_device`] accepts, or an error if the adapter cannot run Sabi.
pub fn device_descriptor(adapter: &wgpu::Adapter) -> Result<wgpu::DeviceDescriptor<'static>, GpuError> {
    let available = adapter.limits();
    match missing_limit(&available) {
        Some(reason) => Err(unsuitable(adapter, reason)),
        None => Ok(wgpu::DeviceDescriptor {
            label: Some("sabi"),
            required_limits: available,
            // A resource that is larger than a block has memory of its own, which is released as soon as the resource is
            // freed. By default, blocks have up to 256 MB, and gaps between textures in them are lost. A software driver
            // takes this memory from the main memory of the machine.
            memory_hints: wgpu::MemoryHints::Manual {
                suballocated_device_memory_block_size: BLOCK_BYTES..BLOCK_BYTES,
            },
            ..Default::default()
        }),
    }
}

/// Error of an adapter that cannot run Sabi.
pub(crate) fn unsuitable(adapter: &wgpu::Adapter, reason: String) -> GpuError {
    GpuError::Unsuitable {
        adapter: adapter.get_info().name,
        reason,
    }
}

/// Returns the first candidate that can be opened, or the error of the last one; `None` without candidates.
fn first_opened<C, T>(
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

/// Returns the limit of an adapter that is too low for Sabi, as a clause; `None` if all are high enough.
pub(crate) fn missing_limit(limits: &wgpu::Limits) -> Option<String> {
    let needs = [
        // A page of the atlas has up to 8192 × 8192 texels.
        (limits.max_texture_dimension_2d, 8192, "texels along a texture's side"),
        (
            limits.max_storage_buffers_per_shader_stage,
            6,
            "storage buffers in a kernel",
        ),
        (
            u32::try_from(limits.max_uniform_buffer_binding_size).unwrap_or(u32::MAX),
            16 << 10,
            "bytes of parameters in a kernel",
        ),
        // A whole material is written by one kernel.
        (
            limits.max_storage_textures_per_shader_stage,
            Channel::ALL.len() as u32,
            "written textures in a kernel",
        ),
        // Two whole materials and a mask, besides the textures of the surface.
        (
            limits.max_sampled_textures_per_shader_stage,
            2 * Channel::ALL.len() as u32 + 1 + surface_texture_count() as u32,
            "read textures in a kernel",
        ),
    ];
    let (has, needed, what) = needs.into_iter().find(|(has, needed, _)| has < needed)?;
    Some(format!("it allows {has} {what}, and Sabi needs {needed}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_adapter_that_cannot_run_sabi_is_skipped() {
        let unsuitable = |name: &str| GpuError::Unsuitable {
            adapter: name.to_owned(),
            reason: "it is too small".to_owned(),
        };
        let open = |(name, opens): (&'static str, bool)| if opens { Ok(name) } else { Err(unsuitable(name)) };
        let chosen = |all: &[(&'static str, bool)]| first_opened(all.iter().copied(), open);
        assert_eq!(
            chosen(&[("old", false), ("good", true), ("late", true)]),
            Some(Ok("good"))
        );
        assert_eq!(
            chosen(&[("old", false), ("older", false)]),
            Some(Err(unsuitable("older")))
        );
        assert_eq!(chosen(&[]), None);
    }

    #[test]
    fn a_limit_that_is_too_low_is_named() {
        let enough = wgpu::Limits {
            max_storage_textures_per_shader_stage: 9,
            max_sampled_textures_per_shader_stage: 24,
            ..wgpu::Limits::default()
        };
        assert_eq!(missing_limit(&enough), None);
        let few = wgpu::Limits {
            max_storage_textures_per_shader_stage: 4,
            ..wgpu::Limits::default()
        };
        let told = "it allows 4 written textures in a kernel, and Sabi needs 9";
        assert_eq!(missing_limit(&few).as_deref(), Some(told));
        let small = wgpu::Limits {
            max_texture_dimension_2d: 4096,
            ..enough
        };
        let told = "it allows 4096 texels along a texture's side, and Sabi needs 8192";
        assert_eq!(missing_limit(&small).as_deref(), Some(told));
    }

    #[test]
    fn a_choice_matches_adapters_by_kind_or_by_a_part_of_the_name() {
        let summary = |name: &str, kind: AdapterKind| AdapterSummary {
            name: name.to_owned(),
            kind,
            driver: String::new(),
            backend: "vulkan".to_owned(),
        };
        let all = [
            summary("GeForce", AdapterKind::Discrete),
            summary("Iris", AdapterKind::Integrated),
            summary("llvmpipe", AdapterKind::Cpu),
        ];
        let matched = |choice: &str| -> Vec<&str> {
            let Ok(choice) = choice.parse::<AdapterChoice>();
            let matched = all.iter().filter(|summary| choice.matches(summary));
            matched.map(|summary| summary.name.as_str()).collect()
        };
        assert_eq!(matched("auto"), ["GeForce", "Iris", "llvmpipe"]);
        assert_eq!(matched("gpu"), ["GeForce", "Iris"]);
        assert_eq!(matched("cpu"), ["llvmpipe"]);
        assert_eq!(matched("force"), ["GeForce"]);
    }
}
