//! What a set of maps was made of, so that it can be made again and checked.

pub(crate) mod build;
pub(crate) mod inputs;
pub(crate) mod made_of;
pub(crate) mod manifest;
pub(crate) mod recipe;
pub(crate) mod recorded;
mod recorded_fit;
pub(crate) mod verification;
