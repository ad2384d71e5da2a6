//! Filling of linked texels with values of other texels, in rounds.

mod kernels;

use sabi_nodes::link::Format;

use crate::device::Gpu;
use crate::error::GpuError;
use crate::links::{GROUP, GhostLinks, Links, ROW};
use crate::pool::array_view;
use crate::surface::GpuSurface;
use kernels::{FillDispatch, fill_kernel};

/// Round of filling linked texels, named by the texels from which values are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FillRound {
    /// The four owned texels around the point of a plain ghost.
    Plain,
    /// Owned texels only.
    Owned,
    /// Owned texels and ghosts that an earlier round filled.
    WithGhosts,
    /// Like [`FillRound::WithGhosts`], and run directly after it.
    Settled,
    /// Like [`FillRound::WithGhosts`], with cubic instead of linear interpolation. Linear interpolation would flatten
    /// crests where a slope is computed across a seam.
    Cubic,
}

/// All rounds that fill ghosts. The first round reads only owned texels, so that no value of an earlier pass is used. If the texels of two
/// charts meet halfway, a ghost is between an owned texel and a ghost of the other chart, whose value depends on it in turn; each further
/// round removes most of the remaining error. The cubic rounds are for results, since slopes are computed from them.
const ALL_ROUNDS: [FillRound; 6] = [
    FillRound::Owned,
    FillRound::WithGhosts,
    FillRound::Settled,
    FillRound::Cubic,
    FillRound::Cubic,
    FillRound::Cubic,
];

impl FillRound {
    /// Returns the rounds that fill the ghosts of a result or of an intermediate texture.
    pub(crate) fn sequence(is_result: bool) -> &'static [FillRound] {
        &ALL_ROUNDS[..if is_result { 6 } else { 3 }]
    }
}

/// Fills the ghosts of one texture: plain ghosts once, coupled ghosts round by round, then all ghosts in the cubic rounds.
pub(crate) fn fill_ghosts(
    gpu: &Gpu,
    surface: &GpuSurface,
    texture: &wgpu::Texture,
    format: Format,
    rounds: &[FillRound],
) -> Result<(), GpuError> {
    let GhostLinks { all, plain, coupled } = &surface.ghosts;
    let cubic = rounds.iter().position(|round| *round == FillRound::Cubic);
    // Without a cubic round, all rounds are linear.
    let (linear, cubic) = rounds.split_at(cubic.unwrap_or(rounds.len()));
    let parts = [(plain, &[FillRound::Plain][..]), (coupled, linear), (all, cubic)];
    gpu.submit_compute_pass(|pass| {
        for (links, rounds) in parts {
            let filled = Filled::new(gpu, links, texture, format);
            filled.encode(pass, surface.bindings_of_ghosts(gpu, links), rounds)?;
        }
        Ok(())
    })
}

/// Encodes the dispatch that writes the gathered values to all ghosts.
pub(crate) fn encode_scattered_ghosts(
    gpu: &Gpu,
    pass: &mut wgpu::ComputePass<'_>,
    surface: &GpuSurface,
    texture: &wgpu::Texture,
    format: Format,
) -> Result<(), GpuError> {
    let links = &surface.ghosts.all;
    pass.set_bind_group(0, surface.bindings_of_ghosts(gpu, links), &[]);
    Filled::new(gpu, links, texture, format).encode_dispatch(pass, FillRound::Cubic, FillDispatch::Scatter)
}

/// Fills the linked texels of one texture on a surface.
pub(crate) fn fill_links(
    gpu: &Gpu,
    surface: &GpuSurface,
    links: &Links,
    texture: &wgpu::Texture,
    format: Format,
    rounds: &[FillRound],
) -> Result<(), GpuError> {
    let bindings = surface.bindings_of_links(gpu, links);
    gpu.submit_compute_pass(|pass| Filled::new(gpu, links, texture, format).encode(pass, &bindings, rounds))
}

/// Texture whose linked texels are filled.
struct Filled<'a> {
    gpu: &'a Gpu,
    links: &'a Links,
    view: wgpu::TextureView,
    format: Format,
}

impl<'a> Filled<'a> {
    fn new(gpu: &'a Gpu, links: &'a Links, texture: &wgpu::Texture, format: Format) -> Filled<'a> {
        Filled {
            gpu,
            links,
            view: array_view(texture),
            format,
        }
    }

    /// Encodes rounds. `bindings` is the bind group of the surface with the links.
    fn encode(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        bindings: &wgpu::BindGroup,
        rounds: &[FillRound],
    ) -> Result<(), GpuError> {
        if self.links.count == 0 || rounds.is_empty() {
            return Ok(());
        }
        pass.set_bind_group(0, bindings, &[]);
        for round in rounds {
            for dispatch in FillDispatch::of_round(*round, self.format) {
                self.encode_dispatch(pass, *round, *dispatch)?;
            }
        }
        Ok(())
    }

    fn encode_dispatch(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        round: FillRound,
        dispatch: FillDispatch,
    ) -> Result<(), GpuError> {
        let links = self.links;
        let groups = links.count.div_ceil(GROUP);
        let with_ghosts = usize::from(matches!(round, FillRound::WithGhosts | FillRound::Settled));
        let kernel = fill_kernel(self.gpu, round, dispatch, self.format)?;
        let constants = links.constants[with_ghosts].as_entire_binding();
        let view = wgpu::BindingResource::TextureView(&self.view);
        // All textures share the buffer of values, so gathering and scattering are one submission.
        let values = (dispatch != FillDispatch::InPlace).then(|| links.values.as_entire_binding());
        let resources = [constants, view].into_iter().chain(values);
        let group = self.gpu.bind(&kernel.layout, resources);
        pass.set_pipeline(&kernel.pipeline);
        pass.set_bind_group(1, &group, &[]);
        pass.dispatch_workgroups(ROW.min(groups), groups.div_ceil(ROW), 1);
        Ok(())
    }
}
