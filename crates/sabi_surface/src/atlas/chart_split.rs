//! Splitting of charts that overlap themselves.

use sabi_cancel::look;
use std::collections::VecDeque;

use super::build_inputs::BuildInputs;
use super::charts::Partition;
use super::fixed_point_uvs::{UNIT, Uvs};
use super::raster::spans;

/// Marks a texel that no triangle has claimed.
const UNCLAIMED: u32 = u32::MAX;

/// Inputs of a split.
pub(super) struct Splitter<'a> {
    pub(super) plan: &'a BuildInputs<'a>,
    pub(super) partition: &'a Partition,
}

impl Splitter<'_> {
    /// Splits a chart. Each new chart grows from the first remaining triangle over neighbors, as long as no texel center is
    /// claimed by two triangles that do not touch in UV.
    ///
    /// Returns for each triangle of the chart, in order, the first triangle of its new chart.
    pub(super) fn split(&self, chart: usize) -> Vec<u32> {
        let triangles = self.partition.triangles(chart);
        let mut grid = OwnerGrid::covering(&self.plan.uvs, triangles);
        // Index of a triangle within the chart.
        let local = |triangle: u32| triangles.binary_search(&triangle).ok();
        let mut labels = vec![UNCLAIMED; triangles.len()];
        for start in 0..triangles.len() {
            if labels[start] != UNCLAIMED {
                continue;
            }
            let seed = triangles[start];
            let mut grown = Vec::new();
            let mut queued = vec![false; triangles.len()];
            queued[start] = true;
            let mut queue = VecDeque::from([start]);
            while let Some(at) = queue.pop_front() {
                look();
                let triangle = triangles[at];
                if triangle != seed && !self.fits(&grid, triangle) {
                    continue;
                }
                grid.paint(self.plan.uvs.fixed(triangle), triangle);
                labels[at] = seed;
                grown.push(triangle);
                for neighbor in self.neighbors(triangle).filter_map(local) {
                    if labels[neighbor] == UNCLAIMED && !queued[neighbor] {
                        queued[neighbor] = true;
                        queue.push_back(neighbor);
                    }
                }
            }
            for triangle in grown {
                grid.paint(self.plan.uvs.fixed(triangle), UNCLAIMED);
            }
        }
        labels
    }

    /// Returns the neighbors of a triangle over edges that are no seams, in the order of its edges.
    fn neighbors(&self, triangle: u32) -> impl Iterator<Item = u32> {
        (3 * triangle..3 * triangle + 3).filter_map(|edge| self.plan.across(edge))
    }

    /// Returns true if all texel centers of a triangle are free or belong to triangles that touch it.
    fn fits(&self, grid: &OwnerGrid, triangle: u32) -> bool {
        let mut fits = true;
        spans(
            self.plan.uvs.fixed(triangle),
            i64::MIN / 4..i64::MAX / 4,
            |y, x0, x1| {
                fits = fits
                    && grid
                        .row(y, x0, x1)
                        .iter()
                        .all(|&owner| owner == UNCLAIMED || self.touch(owner, triangle));
            },
        );
        fits
    }

    /// Returns true if two triangles share a corner in space and in UV. Slivers may flip when their corners are
    /// snapped, which is not an overlap in the user's layout.
    fn touch(&self, a: u32, b: u32) -> bool {
        let corner = |triangle: u32, k: usize| {
            let place = self.plan.topology.corners[triangle as usize * 3 + k];
            (place, self.plan.uvs.fixed(triangle)[k])
        };
        (0..3).any(|i| (0..3).any(|j| corner(a, i) == corner(b, j)))
    }
}

/// Owners of a chart's texels while it grows.
struct OwnerGrid {
    origin: [i64; 2],
    width: usize,
    owners: Vec<u32>,
}

impl OwnerGrid {
    fn covering(uvs: &Uvs, triangles: &[u32]) -> OwnerGrid {
        let (mut low, mut high) = ([i64::MAX; 2], [i64::MIN; 2]);
        for corner in triangles.iter().flat_map(|&triangle| uvs.fixed(triangle)) {
            for axis in 0..2 {
                low[axis] = low[axis].min(corner[axis].div_euclid(UNIT));
                high[axis] = high[axis].max(corner[axis].div_euclid(UNIT) + 1);
            }
        }
        let [width, height] = [0, 1].map(|axis| (high[axis] - low[axis]).max(0) as usize);
        OwnerGrid {
            origin: low,
            width,
            owners: vec![UNCLAIMED; width * height],
        }
    }

    fn place(&self, y: i64, x0: i64, x1: i64) -> std::ops::Range<usize> {
        let start = (y - self.origin[1]) as usize * self.width + (x0 - self.origin[0]) as usize;
        start..start + (x1 - x0) as usize
    }

    fn row(&self, y: i64, x0: i64, x1: i64) -> &[u32] {
        &self.owners[self.place(y, x0, x1)]
    }

    fn paint(&mut self, corners: [[i64; 2]; 3], owner: u32) {
        spans(corners, i64::MIN / 4..i64::MAX / 4, |y, x0, x1| {
            let place = self.place(y, x0, x1);
            self.owners[place].fill(owner);
        });
    }
}
