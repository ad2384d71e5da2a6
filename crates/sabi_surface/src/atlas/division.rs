//! Division of charts at narrow gaps and where they overlap themselves. The resulting charts are placed separately.

use sabi_cancel::Cancel;
use std::collections::HashMap;

use rayon::prelude::*;

use super::build_inputs::{BuildInputs, ChartSet};
use super::chart_split::Splitter;
use super::charts::Partition;
use super::gaps::Gaps;
use super::mask::{Mask, texel_box};
use super::{AtlasError, RINGS};

/// Division of charts at narrow gaps.
pub(super) enum Division {
    /// No chart has narrow gaps.
    NotNeeded,
    /// Charts without narrow gaps; some of them are parts of charts in UV.
    Divided(ChartSet),
    /// The parts would need too many texels.
    TooLarge,
}

/// Maximum number of rounds of dividing charts at narrow gaps. Gaps that remain after that are left.
const DIVISIONS: usize = 4;
/// Maximum number of texels of the parts, as a multiple of the texels of the charts in UV; some more texels are allowed on top.
const GROWTH_LIMIT: u64 = 2;
const LEAST_ROOM: u64 = 1 << 14;
/// Maximum number of texels of all charts' rectangles together. Each texel takes a bit during the build.
const RECTANGLES_LIMIT: u64 = 1 << 33;

/// Number of masks of a chart that exist at the same time: the mask of the chart, and the mask grown by its ring, before
/// and after its place is known.
const MASKS: u64 = 3;
/// Memory of a chart in addition to its texels, in bytes.
const CHART_BYTES: u64 = 256;

impl BuildInputs<'_> {
    /// Returns the mask of each chart, and whether the chart covers a texel twice. Charts that would not fit are an error
    /// before anything is allocated.
    pub(super) fn masks(&self, partition: &Partition) -> Result<Vec<(Mask, bool)>, AtlasError> {
        self.masks_of(partition, &(0..partition.len()).collect::<Vec<_>>())
    }

    /// Returns the masks of some charts, like [`Self::masks`].
    fn masks_of(&self, partition: &Partition, charts: &[usize]) -> Result<Vec<(Mask, bool)>, AtlasError> {
        let boxes: Vec<Option<[i64; 4]>> = charts
            .par_iter()
            .map(|&chart| texel_box(&self.uvs, partition.triangles(chart)))
            .collect();
        let limit = self.page_limit - 2 * RINGS;
        let (mut texels, mut mask_bytes) = (0u64, 0u64);
        for (&chart, bounds) in charts.iter().zip(&boxes) {
            let Some([x0, y0, x1, y1]) = *bounds else { continue };
            let (width, height) = ((x1 - x0) as u64, (y1 - y0) as u64);
            if width.max(height) > u64::from(limit) {
                let triangle = partition.triangles(chart)[0];
                return Err(AtlasError::ChartTooLarge {
                    triangle,
                    width,
                    height,
                    size: self.size,
                    limit,
                });
            }
            texels += width * height;
            mask_bytes += (width / 64 + 1) * 8 * height;
        }
        if texels > RECTANGLES_LIMIT {
            let (needed, limit) = (format!("{texels} texels"), format!("{RECTANGLES_LIMIT} texels"));
            return Err(AtlasError::TooManyTexels {
                size: self.size,
                charts: charts.len(),
                needed,
                limit,
            });
        }
        self.check_memory(
            charts.len(),
            MASKS * mask_bytes.saturating_add(charts.len() as u64 * CHART_BYTES),
        )?;
        let bounded = charts.par_iter().zip(boxes);
        let cancel = Cancel::current();
        let mask = |chart, bounds| Mask::of_chart(&self.uvs, partition.triangles(chart), bounds);
        Ok(bounded
            .map(|(&chart, bounds)| cancel.during(|| mask(chart, bounds)))
            .collect())
    }

    /// Splits charts that overlap themselves; `None` if there are no such charts.
    pub(super) fn split(&self, partition: &Partition, masks: &[(Mask, bool)]) -> Option<Partition> {
        let cancel = Cancel::current();
        let splitter = Splitter { plan: self, partition };
        let suspects = (0..masks.len()).into_par_iter().filter(|&chart| masks[chart].1);
        let found: Vec<(usize, Vec<u32>)> = suspects
            .map(|chart| (chart, cancel.during(|| splitter.split(chart))))
            .collect();
        let is_whole = |(_, labels): &(usize, Vec<u32>)| labels.iter().all(|&label| label == labels[0]);
        (!found.iter().all(is_whole)).then(|| self.relabeled(partition, &found))
    }

    /// Divides charts at narrow gaps.
    pub(super) fn divide_at_narrow_gaps(&self, whole: &ChartSet) -> Division {
        let Some((partition, masks)) = self.divided(whole) else {
            return Division::TooLarge;
        };
        if partition.len() == whole.partition.len() {
            return Division::NotNeeded;
        }
        if room(&masks) > GROWTH_LIMIT * room(&whole.masks) + LEAST_ROOM {
            return Division::TooLarge;
        }
        let origin = |chart: usize| {
            let triangle = partition.triangles(chart)[0];
            whole.origins[whole.partition.triangle_chart[triangle as usize] as usize]
        };
        Division::Divided(ChartSet {
            origins: (0..partition.len()).map(origin).collect(),
            masks,
            partition,
        })
    }

    /// Divides charts at narrow gaps and returns the parts with their masks; `None` if these would be too large.
    fn divided(&self, whole: &ChartSet) -> Option<(Partition, Vec<Mask>)> {
        let mut partition = whole.partition.clone();
        // Masks by the first triangle of the chart: of charts that are finished, and of charts that may need more division.
        let mut done: HashMap<u32, Mask> = HashMap::new();
        let first = |partition: &Partition, chart: usize| partition.triangles(chart)[0];
        let mut open: Vec<(usize, Mask)> = whole.masks.iter().cloned().enumerate().collect();
        // A cut may create another narrow gap.
        for _ in 0..DIVISIONS {
            let gaps = Gaps {
                plan: self,
                partition: &partition,
            };
            let cancel = Cancel::current();
            let divide = |(chart, mask): &(usize, Mask)| cancel.during(|| gaps.divide(*chart, mask));
            let found: Vec<Option<Vec<u32>>> = open.par_iter().map(divide).collect();
            let mut divided = Vec::new();
            for ((chart, mask), labels) in open.into_iter().zip(found) {
                match labels {
                    Some(labels) => divided.push((chart, labels)),
                    None => {
                        done.insert(first(&partition, chart), mask);
                    }
                }
            }
            if divided.is_empty() {
                open = Vec::new();
                break;
            }
            partition = self.relabeled(&partition, &divided);
            let is_new = |&chart: &usize| !done.contains_key(&first(&partition, chart));
            let new: Vec<usize> = (0..partition.len()).filter(is_new).collect();
            // The rectangles of parts can be too large even if those of the whole charts are not, for example in spirals.
            let masks = self.masks_of(&partition, &new).ok()?.into_iter().map(|(mask, _)| mask);
            open = new.into_iter().zip(masks).collect();
        }
        done.extend(open.into_iter().map(|(chart, mask)| (first(&partition, chart), mask)));
        let mask = |chart: usize| done.remove(&first(&partition, chart));
        let masks: Option<Vec<Mask>> = (0..partition.len()).map(mask).collect();
        Some((partition, masks?))
    }

    /// Returns the charts after some of them got new labels for their triangles. A label is the first triangle of the new chart.
    fn relabeled(&self, partition: &Partition, found: &[(usize, Vec<u32>)]) -> Partition {
        // The label of a chart is its first triangle, in the given partition and in the result.
        let mut labels: Vec<u32> = partition
            .triangle_chart
            .iter()
            .map(|&chart| partition.triangles(chart as usize)[0])
            .collect();
        for (chart, found) in found {
            for (&triangle, &label) in partition.triangles(*chart).iter().zip(found) {
                labels[triangle as usize] = label;
            }
        }
        Partition::from_labels(self.mesh, &labels)
    }
}

/// Returns the number of texels in the rectangles of charts, including their rings.
fn room(masks: &[Mask]) -> u64 {
    let around = |side: u32| u64::from(side + 2 * RINGS);
    let masks = masks.iter().filter(|mask| !mask.is_empty());
    masks.map(|mask| around(mask.width) * around(mask.height)).sum()
}
