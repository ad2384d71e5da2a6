//! Writing of the files of a bake, one channel at a time.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sabi_files::StagedSet;

use crate::constant::{constant_value, survey};
use crate::encode::encode;
use crate::layout::SetLayout;
use crate::model_copy::{ChannelInput, MapCollector, MapFile, MaterialMaps};
use crate::preset::{Codes, Format, Preset, When, raw};
use crate::{Channel, ChannelPixels, ConstantRecord, ExportError, NamePattern, OutputRecord, Value};

/// Options of writing a texture set.
#[derive(Clone, Debug, PartialEq)]
pub struct SetOptions {
    /// Files to write.
    pub preset: Preset,
    /// Names of the files.
    pub names: NamePattern,
    /// True to write maps of constant channels, too.
    pub all_maps: bool,
}

impl Default for SetOptions {
    fn default() -> Self {
        SetOptions {
            preset: raw(),
            names: NamePattern::default(),
            all_maps: false,
        }
    }
}

/// Writes the texture sets of one bake into a folder; all files are put in place together by [`BakeWriter::commit`].
#[derive(Debug)]
pub struct BakeWriter {
    staged: StagedSet,
    /// Names of files that presets name and that this bake did not write: maps of constant channels, of channels that the
    /// material does not have, and of values above 1 where there are none.
    skipped: BTreeSet<String>,
    /// Maps for a copy of the model; `None` when no copy is made.
    map_collector: Option<MapCollector>,
}

/// Result of writing a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// Its files; none when it is constant and maps of constants were not asked for.
    pub outputs: Vec<OutputRecord>,
    /// Its value where it is constant.
    pub constant: Option<ConstantRecord>,
    /// Values that were no numbers or infinite, and were replaced by the channel's neutral value.
    pub not_finite: u64,
}

/// Result of a committed bake.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Committed {
    /// All files now in place.
    pub files: Vec<PathBuf>,
    /// Files in the folder that an earlier bake of these sets may have left and that this one has no map for: the channel
    /// is constant now. They are not touched.
    pub left_over: Vec<PathBuf>,
}

impl BakeWriter {
    /// Creates the folder where it does not exist, and checks that it can be written to.
    pub fn create(folder: &Path) -> Result<BakeWriter, ExportError> {
        Ok(BakeWriter {
            staged: StagedSet::create(folder)?,
            skipped: BTreeSet::new(),
            map_collector: None,
        })
    }

    /// Collects the maps that a copy of the model needs from now on: those of all channels that are no masks.
    pub fn keep_model_maps(&mut self) {
        self.map_collector = Some(MapCollector::default());
    }

    /// Takes the collected maps, by material of the model.
    pub fn take_model_maps(&mut self) -> BTreeMap<u32, MaterialMaps> {
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

    /// Begins a texture set. `name` is the stem of its files, from [`crate::set_names`].
    pub fn set<'a>(&'a mut self, layout: &'a SetLayout, name: &str, options: &SetOptions) -> SetWriter<'a> {
        SetWriter {
            bake: self,
            layout,
            name: name.to_owned(),
            options: options.clone(),
        }
    }

    /// Adds a file of the caller's own, such as the report, that takes its place with the maps.
    pub fn extra_file(&mut self, file_name: &str, bytes: &[u8]) -> Result<(), ExportError> {
        Ok(self.staged.stage(file_name, bytes)?)
    }

    /// Puts all files in place.
    pub fn commit(self) -> Result<Committed, ExportError> {
        let folder = self.staged.folder().to_owned();
        let files = self.staged.commit()?;
        let left_over = self
            .skipped
            .iter()
            .map(|name| folder.join(name))
            .filter(|path| path.is_file())
            .collect();
        Ok(Committed { files, left_over })
    }
}

/// Writes one texture set of a bake.
#[derive(Debug)]
pub struct SetWriter<'a> {
    bake: &'a mut BakeWriter,
    layout: &'a SetLayout,
    name: String,
    options: SetOptions,
}

impl SetWriter<'_> {
    /// Writes a channel under its temporary names, on all cores, or finds that it is a constant. Padded pixels are expected
    /// (see [`crate::PaddingMap::gather`]); only owned ones decide.
    pub fn channel(&mut self, channel: &Channel, mut pixels: ChannelPixels) -> Result<Written, ExportError> {
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
        let udim = self.layout.key.udim;
        let constant = constant_value(channel, found.bounds)
            .map(|value| ConstantRecord::new(channel.clone(), self.name.clone(), udim, value));
        // A set without owned pixels has an empty range.
        let (low, high) = found.bounds.unwrap_or(([0.0; 3], [0.0; 3]));
        let above_one = high[..components].iter().any(|&value| value > 1.0);
        let stem = self.options.names.stem(&self.name, channel);
        let mut outputs = Vec::new();
        let mut written = Vec::new();
        for map in self.options.preset.maps_of(channel).cloned().collect::<Vec<_>>() {
            let file_name = map.file_name(&stem, udim);
            if (constant.is_some() && !self.options.all_maps) || (map.when == When::AboveOne && !above_one) {
                self.bake.skipped.insert(file_name);
                continue;
            }
            let range = [low[0], high[0]];
            let (record, bytes) = self.stage_map(channel, &pixels, map.format, file_name, range)?;
            if self.bake.map_collector.is_some() {
                let file = MapFile {
                    name: record.path.clone(),
                    bytes: Arc::new(bytes),
                    is_written: true,
                };
                written.push((map.format, file));
            }
            outputs.push(record);
        }
        self.keep(
            channel,
            &pixels,
            constant.as_ref().map(|constant| constant.value),
            high,
            &written,
        )?;
        Ok(Written {
            outputs,
            constant,
            not_finite: found.not_finite,
        })
    }

    /// Leaves out a channel that the material does not have; its files of an earlier bake are left over.
    pub fn leave_out(&mut self, channel: &Channel) {
        let stem = self.options.names.stem(&self.name, channel);
        let files = self.options.preset.maps_of(channel);
        let names = files.map(|map| map.file_name(&stem, self.layout.key.udim));
        self.bake.skipped.extend(names);
    }

    /// Collects what a copy of the model needs of a channel.
    fn keep(
        &mut self,
        channel: &Channel,
        pixels: &ChannelPixels,
        constant: Option<Value>,
        high: [f32; 3],
        written: &[(Format, MapFile)],
    ) -> Result<(), ExportError> {
        let Some(collector) = &mut self.bake.map_collector else {
            return Ok(());
        };
        let input = ChannelInput {
            layout: self.layout,
            name: &self.name,
            channel,
            pixels,
            constant,
            high,
            written,
        };
        collector.take(&input).map_err(|source| ExportError::Encode {
            file_name: format!("{} for the copy of the model", channel.name()),
            source,
        })
    }

    fn stage_map(
        &mut self,
        channel: &Channel,
        pixels: &ChannelPixels,
        format: Format,
        file_name: String,
        range: [f32; 2],
    ) -> Result<(OutputRecord, Vec<u8>), ExportError> {
        let encoded = encode(pixels, self.layout.size, format, range).map_err(|source| ExportError::Encode {
            file_name: file_name.clone(),
            source,
        })?;
        self.bake.staged.stage(&file_name, &encoded.bytes)?;
        let spans_range = matches!(
            format,
            Format::Png {
                codes: Codes::Range,
                ..
            }
        );
        let record = OutputRecord {
            path: file_name,
            channel: channel.clone(),
            material: self.name.clone(),
            udim: self.layout.key.udim,
            width: self.layout.size,
            height: self.layout.size,
            bits: encoded.bits,
            color_space: encoded.color_space,
            range: spans_range.then_some(range),
            blake3: blake3::hash(&encoded.bytes).to_hex().to_string(),
        };
        Ok((record, encoded.bytes))
    }
}

#[cfg(test)]
mod tests;
