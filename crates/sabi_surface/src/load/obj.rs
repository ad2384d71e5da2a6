//! Wavefront OBJ and its material libraries.
//!
//! Normals that the file leaves out are smooth up to a crease of 80°, or follow its smoothing groups where it has them.
//! Texture coordinates are turned to glTF's convention (v grows downward). Vertex colors, an unwritten addition to the
//! format, are taken as sRGB, as the programs that write them do.

mod library;
mod polygon;
mod statements;

use std::collections::{BTreeMap, BTreeSet, HashMap};

use glam::DMat4;

use self::library::Library;
use self::statements::{Corner, NONE, Statements};
use super::error::Fault;
use super::far::brought_near;
use super::normals::{self, Missing};
use super::submesh::Submesh;
use super::tangents;
use super::warnings::{TRIANGLES, VERTICES, Warnings, counted};
use super::{LoadOptions, MAX_TRIANGLES};
use crate::model::{Mesh, Model, ModelMaterial};

/// Reads an `.obj` file.
pub(super) fn read(
    name: &str,
    bytes: &[u8],
    resolve: &mut super::gltf::Resolve,
    options: &LoadOptions,
) -> Result<Model, Fault> {
    let mut warnings = Warnings::default();
    let text = statements::decoded(bytes);
    let statements = Statements::read(&text, &mut warnings)?;
    let claim: u64 = statements.faces.iter().map(|face| face.corners.len() as u64 - 2).sum();
    if claim > MAX_TRIANGLES {
        return Err(Fault::TooLarge(claim));
    }
    if options.uv_set > 0 {
        let there = if statements.uvs.is_empty() {
            "it has no UVs at all"
        } else {
            "OBJ files have set 0 alone"
        };
        return Err(Fault::UvSet {
            asked: options.uv_set,
            there: there.into(),
        });
    }

    let mut model = Model {
        stem: super::stem(name),
        ..Model::default()
    };
    let (submesh, without_uvs) = triangulate(&statements, &mut warnings);
    let (mut placed, middle) = placed(&complete(submesh, options, &mut warnings), options);
    model.middle = middle;
    if placed.drop_broken() > 0 {
        warnings.add("Some triangles reach out of the range of numbers once scaled and are left out.");
    }
    if placed.triangles.is_empty() {
        if warnings.is_empty() && !statements.positions.is_empty() {
            warnings.add("it is a cloud of points without faces; make a mesh of them first");
        }
        return Err(warnings.into_fault());
    }
    let mut library = Library::default();
    for names in &statements.libraries {
        library.read(names, resolve, &mut warnings);
    }
    let slots = number_materials(&statements, &mut library, &mut placed, &mut model, &mut warnings);
    model.without_uvs = without_uvs.iter().filter_map(|slot| slots.get(slot).copied()).collect();
    number_parts(&statements, &mut placed, &mut model);
    library.read_images(resolve, &mut model, &mut warnings);
    let (with_uvs, with_colors) = (!placed.uvs.is_empty(), !placed.colors.is_empty());
    let mut mesh = Mesh {
        uv_set: with_uvs.then_some(0),
        ..Mesh::default()
    };
    placed.append_to(&mut mesh, with_uvs, with_colors);
    model.mesh = mesh;
    model.warnings = warnings.finish();
    Ok(model)
}

/// Returns the submesh in world space, and its origin in the file's own world; see [`Model::middle`].
fn placed(submesh: &Submesh, options: &LoadOptions) -> (Submesh, [f64; 3]) {
    let submeshes = [(submesh, DMat4::IDENTITY)];
    let (world_from_file, middle) = brought_near(options.world_from_file(), submeshes.into_iter());
    (submesh.placed(world_from_file), middle)
}

/// Triangulates the faces, with one vertex for corners that are equal in all attributes; returns the slots of
/// materials whose faces lack UVs where others have them.
fn triangulate(statements: &Statements, warnings: &mut Warnings) -> (Submesh, BTreeSet<u32>) {
    let mut submesh = Submesh::default();
    let mut vertices: HashMap<Corner, u32> = HashMap::new();
    let mut budget = polygon::Budget::default();
    let mut without_uvs = BTreeSet::new();
    let with_uvs = !statements.uvs.is_empty();
    for face in &statements.faces {
        let corners = &statements.corners[face.corners.clone()];
        if with_uvs && corners.iter().any(|corner| corner.uv == NONE) {
            without_uvs.insert(face.material);
        }
        let numbers: Vec<u32> = corners
            .iter()
            .map(|corner| {
                let vertex = vertices.entry(*corner);
                *vertex.or_insert_with(|| push_vertex(statements, corner, &mut submesh))
            })
            .collect();
        let before = submesh.triangles.len();
        let positions: Vec<[f32; 3]> = numbers
            .iter()
            .map(|number| submesh.positions[*number as usize])
            .collect();
        polygon::triangulate(&positions, &mut budget, |triangle| {
            submesh.triangles.push(triangle.map(|corner| numbers[corner]));
        });
        let more = submesh.triangles.len() - before;
        submesh.materials.extend(std::iter::repeat_n(face.material, more));
        submesh.parts.extend(std::iter::repeat_n(face.part, more));
        submesh.smoothing.extend(std::iter::repeat_n(face.smoothing, more));
    }
    if budget.is_spent() {
        warnings.add("Some hollow faces have too many corners to be cut up well; triangulate the model on export.");
    }
    (submesh, without_uvs)
}

/// Appends a vertex with the attributes of a corner, and returns its number. Attributes that the corner lacks have a value
/// that is never used: missing UVs are listed, missing normals are computed, and missing colors are white.
fn push_vertex(statements: &Statements, corner: &Corner, submesh: &mut Submesh) -> u32 {
    let position = corner.position as usize;
    submesh.positions.push(statements.positions[position]);
    if !statements.uvs.is_empty() {
        let uv = statements.uvs.get(corner.uv as usize).copied();
        // `NONE` for a corner without UVs.
        submesh.uvs.push(uv.unwrap_or_default());
    }
    if !statements.normals.is_empty() {
        let normal = statements.normals.get(corner.normal as usize).copied();
        // `NONE` for a corner without a normal.
        submesh.normals.push(normal.unwrap_or_default());
    }
    if !statements.colors.is_empty() {
        let color = statements.colors.get(position).copied();
        // Colors may end before positions do.
        submesh.colors.push(color.unwrap_or([1.0; 4]));
    }
    submesh.positions.len() as u32 - 1
}

/// Repairs invalid attributes and computes missing ones.
fn complete(mut submesh: Submesh, options: &LoadOptions, warnings: &mut Warnings) -> Submesh {
    let dropped = submesh.drop_broken();
    if dropped > 0 {
        warnings.add(format!(
            "{} had positions that are no numbers and had to be left out.",
            counted(dropped, TRIANGLES)
        ));
    }
    let repaired = submesh.repair_attributes();
    if repaired > 0 {
        warnings.add(format!(
            "{} had texture coordinates or colors that are no numbers; these were replaced.",
            counted(repaired, VERTICES)
        ));
    }
    if let Some(degrees) = options.smooth_degrees {
        normals::replace(&mut submesh, degrees);
    }
    let had_normals = !submesh.normals.is_empty();
    let made = normals::complete(&mut submesh, Missing::Crease);
    if had_normals && made > 0 {
        warnings.add(format!(
            "{} had no normal, or one without a direction; these were made anew.",
            counted(made, VERTICES)
        ));
    }
    tangents::complete(&mut submesh, "the model", warnings);
    submesh
}

/// Keeps the materials in use: those of the libraries in their order, then unknown names in order of first use, then the unnamed
/// one. Returns the new number of each slot.
fn number_materials(
    statements: &Statements,
    library: &mut Library,
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
                    // Unknown names come after those of the libraries.
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
                ..library::plain()
            },
        });
    }
    for material in &mut submesh.materials {
        *material = new_from_slot[material];
    }
    new_from_slot
}

/// Keeps the parts in use, in the file's order.
fn number_parts(statements: &Statements, submesh: &mut Submesh, model: &mut Model) {
    let used: BTreeSet<u32> = submesh.parts.iter().copied().collect();
    let mut new_from_old = BTreeMap::new();
    for old in used {
        new_from_old.insert(old, model.parts.len() as u32);
        let name = statements.parts[old as usize].clone();
        model
            .parts
            .push(if name.is_empty() { model.stem.clone() } else { name });
    }
    for part in &mut submesh.parts {
        *part = new_from_old[part];
    }
}
