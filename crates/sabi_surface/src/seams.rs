//! Seams: edges whose two triangles meet on the model but not in the UV layout.

use crate::atlas::Atlas;
use crate::atlas::charts::is_seam;
use crate::atlas::topology::{NO_TWIN, Topology};
use crate::model::Mesh;

/// A seam, with its two half-edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seam {
    /// The two triangles, indices into [`Mesh::triangles`].
    pub triangles: [u32; 2],
    /// For each triangle, its corners at the start and at the end of the edge. Both triangles list the ends in the same order.
    pub corners: [[u8; 2]; 2],
}

impl Seam {
    /// Returns the vertices of one of the two triangles at the start and at the end of the edge.
    pub fn vertices(&self, mesh: &Mesh, side: usize) -> [usize; 2] {
        let corners = mesh.triangles[self.triangles[side] as usize];
        self.corners[side].map(|corner| corners[usize::from(corner)] as usize)
    }
}

/// Finds all seams of a mesh, in the order of their half-edges: edges where triangles that meet in space are on different
/// charts in UV, or separate on the same chart. At edges of more than two triangles, those that the atlas links are seams.
pub fn seams(mesh: &Mesh, atlas: &Atlas) -> Vec<Seam> {
    let topology = Topology::new(mesh);
    let mut seams = Vec::new();
    for (edge, &twin) in topology.twins.iter().enumerate() {
        let edge = edge as u32;
        if twin == NO_TWIN || twin < edge {
            continue;
        }
        let triangles = [edge / 3, twin / 3];
        let [one, other] = triangles.map(|triangle| atlas.uv_chart(triangle as usize));
        if one == other && !is_seam(mesh, &topology, edge, twin) {
            continue;
        }
        let corners = |edge: u32| [edge % 3, (edge + 1) % 3].map(|corner| corner as u8);
        let place = |side: usize, corner: u8| topology.corners[(3 * triangles[side]) as usize + usize::from(corner)];
        let (first, mut second) = (corners(edge), corners(twin));
        if place(0, first[0]) != place(1, second[0]) {
            second.swap(0, 1);
        }
        seams.push(Seam {
            triangles,
            corners: [first, second],
        });
    }
    seams
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atlas::AtlasOptions;

    /// Creates faces in a plane, each of two triangles with separate vertices, adjacent in space and this far apart in UV.
    fn strip(faces: u16, apart: f32) -> Mesh {
        let mut mesh = Mesh::default();
        for face in 0..faces {
            let (x, u) = (f32::from(face), f32::from(face) * (0.2 + apart));
            let first = mesh.positions.len() as u32;
            mesh.positions
                .extend([[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x + 1.0, 1.0, 0.0], [x, 1.0, 0.0]]);
            mesh.uvs.extend([[u, 0.2], [u + 0.2, 0.2], [u + 0.2, 0.0], [u, 0.0]]);
            mesh.triangles
                .extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
        mesh.normals = vec![[0.0, 0.0, 1.0]; mesh.positions.len()];
        mesh.tangents = vec![[1.0, 0.0, 0.0, 1.0]; mesh.positions.len()];
        mesh.triangle_material = vec![0; mesh.triangles.len()];
        mesh.triangle_part = vec![0; mesh.triangles.len()];
        mesh
    }

    fn found(mesh: &Mesh) -> Vec<Seam> {
        seams(mesh, &Atlas::build(mesh, &AtlasOptions::new(64)).unwrap())
    }

    #[test]
    fn an_edge_is_a_seam_if_its_two_sides_are_apart_on_the_map() {
        assert_eq!(found(&strip(3, 0.0)), [], "one chart, though no vertex is shared");
        let mesh = strip(3, 0.1);
        let seams = found(&mesh);
        assert_eq!(
            seams.iter().map(|seam| seam.triangles).collect::<Vec<_>>(),
            [[0, 3], [2, 5]]
        );
        for seam in seams {
            let [one, other] = [0, 1].map(|side| seam.vertices(&mesh, side).map(|vertex| mesh.positions[vertex]));
            assert_eq!(one, other, "both sides tell the same way along the edge");
        }
    }
}
