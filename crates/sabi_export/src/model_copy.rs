//! A glTF copy of the model that uses the new maps. Only the appearance of the baked materials is changed, in the JSON and the buffers
//! themselves, so that animations, skins, extensions and everything else that Sabi does not read stay unchanged. UVs of an unwrapped model
//! are added as another set. The copy of a model in another format is made from the loaded mesh.

mod compact;
mod companions;
mod container;
mod edit;
mod extensions;
mod finish;
mod finish_extensions;
mod finish_maps;
mod from_mesh;
mod geometry;
mod left_out;
mod look;
mod map_file;
mod maps;
mod material;
mod numbers;
mod options;
mod picture_slots;
mod references;
mod tiles;
mod wrap;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use sabi_files::{Unread, read_plain};
use sabi_surface::model::{Model, UvDecoding};
use serde_json::Value as Json;

use self::container::Container;
use self::from_mesh::MeshCopy;
use self::geometry::{FileBytes, GeometryEdits, UvSets};
use self::tiles::MaterialTiles;
use self::wrap::wraps;
use crate::names::{file_stem, set_names};
use crate::{ExportError, SetKey};

pub use self::finish_maps::{FinishMaps, MappedFactor};
pub use self::geometry::unwrapped_materials;
pub use self::look::{LookChange, Treatment};
pub use self::map_file::MapFile;
pub(crate) use self::map_file::{ChannelInput, WrittenMap};
pub(crate) use self::maps::MapCollector;
pub use self::maps::MaterialMaps;
pub use self::options::CopyOptions;

/// A file to be written beside the maps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CopiedFile {
    /// Plain file name.
    pub name: String,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// Files and warnings of a copy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FinishedCopy {
    /// The `.gltf` or `.glb` file.
    pub copy: CopiedFile,
    /// Files to which the copy refers, except maps of the bake.
    pub beside: Vec<CopiedFile>,
    /// Changes of the properties of the materials that got maps.
    pub changes: Vec<LookChange>,
    /// Warnings about content that is missing in the copy, as sentences.
    pub warnings: Vec<String>,
}

/// A model and the numbers of its UV sets.
#[derive(Clone, Copy, Debug)]
pub struct CopySource<'m> {
    /// The model's file.
    pub path: &'m Path,
    /// What was loaded from it.
    pub model: &'m Model,
    /// Chosen UV set of the file.
    pub uv_set: u32,
    /// UV set for new coordinates, where any of the model was unwrapped.
    pub unwrapped_uv_set: Option<u32>,
}

/// A model that will be copied with new maps.
pub struct ModelCopy<'m> {
    source: CopySource<'m>,
    options: CopyOptions,
    materials: Vec<CopiedMaterial>,
    tiles: MaterialTiles,
    /// Indices in the document of the materials of UDIM tiles, as far as they exist.
    tile_places: BTreeMap<SetKey, usize>,
    stem: String,
    container: Container,
    document: Json,
    /// The file's buffers if its own document is changed; `None` for a document that was made from the loaded mesh.
    bytes: Option<FileBytes>,
    warnings: Vec<String>,
}

/// Material of the model, with the properties that the copy needs.
struct CopiedMaterial {
    /// Name in reports.
    name: String,
    /// Its index in the file; `None` for glTF's default material.
    file_index: Option<usize>,
    /// UV set of its maps.
    uv_set: u32,
    /// Wrap mode of its maps outside 0..1.
    wrap: u32,
    /// Transform that its textures need, since the copy keeps coordinates as stored in the file.
    uv_decoding: Option<UvDecoding>,
}

impl<'m> ModelCopy<'m> {
    /// Reads the file again. Models in other formats than glTF are copied as loaded: rotated, scaled, triangulated. `baked`
    /// are the sets that get maps.
    pub fn open(
        source: CopySource<'m>,
        baked: &BTreeSet<SetKey>,
        options: CopyOptions,
    ) -> Result<ModelCopy<'m>, ExportError> {
        let CopySource { model, .. } = source;
        let tiles = MaterialTiles::of(baked);
        let names = set_names(model);
        let name = |material: u32| {
            names
                .get(material as usize)
                .map_or(&*model.stem, |name| name)
                .to_owned()
        };
        let mut warnings = tiles.warnings(&model.mesh, &name);
        let mut tile_places = BTreeMap::new();
        let file = GltfModel::read(source, &tiles)?;
        let (container, document, bytes) = match file {
            Some(GltfModel {
                container,
                document,
                bytes,
                refused: None,
            }) => (container, document, Some(bytes)),
            other => {
                let document = other.as_ref().map(|file| &file.document);
                let refused = other
                    .as_ref()
                    .and_then(|file| Some((&file.document, file.refused.as_ref()?)));
                warnings.extend(refused.map(|(document, why)| left_out::left_out(document, why)));
                let made = MeshCopy {
                    model,
                    baked: &baked_materials(model, baked),
                    uv_set: source.mesh_uv_set(),
                    file: document,
                    tiles: &tiles,
                };
                tile_places = made.tile_places();
                let (container, document) = made.glb(&mut warnings);
                (container, document, None)
            }
        };
        let stem = match file_stem(&model.stem) {
            stem if stem.is_empty() => "model".to_owned(),
            stem => stem,
        };
        let is_made = bytes.is_none();
        Ok(ModelCopy {
            materials: materials(source, names, is_made),
            tiles,
            tile_places,
            source,
            options,
            stem,
            container,
            document,
            bytes,
            warnings,
        })
    }

    /// Returns the name of the copy: the model's own name, with `.glb` or `.gltf` as in the model, or `.glb` for other formats.
    pub fn file_name(&self) -> String {
        let ending = if self.container.is_glb() { "glb" } else { "gltf" };
        format!("{}.{ending}", self.stem)
    }
}

impl CopySource<'_> {
    /// UV sets of the file's own document.
    fn uv_sets(&self) -> UvSets {
        UvSets {
            chosen: self.uv_set,
            unwrapped: self.unwrapped_uv_set.unwrap_or(self.uv_set),
        }
    }

    /// UV set of all materials in a copy that is made from the loaded mesh.
    fn mesh_uv_set(&self) -> u32 {
        let last = self.model.mesh.texture_uvs.last();
        match self.unwrapped_uv_set {
            Some(unwrapped) => last.map_or(unwrapped, |last| unwrapped.max(last.set.saturating_add(1))),
            None => self.uv_set,
        }
    }
}

/// Returns the materials of sets. A single sheet belongs to all materials.
pub fn baked_materials(model: &Model, baked: &BTreeSet<SetKey>) -> BTreeSet<u32> {
    if model.mesh.is_one_sheet && !baked.is_empty() {
        (0..model.materials.len() as u32).collect()
    } else {
        baked.iter().map(|key| key.material).collect()
    }
}

/// The materials of the model in a copy.
fn materials(source: CopySource<'_>, names: Vec<String>, is_made: bool) -> Vec<CopiedMaterial> {
    let model = source.model;
    let unwrapped = unwrapped_materials(model);
    let named = model.materials.iter().zip(names).zip(wraps(model));
    named
        .enumerate()
        .map(|(index, ((material, name), wrap))| {
            let new_set = source.unwrapped_uv_set.filter(|_| unwrapped.contains(&(index as u32)));
            CopiedMaterial {
                name,
                file_index: if is_made { Some(index) } else { material.file_index },
                uv_set: match new_set {
                    _ if is_made => source.mesh_uv_set(),
                    Some(new_set) => new_set,
                    None => source.uv_set,
                },
                wrap,
                uv_decoding: material.uv_decoding.filter(|_| !is_made && new_set.is_none()),
            }
        })
        .collect()
}

/// The document of a glTF model.
struct GltfModel {
    container: Container,
    document: Json,
    bytes: FileBytes,
    /// Reason why its vertices cannot be changed, as a clause.
    refused: Option<String>,
}

impl GltfModel {
    /// Reads the document; `None` for models of other formats.
    fn read(source: CopySource<'_>, tiles: &MaterialTiles) -> Result<Option<GltfModel>, ExportError> {
        let CopySource { path, model, .. } = source;
        let refuse = |reason: String| ExportError::Model {
            path: path.to_owned(),
            reason,
        };
        let Some(origins) = &model.origins else {
            return Ok(None);
        };
        let bytes = read_plain(path, model.file_bytes).map_err(|unread| refuse(why_unread(unread)))?;
        let (container, document) = Container::split(&bytes).map_err(refuse)?;
        let there = document["materials"].as_array().map_or(0, Vec::len);
        let named = model.materials.iter().filter_map(|material| material.file_index);
        if named.max().is_some_and(|last| last >= there) {
            return Err(refuse("it was changed while it was read".to_owned()));
        }
        let bytes = FileBytes::read(source, &bytes, &document);
        let edits = GeometryEdits {
            model,
            origins,
            unwrapped: unwrapped_materials(model),
            uv_sets: source.uv_sets(),
            tiles: (tiles, &BTreeMap::new()),
            tangents: BTreeMap::new(),
        };
        let refused = edits.check(&document, &container, &bytes).err();
        Ok(Some(GltfModel {
            container,
            document,
            bytes,
            refused,
        }))
    }
}

/// Returns why the file of a loaded model cannot be read again, as a clause.
fn why_unread(unread: Unread) -> String {
    match unread {
        Unread::Missing => "it is not there any more".to_owned(),
        Unread::Folder | Unread::NotPlain => "it has become a folder or a device".to_owned(),
        Unread::TooLarge(_) => "it has grown since it was read".to_owned(),
        Unread::Refused(refusal) => refusal.to_string(),
        Unread::Other(reason) => reason,
    }
}

#[cfg(test)]
mod tests;
