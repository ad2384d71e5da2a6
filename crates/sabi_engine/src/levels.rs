//! Coarser levels of the surface, made when a plan runs on them.

use std::collections::BTreeMap;

use sabi_gpu::{CoarseSurface, Gpu, TexelWidths};
use sabi_graph::Fit;
use sabi_plan::{Plan, Step};

use crate::error::{EngineError, ErrorKind};
use crate::prepare::Prepared;

/// The levels of one surface that were made so far.
pub(crate) struct Levels {
    /// Texel width of each level that may be used, working units, finest first.
    pub(crate) widths: Vec<f64>,
    pub(crate) coarser: BTreeMap<u32, CoarseSurface>,
}

impl Levels {
    pub(crate) fn new(prepared: &Prepared, fit: &Fit) -> Levels {
        let finest = prepared.finest_texel() * prepared.working_from_model(fit);
        let count = prepared.usable_levels();
        Levels {
            widths: (0..=count).map(|level| finest * f64::from(1_u32 << level)).collect(),
            coarser: BTreeMap::new(),
        }
    }

    /// Widths of a level's texels.
    pub(crate) fn of(&self, level: u32) -> TexelWidths {
        let width = |level: u32| self.widths.get(level as usize).copied().unwrap_or(1.0);
        TexelWidths {
            texel: width(level),
            finest: width(0),
        }
    }

    /// Makes what a plan runs on and is not there yet.
    pub(crate) fn make(
        &mut self,
        plan: &Plan,
        gpu: &Gpu,
        prepared: &Prepared,
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
            let made = prepared.atlas.level(&prepared.model.mesh, level);
            let made = made.map_err(|error| EngineError::new(ErrorKind::BadInput, error.to_string()))?;
            let tables = prepared.tables_of(&made.atlas, fit, seed);
            let surface = CoarseSurface::upload(gpu, &made, &tables, self.of(level))?;
            self.coarser.insert(level, surface);
        }
        Ok(())
    }
}
