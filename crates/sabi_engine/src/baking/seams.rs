//! What becomes of the differences that maps show at seams.

use std::sync::OnceLock;

use sabi_export::{Channel, ChannelPixels, SeamSamples, SetLayout};
use sabi_surface::seams::{Seam, seams};

use crate::opening::linked_model::LinkedModel;

/// What becomes of the little that heights and normals differ by on both sides of a seam, where two grids of texels meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Seams {
    /// The texels beside seams are changed until both sides agree; all others stay as they are.
    #[default]
    Erase,
    /// Every texel is written as it was evaluated.
    Keep,
}

/// The seams of a model, found when the first set asks.
pub(crate) struct ModelSeams<'a> {
    wanted: Seams,
    linked: &'a LinkedModel,
    found: OnceLock<Vec<Seam>>,
}

impl<'a> ModelSeams<'a> {
    pub(crate) fn new(wanted: Seams, linked: &'a LinkedModel) -> ModelSeams<'a> {
        ModelSeams {
            wanted,
            linked,
            found: OnceLock::new(),
        }
    }

    /// Makes both sides of a set's seams alike, in channels whose differences show: a step of the height is a crack, and
    /// one of the normal a line in every highlight. `samples` are those of the set, once somebody has asked for them.
    ///
    /// Returns whether texels may have changed, so that what lies around the charts must follow them.
    pub(crate) fn erase(
        &self,
        layout: &SetLayout,
        samples: &OnceLock<SeamSamples>,
        channel: &Channel,
        pixels: &mut ChannelPixels,
    ) -> bool {
        if self.wanted == Seams::Keep || !matches!(channel, Channel::Height | Channel::Normal) {
            return false;
        }
        let LinkedModel { model, atlas, .. } = self.linked;
        let found = self.found.get_or_init(|| seams(&model.mesh, atlas));
        let samples = samples.get_or_init(|| SeamSamples::new(&model.mesh, found, atlas, layout));
        if *channel == Channel::Height {
            samples.erase_heights(pixels);
        } else {
            samples.erase_normals(&model.mesh, pixels);
        }
        !samples.is_empty()
    }
}
