//! Pieces of a model: connected triangles of a part, each with an oriented box.
//!
//! A bench in one mesh is one part with many pieces, one for each plank. `connect` finds connected triangles, `tightest`
//! the box, and `moments` candidates for its axes.

mod connect;
mod moments;
#[cfg(test)]
mod tests;
mod tightest;

use glam::Vec3;
use rayon::prelude::*;
use sabi_cancel::Cancel;

use crate::atlas::topology::Topology;
use crate::groups::Groups;
use crate::model::Mesh;

/// The connected pieces of a mesh, numbered by their first triangle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pieces {
    /// Piece of each triangle, an index into [`Pieces::boxes`].
    pub triangle_piece: Vec<u32>,
    /// The box of each piece.
    pub boxes: Vec<PieceBox>,
    /// Mean of the typical sizes of the pieces, weighted by area, in model units; 1 for a mesh without area.
    pub mean_size: f64,
}

/// Oriented bounding box of a piece.
///
/// Pieces that differ only by a rotation have equal boxes, as far as their shape distinguishes the axes. Sides whose lengths differ by
/// less than 2 % are ordered by the model axes to which they are nearest, and the largest component of the first two axes is positive. If
/// no rotated box is at least 2 % smaller than the axis-aligned one, as for a cube or a ball, the axis-aligned box is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PieceBox {
    /// Part that the piece belongs to, an index into [`crate::model::Model::parts`].
    pub part: u32,
    /// Middle of the box, model units.
    pub center: [f32; 3],
    /// Directions of the sides in model space, longest side first: unit length, right-handed.
    pub axes: [[f32; 3]; 3],
    /// Lengths of the sides, model units.
    pub size: [f32; 3],
}

impl PieceBox {
    /// Returns the size of a piece for lengths that are shares of it, in model units: the side of a cube with the volume of its box. A box
    /// thinner than a quarter of its width counts as that thick, since the scale of detail on a thin sheet depends on its width.
    pub fn typical_size(&self) -> f32 {
        let [length, width, thickness] = self.size;
        let volume = length * width * thickness.max(0.25 * width);
        if volume > 0.0 { volume.cbrt() } else { length }
    }
}

impl Pieces {
    /// Finds the pieces of a mesh. Its triangles refer to existing vertices and have a part each.
    ///
    /// Triangles that share an edge in space belong to one piece if they belong to one part. Solids that only touch stay
    /// separate, even if their edges coincide.
    pub fn of(mesh: &Mesh) -> Pieces {
        let triangle_piece = connect::triangle_pieces(mesh, &Topology::new(mesh));
        let count = triangle_piece.iter().max().map_or(0, |last| *last as usize + 1);
        let boxes = boxes(mesh, &triangle_piece, count);
        let mean_size = mean_size(mesh, &triangle_piece, &boxes);
        Pieces {
            triangle_piece,
            boxes,
            mean_size,
        }
    }
}

fn mean_size(mesh: &Mesh, triangle_piece: &[u32], boxes: &[PieceBox]) -> f64 {
    let (mut sizes, mut areas) = (0.0, 0.0);
    for (triangle, piece) in mesh.triangles.iter().zip(triangle_piece) {
        let [a, b, c] = triangle.map(|vertex| Vec3::from(mesh.positions[vertex as usize]).as_dvec3());
        let area = (b - a).cross(c - a).length();
        sizes += area * f64::from(boxes[*piece as usize].typical_size());
        areas += area;
    }
    let mean = sizes / areas;
    if mean.is_finite() && mean > 0.0 { mean } else { 1.0 }
}

/// Returns the oriented boxes of `count` groups of triangles; `triangle_group` holds the group of each triangle.
pub fn boxes(mesh: &Mesh, triangle_group: &[u32], count: usize) -> Vec<PieceBox> {
    let groups = Groups::of_each(triangle_group, count);
    let cancel = Cancel::current();
    (0..count)
        .into_par_iter()
        .inspect(|_| cancel.look())
        .map(|group| tightest::piece_box(mesh, groups.members(group)))
        .collect()
}
