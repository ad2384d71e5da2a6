//! Conversion of primitives to [`Submesh`]s: attributes are read, strips and fans are converted to triangles, normals and
//! tangents are completed.

use sabi_cancel::{Cancel, look};
use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3;
use gltf::json;
use json::mesh::{Mode, Semantic};
use json::validation::Checked;
use rayon::prelude::*;

use super::accessor::Indices;
use super::draco::PrimitiveSize;
use super::packed_vertices;
use super::source::GltfSource;
use super::storage::AccessorSemantic;
use super::texture_use::GltfTextureUvSets;
use crate::load::blur::{StorageErrors, blurred};
use crate::load::completion::Completion;
use crate::load::error::{ModelFault, damaged};
use crate::load::normals::NormalMethod;
use crate::load::submesh::Submesh;
use crate::load::warnings::Warnings;
use crate::model::TextureUvs;

/// A primitive that was read.
#[derive(Default)]
pub(super) struct LoadedPrimitive {
    pub(super) submesh: Submesh,
    /// Its material in the file; `None` for glTF's default material.
    pub(super) material: Option<usize>,
    /// Its UV sets.
    pub(super) uv_sets: BTreeSet<u32>,
    /// True if the tangents of the chosen set come from the file.
    pub(super) has_own_tangents: bool,
    /// True if the coordinates of the chosen set are stored as integers.
    pub(super) has_integer_uvs: bool,
    pub(super) warnings: Warnings,
}

impl GltfSource<'_> {
    /// Reads the primitives of the meshes, each mesh once.
    pub(super) fn read_primitives(
        &self,
        meshes: impl Iterator<Item = usize>,
    ) -> Result<BTreeMap<usize, Vec<LoadedPrimitive>>, ModelFault> {
        let meshes: BTreeSet<usize> = meshes.collect();
        let primitives: Vec<(usize, usize)> = meshes
            .iter()
            .flat_map(|mesh| (0..self.document.meshes[*mesh].primitives.len()).map(|primitive| (*mesh, primitive)))
            .collect();
        // All are read before the first fault is returned, so that it does not depend on the order of threads.
        let cancel = Cancel::current();
        let loaded: Vec<_> = primitives
            .par_iter()
            .map(|(mesh, primitive)| cancel.during(|| self.read(*mesh, *primitive)))
            .collect();
        let mut by_mesh: BTreeMap<usize, Vec<LoadedPrimitive>> = BTreeMap::new();
        for ((mesh, _), loaded) in primitives.into_iter().zip(loaded) {
            by_mesh.entry(mesh).or_default().push(loaded?);
        }
        Ok(by_mesh)
    }

    /// Returns the number of vertices that a primitive declares.
    pub(super) fn claimed_vertices(&self, primitive: &json::mesh::Primitive) -> u64 {
        let positions = attribute(primitive, Semantic::Positions);
        positions.map_or(0, |index| self.claimed_count(index.value()))
    }

    /// Returns the number of vertices that a primitive declares, limited by the size of the file if that bounds their number.
    pub(super) fn vertices(&self, primitive: &json::mesh::Primitive) -> u64 {
        let claimed = self.claimed_vertices(primitive);
        match packed_vertices::extension(primitive) {
            Some(_) => claimed,
            None => claimed.min(self.most_unstored().max(self.buffers.unpacked_bytes())),
        }
    }

    /// Returns the number of triangles that a primitive declares.
    pub(super) fn claim(&self, primitive: &json::mesh::Primitive) -> u64 {
        let counted = primitive.indices.or_else(|| attribute(primitive, Semantic::Positions));
        let corners = counted.map_or(0, |index| self.claimed_count(index.value()));
        match primitive.mode {
            Checked::Valid(Mode::Triangles) => corners / 3,
            Checked::Valid(Mode::TriangleStrip | Mode::TriangleFan) => corners.saturating_sub(2),
            _ => 0,
        }
    }

    /// Returns the UV sets of a primitive that its material's textures use.
    pub(super) fn texture_sets(&self, primitive: &json::mesh::Primitive) -> BTreeSet<u32> {
        let material = primitive.material.map(|index| index.value());
        let material = material.and_then(|index| self.document.materials.get(index));
        let mut sets = material.map_or_else(BTreeSet::new, |material| GltfTextureUvSets::of(material).all);
        sets.retain(|set| attribute(primitive, Semantic::TexCoords(*set)).is_some());
        sets
    }

    fn read(&self, mesh: usize, number: usize) -> Result<LoadedPrimitive, ModelFault> {
        look();
        let primitive = &self.document.meshes[mesh].primitives[number];
        let label = self.document.mesh_label(mesh);
        let mut loaded = LoadedPrimitive {
            material: primitive.material.map(|index| index.value()),
            ..LoadedPrimitive::default()
        };
        if let Some(material) = loaded.material.filter(|index| *index >= self.document.materials.len()) {
            return damaged(format!("{label} uses materials[{material}], which is not there"));
        }
        let mode = match primitive.mode {
            Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => mode,
            Checked::Valid(_) => {
                loaded
                    .warnings
                    .add(format!("Points and lines of {label} are left out."));
                return Ok(loaded);
            }
            Checked::Invalid => return damaged(format!("{label} has a primitive of unknown mode")),
        };
        let Some(positions) = attribute(primitive, Semantic::Positions) else {
            loaded
                .warnings
                .add(format!("A primitive of {label} has no positions and is left out."));
            return Ok(loaded);
        };
        if primitive.targets.as_ref().is_some_and(|targets| !targets.is_empty()) {
            loaded
                .warnings
                .add(format!("Morph targets of {label} are left out: it is taken at rest."));
        }
        let claim = PrimitiveSize {
            triangles: self.claim(primitive),
            vertices: self.claimed_vertices(primitive),
        };
        let unpacked = self.unpacked_mesh(primitive, claim, &label)?;
        let source = GltfSource {
            unpacked: unpacked.as_ref(),
            ..*self
        };
        let LoadedPrimitive { submesh, warnings, .. } = &mut loaded;
        submesh.positions = source.floats(
            positions.value(),
            AccessorSemantic::Position,
            &format!("positions of {label}"),
            warnings,
        )?;
        submesh.triangles = source.read_triangles(primitive, mode, &label, submesh.positions.len(), warnings)?;
        if !self.is_integer(positions.value()) {
            let errors = StorageErrors::of(submesh.positions.iter().copied());
            let exact = |vertex: usize| Vec3::from(submesh.positions[vertex]).as_dvec3();
            let error = |vertex: usize| errors.at(submesh.positions[vertex]);
            submesh.blurred_by_file = blurred(&submesh.triangles, exact, error);
        }
        submesh.sources = (0..submesh.positions.len() as u32).collect();
        source.read_attributes(primitive, &label, submesh, warnings)?;
        loaded.uv_sets = primitive.attributes.keys().filter_map(uv_set).collect();
        let chosen = attribute(primitive, Semantic::TexCoords(self.uv_set));
        loaded.has_integer_uvs = chosen.is_some_and(|index| self.is_integer(index.value()));
        complete(&mut loaded, &label, self.smooth_degrees);
        Ok(loaded)
    }

    /// The triangles of a primitive of `vertices` vertices.
    fn read_triangles(
        &self,
        primitive: &json::mesh::Primitive,
        mode: Mode,
        label: &str,
        vertices: usize,
        warnings: &mut Warnings,
    ) -> Result<Vec<[u32; 3]>, ModelFault> {
        if let Some(mesh) = self.unpacked {
            return mesh.triangles(label, vertices);
        }
        let Some(index) = primitive.indices else {
            let corners: Vec<u32> = (0..vertices as u32).collect();
            return Ok(triangles(mode, &corners, label, warnings));
        };
        let Indices { corners, restart } = self.indices(index.value(), &format!("indices of {label}"), warnings)?;
        let beyond = |vertex: &u32| *vertex as usize >= vertices && *vertex != restart;
        if let Some(vertex) = corners.iter().copied().find(beyond) {
            return damaged(format!("{label} names vertex {vertex} of {vertices}"));
        }
        if !corners.contains(&restart) {
            return Ok(triangles(mode, &corners, label, warnings));
        }
        // Graphics APIs restart at this index, in lists as well as in strips.
        warnings.add(format!(
            "The indices of {label} use {restart}, by which strips begin anew, as no vertex; no triangle reaches over it."
        ));
        let runs = corners.split(|vertex| *vertex == restart);
        Ok(runs.flat_map(|run| triangles(mode, run, label, warnings)).collect())
    }

    fn read_attributes(
        &self,
        primitive: &json::mesh::Primitive,
        label: &str,
        submesh: &mut Submesh,
        warnings: &mut Warnings,
    ) -> Result<(), ModelFault> {
        let what = |what: &str| format!("{what} of {label}");
        let mut tangents = Vec::new();
        let count = submesh.positions.len();
        let check = |what: &str, length: usize| check_count(label, count, what, length);
        if let Some(index) = attribute(primitive, Semantic::Normals) {
            submesh.normals = self.floats(index.value(), AccessorSemantic::Direction, &what("normals"), warnings)?;
            check("normals", submesh.normals.len())?;
            // glTF requires that tangents without normals are ignored.
            if let Some(index) = attribute(primitive, Semantic::Tangents) {
                tangents = self.floats(index.value(), AccessorSemantic::Direction, &what("tangents"), warnings)?;
                check("tangents", tangents.len())?;
            }
        }
        if let Some(index) = attribute(primitive, Semantic::Colors(0)) {
            submesh.colors = self.colors(index.value(), &what("colors"), warnings)?;
            check("colors", submesh.colors.len())?;
        }
        self.read_uvs(primitive, label, tangents, submesh, warnings)
    }

    /// Reads the chosen UV set and those that textures use. The file's `tangents` are assigned to the set to which they belong.
    fn read_uvs(
        &self,
        primitive: &json::mesh::Primitive,
        label: &str,
        mut tangents: Vec<[f32; 4]>,
        submesh: &mut Submesh,
        warnings: &mut Warnings,
    ) -> Result<(), ModelFault> {
        let count = submesh.positions.len();
        let material = primitive.material.map(|index| index.value());
        let material = material.and_then(|index| self.document.materials.get(index));
        let sets = material.map_or_else(GltfTextureUvSets::default, GltfTextureUvSets::of);
        // A file's tangents belong to the texture coordinates of the normal map (glTF 2.0, 3.7.2.1), or to set 0 if there
        // is no normal map.
        let framed_set = sets.normal.unwrap_or(0);
        submesh.normal_set = sets.normal;
        let mut wanted = sets.all;
        wanted.insert(self.uv_set);
        for set in wanted {
            let Some(index) = attribute(primitive, Semantic::TexCoords(set)) else {
                continue;
            };
            let what = format!("coordinates of UV set {set} of {label}");
            let uvs: Vec<[f32; 2]> =
                self.floats(index.value(), AccessorSemantic::TextureCoordinate, &what, warnings)?;
            check_count(label, count, "texture coordinates", uvs.len())?;
            let mut own = || {
                if set == framed_set {
                    std::mem::take(&mut tangents)
                } else {
                    Vec::new()
                }
            };
            if set != self.uv_set {
                let tangents = own();
                submesh.texture_uvs.push(TextureUvs { set, uvs, tangents });
            } else {
                submesh.uvs = uvs;
                submesh.tangents = own();
            }
        }
        if submesh.uvs.is_empty() && submesh.texture_uvs.is_empty() {
            submesh.tangents = tangents;
        }
        Ok(())
    }
}

/// Checks that an attribute has a value for each of the `count` positions.
fn check_count(label: &str, count: usize, what: &str, length: usize) -> Result<(), ModelFault> {
    if length == count {
        Ok(())
    } else {
        damaged(format!("{label} has {count} positions and {length} {what}"))
    }
}

/// Repairs invalid attributes and computes missing ones.
fn complete(loaded: &mut LoadedPrimitive, label: &str, smooth_degrees: Option<f32>) {
    let LoadedPrimitive {
        submesh,
        warnings,
        has_own_tangents,
        ..
    } = loaded;
    let completion = Completion {
        missing: NormalMethod::Flat,
        repaired_normals: "had normals without a direction; these were made anew",
        smooth_degrees,
    };
    let framed = submesh.normal_set.into_iter().collect();
    *has_own_tangents = completion.complete(submesh, &framed, label, warnings);
}

fn uv_set(semantic: &Checked<Semantic>) -> Option<u32> {
    match semantic {
        Checked::Valid(Semantic::TexCoords(set)) => Some(*set),
        _ => None,
    }
}

fn attribute(primitive: &json::mesh::Primitive, semantic: Semantic) -> Option<json::Index<json::Accessor>> {
    primitive.attributes.get(&Checked::Valid(semantic)).copied()
}

/// Returns the corners of triangles, also for strips and fans (glTF 2.0, 3.7.2.1).
fn triangles(mode: Mode, corners: &[u32], label: &str, warnings: &mut Warnings) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => corners
            .windows(3)
            .enumerate()
            .map(|(index, v)| {
                if index % 2 == 0 {
                    [v[0], v[1], v[2]]
                } else {
                    [v[0], v[2], v[1]]
                }
            })
            .collect(),
        Mode::TriangleFan => match corners {
            [center, rim @ ..] => rim.windows(2).map(|v| [v[0], v[1], *center]).collect(),
            [] => Vec::new(),
        },
        _ => {
            let (whole, rest) = corners.as_chunks();
            if !rest.is_empty() {
                warnings.add(format!(
                    "The corners of {label} end in the middle of a triangle, which is left out."
                ));
            }
            whole.to_vec()
        }
    }
}
