//! What an atlas promises, held on meshes whose answer is known.

mod broken;
mod keeping;
mod layout;
mod links;
mod raster;
mod report;
mod shapes;
