//! A tree of two boxes a node, split where the surface area heuristic wants it, of sixteen places along each axis.

use glam::Vec3;

const BINS: usize = 16;
const LEAF: usize = 4;

/// Rows as `bvh2.wgsl` reads them.
#[derive(Default)]
pub(crate) struct Bvh2 {
    pub(crate) nodes: Vec<[f32; 4]>,
    pub(crate) triangles: Vec<[[f32; 4]; 3]>,
}

#[derive(Clone, Copy)]
struct Bounds {
    low: Vec3,
    high: Vec3,
}

impl Bounds {
    const NONE: Bounds = Bounds {
        low: Vec3::INFINITY,
        high: Vec3::NEG_INFINITY,
    };

    fn with(self, point: Vec3) -> Bounds {
        Bounds {
            low: self.low.min(point),
            high: self.high.max(point),
        }
    }

    fn and(self, other: Bounds) -> Bounds {
        self.with(other.low).with(other.high)
    }

    fn area(self) -> f32 {
        let d = (self.high - self.low).max(Vec3::ZERO);
        d.x * d.y + d.y * d.z + d.z * d.x
    }
}

struct Item {
    corners: [Vec3; 3],
    bounds: Bounds,
    center: Vec3,
}

impl Bvh2 {
    pub(crate) fn build(triangles: &[[Vec3; 3]]) -> Bvh2 {
        let item = |corners: &[Vec3; 3]| {
            let bounds = corners.iter().fold(Bounds::NONE, |bounds, corner| bounds.with(*corner));
            Item {
                corners: *corners,
                bounds,
                center: (bounds.low + bounds.high) * 0.5,
            }
        };
        let mut items: Vec<Item> = triangles.iter().map(item).collect();
        let mut bvh = Bvh2::default();
        bvh.node(&mut items);
        bvh
    }

    /// Adds a node for more triangles than fit into a leaf, and returns its number.
    fn node(&mut self, items: &mut [Item]) -> usize {
        let index = self.nodes.len() / 4;
        self.nodes.extend([[0.0; 4]; 4]);
        let middle = split(items);
        let (left, right) = items.split_at_mut(middle);
        for (side, items) in [left, right].into_iter().enumerate() {
            let bounds = items.iter().fold(Bounds::NONE, |bounds, item| bounds.and(item.bounds));
            let count = if items.len() <= LEAF { items.len() } else { 0 };
            let reference = if count > 0 { self.leaf(items) } else { self.node(items) };
            let [low, high] = [bounds.low, bounds.high];
            self.nodes[4 * index + 2 * side] = [low.x, low.y, low.z, f32::from_bits(reference as u32)];
            self.nodes[4 * index + 2 * side + 1] = [high.x, high.y, high.z, f32::from_bits(count as u32)];
        }
        index
    }

    fn leaf(&mut self, items: &[Item]) -> usize {
        let first = self.triangles.len();
        self.triangles.extend(items.iter().map(|item| {
            let [a, b, c] = item.corners;
            [a, b - a, c - a].map(|v| [v.x, v.y, v.z, 0.0])
        }));
        first
    }
}

/// Sorts items so that the best split is at the returned index.
fn split(items: &mut [Item]) -> usize {
    let around = items.iter().fold(Bounds::NONE, |bounds, item| bounds.with(item.center));
    let mut best = (f32::INFINITY, 0, 0.0);
    for axis in 0..3 {
        let (low, high) = (around.low[axis], around.high[axis]);
        if high <= low {
            continue;
        }
        let mut bins = [(Bounds::NONE, 0_usize); BINS];
        for item in items.iter() {
            let bin = (((item.center[axis] - low) / (high - low) * BINS as f32) as usize).min(BINS - 1);
            bins[bin] = (bins[bin].0.and(item.bounds), bins[bin].1 + 1);
        }
        for at in 1..BINS {
            let side = |bins: &[(Bounds, usize)]| {
                let (bounds, count) = bins.iter().fold((Bounds::NONE, 0), |(bounds, count), bin| {
                    (bounds.and(bin.0), count + bin.1)
                });
                if count == 0 {
                    f32::INFINITY
                } else {
                    bounds.area() * count as f32
                }
            };
            let cost = side(&bins[..at]) + side(&bins[at..]);
            if cost < best.0 {
                best = (cost, axis, low + (high - low) * at as f32 / BINS as f32);
            }
        }
    }
    let (cost, axis, place) = best;
    if cost.is_infinite() {
        return items.len() / 2;
    }
    items.sort_by(|one, other| one.center[axis].total_cmp(&other.center[axis]));
    items
        .partition_point(|item| item.center[axis] < place)
        .clamp(1, items.len() - 1)
}
