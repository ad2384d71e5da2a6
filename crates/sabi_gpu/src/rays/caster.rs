//! Who follows rays: the processor on all its cores, or a kernel on the device. Each is the other's check.

use std::fmt;
use std::str::FromStr;

use sabi_nodes::kind::Finds;

use super::RayRoom;
use super::device::OnDevice;
use super::processor::OnProcessor;
use crate::adapter::AdapterKind;
use crate::device::Gpu;
use crate::error::GpuError;
use crate::run::SourceFill;
use crate::tiles::Slices;

/// Who is to follow rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CasterChoice {
    /// A graphics card itself; the processor's cores where the adapter is a software driver, which runs on them anyway and
    /// is slower at it, and for a model that is too large for the card's textures.
    #[default]
    Auto,
    /// The device.
    Gpu,
    /// The processor.
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

/// Follows the rays of one slice after the other.
pub(crate) enum Caster<'a> {
    OnProcessor(OnProcessor<'a>),
    OnDevice(OnDevice<'a>),
}

/// Whether a choice means the device, as far as one can tell before the scene is known.
pub(crate) fn follows_on_device(gpu: &Gpu, choice: CasterChoice) -> bool {
    match choice {
        CasterChoice::Cpu => false,
        CasterChoice::Gpu => true,
        CasterChoice::Auto => gpu.summary().kind != AdapterKind::Cpu,
    }
}

/// The caster of choice for the scene.
pub(crate) fn caster<'s>(
    gpu: &Gpu,
    choice: CasterChoice,
    sources: &'s mut dyn SourceFill,
) -> Result<Caster<'s>, GpuError> {
    let scene = sources.scene().map_err(GpuError::Scene)?;
    let on_processor = || Caster::OnProcessor(OnProcessor::new(scene));
    let on_device = || Ok(Caster::OnDevice(OnDevice::new(gpu, scene)?));
    if !follows_on_device(gpu, choice) {
        return Ok(on_processor());
    }
    match on_device() {
        Err(GpuError::TooLarge { .. } | GpuError::TooDeep { .. }) if choice == CasterChoice::Auto => Ok(on_processor()),
        made => made,
    }
}

impl Caster<'_> {
    /// Starts on rays that were shot into a room.
    pub(super) fn begin(
        &mut self,
        gpu: &Gpu,
        slices: &Slices<'_>,
        room: &RayRoom,
        rays: usize,
        finds: Finds,
    ) -> Result<(), GpuError> {
        match self {
            Caster::OnProcessor(caster) => caster.begin(gpu, room, rays),
            Caster::OnDevice(caster) => caster.begin(gpu, slices, room, rays, finds),
        }
    }

    /// Sees to it that the hits are in the room for whatever is submitted next.
    pub(super) fn finish(&mut self, gpu: &Gpu, room: &RayRoom, rays: usize, finds: Finds) -> Result<(), GpuError> {
        match self {
            Caster::OnProcessor(caster) => caster.finish(gpu, room, rays, finds),
            // Work on the device is done in the order in which it was submitted.
            Caster::OnDevice(_) => Ok(()),
        }
    }

    /// Whether slices are only submitted, and nobody has waited for them.
    pub(super) fn is_on_device(&self) -> bool {
        matches!(self, Caster::OnDevice(_))
    }
}
