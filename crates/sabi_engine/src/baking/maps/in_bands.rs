//! Maps whose values are read back in bands of rows, so that neither a result nor its normals are in memory as a whole.

use std::ops::Range;

use sabi_export::{BandGather, Channel, ChannelPixels};
use sabi_gpu::{BandData, Normals, Run, read_slot_in_bands};
use sabi_nodes::kind::Channel as Stored;
use sabi_nodes::link::Plane;
use sabi_plan::{PlannedResult, SlotRef};

use super::{MapStep, Maps, OpenSet};
use crate::error::EngineError;
use crate::evaluating::looks::slot_of;
use crate::phases::stop_if_canceled;

/// Receiver of bands: their texels, counted page by page and row by row, and their data.
type Visit<'v> = &'v mut dyn FnMut(&Range<usize>, &BandData<'_>);

impl OpenSet<'_> {
    /// Number of its pixels.
    pub(super) fn pixels(&self) -> usize {
        self.padding.pixels()
    }

    /// Returns true if each pixel shows one texel of one result, so that bands can be read one after another.
    pub(super) fn is_gathered_in_bands(&self) -> bool {
        self.results.distinct.len() <= 1 && self.layout.shared.is_empty()
    }

    fn bands(&self) -> &BandGather {
        self.bands.get_or_init(|| BandGather::new(&self.padding, &self.layout))
    }
}

impl<'s> Maps<'_, 's> {
    /// Sends one channel of a stored plane, whose values begin at `first`. Without a plane, sends its neutral value, or
    /// nothing for a channel that few materials have.
    pub(super) fn channel_in_bands(
        &mut self,
        run: &Run,
        slot: Option<SlotRef>,
        set: &'s OpenSet<'s>,
        channel: &Channel,
        first: usize,
        value: impl Fn([f32; 4]) -> [f32; 4] + Sync,
    ) -> Result<(), EngineError> {
        if channel.is_rare() && slot.is_none() {
            return self.steps.send(MapStep::LeaveOut {
                layout: &set.layout,
                set: &set.work.name,
                channel: channel.clone(),
            });
        }
        let from = self.from;
        let (gpu, surface) = (from.evaluator.gpu(), from.evaluator.surface());
        let read = slot.map(|slot| {
            move |texels: &Range<usize>, visit: Visit<'_>| -> Result<(), EngineError> {
                Ok(read_slot_in_bands(gpu, surface, from.plan, run, slot, texels, visit)?)
            }
        });
        self.gathered(set, channel, first, read, value)
    }

    /// Sends one channel that has the same value in all texels that its set shows.
    pub(super) fn even_channel(
        &mut self,
        set: &'s OpenSet<'s>,
        channel: &Channel,
        first: usize,
        value: [f32; 4],
    ) -> Result<(), EngineError> {
        stop_if_canceled(self.progress)?;
        let memory = self.steps.reserve(set.pixels(), channel);
        let pixels = {
            let _span =
                tracing::debug_span!("lay out", set = set.work.name.as_str(), channel = %channel.name()).entered();
            set.padding.gather(&set.layout, channel, first, |_| value)
        };
        self.send(set, channel.clone(), pixels, true, memory)
    }

    /// Computes and sends the normals of a set; the neutral ones if its material has neither height nor slope.
    pub(super) fn normals_in_bands(
        &mut self,
        run: &mut Run,
        result: &PlannedResult,
        set: &'s OpenSet<'s>,
    ) -> Result<(), EngineError> {
        let [height, slope] = [Stored::Height, Stored::Slope].map(|stored| slot_of(result, Plane::Material(stored)));
        let is_flat = height.is_none() && slope.is_none();
        self.finish_passes += usize::from(!is_flat);
        let from = self.from;
        let (gpu, surface) = (from.evaluator.gpu(), from.evaluator.surface());
        let normals = Normals {
            gpu,
            surface,
            height,
            slope,
            options: &from.run_options,
        };
        let read = (!is_flat).then_some(|texels: &Range<usize>, visit: Visit<'_>| -> Result<(), EngineError> {
            Ok(normals.read_in_bands(run, texels, visit)?)
        });
        self.gathered(set, &Channel::Normal, 0, read, |normal| normal)?;
        self.steps.send(MapStep::Advance)
    }

    /// Gathers the values of a channel from bands that `read` reads for a range of texels, and sends them.
    fn gathered(
        &mut self,
        set: &'s OpenSet<'s>,
        channel: &Channel,
        first: usize,
        read: Option<impl FnOnce(&Range<usize>, Visit<'_>) -> Result<(), EngineError>>,
        value: impl Fn([f32; 4]) -> [f32; 4] + Sync,
    ) -> Result<(), EngineError> {
        stop_if_canceled(self.progress)?;
        let memory = self.steps.reserve(set.pixels(), channel);
        let span =
            tracing::debug_span!("read back and lay out", set = set.work.name.as_str(), channel = %channel.name());
        let entered = span.entered();
        let mut pixels = ChannelPixels::neutral(channel, set.pixels());
        let is_connected = read.is_some();
        if let Some(read) = read {
            let bands = set.bands();
            read(&bands.texels(), &mut |band, data| {
                bands.add(
                    &set.padding,
                    &set.layout,
                    channel,
                    &mut pixels,
                    band,
                    first,
                    |texels, out| {
                        data.copy_texels(texels.start - band.start..texels.end - band.start, out);
                        out.iter_mut().for_each(|texel| *texel = value(*texel));
                    },
                );
            })?;
        }
        drop(entered);
        self.send(set, channel.clone(), pixels, is_connected, memory)
    }
}
