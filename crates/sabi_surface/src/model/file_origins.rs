//! Places in a glTF file from which a mesh was read.

use std::collections::BTreeSet;
use std::ops::Range;

use super::Mesh;

/// Primitives and vertices of a glTF file from which the triangles and vertices of a mesh were read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FileOrigins {
    /// Primitives as placed by nodes, in the order of their triangles. Primitives without triangles are left out.
    pub placed: Vec<PlacedPrimitive>,
    /// For each vertex of the mesh, its number in the accessors of its primitive.
    pub vertices: Vec<u32>,
}

/// A primitive of a glTF file, placed by a node.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedPrimitive {
    /// The node; `None` if the scene contains no mesh, so that all meshes are read as stored.
    pub node: Option<usize>,
    /// Number of the mesh.
    pub mesh: usize,
    /// Number of the primitive in the mesh.
    pub primitive: usize,
    /// Its triangles, as indices into [`Mesh::triangles`]. They are reversed if the node mirrors.
    pub triangles: Range<u32>,
    /// Columns of the matrix from vectors of the file's mesh to vectors of the model.
    pub model_from_file: [[f64; 3]; 3],
    /// True if faces of the primitive were reversed, so that their corners are not in the file's order.
    pub is_turned: bool,
    /// True if the tangents of [`Mesh::uvs`] are those of the file.
    pub has_own_tangents: bool,
    /// Number of its UV sets: the highest set number plus one.
    pub uv_sets: u32,
}

impl FileOrigins {
    /// Adapts to an unwrapping: `source_vertex` contains for each new vertex the vertex from which it was made. All
    /// tangents were computed for the new coordinates.
    pub fn follow(&mut self, source_vertex: &[u32]) {
        let before = std::mem::take(&mut self.vertices);
        let sources = source_vertex.iter().map(|vertex| *vertex as usize);
        self.vertices = sources.filter_map(|vertex| before.get(vertex).copied()).collect();
        for placed in &mut self.placed {
            placed.has_own_tangents = false;
        }
    }

    /// Returns the number of a UV set that no primitive with one of the `materials` has; `None` stands for all materials.
    pub fn free_uv_set(&self, mesh: &Mesh, materials: Option<&BTreeSet<u32>>) -> u32 {
        let is_wanted = |placed: &&PlacedPrimitive| {
            let material = mesh.triangle_material.get(placed.triangles.start as usize);
            materials.is_none_or(|materials| material.is_some_and(|material| materials.contains(material)))
        };
        let sets = self.placed.iter().filter(is_wanted).map(|placed| placed.uv_sets);
        // If no primitive has UVs, the first set is free.
        sets.max().unwrap_or(0)
    }
}
