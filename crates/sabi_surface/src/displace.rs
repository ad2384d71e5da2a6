//! Displacement: a finer copy of a mesh whose vertices are moved by a height field, so that its silhouette changes, too.
//!
//! An edge is halved as long as it is longer than a limit, and a triangle is split along its halved edges. Whether an edge is halved, and
//! where its middle is, depends only on its two ends, so both neighbors split it in the same way and there are no T-junctions. Nothing has
//! to be stitched, and long thin triangles are cut only along their length. The lengths of the resulting edges differ by factors of two.
//!
//! The copy is exactly watertight: all vertices at one position, whatever their triangles, charts and parts, move by the
//! mean of the heights of the charts there, along the mean of the shading normals (as Castaño does on the GPU).
//!
//! Near a hard edge they move along its rounded normal (`rounded.rs`), up to the point where this line meets the height field
//! (`carve.rs`): faces that sink end where their neighbors begin, a chamfer in the heights becomes a plane, and faces that rise
//! meet in a sharp edge.

mod carve;
mod edges;
mod lift;
mod plane;
mod rounded_normals;
mod subdivision;

#[cfg(test)]
mod tests;

use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec2;
use rayon::prelude::*;

use crate::atlas::Atlas;
use crate::model::Mesh;
use lift::lift;
pub use plane::HeightPlane;
use subdivision::{SplitTriangle, count};

/// Resolution of a displaced copy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplaceOptions {
    /// Maximum edge length in model units: longer edges are halved. 0 means as fine as the budget allows. [`texel_length`]
    /// is the length below which finer edges show no more detail.
    pub edge_length: f32,
    /// Maximum number of triangles. A mesh that has more is not subdivided.
    pub triangle_budget: usize,
}

impl Default for DisplaceOptions {
    fn default() -> Self {
        DisplaceOptions {
            edge_length: 0.0,
            triangle_budget: 2_000_000,
        }
    }
}

/// A finer, displaced copy of a mesh. Vertices of different triangles of the mesh are never shared.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DisplacedMesh {
    /// Positions of the vertices, model units.
    pub positions: Vec<[f32; 3]>,
    /// Shading normals of the mesh, for each vertex. Like the tangents, they are those of the undisplaced surface, to which
    /// a normal map refers. They are interpolated without normalization, as over the original triangle.
    pub normals: Vec<[f32; 3]>,
    /// Tangents of the mesh, for each vertex.
    pub tangents: Vec<[f32; 4]>,
    /// Texture coordinates of the mesh, for each vertex.
    pub uvs: Vec<[f32; 2]>,
    /// Places on the page of the chart, texels, for each vertex.
    pub texels: Vec<[f32; 2]>,
    /// Corners as vertex numbers, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Triangle of the mesh from which each triangle was split, in ascending order. It determines chart, material and part.
    pub triangle_from: Vec<u32>,
    /// Length in model units above which edges were halved; infinite if no edge was halved.
    pub edge_length: f32,
    /// Reason why the copy is coarser than requested, as a sentence.
    pub note: Option<String>,
}

/// Subdivides a mesh and displaces it. `height` returns the height at a place of a chart given in texels, in model units
/// along the normal; `None` where the chart has no height. Values that are not finite count as 0. See [`HeightPlane::at`].
/// Coincident surfaces that face opposite directions are not displaced.
pub fn displaced(
    mesh: &Mesh,
    atlas: &Atlas,
    options: &DisplaceOptions,
    height: impl Fn(u32, [f32; 2]) -> Option<f32> + Sync,
) -> DisplacedMesh {
    let budget = options.triangle_budget as u64;
    let (edge_length, note) = fitting_length(mesh, options.edge_length, budget);
    let splits: Vec<SplitTriangle> = (0..mesh.triangles.len())
        .into_par_iter()
        .map(|triangle| SplitTriangle::new(mesh, atlas, triangle, edge_length))
        .collect();
    let mut whole = joined(&splits);
    whole.edge_length = edge_length;
    whole.note = note;
    let chart_of = |triangle: usize| atlas.triangle_chart[triangle];
    whole.positions = lift(mesh, &splits, &whole.positions, chart_of, height);
    whole
}

/// Returns the length of a texel's side in model units, averaged over the surface; 0 if there is no surface or no map of it.
pub fn texel_length(mesh: &Mesh, atlas: &Atlas) -> f32 {
    let area_texels = |[a, b, c]: &[[f32; 2]; 3]| {
        let [a, b, c] = [a, b, c].map(|texel| DVec2::from(texel.map(f64::from)));
        (b - a).perp_dot(c - a).abs() * 0.5
    };
    let texels: f64 = atlas.triangle_texels.iter().map(area_texels).sum();
    let length = (mesh.area() / texels).sqrt() as f32;
    if length.is_finite() { length } else { 0.0 }
}

/// Concatenates the splits without displacing them.
fn joined(splits: &[SplitTriangle]) -> DisplacedMesh {
    let mut whole = DisplacedMesh::default();
    let vertices = splits.iter().map(|split| split.vertices.len()).sum();
    let triangles = splits.iter().map(|split| split.triangles.len()).sum();
    whole.positions.reserve(vertices);
    whole.normals.reserve(vertices);
    whole.tangents.reserve(vertices);
    whole.uvs.reserve(vertices);
    whole.texels.reserve(vertices);
    whole.triangles.reserve(triangles);
    whole.triangle_from.reserve(triangles);
    for (number, split) in splits.iter().enumerate() {
        let first = whole.positions.len() as u32;
        for vertex in &split.vertices {
            whole.positions.push(vertex.position);
            whole.normals.push(vertex.normal);
            whole.tangents.push(vertex.tangent);
            whole.uvs.push(vertex.uv);
            whole.texels.push(vertex.texel);
        }
        let triangles = split.triangles.iter();
        whole
            .triangles
            .extend(triangles.map(|corners| corners.map(|corner| first + corner)));
        whole.triangle_from.resize(whole.triangles.len(), number as u32);
    }
    whole
}

/// Returns the smallest length, not below the requested one, above which edges can be halved within a budget of triangles;
/// and a sentence if it is larger than requested.
fn fitting_length(mesh: &Mesh, asked: f32, budget: u64) -> (f32, Option<String>) {
    let triangles = mesh.triangles.len() as u64;
    let is_asked = asked.is_finite() && asked > 0.0;
    if triangles > budget {
        let note = format!(
            "the displaced model keeps the {triangles} triangles that it has: its budget of {budget} leaves none to follow \
             the heights with"
        );
        return (f32::INFINITY, Some(note));
    }
    let finest = finest_length(mesh);
    let mut length = if is_asked { asked.max(finest) } else { finest };
    if fits(mesh, length, budget) {
        return (length, None);
    }
    // Of all triangles whose sides are not longer than a given length, the equilateral one has the largest area.
    let needed = (mesh.area() * 4.0 / (3f64.sqrt() * budget as f64)).sqrt() as f32;
    length = length.max(needed);
    while !fits(mesh, length, budget) {
        length *= 2f32.powf(0.25);
    }
    let note = is_asked.then(|| {
        format!(
            "the displaced model is coarser than asked for: its edges are up to {length} units long and not {asked}, since \
             shorter ones would take more than {budget} triangles"
        )
    });
    (length, note)
}

/// Returns the length below which edges are only a few rounding steps of their coordinates long and are not halved.
fn finest_length(mesh: &Mesh) -> f32 {
    let corners = mesh.triangles.iter().flatten();
    let reach = corners
        .flat_map(|&vertex| mesh.positions[vertex as usize])
        .filter(|value| value.is_finite())
        .fold(0.0, |reach: f32, value| reach.max(value.abs()));
    (reach / 1024.0 / 1024.0).max(f32::MIN_POSITIVE)
}

/// Returns true if halving all edges longer than `length` makes no more triangles than the budget.
fn fits(mesh: &Mesh, length: f32, budget: u64) -> bool {
    // Counting ends as soon as the sum exceeds the budget.
    let sum = AtomicU64::new(0);
    mesh.triangles.par_iter().for_each(|triangle| {
        let before = sum.load(Ordering::Relaxed);
        if before <= budget {
            let corners = triangle.map(|vertex| mesh.positions[vertex as usize]);
            sum.fetch_add(count(corners, length, budget - before), Ordering::Relaxed);
        }
    });
    sum.into_inner() <= budget
}
