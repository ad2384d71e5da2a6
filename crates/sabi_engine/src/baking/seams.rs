//! Treatment of the differences between both sides of a seam.

use std::sync::OnceLock;

use sabi_export::{Channel, ChannelPixels, ChartBorders, PaddingMap, SeamSamples, SetLayout};
use sabi_surface::seams::{Seam, seams};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::opening::linked_model::LinkedModel;

/// Treatment of the small differences of heights and normals between both sides of a seam, where two grids of texels meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Seams {
    /// Adjusts the texels next to seams until both sides agree.
    #[default]
    Erase,
    /// Writes every texel as it was evaluated.
    Keep,
}

/// Seams and borders of a texture set of a model.
pub(super) struct SetSeams<'s> {
    pub(super) of_model: &'s ModelSeams<'s>,
    /// Found on first use.
    pub(super) samples: &'s OnceLock<SeamSamples>,
    /// Found on first use.
    pub(super) borders: &'s OnceLock<ChartBorders>,
    pub(super) padding: &'s PaddingMap,
}

impl SetSeams<'_> {
    /// Repeats charts in the texels around them where the data jumps, and adjusts both sides of the set's seams in channels
    /// whose differences are visible: a step in the height is a crack, and one in the normal is a line in every highlight.
    pub(super) fn settle(&self, layout: &SetLayout, channel: &Channel, pixels: &mut ChannelPixels) {
        let atlas = &self.of_model.linked.atlas;
        let borders = self.borders.get_or_init(|| ChartBorders::new(atlas, layout));
        let are_repeated = borders.repeat_charts(channel, pixels);
        let are_erased = self.of_model.erase(layout, self.samples, channel, pixels);
        if are_repeated || are_erased {
            self.padding.pad(channel, pixels);
        }
    }
}

/// Seams of a model, computed on first use.
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

    /// Adjusts both sides of a set's seams. `samples` caches its seam samples. Returns true if texels may have changed, so
    /// that the padding must be updated.
    fn erase(
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
