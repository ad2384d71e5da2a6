//! The panels beside canvas, model and texture.

pub(crate) mod export;
mod field;
pub(crate) mod history;
pub(crate) mod keepsakes;
pub(crate) mod library;
mod order;
pub(crate) mod page;
pub(crate) mod parameters;
pub(crate) mod performance;
mod ports;
pub(crate) mod problems;
pub(crate) mod published;
pub(crate) mod stack;
mod variants;

/// What panels hold from frame to frame.
#[derive(Default)]
pub(crate) struct Panels {
    pub(crate) parameters: parameters::Parameters,
    pub(crate) library: library::Library,
    pub(crate) export: export::Export,
    pub(crate) page: page::Page,
    pub(crate) stack: stack::Layers,
    pub(crate) keepsakes: keepsakes::Keepsakes,
}
