//! Writing of the files of a bake, one channel at a time.

mod documents;
mod file;
mod options;
#[cfg(test)]
mod tests;
mod tiles;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use sabi_files::{Disk, StagedSet};

pub use self::documents::WrittenDocuments;
use self::file::{ComponentValues, EncodedFile, FileSet, StagedMap, WantedFile, held_values, sources};
pub use self::options::{NamedPreset, SetOptions};
use crate::constant::{constant_value, survey};
use crate::document::{ChannelFacts, FileFacts, SetFacts, changes_nothing};
use crate::encoded_files::EncodedFiles;
use crate::held_channels::{HeldChannel, HeldSet, MapIndex};
use crate::layout::{Cover, SetKey, SetLayout};
use crate::model_copy::{ChannelInput, MapCollector, MaterialMaps, WrittenMap};
use crate::name_pattern::{NameParts, NamePattern};
use crate::preset::{Map, MapContent, When, components_of};
use crate::{Channel, ChannelPixels, ConstantRecord, CutMap, ExportError, OutputRecord, UnmappedChannels};

/// Writes the texture sets of one bake into a folder; all files are put in place together by [`BakeWriter::commit`].
#[derive(Debug)]
pub struct BakeWriter {
    staged: StagedSet,
    /// Names of files that presets name and that this bake did not write: maps of constant channels, of channels that the
    /// material does not have, and of values above 1 where there are none.
    skipped: BTreeSet<String>,
    /// Channels of each set that wait for others.
    held: BTreeMap<SetKey, HeldSet>,
    /// Channels and files of each set, for documents.
    facts: BTreeMap<SetKey, SetFacts>,
    /// Maps for a copy of the model; `None` when no copy is made.
    map_collector: Option<MapCollector>,
    /// Files of earlier bakes.
    encoded_files: Option<Box<dyn EncodedFiles>>,
    /// Names of the files that were taken from there.
    kept: Vec<String>,
    /// Highest values of channels over all tiles of a material, where its tiles share a scale.
    peaks: BTreeMap<(u32, Channel), f32>,
    /// Maps that hold less than their channel.
    cut: Vec<CutMap>,
}

/// Result of writing a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenChannel {
    /// Its files; none when it is constant and maps of constants were not asked for.
    pub outputs: Vec<OutputRecord>,
    /// Its value where it is constant.
    pub constant: Option<ConstantRecord>,
    /// Values that were no numbers or infinite, and were replaced by the channel's neutral value.
    pub not_finite: u64,
}

/// Result of a committed bake.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CommittedBake {
    /// All files now in place.
    pub files: Vec<PathBuf>,
    /// Files in the folder that an earlier bake of these sets may have written and this one has not, because their
    /// channels are constant now. They are not touched.
    pub left_over: Vec<PathBuf>,
}

impl BakeWriter {
    /// Creates the folder where it does not exist, and checks that it can be written to.
    pub fn create(folder: &Path) -> Result<BakeWriter, ExportError> {
        BakeWriter::create_on(&Disk::default(), folder)
    }

    /// Creates the folder on a disk where it does not exist, and checks that it can be written to.
    pub fn create_on(disk: &Disk, folder: &Path) -> Result<BakeWriter, ExportError> {
        Ok(BakeWriter {
            staged: StagedSet::create_on(disk, folder)?,
            skipped: BTreeSet::new(),
            held: BTreeMap::new(),
            facts: BTreeMap::new(),
            map_collector: None,
            encoded_files: None,
            kept: Vec::new(),
            peaks: BTreeMap::new(),
            cut: Vec::new(),
        })
    }

    /// Takes files from a store instead of encoding them again, and keeps new ones there, from now on.
    pub fn keep_encoded_files(&mut self, files: Box<dyn EncodedFiles>) {
        self.encoded_files = Some(files);
    }

    /// Names of the files that were not encoded, because an earlier bake had.
    pub fn kept(&self) -> &[String] {
        &self.kept
    }

    /// Collects the maps that a copy of the model needs from now on: those of all channels that are no masks.
    pub fn keep_model_maps(&mut self) {
        self.map_collector = Some(MapCollector::default());
    }

    /// Takes the collected maps of each set.
    pub fn take_model_maps(&mut self) -> BTreeMap<SetKey, MaterialMaps> {
        // Maps are collected only after `keep_model_maps`.
        self.map_collector.take().map(MapCollector::finish).unwrap_or_default()
    }

    /// Returns whether the bake has a file of that name already, on a file system that ignores case.
    pub fn contains(&self, file_name: &str) -> bool {
        self.staged.contains(file_name)
    }

    /// Checks that a file may be written under a name: an error if the bake reads it, or if it is no ordinary file.
    pub fn check(&self, file_name: &str) -> Result<(), ExportError> {
        Ok(self.staged.check(file_name)?)
    }

    /// Refuses to replace these files, which the bake reads.
    pub fn protect(&mut self, inputs: impl IntoIterator<Item = PathBuf>) {
        self.staged.protect(inputs);
    }

    /// Sets the highest value of a channel over all tiles of a material, by which normalized maps of each tile are divided. Without it
    /// each tile has its own.
    pub fn set_peak(&mut self, material: u32, channel: &Channel, peak: f32) {
        self.peaks.insert((material, channel.clone()), peak);
    }

    /// Maps in whole numbers so far whose channels exceed 1, where their preset has no other map that holds all of it.
    pub fn cut_maps(&self) -> &[CutMap] {
        &self.cut
    }

    /// Channels of the materials that presets have no map for, once all sets are finished. Channels that change nothing do not
    /// count, nor do presets without any map of a material.
    pub fn left_out(&self, options: &SetOptions) -> Vec<UnmappedChannels> {
        let mut materials: BTreeMap<u32, (&str, BTreeSet<&Channel>)> = BTreeMap::new();
        for (key, set) in &self.facts {
            let (_, channels) = materials.entry(key.material).or_insert((&set.name, BTreeSet::new()));
            let matter = set
                .channels
                .iter()
                .filter(|(channel, facts)| !facts.constant.is_some_and(|value| changes_nothing(channel, value)));
            channels.extend(matter.map(|(channel, _)| channel));
        }
        let mut found = Vec::new();
        for preset in options.presets() {
            let left_out = preset.left_out();
            for (material, has) in materials.values().filter(|_| left_out.len() < Channel::ALL.len()) {
                // The roughness of a layer goes with the layer.
                let is_layered = |channel: &Channel| match channel {
                    Channel::CoatRoughness => has.contains(&Channel::Coat),
                    Channel::SheenRoughness => has.contains(&Channel::Sheen),
                    _ => true,
                };
                let channels = left_out
                    .iter()
                    .filter(|channel| has.contains(channel) && is_layered(channel));
                let channels: Vec<Channel> = channels.cloned().collect();
                if !channels.is_empty() {
                    found.push(UnmappedChannels {
                        preset: preset.name.clone(),
                        material: (*material).to_owned(),
                        channels,
                    });
                }
            }
        }
        found
    }

    /// Begins a texture set. `name` is the stem of its files, from [`crate::set_names`].
    pub fn set<'a>(&'a mut self, layout: &'a SetLayout, name: &str, options: &'a SetOptions) -> SetWriter<'a> {
        SetWriter {
            bake: self,
            layout,
            name: name.to_owned(),
            options,
        }
    }

    /// Adds a file of the caller's own, such as the report, that takes its place with the maps.
    pub fn extra_file(&mut self, file_name: &str, bytes: &[u8]) -> Result<(), ExportError> {
        Ok(self.staged.stage(file_name, bytes)?)
    }

    /// Puts all files in place.
    pub fn commit(self) -> Result<CommittedBake, ExportError> {
        let folder = self.staged.folder().to_owned();
        let files = self.staged.commit()?;
        let left_over = self
            .skipped
            .iter()
            .map(|name| folder.join(name))
            .filter(|path| path.is_file())
            .collect();
        Ok(CommittedBake { files, left_over })
    }
}

/// Writes one texture set of a bake.
#[derive(Debug)]
pub struct SetWriter<'a> {
    bake: &'a mut BakeWriter,
    layout: &'a SetLayout,
    name: String,
    options: &'a SetOptions,
}

impl SetWriter<'_> {
    /// Adds a channel, and writes the files that it completes under their temporary names, on all cores. Padded pixels are
    /// expected (see [`crate::PaddingMap::gather`]); only owned ones decide whether the channel is constant. `is_connected`
    /// says that the graph gives the channel, rather than its neutral value.
    pub fn channel(
        &mut self,
        channel: &Channel,
        mut pixels: ChannelPixels,
        is_connected: bool,
    ) -> Result<WrittenChannel, ExportError> {
        let components = channel.components();
        let expected = self.layout.cover.len() * components;
        if pixels.components != components || pixels.data.len() != expected {
            let channel = channel.name().into_owned();
            return Err(ExportError::WrongSize {
                channel,
                given: pixels.data.len(),
                expected,
            });
        }
        let found = survey(channel, self.layout, &mut pixels);
        if let (Channel::Height, Some(([low, ..], [high, ..]))) = (channel, found.bounds) {
            self.clamp_background(&mut pixels, [low, high]);
        }
        let value = constant_value(channel, found.bounds);
        let udim = self.layout.key.udim;
        let constant = value.map(|value| ConstantRecord::new(channel.clone(), self.name.clone(), udim, value));
        // A set without owned pixels has an empty range.
        let (low, high) = found.bounds.unwrap_or(([0.0; 3], [0.0; 3]));
        let own_peak = high.into_iter().fold(0.0, f32::max);
        let shared_peak = self.bake.peaks.get(&(self.layout.key.material, channel.clone()));
        let peak = shared_peak.copied().unwrap_or(own_peak);
        let facts = ChannelFacts {
            constant: value,
            range: [low[0], high[0]],
        };
        self.facts().add(channel, facts);
        let held = HeldChannel {
            pixels,
            constant: value,
            low,
            high,
            peak,
            is_connected,
        };
        let mut written = self.output(channel, &held)?;
        let is_collected = self.bake.map_collector.is_some();
        // The copy of the model needs the pixels after the files have been written.
        let pixels = is_collected.then(|| held.pixels.clone());
        let presets = self.options.presets();
        let complete = self.held().add(channel, Some(held), &presets);
        written.extend(self.packed(&complete)?);
        if let Some(pixels) = pixels {
            self.collect(channel, &pixels, value, high, peak, &written)?;
        }
        Ok(WrittenChannel {
            outputs: written.into_iter().map(|written| written.record).collect(),
            constant,
            not_finite: found.not_finite,
        })
    }

    /// Leaves out a channel that the material does not have; its files of an earlier bake are left over. Returns the files
    /// that were complete without it.
    pub fn leave_out(&mut self, channel: &Channel) -> Result<Vec<OutputRecord>, ExportError> {
        let presets = self.options.presets();
        let complete = self.held().add(channel, None, &presets);
        let written = self.packed(&complete)?;
        Ok(written.into_iter().map(|written| written.record).collect())
    }

    /// Writes the files that wait for channels which never came, with neutral values for these, and ends the set.
    pub fn finish(&mut self) -> Result<Vec<OutputRecord>, ExportError> {
        let presets = self.options.presets();
        let waiting = self.held().waiting(&presets);
        let written = self.packed(&waiting)?;
        self.bake.held.remove(&self.layout.key);
        Ok(written.into_iter().map(|written| written.record).collect())
    }

    /// Clamps heights outside of all charts: programs take the range of a file from all of its pixels.
    fn clamp_background(&self, pixels: &mut ChannelPixels, [low, high]: [f32; 2]) {
        for (height, cover) in pixels.data.iter_mut().zip(&self.layout.cover) {
            if *cover == Cover::Empty {
                *height = height.clamp(low, high);
            }
        }
    }

    fn facts(&mut self) -> &mut SetFacts {
        let fresh = || SetFacts {
            name: self.name.clone(),
            size: self.layout.size,
            ..SetFacts::default()
        };
        self.bake.facts.entry(self.layout.key).or_insert_with(fresh)
    }

    fn held(&mut self) -> &mut HeldSet {
        self.bake.held.entry(self.layout.key).or_default()
    }

    /// Writes the files of an output of the graph.
    fn output(&mut self, channel: &Channel, held: &HeldChannel) -> Result<Vec<StagedMap>, ExportError> {
        let Some(kind) = channel.output_kind() else {
            return Ok(Vec::new());
        };
        let options = self.options;
        let is_varied = held.constant.is_none() || options.all_maps;
        let mut files = Vec::new();
        for NamedPreset { preset, names } in &options.presets {
            for map in preset.maps.iter().filter(|map| map.content == MapContent::Every(kind)) {
                let name = self.file_name(map, names, &channel.name());
                let is_wanted = is_varied && (map.when != When::ItselfAboveOne || held.is_above_one());
                if !is_wanted {
                    self.bake.skipped.insert(name);
                    continue;
                }
                let components = components_of(channel).into_iter();
                files.push(WantedFile {
                    map,
                    preset,
                    name,
                    sources: components
                        .map(|component| (component, ComponentValues::Pixels(held)))
                        .collect(),
                    scale: 1.0,
                });
            }
        }
        self.write(&files)
    }

    /// Writes packed maps, or skips those that are not wanted.
    fn packed(&mut self, maps: &[MapIndex]) -> Result<Vec<StagedMap>, ExportError> {
        let options = self.options;
        // Put back below.
        let mut held = std::mem::take(self.held());
        let mut files = Vec::new();
        for index in maps {
            let NamedPreset { preset, names } = &options.presets[index[0]];
            let map = &preset.maps[index[1]];
            let name = self.file_name(map, names, &map.name);
            match &map.content {
                MapContent::Packed(components) if held.is_wanted(map, options.all_maps) => {
                    let sources = sources(components, |channel| held_values(&held, channel));
                    let components = sources.iter().map(|(component, _)| component.clone()).collect();
                    let scale = held.scale(map);
                    let file = FileFacts {
                        name: name.clone(),
                        components,
                        scale,
                    };
                    self.facts().files.insert(*index, file);
                    files.push(WantedFile {
                        map,
                        preset,
                        name,
                        sources,
                        scale,
                    });
                }
                _ => {
                    self.bake.skipped.insert(name);
                }
            }
        }
        let written = self.write(&files)?;
        drop(files);
        for index in maps {
            held.finish(*index, &options.presets());
        }
        *self.held() = held;
        Ok(written)
    }

    fn file_name(&self, map: &Map, names: &NamePattern, word: &str) -> String {
        let parts = NameParts {
            material: &self.name,
            map: word,
            udim: self.layout.key.udim,
            size: map.pixels(self.layout.size),
        };
        map.file_name(names, &parts)
    }

    /// Encodes files at once, which keeps all cores busy, and stages them in their order.
    fn write(&mut self, files: &[WantedFile<'_>]) -> Result<Vec<StagedMap>, ExportError> {
        let set = FileSet {
            name: &self.name,
            udim: self.layout.key.udim,
            size: self.layout.size,
        };
        let dither_seed = self.options.dither_seed;
        let keeps_bytes = self.bake.map_collector.is_some();
        let kept = self.bake.encoded_files.as_deref();
        let encoded: Vec<Result<EncodedFile, ExportError>> = files
            .par_iter()
            .map(|file| file.encode(set, dither_seed, keeps_bytes, kept))
            .collect();
        self.bake
            .cut
            .extend(files.iter().filter_map(|file| file.cut(&self.name)));
        let mut written = Vec::new();
        for encoded in encoded {
            let (file, bytes) = encoded?;
            self.bake.staged.stage(&file.record.path, &bytes)?;
            if file.was_kept {
                self.bake.kept.push(file.record.path.clone());
            }
            written.push(file);
        }
        Ok(written)
    }

    /// Collects what a copy of the model needs of a channel.
    fn collect(
        &mut self,
        channel: &Channel,
        pixels: &ChannelPixels,
        constant: Option<crate::ConstantValue>,
        high: [f32; 3],
        peak: f32,
        written: &[StagedMap],
    ) -> Result<(), ExportError> {
        let Some(collector) = &mut self.bake.map_collector else {
            return Ok(());
        };
        let written: Vec<&WrittenMap> = written.iter().filter_map(|written| written.file.as_ref()).collect();
        let input = ChannelInput {
            layout: self.layout,
            name: &self.name,
            channel,
            pixels,
            constant,
            high,
            peak,
            dither_seed: self.options.dither_seed,
            written: &written,
        };
        collector.take(&input).map_err(|source| ExportError::Encode {
            file_name: format!("{} for the copy of the model", channel.name()),
            source,
        })
    }
}
