//! Overlaps of charts on the maps: counts by type and material, and remedies.

use std::collections::BTreeMap;

use sabi_export::{SetKey, set_keys, set_names, sheet_names};
use sabi_surface::atlas::{Chart, PAIRS_LIMIT, UvChart};
use schemars::JsonSchema;
use serde::Serialize;

use crate::opening::linked_model::{LinkedModel, Overlap};
use crate::remedy::Remedy;
use crate::warning::Warning;

/// Maximum number of materials that a report names.
const MATERIALS: usize = 10;

/// Charts that share places on the maps, in a report.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct OverlapReport {
    /// Pairs of charts that share places.
    #[serde(flatten)]
    pub pairs: SharedPairs,
    /// Texels whose place is also used by another chart.
    pub texels: u64,
    /// True if there are more pairs than the atlas lists.
    pub more_than_counted: bool,
    /// Share of the owned texels whose place is also used by another chart.
    pub share: f64,
    /// Materials with the most shared texels, at most 10.
    pub materials: Vec<MaterialOverlap>,
}

/// Charts that share places in one material, in a report.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct MaterialOverlap {
    /// Pairs of charts that share places.
    #[serde(flatten)]
    pub pairs: SharedPairs,
    /// Name of the material, as used in file names.
    pub material: Option<String>,
    /// Texels that pairs of charts share, summed over the pairs.
    pub texels: u64,
}

/// Texture set of a model in a report: the maps of a material, or of one of its UDIM tiles.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct SetReport {
    /// Name of the material as used in file names, or of the model if all materials share one sheet.
    pub material: String,
    /// UDIM number if the material uses several tiles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub udim: Option<u32>,
    /// Charts in UV.
    pub charts: usize,
    /// Texels that they own, for each pixel of the maps.
    pub coverage: f32,
    /// Charts that share places.
    pub overlap: SetOverlap,
}

/// Charts of a texture set that share places, in a report.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct SetOverlap {
    /// Pairs of charts that share places.
    #[serde(flatten)]
    pub pairs: SharedPairs,
    /// Texels that pairs of charts share, summed over the pairs.
    pub texels: u64,
}

/// Pairs of charts that share places on the maps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct SharedPairs {
    /// Pairs of charts in exactly the same place with the same orientation.
    pub stacked: u32,
    /// Pairs of charts in exactly the same place, one of them mirrored.
    pub mirrored: u32,
    /// Pairs in different UV tiles, and charts larger than a tile, on which a texture repeats.
    pub tiling: u32,
    /// Pairs that share a part only.
    pub partial: u32,
}

/// Totals of the overlaps between charts of a model.
pub(crate) struct OverlapTotals {
    by_material: BTreeMap<u32, SetOverlap>,
    /// Overlaps by texture set. A pair of charts counts for the tile of the first one.
    by_set: BTreeMap<SetKey, SetOverlap>,
    /// Share of the owned texels whose place is also used by another chart.
    share: f64,
    /// True if there are more pairs than the atlas lists, so that their counts are lower bounds.
    is_cut: bool,
}

impl SetOverlap {
    fn and(self, more: SetOverlap) -> SetOverlap {
        let (sum, pairs) = (self.pairs, more.pairs);
        SetOverlap {
            texels: self.texels + more.texels,
            pairs: SharedPairs {
                stacked: sum.stacked + pairs.stacked,
                mirrored: sum.mirrored + pairs.mirrored,
                tiling: sum.tiling + pairs.tiling,
                partial: sum.partial + pairs.partial,
            },
        }
    }
}

impl OverlapTotals {
    /// Sums up all pairs that the atlas lists.
    pub(crate) fn of(linked: &LinkedModel) -> OverlapTotals {
        let atlas = &linked.atlas;
        let keys = set_keys(atlas);
        let is_udim = |chart: &Chart| keys.iter().any(|key| key.material == chart.sheet && key.udim.is_some());
        let set_of = |chart: &Chart| keys.iter().find(|key| key.is_home_of(chart)).copied();
        let mut by_material: BTreeMap<u32, SetOverlap> = BTreeMap::new();
        let mut by_set: BTreeMap<SetKey, SetOverlap> = BTreeMap::new();
        let mut add = |chart: &Chart, texels: u64, pairs: SharedPairs| {
            let sums = [
                Some(by_material.entry(chart.material).or_default()),
                set_of(chart).map(|set| by_set.entry(set).or_default()),
            ];
            for sum in sums.into_iter().flatten() {
                *sum = sum.and(SetOverlap { pairs, texels });
            }
        };
        let charts = atlas.uv_charts();
        for &(a, b, texels) in &atlas.report.overlapping_charts {
            let pair = [a, b].map(|chart| &charts[chart as usize]);
            let [first, second] = pair.map(|chart| chart.parts[0]);
            // Tiles of UDIM layouts have separate maps. On these, charts of other tiles overlap in the same way as those of one tile.
            let repeats = first.uv_tile != second.uv_tile && !is_udim(first);
            let are_whole = pair.iter().all(|chart| chart.texels() == texels);
            let mut pairs = SharedPairs::default();
            let kind = match () {
                () if repeats => &mut pairs.tiling,
                () if !are_whole => &mut pairs.partial,
                () if first.mirrored == second.mirrored => &mut pairs.stacked,
                () => &mut pairs.mirrored,
            };
            *kind = 1;
            add(first, texels, pairs);
        }
        let repeats =
            |chart: &&UvChart<'_>| !is_udim(chart.parts[0]) && chart.extent().iter().any(|side| *side > atlas.size);
        for chart in charts.iter().filter(repeats) {
            let pairs = SharedPairs {
                tiling: 1,
                ..SharedPairs::default()
            };
            add(chart.parts[0], chart.texels(), pairs);
        }
        let owned: u64 = atlas.charts.iter().map(|chart| u64::from(chart.texels)).sum();
        let texels = if by_material.is_empty() {
            0
        } else {
            atlas.report.overlap_texels
        };
        let share = texels as f64 / owned.max(1) as f64;
        OverlapTotals {
            by_material,
            by_set,
            share,
            is_cut: atlas.report.overlapping_charts.len() >= PAIRS_LIMIT,
        }
    }

    /// Lists the materials by shared texels, most first.
    fn worst(&self) -> Vec<(u32, SetOverlap)> {
        let mut sorted: Vec<(u32, SetOverlap)> = self
            .by_material
            .iter()
            .map(|(&material, &shared)| (material, shared))
            .collect();
        sorted.sort_by_key(|&(material, shared)| (std::cmp::Reverse(shared.texels), material));
        sorted
    }

    fn total(&self) -> SetOverlap {
        self.by_material
            .values()
            .fold(SetOverlap::default(), |sum, shared| sum.and(*shared))
    }

    /// Describes the texture sets of a model for a report.
    pub(crate) fn sets(&self, linked: &LinkedModel) -> Vec<SetReport> {
        let atlas = &linked.atlas;
        let charts = atlas.uv_charts();
        let pixels = f64::from(atlas.size).powi(2);
        let names = sheet_names(&linked.model);
        let described = set_keys(atlas).into_iter().filter_map(|key| {
            let own = charts.iter().filter(|chart| key.is_home_of(chart.parts[0]));
            let texels: Vec<u64> = own.map(UvChart::texels).filter(|texels| *texels > 0).collect();
            // Nothing is written for a material without a surface, so it needs no name.
            let material = names.get(key.material as usize).filter(|_| !texels.is_empty())?;
            Some(SetReport {
                material: material.clone(),
                udim: key.udim,
                charts: texels.len(),
                coverage: (texels.iter().sum::<u64>() as f64 / pixels) as f32,
                overlap: self.by_set.get(&key).copied().unwrap_or_default(), // No pairs, no overlap.
            })
        });
        described.collect()
    }

    /// Describes the totals for a report, with materials by name.
    pub(crate) fn report(&self, linked: &LinkedModel) -> OverlapReport {
        let names = set_names(&linked.model);
        let materials = self.worst().into_iter().take(MATERIALS);
        let total_texels = match self.by_material.is_empty() {
            true => 0,
            false => linked.atlas.report.overlap_texels,
        };
        OverlapReport {
            pairs: self.total().pairs,
            texels: total_texels,
            more_than_counted: self.is_cut,
            share: (self.share * 10_000.0).round() / 10_000.0,
            materials: materials
                .map(|(material, shared)| MaterialOverlap {
                    pairs: shared.pairs,
                    material: names.get(material as usize).cloned(),
                    texels: shared.texels,
                })
                .collect(),
        }
    }

    /// Returns a warning about the values of maps where charts share places, with ways to treat overlaps that suit the
    /// model better as its remedies.
    pub(crate) fn warning(&self, linked: &LinkedModel) -> Option<Warning> {
        let (material, _) = *self.worst().first()?;
        let total = self.total().pairs;
        let kinds = [
            (total.stacked, "stacked"),
            (total.mirrored, "mirrored"),
            (total.tiling, "tiling"),
            (total.partial, "partly shared"),
        ];
        let kinds: Vec<String> = kinds
            .iter()
            .filter(|(count, _)| *count > 0)
            .map(|(count, word)| format!("{count} {word}"))
            .collect();
        let least = if self.is_cut { "at least " } else { "" };
        let names = set_names(&linked.model);
        let name = names.get(material as usize).map_or("", String::as_str);
        let share = match self.share {
            share if share <= 0.0 => "UV charts repeat the unit square".to_owned(),
            share if share < 0.001 => "UV charts overlap on less than 0.1 % of the surface".to_owned(),
            share => format!("UV charts overlap on {:.1} % of the surface", 100.0 * share),
        };
        let copies = total.tiling == 0 && total.partial == 0;
        let hold = match linked.overlap {
            Overlap::Merge => "the mean of all results",
            Overlap::Auto | Overlap::First | Overlap::Unwrap => "the result of the first chart",
        };
        let sentence = format!(
            "{share} ({least}{}), most of them in '{name}': the maps have {hold} there",
            kinds.join(", ")
        );
        let remedies = remedies(linked.overlap, linked.unwrapped.is_some(), copies);
        Some(Warning::new(sentence, remedies.iter().copied()))
    }
}

/// Returns other treatments of overlaps, best first. The mean is suitable only for exact copies.
fn remedies(overlap: Overlap, was_unwrapped: bool, copies: bool) -> &'static [Remedy] {
    match overlap {
        _ if was_unwrapped => &[Remedy::LargerSize, Remedy::EditUvs],
        Overlap::Auto | Overlap::First | Overlap::Unwrap if copies => &[Remedy::MergeOverlaps, Remedy::UnwrapModel],
        Overlap::Auto | Overlap::First | Overlap::Merge | Overlap::Unwrap => &[Remedy::UnwrapModel],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_model_with_uvs_of_its_own_is_advised_to_be_unwrapped() {
        for overlap in [Overlap::Auto, Overlap::First, Overlap::Merge, Overlap::Unwrap] {
            for copies in [false, true] {
                let told = |was_unwrapped| remedies(overlap, was_unwrapped, copies);
                assert!(told(false).contains(&Remedy::UnwrapModel), "{overlap:?}");
                assert_eq!(told(true), [Remedy::LargerSize, Remedy::EditUvs], "{overlap:?}");
            }
        }
    }
}
