//! Kernels that fill linked texels.

use std::sync::Arc;

use sabi_nodes::link::Format;

use super::LinkRound;
use crate::device::Gpu;
use crate::error::GpuError;
use crate::pipelines::{
    FixedKernel, read_entry, storage_entry, texture_entry, uniform_entry, update_entry, write_entry,
};

/// One dispatch of a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// Computes values into the buffer.
    Gather,
    /// Writes the values of the buffer to the texture.
    Scatter,
    /// Computes values and writes them to the texture.
    InPlace,
    /// The same, with values of coupled ghosts read from the buffer.
    Settle,
}

impl Part {
    /// Dispatches of a round over textures of a format. R32 float is the only format that every adapter can read and write
    /// in one dispatch, which saves the buffer for rounds that read no texel they write; of two rounds that do, the first
    /// stays in the buffer.
    pub(super) fn of(round: LinkRound, format: Format) -> &'static [Part] {
        match (format, round) {
            (Format::R32Float, LinkRound::Plain | LinkRound::Owned) => &[Part::InPlace],
            (Format::R32Float, LinkRound::WithGhosts) => &[Part::Gather],
            (Format::R32Float, LinkRound::Settled) => &[Part::Settle],
            _ => &[Part::Gather, Part::Scatter],
        }
    }

    /// Bindings besides the surface.
    fn entries(self, format: Format) -> Vec<wgpu::BindGroupLayoutEntry> {
        let rest = match self {
            Part::Gather => vec![texture_entry(1), write_entry(2)],
            Part::Scatter => vec![storage_entry(1, format), read_entry(2)],
            Part::InPlace => vec![update_entry(1, format)],
            Part::Settle => vec![update_entry(1, format), read_entry(2)],
        };
        [vec![uniform_entry(0)], rest].concat()
    }
}

const PLAIN: &str = include_str!("../../../../shaders/surface/fill_plain.wgsl");
const COUPLED: &str = include_str!("../../../../shaders/surface/fill_coupled.wgsl");
const GATHER: &str = include_str!("../../../../shaders/surface/access_gather.wgsl");
const IN_PLACE: &str = include_str!("../../../../shaders/surface/access_in_place.wgsl");
const SETTLE: &str = include_str!("../../../../shaders/surface/access_settle.wgsl");
const SCATTER: &str = include_str!("../../../../shaders/surface/scatter_filled.wgsl");
const REFINE: &str = include_str!("../../../../shaders/surface/refine_ghosts.wgsl");
const SCATTER_ALL: &str = include_str!("../../../../shaders/surface/scatter_ghosts.wgsl");

impl Gpu {
    /// Kernel of one dispatch of a round over textures of a format.
    pub(super) fn link_kernel(
        &self,
        round: LinkRound,
        part: Part,
        format: Format,
    ) -> Result<Arc<FixedKernel>, GpuError> {
        let (name, texts) = match (round, part) {
            (LinkRound::Cubic, Part::Scatter) => ("scatter ghosts", [SCATTER_ALL, ""]),
            (LinkRound::Cubic, _) => ("refine ghosts", [REFINE, ""]),
            (_, Part::Scatter) => ("scatter filled", [SCATTER, ""]),
            (LinkRound::Plain, Part::InPlace) => ("plain ghosts in place", [PLAIN, IN_PLACE]),
            (LinkRound::Plain, _) => ("gather plain", [PLAIN, GATHER]),
            (_, Part::InPlace) => ("coupled ghosts in place", [COUPLED, IN_PLACE]),
            (_, Part::Settle) => ("settle coupled", [COUPLED, SETTLE]),
            (_, Part::Gather) => ("gather coupled", [COUPLED, GATHER]),
        };
        let (value, parts) = match format {
            Format::R32Float => ("f32", "x"),
            Format::Rgba16Float | Format::Rgba32Float => ("vec4f", "xyzw"),
        };
        let text = texts
            .join("\n")
            .replace("FORMAT", format.wgsl())
            .replace("VALUE", value)
            .replace("PARTS", parts);
        self.fixed_kernel(name, Some(format), &text, &part.entries(format))
    }
}
