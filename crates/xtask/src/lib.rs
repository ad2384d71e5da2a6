//! Folders of the project, commands that run in them, and requirements of the machine: for `cargo xtask` and for the
//! tools that it starts.

pub mod display;
pub mod packages;
pub mod project;
pub mod vulkan;
