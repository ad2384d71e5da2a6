//! Vertices of a primitive in the order in which a copy writes them.

use std::collections::HashMap;

use sabi_surface::model::FileOrigins;

/// Exact values of the attributes that a copy writes for a vertex. Vertices with the same origin differ in these.
pub(super) type VertexValues = [u32; 9];

/// Vertices and triangles of a primitive. Vertices come in the order of the file.
pub(super) struct Slots {
    /// Vertex of the primitive that each one is made from.
    pub(super) sources: Vec<u32>,
    /// Vertex of the mesh with its values.
    pub(super) vertices: Vec<u32>,
    /// Triangles, with their corners in the order of the file.
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Slots {
    /// Finds the vertices of triangles of a primitive that differ in their origin or in what is written.
    pub(super) fn of(
        corners: &[[u32; 3]],
        origins: &FileOrigins,
        is_mirrored: bool,
        written: &dyn Fn(usize) -> VertexValues,
    ) -> Slots {
        let mut slot_of_vertex: HashMap<u32, u32> = HashMap::new();
        let mut slot_of_value: HashMap<(u32, VertexValues), u32> = HashMap::new();
        let mut slots: Vec<(u32, u32)> = Vec::new();
        let mut slot = |vertex: u32| {
            *slot_of_vertex.entry(vertex).or_insert_with(|| {
                // Every vertex of a model has an origin.
                let source = origins.vertices.get(vertex as usize).copied().unwrap_or_default();
                *slot_of_value
                    .entry((source, written(vertex as usize)))
                    .or_insert_with(|| {
                        slots.push((source, vertex));
                        slots.len() as u32 - 1
                    })
            })
        };
        let mut triangles: Vec<[u32; 3]> = corners.iter().map(|corners| corners.map(&mut slot)).collect();
        let mut order: Vec<u32> = (0..slots.len() as u32).collect();
        order.sort_by_key(|slot| slots[*slot as usize].0);
        let mut place = vec![0; order.len()];
        for (at, slot) in order.iter().enumerate() {
            place[*slot as usize] = at as u32;
        }
        for triangle in &mut triangles {
            *triangle = triangle.map(|slot| place[slot as usize]);
            if is_mirrored {
                triangle.swap(1, 2);
            }
        }
        let (sources, vertices) = order.iter().map(|slot| slots[*slot as usize]).unzip();
        Slots {
            sources,
            vertices,
            triangles,
        }
    }

    /// Returns true if no vertex of the file is split.
    pub(super) fn are_whole(&self) -> bool {
        self.sources.windows(2).all(|pair| pair[0] != pair[1])
    }
}
