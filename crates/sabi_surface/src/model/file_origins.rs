//! Places in a glTF file that a mesh was read from.

use std::collections::BTreeSet;
use std::ops::Range;

use super::Mesh;

/// Primitives and vertices of a glTF file that the triangles and vertices of a mesh were read from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FileOrigins {
    /// Primitives as nodes place them, in the order of their triangles. Those without triangles are left out.
    pub placed: Vec<PlacedPrimitive>,
    /// For each vertex of the mesh its number in the accessors of its primitive.
    pub vertices: Vec<u32>,
}

/// A primitive of a glTF file where a node places it.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedPrimitive {
    /// The node; none where the scene shows no mesh and all are taken as they are stored.
    pub node: Option<usize>,
    /// Number of the mesh.
    pub mesh: usize,
    /// Number of the primitive in the mesh.
    pub primitive: usize,
    /// Its triangles, indices into [`Mesh::triangles`]. They are reversed where the node mirrors.
    pub triangles: Range<u32>,
    /// Columns of the matrix that carries vectors of the file's mesh to the model.
    pub model_from_file: [[f64; 3]; 3],
    /// True if faces of it were turned, so that their corners are not in the file's order.
    pub is_turned: bool,
    /// True if the tangents of [`Mesh::uvs`] are those of the file.
    pub has_own_tangents: bool,
    /// Number of its UV sets: the highest one and one.
    pub uv_sets: u32,
}

impl FileOrigins {
    /// Follows an unwrapping: `source_vertex` has for each new vertex the one that it was made from. All tangents were made for
    /// the new coordinates.
    pub fn follow(&mut self, source_vertex: &[u32]) {
        let before = std::mem::take(&mut self.vertices);
        let sources = source_vertex.iter().map(|vertex| *vertex as usize);
        self.vertices = sources.filter_map(|vertex| before.get(vertex).copied()).collect();
        for placed in &mut self.placed {
            placed.has_own_tangents = false;
        }
    }

    /// Returns the number of a UV set that no primitive has, of those with one of the `materials`; none for all.
    pub fn free_uv_set(&self, mesh: &Mesh, materials: Option<&BTreeSet<u32>>) -> u32 {
        let is_wanted = |placed: &&PlacedPrimitive| {
            let material = mesh.triangle_material.get(placed.triangles.start as usize);
            materials.is_none_or(|materials| material.is_some_and(|material| materials.contains(material)))
        };
        let sets = self.placed.iter().filter(is_wanted).map(|placed| placed.uv_sets);
        // A primitive without UVs has the first set free.
        sets.max().unwrap_or(0)
    }
}
