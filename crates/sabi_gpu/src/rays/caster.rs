//! Ray casters: the processor with all its cores, or a kernel on the device. Tests compare their results.

use std::fmt;
use std::str::FromStr;

use sabi_nodes::kind::Finds;

use super::device::DeviceCaster;
use super::processor::ProcessorCaster;
use super::{CastRays, RayBufferSet, RayScene};
use crate::adapter::AdapterKind;
use crate::device::Gpu;
use crate::error::GpuError;
use crate::tiles::Slices;

/// Ray caster to use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CasterChoice {
    /// The kernel on a graphics card. The processor for a software adapter, whose kernels run on the same cores and are
    /// slower, and for a hierarchy that does not fit on the device.
    #[default]
    Auto,
    /// A kernel on the device.
    Gpu,
    /// The processor on all its cores.
    Cpu,
}

impl FromStr for CasterChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "auto" => Ok(CasterChoice::Auto),
            "gpu" => Ok(CasterChoice::Gpu),
            "cpu" => Ok(CasterChoice::Cpu),
            _ => Err("it takes auto, gpu or cpu".to_owned()),
        }
    }
}

impl fmt::Display for CasterChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            CasterChoice::Auto => "auto",
            CasterChoice::Gpu => "gpu",
            CasterChoice::Cpu => "cpu",
        })
    }
}

/// Caster of the rays of a step, slice by slice.
pub(crate) enum Caster<'a> {
    Processor(ProcessorCaster<'a>),
    Device(DeviceCaster<'a>),
}

/// Returns true if a choice selects the device. [`CasterChoice::Auto`] may still use the processor for a large scene.
pub(crate) fn casts_on_device(gpu: &Gpu, choice: CasterChoice) -> bool {
    match choice {
        CasterChoice::Cpu => false,
        CasterChoice::Gpu => true,
        CasterChoice::Auto => gpu.summary().kind != AdapterKind::Cpu,
    }
}

/// Creates the chosen caster for a scene.
pub(crate) fn caster<'s>(
    gpu: &Gpu,
    choice: CasterChoice,
    scene: RayScene<'s>,
    rays: CastRays,
) -> Result<Caster<'s>, GpuError> {
    let on_processor = || Caster::Processor(ProcessorCaster::new(scene, rays));
    let on_device = || Ok(Caster::Device(DeviceCaster::new(gpu, scene)?));
    if !casts_on_device(gpu, choice) {
        return Ok(on_processor());
    }
    match on_device() {
        Err(GpuError::TooLarge { .. } | GpuError::TooDeep { .. }) if choice == CasterChoice::Auto => Ok(on_processor()),
        made => made,
    }
}

impl Caster<'_> {
    /// Starts to cast the rays in a buffer.
    pub(super) fn begin(
        &mut self,
        gpu: &Gpu,
        slices: &Slices<'_>,
        set: &RayBufferSet,
        rays: usize,
        finds: Finds,
    ) -> Result<(), GpuError> {
        match self {
            Caster::Processor(caster) => caster.begin(gpu, set, rays),
            Caster::Device(caster) => caster.begin(gpu, slices, set, rays, finds),
        }
    }

    /// Makes the hits available to later submissions.
    pub(super) fn finish(&mut self, gpu: &Gpu, set: &RayBufferSet, rays: usize, finds: Finds) -> Result<(), GpuError> {
        match self {
            Caster::Processor(caster) => caster.finish(gpu, set, rays, finds),
            // The device runs submissions in order, so there is nothing to wait for.
            Caster::Device(_) => Ok(()),
        }
    }

    /// Returns true if slices are submitted without waiting for them.
    pub(super) fn is_on_device(&self) -> bool {
        matches!(self, Caster::Device(_))
    }
}
