//! Coarser levels of the atlas, built when a plan runs on them.

use std::collections::BTreeMap;

use sabi_gpu::{CoarseSurface, Gpu, Measures};
use sabi_plan::{Plan, Step, TexelWidths};

use crate::error::EngineError;
use crate::opening::linked_model::FittedModel;

/// Levels of an atlas that were built so far.
pub(crate) struct AtlasLevels {
    /// Width of the finest texels, working units.
    finest: f64,
    /// Largest coordinate of the model, working units.
    farthest: f64,
    coarser: BTreeMap<u32, CoarseSurface>,
}

impl AtlasLevels {
    pub(crate) fn new(model: FittedModel<'_>) -> AtlasLevels {
        AtlasLevels {
            finest: model.finest_texel(),
            farthest: model.farthest(),
            coarser: BTreeMap::new(),
        }
    }

    /// Coarser levels on the device, by number.
    pub(crate) fn coarser(&self) -> &BTreeMap<u32, CoarseSurface> {
        &self.coarser
    }

    /// Returns the texel widths of the usable levels. Counting the levels visits the whole atlas, so it is done only for graphs
    /// with filters.
    pub(crate) fn texel_widths(&self, model: FittedModel<'_>, has_filters: bool) -> TexelWidths {
        TexelWidths {
            finest: self.finest,
            coarsest_level: if has_filters { model.linked().usable_levels() } else { 0 },
        }
    }

    /// Returns the texel widths of a level.
    pub(crate) fn of(&self, level: u32) -> Measures {
        Measures {
            texel: self.finest * f64::from(1_u32 << level),
            finest: self.finest,
            farthest: self.farthest,
        }
    }

    /// Builds and uploads the levels that a plan runs on, as far as they are missing.
    pub(crate) fn make(
        &mut self,
        plan: &Plan,
        gpu: &Gpu,
        model: FittedModel<'_>,
        seed: u32,
    ) -> Result<(), EngineError> {
        let linked = model.linked();
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
            let tables = model.tables_of(&made.atlas, seed);
            let surface = CoarseSurface::upload(gpu, &made, &tables, self.of(level))?;
            self.coarser.insert(level, surface);
        }
        Ok(())
    }
}
