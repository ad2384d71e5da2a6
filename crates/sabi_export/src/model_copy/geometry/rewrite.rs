//! Rewriting of primitives.

use sabi_surface::model::{Mesh, ModelMaterial, PlacedPrimitive};
use serde_json::{Value as Json, json};

use super::arrays::NewArrays;
use super::bytes::FileBytes;
use super::frame::Frame;
use super::slots::{Slots, Written};
use super::{EditedGeometry, GeometryEdits, Tangents, changed};
use crate::model_copy::container::Container;
use crate::model_copy::edit::remove;

/// Rewriter of the meshes of a document.
pub(super) struct Rewriter<'a> {
    pub(super) edits: &'a GeometryEdits<'a>,
    pub(super) file: (&'a FileBytes, &'a Container),
    pub(super) arrays: &'a mut NewArrays,
    pub(super) edited: &'a mut EditedGeometry,
}

/// Attributes of a primitive that are written.
#[derive(Clone, Copy)]
struct Attributes<'m> {
    uvs: Option<&'m [[f32; 2]]>,
    normals: Option<&'m [[f32; 3]]>,
    tangents: WrittenTangents<'m>,
}

#[derive(Clone, Copy)]
enum WrittenTangents<'m> {
    AsTheyAre,
    Removed,
    New(&'m [[f32; 4]]),
}

/// Accessors of the vertices of a primitive. The error is a clause.
pub(super) fn accessors(primitive: &Json) -> Result<Vec<usize>, String> {
    const DRACO: &str = "KHR_draco_mesh_compression";
    if primitive["extensions"].get(DRACO).is_some() {
        return Err(format!("its vertices are compressed ({DRACO})"));
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
        let mut mesh = original.clone();
        let primitives = mesh.get_mut("primitives").and_then(Json::as_array_mut);
        for (number, primitive) in primitives.into_iter().flatten().enumerate() {
            let Some(placed) = placed.iter().find(|placed| placed.primitive == number) else {
                continue;
            };
            let before = primitive.clone();
            if let Err(why) = self.primitive(document, primitive, placed) {
                if self.edits.model.is_smoothed || self.edits.is_unwrapped(placed) {
                    return Err(why);
                }
                *primitive = before;
                self.warn(placed, &why);
            }
        }
        Ok(mesh)
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

    fn primitive(&mut self, document: &mut Json, primitive: &mut Json, placed: &PlacedPrimitive) -> Result<(), String> {
        let attributes = self.attributes(primitive, placed);
        let material = self.edits.material(placed);
        match (attributes.tangents, material) {
            (WrittenTangents::Removed, Some(material)) => {
                remove_tangents(primitive);
                self.edited.tangents.entry(material).or_insert(false);
            }
            (WrittenTangents::New(_), Some(material)) => {
                self.edited.tangents.insert(material, true);
            }
            _ => {}
        }
        if attributes.are_as_stored() {
            return Ok(());
        }
        accessors(primitive)?;
        let frame = Frame::of(placed);
        let mesh = &self.edits.model.mesh;
        let written = |vertex: usize| attributes.written(vertex);
        let slots = Slots::of(mesh, self.edits.origins, placed, frame.is_mirrored, &written);
        let count = primitive["attributes"]["POSITION"].as_u64();
        let count = count.and_then(|accessor| document["accessors"].get(accessor as usize)?["count"].as_u64());
        let count = usize::try_from(count.ok_or_else(changed)?).map_err(|_| changed())?;
        if slots.sources.last().is_some_and(|last| *last as usize >= count) {
            return Err(changed());
        }
        // Vertices that primitives share would otherwise have values for all of them in each.
        if slots.are_whole() && 2 * slots.sources.len() >= count {
            let vertices = spread(&slots, count);
            self.write(document, primitive, attributes, &frame, &vertices);
            return Ok(());
        }
        attributes.remove_replaced(primitive);
        self.gather(document, primitive, &slots)?;
        let vertices: Vec<Option<u32>> = slots.vertices.iter().map(|vertex| Some(*vertex)).collect();
        self.write(document, primitive, attributes, &frame, &vertices);
        primitive["indices"] = json!(self.arrays.indices(document, &slots.triangles));
        remove(primitive, "mode");
        Ok(())
    }

    /// Chooses the attributes that are written.
    fn attributes(&self, primitive: &Json, placed: &PlacedPrimitive) -> Attributes<'a> {
        let model = self.edits.model;
        let mesh = &model.mesh;
        let material = self.edits.material(placed);
        let has = |name: &str| primitive["attributes"].get(name).is_some();
        let morphs = primitive["targets"]
            .as_array()
            .is_some_and(|targets| !targets.is_empty());
        let baked = material.and_then(|material| self.edits.tangents.get(&material));
        let tangents = match baked {
            // Fixed normals would be wrong on flat faces that move.
            Some(Tangents::New) if morphs && !has("NORMAL") && !model.is_smoothed => WrittenTangents::AsTheyAre,
            Some(Tangents::New) if placed.has_own_tangents => WrittenTangents::AsTheyAre,
            Some(Tangents::New) => WrittenTangents::New(&mesh.tangents),
            Some(Tangents::Unused) if has("TANGENT") => WrittenTangents::Removed,
            None if model.is_smoothed && has("TANGENT") => {
                own_tangents(mesh, model.materials.get(material.unwrap_or(0) as usize))
            }
            _ => WrittenTangents::AsTheyAre,
        };
        let frames_normals = matches!(tangents, WrittenTangents::New(_)) && !has("NORMAL");
        Attributes {
            uvs: self.edits.is_unwrapped(placed).then_some(&mesh.uvs),
            normals: (model.is_smoothed || frames_normals).then_some(&mesh.normals),
            tangents,
        }
    }

    /// Replaces the accessors of the primitive by ones with the vertices of the slots.
    fn gather(&mut self, document: &mut Json, primitive: &mut Json, slots: &Slots) -> Result<(), String> {
        let list = self.arrays.list(slots.sources.clone());
        for (key, value) in primitive.as_object_mut().into_iter().flatten() {
            let sets: Vec<&mut Json> = match key.as_str() {
                "attributes" => vec![value],
                "targets" => value.as_array_mut().into_iter().flatten().collect(),
                _ => continue,
            };
            for (_, accessor) in sets.into_iter().filter_map(Json::as_object_mut).flatten() {
                let number = accessor.as_u64().and_then(|at| usize::try_from(at).ok());
                let number = number.ok_or_else(changed)?;
                *accessor = json!(self.arrays.gather(document, self.file, number, &slots.sources, list)?);
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
        frame: &Frame,
        vertices: &[Option<u32>],
    ) {
        let number = |vertex: &Option<u32>| vertex.map(|vertex| vertex as usize);
        if let Some(uvs) = attributes.uvs {
            let of = |vertex| number(vertex).and_then(|vertex| uvs.get(vertex).copied());
            let values: Vec<[f32; 2]> = vertices.iter().map(|vertex| of(vertex).unwrap_or([0.0; 2])).collect();
            let accessor = self.arrays.floats(document, &values);
            for set in 0..=self.edits.uv_set {
                let name = format!("TEXCOORD_{set}");
                // Sets follow on each other in glTF.
                if set == self.edits.uv_set || primitive["attributes"].get(&name).is_none() {
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
            primitive["attributes"]["TANGENT"] = json!(self.arrays.floats(document, &values));
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
            remove(&mut primitive["attributes"], "NORMAL");
        }
        if let WrittenTangents::New(_) = self.tangents {
            remove(&mut primitive["attributes"], "TANGENT");
        }
    }

    /// Exact values at a vertex of the mesh; 0 for attributes that are not written.
    fn written(&self, vertex: usize) -> Written {
        let [u, v] = self.uvs.and_then(|uvs| uvs.get(vertex).copied()).unwrap_or_default();
        let [x, y, z] = self
            .normals
            .and_then(|normals| normals.get(vertex).copied())
            .unwrap_or_default();
        let [tx, ty, tz, w] = match self.tangents {
            WrittenTangents::New(tangents) => tangents.get(vertex).copied().unwrap_or_default(),
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
    remove(&mut primitive["attributes"], "TANGENT");
    let targets = primitive.get_mut("targets").and_then(Json::as_array_mut);
    for target in targets.into_iter().flatten() {
        remove(target, "TANGENT");
    }
}
