//! Filling of linked texels with values of other texels, in rounds.

mod kernels;

use sabi_nodes::link::Format;

use crate::device::Gpu;
use crate::error::GpuError;
use crate::links::{GROUP, GhostLinks, Links, ROW};
use crate::pool::array_view;
use crate::surface::GpuSurface;
use kernels::FillDispatch;

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

impl Gpu {
    /// Fills the ghosts of one texture: plain ghosts once, coupled ghosts round by round, then all ghosts in the cubic rounds.
    pub(crate) fn fill_ghosts(
        &self,
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
        self.submit_compute_pass(|pass| {
            for (links, rounds) in parts {
                let group = links.surface_group.get_or_init(|| self.surface_group(surface, links));
                self.encode_links(pass, links, group, texture, format, rounds)?;
            }
            Ok(())
        })
    }

    /// Encodes the dispatch that writes the gathered values to all ghosts.
    pub(crate) fn encode_scattered_ghosts(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        surface: &GpuSurface,
        texture: &wgpu::Texture,
        format: Format,
    ) -> Result<(), GpuError> {
        let links = &surface.ghosts.all;
        let group = links.surface_group.get_or_init(|| self.surface_group(surface, links));
        pass.set_bind_group(0, group, &[]);
        let view = array_view(texture);
        self.encode_dispatch(pass, links, &view, format, FillRound::Cubic, FillDispatch::Scatter)
    }

    /// Fills the linked texels of one texture. `surface_group` is the bind group of the surface with these links.
    pub(crate) fn fill_links(
        &self,
        links: &Links,
        surface_group: &wgpu::BindGroup,
        texture: &wgpu::Texture,
        format: Format,
        rounds: &[FillRound],
    ) -> Result<(), GpuError> {
        self.submit_compute_pass(|pass| self.encode_links(pass, links, surface_group, texture, format, rounds))
    }

    fn encode_links(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        links: &Links,
        surface_group: &wgpu::BindGroup,
        texture: &wgpu::Texture,
        format: Format,
        rounds: &[FillRound],
    ) -> Result<(), GpuError> {
        if links.count == 0 || rounds.is_empty() {
            return Ok(());
        }
        let view = array_view(texture);
        pass.set_bind_group(0, surface_group, &[]);
        for round in rounds {
            for dispatch in FillDispatch::of_round(*round, format) {
                self.encode_dispatch(pass, links, &view, format, *round, *dispatch)?;
            }
        }
        Ok(())
    }

    fn encode_dispatch(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        links: &Links,
        view: &wgpu::TextureView,
        format: Format,
        round: FillRound,
        dispatch: FillDispatch,
    ) -> Result<(), GpuError> {
        let groups = links.count.div_ceil(GROUP);
        let with_ghosts = usize::from(matches!(round, FillRound::WithGhosts | FillRound::Settled));
        let kernel = self.fill_kernel(round, dispatch, format)?;
        let constants = links.constants[with_ghosts].as_entire_binding();
        let view = wgpu::BindingResource::TextureView(view);
        // All textures share the buffer of values, so gathering and scattering are one submission.
        let values = (dispatch != FillDispatch::InPlace).then(|| links.values.as_entire_binding());
        let group = self.bind(&kernel.layout, [constants, view].into_iter().chain(values));
        pass.set_pipeline(&kernel.pipeline);
        pass.set_bind_group(1, &group, &[]);
        pass.dispatch_workgroups(ROW.min(groups), groups.div_ceil(ROW), 1);
        Ok(())
    }
}
