//! Kernels that fill linked texels.

use std::sync::Arc;

use sabi_nodes::link::Format;

use super::FillRound;
use crate::bindings::{read_entry, storage_entry, texture_entry, uniform_entry, update_entry, write_entry};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::pipeline_cache::FixedKernel;
use crate::pipelines::fixed_kernel;
use crate::shaders::FixedShader;

/// Dispatch that is part of a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FillDispatch {
    /// Computes values into the buffer.
    Gather,
    /// Writes the values of the buffer to the texture.
    Scatter,
    /// Computes values and writes them to the texture.
    InPlace,
    /// Like [`FillDispatch::InPlace`], but reads the values of coupled ghosts from the buffer.
    Settle,
}

impl FillDispatch {
    /// Returns the dispatches of a round over textures of a format. R32 float is the only format that every adapter can
    /// read and write in one dispatch. This saves the buffer for rounds that read no texel that they write. If two rounds
    /// do read such texels, the first leaves its values in the buffer.
    pub(super) fn of_round(round: FillRound, format: Format) -> &'static [FillDispatch] {
        match (format, round) {
            (Format::R32Float, FillRound::Plain | FillRound::Owned) => &[FillDispatch::InPlace],
            (Format::R32Float, FillRound::WithGhosts) => &[FillDispatch::Gather],
            (Format::R32Float, FillRound::Settled) => &[FillDispatch::Settle],
            _ => &[FillDispatch::Gather, FillDispatch::Scatter],
        }
    }

    /// Returns the entries of the bindings besides the surface.
    fn entries(self, format: Format) -> Vec<wgpu::BindGroupLayoutEntry> {
        let rest = match self {
            FillDispatch::Gather => vec![texture_entry(1), write_entry(2)],
            FillDispatch::Scatter => vec![storage_entry(1, format), read_entry(2)],
            FillDispatch::InPlace => vec![update_entry(1, format)],
            FillDispatch::Settle => vec![update_entry(1, format), read_entry(2)],
        };
        [vec![uniform_entry(0)], rest].concat()
    }
}

/// Kernel of one dispatch of a round over textures of a format.
pub(super) fn fill_kernel(
    gpu: &Gpu,
    round: FillRound,
    dispatch: FillDispatch,
    format: Format,
) -> Result<Arc<FixedKernel>, GpuError> {
    let shader = match (round, dispatch) {
        (FillRound::Cubic, FillDispatch::Scatter) => FixedShader::ScatterGhosts(format),
        (FillRound::Cubic, _) => FixedShader::RefineGhosts,
        (_, FillDispatch::Scatter) => FixedShader::ScatterFilled(format),
        (FillRound::Plain, FillDispatch::InPlace) => FixedShader::PlainInPlace,
        (FillRound::Plain, _) => FixedShader::GatherPlain(format),
        (_, FillDispatch::InPlace) => FixedShader::CoupledInPlace,
        (_, FillDispatch::Settle) => FixedShader::SettleCoupled,
        (_, FillDispatch::Gather) => FixedShader::GatherCoupled(format),
    };
    fixed_kernel(gpu, shader, &dispatch.entries(format))
}
