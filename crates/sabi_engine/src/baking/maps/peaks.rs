//! Highest emission of materials with several UDIM tiles. An engine uses one strength for all tiles.

use std::collections::BTreeMap;

use sabi_export::{Channel, Cover, NONE, SetLayout};
use sabi_gpu::{PlaneData, Run};
use sabi_nodes::kind::Channel as Stored;
use sabi_nodes::link::Plane;

use super::{MapWriter, SetWork};
use crate::baking::sheet_results::SheetResults;
use crate::error::EngineError;
use crate::evaluating::looks::slot_of;

impl MapWriter<'_> {
    /// Returns the highest emission of each material with several tiles, if a normalized map needs it.
    pub(super) fn emission_peaks(&self, run: &Run, sets: &[SetWork<'_>]) -> Result<BTreeMap<u32, f32>, EngineError> {
        let mut presets = self.options.presets.iter();
        let is_needed = presets.any(|named| {
            let mut maps = named.preset.maps_of(&Channel::Emission);
            maps.any(|map| map.is_normalized)
        });
        let mut peaks = BTreeMap::new();
        for set in sets.iter().filter(|set| is_needed && set.key.udim.is_some()) {
            if let Some(peak) = self.emission_peak(run, set)? {
                let highest = peaks.entry(set.key.material).or_insert(peak);
                *highest = peak.max(*highest);
            }
        }
        Ok(peaks)
    }

    /// Returns the highest emission that a set shows; `None` if no result has emission.
    fn emission_peak(&self, run: &Run, set: &SetWork<'_>) -> Result<Option<f32>, EngineError> {
        let atlas = &self.evaluator.linked().atlas;
        let results = SheetResults::new(atlas, &set.materials);
        let mut planes: Vec<Option<PlaneData>> = Vec::new();
        for result in &results.distinct {
            let slot = slot_of(result, Plane::Material(Stored::Emission));
            planes.push(slot.map(|slot| self.read(run, slot)).transpose()?);
        }
        if planes.iter().all(Option::is_none) {
            return Ok(None);
        }
        let layout = SetLayout::new(atlas, set.key);
        let shown = layout.source.iter().zip(&layout.cover);
        let shown = shown.filter(|(texel, cover)| **cover == Cover::Owned && **texel != NONE);
        let values = shown.filter_map(|(texel, _)| results.texel(&planes, *texel as usize));
        let highest = values
            .flat_map(|[r, g, b, _]| [r, g, b])
            .filter(|value| value.is_finite());
        Ok(Some(highest.fold(0.0, f32::max)))
    }
}
