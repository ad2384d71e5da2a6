//! The panels beside canvas, model and texture.

pub(crate) mod export;
mod field;
pub(crate) mod history;
pub(crate) mod library;
mod order;
pub(crate) mod page;
pub(crate) mod parameters;
pub(crate) mod performance;
mod ports;
pub(crate) mod problems;
mod published;
pub(crate) mod stack;
mod variants;
