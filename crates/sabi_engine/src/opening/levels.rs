//! Levels of the surface besides the finest one. They are built when a plan runs on them.

use std::collections::BTreeMap;

use sabi_gpu::{CellLevel, CoarseSurface, Gpu, Measures, PointSurface};
use sabi_plan::{Level, LevelWidths, Plan, Step};
use sabi_surface::atlas::AtlasLevel;
use sabi_surface::points::SurfacePoints;

use crate::error::EngineError;
use crate::opening::linked_model::FittedModel;

/// Spacings of points, as fractions of the side of a square as large as the surface: of the finest points (160 000 of
/// them), the minimum for the widest, and the limit below which there are no points.
const FINEST_POINTS: f64 = 512.0;
const WIDEST_POINTS: f64 = 100.0;
const FEWEST_POINTS: f64 = 24.0;
/// Minimum number of texels for the spacing of points, since the cells of points consist of texels.
const TEXELS_FOR_SPACING: f64 = 2.5;

/// Levels of a surface that were built so far.
pub(crate) struct SurfaceLevels {
    /// Width of the finest texels, working units.
    finest: f64,
    /// Largest coordinate of the model, working units.
    farthest: f64,
    coarser: BTreeMap<u32, CoarseSurface>,
    points: BTreeMap<u32, PointSurface>,
}

impl SurfaceLevels {
    pub(crate) fn new(model: FittedModel<'_>) -> SurfaceLevels {
        SurfaceLevels {
            finest: model.finest_texel(),
            farthest: model.farthest(),
            coarser: BTreeMap::new(),
            points: BTreeMap::new(),
        }
    }

    /// Coarser levels of texels on the device, by number.
    pub(crate) fn coarser(&self) -> &BTreeMap<u32, CoarseSurface> {
        &self.coarser
    }

    /// Levels of points on the device, by number.
    pub(crate) fn points(&self) -> &BTreeMap<u32, PointSurface> {
        &self.points
    }

    /// Returns the widths of the usable levels. Counting the levels visits the whole atlas, so it is done only for graphs with
    /// filters.
    pub(crate) fn widths(&self, model: FittedModel<'_>, has_filters: bool) -> LevelWidths {
        if !has_filters {
            return LevelWidths::of_texels(self.finest, 0);
        }
        let side = model.area().sqrt();
        let charts = model.linked().atlas.charts.iter();
        let texels: u64 = charts.map(|chart| u64::from(chart.texels)).sum();
        let least = TEXELS_FOR_SPACING * side / (texels.max(1) as f64).sqrt();
        let finest_points = least.max(side / FINEST_POINTS);
        let doublings = (side / WIDEST_POINTS / finest_points).log2().floor().max(0.0) as u32;
        LevelWidths {
            finest: self.finest,
            coarsest: model.linked().usable_levels(),
            widest_points: finest_points * f64::from(1_u32 << doublings),
            point_levels: if finest_points <= side / FEWEST_POINTS {
                doublings + 1
            } else {
                0
            },
        }
    }

    /// Returns the measures of a level of texels.
    pub(crate) fn of(&self, level: u32) -> Measures {
        self.measures(self.finest * f64::from(1_u32 << level))
    }

    fn measures(&self, texel: f64) -> Measures {
        Measures {
            texel,
            finest: self.finest,
            farthest: self.farthest,
        }
    }

    /// Builds and uploads the levels on which a plan runs, as far as they are missing.
    pub(crate) fn make(
        &mut self,
        plan: &Plan,
        gpu: &Gpu,
        model: FittedModel<'_>,
        seed: u32,
    ) -> Result<(), EngineError> {
        let levels = plan.steps.iter().flat_map(|step| match step {
            Step::Kernel(kernel) => vec![kernel.level],
            Step::Move(step) => step.levels.to_vec(),
            Step::Source(_) | Step::Survey(_) => Vec::new(),
        });
        for level in levels {
            match level {
                Level::FINEST => {}
                Level::Texels(number) if self.coarser.contains_key(&number) => {}
                Level::Texels(number) => {
                    let made = model.linked().atlas.level(&model.linked().model.mesh, number)?;
                    self.add_texels(&made, number, gpu, model, seed)?;
                }
                Level::Points(number) if self.points.contains_key(&number) => {}
                Level::Points(number) => self.add_points(number, gpu, model, seed)?,
            }
        }
        Ok(())
    }

    fn add_texels(
        &mut self,
        made: &AtlasLevel,
        number: u32,
        gpu: &Gpu,
        model: FittedModel<'_>,
        seed: u32,
    ) -> Result<(), EngineError> {
        let tables = model.tables_of(&made.atlas, seed);
        let surface = CoarseSurface::upload(gpu, made, &tables, self.of(number))?;
        self.coarser.insert(number, surface);
        Ok(())
    }

    /// Spreads points over the level of texels from which their cells are built, and uploads both.
    fn add_points(&mut self, number: u32, gpu: &Gpu, model: FittedModel<'_>, seed: u32) -> Result<(), EngineError> {
        let widths = self.widths(model, true);
        let spacing = widths.of(Level::Points(number));
        let linked = model.linked();
        let (cells_number, made) = match widths.cells_of_points(number) {
            Level::Texels(0) | Level::Points(_) => (0, None),
            Level::Texels(cells) => (cells, Some(linked.atlas.level(&linked.model.mesh, cells)?)),
        };
        if let Some(made) = &made
            && !self.coarser.contains_key(&cells_number)
        {
            self.add_texels(made, cells_number, gpu, model, seed)?;
        }
        let atlas = made.as_ref().map_or(&linked.atlas, |made| &made.atlas);
        let working_from_model = model.working_from_model();
        let points = SurfacePoints::spread(&linked.model.mesh, atlas, spacing / working_from_model);
        let level = CellLevel {
            number: cells_number,
            atlas,
            tables: &model.tables_of(atlas, seed),
        };
        let surface = PointSurface::upload(gpu, &points, level, working_from_model, self.measures(spacing))?;
        self.points.insert(number, surface);
        Ok(())
    }
}
