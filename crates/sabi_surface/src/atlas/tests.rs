//! Tests of the guarantees of an atlas, on meshes with known results.

mod broken;
mod gaps;
mod keeping;
mod layout;
mod links;
mod raster;
mod report;
mod shapes;
mod udim;
