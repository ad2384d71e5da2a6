//! glTF 2.0 and GLB, read with the JSON types of the `gltf` crate. Checks and readers are our own.

mod accessor;
mod buffers;
mod document;
mod draco;
mod material;
mod meshopt;
mod packed_vertices;
mod picture;
mod primitive;
mod scene;
mod skin;
mod source;
mod storage;
mod texture_use;
mod tidy;
mod unpacked_vertices;
mod uv_decoding;

use sabi_cancel::look;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::{DMat3, DMat4};
use rayon::prelude::*;

use self::buffers::Buffers;
use self::document::GltfDocument;
use self::material::Materials;
use self::primitive::LoadedPrimitive;
use self::scene::{GltfInstance, SceneMeshes};
use self::source::GltfSource;
pub use self::tidy::gltf_json;
pub use self::unpacked_vertices::UnpackedVertices;
pub(super) use self::unpacked_vertices::unpack;
use self::uv_decoding::UvDecodings;
use super::arealess::LeftOutAreas;
use super::blur::warn_of_placing;
use super::error::{ModelFault, damaged, missing_uv_set};
use super::face_reversal::FaceReversal;
use super::far::brought_near;
use super::parts::NamedPart;
use super::size::check_size;
use super::warnings::{TRIANGLES, Warnings, counted};
use super::{LoadOptions, MAX_TRIANGLES};
use crate::model::{Mesh, Model, PlacedPrimitive, TextureUvs};

/// Returns the bytes of a file beside a model.
pub(super) type Resolve<'a> = dyn FnMut(&str) -> Result<Arc<[u8]>, String> + 'a;

/// Reads a `.gltf` or `.glb` file.
pub(super) fn read(
    name: &str,
    bytes: &[u8],
    resolve: &mut Resolve,
    options: &LoadOptions,
) -> Result<Model, ModelFault> {
    let mut warnings = Warnings::default();
    let (document, binary) = GltfDocument::parse(bytes, options.memory_bytes, &mut warnings)?;
    document.check_extensions(&mut warnings)?;
    let buffers = Buffers::gather(&document, binary, resolve, options.memory_bytes, &mut warnings)?;
    let source = GltfSource {
        document: &document,
        buffers: &buffers,
        unpacked: None,
        uv_set: options.uv_set,
        scene: options.scene,
        smooth_degrees: options.smooth_degrees,
    };
    let SceneMeshes { mut instances, groups } = scene::read(&source, &mut warnings)?;
    let named = instances.iter().map(|instance| NamedPart {
        name: &instance.name,
        group: instance.group,
    });
    let file_parts = options.parts.of_file(named, &groups, &mut warnings)?;
    let mut is_taken = file_parts.iter().map(|part| part.left_out.is_none());
    instances.retain(|_| is_taken.next() == Some(true));
    check_sizes(&source, &instances, options.memory_bytes)?;
    let mut primitives = source.read_primitives(instances.iter().map(|instance| instance.mesh))?;
    let decodings = UvDecodings::of_primitives(&source, primitives.values().flatten());
    primitives
        .values_mut()
        .flatten()
        .for_each(|primitive| decodings.apply(primitive));
    let has = |what: fn(&LoadedPrimitive) -> bool| primitives.values().flatten().any(what);
    let has_triangles = has(|primitive| !primitive.submesh.triangles.is_empty());
    let with_uvs = has(|primitive| !primitive.submesh.uvs.is_empty());
    let with_colors = has(|primitive| !primitive.submesh.colors.is_empty());
    if !with_uvs && has_triangles {
        let sets = primitives.values().flatten().flat_map(|primitive| &primitive.uv_sets);
        missing_uv_set(options.uv_set, &sets.copied().collect())?;
    }

    let without_uvs = gather_warnings(primitives.values().flatten(), with_uvs, &mut warnings);
    let (world_from_file, middle) = world(options, &instances, &primitives);
    let mut model = Model {
        stem: super::stem(name),
        middle,
        file_parts,
        ..Model::default()
    };
    model.mesh.uv_set = with_uvs.then_some(options.uv_set);
    model.mesh.texture_uvs = empty_sets(primitives.values().flatten());
    let mut materials = Materials::default();
    let with = [with_uvs, with_colors];
    let mut placing = InstancePlacer {
        world_from_file,
        with,
        materials: &mut materials,
        model: &mut model,
        turning: FaceReversal::new(options.turns_faces),
        arealess: LeftOutAreas::default(),
        lost: 0,
        blurred: 0,
    };
    for instance in &instances {
        look();
        placing.place(instance, primitives.get(&instance.mesh).into_iter().flatten());
    }
    let InstancePlacer {
        turning,
        arealess,
        lost,
        blurred,
        ..
    } = placing;
    warn_of_placing(blurred, &mut warnings);
    if lost > 0 {
        warnings.add(format!(
            "{} reached out of the range of numbers once placed and had to be left out.",
            counted(lost, TRIANGLES)
        ));
    }
    arealess.tell(&mut warnings);
    if model.mesh.triangles.is_empty() {
        return Err(nothing_there(&document, warnings));
    }
    turning.apply(&mut model, with, &mut warnings);
    drop_idle_frames(&mut model.mesh, primitives.values().flatten());
    model.without_uvs = without_uvs
        .iter()
        .filter_map(|material| materials.place(*material))
        .collect();
    materials.finish(&source, &decodings, name, resolve, &mut model, &mut warnings);
    model.warnings = warnings.finish();
    Ok(model)
}

fn nothing_there(document: &GltfDocument, mut warnings: Warnings) -> ModelFault {
    if document.meshes.is_empty() {
        warnings.add("it has no meshes");
    }
    warnings.into_fault()
}

/// Returns the transform from the file to the world, and the middle of the model in the file's world; see [`Model::middle`].
fn world(
    options: &LoadOptions,
    instances: &[GltfInstance],
    primitives: &BTreeMap<usize, Vec<LoadedPrimitive>>,
) -> (DMat4, [f64; 3]) {
    let placed = instances.iter().flat_map(|instance| {
        let primitives = primitives.get(&instance.mesh).into_iter().flatten();
        primitives.map(|primitive| (&primitive.submesh, instance.file_from_mesh))
    });
    brought_near(options.world_from_file(), placed)
}

/// Returns the UV sets that textures of the primitives use, without coordinates yet.
fn empty_sets<'a>(primitives: impl Iterator<Item = &'a LoadedPrimitive>) -> Vec<TextureUvs> {
    let others = primitives.flat_map(|primitive| &primitive.submesh.texture_uvs);
    let sets: BTreeSet<u32> = others.map(|other| other.set).collect();
    let of_set = |set| TextureUvs {
        set,
        ..TextureUvs::default()
    };
    sets.into_iter().map(of_set).collect()
}

/// Removes the tangents of sets that no normal map uses.
fn drop_idle_frames<'a>(mesh: &mut Mesh, primitives: impl Iterator<Item = &'a LoadedPrimitive>) {
    let others = primitives.flat_map(|primitive| &primitive.submesh.texture_uvs);
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

/// Adds the warnings of the primitives. Returns the materials of primitives that lack the UVs that others have.
fn gather_warnings<'a>(
    primitives: impl Iterator<Item = &'a LoadedPrimitive>,
    with_uvs: bool,
    warnings: &mut Warnings,
) -> BTreeSet<Option<usize>> {
    let mut without_uvs = BTreeSet::new();
    for primitive in primitives {
        warnings.absorb(primitive.warnings.clone());
        if with_uvs && primitive.submesh.uvs.is_empty() && !primitive.submesh.triangles.is_empty() {
            without_uvs.insert(primitive.material);
        }
    }
    without_uvs
}

/// Placing of instances in a model.
struct InstancePlacer<'p> {
    world_from_file: DMat4,
    /// Whether any primitive has UVs, and whether any has colors.
    with: [bool; 2],
    materials: &'p mut Materials,
    model: &'p mut Model,
    turning: FaceReversal,
    arealess: LeftOutAreas,
    /// Number of triangles whose positions are out of range after placing.
    lost: usize,
    /// Triangles that lost their shape.
    blurred: usize,
}

impl InstancePlacer<'_> {
    /// Adds the primitives of an instance to the model as one part.
    fn place<'a>(&mut self, instance: &GltfInstance, primitives: impl Iterator<Item = &'a LoadedPrimitive>) {
        let model = &mut *self.model;
        let part = model.parts.len() as u32;
        let [with_uvs, with_colors] = self.with;
        let world_from_mesh = self.world_from_file * instance.file_from_mesh;
        let mut dropped = 0;
        for (number, primitive) in primitives.enumerate() {
            look();
            let mut placed = primitive.submesh.placed(world_from_mesh);
            self.lost += placed.drop_broken();
            self.blurred += placed.blurred;
            dropped += placed.drop_arealess();
            if placed.triangles.is_empty() {
                continue;
            }
            placed.materials = vec![self.materials.slot(primitive.material); placed.triangles.len()];
            placed.parts = vec![part; placed.triangles.len()];
            self.turning.hold(&placed);
            let origins = model.origins.get_or_insert_default();
            origins.vertices.append(&mut placed.sources);
            let first = model.mesh.triangles.len() as u32;
            origins.placed.push(PlacedPrimitive {
                node: instance.node,
                mesh: instance.mesh,
                primitive: number,
                triangles: first..first + placed.triangles.len() as u32,
                model_from_file: DMat3::from_mat4(world_from_mesh).to_cols_array_2d(),
                is_turned: false,
                has_own_tangents: primitive.has_own_tangents,
                uv_sets: primitive.uv_sets.last().map_or(0, |last| last.saturating_add(1)),
            });
            placed.append_to(&mut model.mesh, with_uvs, with_colors);
        }
        let is_left = model.mesh.triangle_part.last() == Some(&part);
        if is_left {
            model.parts.push(instance.name.clone());
        }
        self.arealess.add(dropped, &instance.name, is_left);
    }
}

/// Maximum number of vertices of all primitives together. Vertices that primitives share count for each of them, since each
/// reads all of them.
const MOST_VERTICES_READ: u64 = 1 << 31;

/// Maximum number of coordinates in UV sets other than the chosen one: twice the number of corners of the largest model.
const MOST_TEXTURE_UVS: u64 = 2 * 3 * MAX_TRIANGLES;

/// Checks the sizes that the file declares before anything is allocated for them.
fn check_sizes(source: &GltfSource, instances: &[GltfInstance], memory_bytes: u64) -> Result<(), ModelFault> {
    let claims: Vec<u64> = source
        .document
        .meshes
        .par_iter()
        .map(|mesh| mesh.primitives.iter().map(|p| source.claim(p)).sum())
        .collect();
    let total = instances
        .iter()
        .fold(0u64, |sum, instance| sum.saturating_add(claims[instance.mesh]));
    let of_mesh = |mesh: usize| source.document.meshes[mesh].primitives.len() as u64;
    let all = (0..source.document.meshes.len())
        .map(of_mesh)
        .fold(0, u64::saturating_add);
    let placed = instances.iter().map(|instance| of_mesh(instance.mesh));
    check_size(total, placed.fold(all, u64::saturating_add), memory_bytes)?;
    let primitives = source.document.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let read = primitives.fold(0u64, |sum, primitive| sum.saturating_add(source.vertices(primitive)));
    if read > MOST_VERTICES_READ {
        return damaged(format!(
            "its primitives share vertices until there are {read} of them; export it with vertices of their own"
        ));
    }
    check_sets(source, instances)
}

/// Checks the number of coordinates in further UV sets: every vertex of the model has coordinates in every set that any texture uses.
fn check_sets(source: &GltfSource, instances: &[GltfInstance]) -> Result<(), ModelFault> {
    let meshes = &source.document.meshes;
    // Vertices without a triangle are not kept.
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
