//! Writing of the files of a bake, one channel at a time.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use rayon::prelude::*;
use sabi_files::StagedSet;

use crate::constant::{constant_value, survey};
use crate::encode::{Codes, Encoding, Plane, encode};
use crate::held::{HeldChannel, HeldSet, MapIndex, is_whole_size};
use crate::layout::{Cover, SetKey, SetLayout};
use crate::model_copy::{ChannelInput, MapCollector, MapFile, MaterialMaps, WrittenMap};
use crate::name_pattern::{NameParts, NamePattern};
use crate::preset::{Component, ComponentSource, Content, Map, NormalY, Preset, raw};
use crate::resize::resized;
use crate::{Channel, ChannelPixels, ConstantRecord, ExportError, OutputRecord};

/// A preset with the names that its files get.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedPreset {
    /// Files to write.
    pub preset: Preset,
    /// Names of the files.
    pub names: NamePattern,
}

/// Options of writing a texture set.
#[derive(Clone, Debug, PartialEq)]
pub struct SetOptions {
    /// Files to write.
    pub presets: Vec<NamedPreset>,
    /// True to write maps of constant channels, too.
    pub all_maps: bool,
}

impl Default for SetOptions {
    fn default() -> Self {
        SetOptions {
            presets: vec![NamedPreset {
                preset: raw(),
                names: NamePattern::default(),
            }],
            all_maps: false,
        }
    }
}

impl SetOptions {
    /// Refuses options under which two files of these sets (stem and UDIM number) would have one name, on a file system that
    /// ignores case. `masks` are the mask outputs of the graph.
    pub fn refuse_same_names(
        &self,
        sets: &[(&str, Option<u32>)],
        masks: &[Channel],
        size: u32,
    ) -> Result<(), ExportError> {
        let mut taken = BTreeSet::new();
        for (material, udim) in sets {
            for NamedPreset { preset, names } in &self.presets {
                for map in &preset.maps {
                    let words: Vec<Cow<'_, str>> = match map.content {
                        Content::EveryMask => masks.iter().map(Channel::name).collect(),
                        Content::Packed(_) => vec![map.name.as_str().into()],
                    };
                    for word in words {
                        let parts = NameParts {
                            material,
                            map: &word,
                            udim: *udim,
                            size: map.pixels(size),
                        };
                        let file_name = map.file_name(names, &parts);
                        if !taken.insert(file_name.to_lowercase()) {
                            return Err(ExportError::SameName { file_name });
                        }
                    }
                }
            }
        }
        Ok(())
    }

    fn presets(&self) -> Vec<&Preset> {
        self.presets.iter().map(|named| &named.preset).collect()
    }
}

/// Writes the texture sets of one bake into a folder; all files are put in place together by [`BakeWriter::commit`].
#[derive(Debug)]
pub struct BakeWriter {
    staged: StagedSet,
    /// Names of files that presets name and that this bake did not write: maps of constant channels, of channels that the
    /// material does not have, and of values above 1 where there are none.
    skipped: BTreeSet<String>,
    /// Channels of each set that wait for others.
    held: BTreeMap<SetKey, HeldSet>,
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
            held: BTreeMap::new(),
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
    ) -> Result<Written, ExportError> {
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
            let background = self.layout.cover.iter().map(|cover| *cover == Cover::Empty);
            for (height, is_background) in pixels.data.iter_mut().zip(background) {
                // Programs take the range of a file from all of its pixels.
                *height = if is_background {
                    height.clamp(low, high)
                } else {
                    *height
                };
            }
        }
        let value = constant_value(channel, found.bounds);
        let udim = self.layout.key.udim;
        let constant = value.map(|value| ConstantRecord::new(channel.clone(), self.name.clone(), udim, value));
        // A set without owned pixels has an empty range.
        let (low, high) = found.bounds.unwrap_or(([0.0; 3], [0.0; 3]));
        let held = HeldChannel {
            pixels,
            constant: value,
            low,
            high,
            is_connected,
        };
        let mut written = self.masks(channel, &held)?;
        let is_collected = self.bake.map_collector.is_some();
        // The copy of the model needs the pixels after the files have been written.
        let pixels = is_collected.then(|| held.pixels.clone());
        let presets = self.options.presets();
        let complete = self.held().add(channel, Some(held), &presets);
        written.extend(self.packed(&complete)?);
        if let Some(pixels) = pixels {
            self.collect(channel, &pixels, value, high, &written)?;
        }
        Ok(Written {
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

    fn held(&mut self) -> &mut HeldSet {
        self.bake.held.entry(self.layout.key).or_default()
    }

    /// Writes the files of a mask output.
    fn masks(&mut self, channel: &Channel, held: &HeldChannel) -> Result<Vec<WrittenFile>, ExportError> {
        if !matches!(channel, Channel::Mask(_)) {
            return Ok(Vec::new());
        }
        let options = self.options;
        let is_wanted = held.constant.is_none() || options.all_maps;
        let mut files = Vec::new();
        for NamedPreset { preset, names } in &options.presets {
            for map in preset.maps.iter().filter(|map| map.content == Content::EveryMask) {
                let name = self.file_name(map, names, &channel.name());
                if !is_wanted {
                    self.bake.skipped.insert(name);
                    continue;
                }
                let component = Component {
                    source: ComponentSource::Channel(channel.clone(), 0),
                    is_inverted: false,
                };
                files.push(WantedFile {
                    map,
                    preset,
                    name,
                    sources: vec![(component, Some(held))],
                });
            }
        }
        self.write(&files)
    }

    /// Writes packed maps, or skips those that are not wanted.
    fn packed(&mut self, maps: &[MapIndex]) -> Result<Vec<WrittenFile>, ExportError> {
        let options = self.options;
        // Put back below.
        let mut held = std::mem::take(self.held());
        let mut files = Vec::new();
        for [preset, map] in maps {
            let NamedPreset { preset, names } = &options.presets[*preset];
            let map = &preset.maps[*map];
            let name = self.file_name(map, names, &map.name);
            match &map.content {
                Content::Packed(components) if held.is_wanted(map, options.all_maps) => files.push(WantedFile {
                    map,
                    preset,
                    name,
                    sources: sources(components, &held),
                }),
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
    fn write(&mut self, files: &[WantedFile<'_>]) -> Result<Vec<WrittenFile>, ExportError> {
        let (layout, name) = (self.layout, self.name.as_str());
        let keeps_bytes = self.bake.map_collector.is_some();
        let encoded: Vec<Result<(WrittenFile, Arc<Vec<u8>>), ExportError>> = files
            .par_iter()
            .map(|file| file.encode(layout, name, keeps_bytes))
            .collect();
        let mut written = Vec::new();
        for encoded in encoded {
            let (file, bytes) = encoded?;
            self.bake.staged.stage(&file.record.path, &bytes)?;
            written.push(file);
        }
        Ok(written)
    }

    /// Collects what a copy of the model needs of a channel.
    fn collect(
        &mut self,
        channel: &Channel,
        pixels: &ChannelPixels,
        constant: Option<crate::Value>,
        high: [f32; 3],
        written: &[WrittenFile],
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
            written: &written,
        };
        collector.take(&input).map_err(|source| ExportError::Encode {
            file_name: format!("{} for the copy of the model", channel.name()),
            source,
        })
    }
}

/// A file that is to be written.
struct WantedFile<'a> {
    map: &'a Map,
    preset: &'a Preset,
    name: String,
    /// Components with the channels that they are of, where the material has these.
    sources: Vec<(Component, Option<&'a HeldChannel>)>,
}

impl WantedFile<'_> {
    /// Encodes the file for a set; also returns its bytes. `keeps_bytes` is true if the copy of the model may use it.
    fn encode(
        &self,
        layout: &SetLayout,
        material: &str,
        keeps_bytes: bool,
    ) -> Result<(WrittenFile, Arc<Vec<u8>>), ExportError> {
        let WantedFile {
            map, preset, sources, ..
        } = self;
        let size = map.pixels(layout.size);
        let fitted: Vec<Option<ChannelPixels>> = sources
            .iter()
            .map(|(_, held)| {
                let held = held.filter(|_| !is_whole_size(map))?;
                Some(resized(&held.pixels, layout.size, size))
            })
            .collect();
        let planes = sources.iter().zip(&fitted);
        let planes: Vec<Plane<'_>> = planes
            .map(|((component, held), fitted)| {
                let pixels = held.map(|held| fitted.as_ref().unwrap_or(&held.pixels));
                plane(component, *held, pixels, preset.normal_y)
            })
            .collect();
        let encoding = Encoding {
            size,
            format: map.format,
            is_srgb: map.is_srgb,
            is_dithered: map.is_dithered,
        };
        let bytes = encode(&planes, encoding).map_err(|source| ExportError::Encode {
            file_name: self.name.clone(),
            source,
        })?;
        let record = OutputRecord {
            path: self.name.clone(),
            preset: preset.name.clone(),
            channel: single_channel(sources).map_or_else(|| map.name.clone(), |channel| channel.name().into_owned()),
            components: sources.iter().map(|(component, _)| component.to_string()).collect(),
            material: material.to_owned(),
            udim: layout.key.udim,
            width: size[0],
            height: size[1],
            bits: map.format.bits(),
            color_space: if map.is_srgb { "srgb" } else { "linear" },
            range: height_range(map, sources),
            blake3: blake3::hash(&bytes).to_hex().to_string(),
        };
        let bytes = Arc::new(bytes);
        let file = keeps_bytes.then(|| WrittenMap {
            components: sources.iter().map(|(component, _)| component.clone()).collect(),
            is_srgb: map.is_srgb,
            is_dithered: map.is_dithered,
            format: map.format,
            is_whole_size: is_whole_size(map),
            normal_y: preset.normal_y,
            file: MapFile {
                name: record.path.clone(),
                bytes: bytes.clone(),
                is_written: true,
            },
        });
        Ok((WrittenFile { record, file }, bytes))
    }
}

/// The components of a map with their channels, without an alpha that is 1 everywhere.
fn sources<'a>(components: &[Component], held: &'a HeldSet) -> Vec<(Component, Option<&'a HeldChannel>)> {
    let source = |component: &Component| {
        let channel = match &component.source {
            ComponentSource::Channel(channel, _) => held.channel(channel),
            ComponentSource::Constant(_) => None,
        };
        (component.clone(), channel)
    };
    // Programs take a map with an alpha channel for one that is cut out.
    let is_opaque = |component: &Component| is_opaque(component, held);
    let kept = match components {
        [r, g, b, alpha] if is_opaque(alpha) => vec![r, g, b],
        components => components.iter().collect(),
    };
    kept.into_iter().map(source).collect()
}

/// A file that was staged.
struct WrittenFile {
    record: OutputRecord,
    /// For the copy of the model, if one is made.
    file: Option<WrittenMap>,
}

/// A component as the encoder takes it; the neutral value where the material does not have the channel.
fn plane<'a>(
    component: &Component,
    held: Option<&HeldChannel>,
    pixels: Option<&'a ChannelPixels>,
    normal_y: NormalY,
) -> Plane<'a> {
    let (channel, index) = match &component.source {
        ComponentSource::Constant(value) => return Plane::Constant(*value),
        ComponentSource::Channel(channel, index) => (channel, *index),
    };
    match (held, pixels) {
        (Some(held), Some(pixels)) => Plane::Channel {
            pixels,
            index,
            codes: match channel {
                Channel::Normal => Codes::Normal {
                    is_down: normal_y == NormalY::Down,
                },
                Channel::Height => Codes::Range([held.low[0], held.high[0]]),
                _ => Codes::Unit,
            },
            is_inverted: component.is_inverted,
        },
        _ => {
            // A channel has a neutral value for each of its components.
            let neutral = channel.neutral().get(index).copied().unwrap_or(0.0);
            let unit = match channel {
                Channel::Normal => neutral * 0.5 + 0.5,
                _ => neutral,
            };
            Plane::Constant(if component.is_inverted { 1.0 - unit } else { unit })
        }
    }
}

/// Returns true if a component is an opacity of 1 everywhere.
fn is_opaque(component: &Component, held: &HeldSet) -> bool {
    let is_opacity = matches!(component.source, ComponentSource::Channel(Channel::Opacity, _));
    is_opacity && held.constant(component).is_some_and(|value| value >= 1.0)
}

/// The channel of a file that has one alone.
fn single_channel<'s>(sources: &'s [(Component, Option<&HeldChannel>)]) -> Option<&'s Channel> {
    let channel = |source: &'s (Component, _)| match &source.0.source {
        ComponentSource::Channel(channel, _) => Some(channel),
        ComponentSource::Constant(_) => None,
    };
    let first = channel(sources.first()?)?;
    sources
        .iter()
        .all(|source| channel(source) == Some(first))
        .then_some(first)
}

/// Heights of the lowest and highest code, for heights in whole numbers.
fn height_range(map: &Map, sources: &[(Component, Option<&HeldChannel>)]) -> Option<[f32; 2]> {
    let is_height = |component: &Component| matches!(component.source, ComponentSource::Channel(Channel::Height, _));
    let (_, held) = sources.iter().find(|(component, _)| is_height(component))?;
    let held = held.as_ref().filter(|_| map.format.is_whole())?;
    Some([held.low[0], held.high[0]])
}

#[cfg(test)]
mod tests;
