//! Model with its linked atlas.

mod fitted_model;
mod saved_reading;
mod unwrapping;

use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use sabi_files::TrustedPaths;
use sabi_graph::Fit;
use sabi_paint::SurfaceIndex;
use sabi_surface::atlas::{Atlas, AtlasError, AtlasOptions, Repeats, Udim, cached};
use sabi_surface::bvh::Bvh;
use sabi_surface::ground::Ground;
use sabi_surface::load::{LoadOptions, ModelFault, Up, is_smoothing_angle, load_trusting, mesh_bytes};
use sabi_surface::model::Model;
use sabi_surface::openness::Openness;
use sabi_surface::pieces::Pieces;
use sabi_surface::unwrap::UnwrapReport;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{EngineError, ErrorKind};
use crate::opening::memory::default_memory_bytes;
use crate::phases::{Phase, Progress, stop_if_canceled, unless_canceled};
use crate::warning::Warning;
pub use fitted_model::FittedModel;
pub use saved_reading::SavedReading;
use unwrapping::{Unwrap, unwrap_model, unwrapping};

/// Options for loading a model.
#[derive(Clone, Debug)]
pub struct ModelOptions {
    /// Model file.
    pub path: PathBuf,
    /// Number of the UV set.
    pub uv: u32,
    /// Up axis of the file.
    pub up: Up,
    /// Factor for all lengths of the file.
    pub scale: f32,
    /// Scene of a glTF file; `None` for the file's default scene.
    pub scene: Option<u32>,
    /// Angle between faces up to which their shading is smooth, in degrees; `None` for the normals of the file.
    pub smooth_degrees: Option<f32>,
    /// Parts that are used, and faces that are turned. Values that are missing here are taken from the graph, if it
    /// names the model.
    pub reading: SavedReading,
    /// Treatment of overlapping charts.
    pub overlap: Overlap,
    /// Treatment of UVs in several tiles.
    pub udim: Udim,
    /// Texels per UV unit.
    pub size: u32,
    /// Folder of the disk cache; `None` to build the atlas every time.
    pub cache_dir: Option<PathBuf>,
    /// Paths outside of the model's folder from which the model may open files.
    pub trusted: TrustedPaths,
    /// Maximum memory for its files and pictures, in bytes.
    pub memory_bytes: u64,
}

/// Treatment of charts that overlap on the maps: stacked and mirrored ones, or those of a repeating texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Overlap {
    /// Uses the result of the first chart. Surfaces whose UVs repeat so often that their maps would show little of them are
    /// unwrapped, each onto a sheet of its own.
    #[default]
    Auto,
    /// Uses the result of the first chart.
    First,
    /// Uses the mean of the results of all charts.
    Merge,
    /// Unwraps the whole model onto one sheet for all its materials, so that no charts overlap.
    Unwrap,
}

impl ModelOptions {
    /// Creates the default options of a model that the user names, at a size.
    pub fn new(path: &Path, size: u32) -> ModelOptions {
        ModelOptions {
            path: path.to_owned(),
            uv: 0,
            up: Up::Y,
            scale: 1.0,
            scene: None,
            smooth_degrees: None,
            reading: SavedReading::default(),
            overlap: Overlap::Auto,
            udim: Udim::Auto,
            size,
            cache_dir: None,
            trusted: TrustedPaths::of_file(path),
            memory_bytes: default_memory_bytes(),
        }
    }

    fn atlas_options(&self) -> AtlasOptions {
        AtlasOptions {
            udim: self.udim,
            memory_bytes: self.memory_bytes,
            ..AtlasOptions::new(self.size)
        }
    }

    fn cache_folder(&self) -> Option<PathBuf> {
        self.cache_dir.as_deref().map(|folder| folder.join("atlas"))
    }
}

/// Model with its linked atlas.
pub struct LinkedModel {
    /// Model, with the new mesh if it was unwrapped.
    pub model: Arc<Model>,
    /// Result of unwrapping; `None` if its own UVs are used.
    pub unwrapped: Option<UnwrapResult>,
    /// Treatment of overlapping charts.
    pub overlap: Overlap,
    /// Treatment of UVs in several tiles.
    pub(crate) udim: Udim,
    /// Materials that were unwrapped since their own UVs repeat too often.
    pub(crate) repeats: Vec<Repeats>,
    /// Linked atlas.
    pub atlas: Atlas,
    /// Connected pieces of its parts.
    pub pieces: Arc<Pieces>,
    /// Ray hierarchy. It is built for the first ray, or earlier by the live evaluator.
    pub bvh: Arc<OnceLock<Bvh>>,
    /// Index of the mesh for brushes. It is built for the first stroke.
    pub paint_index: Arc<OnceLock<SurfaceIndex>>,
    /// Its shade on the ground, computed when a picture first needs it.
    ground: Arc<OnceLock<Option<Ground>>>,
    /// Its openness for the charts of the atlas, computed when a picture first needs it.
    openness: OnceLock<Option<Openness>>,
    finest_texel: OnceLock<f64>,
    area: OnceLock<f64>,
    usable_levels: OnceLock<u32>,
    /// Warnings about properties on which rays depend.
    pub(crate) solidity: OnceLock<Vec<Warning>>,
    /// True if the atlas was read from the cache.
    pub atlas_was_cached: bool,
    /// Largest side of the bounding box, model units.
    pub largest_side: f64,
    /// Largest coordinate, model units.
    pub(crate) farthest: f64,
    /// Model units per unit of the file.
    pub scale: f64,
    /// Angle up to which its shading was smoothed, in degrees; `None` for the normals of the file.
    pub smooth_degrees: Option<f32>,
}

/// Shade of a model on the ground and on itself. Parts that cannot be computed are left out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ModelShade<'a> {
    pub(crate) ground: Option<&'a Ground>,
    pub(crate) openness: Option<&'a Openness>,
}

/// Result of unwrapping a model.
///
/// To export the model with UVs that fit its maps: [`LinkedModel::model`] has the unwrapped mesh in world space around
/// [`Model::middle`]. Its positions, normals, tangents and colors are written unchanged, every set of `texture_uvs` as the
/// `TEXCOORD` of its number, and `uvs`, the layout of the maps, as [`UnwrapResult::uv_set`].
#[derive(Clone, Debug, PartialEq)]
pub struct UnwrapResult {
    /// Number of the `TEXCOORD` for the new coordinates in an exported file: the first that its textures do not use.
    pub uv_set: u32,
    /// Vertex of the loaded mesh for each vertex of the new mesh.
    pub source_vertex: Vec<u32>,
    /// Quality of the result.
    pub report: UnwrapReport,
    /// True if it was read from the cache.
    pub was_cached: bool,
}

impl LinkedModel {
    /// Returns the number of bytes that its files, its mesh and its atlas take.
    pub(crate) fn memory_bytes(&self) -> u64 {
        self.model.file_bytes + mesh_bytes(self.model.mesh.triangles.len() as u64) + self.atlas.memory_bytes()
    }

    /// Loads a model and builds its atlas.
    pub fn open(options: &ModelOptions, progress: &dyn Progress) -> Result<LinkedModel, EngineError> {
        let model = LinkedModel::load_model(options, progress)?;
        progress.advance(Phase::Load, 1, 1);
        stop_if_canceled(progress)?;
        LinkedModel::link(model, options, progress)
    }

    /// Loads a model without its atlas. Can be canceled at any moment.
    pub fn load_model(options: &ModelOptions, progress: &dyn Progress) -> Result<Model, EngineError> {
        if !(options.scale.is_finite() && options.scale > 0.0) {
            let why = format!("the scale of a model is a number above 0, not {}", options.scale);
            return Err(EngineError::new(ErrorKind::Usage, why));
        }
        if let Some(degrees) = options.smooth_degrees.filter(|degrees| !is_smoothing_angle(*degrees)) {
            return Err(EngineError::new(
                ErrorKind::Usage,
                ModelFault::Smooth(degrees).to_string(),
            ));
        }
        let load_options = LoadOptions {
            uv_set: options.uv,
            up: options.up,
            scale: options.scale,
            scene: options.scene,
            smooth_degrees: options.smooth_degrees,
            parts: options.reading.parts.clone(),
            turns_faces: options.reading.turns_faces(),
            textures: options.reading.textures.clone(),
            memory_bytes: options.memory_bytes,
        };
        let _span = tracing::debug_span!("load model", path = %options.path.display()).entered();
        let (path, trusted) = (options.path.clone(), options.trusted.clone());
        let loaded = unless_canceled(progress, move || load_trusting(&path, &trusted, &load_options))?;
        Ok(loaded?)
    }

    /// Builds the atlas of a loaded model or reads it from the cache. A model without usable UVs is unwrapped first. Can be
    /// canceled at any moment.
    pub fn link(model: Model, options: &ModelOptions, progress: &dyn Progress) -> Result<LinkedModel, EngineError> {
        let _span = tracing::debug_span!("link atlas", size = options.size).entered();
        progress.advance(Phase::Atlas, 0, 1);
        let own_options = options.clone();
        let linked = unless_canceled(progress, move || LinkedModel::linked(model, &own_options))??;
        progress.advance(Phase::Atlas, 1, 1);
        Ok(linked)
    }

    fn linked(mut model: Model, options: &ModelOptions) -> Result<LinkedModel, EngineError> {
        let unwrapped_anew = |model: &mut Model, what: &Unwrap| {
            let made = unwrap_model(model, options, what);
            made.map_err(|error| refused(options, EngineError::of(ErrorKind::BadInput, error)))
        };
        let mut unwrapped = None;
        let (what, repeats) = unwrapping(&mut model, options);
        if let Some(what) = what {
            unwrapped = Some(unwrapped_anew(&mut model, &what)?);
        }
        let cache_dir = options.cache_folder();
        let atlas_options = options.atlas_options();
        let mut built = cached(cache_dir.as_deref(), &model.mesh, &atlas_options);
        if unwrapped.is_none() && matches!(built, Err(AtlasError::NoArea { .. })) {
            let sentence = "The model's UVs have no area, so it was unwrapped again onto one sheet.";
            model.warnings.push(sentence.to_owned());
            unwrapped = Some(unwrapped_anew(&mut model, &Unwrap::All)?);
            built = cached(cache_dir.as_deref(), &model.mesh, &atlas_options);
        }
        let (atlas, atlas_was_cached) = built.map_err(|error| refused(options, error.into()))?;
        let (largest_side, farthest) = extents(&model);
        // This comes after the atlas, which refuses incomplete meshes.
        let pieces = Arc::new(Pieces::of(&model.mesh));
        Ok(LinkedModel {
            model: Arc::new(model),
            unwrapped,
            overlap: options.overlap,
            udim: options.udim,
            repeats,
            atlas,
            atlas_was_cached,
            pieces,
            bvh: Arc::default(),
            paint_index: Arc::default(),
            ground: Arc::default(),
            openness: OnceLock::new(),
            finest_texel: OnceLock::new(),
            area: OnceLock::new(),
            usable_levels: OnceLock::new(),
            solidity: OnceLock::new(),
            largest_side,
            farthest,
            scale: f64::from(options.scale),
            smooth_degrees: options.smooth_degrees,
        })
    }

    /// Builds the atlas for another size. The model and its ray hierarchy are shared.
    pub fn resized(&self, options: &ModelOptions, progress: &dyn Progress) -> Result<LinkedModel, EngineError> {
        let _span = tracing::debug_span!("link atlas", size = options.size).entered();
        progress.advance(Phase::Atlas, 0, 1);
        let (cache_dir, atlas_options, model) = (options.cache_folder(), options.atlas_options(), self.model.clone());
        let built = unless_canceled(progress, move || {
            cached(cache_dir.as_deref(), &model.mesh, &atlas_options)
        })?;
        let (atlas, atlas_was_cached) = built.map_err(|error| refused(options, error.into()))?;
        progress.advance(Phase::Atlas, 1, 1);
        Ok(LinkedModel {
            model: self.model.clone(),
            unwrapped: self.unwrapped.clone(),
            repeats: self.repeats.clone(),
            atlas,
            atlas_was_cached,
            pieces: self.pieces.clone(),
            bvh: self.bvh.clone(),
            paint_index: self.paint_index.clone(),
            ground: self.ground.clone(),
            openness: OnceLock::new(),
            finest_texel: OnceLock::new(),
            area: OnceLock::new(),
            usable_levels: OnceLock::new(),
            solidity: OnceLock::new(),
            ..*self
        })
    }

    /// Returns the ray hierarchy, built on first use.
    pub(crate) fn hierarchy(&self) -> &Bvh {
        self.bvh.get_or_init(|| Bvh::build(&self.model.mesh))
    }

    /// Returns the shade of the model, computed on first use or read from a cache folder.
    pub(crate) fn shade(&self, cache_dir: Option<&Path>) -> ModelShade<'_> {
        let _span = tracing::debug_span!("find the shade of the model").entered();
        let (mesh, bvh) = (&self.model.mesh, self.hierarchy());
        let ground = self.ground.get_or_init(|| Ground::of(mesh, bvh));
        let openness = self.openness.get_or_init(|| {
            let folder = cache_dir.map(|folder| folder.join("atlas"));
            // If an atlas of that size cannot be built, the model is drawn without it.
            Openness::of(mesh, &self.atlas, bvh, folder.as_deref()).ok()
        });
        ModelShade {
            ground: ground.as_ref(),
            openness: openness.as_ref(),
        }
    }

    /// Returns the shade of the model if it has been computed.
    pub(crate) fn found_shade(&self) -> Option<ModelShade<'_>> {
        let (ground, openness) = (self.ground.get()?, self.openness.get()?);
        Some(ModelShade {
            ground: ground.as_ref(),
            openness: openness.as_ref(),
        })
    }

    /// Returns the model under a fit.
    pub fn fitted(&self, fit: Fit) -> FittedModel<'_> {
        FittedModel::new(self, fit)
    }

    /// Returns the width of the finest texels, model units; see [`Atlas::finest_texel`].
    pub(crate) fn finest_texel(&self) -> f64 {
        *self
            .finest_texel
            .get_or_init(|| self.atlas.finest_texel(&self.model.mesh))
    }

    /// Returns the area of the surface, square model units.
    pub(crate) fn area(&self) -> f64 {
        *self.area.get_or_init(|| self.model.mesh.area())
    }

    /// Returns the number of usable coarser levels; see [`Atlas::usable_levels`].
    pub(crate) fn usable_levels(&self) -> u32 {
        *self.usable_levels.get_or_init(|| self.atlas.usable_levels())
    }
}

/// Adds the path of the model to an error.
fn refused(options: &ModelOptions, error: EngineError) -> EngineError {
    error.map_messages(|sentence| format!("{}: {sentence}", options.path.display()))
}

/// Returns the largest side of the bounding box and the largest coordinate; 1 for a model without extent.
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
