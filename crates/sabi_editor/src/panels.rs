//! The panels beside canvas, model and texture.

mod card;
mod channel_sections;
mod enlarged;
pub(crate) mod export;
mod exposed;
mod field;
pub(crate) mod history;
pub(crate) mod input_histogram;
mod instance;
pub(crate) mod library;
pub(crate) mod page;
mod painting;
pub(crate) mod parameters;
mod ports;
pub(crate) mod problems;
mod random;
mod reordering;
pub(crate) mod stack;
pub(crate) mod timing;
mod update;
mod variants;
