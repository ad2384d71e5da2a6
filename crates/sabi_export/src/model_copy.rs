//! A glTF copy of the model that uses the new maps: only what the baked materials look like is changed, on the JSON and
//! the buffers themselves, so that animations, skins, extensions and everything else that Sabi does not read stay unchanged. The
//! copy of a model that is no glTF, or that was unwrapped, is made from the loaded mesh.

mod compact;
mod companions;
mod container;
mod edit;
mod extensions;
mod finish_extensions;
mod finish_maps;
mod from_mesh;
mod left_out;
mod look;
mod map_file;
mod maps;
mod material;
mod numbers;
mod options;
mod pictures;
mod references;
mod wrap;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use sabi_surface::model::{Model, ModelMaterial, UvDecoding};
use serde_json::{Value as Json, json};

use self::compact::Uses;
use self::container::Container;
use self::edit::TextureUse;
use self::pictures::Pictures;
use self::wrap::{REPEAT, wraps};
use crate::ExportError;
use crate::names::{file_stem, set_names};

pub use self::finish_maps::{FinishMaps, Scaled};
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
    /// Files that it names and that are not maps of the bake.
    pub beside: Vec<CopiedFile>,
    /// Changes of the properties of the materials that got maps.
    pub changes: Vec<LookChange>,
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
    options: CopyOptions,
    stem: String,
    container: Container,
    document: Json,
    /// Warnings about content that a copy made from the loaded mesh lacks.
    warnings: Vec<String>,
}

/// Material of the model, with what the copy needs of it.
#[derive(Debug)]
struct CopiedMaterial {
    /// Name in reports.
    name: String,
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
    pub fn open(
        path: &Path,
        model: &Model,
        uv_set: u32,
        baked: &BTreeSet<u32>,
        options: CopyOptions,
    ) -> Result<ModelCopy, ExportError> {
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
        let names = set_names(model);
        let copied = |((index, material), (wrap, name)): ((usize, &ModelMaterial), (u32, String))| CopiedMaterial {
            name,
            file_index: if is_made { Some(index) } else { material.file_index },
            wrap,
            uv_decoding: material.uv_decoding.filter(|_| !is_made),
        };
        let materials = model.materials.iter().enumerate();
        Ok(ModelCopy {
            path: path.to_owned(),
            materials: materials.zip(wraps(model).into_iter().zip(names)).map(copied).collect(),
            uv_set,
            is_one_sheet,
            options,
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
        let uses = Uses::of(&mut self.document);
        let with_places = |(material, maps)| (self.material_of_file(material), material, maps);
        let mut materials: Vec<(usize, u32, MaterialMaps)> = baked.into_iter().map(with_places).collect();
        let mut pictures = Pictures::new(&self.document);
        let keeps_look = self.options.keeps_look;
        let mut befores = Vec::new();
        for (index, ..) in &materials {
            let material = &mut self.document["materials"][*index];
            befores.push(material.clone());
            look::strip(material, keeps_look);
        }
        pictures.find_free(&self.document);
        self.add_maps(&mut materials, &mut pictures);
        let changes = self.changes(&materials, &befores);
        let placed = pictures.finish(&mut self.document, uses.as_ref());
        self.container.forget(&mut self.document, &placed.dead);
        extensions::keep_lists_true(&mut self.document, &known);
        let mut beside = placed.files;
        let mut warnings = std::mem::take(&mut self.warnings);
        warnings.extend(companions::bring_along(
            &mut self.document,
            &self.path,
            &self.stem,
            &placed.new,
            is_taken,
            &mut beside,
        ));
        let name = self.file_name();
        let joined = self.container.join(&mut self.document);
        let bytes = joined.map_err(|bytes| ExportError::CopyTooLarge { path: self.path, bytes })?;
        let copy = CopiedFile { name, bytes };
        Ok(FinishedCopy {
            copy,
            beside,
            changes,
            warnings,
        })
    }

    /// Adds the new maps and factors to stripped materials, each with its place in the file and its number in the model.
    fn add_maps(&mut self, materials: &mut [(usize, u32, MaterialMaps)], pictures: &mut Pictures) {
        // Materials on one sheet share their textures.
        let mut shared: BTreeMap<(String, u32), usize> = BTreeMap::new();
        for (index, material, maps) in materials.iter_mut() {
            let known = self.materials.get(*material as usize);
            let (wrap, decoding) = known.map_or((REPEAT, None), |known| (known.wrap, known.uv_decoding));
            let mut place = |document: &mut Json, map: MapFile| {
                let add = || pictures.add(document, &mut self.container, map.clone(), wrap);
                TextureUse {
                    index: *shared.entry((map.name.clone(), wrap)).or_insert_with(add),
                    uv_set: self.uv_set,
                    decoding,
                }
            };
            edit::add_maps(&mut self.document, *index, maps, &mut place);
            look::set_alpha_mode(&mut self.document["materials"][*index], maps, self.options.keeps_look);
        }
    }

    /// Returns the changes of the look of materials, and removes what stands in the way of the new look from their primitives.
    fn changes(&mut self, materials: &[(usize, u32, MaterialMaps)], befores: &[Json]) -> Vec<LookChange> {
        let keeps_look = self.options.keeps_look;
        let mut changes = Vec::new();
        for ((index, material, _), before) in materials.iter().zip(befores) {
            let name = self.name(*material);
            changes.extend(look::changes(&name, before, &self.document["materials"][*index]));
            changes.extend(look::change_primitives(&name, &mut self.document, *index, keeps_look));
        }
        changes
    }

    /// Name of a material in reports.
    fn name(&self, material: u32) -> String {
        let known = self.materials.get(material as usize);
        known.map_or_else(|| self.stem.clone(), |known| known.name.clone())
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
}

#[cfg(test)]
mod tests;
