//! Maps of UDIM tiles that other tiles of the material have: a document has one name for those of all tiles, so that a tile
//! where the channels are constant needs the map, too.

use std::collections::BTreeMap;

use super::BakeWriter;
use super::file::{ComponentValues, FileSet, WantedFile, sources};
use super::options::{NamedPreset, SetOptions};
use crate::document::{FileFacts, SetFacts};
use crate::layout::SetKey;
use crate::name_pattern::NameParts;
use crate::preset::{Map, MapContent, When};
use crate::{Channel, ConstantValue, ExportError, OutputRecord};

impl BakeWriter {
    /// Writes the maps that documents need and that some tiles lack.
    pub(super) fn fill_tiles(&mut self, options: &SetOptions) -> Result<Vec<OutputRecord>, ExportError> {
        let mut tiles: BTreeMap<u32, Vec<SetKey>> = BTreeMap::new();
        for key in self.facts.keys().filter(|key| key.udim.is_some()) {
            tiles.entry(key.material).or_default().push(*key);
        }
        let mut written = Vec::new();
        for (preset, named) in options.presets.iter().enumerate() {
            if named.preset.documents.is_empty() {
                continue;
            }
            for (map, of) in named.preset.maps.iter().enumerate() {
                for keys in tiles.values() {
                    for key in self.lacking(keys, [preset, map], of) {
                        written.extend(self.fill(key, [preset, map], named)?);
                    }
                }
            }
        }
        Ok(written)
    }

    /// Tiles that are to get a map with one value everywhere in each component.
    fn lacking(&self, keys: &[SetKey], index: [usize; 2], map: &Map) -> Vec<SetKey> {
        let sets: Vec<(&SetKey, &SetFacts)> = keys
            .iter()
            .filter_map(|key| Some((key, self.facts.get(key)?)))
            .collect();
        let (with, without): (Vec<_>, Vec<_>) = sets.iter().partition(|(_, set)| set.files.contains_key(&index));
        let is_constant = |channel: &&Channel| without.iter().all(|(_, set)| set.constant(channel).is_some());
        // Each tile has a value of its own.
        let differs = |channel: &Channel| {
            let mut values = sets.iter().map(|(_, set)| set.constant(channel));
            let first = values.next().flatten();
            values.any(|value| value != first)
        };
        let varies = matches!(map.when, When::Varies | When::Connected(_));
        let is_wanted = !with.is_empty() || (varies && map.channels().into_iter().any(differs));
        match is_wanted && map.channels().iter().all(is_constant) {
            true => without.into_iter().map(|(key, _)| *key).collect(),
            false => Vec::new(),
        }
    }

    /// Writes a map of constant channels for a tile.
    fn fill(
        &mut self,
        key: SetKey,
        index: [usize; 2],
        NamedPreset { preset, names }: &NamedPreset,
    ) -> Result<Option<OutputRecord>, ExportError> {
        let map = &preset.maps[index[1]];
        let (MapContent::Packed(components), Some(set)) = (&map.content, self.facts.get_mut(&key)) else {
            return Ok(None);
        };
        let material = set.name.clone();
        let values = |channel: &Channel| {
            let constant = set.constant(channel);
            constant.unwrap_or_else(|| ConstantValue::neutral(channel))
        };
        let sources = sources(components, |channel| ComponentValues::Same(values(channel)));
        let file_set = FileSet {
            name: &material,
            udim: key.udim,
            size: set.size,
        };
        let parts = NameParts {
            material: &material,
            map: &map.name,
            udim: key.udim,
            size: map.pixels(set.size),
        };
        let name = map.file_name(names, &parts);
        // Of a tile without a shared peak, the value is all that it has.
        let peak = match self.peaks.get(&(key.material, Channel::Emission)) {
            Some(peak) => *peak,
            None => (0..3)
                .map(|at| values(&Channel::Emission).component(at))
                .fold(1.0, f32::max),
        };
        let is_emission = map.is_normalized && map.has(&Channel::Emission);
        let scale = if is_emission { peak.max(1.0) } else { 1.0 };
        let file = FileFacts {
            name: name.clone(),
            components: sources.iter().map(|(component, _)| component.clone()).collect(),
            scale,
        };
        let wanted = WantedFile {
            map,
            preset,
            name,
            sources,
            scale,
        };
        // One value everywhere, and no copy of the model reads it.
        let (encoded, bytes) = wanted.encode(file_set, 0, false, self.encoded_files.as_deref())?;
        set.files.insert(index, file);
        self.skipped.remove(&encoded.record.path);
        self.staged.stage(&encoded.record.path, &bytes)?;
        Ok(Some(encoded.record))
    }
}
