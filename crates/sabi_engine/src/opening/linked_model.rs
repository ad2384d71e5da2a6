//! A model, made ready: loaded, its atlas built or found, its lengths known.

mod fitted_model;

use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use sabi_graph::Fit;
use sabi_surface::atlas::{Atlas, AtlasError, AtlasOptions, cached};
use sabi_surface::bvh::Bvh;
use sabi_surface::load::{LoadOptions, Up, load};
use sabi_surface::model::Model;
use sabi_surface::pieces::Pieces;
use sabi_surface::unwrap::{UnwrapError, UnwrapReport, unwrap_cached};

use crate::error::{EngineError, ErrorKind};
use crate::phases::{Phase, Progress, stop_if_canceled};
pub use fitted_model::FittedModel;

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
    /// What charts that share a place on the maps get.
    pub overlap: Overlap,
    /// Texels for one unit of UV.
    pub size: u32,
    /// Where atlases are kept; none to build anew.
    pub cache_dir: Option<PathBuf>,
}

/// What charts that share a place on the maps get: stacked and mirrored ones, or those of a tiling texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Overlap {
    /// The first chart's result.
    #[default]
    First,
    /// The mean of the results of all of them.
    Merge,
    /// Places of their own: the whole model is unwrapped anew onto one sheet for all its materials.
    Unwrap,
}

impl ModelOptions {
    /// A model as its file has it, at a size.
    pub fn new(path: &Path, size: u32) -> ModelOptions {
        ModelOptions {
            path: path.to_owned(),
            uv: 0,
            up: Up::Y,
            scale: 1.0,
            overlap: Overlap::First,
            size,
            cache_dir: None,
        }
    }

    fn cache_folder(&self) -> Option<PathBuf> {
        self.cache_dir.as_deref().map(|folder| folder.join("atlas"))
    }
}

/// A model with its atlas.
pub struct LinkedModel {
    /// The model; where it was unwrapped, with its new mesh.
    pub model: Arc<Model>,
    /// How it was unwrapped; none where its own UVs are used.
    pub unwrapped: Option<Unwrapping>,
    /// What charts that share a place on the maps get.
    pub overlap: Overlap,
    /// Its linked atlas.
    pub atlas: Atlas,
    /// What hangs together inside its parts.
    pub pieces: Arc<Pieces>,
    /// What its rays are followed through; built when the first one is shot, and by the live evaluator before one is.
    pub bvh: Arc<OnceLock<Bvh>>,
    finest_texel: OnceLock<f64>,
    usable_levels: OnceLock<u32>,
    /// What rays cannot rely on, as sentences.
    pub(crate) solidity: OnceLock<Vec<String>>,
    /// Whether the atlas was found on disk.
    pub atlas_was_cached: bool,
    /// The largest side of the box around it, model units.
    pub largest_side: f64,
    /// The largest coordinate, model units.
    pub(crate) farthest: f64,
    /// Model units in one unit of the file: what all lengths of it were multiplied by.
    pub scale: f64,
}

/// What is known about an unwrapped model.
///
/// To write it out with UVs that its maps fit: [`LinkedModel::model`] has the mesh that was unwrapped, in world space around
/// [`Model::middle`]. Its positions, normals, tangents and colors go into the file as they are, every set of `texture_uvs` as the `TEXCOORD` of its
/// number, and `uvs`, which the maps are laid out by, as [`Unwrapping::uv_set`].
#[derive(Clone, Debug, PartialEq)]
pub struct Unwrapping {
    /// The `TEXCOORD` that the new coordinates are in a written file: the first that its textures leave free.
    pub uv_set: u32,
    /// For each vertex of the new mesh its vertex in the mesh as it was loaded.
    pub source_vertex: Vec<u32>,
    /// How well it went.
    pub report: UnwrapReport,
    /// Whether it was found on disk.
    pub was_cached: bool,
}

impl LinkedModel {
    /// Loads a model and builds its atlas.
    pub fn open(options: &ModelOptions, progress: &dyn Progress) -> Result<LinkedModel, EngineError> {
        let model = LinkedModel::load_model(options)?;
        progress.advance(Phase::Load, 1, 1);
        stop_if_canceled(progress)?;
        LinkedModel::link(model, options, progress)
    }

    /// Only loads the model.
    pub fn load_model(options: &ModelOptions) -> Result<Model, EngineError> {
        if !(options.scale.is_finite() && options.scale > 0.0) {
            let why = format!("the scale of a model is a number above 0, not {}", options.scale);
            return Err(EngineError::new(ErrorKind::Usage, why));
        }
        let load_options = LoadOptions {
            uv_set: options.uv,
            up: options.up,
            scale: options.scale,
        };
        let _span = tracing::debug_span!("load model", path = %options.path.display()).entered();
        Ok(load(&options.path, &load_options)?)
    }

    /// Builds or finds the atlas of a loaded model, which is unwrapped first where it has to be.
    pub fn link(mut model: Model, options: &ModelOptions, progress: &dyn Progress) -> Result<LinkedModel, EngineError> {
        let _span = tracing::debug_span!("link atlas", size = options.size).entered();
        progress.advance(Phase::Atlas, 0, 1);
        let unwrapped_anew = |model: &mut Model| {
            let made = unwrap_model(model, options);
            made.map_err(|error| refused(options, EngineError::of(ErrorKind::BadInput, error)))
        };
        let mut unwrapped = None;
        if options.overlap == Overlap::Unwrap || needs_unwrapping(&mut model) {
            unwrapped = Some(unwrapped_anew(&mut model)?);
            stop_if_canceled(progress)?;
        }
        let cache_dir = options.cache_folder();
        let atlas_options = AtlasOptions::new(options.size);
        let mut built = cached(cache_dir.as_deref(), &model.mesh, &atlas_options);
        if unwrapped.is_none() && matches!(built, Err(AtlasError::NoArea { .. })) {
            let sentence = "The model's UVs have no area, so it was unwrapped anew onto one sheet.";
            model.warnings.push(sentence.to_owned());
            unwrapped = Some(unwrapped_anew(&mut model)?);
            built = cached(cache_dir.as_deref(), &model.mesh, &atlas_options);
        }
        let (atlas, atlas_was_cached) = built.map_err(|error| refused(options, error.into()))?;
        progress.advance(Phase::Atlas, 1, 1);
        let (largest_side, farthest) = extents(&model);
        // After the atlas, which has refused meshes that are not whole.
        let pieces = Arc::new(Pieces::of(&model.mesh));
        Ok(LinkedModel {
            model: Arc::new(model),
            unwrapped,
            overlap: options.overlap,
            atlas,
            atlas_was_cached,
            pieces,
            bvh: Arc::default(),
            finest_texel: OnceLock::new(),
            usable_levels: OnceLock::new(),
            solidity: OnceLock::new(),
            largest_side,
            farthest,
            scale: f64::from(options.scale),
        })
    }

    /// The same model with an atlas of another size. The model itself, and what rays are followed through, are shared.
    pub fn resized(&self, options: &ModelOptions, progress: &dyn Progress) -> Result<LinkedModel, EngineError> {
        let _span = tracing::debug_span!("link atlas", size = options.size).entered();
        progress.advance(Phase::Atlas, 0, 1);
        let cache_dir = options.cache_folder();
        let built = cached(cache_dir.as_deref(), &self.model.mesh, &AtlasOptions::new(options.size));
        let (atlas, atlas_was_cached) = built.map_err(|error| refused(options, error.into()))?;
        progress.advance(Phase::Atlas, 1, 1);
        Ok(LinkedModel {
            model: self.model.clone(),
            unwrapped: self.unwrapped.clone(),
            overlap: self.overlap,
            atlas,
            atlas_was_cached,
            pieces: self.pieces.clone(),
            bvh: self.bvh.clone(),
            finest_texel: OnceLock::new(),
            usable_levels: OnceLock::new(),
            solidity: OnceLock::new(),
            ..*self
        })
    }

    /// What rays are followed through, built now if that was not done.
    pub(crate) fn hierarchy(&self) -> &Bvh {
        self.bvh.get_or_init(|| Bvh::build(&self.model.mesh))
    }

    /// Returns the model under a fit.
    pub fn fitted(&self, fit: Fit) -> FittedModel<'_> {
        FittedModel::new(self, fit)
    }

    /// Width of the finest texels, model units; see [`Atlas::finest_texel`].
    pub(crate) fn finest_texel(&self) -> f64 {
        *self
            .finest_texel
            .get_or_init(|| self.atlas.finest_texel(&self.model.mesh))
    }

    /// Coarser levels that may be used; see [`Atlas::usable_levels`].
    pub(crate) fn usable_levels(&self) -> u32 {
        *self.usable_levels.get_or_init(|| self.atlas.usable_levels())
    }
}

/// Whether a model has no UVs for some or all of its surface; says so.
fn needs_unwrapping(model: &mut Model) -> bool {
    if model.mesh.uvs.is_empty() {
        let sentence = "The model has no UVs, so it was unwrapped onto one sheet for all its materials.";
        model.warnings.push(sentence.to_owned());
        return true;
    }
    if model.without_uvs.is_empty() {
        return false;
    }
    model.warnings.push(format!(
        "A part of the model has no UVs ({}), so all of it was unwrapped anew onto one sheet for all its materials.",
        first_of(&model.without_uvs)
    ));
    true
}

/// The first few of a list, and how many more there are.
fn first_of(names: &[String]) -> String {
    const MOST_NAMED: usize = 4;
    let named = names[..names.len().min(MOST_NAMED)].join(", ");
    match names.len().saturating_sub(MOST_NAMED) {
        0 => named,
        more => format!("{named} and {more} more"),
    }
}

/// The same error with the path of the model before its sentences.
fn refused(options: &ModelOptions, error: EngineError) -> EngineError {
    error.said(|sentence| format!("{}: {sentence}", options.path.display()))
}

/// Puts the unwrapped mesh in the place of the model's own.
fn unwrap_model(model: &mut Model, options: &ModelOptions) -> Result<Unwrapping, UnwrapError> {
    let folder = options.cache_folder();
    let (unwrapped, was_cached) = unwrap_cached(folder.as_deref(), &model.mesh)?;
    model.mesh = unwrapped.mesh;
    model.warnings.extend(unwrapped.report.warnings.iter().cloned());
    let last = model.mesh.texture_uvs.last();
    Ok(Unwrapping {
        uv_set: last.map_or(0, |last| last.set.saturating_add(1)),
        source_vertex: unwrapped.source_vertex,
        report: unwrapped.report,
        was_cached,
    })
}

/// The largest side of the box around all triangles, and their largest coordinate; 1 for a model without extent.
fn extents(model: &Model) -> (f64, f64) {
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
    let farthest = low.iter().chain(&high).map(|at| at.abs()).fold(0.0, f64::max);
    let sound = |length: f64| {
        if length > 0.0 && length.is_finite() {
            length
        } else {
            1.0
        }
    };
    (sound(side), sound(farthest))
}

#[cfg(test)]
mod tests {
    use super::first_of;

    #[test]
    fn a_long_list_is_cut_short_and_counted() {
        let names: Vec<String> = ["a", "b", "c", "d", "e", "f"].map(str::to_owned).to_vec();
        assert_eq!(first_of(&names[..2]), "a, b");
        assert_eq!(first_of(&names[..4]), "a, b, c, d");
        assert_eq!(first_of(&names), "a, b, c, d and 2 more");
    }
}
