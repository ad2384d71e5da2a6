//! Surface on which a graph is evaluated: a model with a fit and a seed, uploaded to the device.

use std::sync::{Arc, OnceLock};

use sabi_export::{ChartBorders, STEEPER};
use sabi_gpu::{BorderGhost, Borders, DeviceHierarchy, Gpu, GpuSurface, Shares, ShownTiles, SurfaceTables, Surfaces};
use sabi_graph::Fit;
use sabi_plan::{LevelWidths, Plan};
use sabi_surface::atlas::{AtlasOptions, atlas_key};

use crate::error::EngineError;
use crate::opening::levels::SurfaceLevels;
use crate::opening::linked_model::FittedModel;
use crate::opening::linked_model::LinkedModel;
use crate::phases::{PhaseTimes, Progress};
use crate::source::SourceSurface;
use crate::source::picture_table::PictureTables;

/// Model with a fit and a seed, and everything on the device that depends on them.
pub(crate) struct EvaluatedSurface {
    linked: Arc<LinkedModel>,
    fit: Fit,
    seed: u32,
    tables: SurfaceTables,
    on_device: GpuSurface,
    levels: SurfaceLevels,
    hierarchy_on_device: OnceLock<DeviceHierarchy>,
    /// Pictures that sources show.
    picture_tables: PictureTables,
    /// Texels that show the values of others; `None` if charts do not overlap.
    shares: OnceLock<Option<Shares>>,
    /// Ghosts that repeat their own chart where the data jumps.
    borders: OnceLock<Borders>,
    /// Tiles whose results are shown; `None` if nearly all are.
    shown: OnceLock<Option<ShownTiles>>,
    /// Hash of the surface, part of the keys of results.
    key: [u8; 32],
}

impl EvaluatedSurface {
    /// Computes the tables of a surface and uploads them.
    pub(crate) fn upload(
        gpu: &Gpu,
        linked: Arc<LinkedModel>,
        fit: Fit,
        seed: u32,
        times: &mut PhaseTimes,
    ) -> Result<EvaluatedSurface, EngineError> {
        let _span = tracing::debug_span!("upload surface", seed).entered();
        let model = linked.fitted(fit);
        let tables = times.load.time(|| model.tables(seed));
        let levels = times.atlas.time(|| SurfaceLevels::new(model));
        let on_device = times
            .load
            .time(|| GpuSurface::upload(gpu, &linked.atlas, &tables, levels.of(0)))?;
        Ok(EvaluatedSurface {
            key: key_of(&linked, &tables),
            linked,
            fit,
            seed,
            tables,
            on_device,
            levels,
            hierarchy_on_device: OnceLock::new(),
            picture_tables: PictureTables::default(),
            shares: OnceLock::new(),
            borders: OnceLock::new(),
            shown: OnceLock::new(),
        })
    }

    /// Uploads the surface again if the fit or the seed has changed.
    pub(crate) fn set_fit_and_seed(&mut self, gpu: &Gpu, fit: Fit, seed: u32) -> Result<(), EngineError> {
        if (fit, seed) == (self.fit, self.seed) {
            return Ok(());
        }
        let linked = self.linked.clone();
        let uploaded = EvaluatedSurface::upload(gpu, linked, fit, seed, &mut PhaseTimes::default())?;
        // Shared texels, borders and shown tiles depend only on the atlas, so they are kept.
        let shares = std::mem::take(&mut self.shares);
        let borders = std::mem::take(&mut self.borders);
        let shown = std::mem::take(&mut self.shown);
        *self = EvaluatedSurface {
            shares,
            borders,
            shown,
            ..uploaded
        };
        Ok(())
    }

    pub(crate) fn linked(&self) -> &Arc<LinkedModel> {
        &self.linked
    }

    pub(crate) fn model(&self) -> FittedModel<'_> {
        self.linked.fitted(self.fit)
    }

    pub(crate) fn fit(&self) -> Fit {
        self.fit
    }

    pub(crate) fn key(&self) -> [u8; 32] {
        self.key
    }

    pub(crate) fn on_device(&self) -> &GpuSurface {
        &self.on_device
    }

    /// Returns all levels that were uploaded so far.
    pub(crate) fn surfaces(&self) -> Surfaces<'_> {
        Surfaces {
            finest: &self.on_device,
            coarser: self.levels.coarser(),
            points: self.levels.points(),
        }
    }

    /// Returns the widths of the usable levels.
    pub(crate) fn level_widths(&self, has_filters: bool) -> LevelWidths {
        self.levels.widths(self.model(), has_filters)
    }

    /// Builds and uploads the coarser levels on which a plan runs, as far as they are missing.
    pub(crate) fn make_levels(&mut self, plan: &Plan, gpu: &Gpu) -> Result<(), EngineError> {
        let model = self.linked.fitted(self.fit);
        self.levels.make(plan, gpu, model, self.seed)
    }

    /// Returns the surface in the form that sources use.
    pub(crate) fn for_sources<'a>(&'a self, progress: &'a dyn Progress) -> SourceSurface<'a> {
        SourceSurface {
            model: &self.linked.model,
            atlas: &self.linked.atlas,
            tables: &self.tables,
            pieces: &self.linked.pieces,
            paint_index: &self.linked.paint_index,
            bvh: &self.linked.bvh,
            bvh_on_device: &self.hierarchy_on_device,
            picture_tables: &self.picture_tables,
            key: self.key,
            working_from_model: self.model().working_from_model(),
            tiles: None,
            progress,
        }
    }

    /// Drops the pictures on the device. They are uploaded again on their next use.
    pub(crate) fn forget_pictures(&self) {
        self.picture_tables.clear();
    }

    /// Returns the tiles whose results maps and pictures show, computed on first use. `None` if nearly all are shown.
    pub(crate) fn shown(&self) -> Option<&ShownTiles> {
        let found = self.shown.get_or_init(|| {
            let tiles = self.linked.shown_tiles()?;
            Some(ShownTiles::new(&self.linked.atlas, tiles))
        });
        found.as_ref()
    }

    /// Returns the texels that show the values of other texels, as on the maps in an engine; computed on first use. `None`
    /// for a model without overlapping charts.
    ///
    /// Sources and targets are texels of one result. Only an unwrapped model has charts of several results on one sheet. There charts do
    /// not overlap, unless they are too small for the size. A texel whose pixel shows a chart of another material shows its own material.
    pub(crate) fn shares(&self, gpu: &Gpu) -> Result<Option<&Shares>, EngineError> {
        if self.shares.get().is_none() {
            let shared = self.linked.shared_texels();
            let shares = match shared.is_empty() {
                true => None,
                false => Some(Shares::upload(gpu, &self.on_device, shared.groups())?),
            };
            // Another thread may have been faster. It has computed the same value.
            let _ = self.shares.set(shares);
        }
        Ok(self.shares.get().and_then(Option::as_ref))
    }

    /// Returns the ghosts that repeat their own chart where the data jumps, computed on first use.
    pub(crate) fn borders(&self, gpu: &Gpu) -> Result<&Borders, EngineError> {
        if let Some(known) = self.borders.get() {
            return Ok(known);
        }
        let found = ChartBorders::of_atlas(&self.linked.atlas);
        let ghosts = found.ghosts().iter().map(|ghost| BorderGhost {
            index: ghost.index,
            step: ghost.step,
            own: ghost.own,
        });
        let uploaded = Borders::upload(gpu, &self.on_device, ghosts, STEEPER)?;
        // Another thread may have been faster. It has computed the same value.
        Ok(self.borders.get_or_init(|| uploaded))
    }
}

/// Returns a hash of the surface: of the inputs of the atlas, and of the position of every triangle in space. The version
/// of the program is not included, since results are kept in memory, and ray results on disk have their own version.
fn key_of(linked: &LinkedModel, tables: &SurfaceTables) -> [u8; 32] {
    let mut hash = blake3::Hasher::new();
    hash.update(&atlas_key(&linked.model.mesh, &AtlasOptions::new(linked.atlas.size)));
    for row in tables.geometry.iter().chain(&tables.frames).chain(&tables.pieces) {
        hash.update(row.map(f32::to_le_bytes).as_flattened());
    }
    *hash.finalize().as_bytes()
}
