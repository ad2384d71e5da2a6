//! The leap map: how far a straight step may go from a texel.
//!
//! Walls are texels that no triangle owns, and texels at a jump of the metric: neighbors in a row or column whose triangles' first
//! fundamental forms `JᵀJ` (texels to model space) differ by more than 5 % of the larger one. The leap is the exact Euclidean distance to
//! the nearest wall's center, minus 1.5 so that bilinear sampling at the end does not touch the wall, rounded down.

use rayon::prelude::*;
use sabi_cancel::Cancel;

use super::EMPTY;
use super::charts::Partition;
use super::fixed_point_uvs::Uvs;
use crate::model::Mesh;

/// Distances beyond this many texels count as equal: a leap is at most 255.
const FAR: u16 = 258;
/// Number of columns that one task processes.
const STRIP: usize = 256;
const METRIC_JUMP: f32 = 0.05;

/// First fundamental form of a triangle: `[P_u·P_u, P_u·P_v, P_v·P_v]`, P in model units, u and v in texels.
type Metric = [f32; 3];

/// Computes the leap of every texel.
pub(super) fn leap(mesh: &Mesh, uvs: &Uvs, partition: &Partition, owners: &[u32], page_size: [u32; 2]) -> Vec<u8> {
    let [width, height] = page_size.map(|side| side as usize);
    let metrics: Vec<Metric> = (0..partition.triangle_chart.len() as u32)
        .into_par_iter()
        .map(|triangle| metric(mesh, uvs, triangle))
        .collect();
    let cancel = Cancel::current();
    let mut leaps = vec![0u8; owners.len()];
    leaps
        .par_chunks_mut(width * height)
        .zip(owners.par_chunks(width * height))
        .for_each(|(leaps, owners)| {
            let page = OwnedPage {
                owners,
                width,
                metrics: &metrics,
                cancel: &cancel,
            };
            let columns = page.column_distances();
            leaps
                .par_chunks_mut(width)
                .zip(columns.par_chunks(width))
                .for_each(|(leaps, columns)| {
                    cancel.look();
                    row_leaps(columns, leaps);
                });
        });
    leaps
}

struct OwnedPage<'a> {
    owners: &'a [u32],
    width: usize,
    metrics: &'a [Metric],
    cancel: &'a Cancel,
}

impl OwnedPage<'_> {
    /// Returns the distance of every texel to the nearest wall in its column, at most [`FAR`].
    fn column_distances(&self) -> Vec<u16> {
        let (width, height) = (self.width, self.owners.len() / self.width);
        let mut distances = vec![FAR; self.owners.len()];
        distances.par_chunks_mut(width).enumerate().for_each(|(y, distances)| {
            self.cancel.look();
            for (x, distance) in distances.iter_mut().enumerate() {
                if self.is_wall(x, y) {
                    *distance = 0;
                }
            }
        });
        // Columns are independent of each other. They are processed in strips, which are copied out and back.
        let strips: Vec<Vec<u16>> = (0..width)
            .step_by(STRIP)
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(|left| {
                self.cancel.look();
                let wide = STRIP.min(width - left);
                let mut strip: Vec<u16> = Vec::with_capacity(wide * height);
                for row in distances.chunks_exact(width) {
                    strip.extend_from_slice(&row[left..left + wide]);
                }
                sweep_columns(&mut strip, wide);
                strip
            })
            .collect();
        distances.par_chunks_mut(width).enumerate().for_each(|(y, distances)| {
            for (strip, target) in strips.iter().zip(distances.chunks_mut(STRIP)) {
                let wide = target.len();
                target.copy_from_slice(&strip[y * wide..][..wide]);
            }
        });
        distances
    }

    fn is_wall(&self, x: usize, y: usize) -> bool {
        let at = y * self.width + x;
        let owner = self.owners[at];
        if owner == EMPTY {
            return true;
        }
        let jumps = |near: Option<&u32>| {
            near.is_some_and(|&near| {
                near != owner && near != EMPTY && differs(self.metrics[owner as usize], self.metrics[near as usize])
            })
        };
        (x > 0 && jumps(self.owners.get(at - 1)))
            || (x + 1 < self.width && jumps(self.owners.get(at + 1)))
            || (at >= self.width && jumps(self.owners.get(at - self.width)))
            || jumps(self.owners.get(at + self.width))
    }
}

/// Propagates distances down and then up. The border of the page need not count as a wall, since rings keep charts away from it.
fn sweep_columns(strip: &mut [u16], wide: usize) {
    for at in wide..strip.len() {
        strip[at] = strip[at].min(strip[at - wide] + 1);
    }
    for at in (0..strip.len().saturating_sub(wide)).rev() {
        strip[at] = strip[at].min(strip[at + wide] + 1);
    }
}

/// Computes the leaps of a row from the distances within its columns: the lower envelope of parabolas (Felzenszwalb and
/// Huttenlocher 2012), in integers. Each run between two walls of the row is computed separately.
fn row_leaps(columns: &[u16], leaps: &mut [u8]) {
    let mut envelope = Envelope::default();
    let mut x = 0;
    while x < columns.len() {
        if columns[x] == 0 {
            x += 1;
            continue;
        }
        let end = columns[x..]
            .iter()
            .position(|&distance| distance == 0)
            .map_or(columns.len(), |run| x + run);
        envelope.clear();
        // Walls at both ends of the run. The border of the page counts as a wall.
        envelope.push(x as i64 - 1, 0);
        for (offset, &distance) in columns[x..end].iter().enumerate() {
            envelope.push((x + offset) as i64, i64::from(distance));
        }
        envelope.push(end as i64, 0);
        envelope.read(x, &mut leaps[x..end]);
        x = end;
    }
}

/// Lower envelope of parabolas `(x − at)² + distance²`, from left to right.
#[derive(Default)]
struct Envelope {
    /// Position, squared distance, first texel where it is the lowest.
    parabolas: Vec<(i64, i64, i64)>,
}

impl Envelope {
    fn clear(&mut self) {
        self.parabolas.clear();
    }

    fn push(&mut self, at: i64, distance: i64) {
        let square = distance * distance;
        let mut from = i64::MIN;
        while let Some(&(before, before_square, before_from)) = self.parabolas.last() {
            // First texel at which the new parabola is lower than the one before.
            let meet = (square + at * at - before_square - before * before).div_euclid(2 * (at - before)) + 1;
            if meet > before_from {
                from = meet;
                break;
            }
            self.parabolas.pop();
        }
        self.parabolas.push((at, square, from));
    }

    fn read(&self, start: usize, leaps: &mut [u8]) {
        let mut parabolas = self.parabolas.iter().peekable();
        let mut current = (0, 0);
        for (offset, leap) in leaps.iter_mut().enumerate() {
            let x = (start + offset) as i64;
            while let Some(&(at, square, _)) = parabolas.next_if(|parabola| parabola.2 <= x) {
                current = (at, square);
            }
            *leap = leap_of((x - current.0).pow(2) + current.1);
        }
    }
}

/// `⌊√square − 1.5⌋` between 0 and 255.
fn leap_of(square: i64) -> u8 {
    // √square ≥ n + 1.5 means 4 square ≥ (2n + 3)²; integers decide.
    let root = (4 * square).isqrt();
    ((root - 3) / 2).clamp(0, 255) as u8
}

fn metric(mesh: &Mesh, uvs: &Uvs, triangle: u32) -> Metric {
    let [q0, q1, q2] = uvs.corners(triangle);
    let (q1, q2) = (q1 - q0, q2 - q0);
    let area2 = q1.perp_dot(q2);
    let [p0, p1, p2] = mesh.corners(triangle);
    let axis = |of_1: f64, of_2: f64| (p1 - p0) * of_1 + (p2 - p0) * of_2;
    let (u, v) = (axis(q2.y / area2, -q1.y / area2), axis(-q2.x / area2, q1.x / area2));
    [u.dot(u), u.dot(v), v.dot(v)].map(|product| product as f32)
}

/// Returns true if two metrics differ by more than a twentieth of the larger, or if either contains a NaN.
fn differs(a: Metric, b: Metric) -> bool {
    let scale = a.iter().chain(&b).fold(0.0f32, |scale, value| scale.max(value.abs()));
    !(0..3).all(|k| (a[k] - b[k]).abs() <= METRIC_JUMP * scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaps_are_the_exact_distance_to_the_nearest_wall_less_one_and_a_half() {
        let (width, height) = (61usize, 47usize);
        let wall = |x: usize, y: usize| (x * 7919 + y * 104_729 + x * y * 31).is_multiple_of(97);
        let mut distances: Vec<u16> = (0..width * height)
            .map(|at| if wall(at % width, at / width) { 0 } else { FAR })
            .collect();
        sweep_columns(&mut distances, width);
        for y in 0..height {
            let mut leaps = vec![0; width];
            row_leaps(&distances[y * width..][..width], &mut leaps);
            for (x, &leap) in leaps.iter().enumerate() {
                let nearest = (0..width * height)
                    .filter(|at| wall(at % width, at / width))
                    .map(|at| (at % width).abs_diff(x).pow(2) + (at / width).abs_diff(y).pow(2))
                    .chain([(x + 1).pow(2), (width - x).pow(2)])
                    .min()
                    .unwrap();
                let expected = ((nearest as f64).sqrt() - 1.5).floor().clamp(0.0, 255.0);
                assert_eq!(f64::from(leap), expected, "at {x} {y}");
            }
        }
    }
}
