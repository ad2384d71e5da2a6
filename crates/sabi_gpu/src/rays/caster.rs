//! Who follows rays: the processor on all its cores, or a kernel on the device. Each is the other's check.

use std::fmt;
use std::str::FromStr;

use sabi_nodes::kind::Finds;

use super::RayRoom;
use super::device::OnDevice;
use super::hierarchy::RayScene;
use super::processor::OnProcessor;
use crate::device::{AdapterKind, Gpu};
use crate::error::GpuError;
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

/// The caster of choice for a scene.
pub(crate) fn caster<'a>(gpu: &Gpu, choice: CasterChoice, scene: RayScene<'a>) -> Result<Caster<'a>, GpuError> {
    let on_processor = || Caster::OnProcessor(OnProcessor::new(scene));
    let on_device = || Ok(Caster::OnDevice(OnDevice::new(gpu, scene)?));
    match choice {
        CasterChoice::Cpu => Ok(on_processor()),
        CasterChoice::Gpu => on_device(),
        CasterChoice::Auto if gpu.summary().kind == AdapterKind::Cpu => Ok(on_processor()),
        CasterChoice::Auto => match on_device() {
            Err(GpuError::TooLarge { .. } | GpuError::TooDeep { .. }) => Ok(on_processor()),
            made => made,
        },
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
