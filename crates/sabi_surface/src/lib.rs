//! From a model file to a surface: loading, charts, the linked atlas, ray casting.
//!
//! Invariants:
//! * No number in a file is trusted: counts, offsets and indices are checked before memory is allocated or read.
//! * Everything that was repaired, reduced or left out is reported as a warning of the model.
//! * The same file gives the same atlas, byte for byte, on every machine and any number of threads.
//! * Nothing here knows a graph or a device.
//!
//! ```
//! use sabi_surface::atlas::{Atlas, AtlasOptions};
//! use sabi_surface::model::Mesh;
//!
//! // Two triangles of a square that meet along its diagonal.
//! let corners = [[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.1, 0.9]];
//! let mesh = Mesh {
//! positions: corners.map(|[x, y]| [x, y, 0.0]).to_vec(),
//! normals: vec![[0.0, 0.0, 1.0]; 4],
//! tangents: vec![[1.0, 0.0, 0.0, 1.0]; 4],
//! uvs: corners.to_vec(),
//! uv_set: Some(0),
//! triangles: vec![[0, 1, 2], [0, 2, 3]],
//! triangle_material: vec![0, 0],
//! triangle_part: vec![0, 0],
//! ..Mesh::default()
//! };
//! let atlas = Atlas::build(&mesh, &AtlasOptions::new(64))?;
//! assert_eq!(atlas.charts.len(), 1);
//! # Ok::<(), sabi_surface::atlas::AtlasError>(())
//! ```

pub mod atlas;
pub mod bvh;
pub mod displace;
pub mod ground;
mod groups;
pub mod load;
pub mod model;
pub mod near;
pub mod openness;
pub mod orientation;
pub mod patch;
pub mod pieces;
pub mod points;
pub mod seams;
mod segment;
pub mod unwrap;

pub use atlas::topology::{NO_TWIN, Topology};
pub use groups::Groups;
