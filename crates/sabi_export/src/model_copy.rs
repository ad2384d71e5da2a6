//! A glTF copy of the model that uses the new maps: only what the baked materials look like is changed, on the JSON and
//! the buffers themselves, so that animations, skins, extensions and everything else that Sabi does not read stay unchanged. The
//! copy of a model that is no glTF, or that was unwrapped, is made from the loaded mesh.

mod container;
mod edit;
mod extensions;
mod finish_extensions;
mod finish_maps;
mod from_mesh;
mod left_out;
mod map_file;
mod maps;
mod material;
mod numbers;
mod pictures;
mod references;

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use sabi_surface::load::named_file;
use sabi_surface::model::{Model, ModelMaterial, UvDecoding};
use serde_json::{Value as Json, json};

use self::container::Container;
use self::edit::TextureUse;
use self::pictures::Pictures;
use crate::ExportError;
use crate::names::file_stem;

pub use self::finish_maps::{FinishMaps, Scaled};
pub use self::map_file::MapFile;
pub(crate) use self::map_file::{ChannelInput, WrittenMap};
pub(crate) use self::maps::MapCollector;
pub use self::maps::MaterialMaps;

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
    /// Files that it names and that are not maps of the bake.
    pub beside: Vec<CopiedFile>,
    /// Warnings about files that were not copied, as sentences.
    pub warnings: Vec<String>,
}

/// A model that is to be copied with new maps.
#[derive(Debug)]
pub struct ModelCopy {
    path: PathBuf,
    /// Materials of the model.
    materials: Vec<CopiedMaterial>,
    uv_set: u32,
    /// True if one set of maps serves all materials.
    is_one_sheet: bool,
    stem: String,
    container: Container,
    document: Json,
    /// Warnings about content that a copy made from the loaded mesh lacks.
    warnings: Vec<String>,
}

/// Material of the model, with what the copy needs of it.
#[derive(Debug)]
struct CopiedMaterial {
    /// Its place in the file; none for glTF's default material.
    file_index: Option<usize>,
    /// Wrap mode of its maps outside 0..1.
    wrap: u32,
    /// Transform that its textures need, since the copy keeps the coordinates as the file stores them.
    uv_decoding: Option<UvDecoding>,
}

impl ModelCopy {
    /// Reads the file again: `model` is what was loaded from it, with `uv_set` as the set of the maps. Models that are no
    /// glTF, and those that were unwrapped or have smoothed normals, are copied as they were loaded: turned,
    /// scaled, triangulated; `baked` are their materials that get maps.
    pub fn open(path: &Path, model: &Model, uv_set: u32, baked: &BTreeSet<u32>) -> Result<ModelCopy, ExportError> {
        let refuse = |reason: String| ExportError::Model {
            path: path.to_owned(),
            reason,
        };
        let is_one_sheet = model.mesh.is_one_sheet;
        let mut file = None;
        if model.is_gltf {
            let bytes = std::fs::read(path).map_err(|error| refuse(error.to_string()))?;
            let (container, document) = Container::split(&bytes).map_err(refuse)?;
            let there = document["materials"].as_array().map_or(0, Vec::len);
            let named = model.materials.iter().filter_map(|material| material.file_index);
            if named.max().is_some_and(|last| last >= there) {
                return Err(refuse("it was changed while it was read".to_owned()));
            }
            file = Some((container, document));
        }
        // New UVs are in no set of the file.
        let is_made = model.mesh.uv_set.is_none() || model.is_smoothed || file.is_none();
        let mut warnings = Vec::new();
        let (container, document) = match file {
            Some(file) if !is_made => file,
            other => {
                let file = other.map(|(_, document)| document);
                warnings.extend(file.as_ref().and_then(left_out::left_out));
                from_mesh::glb(model, baked, uv_set, file.as_ref(), &mut warnings)
            }
        };
        let stem = match file_stem(&model.stem) {
            stem if stem.is_empty() => "model".to_owned(),
            stem => stem,
        };
        let copied = |((index, material), wrap): ((usize, &ModelMaterial), u32)| CopiedMaterial {
            file_index: if is_made { Some(index) } else { material.file_index },
            wrap,
            uv_decoding: material.uv_decoding.filter(|_| !is_made),
        };
        Ok(ModelCopy {
            path: path.to_owned(),
            materials: model
                .materials
                .iter()
                .enumerate()
                .zip(wraps(model))
                .map(copied)
                .collect(),
            uv_set,
            is_one_sheet,
            stem,
            container,
            document,
            warnings,
        })
    }

    /// Name of the copy: the model's own, `.glb` or `.gltf` as the model was, `.glb` where it was neither.
    pub fn file_name(&self) -> String {
        let ending = if self.container.is_glb() { "glb" } else { "gltf" };
        format!("{}.{ending}", self.stem)
    }

    /// Finishes the copy, with maps by material of the model; on one sheet the maps of material 0 are those of all materials.
    /// Maps of a `.glb` go into its binary chunk; those of a `.gltf`, or of a `.glb` whose first buffer is no such chunk, stay
    /// beside it. `is_taken` returns true for file names that the bake uses already.
    pub fn finish(
        mut self,
        mut baked: BTreeMap<u32, MaterialMaps>,
        is_taken: &dyn Fn(&str) -> bool,
    ) -> Result<FinishedCopy, ExportError> {
        if self.is_one_sheet
            && let Some(maps) = baked.remove(&0)
        {
            baked = (0..self.materials.len() as u32)
                .map(|material| (material, maps.clone()))
                .collect();
        }
        let known = extensions::present(&self.document);
        let mut materials = Vec::new();
        for (material, maps) in baked {
            let known = self.materials.get(material as usize);
            let (wrap, decoding) = known.map_or((REPEAT, None), |known| (known.wrap, known.uv_decoding));
            materials.push((self.material_of_file(material), wrap, decoding, maps));
        }
        let mut pictures = Pictures::new(&self.document);
        for (index, ..) in &materials {
            edit::strip(&mut self.document["materials"][*index]);
        }
        pictures.find_free(&self.document);
        // Materials on one sheet share their textures.
        let mut shared: BTreeMap<(String, u32), usize> = BTreeMap::new();
        for (index, wrap, decoding, maps) in materials {
            let mut place = |document: &mut Json, map: MapFile| {
                let add = || pictures.add(document, &mut self.container, map.clone(), wrap);
                TextureUse {
                    index: *shared.entry((map.name.clone(), wrap)).or_insert_with(add),
                    uv_set: self.uv_set,
                    decoding,
                }
            };
            edit::add_maps(&mut self.document, index, maps, &mut place);
        }
        let placed = pictures.finish(&mut self.document);
        self.container.forget(&mut self.document, &placed.dead);
        extensions::keep_lists_true(&mut self.document, &known);
        let mut beside = placed.files;
        let mut warnings = std::mem::take(&mut self.warnings);
        self.bring_along(&placed.new, is_taken, &mut beside, &mut warnings);
        let name = self.file_name();
        let joined = self.container.join(&mut self.document);
        let bytes = joined.map_err(|bytes| ExportError::CopyTooLarge { path: self.path, bytes })?;
        let copy = CopiedFile { name, bytes };
        Ok(FinishedCopy { copy, beside, warnings })
    }

    /// The place of a material in the file; the default material, which a file does not list, is added to it.
    fn material_of_file(&mut self, material: u32) -> usize {
        if let Some(index) = self.materials.get(material as usize).and_then(|known| known.file_index) {
            return index;
        }
        let index = edit::push(&mut self.document, "materials", json!({}));
        for primitive in edit::primitives(&mut self.document) {
            if primitive.get("material").is_none() {
                primitive["material"] = json!(index);
            }
        }
        index
    }

    /// Copies the buffers and pictures that the file names in files of their own, as far as they lie in its folder.
    fn bring_along(
        &mut self,
        new: &BTreeSet<usize>,
        is_taken: &dyn Fn(&str) -> bool,
        files: &mut Vec<CopiedFile>,
        warnings: &mut Vec<String>,
    ) {
        let mut own: BTreeSet<String> = files.iter().map(|file| file.name.to_lowercase()).collect();
        let mut take = |name: &str| !is_taken(name) && own.insert(name.to_lowercase());
        let mut brought: Vec<(String, String)> = Vec::new();
        for list in ["buffers", "images"] {
            let entries = self.document.get_mut(list).and_then(Json::as_array_mut);
            for (index, entry) in entries.into_iter().flatten().enumerate() {
                let is_new = list == "images" && new.contains(&index);
                let Some(uri) = entry["uri"].as_str().filter(|_| !is_new).map(str::to_owned) else {
                    continue;
                };
                if let Some((_, name)) = brought.iter().find(|(from, _)| *from == uri) {
                    entry["uri"] = json!(pictures::uri_of(name));
                    continue;
                }
                match named_file(&self.path, &uri) {
                    None => {}
                    Some(Err(reason)) => warnings.push(format!(
                        "the copy of the model names {uri} as the model does, but it was not copied: {reason}"
                    )),
                    // A downloaded model must not collect other files of this computer.
                    Some(Ok((_, file))) if !is_beside(&self.path, &file) => warnings.push(format!(
                        "the copy of the model names {uri} as the model does, but it was not copied: it lies outside of the \
                         model's folder; copy it by hand if it belongs to the model"
                    )),
                    Some(Ok((bytes, file))) => {
                        let name = free_name(&file, list, &self.stem, &mut take);
                        entry["uri"] = json!(pictures::uri_of(&name));
                        brought.push((uri, name.clone()));
                        files.push(CopiedFile { name, bytes });
                    }
                }
            }
        }
    }
}

/// Returns whether a file is in the model's folder or below, with links and `..` resolved.
fn is_beside(model: &Path, file: &Path) -> bool {
    let folder = match model.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    match (folder.canonicalize(), file.canonicalize()) {
        (Ok(folder), Ok(file)) => file.starts_with(folder),
        _ => false,
    }
}

/// A plain name for a copied file: a buffer goes by the model's name, a picture by its own.
fn free_name(file: &Path, list: &str, stem: &str, take: &mut dyn FnMut(&str) -> bool) -> String {
    let part = |part: Option<&OsStr>| part.map_or_else(String::new, |part| file_stem(&part.to_string_lossy()));
    let first = match part(file.file_stem()) {
        _ if list == "buffers" => stem.to_owned(),
        own if own.is_empty() => "picture".to_owned(),
        own => own,
    };
    let ending = part(file.extension());
    let mut number = 1;
    loop {
        let name = match number {
            1 => format!("{first}.{ending}"),
            number => format!("{first}_{number}.{ending}"),
        };
        if take(&name) {
            return name;
        }
        number += 1;
    }
}

/// Largest distance of UVs outside the unit square that still counts as its edge.
const EDGE: f32 = 1e-4;
/// glTF's wrap modes.
const CLAMP_TO_EDGE: u32 = 33071;
const REPEAT: u32 = 10497;

/// Returns the wrap mode of each material. Maps repeat where UVs leave the unit square; elsewhere repeating would let opposite edges
/// bleed into each other.
fn wraps(model: &Model) -> Vec<u32> {
    let mesh = &model.mesh;
    let mut wraps = vec![CLAMP_TO_EDGE; model.materials.len()];
    for (corners, material) in mesh.triangles.iter().zip(&mesh.triangle_material) {
        let mut uvs = corners.iter().filter_map(|vertex| mesh.uvs.get(*vertex as usize));
        let leaves = uvs.any(|uv| !uv.iter().all(|at| (-EDGE..=1.0 + EDGE).contains(at)));
        if let Some(wrap) = wraps.get_mut(*material as usize).filter(|_| leaves) {
            *wrap = REPEAT;
        }
    }
    wraps
}

#[cfg(test)]
mod tests;
