//! Data about a mesh that a brush needs: connections, pieces, and the triangles near a place.

use std::sync::OnceLock;

use glam::DVec3;
use sabi_surface::bvh::Bvh;
use sabi_surface::model::Mesh;
use sabi_surface::{Groups, NO_TWIN, Topology};

/// Maximum number of cells along a side of the grid.
const SIDE_LIMIT: usize = 96;

/// Connections, pieces and a grid over the triangles of a mesh. Created once for a model.
pub struct SurfaceIndex {
    pub(crate) topology: Topology,
    /// Connected piece of each triangle.
    pub(crate) pieces: Vec<u32>,
    /// Number of pieces.
    pub(crate) piece_count: u32,
    low: DVec3,
    high: DVec3,
    cell: f64,
    counts: [usize; 3],
    /// Triangles whose boxes touch each cell.
    triangles: Groups,
    /// Hierarchy for rays, created for the first stroke that needs it.
    pub(crate) bvh: OnceLock<Bvh>,
}

impl SurfaceIndex {
    /// Indexes a mesh.
    pub fn new(mesh: &Mesh) -> SurfaceIndex {
        let topology = Topology::new(mesh);
        let (pieces, piece_count) = pieces_of(mesh, &topology);
        let boxes: Vec<[DVec3; 2]> = (0..mesh.triangles.len() as u32)
            .map(|triangle| box_of(mesh, triangle))
            .collect();
        let finite = || boxes.iter().filter(|[low, high]| low.is_finite() && high.is_finite());
        let low = finite().map(|[low, _]| *low).fold(DVec3::INFINITY, DVec3::min);
        let high = finite().map(|[_, high]| *high).fold(DVec3::NEG_INFINITY, DVec3::max);
        let extent = high - low;
        let side = extent.max_element();
        // This gives about two cells for each triangle if the model fills its box.
        let along = (mesh.triangles.len() as f64).sqrt().clamp(1.0, SIDE_LIMIT as f64);
        let cell = if side.is_finite() && side > 0.0 {
            side / along
        } else {
            1.0
        };
        let count = |extent: f64| {
            if extent.is_finite() {
                (extent / cell) as usize + 1
            } else {
                1
            }
        };
        let mut index = SurfaceIndex {
            topology,
            pieces,
            piece_count,
            low: if low.is_finite() { low } else { DVec3::ZERO },
            high: if high.is_finite() { high } else { DVec3::ZERO },
            cell,
            counts: [count(extent.x), count(extent.y), count(extent.z)],
            triangles: Groups::of_each(&[], 0),
            bvh: OnceLock::new(),
        };
        let cells = index.counts.iter().product();
        index.triangles = Groups::new(cells, |member| {
            for (triangle, [low, high]) in boxes.iter().enumerate() {
                index.cells(*low, *high, |cell| member(cell, triangle as u32));
            }
        });
        index
    }

    /// Calls `visit` for the cells that a box touches. Calls it for no cell if the box is not finite.
    fn cells(&self, low: DVec3, high: DVec3, mut visit: impl FnMut(usize)) {
        if !(low.is_finite() && high.is_finite()) {
            return;
        }
        let place = |at: DVec3| ((at - self.low) / self.cell).max(DVec3::ZERO);
        let (first, last) = (place(low), place(high));
        let range = |axis: usize| {
            let most = self.counts[axis] - 1;
            (first[axis] as usize).min(most)..=(last[axis] as usize).min(most)
        };
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    visit((z * self.counts[1] + y) * self.counts[0] + x);
                }
            }
        }
    }

    /// Middle of the box of the mesh.
    pub(crate) fn middle(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }

    /// Finds the triangles whose boxes may touch a box, in ascending order without repeats.
    pub(crate) fn near(&self, low: DVec3, high: DVec3, found: &mut Vec<u32>) {
        found.clear();
        self.cells(low, high, |cell| found.extend_from_slice(self.triangles.members(cell)));
        found.sort_unstable();
        found.dedup();
    }
}

fn box_of(mesh: &Mesh, triangle: u32) -> [DVec3; 2] {
    let [a, b, c] = mesh.corners(triangle);
    [a.min(b).min(c), a.max(b).max(c)]
}

/// Returns the connected piece of each triangle, numbered in the order of their first triangles, and the number of pieces.
/// Unlike in [`sabi_surface::pieces::Pieces`], a piece continues across welded parts, as strokes do.
fn pieces_of(mesh: &Mesh, topology: &Topology) -> (Vec<u32>, u32) {
    const UNKNOWN: u32 = u32::MAX;
    let mut pieces = vec![UNKNOWN; mesh.triangles.len()];
    let mut count = 0;
    let mut open = Vec::new();
    for first in 0..mesh.triangles.len() as u32 {
        if pieces[first as usize] != UNKNOWN {
            continue;
        }
        open.push(first);
        pieces[first as usize] = count;
        while let Some(triangle) = open.pop() {
            for edge in 0..3 {
                let twin = topology.twins[3 * triangle as usize + edge];
                if twin != NO_TWIN && pieces[twin as usize / 3] == UNKNOWN {
                    pieces[twin as usize / 3] = count;
                    open.push(twin / 3);
                }
            }
        }
        count += 1;
    }
    (pieces, count)
}
