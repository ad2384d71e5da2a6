//! Bakes recorded in reports and output folders.

pub(crate) mod manifest;
pub(crate) mod recorded_bake;
pub(crate) mod verification;
