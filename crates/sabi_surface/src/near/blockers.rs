//! A short list of triangles that are tested against a ray, eight at a time.

use glam::Vec3A;

/// Number of triangles in a row: wide enough for the vector units of any CPU. The compiler vectorizes the code.
const LANES: usize = 8;
/// Number of rows from which tracing a ray through the hierarchy is faster.
const MOST_ROWS: usize = 8;

/// Triangles that can stop rays, in scaled space.
#[derive(Default)]
pub(super) struct Blockers {
    rows: Vec<TriangleRow>,
    count: usize,
    counts: bool,
    is_overfull: bool,
}

/// For each triangle: the first corner, the edge from the second corner to the first, the edge from the first to the third,
/// and the cross product of both edges. Each component is stored for all triangles of the row. Zero for unused entries.
#[derive(Clone, Copy, Default)]
struct TriangleRow {
    corner: [[f32; LANES]; 3],
    one: [[f32; LANES]; 3],
    two: [[f32; LANES]; 3],
    normal: [[f32; LANES]; 3],
    numbers: [u32; LANES],
}

impl Blockers {
    pub(super) fn clear(&mut self) {
        self.rows.clear();
        self.count = 0;
        self.counts = false;
        self.is_overfull = false;
    }

    /// Resets, so that it is unknown which triangles can stop rays.
    pub(super) fn give_up(&mut self) {
        self.clear();
        self.counts = true;
        self.is_overfull = true;
    }

    /// Adds a triangle. `counts` is false if it stops a ray but its hits do not count.
    pub(super) fn add(&mut self, number: u32, [v0, v1, v2]: [Vec3A; 3], counts: bool) {
        self.counts |= counts;
        let lane = self.count % LANES;
        if lane == 0 {
            if self.rows.len() == MOST_ROWS {
                self.is_overfull = true;
            }
            if self.is_overfull {
                return;
            }
            self.rows.push(TriangleRow::default());
        }
        let Some(row) = self.rows.last_mut() else { return };
        let (one, two) = (v0 - v1, v2 - v0);
        let normal = one.cross(two);
        for axis in 0..3 {
            row.corner[axis][lane] = v0[axis];
            row.one[axis][lane] = one[axis];
            row.two[axis][lane] = two[axis];
            row.normal[axis][lane] = normal[axis];
        }
        row.numbers[lane] = number;
        self.count += 1;
    }

    /// Returns true if a hit on any of them counts.
    pub(super) fn any_counts(&self) -> bool {
        self.counts
    }

    /// Returns true if the list contains every triangle that can stop rays.
    pub(super) fn is_whole(&self) -> bool {
        !self.is_overfull
    }

    /// Returns the first hit of a ray: number and distance. If two triangles are at the same distance, the one added first is returned.
    pub(super) fn nearest(&self, origin: Vec3A, direction: Vec3A, reach: f32) -> Option<(u32, f32)> {
        let mut best = None;
        let mut within = reach;
        for row in &self.rows {
            let distances = row.distances(origin.to_array(), direction.to_array());
            for (distance, number) in distances.into_iter().zip(row.numbers) {
                if distance < within || (best.is_none() && distance == within) {
                    within = distance;
                    best = Some((number, distance));
                }
            }
        }
        best
    }
}

impl TriangleRow {
    /// Distance of each triangle along a ray; infinite where the ray misses it (Möller and Trumbore, 1997).
    fn distances(&self, [ox, oy, oz]: [f32; 3], [dx, dy, dz]: [f32; 3]) -> [f32; LANES] {
        let mut distances = [0.0; LANES];
        for lane in 0..LANES {
            let of = |rows: &[[f32; LANES]; 3]| (rows[0][lane], rows[1][lane], rows[2][lane]);
            let ((cx, cy, cz), (nx, ny, nz)) = (of(&self.corner), of(&self.normal));
            let ((ax, ay, az), (bx, by, bz)) = (of(&self.one), of(&self.two));
            let (x, y, z) = (cx - ox, cy - oy, cz - oz);
            let (sx, sy, sz) = (dy * z - dz * y, dz * x - dx * z, dx * y - dy * x);
            let inverse = 1.0 / (nx * dx + ny * dy + nz * dz);
            let u = (sx * bx + sy * by + sz * bz) * inverse;
            let v = (sx * ax + sy * ay + sz * az) * inverse;
            let distance = (nx * x + ny * y + nz * z) * inverse;
            // These comparisons are false for NaN, which results for a triangle without area or parallel to the ray.
            let is_hit = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (distance >= 0.0);
            distances[lane] = if is_hit { distance } else { f32::INFINITY };
        }
        distances
    }
}
