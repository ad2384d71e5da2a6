//! Encoding and writing of maps on a separate thread, while the next maps are read back and computed.

use std::sync::mpsc::{Sender, channel};
use std::{panic, thread};

use sabi_export::{
    BakeWriter, Channel, ChannelPixels, ConstantRecord, DocumentRecord, OutputRecord, SetLayout, SetOptions,
    UnmappedChannels,
};

use super::memory_budget::{MemoryBudget, ReservedMemory};
use crate::baking::report::ModelCopyReport;
use crate::baking::seams::SetSeams;
use crate::error::{EngineError, ErrorKind};
use crate::phases::{Phase, Progress, stop_if_canceled};
use crate::warning::Warning;

/// Maps that were written.
#[derive(Default)]
pub(crate) struct WrittenMaps {
    pub(crate) outputs: Vec<OutputRecord>,
    pub(crate) constants: Vec<ConstantRecord>,
    pub(crate) warnings: Vec<Warning>,
    /// Documents of materials that name the maps.
    pub(crate) documents: Vec<DocumentRecord>,
    /// Channels of materials for which presets have no map.
    pub(crate) left_out: Vec<UnmappedChannels>,
    /// Copy of the model that uses the maps.
    pub(crate) copy: Option<ModelCopyReport>,
    /// Kernels that only exports need.
    pub(crate) finish_passes: usize,
}

/// Sorts maps and constants by their sets. In a set the base color comes first, since people look for it, though it is not
/// written first. Others keep the order of writing.
pub(crate) fn sort_by_set(written: &mut WrittenMaps) {
    let of_color = [Channel::BaseColor, Channel::Opacity].map(|channel| channel.name().into_owned());
    let has_color = |output: &OutputRecord| {
        let mut components = output.components.iter();
        components.any(|component| of_color.iter().any(|channel| component.starts_with(channel.as_str())))
    };
    let outputs = &mut written.outputs;
    outputs.sort_by(|a, b| (&a.material, a.udim, !has_color(a)).cmp(&(&b.material, b.udim, !has_color(b))));
    let is_color = |constant: &ConstantRecord| matches!(constant.channel, Channel::BaseColor | Channel::Opacity);
    let constants = &mut written.constants;
    constants.sort_by(|a, b| (&a.material, a.udim, !is_color(a)).cmp(&(&b.material, b.udim, !is_color(b))));
}

/// Step of writing the maps of texture sets.
pub(super) enum MapStep<'s> {
    /// Encodes and writes a channel of a set.
    Write {
        layout: &'s SetLayout,
        /// Stem of the set's files.
        set: &'s str,
        channel: Channel,
        pixels: ChannelPixels,
        /// Seams to be erased; `None` if the graph does not set the channel, which then has its neutral value.
        seams: Option<SetSeams<'s>>,
        /// Memory of the pixels.
        memory: ReservedMemory<'s>,
    },
    /// Leaves out a channel that the set's material does not have.
    LeaveOut {
        layout: &'s SetLayout,
        set: &'s str,
        channel: Channel,
    },
    /// Writes maps that still wait for channels which the set does not have.
    Finish { layout: &'s SetLayout, set: &'s str },
    /// Advances the progress.
    Advance,
}

/// Sends steps to a [`MapEncoder`], which takes them in order.
pub(super) struct MapSteps<'s> {
    sender: Sender<MapStep<'s>>,
    budget: &'s MemoryBudget,
}

impl<'s> MapSteps<'s> {
    /// Waits until there is enough memory for the pixels of a channel besides those of earlier steps.
    pub(super) fn reserve(&self, pixels: usize, channel: &Channel) -> ReservedMemory<'s> {
        self.budget.reserve(pixels * channel.components() * size_of::<f32>())
    }

    /// Sends a step. Fails if an earlier step has failed; in that case [`MapEncoder::take_while`] returns the error of the earlier step.
    pub(super) fn send(&self, step: MapStep<'s>) -> Result<(), EngineError> {
        let sent = self.sender.send(step);
        sent.map_err(|_| EngineError::new(ErrorKind::Interrupted, "an earlier map could not be written"))
    }
}

/// Writer of the maps of a bake under temporary names.
pub(super) struct MapEncoder<'w> {
    pub(super) writer: &'w mut BakeWriter,
    pub(super) options: &'w SetOptions,
    pub(super) written: WrittenMaps,
    /// Number of finished steps for the progress, and number of all steps.
    pub(super) done: usize,
    pub(super) of: usize,
    pub(super) progress: &'w dyn Progress,
}

impl MapEncoder<'_> {
    /// Runs `compute`, and takes its steps on another thread. If it fails, the error is the one that would come first if
    /// each step were taken before the next is computed.
    pub(super) fn take_while<'s>(
        &mut self,
        budget: &'s MemoryBudget,
        compute: impl FnOnce(&MapSteps<'s>) -> Result<(), EngineError>,
    ) -> Result<(), EngineError> {
        let (sender, receiver) = channel();
        thread::scope(|scope| {
            let taking = scope.spawn(move || receiver.into_iter().try_for_each(|step| self.take(step)));
            // Dropped at the end of the closure, which ends the other thread.
            let steps = MapSteps { sender, budget };
            let computed = compute(&steps);
            drop(steps);
            let taken = taking.join().unwrap_or_else(|payload| panic::resume_unwind(payload));
            taken.and(computed)
        })
    }

    fn take(&mut self, step: MapStep<'_>) -> Result<(), EngineError> {
        match step {
            MapStep::Write {
                layout,
                set,
                channel,
                mut pixels,
                seams,
                memory,
            } => {
                // Checked before each map, since encoding a large map takes seconds.
                stop_if_canceled(self.progress)?;
                if let Some(seams) = &seams {
                    seams.settle(layout, &channel, &mut pixels);
                }
                self.write(layout, set, &channel, pixels, seams.is_some())?;
                drop(memory);
            }
            MapStep::LeaveOut { layout, set, channel } => {
                let complete = self.writer.set(layout, set, self.options).leave_out(&channel)?;
                self.written.outputs.extend(complete);
            }
            MapStep::Finish { layout, set } => {
                let complete = self.writer.set(layout, set, self.options).finish()?;
                self.written.outputs.extend(complete);
            }
            MapStep::Advance => {
                self.done += 1;
                self.progress.advance(Phase::Encode, self.done, self.of);
            }
        }
        Ok(())
    }

    fn write(
        &mut self,
        layout: &SetLayout,
        set: &str,
        channel: &Channel,
        pixels: ChannelPixels,
        is_connected: bool,
    ) -> Result<(), EngineError> {
        let _span = tracing::debug_span!("encode", set, channel = %channel.name()).entered();
        let mut writer = self.writer.set(layout, set, self.options);
        let done = writer.channel(channel, pixels, is_connected)?;
        if done.not_finite > 0 {
            let sentence = format!(
                "{} values of {} in '{set}' were not numbers and were replaced; look for a division by zero in the graph",
                done.not_finite,
                channel.name(),
            );
            self.written.warnings.push(sentence.into());
        }
        self.written.outputs.extend(done.outputs);
        self.written.constants.extend(done.constant);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;
    use std::sync::atomic::{AtomicBool, Ordering};

    use sabi_export::{Cover, SetKey};

    use super::*;

    const SIZE: u32 = 16;

    /// Progress that records reports and can be canceled.
    #[derive(Default)]
    struct RecordedProgress {
        steps: Mutex<Vec<usize>>,
        is_canceled: AtomicBool,
    }

    impl Progress for RecordedProgress {
        fn advance(&self, _phase: Phase, done: usize, _of: usize) {
            self.steps.lock().unwrap().push(done);
        }

        fn is_canceled(&self) -> bool {
            self.is_canceled.load(Ordering::Relaxed)
        }
    }

    fn layout() -> SetLayout {
        let pixels = (SIZE * SIZE) as usize;
        SetLayout {
            key: SetKey {
                material: 0,
                uv_tile: [0, 0],
                udim: None,
            },
            size: SIZE,
            source: (0..SIZE * SIZE).collect(),
            cover: vec![Cover::Owned; pixels],
            shared: Vec::new(),
            collisions: 0,
        }
    }

    /// Sends a channel that varies.
    fn send<'s>(
        steps: &MapSteps<'s>,
        layout: &'s SetLayout,
        set: &'s str,
        channel: Channel,
    ) -> Result<(), EngineError> {
        let pixels = (SIZE * SIZE) as usize;
        let memory = steps.reserve(pixels, &channel);
        let components = channel.components();
        let data = (0..pixels * components)
            .map(|index| (index as f32).sin().abs())
            .collect();
        steps.send(MapStep::Write {
            layout,
            set,
            channel,
            pixels: ChannelPixels { components, data },
            seams: None,
            memory,
        })?;
        steps.send(MapStep::Advance)
    }

    /// Takes the steps of a computation, with memory for one map. Returns the names of the files.
    fn taken<'s>(
        progress: &RecordedProgress,
        budget: &'s MemoryBudget,
        compute: impl FnOnce(&MapSteps<'s>) -> Result<(), EngineError>,
    ) -> Result<Vec<String>, EngineError> {
        let folder = tempfile::tempdir().unwrap();
        let mut writer = BakeWriter::create(folder.path()).unwrap();
        let mut encoder = MapEncoder {
            writer: &mut writer,
            options: &SetOptions::raw().unwrap(),
            written: WrittenMaps::default(),
            done: 0,
            of: 3,
            progress,
        };
        encoder.take_while(budget, compute)?;
        Ok(encoder.written.outputs.into_iter().map(|output| output.path).collect())
    }

    #[test]
    fn maps_are_written_in_the_order_in_which_they_are_computed() {
        let (progress, layout, budget) = (RecordedProgress::default(), layout(), MemoryBudget::new(0));
        let files = taken(&progress, &budget, |steps| {
            [Channel::Normal, Channel::BaseColor, Channel::Height]
                .into_iter()
                .try_for_each(|channel| send(steps, &layout, "wood", channel))
        });
        let names = [
            "wood_normal.png",
            "wood_base_color.png",
            "wood_height.exr",
            "wood_height.png",
        ];
        assert_eq!(files.unwrap(), names);
        assert_eq!(*progress.steps.lock().unwrap(), [1, 2, 3]);
    }

    #[test]
    fn the_error_of_an_earlier_map_comes_before_that_of_a_later_one() {
        let (layout, budget) = (layout(), MemoryBudget::new(usize::MAX));
        let lost = || EngineError::new(ErrorKind::OutOfMemory, "the device is lost");
        let error = |set: &str| {
            let computed = taken(&RecordedProgress::default(), &budget, |steps| {
                let sent = [Channel::Roughness, Channel::Normal]
                    .into_iter()
                    .try_for_each(|channel| send(steps, &layout, set, channel));
                sent.and(Err(lost()))
            });
            computed.unwrap_err()
        };
        assert_eq!(error("wood"), lost());
        let refused = error("no/folder").to_string();
        assert!(refused.contains("no/folder_roughness.png"), "{refused}");
    }

    #[test]
    fn a_canceled_bake_encodes_no_further_map() {
        let (progress, layout, budget) = (RecordedProgress::default(), layout(), MemoryBudget::new(usize::MAX));
        progress.is_canceled.store(true, Ordering::Relaxed);
        let canceled = taken(&progress, &budget, |steps| {
            send(steps, &layout, "wood", Channel::Height)
        });
        assert_eq!(canceled.unwrap_err().kind, ErrorKind::Interrupted);
        assert!(progress.steps.lock().unwrap().is_empty());
    }
}
