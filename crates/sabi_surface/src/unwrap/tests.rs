//! Promises of unwrapping, each on small meshes.

mod promises;
mod shapes;
