//! The panels beside canvas, model and texture.

mod card;
mod channel_sections;
pub(crate) mod export;
mod exposed_parameters;
pub(crate) mod history;
pub(crate) mod input_histogram;
mod instance;
pub(crate) mod library;
pub(crate) mod node_page;
mod painting;
pub(crate) mod parameters;
mod picture_tooltip;
mod ports;
pub(crate) mod problems;
mod random;
mod reordering;
pub(crate) mod stack;
mod text_field;
pub(crate) mod timing;
mod update;
mod variants;
