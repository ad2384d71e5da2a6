//! Lit pictures of a model.

pub(crate) mod displace;
pub(crate) mod render;
