//! Triangles without area, which are never visible. Those that close the surface between other triangles are kept. The rest, such as
//! meshes that are scaled to nothing and lines that lead away from the surface, is removed, since it would affect bounds and charts.

use std::collections::BTreeSet;

use glam::{DMat4, DVec3, Vec3};

use super::name_lists::listed;
use super::submesh::{Submesh, retain};
use super::warnings::{TRIANGLES, Warnings, counted};

/// Maximum ratio of height to distance from the origin at which the height of a triangle with 64-bit positions is only a rounding error.
const NO_HEIGHT: f64 = 1e-12;

/// Maximum number of names in a sentence.
const MOST_NAMES: usize = 8;

/// Parts and triangles that were removed because they have no area.
#[derive(Default)]
pub(super) struct LeftOutAreas {
    parts: BTreeSet<String>,
    triangles: usize,
}

impl LeftOutAreas {
    /// Counts removed triangles of a part. `is_left` is true if the part has other triangles.
    pub(super) fn add(&mut self, triangles: usize, name: &str, is_left: bool) {
        if is_left {
            self.triangles += triangles;
        } else if triangles > 0 {
            self.parts.insert(name.to_owned());
        }
    }

    /// Adds a warning about everything that was removed.
    pub(super) fn tell(self, warnings: &mut Warnings) {
        if !self.parts.is_empty() {
            warnings.add(format!(
                "What has no area, such as a part that is scaled to nothing, is left out: {}.",
                listed(self.parts.iter().map(String::as_str), MOST_NAMES)
            ));
        }
        if self.triangles > 0 {
            warnings.add(format!(
                "{} without an area, away from the surface, had to be left out.",
                counted(self.triangles, TRIANGLES)
            ));
        }
    }
}

/// Returns the corners of the triangles with area, transformed by `world_from_mesh`.
pub(super) fn corners_with_area(submesh: &Submesh, world_from_mesh: DMat4) -> impl Iterator<Item = DVec3> {
    let place = move |vertex: u32| {
        let at = Vec3::from(submesh.positions[vertex as usize]).as_dvec3();
        world_from_mesh.transform_point3(submesh.origin + at)
    };
    let placed = submesh.triangles.iter().map(move |corners| corners.map(place));
    placed.filter(|corners| has_area(*corners, NO_HEIGHT)).flatten()
}

impl Submesh {
    /// Removes triangles without area, except for lines whose corners are also corners of triangles with area. Returns the
    /// number of triangles removed.
    pub(super) fn drop_arealess(&mut self) -> usize {
        let has_area: Vec<bool> = self.triangles.iter().map(|corners| self.has_area(*corners)).collect();
        if !has_area.contains(&false) {
            return 0;
        }
        let first_at = self.first_at_position();
        let mut is_on_surface = vec![false; first_at.len()];
        for (corners, _) in self.triangles.iter().zip(&has_area).filter(|(_, has_area)| **has_area) {
            for vertex in corners {
                is_on_surface[first_at[*vertex as usize] as usize] = true;
            }
        }
        let is_between = |corners: &[u32; 3]| {
            let mut corners = corners.iter();
            corners.all(|vertex| is_on_surface[first_at[*vertex as usize] as usize])
        };
        let kept = self.triangles.iter().zip(&has_area);
        let keep: Vec<bool> = kept
            .map(|(corners, has_area)| *has_area || is_between(corners))
            .collect();
        let before = self.triangles.len();
        self.retain_triangles(&keep);
        before - self.triangles.len()
    }

    /// Keeps some triangles, and the vertices that they use.
    pub(super) fn retain_triangles(&mut self, keep: &[bool]) {
        if keep.contains(&false) {
            retain(&mut self.triangles, keep);
            retain(&mut self.materials, keep);
            retain(&mut self.parts, keep);
            retain(&mut self.smoothing, keep);
        }
        self.drop_unused();
    }

    fn has_area(&self, corners: [u32; 3]) -> bool {
        let place = |vertex: u32| Vec3::from(self.positions[vertex as usize]).as_dvec3();
        has_area(corners.map(place), f64::from(f32::EPSILON))
    }
}

/// Returns true if the height of a triangle is larger than the rounding error of its positions, which is a share of their
/// distance from the origin. Returns false for NaN.
fn has_area([a, b, c]: [DVec3; 3], rounding: f64) -> bool {
    let reach = a.abs().max(b.abs()).max(c.abs()).max_element();
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    (b - a).cross(c - a).length() > longest * reach * rounding
}
