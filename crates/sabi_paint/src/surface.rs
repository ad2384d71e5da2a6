//! The surface that is painted on.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use glam::{DVec2, DVec3};
use sabi_surface::bvh::Bvh;
use sabi_surface::model::Mesh;
use sabi_surface::patch::{ConnectedMesh, Site, walk, weights_at};

use crate::brush_limits::Eye;
use crate::index::SurfaceIndex;
use crate::pen::{Shaft, Touch};
use crate::stroke::StrokePoint;

/// Minimum length of the upward direction along the surface with which a decal is upright; flatter places count as level.
const LEAST_UPRIGHT: f64 = 0.05;
/// Minimum cosine between the normal of a point and that of the triangle to which it may move.
const LEAST_COSINE: f64 = 0.3;

/// A mesh prepared for the brush: with connections, and with triangles that can be identified by their content.
pub struct PaintSurface<'a> {
    mesh: &'a Mesh,
    index: &'a SurfaceIndex,
    by_key: OnceLock<BTreeMap<u32, u32>>,
    stop: Option<&'a StopCheck<'a>>,
}

/// Function that is called many times while strokes are painted. If it returns true, the work ends early, and its result must not be used.
pub type StopCheck<'a> = dyn Fn() -> bool + Sync + 'a;

impl<'a> PaintSurface<'a> {
    /// Creates the surface of a mesh from the mesh's index.
    pub fn new(mesh: &'a Mesh, index: &'a SurfaceIndex) -> PaintSurface<'a> {
        PaintSurface {
            mesh,
            index,
            by_key: OnceLock::new(),
            stop: None,
        }
    }

    /// Returns the surface for work that can be stopped, since strokes may have millions of points.
    #[must_use]
    pub fn stopped_by(self, stop: &'a StopCheck<'a>) -> PaintSurface<'a> {
        PaintSurface {
            stop: Some(stop),
            ..self
        }
    }

    /// Returns true if the work should end.
    pub fn is_stopped(&self) -> bool {
        self.stop.is_some_and(|stop| stop())
    }

    /// The mesh with its connections.
    pub fn connected(&self) -> ConnectedMesh<'_> {
        ConnectedMesh {
            mesh: self.mesh,
            topology: &self.index.topology,
        }
    }

    pub(crate) fn index(&self) -> &'a SurfaceIndex {
        self.index
    }

    /// Returns the hierarchy for rays. It is created for the first stroke that needs it.
    pub(crate) fn bvh(&self) -> &'a Bvh {
        self.index.bvh.get_or_init(|| Bvh::build(self.mesh))
    }

    /// Returns the unit shading normal at a place of a triangle, given by the weights of its second and third corner.
    pub(crate) fn smooth_normal(&self, triangle: u32, weights: DVec2) -> DVec3 {
        let shares = [1.0 - weights.x - weights.y, weights.x, weights.y];
        let corners = self.mesh.triangles[triangle as usize].into_iter().zip(shares);
        let normal = |vertex: u32| DVec3::from(self.mesh.normals[vertex as usize].map(f64::from));
        corners
            .map(|(vertex, share)| share * normal(vertex))
            .sum::<DVec3>()
            .normalize_or_zero()
    }

    /// Returns the weights of the second and the third corner of a site's triangle there; those of the middle for a triangle without area.
    pub(crate) fn weights(&self, site: Site) -> DVec2 {
        let weights = weights_at(self.connected().corners(site.triangle), site.position);
        weights
            .filter(|weights| weights.is_finite())
            .unwrap_or(DVec2::splat(1.0 / 3.0)) // The middle of the triangle.
    }

    /// Returns the unit shading normal at a site, or the normal of the triangle if there is no shading normal.
    pub(crate) fn smooth_normal_at(&self, site: Site) -> DVec3 {
        let normal = self.smooth_normal(site.triangle, self.weights(site));
        if normal == DVec3::ZERO {
            self.connected().normal(site.triangle)
        } else {
            normal
        }
    }

    /// Returns the unit normal of the surface around a site: the mean, weighted by area, of the triangles near it that do
    /// not face away. If they cancel out, returns the normal of the site.
    pub(crate) fn broad_normal(&self, site: Site, radius: f64) -> DVec3 {
        let own = self.smooth_normal_at(site);
        let mut near = Vec::new();
        self.index
            .near(site.position - radius, site.position + radius, &mut near);
        let normals = near.into_iter().filter_map(|triangle| {
            let [a, b, c] = self.connected().corners(triangle);
            // The length of this normal is twice the area.
            let normal = (b - a).cross(c - a);
            let is_near = self
                .connected()
                .nearest_in(triangle, site.position)
                .distance(site.position)
                <= radius;
            (is_near && normal.dot(own) > 0.0).then_some(normal)
        });
        normals.sum::<DVec3>().try_normalize().unwrap_or(own) // The normals cancel out.
    }

    /// Returns the nearest place within a distance that faces the same way.
    pub(crate) fn nearest(&self, from: DVec3, normal: DVec3, tolerance: f64) -> Option<Site> {
        let mut near = Vec::new();
        self.index.near(from - tolerance, from + tolerance, &mut near);
        let mut best: Option<(f64, Site)> = None;
        for triangle in near {
            if self.connected().normal(triangle).dot(normal) < LEAST_COSINE {
                continue;
            }
            let position = self.connected().nearest_in(triangle, from);
            let distance = position.distance(from);
            if distance <= tolerance && best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, Site { triangle, position }));
            }
        }
        best.map(|(_, site)| site)
    }

    /// The mesh.
    pub fn mesh(&self) -> &'a Mesh {
        self.mesh
    }

    /// Returns a hash of the corners of a triangle, by which it is found again if the triangles of a model are renumbered.
    pub fn triangle_key(&self, triangle: u32) -> u32 {
        let mut hash = blake3::Hasher::new();
        for vertex in self.mesh.triangles[triangle as usize] {
            // Adding 0 turns −0 into 0.
            let position = self.mesh.positions[vertex as usize].map(|value| (value + 0.0).to_le_bytes());
            hash.update(position.as_flattened());
        }
        let bytes = hash.finalize();
        u32::from_le_bytes([0, 1, 2, 3].map(|index| bytes.as_bytes()[index]))
    }

    /// Returns a triangle with that content, if there is one.
    pub(crate) fn triangle_of_key(&self, key: u32) -> Option<u32> {
        let by_key = self.by_key.get_or_init(|| {
            let triangles = 0..self.mesh.triangles.len() as u32;
            // If several have the same content, the first is used.
            triangles
                .rev()
                .map(|triangle| (self.triangle_key(triangle), triangle))
                .collect()
        });
        by_key.get(&key).copied()
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.mesh.triangles.len()
    }

    /// Returns the point, with its touch, at which a walk from another point toward a position in space ends.
    pub fn led(&self, from: &StrokePoint, to: DVec3) -> Option<StrokePoint> {
        self.point(walk(self.connected(), from.site, to), from.touch(), false)
    }

    /// Returns the point of a stroke at a site, with the data by which it is found again; `None` if the mesh has no such
    /// triangle or the position is not finite.
    pub fn point(&self, site: Site, touch: impl Into<Touch>, starts: bool) -> Option<StrokePoint> {
        let Touch { pressure, shaft } = touch.into().bounded();
        let is_there = (site.triangle as usize) < self.triangle_count() && site.position.is_finite();
        is_there.then(|| StrokePoint {
            site,
            normal: self.connected().normal(site.triangle).as_vec3().to_array(),
            triangle_key: self.triangle_key(site.triangle),
            pressure,
            starts,
            shaft,
        })
    }

    /// Returns the shaft of a pen at a site that leans by an angle toward a direction in space; upright if that direction
    /// has no component along the surface.
    pub fn shaft(&self, site: Site, toward: DVec3, angle_degrees: f32) -> Option<Shaft> {
        let is_there = (site.triangle as usize) < self.triangle_count() && site.position.is_finite();
        let normal = is_there.then(|| self.smooth_normal_at(site))?;
        let along = (toward - toward.dot(normal) * normal).normalize_or_zero();
        let angle_degrees = if along == DVec3::ZERO { 0.0 } else { angle_degrees };
        Shaft::leaning(normal, along, angle_degrees)
    }
}

/// Returns the directions to the right and upward on a decal at a point of a surface, of unit length: for a person in front
/// of the surface, or behind it if the eye sees its back, so that writing can be read from where it was laid.
pub fn decal_axes(point: &StrokePoint, normal: DVec3, eye: Option<Eye>) -> [DVec3; 2] {
    let of_triangle = DVec3::from(point.normal.map(f64::from));
    let is_behind = eye.is_some_and(|eye| eye.sees_back(point.site.position, of_triangle));
    let toward_eye = if is_behind { -normal } else { normal };
    let right = rightward(toward_eye);
    [right, toward_eye.cross(right)]
}

/// Returns the direction to the right for a person who stands in front of a surface, given by its unit normal; for a level
/// surface, that of a person in front of the model. A decal whose brush is not rotated is upright in this sense.
pub fn rightward(normal: DVec3) -> DVec3 {
    let upward = DVec3::Y - normal.y * normal;
    let upward = if upward.length() < LEAST_UPRIGHT {
        DVec3::new(0.0, 0.0, -normal.y)
    } else {
        upward
    };
    upward.cross(normal).normalize_or_zero()
}
