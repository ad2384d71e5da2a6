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

use std::path::PathBuf;

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

impl Panels {
    /// Panels that keep small pictures in this folder, if there is one, and go on with node files that are being written.
    pub(crate) fn new(cache: Option<PathBuf>, drafts: Vec<page::Draft>) -> Panels {
        let mut panels = Panels {
            keepsakes: keepsakes::Keepsakes::new(cache),
            ..Panels::default()
        };
        panels.page.take_up(drafts);
        panels
    }
}
