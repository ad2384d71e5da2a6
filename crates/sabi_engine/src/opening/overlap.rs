//! Overlaps of charts on the maps: counts by sort and material, and remedies.

use std::collections::BTreeMap;

use sabi_export::{set_keys, set_names};
use sabi_surface::atlas::{PAIRS_LIMIT, UvChart};
use serde::Serialize;

use crate::opening::linked_model::{LinkedModel, Overlap};
use crate::remedy::Remedy;
use crate::warning::Warning;

/// Most materials that a report names.
const MATERIALS: usize = 10;

/// Charts that share places on the maps, in a report.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct OverlapReport {
    /// Pairs of charts that share places.
    #[serde(flatten)]
    pub pairs: SharedPairs,
    /// Texels whose place another chart claims as well.
    pub texels: u64,
    /// True if there are more pairs than the atlas lists.
    pub more_than_counted: bool,
    /// Share of the owned texels whose place another chart claims as well.
    pub share: f64,
    /// Materials with the most shared texels, at most 10.
    pub materials: Vec<MaterialOverlap>,
}

/// Charts that share places in one material, in a report.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MaterialOverlap {
    /// Pairs of charts that share places.
    #[serde(flatten)]
    pub pairs: SharedPairs,
    /// Name of the material, as files are named after it.
    pub material: Option<String>,
    /// Texels that pairs of charts share, added up.
    pub texels: u64,
}

/// Pairs of charts that share places on the maps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SharedPairs {
    /// Pairs that lie on each other exactly and wind the same way.
    pub stacked: u32,
    /// Pairs that lie on each other exactly, one of them mirrored.
    pub mirrored: u32,
    /// Pairs in different UV tiles, and charts larger than one: a texture repeats there.
    pub tiling: u32,
    /// Pairs that share a part only.
    pub partial: u32,
}

/// Totals of the overlaps between charts of one material.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct MaterialTotals {
    /// Texels that pairs of charts share, added up.
    texels: u64,
    pairs: SharedPairs,
}

/// Totals of the overlaps between charts of a model.
pub(crate) struct OverlapTotals {
    by_material: BTreeMap<u32, MaterialTotals>,
    /// Share of the owned texels whose place another chart claims as well.
    share: f64,
    /// True if there are more pairs than the atlas lists, so that their counts are lower bounds.
    is_cut: bool,
}

impl OverlapTotals {
    /// Sums up all pairs that the atlas lists. In UDIM layouts charts of different tiles share nothing.
    pub(crate) fn of(linked: &LinkedModel) -> OverlapTotals {
        let atlas = &linked.atlas;
        let udims: Vec<u32> = set_keys(atlas)
            .iter()
            .filter(|key| key.udim.is_some())
            .map(|key| key.material)
            .collect();
        let mut by_material: BTreeMap<u32, MaterialTotals> = BTreeMap::new();
        let charts = atlas.uv_charts();
        for &(a, b, texels) in &atlas.report.overlapping_charts {
            let pair = [a, b].map(|chart| &charts[chart as usize]);
            let [first, second] = pair.map(|chart| chart.parts[0]);
            let apart = first.uv_tile != second.uv_tile;
            if apart && udims.contains(&first.sheet) {
                continue;
            }
            let shared = by_material.entry(first.material).or_default();
            shared.texels += texels;
            let are_whole = pair.iter().all(|chart| chart.texels() == texels);
            let kind = match () {
                () if apart => &mut shared.pairs.tiling,
                () if !are_whole => &mut shared.pairs.partial,
                () if first.mirrored == second.mirrored => &mut shared.pairs.stacked,
                () => &mut shared.pairs.mirrored,
            };
            *kind += 1;
        }
        let repeats = |chart: &&UvChart| chart.extent().iter().any(|side| *side > atlas.size);
        for chart in charts.iter().filter(repeats) {
            let shared = by_material.entry(chart.parts[0].material).or_default();
            shared.pairs.tiling += 1;
            shared.texels += chart.texels();
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
            share,
            is_cut: atlas.report.overlapping_charts.len() >= PAIRS_LIMIT,
        }
    }

    /// Lists the materials by shared texels, most first.
    fn worst(&self) -> Vec<(u32, MaterialTotals)> {
        let mut sorted: Vec<(u32, MaterialTotals)> = self
            .by_material
            .iter()
            .map(|(&material, &shared)| (material, shared))
            .collect();
        sorted.sort_by_key(|&(material, shared)| (std::cmp::Reverse(shared.texels), material));
        sorted
    }

    fn total(&self) -> MaterialTotals {
        self.by_material
            .values()
            .fold(MaterialTotals::default(), |sum, shared| MaterialTotals {
                texels: sum.texels + shared.texels,
                pairs: SharedPairs {
                    stacked: sum.pairs.stacked + shared.pairs.stacked,
                    mirrored: sum.pairs.mirrored + shared.pairs.mirrored,
                    tiling: sum.pairs.tiling + shared.pairs.tiling,
                    partial: sum.pairs.partial + shared.pairs.partial,
                },
            })
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

/// Returns other treatments of overlaps, best first. The mean suits exact copies only.
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
