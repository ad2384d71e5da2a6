//! glTF 2.0 and GLB, read over the JSON types of the `gltf` crate with checks and readers of our own.

mod accessor;
mod buffers;
mod document;
mod material;
mod picture;
mod primitive;
mod scene;
mod skin;
mod storage;

use std::collections::{BTreeMap, BTreeSet};

use glam::DMat4;
use rayon::prelude::*;

use self::buffers::Buffers;
use self::document::Document;
use self::material::Materials;
use self::primitive::{Outcome, Source};
use self::scene::Instance;
use super::error::{Fault, damaged};
use super::far::brought_near;
use super::warnings::{TRIANGLES, Warnings, counted};
use super::{LoadOptions, MAX_TRIANGLES};
use crate::model::{Mesh, Model, TextureUvs};

/// The files beside a model.
pub(super) type Resolve<'a> = dyn FnMut(&str) -> Result<Vec<u8>, String> + 'a;

/// Reads a `.gltf` or `.glb` file.
pub(super) fn read(name: &str, bytes: &[u8], resolve: &mut Resolve, options: &LoadOptions) -> Result<Model, Fault> {
    let mut warnings = Warnings::default();
    let (document, binary) = Document::parse(bytes, &mut warnings)?;
    document.check_extensions(&mut warnings)?;
    let buffers = Buffers::gather(&document, binary, resolve, &mut warnings);
    let source = Source {
        document: &document,
        buffers: &buffers,
        uv_set: options.uv_set,
    };
    let instances = scene::instances(&source, &mut warnings)?;
    check_size(&source, &instances)?;
    let pieces = source.pieces(instances.iter().map(|instance| instance.mesh))?;
    let has = |what: fn(&Outcome) -> bool| pieces.values().flatten().any(what);
    let with_uvs = has(|piece| !piece.piece.uvs.is_empty());
    let with_colors = has(|piece| !piece.piece.colors.is_empty());
    if !with_uvs {
        primitive::check_uv_set(options.uv_set, pieces.values().flatten())?;
    }

    let without_uvs = gather_warnings(&source, pieces.values().flatten(), with_uvs, &mut warnings);
    let (world_from_file, middle) = world(options, &instances, &pieces);
    let mut model = Model {
        stem: super::stem(name),
        middle,
        without_uvs: without_uvs.into_iter().collect(),
        ..Model::default()
    };
    model.mesh.uv_set = with_uvs.then_some(options.uv_set);
    model.mesh.texture_uvs = empty_sets(pieces.values().flatten());
    let mut materials = Materials::default();
    let mut lost = 0;
    for instance in &instances {
        let pieces = pieces.get(&instance.mesh).into_iter().flatten();
        lost += place(
            instance,
            world_from_file,
            pieces,
            [with_uvs, with_colors],
            &mut materials,
            &mut model,
        );
    }
    if lost > 0 {
        warnings.add(format!(
            "{} reached out of the range of numbers once placed and had to be left out.",
            counted(lost, TRIANGLES)
        ));
    }
    if model.mesh.triangles.is_empty() {
        if document.meshes.is_empty() {
            warnings.add("it has no meshes");
        }
        return Err(warnings.into_fault());
    }
    drop_idle_frames(&mut model.mesh, pieces.values().flatten());
    materials.finish(&source, name, resolve, &mut model, &mut warnings);
    model.warnings = warnings.finish();
    Ok(model)
}

/// Returns the transform from the file to the world, and the middle of the model in the file's own world; see
/// [`Model::middle`].
fn world(options: &LoadOptions, instances: &[Instance], pieces: &BTreeMap<usize, Vec<Outcome>>) -> (DMat4, [f64; 3]) {
    let placed = instances.iter().flat_map(|instance| {
        let pieces = pieces.get(&instance.mesh).into_iter().flatten();
        pieces.map(|piece| (&piece.piece, instance.file_from_mesh))
    });
    brought_near(options.world_from_file(), placed)
}

/// The sets that textures of the pieces are laid out by, without coordinates yet.
fn empty_sets<'a>(pieces: impl Iterator<Item = &'a Outcome>) -> Vec<TextureUvs> {
    let others = pieces.flat_map(|piece| &piece.piece.texture_uvs);
    let sets: BTreeSet<u32> = others.map(|other| other.set).collect();
    let of_set = |set| TextureUvs {
        set,
        ..TextureUvs::default()
    };
    sets.into_iter().map(of_set).collect()
}

/// Leaves out the tangents of sets that no normal map uses.
fn drop_idle_frames<'a>(mesh: &mut Mesh, pieces: impl Iterator<Item = &'a Outcome>) {
    let others = pieces.flat_map(|piece| &piece.piece.texture_uvs);
    let framed: BTreeSet<u32> = others
        .filter(|other| !other.tangents.is_empty())
        .map(|other| other.set)
        .collect();
    for other in &mut mesh.texture_uvs {
        if !framed.contains(&other.set) {
            other.tangents = Vec::new();
        }
    }
}

/// The warnings of the pieces, and names of the materials of those without the UVs that others have.
fn gather_warnings<'a>(
    source: &Source,
    pieces: impl Iterator<Item = &'a Outcome>,
    with_uvs: bool,
    warnings: &mut Warnings,
) -> BTreeSet<String> {
    let mut without_uvs = BTreeSet::new();
    for piece in pieces {
        warnings.absorb(piece.warnings.clone());
        if with_uvs && piece.piece.uvs.is_empty() && !piece.piece.triangles.is_empty() {
            without_uvs.insert(source.document.material_label(piece.material));
        }
    }
    without_uvs
}

/// Puts the pieces of an instance into the model as one part; says how many triangles were lost.
fn place<'a>(
    instance: &Instance,
    world_from_file: DMat4,
    pieces: impl Iterator<Item = &'a Outcome>,
    [with_uvs, with_colors]: [bool; 2],
    materials: &mut Materials,
    model: &mut Model,
) -> usize {
    let part = model.parts.len() as u32;
    let mut lost = 0;
    for piece in pieces {
        let mut placed = piece.piece.placed(world_from_file * instance.file_from_mesh);
        lost += placed.drop_broken();
        if placed.triangles.is_empty() {
            continue;
        }
        placed.materials = vec![materials.slot(piece.material); placed.triangles.len()];
        placed.parts = vec![part; placed.triangles.len()];
        placed.append_to(&mut model.mesh, with_uvs, with_colors);
    }
    if model.mesh.triangle_part.last() == Some(&part) {
        model.parts.push(instance.name.clone());
    }
    lost
}

/// Primitives may share their vertices, but each takes a look at all of them: more looks than this take minutes.
const MOST_VERTICES_SEEN: u64 = 1 << 31;

/// Coordinates in UV sets besides the chosen one: as many as the largest model has corners, twice.
const MOST_TEXTURE_UVS: u64 = 2 * 3 * MAX_TRIANGLES;

/// Adds up what the file claims before anything is allocated for it.
fn check_size(source: &Source, instances: &[Instance]) -> Result<(), Fault> {
    let claims: Vec<u64> = source
        .document
        .meshes
        .par_iter()
        .map(|mesh| mesh.primitives.iter().map(|p| source.claim(p)).sum())
        .collect();
    let total = instances
        .iter()
        .fold(0u64, |sum, instance| sum.saturating_add(claims[instance.mesh]));
    if total > MAX_TRIANGLES {
        return Err(Fault::TooLarge(total));
    }
    let primitives = source.document.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let seen = primitives.fold(0u64, |sum, primitive| sum.saturating_add(source.vertices(primitive)));
    if seen > MOST_VERTICES_SEEN {
        return damaged(format!(
            "its primitives share vertices until there are {seen} of them; export it with vertices of their own"
        ));
    }
    check_sets(source, instances)
}

/// Every vertex of the model has coordinates in every set that any material's textures are laid out by.
fn check_sets(source: &Source, instances: &[Instance]) -> Result<(), Fault> {
    let meshes = &source.document.meshes;
    // Vertices without a triangle are left out.
    let vertices = |p| source.vertices(p).min(source.claim(p).saturating_mul(3));
    let claims: Vec<u64> = meshes
        .par_iter()
        .map(|mesh| mesh.primitives.iter().map(vertices).sum())
        .collect();
    let used: BTreeSet<usize> = instances.iter().map(|instance| instance.mesh).collect();
    let primitives = used.iter().flat_map(|&mesh| &meshes[mesh].primitives);
    let mut sets: BTreeSet<u32> = primitives.flat_map(|p| source.texture_sets(p)).collect();
    sets.remove(&source.uv_set);
    let sets = sets.len() as u64;
    let vertices: u64 = instances.iter().map(|instance| claims[instance.mesh]).sum();
    if vertices.saturating_mul(sets) > MOST_TEXTURE_UVS {
        return damaged(format!(
            "its materials use {sets} UV sets besides {}, too many for {vertices} vertices; export it with all textures in one \
             UV set",
            source.uv_set
        ));
    }
    Ok(())
}
