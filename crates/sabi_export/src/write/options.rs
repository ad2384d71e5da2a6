//! Options of writing texture sets.

use std::borrow::Cow;
use std::collections::BTreeMap;

use crate::name_pattern::{NameParts, NamePattern};
use crate::preset::{DocumentFormat, MapContent, Preset, PresetError, raw};
use crate::{Channel, ExportError};

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
    /// Name of documents without their ending; none to write no documents.
    pub document_stem: Option<String>,
    /// Seed of the noise of dithered maps: the same one gives the same bytes.
    pub dither_seed: u32,
}

impl SetOptions {
    /// Options of the default preset, under its own names.
    pub fn raw() -> Result<SetOptions, PresetError> {
        let named = NamedPreset {
            preset: raw()?,
            names: NamePattern::default(),
        };
        Ok(SetOptions {
            presets: vec![named],
            all_maps: false,
            document_stem: None,
            dither_seed: 0,
        })
    }

    /// Names of the documents of all presets.
    pub fn document_names(&self) -> Vec<String> {
        let documents = self.presets.iter().flat_map(|named| &named.preset.documents);
        documents.filter_map(|document| self.document_name(*document)).collect()
    }

    /// Name of a document of the bake; none if it writes no documents.
    pub(super) fn document_name(&self, document: DocumentFormat) -> Option<String> {
        let stem = self.document_stem.as_ref()?;
        Some(format!("{stem}.{}", document.ending()))
    }

    /// Gives all presets the outputs of a graph, as [`Preset::for_outputs`].
    pub fn set_outputs(&mut self, outputs: &[Channel]) -> Result<(), PresetError> {
        for named in &mut self.presets {
            named.preset = named.preset.clone().for_outputs(outputs)?;
        }
        Ok(())
    }

    /// Refuses options under which two files of these sets (stem and UDIM number) would have one name, on a file system that
    /// ignores case. `outputs` are those of the graph beside its materials.
    pub fn refuse_same_names(
        &self,
        sets: &[(&str, Option<u32>)],
        outputs: &[Channel],
        size: u32,
    ) -> Result<(), ExportError> {
        // Names by their small letters.
        let mut taken: BTreeMap<String, String> = BTreeMap::new();
        for file_name in self.document_names() {
            if taken.insert(file_name.to_lowercase(), file_name.clone()).is_some() {
                return Err(ExportError::SameDocument { file_name });
            }
        }
        for (material, udim) in sets {
            for NamedPreset { preset, names } in &self.presets {
                for map in &preset.maps {
                    let words: Vec<Cow<'_, str>> = match map.content {
                        MapContent::Every(kind) => {
                            let its = outputs.iter().filter(|output| output.output_kind() == Some(kind));
                            its.map(Channel::name).collect()
                        }
                        MapContent::Packed(_) => vec![map.name.as_str().into()],
                    };
                    for word in words {
                        let parts = NameParts {
                            material,
                            map: &word,
                            udim: *udim,
                            size: map.pixels(size),
                        };
                        let file_name = map.file_name(names, &parts);
                        match taken.insert(file_name.to_lowercase(), file_name.clone()) {
                            None => {}
                            Some(first) if first == file_name => return Err(ExportError::SameName { file_name }),
                            Some(first) => {
                                let second = file_name;
                                return Err(ExportError::SameLetters { first, second });
                            }
                        }
                    }
                }
            }
        }
        Ok(())
    }

    pub(super) fn presets(&self) -> Vec<&Preset> {
        self.presets.iter().map(|named| &named.preset).collect()
    }
}
