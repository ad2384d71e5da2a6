//! Rays from places close to each other. The triangles near these places are collected once, and for each place those that
//! its rays can hit. If there are none, the rays need not be traced; if there are few, they are tested one after the other,
//! which is faster than using the whole hierarchy.

mod blockers;
#[cfg(test)]
mod tests;

use glam::Vec3A;
use obvhs::triangle::Triangle;

use self::blockers::Blockers;
use crate::bvh::Bvh;

/// Bound for rounding errors of coordinates in scaled space, far above that of single precision.
const ROUNDING: f32 = 1e-3;

/// A ray from a place on the surface, model units.
#[derive(Clone, Copy, Debug)]
pub struct PlaceRay {
    /// Start.
    pub origin: [f32; 3],
    /// Unit direction.
    pub direction: [f32; 3],
    /// Length.
    pub reach: f32,
}

/// Triangles near the starts of some rays, in scaled space.
#[derive(Default)]
pub struct NearTriangles {
    numbers: Vec<u32>,
    found: Vec<NearTriangle>,
}

#[derive(Clone, Copy)]
struct NearTriangle {
    number: u32,
    corners: [Vec3A; 3],
    low: Vec3A,
    high: Vec3A,
    /// Of unit length; zero for a triangle without area.
    normal: Vec3A,
}

impl NearTriangle {
    fn of(bvh: &Bvh, number: u32) -> Option<NearTriangle> {
        let Triangle { v0, v1, v2 } = *bvh.scaled_triangle(number)?;
        Some(NearTriangle {
            number,
            corners: [v0, v1, v2],
            low: v0.min(v1).min(v2),
            high: v0.max(v1).max(v2),
            normal: (v1 - v0).cross(v2 - v0).normalize_or_zero(),
        })
    }

    /// Returns true if no point of the triangle is within a distance of a place.
    fn is_beyond(&self, place: Vec3A, distance: f32) -> bool {
        let outside = (self.low - place).max(place - self.high).max(Vec3A::ZERO);
        let over = (place - self.corners[0]).dot(self.normal).abs();
        outside.length_squared() > distance * distance || over > distance
    }
}

/// Bounding box of the starts of rays, in scaled space, and the length of the longest ray.
struct Starts {
    low: Vec3A,
    high: Vec3A,
    reach: f32,
}

impl Starts {
    const NONE: Starts = Starts {
        low: Vec3A::INFINITY,
        high: Vec3A::NEG_INFINITY,
        reach: 0.0,
    };

    /// Adds the start of a ray and its length.
    fn add(&mut self, origin: Vec3A, reach: f32) {
        self.low = self.low.min(origin);
        self.high = self.high.max(origin);
        self.reach = self.reach.max(reach);
    }

    /// Returns half the diagonal of the box plus the length of the longest ray.
    fn range(&self) -> f32 {
        0.5 * (self.high - self.low).length() + self.reach + ROUNDING
    }
}

impl NearTriangles {
    /// Finds all triangles that some rays can hit, possibly with others near them. Returns false if there are more than `most`.
    pub fn find(&mut self, bvh: &Bvh, rays: impl Iterator<Item = PlaceRay>, most: usize) -> bool {
        self.found.clear();
        self.numbers.clear();
        let mut starts = Starts::NONE;
        for ray in rays {
            starts.add(bvh.to_scaled(ray.origin), bvh.scaled_length(ray.reach));
        }
        if starts.reach <= 0.0 {
            return true;
        }
        if bvh.tree().nodes.is_empty() || !starts.reach.is_finite() {
            return false;
        }
        let around = Vec3A::splat(starts.reach + ROUNDING);
        let (low, high) = (starts.low - around, starts.high + around);
        let mut open = vec![0_u32];
        while let Some(index) = open.pop() {
            let node = &bvh.tree().nodes[index as usize];
            for child in (0..8).filter(|&child| !node.is_child_empty(child)) {
                let own = node.child_aabb(child);
                if own.min.cmpgt(high).any() || own.max.cmplt(low).any() {
                    continue;
                }
                if !node.is_leaf(child) {
                    open.push(node.child_node_index(child));
                    continue;
                }
                let (first, count) = node.child_primitives(child);
                let numbers = &bvh.tree().primitive_indices[first as usize..(first + count) as usize];
                self.numbers.extend_from_slice(numbers);
                if self.numbers.len() > most {
                    return false;
                }
            }
        }
        let found = self.numbers.iter().filter_map(|&number| NearTriangle::of(bvh, number));
        self.found.extend(found);
        true
    }
}

/// Triangles that the rays of a place can hit, separately for both sides of its triangle.
#[derive(Default)]
pub struct Surroundings {
    normal: Vec3A,
    above: Blockers,
    below: Blockers,
}

/// What is known about a ray after the surroundings of its place were examined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// The ray hits nothing, or nothing that counts.
    Miss,
    /// The first hit: the triangle, and the distance in model units.
    Hit(u32, f32),
    /// Nothing is known: the ray has to be traced through the hierarchy.
    Nothing,
}

impl Surroundings {
    /// Examines the surroundings of a place on `triangle` from which some rays start. Hits on triangles that are turned by
    /// less than `least_turn` (radians) against it do not count.
    pub fn look(
        &mut self,
        bvh: &Bvh,
        near: &NearTriangles,
        triangle: u32,
        rays: impl Iterator<Item = PlaceRay>,
        least_turn: Option<f32>,
    ) {
        let normal_of = |plane: &Triangle| (plane.v1 - plane.v0).cross(plane.v2 - plane.v0).try_normalize();
        let plane = bvh.scaled_triangle(triangle);
        let Some((triangle, normal)) = plane.and_then(|plane| Some((plane, normal_of(plane)?))) else {
            // A triangle without area has no sides.
            self.give_up();
            return;
        };
        self.above.clear();
        self.below.clear();
        self.normal = normal;
        let height = |point: Vec3A| (point - triangle.v0).dot(self.normal);
        let (mut lowest_up, mut highest_down) = (f32::INFINITY, f32::NEG_INFINITY);
        let mut starts = Starts::NONE;
        for ray in rays {
            let origin = bvh.to_scaled(ray.origin);
            starts.add(origin, bvh.scaled_length(ray.reach));
            let start = height(origin);
            if self.goes_up(ray) {
                lowest_up = lowest_up.min(start);
            } else {
                highest_down = highest_down.max(start);
            }
        }
        let (middle, range) = (0.5 * (starts.low + starts.high), starts.range());
        let most_alike = least_turn.map_or(f32::INFINITY, f32::cos);
        for other in near.found.iter().filter(|other| !other.is_beyond(middle, range)) {
            let [a, b, c] = other.corners.map(height);
            let counts = other.normal.dot(self.normal) <= most_alike;
            if a.max(b).max(c) > lowest_up {
                self.above.add(other.number, other.corners, counts);
            }
            if a.min(b).min(c) < highest_down {
                self.below.add(other.number, other.corners, counts);
            }
        }
    }

    /// Resets, so that nothing is known about any ray.
    pub fn give_up(&mut self) {
        self.above.give_up();
        self.below.give_up();
    }

    /// Finds the first hit of a ray of this place.
    pub fn closest(&self, bvh: &Bvh, ray: PlaceRay) -> Known {
        let side = if self.goes_up(ray) { &self.above } else { &self.below };
        if !side.any_counts() {
            return Known::Miss;
        }
        if !side.is_whole() {
            return Known::Nothing;
        }
        let Some(direction) = Vec3A::from_array(ray.direction).try_normalize() else {
            return Known::Miss;
        };
        let found = side.nearest(bvh.to_scaled(ray.origin), direction, bvh.scaled_length(ray.reach));
        found.map_or(Known::Miss, |(triangle, distance)| {
            Known::Hit(triangle, distance / bvh.scaled_from_model().1)
        })
    }

    /// Returns true if a ray leaves the plane upward, or is parallel to it.
    fn goes_up(&self, ray: PlaceRay) -> bool {
        Vec3A::from_array(ray.direction).dot(self.normal) >= 0.0
    }
}
