//! Kernels that fill linked texels.

use std::sync::Arc;

use sabi_nodes::link::Format;

use super::LinkRound;
use crate::device::Gpu;
use crate::error::GpuError;
use crate::pipelines::{
    FixedKernel, read_entry, storage_entry, texture_entry, uniform_entry, update_entry, write_entry,
};
use crate::shaders::FixedShader;

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

impl Gpu {
    /// Kernel of one dispatch of a round over textures of a format.
    pub(super) fn link_kernel(
        &self,
        round: LinkRound,
        part: Part,
        format: Format,
    ) -> Result<Arc<FixedKernel>, GpuError> {
        let shader = match (round, part) {
            (LinkRound::Cubic, Part::Scatter) => FixedShader::ScatterGhosts(format),
            (LinkRound::Cubic, _) => FixedShader::RefineGhosts,
            (_, Part::Scatter) => FixedShader::ScatterFilled(format),
            (LinkRound::Plain, Part::InPlace) => FixedShader::PlainInPlace,
            (LinkRound::Plain, _) => FixedShader::GatherPlain(format),
            (_, Part::InPlace) => FixedShader::CoupledInPlace,
            (_, Part::Settle) => FixedShader::SettleCoupled,
            (_, Part::Gather) => FixedShader::GatherCoupled(format),
        };
        self.fixed_kernel(shader, &part.entries(format))
    }
}
