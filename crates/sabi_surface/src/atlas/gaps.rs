//! Narrow gaps: places where two parts of a chart lie side by side in UV, but not on the surface, with too few texels
//! between them for both rings of ghosts. A ghost continues only one of the sides, so the other side would read values from
//! elsewhere on the surface. The chart is divided there, and its parts are placed separately.

use sabi_cancel::{CancelableIterator as _, look};
use std::collections::{HashSet, VecDeque};

use glam::{DVec2, DVec3};

use super::RINGS;
use super::build_inputs::BuildInputs;
use super::charts::Partition;
use super::mask::{Mask, for_each_run, or_shifted};
use super::raster::spans;
use crate::segment::distance_to_segment;

/// Maximum number of texels between two parts of a chart whose rings meet.
const WIDEST: i64 = 2 * RINGS as i64;
/// Distance from the middle of a gap within which a path over the chart may connect its two sides, in texels, or as a share of the map if
/// that is more. If there is such a path, the gap is left: near the end of a gap the sides are close to each other on the surface, too.
const AROUND: f64 = 12.0;
const AROUND_SHARE: f64 = 0.01;
/// Maximum number of triangles that are visited to find such a path around one gap. If the search ends early, the sides
/// count as connected.
const AROUND_LIMIT: usize = 4096;
/// Maximum number of triangles that are visited to find paths around all gaps of a chart, for each of its triangles.
const WAYS_EFFORT: usize = 64;
const LEAST_WAYS_EFFORT: usize = 1 << 22;
/// Maximum number of triangles that are visited to divide a chart, for each of its triangles. At gaps that remain after
/// that, single triangles are cut out.
const EFFORT: usize = 128;
/// Maximum number of pairs of texels across gaps of a chart that are examined: 32 MiB.
const GAP_PAIRS_LIMIT: usize = 1 << 20;
/// Maximum number of places that are examined along the border edges of a chart, for each of its triangles.
const EDGE_STEPS: usize = 256;
const LEAST_EDGE_STEPS: usize = 1 << 20;
/// Distance in space, in texel widths, up to which neighboring texels count as the same place, for example along edges that
/// differ only by rounding.
const ONE_PLACE: f64 = 3.0;

/// Directions from a texel across a gap. The opposite directions would find the same gaps.
const DIRECTIONS: [[i64; 2]; 4] = [[1, 0], [0, 1], [1, 1], [-1, 1]];

/// Column and row in the user's UV layout.
type LayoutTexel = [i64; 2];

/// Charts whose gaps are looked for.
pub(super) struct Gaps<'a> {
    pub(super) plan: &'a BuildInputs<'a>,
    pub(super) partition: &'a Partition,
}

impl Gaps<'_> {
    /// Divides a chart at its narrow gaps. Cuts may leave other narrow gaps. Returns for each triangle of the chart, in
    /// order, the first triangle of its part; `None` for a chart without narrow gaps.
    pub(super) fn divide(&self, chart: usize, mask: &Mask) -> Option<Vec<u32>> {
        let sides = self.sides(chart, mask);
        let effort = EFFORT.saturating_mul(self.partition.triangles(chart).len());
        (!sides.is_empty()).then(|| self.parts(chart, &sides, effort))
    }

    /// Returns the triangles on both sides of the narrow gaps of a chart, sorted by their places in UV, so that copies of a
    /// chart are divided in the same way whatever the order of their triangles.
    pub(super) fn sides(&self, chart: usize, mask: &Mask) -> Vec<[u32; 2]> {
        let mut pairs = wide_pairs(mask);
        self.touching_pairs(chart, mask, &mut pairs);
        pairs.sort_unstable();
        pairs.dedup();
        let owners = self.owners(chart, mask, &pairs);
        let mut effort = WAYS_EFFORT
            .saturating_mul(self.partition.triangles(chart).len())
            .max(LEAST_WAYS_EFFORT);
        let mut known = HashSet::new();
        let mut sides = Vec::new();
        for [from, to] in pairs {
            let (Some(a), Some(b)) = (owners.triangle(from), owners.triangle(to)) else {
                continue;
            };
            if a == b || known.contains(&[a.min(b), a.max(b)]) || self.is_one_place([(a, from), (b, to)]) {
                continue;
            }
            let middle = (center(from) + center(to)) / 2.0;
            if !self.are_joined(a, b, middle, &mut effort) {
                known.insert([a.min(b), a.max(b)]);
                sides.push([a, b]);
            }
        }
        sides
    }

    /// Returns whether two neighboring texels are at the same place in space.
    fn is_one_place(&self, [(a, from), (b, to)]: [(u32, LayoutTexel); 2]) -> bool {
        let are_side_by_side = [0, 1].iter().all(|&axis| (from[axis] - to[axis]).abs() <= 1);
        let places = || self.place(a, from).zip(self.place(b, to));
        are_side_by_side
            && places().is_some_and(|([one, width], [other, _])| one.distance(other) <= ONE_PLACE * width.length())
    }

    /// Returns the position of a texel's center in space, and the longer one of its two texel axes; `None` for a triangle
    /// without area in UV.
    fn place(&self, triangle: u32, texel: LayoutTexel) -> Option<[DVec3; 2]> {
        let [q0, q1, q2] = self.plan.uvs.corners(triangle);
        let (to_1, to_2) = (q1 - q0, q2 - q0);
        let area2 = to_1.perp_dot(to_2);
        let position = |vertex: u32| DVec3::from(self.plan.mesh.positions[vertex as usize].map(f64::from));
        let [p0, p1, p2] = self.plan.mesh.triangles[triangle as usize].map(position);
        let step = |v: DVec2| (p1 - p0) * (v.perp_dot(to_2) / area2) + (p2 - p0) * (to_1.perp_dot(v) / area2);
        let (x, y) = (step(DVec2::X), step(DVec2::Y));
        let longer = if x.length_squared() < y.length_squared() { y } else { x };
        (area2 != 0.0).then(|| [p0 + step(center(texel) - q0), longer])
    }

    /// Adds pairs of neighboring texels near edges where the chart ends.
    fn touching_pairs(&self, chart: usize, mask: &Mask, pairs: &mut Vec<[LayoutTexel; 2]>) {
        let triangles = self.partition.triangles(chart);
        let mut steps_left = EDGE_STEPS.saturating_mul(triangles.len()).max(LEAST_EDGE_STEPS);
        for &triangle in triangles.iter().looking() {
            let corners = self.plan.uvs.corners(triangle);
            for k in 0..3 {
                if self.beyond(3 * triangle + k as u32).is_some() {
                    continue;
                }
                let (from, to) = (corners[k], corners[(k + 1) % 3]);
                let length = from.distance(to);
                // A triangle without area may extend beyond the rectangle of the chart.
                if length > f64::from(mask.width + mask.height) {
                    continue;
                }
                let steps = (2.0 * length).ceil().max(1.0);
                let mut last = None;
                for step in 0..=steps as i64 {
                    if pairs.len() >= GAP_PAIRS_LIMIT || steps_left == 0 {
                        return;
                    }
                    steps_left -= 1;
                    let texel = from.lerp(to, step as f64 / steps).floor().as_i64vec2().to_array();
                    if last.replace(texel) == Some(texel) {
                        continue;
                    }
                    let [x, y] = texel;
                    let beside = [
                        [[x - 1, y], texel],
                        [texel, [x + 1, y]],
                        [[x, y - 1], texel],
                        [texel, [x, y + 1]],
                    ];
                    pairs.extend(
                        beside
                            .into_iter()
                            .filter(|pair| pair.iter().all(|&texel| mask.is_set(texel))),
                    );
                }
            }
        }
    }

    /// Finds the triangles of the texels of pairs.
    fn owners(&self, chart: usize, mask: &Mask, pairs: &[[LayoutTexel; 2]]) -> Owners {
        let mut owners = Owners::of(mask, pairs.iter().flatten().copied());
        if !pairs.is_empty() {
            // Iterate in reverse, so that the lowest number is written last, as in the atlas.
            for &triangle in self.partition.triangles(chart).iter().rev() {
                spans(
                    self.plan.uvs.fixed(triangle),
                    i64::MIN / 4..i64::MAX / 4,
                    |y, x0, x1| {
                        owners.paint(y, [x0, x1], triangle);
                    },
                );
            }
        }
        owners
    }

    /// Returns the triangle on the other side of a half-edge if it belongs to the same chart there.
    fn beyond(&self, edge: u32) -> Option<u32> {
        let chart = |triangle: u32| self.partition.triangle_chart[triangle as usize];
        self.plan.across(edge).filter(|&next| chart(next) == chart(edge / 3))
    }

    /// Returns whether a path over the chart near a point leads from one triangle to another.
    fn are_joined(&self, from: u32, to: u32, middle: DVec2, effort: &mut usize) -> bool {
        // In most cases the triangles share an edge.
        if self.near_neighbors(from, middle).any(|next| next == to) {
            return true;
        }
        let mut seen = HashSet::from([from]);
        let mut queue = VecDeque::from([from]);
        while let Some(triangle) = queue.pop_front() {
            look();
            for next in self.near_neighbors(triangle, middle) {
                if next == to || seen.len() > AROUND_LIMIT || *effort == 0 {
                    return true;
                }
                if seen.insert(next) {
                    *effort -= 1;
                    queue.push_back(next);
                }
            }
        }
        false
    }

    /// Returns the neighbors of a triangle in its chart, over edges near a point.
    fn near_neighbors(&self, triangle: u32, point: DVec2) -> impl Iterator<Item = u32> {
        let corners = self.plan.uvs.corners(triangle);
        let reach = AROUND.max(AROUND_SHARE * self.plan.uvs.size());
        (0..3).filter_map(move |k| {
            let next = self.beyond(3 * triangle + k as u32)?;
            (distance_to_segment(point, [corners[k], corners[(k + 1) % 3]]) <= reach).then_some(next)
        })
    }

    /// Divides a chart between the sides of its gaps. Each cut separates the triangles that are nearer to one side from those nearer to
    /// the other, measured in triangles, so that a cut continues from the end of the gap and no part falls to pieces.
    pub(super) fn parts(&self, chart: usize, sides: &[[u32; 2]], mut effort: usize) -> Vec<u32> {
        let triangles = self.partition.triangles(chart);
        let local = |triangle: u32| triangles.binary_search(&triangle).ok();
        let neighbors: Vec<[Option<usize>; 3]> = triangles
            .iter()
            .map(|triangle| [0, 1, 2].map(|k| self.beyond(3 * triangle + k).and_then(local)))
            .collect();
        let mut parts = vec![0_usize; triangles.len()];
        let mut count = 1;
        for [a, b] in middle_first(sides).map(|side| side.map(local)) {
            let (Some(a), Some(b)) = (a, b) else { continue };
            if parts[a] != parts[b] {
                continue;
            }
            let nearer = if effort > 0 {
                nearer_to_each(&neighbors, &parts, [a, b])
            } else {
                [vec![], vec![b]]
            };
            effort = effort.saturating_sub(nearer.iter().map(Vec::len).sum());
            for triangle in &nearer[1] {
                parts[*triangle] = count;
            }
            count += 1;
        }
        let mut first = vec![u32::MAX; count];
        for (&triangle, &part) in triangles.iter().zip(&parts) {
            first[part] = first[part].min(triangle);
        }
        parts.into_iter().map(|part| first[part]).collect()
    }
}

/// Some texels of a chart with the triangles that own them.
struct Owners {
    first_row: i64,
    /// Columns of each row in ascending order, with the triangle once it is known.
    rows: Vec<Vec<(i64, Option<u32>)>>,
}

impl Owners {
    fn of(mask: &Mask, texels: impl Iterator<Item = LayoutTexel>) -> Owners {
        let first_row = mask.origin[1];
        let mut rows = vec![Vec::new(); mask.height as usize];
        for [x, y] in texels {
            rows[(y - first_row) as usize].push((x, None));
        }
        for row in &mut rows {
            row.sort_unstable();
            row.dedup();
        }
        Owners { first_row, rows }
    }

    /// Sets the triangle of the texels in a row whose columns are in a range.
    fn paint(&mut self, y: i64, [x0, x1]: [i64; 2], triangle: u32) {
        let row = usize::try_from(y - self.first_row)
            .ok()
            .and_then(|row| self.rows.get_mut(row));
        let Some(row) = row else { return };
        let start = row.partition_point(|&(x, _)| x < x0);
        for (_, owner) in row[start..].iter_mut().take_while(|(x, _)| *x < x1) {
            *owner = Some(triangle);
        }
    }

    fn triangle(&self, [x, y]: LayoutTexel) -> Option<u32> {
        let row = self.rows.get(usize::try_from(y - self.first_row).ok()?)?;
        row[row.binary_search_by_key(&x, |&(x, _)| x).ok()?].1
    }
}

/// Returns the middle item first, then the middle items of both halves, and so on, so that parts are halved before small
/// parts are cut off.
fn middle_first<T: Copy>(items: &[T]) -> impl Iterator<Item = T> {
    let mut ranges = VecDeque::new();
    ranges.push_back(0..items.len());
    std::iter::from_fn(move || {
        let range = ranges.pop_front()?;
        let middle = range.start.midpoint(range.end);
        ranges.extend(
            [range.start..middle, middle + 1..range.end]
                .into_iter()
                .filter(|half| !half.is_empty()),
        );
        items.get(middle).copied()
    })
}

/// Returns the triangles of a part that are nearer to the first of two triangles, and those that are nearer to the second,
/// measured in triangles.
fn nearer_to_each(neighbors: &[[Option<usize>; 3]], parts: &[usize], sides: [usize; 2]) -> [Vec<usize>; 2] {
    let mut seen = HashSet::from(sides);
    let mut nearer = sides.map(|side| vec![side]);
    let mut queue = VecDeque::from([(sides[0], 0), (sides[1], 1)]);
    while let Some((at, side)) = queue.pop_front() {
        for next in neighbors[at].iter().flatten().copied() {
            if parts[next] == parts[sides[0]] && seen.insert(next) {
                nearer[side].push(next);
                queue.push_back((next, side));
            }
        }
    }
    nearer
}

/// Returns pairs of texels of a chart with a few empty texels between them.
fn wide_pairs(mask: &Mask) -> Vec<[LayoutTexel; 2]> {
    let mut pairs = Vec::new();
    let empty = Vec::new();
    let rows: Vec<&[u64]> = mask.rows().collect();
    for (y, row) in rows.iter().enumerate() {
        for [dx, dy] in DIRECTIONS {
            // Texels after which the chart ends in this direction.
            let next = rows.get(y + dy as usize).copied().unwrap_or(&empty);
            let mut covered = vec![0; row.len()];
            or_shifted(&mut covered, next, -dx);
            let ends: Vec<u64> = row.iter().zip(&covered).map(|(own, next)| own & !next).collect();
            for_each_run(&ends, |x0, x1| {
                for x in x0..x1.min(x0 + GAP_PAIRS_LIMIT.saturating_sub(pairs.len())) {
                    let from = [mask.origin[0] + x as i64, mask.origin[1] + y as i64];
                    let across = (2..=WIDEST + 1).map(|steps| [from[0] + steps * dx, from[1] + steps * dy]);
                    pairs.extend(across.into_iter().find(|&to| mask.is_set(to)).map(|to| [from, to]));
                }
            });
        }
    }
    pairs
}

fn center([x, y]: LayoutTexel) -> DVec2 {
    DVec2::new(x as f64, y as f64) + 0.5
}
