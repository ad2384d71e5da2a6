//! The seams of a model: edges at which two charts meet.

use std::collections::BTreeMap;

use crate::on_mesh::OnMesh;

/// An edge as two triangles have it: the same two points of the surface, on two charts.
#[derive(Clone, Copy, Debug)]
pub struct Seam {
    /// The two triangles.
    pub triangles: [u32; 2],
    /// For each of them its corners at the start and at the end of the edge.
    pub corners: [[usize; 2]; 2],
}

impl Seam {
    /// Weights of the corners of one of the two triangles, at a share of the way along the edge.
    pub fn weights(&self, side: usize, along: f64) -> [f64; 3] {
        let mut weights = [0.0; 3];
        weights[self.corners[side][0]] = 1.0 - along;
        weights[self.corners[side][1]] = along;
        weights
    }
}

impl OnMesh {
    /// All seams, from the mesh alone: edges whose triangles have the same two points but other texture coordinates.
    pub fn seams(&self) -> Vec<Seam> {
        let mesh = &self.evaluator.linked().model.mesh;
        let mut open: BTreeMap<[[u32; 3]; 2], (u32, [usize; 2])> = BTreeMap::new();
        let mut seams = Vec::new();
        for (triangle, corners) in (0_u32..).zip(&mesh.triangles) {
            for start in 0..3 {
                let ends = [start, (start + 1) % 3];
                let [from, to] = ends.map(|end| mesh.positions[corners[end] as usize].map(f32::to_bits));
                match open.remove(&[to, from]) {
                    Some((other, [other_from, other_to])) => {
                        let seam = Seam {
                            triangles: [other, triangle],
                            corners: [[other_from, other_to], [ends[1], ends[0]]],
                        };
                        if self.is_cut(&seam) {
                            seams.push(seam);
                        }
                    }
                    None => {
                        open.insert([from, to], (triangle, ends));
                    }
                }
            }
        }
        seams
    }

    fn is_cut(&self, seam: &Seam) -> bool {
        let mesh = &self.evaluator.linked().model.mesh;
        let uv = |side: usize, end: usize| {
            let vertex = mesh.triangles[seam.triangles[side] as usize][seam.corners[side][end]];
            mesh.uvs[vertex as usize]
        };
        (0..2).any(|end| uv(0, end) != uv(1, end))
    }
}
