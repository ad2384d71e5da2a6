//! Bakes as reports and output folders record them.

pub(crate) mod manifest;
pub(crate) mod recorded_bake;
pub(crate) mod verification;
