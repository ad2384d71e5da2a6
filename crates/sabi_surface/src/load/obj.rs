//! Wavefront OBJ and its material libraries.
//!
//! Missing normals are smooth up to an angle of 80°, or follow the smoothing groups of the file. Texture coordinates are converted to
//! glTF's convention (v grows downward). Vertex colors, an undocumented extension of the format, are interpreted as sRGB, as in the
//! programs that write them. Each `o` starts a part, and groups (`g`) with the same name are one part of their object.

mod colors;
mod map_statement;
mod material_draft;
mod material_library;
mod statements;
mod unknown;

use std::collections::{BTreeMap, BTreeSet};

use glam::DMat4;

use self::material_library::MaterialLibrary;
use self::statements::Statements;
use super::LoadOptions;
use super::arealess::LeftOutAreas;
use super::blur::warn_of_placing;
use super::completion::{Completion, LACKING_NORMALS};
use super::error::ModelFault;
use super::face_reversal::FaceReversal;
use super::faces::NONE;
use super::far::brought_near;
use super::normals::NormalMethod;
use super::parts::{NamedPart, NodeGroups};
use super::polygon::Budget;
use super::size::check_size;
use super::submesh::Submesh;
use super::text::decoded;
use super::warnings::Warnings;
use crate::model::{FilePart, Mesh, Model, ModelMaterial};

/// Reads an `.obj` file.
pub(super) fn read(
    name: &str,
    bytes: &[u8],
    resolve: &mut super::gltf::Resolve,
    options: &LoadOptions,
) -> Result<Model, ModelFault> {
    let mut warnings = Warnings::default();
    let text = decoded(bytes);
    let mut statements = Statements::read(&text, &mut warnings)?;
    let named = statements.materials.len() + statements.parts.len();
    check_size(statements.faces.triangles(), named as u64, options.memory_bytes)?;
    check_uv_set(&statements, options)?;
    let mut model = Model {
        stem: super::stem(name),
        file_parts: choose_parts(&mut statements, name, options, &mut warnings)?,
        ..Model::default()
    };
    let without_uvs = without_uvs(&statements);
    let mut submesh = statements.faces.triangulated(&mut Budget::default(), &mut warnings);
    let completion = Completion {
        repaired_normals: LACKING_NORMALS,
        missing: NormalMethod::Crease,
        smooth_degrees: options.smooth_degrees,
    };
    completion.complete(&mut submesh, &BTreeSet::new(), "the model", &mut warnings);
    let (mut placed, middle) = placed(&submesh, options);
    model.middle = middle;
    warn_of_placing(placed.blurred, &mut warnings);
    if placed.drop_broken() > 0 {
        warnings.add("Some triangles reach out of the range of numbers once scaled and are left out.");
    }
    drop_arealess(&mut placed, &statements, name, &mut warnings);
    if placed.triangles.is_empty() {
        if warnings.is_empty() && !statements.faces.positions.is_empty() {
            warnings.add("it is a cloud of points without faces; make a mesh of them first");
        }
        return Err(warnings.into_fault());
    }
    let mut library = MaterialLibrary::default();
    for names in &statements.libraries {
        library.read(names, resolve, &mut warnings);
    }
    let used = statements.faces.faces.iter().map(|face| face.material);
    let used: BTreeSet<u32> = used.collect();
    let mut used = used
        .into_iter()
        .map(|slot| statements.materials[slot as usize].as_str());
    if used.any(|name| !name.is_empty() && library.place(name).is_none()) {
        library.read_beside(&model.stem, resolve, &mut warnings);
    }
    let slots = number_materials(&statements, &mut library, &mut placed, &mut model, &mut warnings);
    model.without_uvs = without_uvs.iter().filter_map(|slot| slots.get(slot).copied()).collect();
    number_parts(&statements, name, &mut placed, &mut model);
    library.pictures.read(resolve, &mut model, &mut warnings);
    let (with_uvs, with_colors) = (!placed.uvs.is_empty(), !placed.colors.is_empty());
    let mut mesh = Mesh {
        uv_set: with_uvs.then_some(0),
        ..Mesh::default()
    };
    let mut turning = FaceReversal::new(options.turns_faces);
    turning.hold(&placed);
    placed.append_to(&mut mesh, with_uvs, with_colors);
    model.mesh = mesh;
    turning.apply(&mut model, [with_uvs, with_colors], &mut warnings);
    model.warnings = warnings.finish();
    Ok(model)
}

/// Returns the name of a part; the file's name if the faces have no part name.
fn part_name(statements: &Statements, part: u32, file: &str) -> String {
    let name = &statements.parts[part as usize];
    if name.is_empty() {
        super::stem(file)
    } else {
        name.clone()
    }
}

/// Keeps the faces of the chosen parts. Returns all parts that have faces.
fn choose_parts(
    statements: &mut Statements,
    file: &str,
    options: &LoadOptions,
    warnings: &mut Warnings,
) -> Result<Vec<FilePart>, ModelFault> {
    let used: BTreeSet<u32> = statements.faces.faces.iter().map(|face| face.part).collect();
    let names: Vec<String> = used.iter().map(|part| part_name(statements, *part, file)).collect();
    let mut groups = NodeGroups::default();
    for object in &statements.objects {
        groups.add(object, None, false);
    }
    let named = used.iter().zip(&names).map(|(part, name)| NamedPart {
        name,
        group: statements.object_of.get(part).copied(),
    });
    let parts = options.parts.of_file(named, &groups, warnings)?;
    let taken = used.into_iter().zip(&parts).filter(|(_, part)| part.left_out.is_none());
    let taken: BTreeSet<u32> = taken.map(|(part, _)| part).collect();
    statements.faces.faces.retain(|face| taken.contains(&face.part));
    Ok(parts)
}

/// Removes triangles without area, and adds a warning about them.
fn drop_arealess(placed: &mut Submesh, statements: &Statements, file: &str, warnings: &mut Warnings) {
    let of_parts = |placed: &Submesh| {
        let mut counts: BTreeMap<u32, usize> = BTreeMap::new();
        for part in &placed.parts {
            *counts.entry(*part).or_default() += 1;
        }
        counts
    };
    let before = of_parts(placed);
    if placed.drop_arealess() == 0 {
        return;
    }
    let after = of_parts(placed);
    let mut left_out = LeftOutAreas::default();
    for (part, count) in before {
        let left = after.get(&part).copied();
        left_out.add(
            count - left.unwrap_or(0),
            &part_name(statements, part, file),
            left.is_some(),
        );
    }
    left_out.tell(warnings);
}

/// Returns the submesh in world space, and its origin in the file's own world; see [`Model::middle`].
fn placed(submesh: &Submesh, options: &LoadOptions) -> (Submesh, [f64; 3]) {
    let submeshes = [(submesh, DMat4::IDENTITY)];
    let (world_from_file, middle) = brought_near(options.world_from_file(), submeshes.into_iter());
    (submesh.placed(world_from_file), middle)
}

/// Returns a fault if a UV set is requested that OBJ files cannot have.
fn check_uv_set(statements: &Statements, options: &LoadOptions) -> Result<(), ModelFault> {
    if options.uv_set == 0 {
        return Ok(());
    }
    let there = if statements.faces.uvs.values.is_empty() {
        "it has no UVs at all"
    } else {
        "OBJ files have set 0 alone"
    };
    Err(ModelFault::UvSet {
        asked: options.uv_set,
        there: there.into(),
    })
}

/// Returns the slots of the materials whose faces lack UVs while others have them.
fn without_uvs(statements: &Statements) -> BTreeSet<u32> {
    let faces = &statements.faces;
    if faces.uvs.values.is_empty() {
        return BTreeSet::new();
    }
    let lacking = faces
        .faces
        .iter()
        .filter(|face| faces.uvs.corners[face.corners.clone()].contains(&NONE));
    lacking.map(|face| face.material).collect()
}

/// Keeps the materials that are used: first those of the libraries in their order, then unknown names in order of first
/// use, then the unnamed material. Returns the new number of each slot.
fn number_materials(
    statements: &Statements,
    library: &mut MaterialLibrary,
    submesh: &mut Submesh,
    model: &mut Model,
    warnings: &mut Warnings,
) -> BTreeMap<u32, u32> {
    let used: BTreeSet<u32> = submesh.materials.iter().copied().collect();
    let mut order: Vec<(usize, u32)> = used
        .into_iter()
        .map(|slot| {
            let name = &statements.materials[slot as usize];
            (
                if name.is_empty() {
                    usize::MAX
                } else {
                    // Unknown names come after the names of the libraries.
                    library.place(name).unwrap_or(usize::MAX - 1)
                },
                slot,
            )
        })
        .collect();
    order.sort_unstable();
    let mut new_from_slot = BTreeMap::new();
    for (new, (place, slot)) in order.into_iter().enumerate() {
        let name = &statements.materials[slot as usize];
        new_from_slot.insert(slot, new as u32);
        if place == usize::MAX - 1 && !statements.libraries.is_empty() {
            warnings.add(format!(
                "Material `{name}` is in no material library that could be read; it gets plain values."
            ));
        }
        model.materials.push(match library.take(name) {
            Some(material) => material,
            None => ModelMaterial {
                name: name.clone(),
                ..ModelMaterial::plain()
            },
        });
    }
    for material in &mut submesh.materials {
        *material = new_from_slot[material];
    }
    new_from_slot
}

/// Keeps the parts that are used, in the file's order.
fn number_parts(statements: &Statements, file: &str, submesh: &mut Submesh, model: &mut Model) {
    let used: BTreeSet<u32> = submesh.parts.iter().copied().collect();
    let mut new_from_old = BTreeMap::new();
    for old in used {
        new_from_old.insert(old, model.parts.len() as u32);
        model.parts.push(part_name(statements, old, file));
    }
    for part in &mut submesh.parts {
        *part = new_from_old[part];
    }
}
