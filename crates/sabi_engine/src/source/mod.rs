//! Node kinds that are implemented in Rust, one file each: sources and outputs.

mod corners;
mod id_color;
mod image;
mod image_params;
mod material_canvas;
pub(crate) mod mip_chain;
mod model;
mod model_finish;
mod model_pictures;
mod model_textures;
mod output_color;
mod output_map;
mod output_mask;
mod output_material;
mod output_vector;
pub(crate) mod paint;
mod part_groups;
pub(crate) mod picture_table;
mod projection;
pub(crate) mod ray_cache;
pub(crate) mod session_pictures;
pub(crate) mod strokes;
mod surface_id;
mod texels;
mod vertex_color;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sabi_cancel::CanceledWork;
use sabi_files::{PathBase, TrustedPaths};
use sabi_gpu::{GpuError, PlaneData, RayScene, SourceCanvas, SourceFill, TileSet};
use sabi_graph::{FlatGraph, FlatNode};
use sabi_nodes::link::Plane;
use sabi_plan::{NoSuchValue, SourceKind, SourceStep};
use sabi_surface::bvh::Bvh;
use sabi_surface::model::Model;

use crate::phases::{Progress, watched};
use crate::program_cache::ProgramCache;

pub use paint::without_paint;
pub use session_pictures::SessionPictures;
pub use strokes::{FlattenedFile, Strokes, paint_folder};

pub(crate) use model::NAME as SOURCE_MODEL;
pub(crate) use output_map::map_output;
pub(crate) use output_material::{NAME as OUTPUT_MATERIAL, claim};
use paint::PaintedNode;
use ray_cache::RayCache;
use session_pictures::{OpenPicture, allowed_path};
pub(crate) use texels::SourceSurface;

/// Source or output kinds by id.
pub(crate) type SourceKinds = BTreeMap<String, SourceKind>;

/// Returns the source kinds by id. The properties of those that show the model are set once it is loaded.
pub(crate) fn kinds() -> SourceKinds {
    by_id([
        image::kind(),
        model::kind(),
        paint::kind(),
        surface_id::kind(),
        vertex_color::kind(),
    ])
}

/// Returns the kinds that show the model, with the properties of this one.
pub(crate) fn kinds_for(model: &Model) -> [SourceKind; 3] {
    [
        model::kind_for(model),
        surface_id::kind_for(model),
        vertex_color::kind_for(model),
    ]
}

/// Hashes bytes after their length, so that neighboring values cannot be confused.
fn hash_apart(hash: &mut blake3::Hasher, bytes: &[u8]) {
    hash.update(&(bytes.len() as u64).to_le_bytes());
    hash.update(bytes);
}

/// Returns the output kinds by id.
pub(crate) fn sinks() -> SourceKinds {
    by_id([
        output_material::kind(),
        output_mask::kind(),
        output_color::kind(),
        output_vector::kind(),
    ])
}

fn by_id(kinds: impl IntoIterator<Item = SourceKind>) -> SourceKinds {
    kinds.into_iter().map(|kind| (kind.id.clone(), kind)).collect()
}

/// Access to the files that nodes name.
#[derive(Clone)]
pub(crate) struct Files<'a> {
    pub(crate) pictures: &'a SessionPictures,
    pub(crate) strokes: &'a Strokes,
    /// Path of the graph.
    pub(crate) path: &'a Path,
    /// Base of paths in the graph.
    pub(crate) base: PathBase,
    pub(crate) trusted: &'a TrustedPaths,
    /// Memory that the pictures of the model may take, bytes.
    pub(crate) memory_bytes: u64,
    pub(crate) graph: &'a FlatGraph,
}

/// Provider of the results of all source kinds.
pub(crate) struct Sources<'a> {
    surface: SourceSurface<'a>,
    files: Files<'a>,
    model: model::ModelSource<'a>,
    ray_cache: &'a RayCache,
    kept_results: Option<&'a ProgramCache>,
    /// Cancels the decoding of pictures.
    progress: &'a dyn Progress,
    /// Warnings about things that cannot be shown.
    pub(crate) warnings: Vec<String>,
}

impl<'a> Sources<'a> {
    /// Creates sources. Files are opened on first use.
    pub(crate) fn new(
        surface: SourceSurface<'a>,
        files: Files<'a>,
        ray_cache: &'a RayCache,
        kept_results: Option<&'a ProgramCache>,
        progress: &'a dyn Progress,
    ) -> Sources<'a> {
        Sources {
            surface,
            files,
            model: model::ModelSource::default(),
            ray_cache,
            kept_results,
            progress,
            warnings: Vec::new(),
        }
    }
}

impl Files<'_> {
    /// Returns the file that contains a node: the graph, or a group file.
    fn file_of(&self, node: &FlatNode) -> PathBuf {
        match &node.file {
            Some(group) => self.base.resolve(group),
            None => self.path.to_owned(),
        }
    }

    /// Opens the picture of a `source/image`.
    fn picture(&self, step: &SourceStep) -> Result<Arc<OpenPicture>, String> {
        let written = step.values.text("file").map_err(|error| unread(step, &error))?;
        let layer = step.values.text("layer").map_err(|error| unread(step, &error))?;
        let path = allowed_path(&self.base, self.trusted, &self.graph.nodes[step.node], written);
        let opened = path.and_then(|path| self.pictures.open(&path, written, layer));
        opened.map_err(|(why, _)| format!("node '{}' ({}): {why}", step.id, step.kind))
    }
}

/// Returns a sentence about a node whose source cannot read one of its parameters.
fn unread(step: &SourceStep, error: &NoSuchValue) -> String {
    format!("node '{}' ({}): {error}", step.id, step.kind)
}

/// Returns the error of a run with a sentence about one of its nodes.
fn of_node(step: &SourceStep, reason: String) -> GpuError {
    GpuError::Node {
        node: step.id.clone(),
        reason,
    }
}

/// Returns the error of a node whose source cannot read one of its parameters.
fn unreadable(step: &SourceStep, error: &NoSuchValue) -> GpuError {
    of_node(step, unread(step, error))
}

impl SourceFill for Sources<'_> {
    fn draw(
        &mut self,
        canvas: &SourceCanvas<'_>,
        step: &SourceStep,
        output: &str,
        plane: Plane,
    ) -> Result<bool, GpuError> {
        let (surface, warnings) = (&self.surface, &mut self.warnings);
        match step.kind.as_str() {
            image::NAME => {
                let picture = watched(self.progress, || self.files.picture(step));
                let picture = picture.map_err(|CanceledWork| GpuError::Canceled)?;
                let picture = picture.map_err(|why| of_node(step, why))?;
                image::draw(surface, canvas, step, output, &picture, warnings)?;
            }
            model::NAME => {
                let Files {
                    pictures, memory_bytes, ..
                } = self.files;
                let opened = watched(self.progress, || {
                    self.model.open(surface, pictures, memory_bytes, warnings)
                });
                opened.map_err(|CanceledWork| GpuError::Canceled)?;
                self.model.draw(surface, canvas, output, plane, warnings)?;
            }
            surface_id::NAME => surface_id::draw(surface, canvas, step, output, warnings)?,
            vertex_color::NAME => vertex_color::draw(surface, canvas, &step.id, plane, warnings)?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn plane(
        &mut self,
        step: &SourceStep,
        output: &str,
        plane: Plane,
        inputs: &[Option<PlaneData>],
        tiles: Option<&TileSet>,
    ) -> Result<Vec<u8>, String> {
        if step.kind != paint::NAME {
            return Err(format!(
                "node '{}' is of kind '{}', which no source fills; this is a defect of Sabi",
                step.id, step.kind
            ));
        }
        let surface = &SourceSurface { tiles, ..self.surface };
        let graph = self.files.file_of(&self.files.graph.nodes[step.node]);
        let strokes = self.files.strokes;
        let painted = PaintedNode::of(surface, strokes, &graph, step, output, inputs, &mut self.warnings);
        painted
            .map(|painted| painted.plane(plane))
            .map_err(|error| unread(step, &error))
    }

    fn changed_tiles(&mut self, before: &SourceStep, now: &SourceStep) -> Option<TileSet> {
        if now.kind != paint::NAME {
            return None;
        }
        let graph = self.files.file_of(&self.files.graph.nodes[now.node]);
        let strokes = self.files.strokes;
        paint::changed_tiles(&self.surface, strokes, &graph, [before, now], &mut self.warnings)
    }

    fn plane_tiles(
        &mut self,
        step: &SourceStep,
        output: &str,
        plane: Plane,
        inputs: &[Option<PlaneData>],
        tiles: &TileSet,
    ) -> Result<Vec<u8>, String> {
        let graph = self.files.file_of(&self.files.graph.nodes[step.node]);
        let strokes = self.files.strokes;
        let painted = PaintedNode::of(&self.surface, strokes, &graph, step, output, inputs, &mut self.warnings);
        painted
            .map(|painted| painted.tiles(plane, tiles))
            .map_err(|error| unread(step, &error))
    }

    fn caches_rays(&self) -> bool {
        self.ray_cache.is_open()
    }

    fn cached_rays(&mut self, key: &[u8; 32]) -> Option<Vec<u8>> {
        self.ray_cache.find(key)
    }

    fn cache_rays(&mut self, key: &[u8; 32], results: &[u8]) {
        self.warnings.extend(self.ray_cache.keep(key, results));
    }

    fn keeps_results(&self) -> bool {
        self.kept_results.is_some()
    }

    fn has_result(&self, key: &[u8; 32]) -> bool {
        self.kept_results.is_some_and(|kept| kept.contains(key))
    }

    fn kept_result(&mut self, key: &[u8; 32]) -> Option<Vec<u8>> {
        self.kept_results?.find(key)
    }

    fn keep_result(&mut self, key: &[u8; 32], result: &[u8]) {
        if let Some(kept) = self.kept_results {
            kept.keep(key, result);
        }
    }

    fn scene(&mut self) -> Result<RayScene<'_>, String> {
        Ok(RayScene {
            bvh: self.surface.bvh.get_or_init(|| Bvh::build(&self.surface.model.mesh)),
            working_from_model: self.surface.working_from_model,
            on_device: self.surface.bvh_on_device,
        })
    }
}
