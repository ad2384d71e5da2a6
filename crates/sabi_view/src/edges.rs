//! Lines over the model: its wires and the seams of its maps.

use rayon::prelude::*;
use sabi_gpu::wgsl_struct;
use sabi_surface::atlas::Atlas;
use sabi_surface::displace::Displaced;
use sabi_surface::model::Mesh;

use crate::placement::Placement;

wgsl_struct! {
    vertex "view/lines" Line:
    /// The ends of a line, view space.
    pub(crate) struct Line {
        pub(crate) first: [f32; 3],
        pub(crate) second: [f32; 3],
    }
}

/// An edge as a triangle beside it has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Side {
    /// Bits of the places of its ends, model units, the smaller ones first: both triangles beside it say the same.
    ends: [[u32; 3]; 2],
    chart: u32,
    /// Bits of the texel coordinates of its ends.
    texels: [[u32; 2]; 2],
}

impl Side {
    fn new(ends: [[f32; 3]; 2], chart: u32, texels: [[f32; 2]; 2]) -> Side {
        // Zero has two signs.
        let [a, b] = ends.map(|end| end.map(|at| (at + 0.0).to_bits()));
        let [of_a, of_b] = texels.map(|texel| texel.map(f32::to_bits));
        let (ends, texels) = if a <= b {
            ([a, b], [of_a, of_b])
        } else {
            ([b, a], [of_b, of_a])
        };
        Side { ends, chart, texels }
    }

    fn line(&self, placement: &Placement) -> Line {
        let [first, second] = self
            .ends
            .map(|end| placement.view_from_model(end.map(f32::from_bits)).to_array());
        Line { first, second }
    }
}

/// The three edges of each triangle of a mesh.
pub(crate) fn sides_of(mesh: &Mesh, atlas: &Atlas) -> Vec<Side> {
    let side = |triangle: usize, corner: usize| {
        let corners = [corner, (corner + 1) % 3];
        Side::new(
            corners.map(|corner| mesh.positions[mesh.triangles[triangle][corner] as usize]),
            atlas.triangle_chart[triangle],
            corners.map(|corner| atlas.triangle_texels[triangle][corner]),
        )
    };
    let triangles = 0..mesh.triangles.len();
    triangles
        .flat_map(|triangle| [0, 1, 2].map(|corner| side(triangle, corner)))
        .collect()
}

/// The edges of the mesh that was displaced, in the pieces that they were cut into: those that a triangle of the mesh was cut
/// along within have no place on it.
pub(crate) fn sides_of_displaced(displaced: &Displaced, atlas: &Atlas) -> Vec<Side> {
    let mut sides = Vec::new();
    let mut edges: Vec<[u32; 2]> = Vec::new();
    let mut first = 0;
    for same in displaced.triangle_from.chunk_by(|a, b| a == b) {
        let chart = atlas.triangle_chart[same[0] as usize];
        edges.clear();
        for [a, b, c] in &displaced.triangles[first..first + same.len()] {
            edges.extend([[a, b], [b, c], [c, a]].map(|[from, to]| [*from.min(to), *from.max(to)]));
        }
        first += same.len();
        edges.sort_unstable();
        let outer = edges.chunk_by(|a, b| a == b).filter(|beside| beside.len() == 1);
        sides.extend(outer.map(|beside| {
            let ends = beside[0].map(|end| end as usize);
            Side::new(
                ends.map(|end| displaced.positions[end]),
                chart,
                ends.map(|end| displaced.texels[end]),
            )
        }));
    }
    sides
}

/// Every edge once; and those at which a chart ends: beside which the charts differ, or the texture coordinates do.
pub(crate) fn lines_of(mut sides: Vec<Side>, placement: &Placement) -> [Vec<Line>; 2] {
    sides.par_sort_unstable();
    let edges = sides.chunk_by(|a, b| a.ends == b.ends);
    let seams = edges.clone().filter(|sides| sides.len() != 2 || sides[0] != sides[1]);
    let line = |sides: &[Side]| sides[0].line(placement);
    [edges.map(line).collect(), seams.map(line).collect()]
}
