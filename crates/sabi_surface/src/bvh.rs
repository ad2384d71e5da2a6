//! Ray casting: an eight-way compressed bounding volume hierarchy over the triangles.

use glam::{DVec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;

use crate::model::Mesh;

#[cfg(test)]
mod tests;

/// Diagonal of the scaled scene. obvhs misses boxes that end nearer than 1e-4, so a larger scene misses fewer hits. Its
/// debug assertions allow an error of 1e-5 for boxes, ten times the rounding error at this size.
const SCALED_DIAGONAL: f64 = 32.0;

/// A bounding volume hierarchy of a mesh, scaled to a size at which single precision is accurate.
pub struct Bvh {
    tree: CwBvh,
    triangles: Vec<Triangle>,
    center: Vec3A,
    scale: f32,
}

/// Intersection of a ray with a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Triangle number in the mesh.
    pub triangle: u32,
    /// Distance from the ray's origin, model units.
    pub distance: f32,
    /// Barycentric coordinates of the point: weights of the triangle's corners, together 1.
    pub barycentric: [f32; 3],
}

impl Bvh {
    /// Builds the hierarchy, the same for the same mesh.
    pub fn build(mesh: &Mesh) -> Bvh {
        // NaN positions are moved to the center: the triangle then has no area, and no ray hits it.
        let corner = |vertex: u32| {
            let position = mesh
                .positions
                .get(vertex as usize)
                .map(|position| DVec3::from(position.map(f64::from)));
            position.filter(|position| position.is_finite())
        };
        let found = mesh.triangles.iter().flatten().filter_map(|&vertex| corner(vertex));
        let (low, high) = found.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), position| {
            (low.min(position), high.max(position))
        });
        let diagonal = (high - low).length();
        let (center, scale) = if diagonal.is_finite() && diagonal > 0.0 {
            ((low + high) * 0.5, SCALED_DIAGONAL / diagonal)
        } else {
            (DVec3::ZERO, 1.0)
        };
        let scaled = |triangle: &[u32; 3]| {
            let corners = triangle.map(|vertex| corner(vertex).map(|at| ((at - center) * scale).as_vec3a()));
            match corners {
                [Some(v0), Some(v1), Some(v2)] => Triangle { v0, v1, v2 },
                _ => Triangle::default(),
            }
        };
        let triangles: Vec<Triangle> = mesh.triangles.iter().map(scaled).collect();
        let tree = if triangles.is_empty() {
            CwBvh::default()
        } else {
            build_cwbvh_from_tris(
                &triangles,
                BvhBuildParams::medium_build(),
                &mut std::time::Duration::default(),
            )
        };
        Bvh {
            tree,
            triangles,
            center: center.as_vec3a(),
            scale: scale as f32,
        }
    }

    /// Returns the nearest intersection of a ray within `max` model units. `direction` need not have unit length.
    pub fn closest(&self, origin: [f32; 3], direction: [f32; 3], max: f32) -> Option<Hit> {
        let ray = self.scaled(origin, direction, max)?;
        let mut hit = RayHit::none();
        let is_hit = self
            .tree
            .ray_traverse(ray, &mut hit, |ray, id| self.triangle(id).intersect(ray));
        if !is_hit {
            return None;
        }
        let triangle = *self.tree.primitive_indices.get(hit.primitive_id as usize)?;
        let barycentric = barycentric(&self.triangles[triangle as usize], ray.origin + ray.direction * hit.t);
        Some(Hit {
            triangle,
            distance: hit.t / self.scale,
            barycentric,
        })
    }

    /// Returns true if a ray hits anything within `max` model units. `direction` need not have unit length.
    pub fn any(&self, origin: [f32; 3], direction: [f32; 3], max: f32) -> bool {
        self.scaled(origin, direction, max).is_some_and(|ray| {
            !self
                .tree
                .ray_traverse_miss(ray, |ray, id| self.triangle(id).intersect(ray))
        })
    }

    /// Returns true if a ray hits, within `max` model units, a triangle for whose number `counts` returns true.
    pub fn any_of(&self, origin: [f32; 3], direction: [f32; 3], max: f32, counts: impl Fn(u32) -> bool) -> bool {
        self.scaled(origin, direction, max).is_some_and(|ray| {
            !self.tree.ray_traverse_miss(ray, |ray, id| {
                let triangle = self.tree.primitive_indices[id];
                if counts(triangle) {
                    self.triangles[triangle as usize].intersect(ray)
                } else {
                    f32::INFINITY
                }
            })
        })
    }

    /// Counts the triangles that an endless ray crosses, considering only those for whose number `counts` returns true.
    pub(crate) fn crossed(&self, origin: [f32; 3], direction: [f32; 3], counts: impl Fn(u32) -> bool) -> u32 {
        let mut crossed = 0;
        if let Some(ray) = self.scaled(origin, direction, f32::INFINITY) {
            self.tree.ray_traverse_anyhit(ray, |ray, id| {
                let triangle = self.tree.primitive_indices[id];
                let is_hit = || self.triangles[triangle as usize].intersect(ray).is_finite();
                crossed += u32::from(counts(triangle) && is_hit());
            });
        }
        crossed
    }

    /// Returns the hierarchy in scaled space. Its `primitive_indices` lead to triangles of the mesh.
    pub fn tree(&self) -> &CwBvh {
        &self.tree
    }

    /// Returns center and scale of the map from model space to scaled space: `(position − center) × scale`.
    pub fn scaled_from_model(&self) -> ([f32; 3], f32) {
        (self.center.to_array(), self.scale)
    }

    /// Returns the triangles in the order of the tree and in scaled space, as three rows each: the first corner, with the triangle's
    /// number as a bit pattern; the edge from the second corner to the first; the edge from the first to the third.
    pub fn scaled_triangle_rows(&self) -> Vec<[[f32; 4]; 3]> {
        let rows = |number: &u32| {
            let Triangle { v0, v1, v2 } = self.triangles[*number as usize];
            [(v0, f32::from_bits(*number)), (v0 - v1, 0.0), (v2 - v0, 0.0)].map(|(v, last)| [v.x, v.y, v.z, last])
        };
        self.tree.primitive_indices.iter().map(rows).collect()
    }

    /// Levels of the hierarchy; 0 without triangles.
    pub fn depth(&self) -> usize {
        let mut deepest = 0;
        let mut open: Vec<(u32, usize)> = self.tree.nodes.first().map(|_| (0, 1)).into_iter().collect();
        while let Some((node, depth)) = open.pop() {
            deepest = deepest.max(depth);
            let node = &self.tree.nodes[node as usize];
            let children = (0..8).filter(|&child| !node.is_leaf(child));
            open.extend(children.map(|child| (node.child_node_index(child), depth + 1)));
        }
        deepest
    }

    /// A triangle of the mesh, in scaled space.
    pub(crate) fn scaled_triangle(&self, number: u32) -> Option<&Triangle> {
        self.triangles.get(number as usize)
    }

    /// Converts a point from model space to scaled space.
    pub(crate) fn to_scaled(&self, point: [f32; 3]) -> Vec3A {
        (Vec3A::from_array(point) - self.center) * self.scale
    }

    /// Converts a length from model space to scaled space.
    pub(crate) fn scaled_length(&self, length: f32) -> f32 {
        length * self.scale
    }

    fn triangle(&self, primitive: usize) -> &Triangle {
        &self.triangles[self.tree.primitive_indices[primitive] as usize]
    }

    /// Returns the ray in scaled space; `None` if it has no direction or no length.
    fn scaled(&self, origin: [f32; 3], direction: [f32; 3], max: f32) -> Option<Ray> {
        let direction = Vec3A::from_array(direction).try_normalize()?;
        let origin = (Vec3A::from_array(origin) - self.center) * self.scale;
        if self.triangles.is_empty() || !origin.is_finite() || max.is_nan() || max <= 0.0 {
            return None;
        }
        // Adding 0 converts −0 to 0: obvhs treats −0 as negative in one place and not in another, and would miss everything.
        Some(Ray::new(origin, direction + Vec3A::ZERO, 0.0, max * self.scale))
    }
}

/// Returns the barycentric coordinates of a point in the plane of a triangle.
fn barycentric(triangle: &Triangle, point: Vec3A) -> [f32; 3] {
    let (u, v) = (triangle.v1 - triangle.v0, triangle.v2 - triangle.v0);
    let normal = u.cross(v);
    let square = normal.length_squared();
    if square <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let offset = point - triangle.v0;
    let of_1 = offset.cross(v).dot(normal) / square;
    let of_2 = u.cross(offset).dot(normal) / square;
    [1.0 - of_1 - of_2, of_1, of_2]
}
