//! Changes of the graph or the kinds while the model stays loaded.

use std::sync::OnceLock;

use sabi_gpu::GpuSurface;
use sabi_graph::FlatGraph;

use super::{Evaluator, surface_key};
use crate::error::EngineError;
use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;
use crate::opening::levels::AtlasLevels;
use crate::warning::Warning;

impl Evaluator {
    /// Takes another graph, or the same one after an edit; `graph` is `open` without its groups. Nothing is loaded again: only
    /// the tables of the surface are made anew where the document has another fit or seed.
    pub fn set_graph(&mut self, open: &OpenGraph, graph: FlatGraph) -> Result<(), EngineError> {
        let fit = self.chosen.0.unwrap_or(open.document.fit);
        let seed = self.chosen.1.unwrap_or(open.document.seed);
        if (fit, seed) != (self.fit, self.seed) {
            let tables = self.linked.tables(&fit, seed);
            let levels = AtlasLevels::new(&self.linked, &fit);
            self.surface = GpuSurface::upload(&self.gpu, &self.linked.atlas, &tables, levels.of(0))?;
            self.surface_key = surface_key(&self.linked, &tables);
            (self.tables, self.levels) = (tables, levels);
            (self.fit, self.seed) = (fit, seed);
            self.bvh_on_device = OnceLock::new();
        }
        self.path.clone_from(&open.path);
        self.pictures = open.pictures.clone();
        self.graph = graph;
        self.begin_warnings();
        Ok(())
    }

    /// Takes other node kinds, such as those of node files that were read again.
    pub fn set_kinds(&mut self, mut kinds: Kinds) {
        kinds.adapt_to(&self.linked.model);
        self.kinds = kinds;
        self.begin_warnings();
    }

    /// Forgets what was said of the last graph.
    fn begin_warnings(&mut self) {
        let left_out = self.kinds.left_out().map(Warning::from);
        self.warnings = self.of_model.iter().cloned().chain(left_out).collect();
    }
}
