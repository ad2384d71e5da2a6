//! COLLADA (`.dae`), versions 1.4 and 1.5.
//!
//! The unit and the up axis that the file declares are used to convert the model to meters with +Y up, before [`LoadOptions`] rotate and
//! scale it. UV sets are numbered in the order of their `set` in a mesh. Vertex colors are interpreted as sRGB, material colors as linear.
//! Base color, emission, opacity and normal map of a material are read. Its shininess is ignored, since roughness cannot be derived from
//! it. Skins, morph targets and animations are ignored: the scene is read in its stored pose.

mod document;
mod effect;
mod geometry;
mod missing;
mod polygons;
mod scene;
mod skin;
mod sources;

use std::collections::hash_map::Entry;
use std::collections::{BTreeSet, HashMap};

use self::document::DaeDocument;
use self::effect::DaeMaterials;
use self::geometry::Geometry;
use self::sources::DaeSources;
use super::LoadOptions;
use super::assembly::{self, Assembly, MeshInstance};
use super::completion::{Completion, LACKING_NORMALS};
use super::error::ModelFault;
use super::gltf::Resolve;
use super::normals::NormalMethod;
use super::polygon::Budget;
use super::text::decoded;
use super::warnings::Warnings;
use crate::model::Model;

/// Start of the root element of every file.
pub(super) const ROOT: &[u8] = b"<COLLADA";

/// Reads a `.dae` file.
pub(super) fn read(
    name: &str,
    bytes: &[u8],
    resolve: &mut Resolve,
    options: &LoadOptions,
) -> Result<Model, ModelFault> {
    let mut warnings = Warnings::default();
    let text = decoded(bytes);
    let tree = document::parsed(&text, options.memory_bytes)?;
    let document = DaeDocument::new(&tree, &mut warnings)?;
    if document.first("library_animations").is_some() {
        warnings.add("Animations are left out: the scene is taken as it stands without them.");
    }
    let mut assembly = Assembly::default();
    let shown = scene::shown(&document, &mut assembly.groups, &mut warnings)?;
    let mut places = HashMap::new();
    let mut geometries: Vec<Geometry> = Vec::new();
    for shown in &shown {
        if let Entry::Vacant(place) = places.entry(shown.mesh.id()) {
            place.insert(geometries.len());
            geometries.push(Geometry::new(&document, shown.mesh, &mut warnings)?);
        }
    }
    let claims: Vec<u64> = geometries.iter().map(Geometry::triangles).collect();
    let triangles = shown.iter().map(|shown| claims[places[&shown.mesh.id()]]);
    assembly::check_triangles(triangles, options.memory_bytes)?;
    let mut looks = DaeMaterials::new(&document);
    for shown in shown {
        let mesh = places[&shown.mesh.id()];
        let materials = looks.bound(&shown, &geometries[mesh]);
        assembly.instances.push(MeshInstance {
            mesh,
            name: shown.name,
            group: shown.group,
            file_from_mesh: document.file_from_scene * shown.scene_from_mesh,
            materials,
        });
    }
    assembly.materials = looks.materials(&mut assembly.pictures, &mut warnings);
    // Before the meshes, since a reference that leads nowhere is why they lack something.
    document.tell_missing(&mut warnings);
    read_meshes(&geometries, &mut assembly, options, &mut warnings)?;
    assembly.into_model(name, resolve, options, warnings)
}

/// Reads the triangles of all meshes.
fn read_meshes(
    geometries: &[Geometry],
    assembly: &mut Assembly,
    options: &LoadOptions,
    warnings: &mut Warnings,
) -> Result<(), ModelFault> {
    let completion = Completion {
        repaired_normals: LACKING_NORMALS,
        missing: NormalMethod::Crease,
        smooth_degrees: options.smooth_degrees,
    };
    let mut sources = DaeSources::default();
    let mut budget = Budget::default();
    for (geometry, sets) in geometries.iter().zip(assembly.texture_sets(geometries.len())) {
        assembly.uv_sets.extend(0..geometry.uv_sets.len() as u32);
        let mut wanted: BTreeSet<u32> = sets.all.clone();
        wanted.insert(options.uv_set);
        let mut submeshes = Vec::new();
        for list in &geometry.lists {
            let faces = geometry.read(list, options.uv_set, &wanted, &mut sources, warnings)?;
            let mut submesh = faces.triangulated(&mut budget, warnings);
            completion.complete(&mut submesh, &sets.framed, &geometry.who, warnings);
            submeshes.push(submesh);
        }
        assembly.meshes.push(submeshes);
    }
    Ok(())
}
