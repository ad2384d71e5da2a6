//! Tests of the guarantees of an atlas, on meshes with known results.

mod disk_cache;
mod gaps;
mod invalid_meshes;
mod layout;
mod links;
mod raster;
mod report;
mod shapes;
mod udim;
