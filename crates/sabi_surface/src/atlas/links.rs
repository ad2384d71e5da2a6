//! Ghost links: the surface point of each ghost.

use glam::{DMat2, DVec2, UVec2};
use rayon::prelude::*;
use sabi_cancel::Cancel;

use super::chart_placement::ChartPlacement;
use super::charts::Partition;
use super::ring::AnchoredGhost;
use super::walk::{WalkEnd, WalkMesh};
use super::{EMPTY, Ghost};

/// Maximum distance from the end of a link to the owned texel towards which it is moved, in texels.
const PULL_TEXELS: i64 = 4;
/// Distance from a moved end to the center of that texel, along the longer axis, in texels.
const PULLED_DISTANCE: f64 = 0.875;
/// Minimum bilinear weight at which an owned texel counts.
const LEAST_WEIGHT: f64 = 1e-3;

/// Distances, in texels, by which a walk is continued beyond its end until enough texels of its bilinear footprint are owned.
const CONTINUED_TEXELS: [f64; 4] = [0.0, 0.25, 0.5, 1.0];
/// Difference below which two shares of owned texels count as equal.
const EQUAL_SHARE: f64 = 0.25;
/// Share of owned texels above which a walk is not continued.
const SUFFICIENT_SHARE: f64 = 0.75;

/// Owners and placement in which links are looked up.
pub(super) struct PlacedOwners<'a> {
    pub(super) owners: &'a [u32],
    pub(super) partition: &'a Partition,
    pub(super) placement: &'a ChartPlacement,
}

/// The ghosts with their links.
pub(super) struct LinkedGhosts {
    pub(super) ghosts: Vec<Ghost>,
    /// Ghosts without a link.
    pub(super) unlinked: u32,
    /// Number of ghosts whose links were moved toward an owned texel.
    pub(super) pulled: u32,
}

/// Result of linking a ghost.
enum LinkOutcome {
    /// Linked to the end of its walk.
    Linked,
    /// Linked to a point between the end of its walk and the nearest owned texel.
    Pulled,
    /// Linked to its anchor, because the walk did not end near an owned texel.
    Unlinked,
}

/// Links all ghosts, in their order.
pub(super) fn link(walker: &WalkMesh, pages: &PlacedOwners, anchored: &[AnchoredGhost]) -> LinkedGhosts {
    let cancel = Cancel::current();
    let linked: Vec<(Ghost, LinkOutcome)> = anchored
        .par_iter()
        .inspect(|_| cancel.look())
        .map(|anchored| pages.link(walker, anchored))
        .collect();
    let count =
        |is_counted: fn(&LinkOutcome) -> bool| linked.iter().filter(|linked| is_counted(&linked.1)).count() as u32;
    LinkedGhosts {
        unlinked: count(|outcome| matches!(outcome, LinkOutcome::Unlinked)),
        pulled: count(|outcome| matches!(outcome, LinkOutcome::Pulled)),
        ghosts: linked.into_iter().map(|(ghost, _)| ghost).collect(),
    }
}

impl PlacedOwners<'_> {
    fn link(&self, walker: &WalkMesh, anchored: &AnchoredGhost) -> (Ghost, LinkOutcome) {
        let AnchoredGhost {
            texel,
            anchor,
            triangle,
        } = *anchored;
        let chart = self.partition.triangle_chart[triangle as usize];
        let corner = UVec2::from(anchor).as_dvec2();
        let start = corner + 0.5 - self.offset(chart);
        let [x, y, _] = texel.map(f64::from);
        let step = DVec2::new(x, y) - corner;
        let found = walker.walk(triangle, start, step).and_then(|end| self.sampled(end));
        let read = self.read_point(walker, triangle, start, step);
        let ghost = |triangle, texel: DVec2, transport: DMat2| Ghost {
            texel: anchored.texel,
            chart,
            target_triangle: triangle,
            target_texel: texel.as_vec2().to_array(),
            target_from_own: transport.as_mat2().to_cols_array_2d(),
            read_triangle: read.map_or(triangle, |(read, _)| read),
            read_texel: read.map_or(texel, |(_, at)| at).as_vec2().to_array(),
        };
        match found {
            Some((end, texel, false)) => (ghost(end.triangle, texel, end.transport), LinkOutcome::Linked),
            Some((end, texel, true)) => (ghost(end.triangle, texel, end.transport), LinkOutcome::Pulled),
            None => (ghost(triangle, corner + 0.5, DMat2::IDENTITY), LinkOutcome::Unlinked),
        }
    }

    /// Returns the point at which stored values are read for the end of a walk: a triangle of its chart, and texel
    /// coordinates on the chart's page.
    ///
    /// Between the owned texels of two charts there is up to a texel of surface that neither owns. A walk that ends there
    /// is continued over the seam, and its end is given in coordinates of the chart on the other side, since in its own
    /// chart a ghost would read itself. Of all candidates, the one with the largest share of owned texels is used.
    fn read_point(&self, walker: &WalkMesh, triangle: u32, start: DVec2, step: DVec2) -> Option<(u32, DVec2)> {
        let length = step.x.hypot(step.y).max(1.0);
        let ends = CONTINUED_TEXELS.into_iter().filter_map(|texels| {
            let more = step * texels / length;
            let mut end = walker.walk(triangle, start, step + more)?;
            end.texel -= end.transport * more;
            let share = self.owned_share(&end);
            Some((end, share))
        });
        let chart = |end: &WalkEnd| self.partition.triangle_chart[end.triangle as usize];
        let own = self.partition.triangle_chart[triangle as usize];
        let mut best: Option<(WalkEnd, f64)> = None;
        for (end, share) in ends {
            let is_better = best.as_ref().is_none_or(|(known, most)| {
                // Both charts may end one texel before the seam. In that case the other chart is preferred.
                let changes = chart(known) == own && chart(&end) != own;
                share > most + LEAST_WEIGHT || (changes && share > most - EQUAL_SHARE)
            });
            if is_better {
                best = Some((end, share));
            }
            if share > SUFFICIENT_SHARE {
                break;
            }
        }
        let (end, texel, _) = best.and_then(|(end, _)| self.sampled(end))?;
        Some((end.triangle, texel))
    }

    /// Returns the offset, in texels, from a chart's place in the user's layout to its place on the page.
    fn offset(&self, chart: u32) -> DVec2 {
        DVec2::from(self.placement.charts[chart as usize].offset.map(f64::from))
    }

    /// Returns the bilinear weight of owned texels of the chart at the end of a walk.
    fn owned_share(&self, end: &WalkEnd) -> f64 {
        let [width, height] = self.placement.page_size.map(i64::from);
        let chart = self.partition.triangle_chart[end.triangle as usize];
        let place = &self.placement.charts[chart as usize];
        let point = end.texel + self.offset(chart) - 0.5;
        let corner = point.floor();
        let weight = point - corner;
        let first = corner.as_i64vec2();
        let mut share = 0.0;
        for tap in 0..4_i64 {
            let [x, y] = [tap & 1, tap >> 1];
            let (column, row) = (first.x + x, first.y + y);
            if column < 0 || row < 0 || column >= width || row >= height {
                continue;
            }
            let owner = self.owners[((i64::from(place.page) * height + row) * width + column) as usize];
            if owner != EMPTY && self.partition.triangle_chart[owner as usize] == chart {
                let tap_weight = |tap: i64, weight: f64| if tap == 1 { weight } else { 1.0 - weight };
                share += tap_weight(x, weight.x) * tap_weight(y, weight.y);
            }
        }
        share
    }

    /// Returns the end of a walk on its page, and whether it was moved toward an owned texel so that bilinear sampling
    /// reads that texel. `None` if no owned texel of the chart is near.
    fn sampled(&self, end: WalkEnd) -> Option<(WalkEnd, DVec2, bool)> {
        let chart = self.partition.triangle_chart[end.triangle as usize];
        let texel = end.texel + self.offset(chart);
        let away = self.nearest_owned(chart, texel)? - texel;
        let distance = away.abs();
        if (1.0 - distance.x).max(0.0) * (1.0 - distance.y).max(0.0) >= LEAST_WEIGHT {
            return Some((end, texel, false));
        }
        let pull = 1.0 - PULLED_DISTANCE / distance.max_element();
        Some((end, texel + away * pull, true))
    }

    /// Returns the center of the owned texel of a chart that is nearest to a point, within [`PULL_TEXELS`].
    fn nearest_owned(&self, chart: u32, texel: DVec2) -> Option<DVec2> {
        let [width, height] = self.placement.page_size.map(i64::from);
        let page = i64::from(self.placement.charts[chart as usize].page);
        let [column, row] = texel.floor().as_i64vec2().to_array();
        let mut nearest: Option<(f64, DVec2)> = None;
        for reach in 0..=PULL_TEXELS {
            for y in (row - reach).max(0)..=(row + reach).min(height - 1) {
                for x in (column - reach).max(0)..=(column + reach).min(width - 1) {
                    if (x - column).abs().max((y - row).abs()) != reach {
                        continue;
                    }
                    let owner = self.owners[((page * height + y) * width + x) as usize];
                    if owner == EMPTY || self.partition.triangle_chart[owner as usize] != chart {
                        continue;
                    }
                    let center = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                    let away = center - texel;
                    let distance = away.x.hypot(away.y);
                    if nearest.is_none_or(|(least, _)| distance < least) {
                        nearest = Some((distance, center));
                    }
                }
            }
            // Texels farther out have at least this distance.
            if nearest.is_some_and(|(least, _)| least <= reach as f64) {
                break;
            }
        }
        nearest.map(|(_, center)| center)
    }
}
