//! Oriented bounding box of a piece: the tightest of a few candidates.

use glam::{DMat3, DVec3, Vec3};

use super::PieceBox;
use super::moments::{FourfoldSymmetry, Moments};
use crate::model::Mesh;

/// Ratio of lengths or areas below which they count as equal, so that rounding does not swap axes.
const SLACK: f64 = 1.02;

/// The box of a piece, given by its triangles.
pub(super) fn piece_box(mesh: &Mesh, triangles: &[u32]) -> PieceBox {
    let place = |vertex: u32| Vec3::from(mesh.positions[vertex as usize]).as_dvec3();
    let origin = triangles
        .first()
        .map_or(DVec3::ZERO, |first| place(mesh.triangles[*first as usize][0]));
    let corners = |triangle: &u32| mesh.triangles[*triangle as usize].map(|vertex| place(vertex) - origin);
    let mut moments = Moments::default();
    for triangle in triangles {
        moments.add(corners(triangle));
    }
    let mut frames = vec![DMat3::IDENTITY];
    if let Some([spread, normals]) = moments.axes() {
        let mut symmetry = FourfoldSymmetry::new(spread.distinct());
        for triangle in triangles {
            symmetry.add(corners(triangle));
        }
        // Fourfold symmetry gives the best orientation; the moments are candidates for shapes without it.
        frames.extend(symmetry.axes());
        frames.extend([normals.directions, spread.directions]);
    }
    let mut extents = vec![FrameBounds::default(); frames.len()];
    for corner in triangles.iter().flat_map(corners) {
        for (frame, extent) in frames.iter().zip(&mut extents) {
            extent.take(frame.transpose_mul_vec3(corner));
        }
    }
    // A group may have no triangle at all.
    if triangles.is_empty() {
        extents[0].take(DVec3::ZERO);
    }
    let mut best = 0;
    for at in 1..frames.len() {
        if extents[at].face() * SLACK < extents[best].face() {
            best = at;
        }
    }
    let extent = extents[best];
    let frame = frames[best];
    let axes = ordered(frame, extent.size());
    let center = origin + frame * extent.middle();
    PieceBox {
        part: triangles.first().map_or(0, |first| mesh.triangle_part[*first as usize]),
        center: center.as_vec3().to_array(),
        axes: axes.map(|(axis, _)| axis.as_vec3().to_array()),
        size: axes.map(|(_, length)| length as f32),
    }
}

/// Lowest and highest coordinates in a frame.
#[derive(Clone, Copy)]
struct FrameBounds {
    low: DVec3,
    high: DVec3,
}

impl Default for FrameBounds {
    fn default() -> Self {
        FrameBounds {
            low: DVec3::INFINITY,
            high: DVec3::NEG_INFINITY,
        }
    }
}

impl FrameBounds {
    fn take(&mut self, at: DVec3) {
        self.low = self.low.min(at);
        self.high = self.high.max(at);
    }

    fn size(&self) -> DVec3 {
        self.high - self.low
    }

    fn middle(&self) -> DVec3 {
        (self.low + self.high) * 0.5
    }

    /// Returns half the surface area of the box. Unlike the volume, it distinguishes boxes around flat pieces.
    fn face(&self) -> f64 {
        let DVec3 { x, y, z } = self.size();
        x * y + y * z + z * x
    }
}

/// Returns axes and lengths in the order and with the signs that [`PieceBox`] describes.
fn ordered(frame: DMat3, size: DVec3) -> [(DVec3, f64); 3] {
    let mut left: Vec<(DVec3, f64)> = (0..3).map(|at| (frame.col(at), size[at])).collect();
    // The preferred directions are slightly off the model's axes, so that a rotation by 45° causes no tie.
    let mut take = |toward: DVec3| {
        let nearness = |axis: &(DVec3, f64)| axis.0.dot(toward).abs();
        let most = (1..left.len()).fold(0, |most, at| {
            if nearness(&left[at]) > nearness(&left[most]) {
                at
            } else {
                most
            }
        });
        left.remove(most)
    };
    let x = take(DVec3::new(1.0, 0.03, 0.009));
    let y = take(DVec3::new(0.009, 1.0, 0.03));
    let z = take(DVec3::new(0.03, 0.009, 1.0));
    let mut axes = [x, y, z];
    for (earlier, later) in [(0, 1), (1, 2), (0, 1)] {
        if axes[later].1 > SLACK * axes[earlier].1 {
            axes.swap(earlier, later);
        }
    }
    let [first, second] = [axes[0].0, axes[1].0].map(oriented);
    axes[0].0 = first;
    axes[1].0 = second;
    axes[2].0 = first.cross(second);
    axes
}

/// Returns the axis with the sign that makes its largest component positive. Of nearly equal components, the first decides.
fn oriented(axis: DVec3) -> DVec3 {
    let weighed = axis.abs() * DVec3::new(1.0, 0.97, 0.94);
    let largest = (1..3).fold(0, |most, at| if weighed[at] > weighed[most] { at } else { most });
    if axis[largest] < 0.0 { -axis } else { axis }
}
