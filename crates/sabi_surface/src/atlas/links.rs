//! Ghost links: the surface point of each ghost.

use rayon::prelude::*;

use super::charts::Partition;
use super::place::Placement;
use super::ring::Anchored;
use super::walk::{Ground, Landing};
use super::{EMPTY, Ghost};

/// Largest distance from a link's end to the owned texel that it is pulled to, texels.
const PULL_TEXELS: i64 = 4;
/// Distance from a pulled end to the texel's center, along the longer axis, texels.
const PULLED_DISTANCE: f64 = 0.875;
/// An owned texel counts for bilinear sampling from this weight on.
const LEAST_WEIGHT: f64 = 1e-3;

/// Distances, in texels, by which a walk is continued beyond its end until enough texels around it are owned.
const BEYOND: [f64; 4] = [0.0, 0.25, 0.5, 1.0];
/// Difference below which two shares count as equal.
const ALIKE: f64 = 0.25;
/// Share of owned texels at which a walk is not continued.
const ENOUGH: f64 = 0.75;

/// Owners and placement in which links are looked up.
pub(super) struct Pages<'a> {
    pub(super) owners: &'a [u32],
    pub(super) partition: &'a Partition,
    pub(super) placement: &'a Placement,
}

/// The ghosts with their links, how many have none, and how many were pulled to an owned texel.
pub(super) struct Links {
    pub(super) ghosts: Vec<Ghost>,
    pub(super) unlinked: u32,
    pub(super) pulled: u32,
}

/// Origin of a ghost's link.
enum Way {
    Walked,
    Pulled,
    Gave,
}

/// Links all ghosts, in their order.
pub(super) fn link(ground: &Ground, pages: &Pages, anchored: &[Anchored]) -> Links {
    let linked: Vec<(Ghost, Way)> = anchored
        .par_iter()
        .map(|anchored| pages.link(ground, anchored))
        .collect();
    let count = |way: fn(&Way) -> bool| linked.iter().filter(|linked| way(&linked.1)).count() as u32;
    Links {
        unlinked: count(|way| matches!(way, Way::Gave)),
        pulled: count(|way| matches!(way, Way::Pulled)),
        ghosts: linked.into_iter().map(|(ghost, _)| ghost).collect(),
    }
}

impl Pages<'_> {
    fn link(&self, ground: &Ground, anchored: &Anchored) -> (Ghost, Way) {
        let Anchored {
            texel,
            anchor,
            triangle,
        } = *anchored;
        let chart = self.partition.triangle_chart[triangle as usize];
        let offset = self.placement.charts[chart as usize].offset.map(f64::from);
        let start = [0, 1].map(|axis| f64::from(anchor[axis]) + 0.5 - offset[axis]);
        let step = [0, 1].map(|axis| f64::from(texel[axis]) - f64::from(anchor[axis]));
        let found = ground
            .walk(triangle, start, step)
            .and_then(|landing| self.reachable(landing));
        let read = self.read_place(ground, triangle, start, step);
        let ghost = |triangle, texel: [f64; 2], transport: [[f64; 2]; 2]| Ghost {
            texel: anchored.texel,
            chart,
            target_triangle: triangle,
            target_texel: texel.map(|value| value as f32),
            target_from_own: transport.map(|column| column.map(|value| value as f32)),
            read_triangle: read.map_or(triangle, |(read, _)| read),
            read_texel: read.map_or(texel, |(_, at)| at).map(|value| value as f32),
        };
        match found {
            Some((landing, texel, false)) => (ghost(landing.triangle, texel, landing.transport), Way::Walked),
            Some((landing, texel, true)) => (ghost(landing.triangle, texel, landing.transport), Way::Pulled),
            None => {
                let center = anchor.map(|value| f64::from(value) + 0.5);
                (ghost(triangle, center, [[1.0, 0.0], [0.0, 1.0]]), Way::Gave)
            }
        }
    }

    /// Returns the place from which stored values are read for the end of a walk: a triangle of the chart, and texel
    /// coordinates on its page.
    ///
    /// Between the last owned texel of a chart and the first of the next there is up to a texel of surface that neither
    /// owns. A walk that ends there is continued beyond the seam, and its end is given in the coordinates of that chart:
    /// of all candidates the one that reads most from owned texels. In its own chart's coordinates a ghost would read
    /// itself.
    fn read_place(&self, ground: &Ground, triangle: u32, start: [f64; 2], step: [f64; 2]) -> Option<(u32, [f64; 2])> {
        let length = step[0].hypot(step[1]).max(1.0);
        let ends = BEYOND.into_iter().filter_map(|beyond| {
            let more = step.map(|value| value * beyond / length);
            let further = [0, 1].map(|axis| step[axis] + more[axis]);
            let mut landing = ground.walk(triangle, start, further)?;
            let [along_u, along_v] = landing.transport;
            for axis in 0..2 {
                landing.texel[axis] -= along_u[axis] * more[0] + along_v[axis] * more[1];
            }
            let share = self.owned_share(&landing);
            Some((landing, share))
        });
        let chart = |landing: &Landing| self.partition.triangle_chart[landing.triangle as usize];
        let own = self.partition.triangle_chart[triangle as usize];
        let mut best: Option<(Landing, f64)> = None;
        for (landing, share) in ends {
            let is_better = best.as_ref().is_none_or(|(known, most)| {
                // Both charts may end a texel before the seam; the other one is preferred.
                let changes = chart(known) == own && chart(&landing) != own;
                share > most + LEAST_WEIGHT || (changes && share > most - ALIKE)
            });
            if is_better {
                best = Some((landing, share));
            }
            if share > ENOUGH {
                break;
            }
        }
        let (landing, texel, _) = best.and_then(|(landing, _)| self.reachable(landing))?;
        Some((landing.triangle, texel))
    }

    /// Share of owned texels of the chart in what bilinear sampling reads at the end of a walk.
    fn owned_share(&self, landing: &Landing) -> f64 {
        let [width, height] = self.placement.page_size.map(i64::from);
        let chart = self.partition.triangle_chart[landing.triangle as usize];
        let place = &self.placement.charts[chart as usize];
        let point = [0, 1].map(|axis| landing.texel[axis] + f64::from(place.offset[axis]) - 0.5);
        let corner = point.map(f64::floor);
        let weight = [0, 1].map(|axis| point[axis] - corner[axis]);
        let mut share = 0.0;
        for tap in 0..4_i64 {
            let [x, y] = [tap & 1, tap >> 1];
            let (column, row) = (corner[0] as i64 + x, corner[1] as i64 + y);
            if column < 0 || row < 0 || column >= width || row >= height {
                continue;
            }
            let owner = self.owners[((i64::from(place.page) * height + row) * width + column) as usize];
            if owner != EMPTY && self.partition.triangle_chart[owner as usize] == chart {
                let along = |far: i64, weight: f64| if far == 1 { weight } else { 1.0 - weight };
                share += along(x, weight[0]) * along(y, weight[1]);
            }
        }
        share
    }

    /// The end on its page, and whether it had to be pulled so that bilinear sampling finds an owned texel.
    fn reachable(&self, landing: Landing) -> Option<(Landing, [f64; 2], bool)> {
        let chart = self.partition.triangle_chart[landing.triangle as usize];
        let offset = self.placement.charts[chart as usize].offset;
        let texel = [0, 1].map(|axis| landing.texel[axis] + f64::from(offset[axis]));
        let nearest = self.nearest_owned(chart, texel)?;
        let away = [0, 1].map(|axis| nearest[axis] - texel[axis]);
        let longest = away[0].abs().max(away[1].abs());
        if (1.0 - away[0].abs()).max(0.0) * (1.0 - away[1].abs()).max(0.0) >= LEAST_WEIGHT {
            return Some((landing, texel, false));
        }
        let pull = 1.0 - PULLED_DISTANCE / longest;
        Some((landing, [0, 1].map(|axis| texel[axis] + away[axis] * pull), true))
    }

    /// Center of the owned texel of a chart that is nearest to a point.
    fn nearest_owned(&self, chart: u32, texel: [f64; 2]) -> Option<[f64; 2]> {
        let [width, height] = self.placement.page_size.map(i64::from);
        let page = i64::from(self.placement.charts[chart as usize].page);
        let [column, row] = texel.map(|value| value.floor() as i64);
        let mut nearest: Option<(f64, [f64; 2])> = None;
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
                    let center = [x as f64 + 0.5, y as f64 + 0.5];
                    let distance = (center[0] - texel[0]).hypot(center[1] - texel[1]);
                    if nearest.is_none_or(|(least, _)| distance < least) {
                        nearest = Some((distance, center));
                    }
                }
            }
            // Texels further out are at least this far away.
            if nearest.is_some_and(|(least, _)| least <= reach as f64) {
                break;
            }
        }
        nearest.map(|(_, center)| center)
    }
}
