//! A model file becomes a surface: loading, charts, the linked atlas, ray casting.

pub mod atlas;
pub mod bvh;
pub mod disk;
pub mod displace;
pub mod load;
pub mod model;
pub mod pieces;
pub mod seams;
pub mod unwrap;
