//! New vertex data in the document of a glTF model: UVs of an unwrapped model, smoothed normals, tangents, and reversed faces. Vertices
//! that have to be split for this are duplicated with all data of the file, byte for byte: joints and weights, morph targets, other UVs
//! and custom attributes. So skins, animations and everything else that refers to the meshes stay valid.

mod arrays;
mod bytes;
mod inverse_transform;
mod layout;
mod rewrite;
mod slots;

use std::collections::{BTreeMap, BTreeSet};

use sabi_surface::model::{FileOrigins, Model, PlacedPrimitive};
use serde_json::{Value as Json, json};

use self::arrays::NewArrays;
pub(super) use self::bytes::FileBytes;
use self::bytes::OfPrimitive;
use self::rewrite::Rewriter;
use super::CopiedFile;
use super::container::Container;
use super::edit::push;
use super::tiles::MaterialTiles;
use crate::SetKey;

/// Treatment of the tangents of a baked material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tangents {
    /// The material does not use any.
    Unused,
    /// They belong to maps that the bake did not make.
    Foreign,
    /// They are the tangent frame of the new maps.
    New,
}

/// Material of a set, and its UDIM tile where the material has several.
pub(super) type SetName = (u32, Option<u32>);

/// Numbers of UV sets in the document.
#[derive(Clone, Copy, Debug)]
pub(super) struct UvSets {
    /// Set of the file that the maps are laid out by.
    pub(super) chosen: u32,
    /// New set of unwrapped materials.
    pub(super) unwrapped: u32,
}

/// Changes to the vertex data of a model.
pub(super) struct GeometryEdits<'m> {
    pub(super) model: &'m Model,
    pub(super) origins: &'m FileOrigins,
    /// Materials whose UVs are new.
    pub(super) unwrapped: BTreeSet<u32>,
    pub(super) uv_sets: UvSets,
    /// Materials in several UDIM tiles, and the places of those of the tiles in the document.
    pub(super) tiles: (&'m MaterialTiles, &'m BTreeMap<SetKey, usize>),
    /// Tangents of the baked sets.
    pub(super) tangents: BTreeMap<SetName, Tangents>,
}

/// Result of editing the vertex data of a document.
#[derive(Default)]
pub(super) struct EditedGeometry {
    /// File of the new data, where that is not in the document's container.
    pub(super) file: Option<CopiedFile>,
    /// Sets whose tangents are new; false for those whose tangents are removed.
    pub(super) tangents: BTreeMap<SetName, bool>,
    /// Warnings, as sentences.
    pub(super) warnings: Vec<String>,
}

/// Returns the materials whose UVs were made by unwrapping.
pub fn unwrapped_materials(model: &Model) -> BTreeSet<u32> {
    let all = 0..model.materials.len() as u32;
    match model.mesh.uv_set {
        Some(_) => BTreeSet::new(),
        None if model.mesh.is_one_sheet => all.collect(),
        None => model.without_uvs.clone(),
    }
}

/// Triangles of a placed primitive that share a material of the document.
struct PrimitivePart {
    /// Set of the tile, for a material in several tiles.
    tile: Option<SetKey>,
    triangles: Vec<[u32; 3]>,
    /// True if the primitive has other parts.
    is_split: bool,
}

/// Primitives of a mesh that one node shows.
struct NodePrimitives<'m> {
    node: Option<usize>,
    placed: Vec<&'m PlacedPrimitive>,
}

/// Instances by mesh.
fn instances(origins: &FileOrigins) -> BTreeMap<usize, Vec<NodePrimitives<'_>>> {
    let mut instances: BTreeMap<usize, Vec<NodePrimitives<'_>>> = BTreeMap::new();
    for placed in &origins.placed {
        let of_mesh = instances.entry(placed.mesh).or_default();
        match of_mesh.last_mut().filter(|last| last.node == placed.node) {
            Some(last) => last.placed.push(placed),
            None => of_mesh.push(NodePrimitives {
                node: placed.node,
                placed: vec![placed],
            }),
        }
    }
    instances
}

impl GeometryEdits<'_> {
    /// Material of a primitive.
    fn material(&self, placed: &PlacedPrimitive) -> Option<u32> {
        let materials = &self.model.mesh.triangle_material;
        materials.get(placed.triangles.start as usize).copied()
    }

    fn is_unwrapped(&self, placed: &PlacedPrimitive) -> bool {
        self.material(placed)
            .is_some_and(|material| self.unwrapped.contains(&material))
    }

    /// Returns true if a primitive has to be changed: its vertices are different, or are moved on the maps.
    fn must_change(&self, placed: &PlacedPrimitive) -> bool {
        let is_tiled = |material| self.tiles.0.has(material);
        self.model.is_smoothed
            || placed.is_turned
            || self.is_unwrapped(placed)
            || self.material(placed).is_some_and(is_tiled)
    }

    /// The parts of a primitive, of a material in several tiles one for each tile.
    fn parts(&self, placed: &PlacedPrimitive) -> Vec<PrimitivePart> {
        let mesh = &self.model.mesh;
        let mut parts: BTreeMap<Option<SetKey>, Vec<[u32; 3]>> = BTreeMap::new();
        for number in placed.triangles.clone() {
            let tile = self.tiles.0.of_triangle(mesh, number as usize);
            let corners = mesh.triangles.get(number as usize);
            parts.entry(tile).or_default().extend(corners);
        }
        let is_split = parts.len() > 1;
        let part = |(tile, triangles)| PrimitivePart {
            tile,
            triangles,
            is_split,
        };
        parts.into_iter().map(part).collect()
    }

    /// Checks that all vertices that have to be split can be. The error is a clause.
    pub(super) fn check(&self, document: &Json, container: &Container, bytes: &FileBytes) -> Result<(), String> {
        for placed in self.origins.placed.iter().filter(|placed| self.must_change(placed)) {
            let range = placed.triangles.start as usize..placed.triangles.end as usize;
            // A model has all the triangles that its origins name.
            let corners = self.model.mesh.triangles.get(range).unwrap_or_default().as_flattened();
            let origins = corners
                .iter()
                .filter_map(|vertex| self.origins.vertices.get(*vertex as usize));
            // A placed primitive has triangles.
            let last = origins.copied().max().unwrap_or(0);
            let number = [placed.mesh, placed.primitive];
            for accessor in rewrite::accessors(primitive(document, placed)?, bytes.is_unpacked(number))? {
                let of = OfPrimitive {
                    accessor,
                    primitive: number,
                };
                bytes.check(document, container, of, last)?;
            }
        }
        Ok(())
    }

    /// Changes the document; `name` chooses a name for a file of new data, which is embedded where there is none. The error is a
    /// clause.
    pub(super) fn apply(
        &self,
        document: &mut Json,
        container: &mut Container,
        bytes: &FileBytes,
        name: Option<&dyn Fn() -> String>,
    ) -> Result<EditedGeometry, String> {
        let mut arrays = NewArrays::default();
        let mut edited = EditedGeometry::default();
        for (mesh, instances) in instances(self.origins) {
            let original = document["meshes"][mesh].clone();
            for (number, instance) in instances.iter().enumerate() {
                // Instances share the file's mesh until they get different UVs.
                if number > 0 && !instance.placed.iter().any(|placed| self.is_unwrapped(placed)) {
                    continue;
                }
                let mut rewriter = Rewriter {
                    edits: self,
                    file: bytes,
                    container,
                    arrays: &mut arrays,
                    edited: &mut edited,
                };
                let rewritten = rewriter.mesh(document, &original, &instance.placed)?;
                match instance.node.filter(|_| number > 0) {
                    None => document["meshes"][mesh] = rewritten,
                    Some(node) => {
                        let mesh = push(document, "meshes", rewritten);
                        document["nodes"][node]["mesh"] = json!(mesh);
                    }
                }
            }
        }
        edited.file = arrays.finish(document, container, name);
        Ok(edited)
    }
}

/// The JSON of a primitive. The error is a clause.
fn primitive<'j>(document: &'j Json, placed: &PlacedPrimitive) -> Result<&'j Json, String> {
    let mesh = document["meshes"].get(placed.mesh);
    let primitive = mesh.and_then(|mesh| mesh["primitives"].get(placed.primitive));
    primitive.ok_or_else(changed)
}

/// Reason of a file that is not the one that was loaded.
fn changed() -> String {
    "it was changed while it was read".to_owned()
}
