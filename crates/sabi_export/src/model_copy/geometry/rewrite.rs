//! Rewriting of primitives.

use sabi_surface::model::{Mesh, ModelMaterial, PlacedPrimitive};
use serde_json::{Map, Value as Json, json};

use super::arrays::NewArrays;
use super::bytes::{DRACO, FileBytes, OfPrimitive};
use super::inverse_transform::InverseTransform;
use super::slots::{Slots, VertexValues};
use super::{EditedGeometry, GeometryEdits, PrimitivePart, SetName, Tangents, UvSets, changed};
use crate::model_copy::container::Container;
use crate::model_copy::edit::remove;
use crate::model_copy::from_mesh::MOST_SETS;
use crate::model_copy::tiles::in_tile;

/// Rewriter of the meshes of a document.
pub(super) struct Rewriter<'a> {
    pub(super) edits: &'a GeometryEdits<'a>,
    pub(super) file: &'a FileBytes,
    pub(super) container: &'a Container,
    pub(super) arrays: &'a mut NewArrays,
    pub(super) edited: &'a mut EditedGeometry,
}

/// Attributes of a primitive that are written.
#[derive(Clone, Copy)]
struct Attributes<'m> {
    uvs: Option<WrittenUvs<'m>>,
    normals: Option<&'m [[f32; 3]]>,
    tangents: WrittenTangents<'m>,
}

/// Texture coordinates by vertex of the mesh.
#[derive(Clone, Copy)]
struct WrittenUvs<'m> {
    set: u32,
    values: &'m [[f32; 2]],
    /// Tile that is moved into the unit square.
    tile: [i32; 2],
}

impl WrittenUvs<'_> {
    fn at(&self, vertex: usize) -> Option<[f32; 2]> {
        self.values.get(vertex).map(|uv| in_tile(*uv, self.tile))
    }
}

#[derive(Clone, Copy)]
enum WrittenTangents<'m> {
    AsTheyAre,
    Removed,
    New(&'m [[f32; 4]]),
}

const TANGENT: &str = "TANGENT";
/// Extensions of primitives that refer to no vertex by its number.
const WITHOUT_VERTICES: [&str; 3] = ["EXT_mesh_features", "EXT_structural_metadata", "KHR_materials_variants"];

/// Accessors of the vertices of a primitive, where these can be split; `is_unpacked` is true where they are known although the
/// primitive is packed. The error is a clause.
pub(super) fn accessors(primitive: &Json, is_unpacked: bool) -> Result<Vec<usize>, String> {
    let extensions = primitive["extensions"].as_object();
    for name in extensions.into_iter().flat_map(Map::keys) {
        match name.as_str() {
            DRACO if !is_unpacked => return Err(format!("its vertices are compressed ({DRACO})")),
            name if name == DRACO || WITHOUT_VERTICES.contains(&name) => {}
            name => return Err(format!("the extension {name} may count on the places of its vertices")),
        }
    }
    let targets = primitive["targets"].as_array().into_iter().flatten();
    let sets = std::iter::once(&primitive["attributes"]).chain(targets);
    let entries = sets.filter_map(Json::as_object).flatten();
    let numbers = entries.map(|(_, accessor)| accessor.as_u64().and_then(|at| usize::try_from(at).ok()));
    numbers.collect::<Option<Vec<usize>>>().ok_or_else(changed)
}

impl<'a> Rewriter<'a> {
    /// Returns the mesh `original` with its placed primitives rewritten. The error is a clause.
    pub(super) fn mesh(
        &mut self,
        document: &mut Json,
        original: &Json,
        placed: &[&PlacedPrimitive],
    ) -> Result<Json, String> {
        let mut rewritten = Vec::new();
        for (number, primitive) in original["primitives"].as_array().into_iter().flatten().enumerate() {
            let Some(placed) = placed.iter().find(|placed| placed.primitive == number) else {
                rewritten.push(primitive.clone());
                continue;
            };
            for part in self.edits.parts(placed) {
                rewritten.push(self.part(document, primitive, placed, &part)?);
            }
        }
        let mut mesh = original.clone();
        mesh["primitives"] = Json::Array(rewritten);
        Ok(mesh)
    }

    /// Returns a part of a primitive as a primitive of its own. The error is a clause.
    fn part(
        &mut self,
        document: &mut Json,
        original: &Json,
        placed: &PlacedPrimitive,
        part: &PrimitivePart,
    ) -> Result<Json, String> {
        let mut primitive = original.clone();
        let place = part.tile.and_then(|tile| self.edits.tiles.1.get(&tile));
        if let Some(place) = place {
            primitive["material"] = json!(place);
        }
        let attributes = self.attributes(&primitive, placed, part);
        let set = self.set(placed, part);
        match (self.primitive(document, &mut primitive, placed, part, attributes), set) {
            (Ok(()), Some(set)) => match attributes.tangents {
                WrittenTangents::Removed => {
                    self.edited.tangents.entry(set).or_insert(false);
                }
                WrittenTangents::New(_) => {
                    self.edited.tangents.insert(set, true);
                }
                WrittenTangents::AsTheyAre => {}
            },
            (Ok(()), None) => {}
            (Err(why), _) if self.edits.must_change(placed) => return Err(why),
            (Err(why), _) => {
                primitive = original.clone();
                remove_tangents(&mut primitive);
                self.warn(placed, &why);
            }
        }
        Ok(primitive)
    }

    fn set(&self, placed: &PlacedPrimitive, part: &PrimitivePart) -> Option<SetName> {
        let udim = part.tile.and_then(|tile| tile.udim);
        Some((self.edits.material(placed)?, udim))
    }

    /// Warns of a primitive without tangents, once for each material.
    fn warn(&mut self, placed: &PlacedPrimitive, why: &str) {
        let material = self.edits.material(placed);
        let material = material.and_then(|material| self.edits.model.materials.get(material as usize));
        let label = material.map_or_else(String::new, |material| material.label());
        let sentence = format!(
            "the copy of the model has no tangents for {label}, since {why}; programs make their own, which may differ from \
             those of the normal map"
        );
        if !self.edited.warnings.contains(&sentence) {
            self.edited.warnings.push(sentence);
        }
    }

    /// Changes a primitive to a part of it. The error is a clause.
    fn primitive(
        &mut self,
        document: &mut Json,
        primitive: &mut Json,
        placed: &PlacedPrimitive,
        part: &PrimitivePart,
        attributes: Attributes<'_>,
    ) -> Result<(), String> {
        if let WrittenTangents::Removed = attributes.tangents {
            remove_tangents(primitive);
        }
        if attributes.are_as_stored() && !part.is_split && !placed.is_turned {
            return Ok(());
        }
        let frame = InverseTransform::of(placed);
        let written = |vertex: usize| attributes.written(vertex);
        let slots = Slots::of(&part.triangles, self.edits.origins, frame.is_mirrored, &written);
        let positions = primitive["attributes"]["POSITION"].as_u64();
        let stored_count =
            positions.and_then(|accessor| document["accessors"].get(accessor as usize)?["count"].as_u64());
        let count = usize::try_from(stored_count.ok_or_else(changed)?).map_err(|_| changed())?;
        if slots.sources.last().is_some_and(|last| *last as usize >= count) {
            return Err(changed());
        }
        attributes.remove_replaced(primitive);
        // Vertices that primitives share would otherwise have values for all of them in each.
        // The indices of turned faces are others.
        let keeps_indices = !part.is_split && !placed.is_turned;
        if keeps_indices && slots.are_whole() && 2 * slots.sources.len() >= count {
            let vertices = spread(&slots, count);
            self.write(document, primitive, attributes, &frame, &vertices);
            return Ok(());
        }
        self.gather(document, primitive, [placed.mesh, placed.primitive], &slots)?;
        let vertices: Vec<Option<u32>> = slots.vertices.iter().map(|vertex| Some(*vertex)).collect();
        self.write(document, primitive, attributes, &frame, &vertices);
        primitive["indices"] = json!(self.arrays.indices(document, &slots.triangles));
        remove(primitive, "mode");
        Ok(())
    }

    /// Chooses the attributes that are written.
    fn attributes(&self, primitive: &Json, placed: &PlacedPrimitive, part: &PrimitivePart) -> Attributes<'a> {
        let model = self.edits.model;
        let mesh = &model.mesh;
        let material = self.edits.material(placed);
        let has = |name: &str| primitive["attributes"].get(name).is_some();
        let morphs = primitive["targets"]
            .as_array()
            .is_some_and(|targets| !targets.is_empty());
        let set = self.set(placed, part);
        let baked = set.and_then(|set| self.edits.tangents.get(&set));
        let has_new_normals = model.is_smoothed || placed.is_turned;
        let tangents = match baked {
            // Fixed normals would be wrong on flat faces that move.
            Some(Tangents::New) if morphs && !has("NORMAL") && !has_new_normals => WrittenTangents::AsTheyAre,
            Some(Tangents::New) if placed.has_own_tangents => WrittenTangents::AsTheyAre,
            Some(Tangents::New) => WrittenTangents::New(&mesh.tangents),
            Some(Tangents::Unused) if has(TANGENT) => WrittenTangents::Removed,
            None if has_new_normals && has(TANGENT) => {
                own_tangents(mesh, model.materials.get(material.unwrap_or(0) as usize))
            }
            _ => WrittenTangents::AsTheyAre,
        };
        let frames_normals = matches!(tangents, WrittenTangents::New(_)) && !has("NORMAL");
        Attributes {
            uvs: self.uvs(placed, part),
            normals: (has_new_normals || frames_normals).then_some(&mesh.normals),
            tangents,
        }
    }

    /// Chooses the texture coordinates that are written.
    fn uvs(&self, placed: &PlacedPrimitive, part: &PrimitivePart) -> Option<WrittenUvs<'a>> {
        let UvSets { chosen, unwrapped } = self.edits.uv_sets;
        let model = self.edits.model;
        let values = &model.mesh.uvs[..];
        if self.edits.is_unwrapped(placed) {
            return Some(WrittenUvs {
                set: unwrapped,
                values,
                tile: [0; 2],
            });
        }
        let tile = part.tile?.uv_tile;
        let material = self.edits.material(placed)?;
        // Coordinates under a transform stay, and the transform moves them.
        let is_decoded = model.materials.get(material as usize)?.uv_decoding.is_some();
        (tile != [0; 2] && !is_decoded).then_some(WrittenUvs {
            set: chosen,
            values,
            tile,
        })
    }

    /// Replaces the accessors of the primitive by ones with the vertices of the slots.
    fn gather(
        &mut self,
        document: &mut Json,
        primitive: &mut Json,
        number: [usize; 2],
        slots: &Slots,
    ) -> Result<(), String> {
        let is_unpacked = self.file.is_unpacked(number);
        accessors(primitive, is_unpacked)?;
        let list = self.arrays.list(slots.sources.clone());
        for (key, value) in primitive.as_object_mut().into_iter().flatten() {
            let sets: Vec<&mut Json> = match key.as_str() {
                "attributes" => vec![value],
                "targets" => value.as_array_mut().into_iter().flatten().collect(),
                _ => continue,
            };
            for (_, accessor) in sets.into_iter().filter_map(Json::as_object_mut).flatten() {
                let place = accessor.as_u64().and_then(|at| usize::try_from(at).ok());
                let of = OfPrimitive {
                    accessor: place.ok_or_else(changed)?,
                    primitive: number,
                };
                let arrays = &mut *self.arrays;
                let gathered = arrays.gather(document, self.file, self.container, of, &slots.sources, list)?;
                *accessor = json!(gathered);
            }
        }
        if let Some(extensions) = primitive.get_mut("extensions") {
            remove(extensions, DRACO);
            if extensions.as_object().is_some_and(Map::is_empty) {
                remove(primitive, "extensions");
            }
        }
        Ok(())
    }

    /// Writes the attributes of vertices of the mesh; none for vertices of the file that no triangle uses.
    fn write(
        &mut self,
        document: &mut Json,
        primitive: &mut Json,
        attributes: Attributes<'_>,
        frame: &InverseTransform,
        vertices: &[Option<u32>],
    ) {
        let number = |vertex: &Option<u32>| vertex.map(|vertex| vertex as usize);
        if let Some(uvs) = attributes.uvs {
            let of = |vertex| number(vertex).and_then(|vertex| uvs.at(vertex));
            let values: Vec<[f32; 2]> = vertices.iter().map(|vertex| of(vertex).unwrap_or([0.0; 2])).collect();
            let accessor = self.arrays.floats(document, &values);
            let new_set = uvs.set;
            // Sets follow on each other in glTF.
            for set in (0..new_set.min(MOST_SETS)).chain([new_set]) {
                let name = format!("TEXCOORD_{set}");
                if set == new_set || primitive["attributes"].get(&name).is_none() {
                    primitive["attributes"][name] = json!(accessor);
                }
            }
        }
        if let Some(normals) = attributes.normals {
            let of = |vertex| number(vertex).and_then(|vertex| normals.get(vertex).copied());
            let back = |vertex| of(vertex).map_or([0.0, 0.0, 1.0], |normal| frame.normal(normal));
            let values: Vec<[f32; 3]> = vertices.iter().map(back).collect();
            primitive["attributes"]["NORMAL"] = json!(self.arrays.floats(document, &values));
        }
        if let WrittenTangents::New(tangents) = attributes.tangents {
            let of = |vertex| number(vertex).and_then(|vertex| tangents.get(vertex).copied());
            let back = |vertex| of(vertex).map_or([1.0, 0.0, 0.0, 1.0], |tangent| frame.tangent(tangent));
            let values: Vec<[f32; 4]> = vertices.iter().map(back).collect();
            primitive["attributes"][TANGENT] = json!(self.arrays.floats(document, &values));
        }
    }
}

impl Attributes<'_> {
    fn are_as_stored(&self) -> bool {
        self.uvs.is_none() && self.normals.is_none() && !matches!(self.tangents, WrittenTangents::New(_))
    }

    /// Removes the attributes in whose place others are written.
    fn remove_replaced(&self, primitive: &mut Json) {
        if self.normals.is_some() {
            remove_attribute(primitive, "NORMAL");
        }
        if let WrittenTangents::New(_) = self.tangents {
            remove_tangents(primitive);
        }
        if let Some(uvs) = self.uvs {
            remove_attribute(primitive, &format!("TEXCOORD_{}", uvs.set));
        }
    }

    /// Exact values at a vertex of the mesh; 0 for attributes that are not written.
    fn written(&self, vertex: usize) -> VertexValues {
        let [u, v] = self.uvs.and_then(|uvs| uvs.at(vertex)).unwrap_or([0.0; 2]);
        let normal = self.normals.and_then(|normals| normals.get(vertex).copied());
        let [x, y, z] = normal.unwrap_or([0.0; 3]);
        let [tx, ty, tz, w] = match self.tangents {
            WrittenTangents::New(tangents) => tangents.get(vertex).copied().unwrap_or([0.0; 4]),
            _ => [0.0; 4],
        };
        [u, v, x, y, z, tx, ty, tz, w].map(f32::to_bits)
    }
}

/// Values for each vertex of the file.
fn spread(slots: &Slots, count: usize) -> Vec<Option<u32>> {
    let mut vertices = vec![None; count];
    for (source, vertex) in slots.sources.iter().zip(&slots.vertices) {
        if let Some(place) = vertices.get_mut(*source as usize) {
            *place = Some(*vertex);
        }
    }
    vertices
}

/// Tangents of a material that was not baked, for the set of its normal map.
fn own_tangents<'m>(mesh: &'m Mesh, material: Option<&ModelMaterial>) -> WrittenTangents<'m> {
    let normal = material.and_then(|material| material.normal.as_ref());
    let tangents = normal
        .and_then(|normal| mesh.set(normal.uv_set))
        .map(|(_, tangents)| tangents);
    match tangents.filter(|tangents| !tangents.is_empty()) {
        Some(tangents) => WrittenTangents::New(tangents),
        None => WrittenTangents::Removed,
    }
}

/// Removes the tangents of a primitive and of its morph targets.
fn remove_tangents(primitive: &mut Json) {
    remove_attribute(primitive, TANGENT);
    let targets = primitive.get_mut("targets").and_then(Json::as_array_mut);
    for target in targets.into_iter().flatten() {
        // glTF has no empty targets, and weights count them.
        if target.as_object().is_some_and(|target| target.len() > 1) {
            remove(target, TANGENT);
        }
    }
}

/// Removes an attribute of a primitive. Those in compressed data are a part of all.
fn remove_attribute(primitive: &mut Json, name: &str) {
    for place in ["/attributes", "/extensions/KHR_draco_mesh_compression/attributes"] {
        if let Some(attributes) = primitive.pointer_mut(place) {
            remove(attributes, name);
        }
    }
}
