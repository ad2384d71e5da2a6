//! Coarser levels of the surface, made when a plan runs on them.

use std::collections::BTreeMap;

use sabi_gpu::{CoarseSurface, Gpu, Measures};
use sabi_graph::Fit;
use sabi_plan::{Plan, Step};

use crate::error::EngineError;
use crate::opening::linked_model::LinkedModel;

/// The levels of one surface that were made so far.
pub(crate) struct AtlasLevels {
    /// Width of the finest texels, working units.
    finest: f64,
    /// Largest coordinate of the model, working units.
    farthest: f64,
    pub(crate) coarser: BTreeMap<u32, CoarseSurface>,
}

impl AtlasLevels {
    pub(crate) fn new(linked: &LinkedModel, fit: &Fit) -> AtlasLevels {
        let scale = linked.working_from_model(fit);
        AtlasLevels {
            finest: linked.finest_texel() * scale,
            farthest: linked.farthest * scale,
            coarser: BTreeMap::new(),
        }
    }

    /// Texel width of each level that may be used, working units, finest first. The whole atlas is looked at for that, so
    /// it is asked for graphs only that have filters.
    pub(crate) fn widths(&self, linked: &LinkedModel, has_filters: bool) -> Vec<f64> {
        let coarser = if has_filters { linked.usable_levels() } else { 0 };
        (0..=coarser).map(|level| self.of(level).texel).collect()
    }

    /// Widths of a level's texels.
    pub(crate) fn of(&self, level: u32) -> Measures {
        Measures {
            texel: self.finest * f64::from(1_u32 << level),
            finest: self.finest,
            farthest: self.farthest,
        }
    }

    /// Makes what a plan runs on and is not there yet.
    pub(crate) fn make(
        &mut self,
        plan: &Plan,
        gpu: &Gpu,
        linked: &LinkedModel,
        fit: &Fit,
        seed: u32,
    ) -> Result<(), EngineError> {
        let levels = plan.steps.iter().map(|step| match step {
            Step::Kernel(kernel) => kernel.level,
            Step::Move(step) => step.levels[0].max(step.levels[1]),
            Step::Source(_) | Step::Survey(_) => 0,
        });
        for level in levels {
            if level == 0 || self.coarser.contains_key(&level) {
                continue;
            }
            let made = linked.atlas.level(&linked.model.mesh, level)?;
            let tables = linked.tables_of(&made.atlas, fit, seed);
            let surface = CoarseSurface::upload(gpu, &made, &tables, self.of(level))?;
            self.coarser.insert(level, surface);
        }
        Ok(())
    }
}
