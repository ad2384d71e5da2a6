//! Converts meshes, their instances and materials, in the form common to the formats other than glTF, to a [`Model`].

use sabi_cancel::look;
use std::collections::{BTreeMap, BTreeSet};

use glam::DMat4;

use super::arealess::LeftOutAreas;
use super::blur::warn_of_placing;
use super::error::{ModelFault, damaged, missing_uv_set};
use super::face_reversal::FaceReversal;
use super::far::brought_near;
use super::gltf::Resolve;
use super::material_images::MaterialImages;
use super::parts::{NamedPart, NodeGroups};
use super::size::check_size;
use super::submesh::Submesh;
use super::warnings::{TRIANGLES, Warnings, counted};
use super::{LoadOptions, MAX_TRIANGLES};
use crate::model::{Model, ModelMaterial, TextureUvs};

/// Maximum number of coordinates in UV sets other than the chosen one: twice the number of corners of the largest model.
const MOST_TEXTURE_UVS: u64 = 2 * 3 * MAX_TRIANGLES;

/// A mesh that is placed in the scene, as one part of the model.
pub(super) struct MeshInstance {
    /// Its place in [`Assembly::meshes`].
    pub(super) mesh: usize,
    pub(super) name: String,
    /// The node above it, in [`Assembly::groups`].
    pub(super) group: Option<usize>,
    pub(super) file_from_mesh: DMat4,
    /// Material of the file for each number in [`Submesh::materials`]. Higher numbers have no material.
    pub(super) materials: Vec<u32>,
}

/// Meshes, instances and materials that were read from a file.
#[derive(Default)]
pub(super) struct Assembly {
    /// Meshes of one or more submeshes, repaired and completed.
    pub(super) meshes: Vec<Vec<Submesh>>,
    /// UV sets of all meshes, used or not.
    pub(super) uv_sets: BTreeSet<u32>,
    /// Instances in the file's order.
    pub(super) instances: Vec<MeshInstance>,
    /// Nodes above them.
    pub(super) groups: NodeGroups,
    /// In the file's order.
    pub(super) materials: Vec<ModelMaterial>,
    pub(super) pictures: MaterialImages,
}

/// UV sets that the textures of a mesh's materials use.
#[derive(Clone, Default)]
pub(super) struct TextureUvSets {
    pub(super) all: BTreeSet<u32>,
    /// UV sets of normal maps.
    pub(super) framed: BTreeSet<u32>,
}

/// Returns a fault if the triangles of all instances together exceed the maximum number or the memory.
pub(super) fn check_triangles(instances: impl Iterator<Item = u64>, memory_bytes: u64) -> Result<(), ModelFault> {
    let (mut total, mut count) = (0u64, 0);
    for triangles in instances {
        total = total.saturating_add(triangles);
        count += 1;
    }
    check_size(total, count, memory_bytes)
}

impl Assembly {
    /// Returns the UV sets of each of `meshes` meshes, according to the instances and their materials.
    pub(super) fn texture_sets(&self, meshes: usize) -> Vec<TextureUvSets> {
        let mut sets = vec![TextureUvSets::default(); meshes];
        for instance in &self.instances {
            let sets = &mut sets[instance.mesh];
            let materials = instance.materials.iter();
            for material in materials.filter_map(|material| self.materials.get(*material as usize)) {
                sets.all.extend(material.textures().map(|texture| texture.uv_set));
                sets.framed
                    .extend(material.normal.as_ref().map(|texture| texture.uv_set));
            }
        }
        sets
    }

    /// Places all instances, and keeps the materials that are used and their images.
    pub(super) fn into_model(
        mut self,
        name: &str,
        resolve: &mut Resolve,
        options: &LoadOptions,
        mut warnings: Warnings,
    ) -> Result<Model, ModelFault> {
        let named = self.instances.iter().map(|instance| NamedPart {
            name: &instance.name,
            group: instance.group,
        });
        let file_parts = options.parts.of_file(named, &self.groups, &mut warnings)?;
        let mut is_taken = file_parts.iter().map(|part| part.left_out.is_none());
        self.instances.retain(|_| is_taken.next() == Some(true));
        let has = |what: fn(&Submesh) -> bool| self.placements(|submesh, _| what(submesh)).any(|has| has);
        if !has(|submesh| !submesh.triangles.is_empty()) {
            return Err(warnings.into_fault());
        }
        let with_uvs = has(|submesh| !submesh.uvs.is_empty());
        let with_colors = has(|submesh| !submesh.colors.is_empty());
        if !with_uvs {
            missing_uv_set(options.uv_set, &self.uv_sets)?;
        }
        let placements = self.placements(|mesh, instance| (mesh, instance.file_from_mesh));
        let (world_from_file, middle) = brought_near(options.world_from_file(), placements);
        let mut model = Model {
            stem: super::stem(name),
            middle,
            file_parts,
            ..Model::default()
        };
        model.mesh.uv_set = with_uvs.then_some(options.uv_set);
        model.mesh.texture_uvs = self.empty_sets()?;
        let mut without_uvs = BTreeSet::new();
        let (mut lost, mut blurred) = (0, 0);
        let mut arealess = LeftOutAreas::default();
        let mut turning = FaceReversal::new(options.turns_faces);
        for instance in &self.instances {
            let part = model.parts.len() as u32;
            let mut dropped = 0;
            for submesh in &self.meshes[instance.mesh] {
                look();
                let mut placed = submesh.placed(world_from_file * instance.file_from_mesh);
                lost += placed.drop_broken();
                blurred += placed.blurred;
                dropped += placed.drop_arealess();
                for material in &mut placed.materials {
                    *material = self.material_of(instance, *material);
                }
                if with_uvs && placed.uvs.is_empty() {
                    without_uvs.extend(placed.materials.iter().copied());
                }
                placed.parts = vec![part; placed.triangles.len()];
                turning.hold(&placed);
                placed.append_to(&mut model.mesh, with_uvs, with_colors);
            }
            let is_left = model.mesh.triangle_part.last() == Some(&part);
            if is_left {
                model.parts.push(instance.name.clone());
            }
            arealess.add(dropped, &instance.name, is_left);
        }
        warn_of_placing(blurred, &mut warnings);
        arealess.tell(&mut warnings);
        if lost > 0 {
            warnings.add(format!(
                "{} reached out of the range of numbers once placed and had to be left out.",
                counted(lost, TRIANGLES)
            ));
        }
        if model.mesh.triangles.is_empty() {
            return Err(warnings.into_fault());
        }
        turning.apply(&mut model, [with_uvs, with_colors], &mut warnings);
        model.without_uvs = without_uvs;
        number_materials(self.materials, &mut model);
        self.pictures.read(resolve, &mut model, &mut warnings);
        model.warnings = warnings.finish();
        Ok(model)
    }

    /// Each submesh with its instance.
    fn placements<'a, T>(
        &'a self,
        placement: impl Fn(&'a Submesh, &'a MeshInstance) -> T + Copy,
    ) -> impl Iterator<Item = T> {
        let submeshes = self
            .instances
            .iter()
            .map(|instance| (instance, &self.meshes[instance.mesh]));
        submeshes
            .flat_map(move |(instance, submeshes)| submeshes.iter().map(move |submesh| placement(submesh, instance)))
    }

    /// Returns the material of the file for a number of the mesh; a number after the last one if there is none.
    fn material_of(&self, instance: &MeshInstance, number: u32) -> u32 {
        let none = self.materials.len() as u32;
        let material = instance.materials.get(number as usize).copied();
        material.unwrap_or(none).min(none)
    }

    /// Returns the UV sets other than the chosen one that textures use, without coordinates yet.
    fn empty_sets(&self) -> Result<Vec<TextureUvs>, ModelFault> {
        let mut sets = BTreeSet::new();
        let mut vertices = 0u64;
        for (count, used) in self.placements(|submesh, _| (submesh.positions.len(), &submesh.texture_uvs)) {
            vertices = vertices.saturating_add(count as u64);
            sets.extend(used.iter().map(|other| other.set));
        }
        if vertices.saturating_mul(sets.len() as u64) > MOST_TEXTURE_UVS {
            return damaged(format!(
                "its materials use {} further UV sets, too many for {vertices} vertices; export it with all textures in one \
                 UV set",
                sets.len()
            ));
        }
        let of_set = |set| TextureUvs {
            set,
            ..TextureUvs::default()
        };
        Ok(sets.into_iter().map(of_set).collect())
    }
}

/// Keeps the materials that are used, in the file's order. Faces without a material get a plain one, which is the last.
fn number_materials(materials: Vec<ModelMaterial>, model: &mut Model) {
    let used: BTreeSet<u32> = model.mesh.triangle_material.iter().copied().collect();
    let new_from_old: BTreeMap<u32, u32> = used.iter().copied().zip(0..).collect();
    for material in &mut model.mesh.triangle_material {
        *material = new_from_old[material];
    }
    model.without_uvs = model
        .without_uvs
        .iter()
        .map(|material| new_from_old[material])
        .collect();
    let mut materials: Vec<Option<ModelMaterial>> = materials.into_iter().map(Some).collect();
    let taken = used.into_iter().map(|old| {
        let material = materials.get_mut(old as usize).and_then(Option::take);
        material.unwrap_or_else(ModelMaterial::plain)
    });
    model.materials = taken.collect();
}
