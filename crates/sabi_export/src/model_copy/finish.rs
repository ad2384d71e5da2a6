//! Last step of a copy: adding the new maps to its document.

use std::collections::{BTreeMap, BTreeSet};

use sabi_surface::model::UvDecoding;
use serde_json::{Value as Json, json};

use super::compact::UsedEntries;
use super::edit::TextureUse;
use super::geometry::{EditedGeometry, GeometryEdits, Tangents, unwrapped_materials};
use super::map_file::MapFile;
use super::maps::MaterialMaps;
use super::picture_slots::PictureSlots;
use super::wrap::{CLAMP_TO_EDGE, REPEAT};
use super::{CopiedFile, FinishedCopy, LookChange, ModelCopy, Treatment, companions, edit, extensions, look, tiles};
use crate::{ExportError, SetKey};

/// A material that gets maps, or one tile of it.
struct BakedMaterial {
    key: SetKey,
    /// Its place in the document.
    index: usize,
    maps: MaterialMaps,
    /// Its JSON before.
    before: Json,
}

impl ModelCopy<'_> {
    /// Finishes the copy with the maps of each set. The maps of a single sheet are used for all materials. Maps of a `.glb`
    /// are stored in its binary chunk. Maps of a `.gltf`, or of a `.glb` whose first buffer is not that chunk, are separate
    /// files. `is_taken` returns true for file names that the bake already uses.
    pub fn finish(
        mut self,
        maps: BTreeMap<SetKey, MaterialMaps>,
        is_taken: &dyn Fn(&str) -> bool,
    ) -> Result<FinishedCopy, ExportError> {
        if self.options.embeds {
            companions::adopt_first_buffer(&mut self.document, &mut self.container, self.source);
        }
        let known = extensions::present(&self.document);
        let uses = UsedEntries::of(&mut self.document);
        let mut baked = self.baked(maps);
        self.keep_materials_of_others(&baked);
        let mut pictures = PictureSlots::new(&self.document, self.options.embeds);
        self.replace_looks(&mut baked, &mut pictures);
        let mut changes = self.changes(&baked);
        let geometry = self.edit_geometry(&baked, &mut changes, is_taken)?;
        let placed = pictures.finish(&mut self.document, uses.as_ref(), &self.container);
        self.container.forget(&mut self.document, &placed.dead);
        extensions::keep_lists_true(&mut self.document, &known);
        let mut warnings = std::mem::take(&mut self.warnings);
        warnings.extend(geometry.warnings);
        let buffers = self.document["buffers"].as_array().map_or(0, Vec::len);
        let new_buffer = geometry.file.as_ref().map(|_| buffers - 1);
        let mut beside: Vec<CopiedFile> = placed.files.into_iter().chain(geometry.file).collect();
        let is_new = |list: &str, index: usize| match list {
            "images" => placed.new.contains(&index),
            _ => new_buffer == Some(index),
        };
        let source = self.source;
        warnings.extend(if self.options.embeds {
            companions::embed(&mut self.document, &mut self.container, source)
        } else {
            companions::bring_along(&mut self.document, source, &self.stem, &is_new, is_taken, &mut beside)
        });
        let name = self.file_name();
        let joined = self.container.join(&mut self.document);
        let path = self.source.path.to_owned();
        let bytes = joined.map_err(|bytes| ExportError::CopyTooLarge { path, bytes })?;
        Ok(FinishedCopy {
            copy: CopiedFile { name, bytes },
            beside,
            changes,
            warnings,
        })
    }

    /// The materials that get maps, with their places.
    fn baked(&mut self, mut maps: BTreeMap<SetKey, MaterialMaps>) -> Vec<BakedMaterial> {
        if self.source.model.mesh.is_one_sheet
            && let Some((key, of_sheet)) = maps.pop_first()
        {
            let all = 0..self.materials.len() as u32;
            maps = all
                .map(|material| (SetKey { material, ..key }, of_sheet.clone()))
                .collect();
        }
        let place = |(key, maps)| {
            let index = self.place(key);
            BakedMaterial {
                key,
                index,
                maps,
                before: self.document["materials"][index].clone(),
            }
        };
        let mut maps: Vec<(SetKey, MaterialMaps)> = maps.into_iter().collect();
        maps.sort_by_key(|(key, _)| (key.material, key.udim));
        let baked: Vec<BakedMaterial> = maps.into_iter().map(place).collect();
        for BakedMaterial { key, index, before, .. } in &baked {
            if let Some(udim) = key.udim {
                let own = before["name"].as_str().filter(|name| !name.is_empty());
                let name = own.map_or_else(|| self.name_of_material(key.material), str::to_owned);
                self.document["materials"][*index]["name"] = json!(format!("{name}.{udim}"));
            }
        }
        baked
    }

    /// Returns the index of the material of a set. The first tile of a material uses its index; the others get copies of it.
    fn place(&mut self, key: SetKey) -> usize {
        if let Some(place) = self.tile_places.get(&key) {
            return *place;
        }
        let own = self.material_of_file(key.material);
        if key.udim.is_none() {
            return own;
        }
        let place = if self.tiles.is_first(&key) {
            own
        } else {
            let material = self.document["materials"][own].clone();
            edit::push(&mut self.document, "materials", material)
        };
        self.tile_places.insert(key, place);
        place
    }

    /// Returns the index of a material in the file. The default material, which a file does not list, is added.
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

    /// Assigns a copy of the original material to primitives of baked materials that the bake did not include and that lack
    /// the UVs of its maps, including those of tiles: points, lines, and meshes of other scenes.
    fn keep_materials_of_others(&mut self, baked: &[BakedMaterial]) {
        let Some(origins) = self.source.model.origins.as_ref().filter(|_| self.bytes.is_some()) else {
            return;
        };
        let seen: BTreeSet<(usize, usize)> = origins
            .placed
            .iter()
            .map(|placed| (placed.mesh, placed.primitive))
            .collect();
        let unwrapped = unwrapped_materials(self.source.model);
        for of_baked in baked {
            let known = self.materials.get(of_baked.key.material as usize);
            let set = format!("TEXCOORD_{}", known.map_or(0, |known| known.uv_set));
            let lacks_uvs = |primitive: &Json| {
                of_baked.key.udim.is_some()
                    || unwrapped.contains(&of_baked.key.material)
                    || primitive["attributes"].get(&set).is_none()
            };
            let mut kept = None;
            let meshes = self.document["meshes"].as_array().map_or(0, Vec::len);
            for mesh in 0..meshes {
                let primitives = self.document["meshes"][mesh]["primitives"]
                    .as_array()
                    .map_or(0, Vec::len);
                for number in (0..primitives).filter(|number| !seen.contains(&(mesh, *number))) {
                    let primitive = &self.document["meshes"][mesh]["primitives"][number];
                    if primitive["material"].as_u64() != Some(of_baked.index as u64) || !lacks_uvs(primitive) {
                        continue;
                    }
                    let document = &mut self.document;
                    let place = *kept.get_or_insert_with(|| edit::push(document, "materials", of_baked.before.clone()));
                    self.document["meshes"][mesh]["primitives"][number]["material"] = json!(place);
                }
            }
        }
    }

    /// Replaces the previous appearance by the new maps and factors.
    fn replace_looks(&mut self, baked: &mut [BakedMaterial], pictures: &mut PictureSlots) {
        let keeps_look = self.options.keeps_look;
        for of_baked in &*baked {
            look::strip(&mut self.document["materials"][of_baked.index], keeps_look);
        }
        pictures.find_free(&self.document);
        // Materials that share a sheet share their textures.
        let mut shared: BTreeMap<(String, u32), usize> = BTreeMap::new();
        for BakedMaterial { key, index, maps, .. } in baked {
            let known = self.materials.get(key.material as usize);
            let wrap = match key.udim {
                Some(_) => CLAMP_TO_EDGE,
                None => known.map_or(REPEAT, |known| known.wrap),
            };
            let decoding = known
                .and_then(|known| known.uv_decoding)
                .map(|decoding| match key.udim {
                    Some(_) => UvDecoding {
                        offset: tiles::in_tile(decoding.offset, key.uv_tile),
                        ..decoding
                    },
                    None => decoding,
                });
            let mut place = |document: &mut Json, map: MapFile| {
                let add = || pictures.add(document, &mut self.container, map.clone(), wrap);
                TextureUse {
                    index: *shared.entry((map.name.clone(), wrap)).or_insert_with(add),
                    uv_set: known.map_or(0, |known| known.uv_set),
                    decoding,
                }
            };
            edit::add_maps(&mut self.document, *index, maps, &mut place);
            look::set_alpha_mode(&mut self.document["materials"][*index], maps, keeps_look);
        }
    }

    /// Changes the primitives of the baked materials. Lists the changes of these and of the materials.
    fn changes(&mut self, baked: &[BakedMaterial]) -> Vec<LookChange> {
        let mut changes = Vec::new();
        for of_baked in baked {
            let name = self.name(of_baked.key);
            let keeps_look = self.options.keeps_look;
            let after = &self.document["materials"][of_baked.index];
            changes.extend(look::changes(&name, &of_baked.before, after, keeps_look));
            changes.extend(look::change_primitives(
                &name,
                &mut self.document,
                of_baked.index,
                keeps_look,
            ));
        }
        changes
    }

    /// Name of a set in reports.
    fn name(&self, key: SetKey) -> String {
        let name = self.name_of_material(key.material);
        match key.udim {
            Some(udim) => format!("{name}.{udim}"),
            None => name,
        }
    }

    fn name_of_material(&self, material: u32) -> String {
        let known = self.materials.get(material as usize);
        known.map_or_else(|| self.stem.clone(), |known| known.name.clone())
    }

    /// Writes new UVs, normals and tangents into the file's own document.
    fn edit_geometry(
        &mut self,
        baked: &[BakedMaterial],
        changes: &mut Vec<LookChange>,
        is_taken: &dyn Fn(&str) -> bool,
    ) -> Result<EditedGeometry, ExportError> {
        let (Some(bytes), Some(origins)) = (&self.bytes, &self.source.model.origins) else {
            return Ok(EditedGeometry::default());
        };
        let tangents = |of_baked: &BakedMaterial| {
            let material = &self.document["materials"][of_baked.index];
            let needed = tangents(material, self.options.keeps_look);
            ((of_baked.key.material, of_baked.key.udim), needed)
        };
        let edits = GeometryEdits {
            model: self.source.model,
            origins,
            unwrapped: unwrapped_materials(self.source.model),
            uv_sets: self.source.uv_sets(),
            tiles: (&self.tiles, &self.tile_places),
            tangents: baked.iter().map(tangents).collect(),
        };
        let stem = format!("{}_vertices", self.stem);
        let name = || companions::free_file_name(&stem, "bin", &mut |name| !is_taken(name));
        let name: Option<&dyn Fn() -> String> = if self.options.embeds { None } else { Some(&name) };
        let edited = edits.apply(&mut self.document, &mut self.container, bytes, name);
        let edited = edited.map_err(|reason| ExportError::Model {
            path: self.source.path.to_owned(),
            reason,
        })?;
        let of_tangents = baked.iter().filter_map(|BakedMaterial { key, .. }| {
            let is_new = edited.tangents.get(&(key.material, key.udim))?;
            Some(LookChange {
                material: self.name(*key),
                property: "TANGENT".to_owned(),
                change: if *is_new { Treatment::Set } else { Treatment::Removed },
            })
        });
        changes.extend(of_tangents);
        Ok(edited)
    }
}

/// The tangents that a baked material needs.
fn tangents(material: &Json, keeps_look: bool) -> Tangents {
    let extension = |name: &str| material["extensions"].get(name);
    // If the model had an anisotropy, it is one of the model's own maps.
    let anisotropy = extension("KHR_materials_anisotropy");
    if material.get("normalTexture").is_some() || anisotropy.is_some() && !keeps_look {
        return Tangents::New;
    }
    let coat = extension("KHR_materials_clearcoat");
    let is_coat_bumpy = coat.is_some_and(|coat| coat.get("clearcoatNormalTexture").is_some());
    match anisotropy.is_some() || is_coat_bumpy {
        true => Tangents::Foreign,
        false => Tangents::Unused,
    }
}
