//! Maps: results that are read back, laid out like the model's UVs, and written.

mod in_bands;
mod material;
mod peaks;
mod sameness;
mod set_pixels;

use std::collections::BTreeMap;
use std::sync::OnceLock;

use sabi_color::luminance;
use sabi_export::{
    BakeWriter, BandGather, Channel, ChannelPixels, ChartBorders, Padding, PaddingMap, SeamSamples, SetKey, SetLayout,
    SetOptions,
};
use sabi_gpu::{AdapterKind, PlaneData, Run, RunOptions, read_slot};
use sabi_graph::PortType;
use sabi_plan::{Plan, PlannedResult, SlotRef};

use self::material::MAPS;
pub(crate) use self::set_pixels::SetPixels;
use crate::baking::map_encoder::{MapEncoder, MapStep, MapSteps, WrittenMaps, sort_by_set};
use crate::baking::memory_budget::{MemoryBudget, ReservedMemory};
use crate::baking::seams::{ModelSeams, SetSeams};
use crate::baking::sheet_results::SheetResults;
use crate::error::EngineError;
use crate::evaluating::evaluator::Evaluator;
use crate::phases::{Progress, stop_if_canceled};

/// Texture set with its results.
pub(crate) struct SetWork<'p> {
    /// Key of the set.
    pub(crate) key: SetKey,
    /// Stem of its file names.
    pub(crate) name: String,
    /// Result that serves each material, by material index; empty if no result does.
    pub(crate) materials: BTreeMap<u32, &'p PlannedResult>,
    /// Results that become separate maps, each with its channel.
    pub(crate) maps: Vec<(Channel, &'p PlannedResult)>,
}

/// Writer of the maps of texture sets, one plane at a time.
pub(crate) struct MapWriter<'a> {
    pub(crate) evaluator: &'a Evaluator,
    pub(crate) plan: &'a Plan,
    pub(crate) options: SetOptions,
    pub(crate) padding: Padding,
    pub(crate) seams: ModelSeams<'a>,
    pub(crate) run_options: RunOptions<'a>,
}

/// Approximate memory limit for the layouts and paddings of sets that are written together.
const LAYOUT_BUDGET_BYTES: usize = 1 << 30;
/// Limit for the pixels of maps that wait or are being encoded, for devices that keep textures in the same memory: a mask
/// of 4096², or two color maps of 2048². A larger map is processed alone.
const PIXEL_BUDGET_BYTES: usize = 96 << 20;
/// The same limit for devices with their own memory: two color maps of 4096², one of which is encoded while the other is laid out.
const DISCRETE_PIXEL_BUDGET_BYTES: usize = 384 << 20;
/// Bytes per pixel of a layout's source and cover, and at most of the padding's sources.
const LAYOUT_PIXEL_BYTES: usize = 9;

/// Returns the maximum number of bytes of the layout and the padding of a set of maps of a size.
fn layout_bytes(size: u32) -> usize {
    (size as usize).pow(2) * LAYOUT_PIXEL_BYTES
}

impl MapWriter<'_> {
    /// Writes all sets under temporary names. A plane is read back once for all sets that fit into memory together. The
    /// pixels of the first set may already be laid out.
    pub(crate) fn write(
        &self,
        run: &mut Run,
        sets: &[SetWork<'_>],
        mut first: Option<SetPixels>,
        writer: &mut BakeWriter,
        progress: &dyn Progress,
    ) -> Result<WrittenMaps, EngineError> {
        let atlas = &self.evaluator.linked().atlas;
        let set_bytes = layout_bytes(atlas.size);
        let mut encoder = MapEncoder {
            writer,
            options: &self.options,
            written: WrittenMaps::default(),
            done: 0,
            of: sets
                .iter()
                .map(|set| set.maps.len() + if set.materials.is_empty() { 0 } else { MAPS.len() + 2 })
                .sum(),
            progress,
        };
        let budget = MemoryBudget::new(match self.evaluator.gpu().summary().kind {
            AdapterKind::Discrete => DISCRETE_PIXEL_BUDGET_BYTES,
            AdapterKind::Integrated | AdapterKind::Cpu => PIXEL_BUDGET_BYTES,
        });
        let mut finish_passes = 0;
        run.drop_unused();
        for (material, peak) in self.emission_peaks(run, sets)? {
            encoder.writer.set_peak(material, &Channel::Emission, peak);
        }
        let mut chunks = sets.chunks((LAYOUT_BUDGET_BYTES / set_bytes.max(1)).max(1)).peekable();
        while let Some(together) = chunks.next() {
            let open: Vec<OpenSet<'_>> = together.iter().map(|work| self.open(work, first.take())).collect();
            encoder.take_while(&budget, |steps| {
                let mut maps = Maps {
                    from: self,
                    steps,
                    finish_passes: 0,
                    frees_results: chunks.peek().is_none(),
                    progress,
                };
                maps.sets(run, &open)?;
                finish_passes += maps.finish_passes;
                Ok(())
            })?;
        }
        let mut written = encoder.written;
        written.finish_passes = finish_passes;
        // Maps were written plane by plane, but the report lists them set by set.
        sort_by_set(&mut written);
        Ok(written)
    }

    fn open<'s>(&self, work: &'s SetWork<'s>, pixels: Option<SetPixels>) -> OpenSet<'s> {
        let linked = self.evaluator.linked();
        let SetPixels { layout, padding } = pixels.unwrap_or_else(|| SetPixels::new(linked, work.key, self.padding));
        OpenSet {
            work,
            results: SheetResults::new(&linked.atlas, &work.materials),
            layout,
            padding,
            bands: OnceLock::new(),
            seams: OnceLock::new(),
            borders: OnceLock::new(),
        }
    }

    fn read(&self, run: &Run, slot: SlotRef) -> Result<PlaneData, EngineError> {
        let _span = tracing::debug_span!("read back").entered();
        let (gpu, surface) = (self.evaluator.gpu(), self.evaluator.surface());
        Ok(read_slot(gpu, surface, self.plan, run, slot)?)
    }
}

/// Texture set with its layout.
struct OpenSet<'a> {
    work: &'a SetWork<'a>,
    results: SheetResults<'a>,
    layout: SetLayout,
    padding: PaddingMap,
    /// Texels from which its pixels take values, computed on first use.
    bands: OnceLock<BandGather>,
    seams: OnceLock<SeamSamples>,
    borders: OnceLock<ChartBorders>,
}

/// Maps that are read back, laid out, and sent as steps.
struct Maps<'a, 's> {
    from: &'s MapWriter<'s>,
    steps: &'a MapSteps<'s>,
    finish_passes: usize,
    /// True if no other sets read the results later.
    frees_results: bool,
    progress: &'a dyn Progress,
}

impl<'s> Maps<'_, 's> {
    /// Hands over all maps of sets.
    fn sets(&mut self, run: &mut Run, open: &'s [OpenSet<'s>]) -> Result<(), EngineError> {
        self.frees_results &= open.iter().all(|set| set.results.distinct.len() <= 1);
        for result in &self.from.plan.results {
            let is_served = |set: &&OpenSet<'_>| match set.results.distinct[..] {
                [served] => std::ptr::eq(served, result),
                _ => false,
            };
            let served: Vec<&OpenSet<'_>> = open.iter().filter(is_served).collect();
            self.material(run, &[result], &served)?;
            self.own_maps(run, result, open)?;
        }
        for set in open.iter().filter(|set| set.results.distinct.len() > 1) {
            self.material(run, &set.results.distinct, &[set])?;
        }
        // A material that no output serves keeps its existing maps.
        for set in open.iter().filter(|set| !set.work.materials.is_empty()) {
            self.steps.send(MapStep::Finish {
                layout: &set.layout,
                set: &set.work.name,
            })?;
        }
        Ok(())
    }

    /// Writes the map of a result for every set.
    fn own_maps(&mut self, run: &mut Run, result: &PlannedResult, sets: &'s [OpenSet<'s>]) -> Result<(), EngineError> {
        let mut planes = Vec::new();
        let mut is_read = false;
        for set in sets {
            let its = set.work.maps.iter().filter(|(_, map)| std::ptr::eq(*map, result));
            for (channel, _) in its {
                let takes_one = channel.components() == 1;
                let value = |[r, g, b, a]: [f32; 4]| match (result.stored.ty, takes_one) {
                    (PortType::Color, true) => [luminance([r, g, b]); 4],
                    (PortType::Mask, _) => [r; 4],
                    _ => [r, g, b, a],
                };
                // A mask, color or vector has one plane.
                let slot = result.slots[0];
                if set.layout.shared.is_empty() {
                    self.channel_in_bands(run, Some(slot), set, channel, 0, value)?;
                } else {
                    if planes.is_empty() {
                        planes.push(Some(self.from.read(run, slot)?));
                    }
                    self.channel(set, channel, &planes, 0, value)?;
                }
                is_read = true;
                self.steps.send(MapStep::Advance)?;
            }
        }
        if is_read {
            self.free(run, &[result.slots.first().copied()]);
        }
        Ok(())
    }

    /// Sends one channel. Without a plane, sends its neutral value, or nothing for a channel that few materials have. There
    /// is one plane for each result of the set, or one for the whole set.
    fn channel(
        &mut self,
        set: &'s OpenSet<'s>,
        channel: &Channel,
        planes: &[Option<PlaneData>],
        first: usize,
        value: impl Fn([f32; 4]) -> [f32; 4] + Sync,
    ) -> Result<(), EngineError> {
        stop_if_canceled(self.progress)?;
        let (layout, name, channel) = (&set.layout, set.work.name.as_str(), channel.clone());
        if channel.is_rare() && planes.iter().all(Option::is_none) {
            return self.steps.send(MapStep::LeaveOut {
                layout,
                set: name,
                channel,
            });
        }
        let memory = self.steps.reserve(set.pixels(), &channel);
        let span = tracing::debug_span!("lay out", set = name, channel = %channel.name()).entered();
        let texel = |index| match set.results.texel(planes, index) {
            Some(stored) => value(stored),
            None => {
                let mut values = [0.0; 4];
                for (value, neutral) in values.iter_mut().skip(first).zip(channel.neutral()) {
                    *value = *neutral;
                }
                values
            }
        };
        let mut pixels = if planes.iter().all(Option::is_none) {
            ChannelPixels::neutral(&channel, set.pixels())
        } else {
            set.padding.gather(layout, &channel, first, texel)
        };
        if channel == Channel::Normal && !layout.shared.is_empty() {
            // The mean of unit vectors is shorter than 1, so it is normalized.
            for normal in pixels.data.chunks_exact_mut(3) {
                let length = normal.iter().map(|part| part * part).sum::<f32>().sqrt();
                if length > 0.0 {
                    normal.iter_mut().for_each(|part| *part /= length);
                }
            }
        }
        drop(span);
        self.send(set, channel, pixels, planes.iter().any(Option::is_some), memory)
    }

    /// Sends the pixels of a channel.
    fn send(
        &self,
        set: &'s OpenSet<'s>,
        channel: Channel,
        pixels: ChannelPixels,
        is_connected: bool,
        memory: ReservedMemory<'s>,
    ) -> Result<(), EngineError> {
        let seams = is_connected.then_some(SetSeams {
            of_model: &self.from.seams,
            samples: &set.seams,
            borders: &set.borders,
            padding: &set.padding,
        });
        self.steps.send(MapStep::Write {
            layout: &set.layout,
            set: &set.work.name,
            channel,
            pixels,
            seams,
            memory,
        })
    }
}
