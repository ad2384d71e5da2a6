//! A model, made ready: loaded, its atlas built or found, its lengths known.

use std::path::{Path, PathBuf};

use sabi_gpu::SurfaceTables;
use sabi_graph::Fit;
use sabi_surface::atlas::{Atlas, AtlasOptions, cached};
use sabi_surface::load::{LoadOptions, Up, load};
use sabi_surface::model::Model;

use crate::error::{EngineError, ErrorKind};
use crate::stages::{Progress, Stage};

/// How a model is taken.
#[derive(Clone, Debug)]
pub struct ModelOptions {
    /// The file.
    pub path: PathBuf,
    /// Which UV set.
    pub uv: u32,
    /// Which axis of the file points up.
    pub up: Up,
    /// All lengths are multiplied by this.
    pub scale: f32,
    /// Texels for one unit of UV.
    pub size: u32,
    /// Where atlases are kept; none to build anew.
    pub cache_dir: Option<PathBuf>,
}

impl ModelOptions {
    /// A model as its file has it, at a size.
    pub fn new(path: &Path, size: u32) -> ModelOptions {
        ModelOptions {
            path: path.to_owned(),
            uv: 0,
            up: Up::Y,
            scale: 1.0,
            size,
            cache_dir: None,
        }
    }
}

/// A model with its atlas.
pub struct Prepared {
    /// The model.
    pub model: Model,
    /// Its linked atlas.
    pub atlas: Atlas,
    /// Whether the atlas was found on disk.
    pub atlas_was_cached: bool,
    /// The largest side of the box around it, model units.
    pub largest_side: f64,
    /// Model units in one unit of the file: what all lengths of it were multiplied by.
    pub scale: f64,
}

impl Prepared {
    /// Loads a model and builds its atlas.
    pub fn open(options: &ModelOptions, progress: &dyn Progress) -> Result<Prepared, EngineError> {
        let model = Prepared::load_model(options)?;
        progress.advance(Stage::Load, 1, 1);
        Prepared::link(model, options, progress)
    }

    /// Only loads the model.
    pub fn load_model(options: &ModelOptions) -> Result<Model, EngineError> {
        if !(options.scale.is_finite() && options.scale > 0.0) {
            let why = format!("--scale takes a number above 0, not {}", options.scale);
            return Err(EngineError::new(ErrorKind::Usage, why));
        }
        let load_options = LoadOptions {
            uv_set: options.uv,
            up: options.up,
            scale: options.scale,
        };
        Ok(load(&options.path, &load_options)?)
    }

    /// Builds or finds the atlas of a loaded model.
    pub fn link(model: Model, options: &ModelOptions, progress: &dyn Progress) -> Result<Prepared, EngineError> {
        let cache_dir = options.cache_dir.as_deref().map(|folder| folder.join("atlas"));
        progress.advance(Stage::Atlas, 0, 1);
        let built = cached(cache_dir.as_deref(), &model.mesh, &AtlasOptions::new(options.size));
        let (atlas, atlas_was_cached) = built
            .map_err(|error| EngineError::new(ErrorKind::BadInput, format!("{}: {error}", options.path.display())))?;
        progress.advance(Stage::Atlas, 1, 1);
        let largest_side = largest_side(&model);
        Ok(Prepared {
            model,
            atlas,
            atlas_was_cached,
            largest_side,
            scale: f64::from(options.scale),
        })
    }

    /// Factor from model units to working units under a fit.
    pub fn working_from_model(&self, fit: &Fit) -> f64 {
        match fit {
            Fit::Unit => 1.0 / self.largest_side,
            Fit::Metres => 1.0,
            Fit::Length(length) => 1.0 / length,
        }
    }

    /// Factor from working units under a fit to the units of the model's file, in which heights are exported.
    pub fn file_from_working(&self, fit: &Fit) -> f64 {
        1.0 / (self.working_from_model(fit) * self.scale)
    }

    /// The tables that kernels read, in working units.
    pub fn tables(&self, fit: &Fit, seed: u32) -> SurfaceTables {
        SurfaceTables::new(&self.model.mesh, &self.atlas, self.working_from_model(fit), seed)
    }

    /// Lowest and highest `dot(vertex, direction)` in working units.
    pub fn extent(&self, fit: &Fit, direction: [f32; 3]) -> [f32; 2] {
        let scale = self.working_from_model(fit);
        let along = |position: &[f32; 3]| {
            let dot: f64 = position
                .iter()
                .zip(direction)
                .map(|(x, d)| f64::from(*x) * f64::from(d))
                .sum();
            (dot * scale) as f32
        };
        let start = [f32::INFINITY, f32::NEG_INFINITY];
        let used = self.model.mesh.triangles.iter().flatten();
        let positions = used.filter_map(|vertex| self.model.mesh.positions.get(*vertex as usize));
        let [low, high] = positions
            .map(along)
            .fold(start, |[low, high], x| [low.min(x), high.max(x)]);
        if low <= high { [low, high] } else { [0.0, 1.0] }
    }
}

/// The largest side of the box around all triangles; 1 for a model without extent.
fn largest_side(model: &Model) -> f64 {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for vertex in model.mesh.triangles.iter().flatten() {
        let Some(position) = model.mesh.positions.get(*vertex as usize) else {
            continue;
        };
        for axis in 0..3 {
            low[axis] = low[axis].min(f64::from(position[axis]));
            high[axis] = high[axis].max(f64::from(position[axis]));
        }
    }
    let side = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    if side > 0.0 && side.is_finite() { side } else { 1.0 }
}
