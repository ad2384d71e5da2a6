//! Triangles that become part of a [`Mesh`]: repaired, completed, placed.

use sabi_cancel::{Cancel, CancelableIterator as _};
use std::collections::HashMap;

use glam::{DMat4, DVec3, Vec3};

use super::blur::blurred;
use super::unit_vector::{perpendicular, unit};
use crate::model::{Mesh, MissingUvs, TextureUvs};

/// Triangles with one set of vertex attributes, in the space of their mesh. Attributes that the file lacks are empty.
#[derive(Clone, Debug, Default)]
pub(crate) struct Submesh {
    /// Positions relative to [`Submesh::origin`].
    pub(crate) positions: Vec<[f32; 3]>,
    /// Origin of the positions in the space of the mesh. It is zero unless the vertices are far from the mesh's own origin.
    pub(crate) origin: DVec3,
    /// Number of triangles that lost their shape when positions were rounded to 32 bits.
    pub(crate) blurred: usize,
    /// Number of triangles that had lost their shape in the file already.
    pub(crate) blurred_by_file: usize,
    /// Normals; zero for a vertex without one.
    pub(crate) normals: Vec<[f32; 3]>,
    /// How normals were computed that do not come from the file.
    pub(crate) made_normals: Option<MadeNormals>,
    pub(crate) tangents: Vec<[f32; 4]>,
    pub(crate) uvs: Vec<[f32; 2]>,
    /// Other UV sets that textures of the material use, by ascending number.
    pub(crate) texture_uvs: Vec<TextureUvs>,
    /// UV set of the material's normal map.
    pub(crate) normal_set: Option<u32>,
    /// For each vertex, the vertex of the mesh or file from which it was made; empty if this is not needed.
    pub(crate) sources: Vec<u32>,
    pub(crate) colors: Vec<[f32; 4]>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Material of each triangle.
    pub(crate) materials: Vec<u32>,
    /// Part of each triangle.
    pub(crate) parts: Vec<u32>,
    /// Smoothing of each triangle, for missing normals; empty if the format has none.
    pub(crate) smoothing: Vec<Smoothing>,
}

/// Smoothing of shading across a triangle's edges, as stored in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Smoothing {
    /// Not given: edges are smooth unless the angle is large.
    ByAngle,
    /// Flat.
    Off,
    /// Smooth towards triangles of the same group.
    Group(u32),
}

/// How normals were computed that do not come from the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum MadeNormals {
    /// One for each triangle; the file has no normals.
    Flat,
    /// Smooth up to a fixed angle; the file has no normals.
    Crease,
    /// Smooth up to this angle between faces, in degrees; replaces the file's normals.
    Smooth(f32),
}

impl Submesh {
    /// Removes triangles with a position that is not finite, and vertices that no triangle uses. Returns the number of triangles removed.
    pub(super) fn drop_broken(&mut self) -> usize {
        let finite: Vec<bool> = self
            .positions
            .iter()
            .map(|at| at.iter().all(|x| x.is_finite()))
            .collect();
        let before = self.triangles.len();
        if finite.contains(&false) {
            let keep: Vec<bool> = self
                .triangles
                .iter()
                .map(|corners| corners.iter().all(|v| finite[*v as usize]))
                .collect();
            self.retain_triangles(&keep);
        } else {
            self.drop_unused();
        }
        before - self.triangles.len()
    }

    /// Swaps the chosen set with another one.
    pub(super) fn swap_set(&mut self, index: usize) {
        let other = &mut self.texture_uvs[index];
        std::mem::swap(&mut self.uvs, &mut other.uvs);
        std::mem::swap(&mut self.tangents, &mut other.tangents);
    }

    pub(super) fn drop_unused(&mut self) {
        let mut used = vec![false; self.positions.len()];
        for corner in self.triangles.as_flattened() {
            used[*corner as usize] = true;
        }
        if !used.contains(&false) {
            return;
        }
        let mut new_from_old = vec![0u32; used.len()];
        for (new, old) in (0..used.len()).filter(|old| used[*old]).enumerate() {
            new_from_old[old] = new as u32;
        }
        for corner in self.triangles.as_flattened_mut() {
            *corner = new_from_old[*corner as usize];
        }
        retain(&mut self.positions, &used);
        retain(&mut self.normals, &used);
        retain(&mut self.tangents, &used);
        retain(&mut self.uvs, &used);
        retain(&mut self.colors, &used);
        retain(&mut self.sources, &used);
        for other in &mut self.texture_uvs {
            retain(&mut other.uvs, &used);
            retain(&mut other.tangents, &used);
        }
    }

    /// Replaces texture coordinates and colors that are not finite by zero and white. Returns the number of affected vertices.
    pub(super) fn repair_attributes(&mut self) -> usize {
        let mut repaired = 0;
        let others = self.texture_uvs.iter_mut().flat_map(|other| &mut other.uvs);
        for uv in self.uvs.iter_mut().chain(others) {
            if !uv.iter().all(|x| x.is_finite()) {
                *uv = [0.0; 2];
                repaired += 1;
            }
        }
        for color in &mut self.colors {
            if !color.iter().all(|x| x.is_finite()) {
                *color = [1.0; 4];
                repaired += 1;
            }
        }
        repaired
    }

    /// Returns for each vertex the first vertex at exactly the same position.
    pub(super) fn first_at_position(&self) -> Vec<u32> {
        // Adding 0.0 converts −0 to 0.
        let bits = |vertex: u32| self.positions[vertex as usize].map(|x| (x + 0.0).to_bits());
        let mut order: Vec<u32> = (0..self.positions.len() as u32).collect();
        let cancel = Cancel::current();
        order.sort_unstable_by_key(|vertex| {
            cancel.look();
            (bits(*vertex), *vertex)
        });
        let mut first_at = vec![0; self.positions.len()];
        for run in order.chunk_by(|a, b| bits(*a) == bits(*b)) {
            for vertex in run {
                first_at[*vertex as usize] = run[0];
            }
        }
        first_at
    }

    /// Assigns the values of corners to their vertices. Vertices whose corners have different values are split. `corners`
    /// has three values for each triangle; the result has one for each vertex. Triangles keep their order.
    pub(crate) fn split_by<const N: usize>(&mut self, corners: &[[f32; N]]) -> Vec<[f32; N]> {
        let count = self.positions.len();
        let mut origins: Vec<u32> = Vec::new();
        let mut values: Vec<Option<[f32; N]>> = vec![None; count];
        let mut split: HashMap<(u32, [u32; N]), u32> = HashMap::new();
        let all = self.triangles.as_flattened_mut().iter_mut().zip(corners);
        for (corner, value) in all.looking() {
            let bits = value.map(f32::to_bits);
            match values[*corner as usize] {
                None => values[*corner as usize] = Some(*value),
                Some(first) if first.map(f32::to_bits) == bits => {}
                Some(_) => {
                    let origin = *corner;
                    *corner = *split.entry((origin, bits)).or_insert_with(|| {
                        origins.push(origin);
                        values.push(Some(*value));
                        values.len() as u32 - 1
                    });
                }
            }
        }
        repeat(&mut self.positions, &origins);
        repeat(&mut self.normals, &origins);
        repeat(&mut self.tangents, &origins);
        repeat(&mut self.uvs, &origins);
        repeat(&mut self.colors, &origins);
        repeat(&mut self.sources, &origins);
        for other in &mut self.texture_uvs {
            repeat(&mut other.uvs, &origins);
            repeat(&mut other.tangents, &origins);
        }
        // A vertex that no triangle uses has no corner, and its value is never read.
        values.into_iter().map(|value| value.unwrap_or([0.0; N])).collect()
    }

    /// Returns the submesh transformed by `world_from_mesh`. If the transform mirrors, the winding of triangles is
    /// reversed, so that their outside stays outside.
    pub(super) fn placed(&self, world_from_mesh: DMat4) -> Submesh {
        let mut placed = self.clone();
        let world_from_mesh = world_from_mesh * DMat4::from_translation(self.origin);
        placed.origin = DVec3::ZERO;
        if world_from_mesh == DMat4::IDENTITY {
            return placed;
        }
        let linear = glam::DMat3::from_mat4(world_from_mesh);
        let mirrored = linear.determinant() < 0.0;
        let sign = if mirrored { -1.0 } else { 1.0 };
        // The cofactor matrix is the inverse transpose times the determinant, and is also defined for singular matrices.
        let [a, b, c] = [linear.x_axis, linear.y_axis, linear.z_axis];
        let normal_from_normal = glam::DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b)) * sign;
        let exact = |vertex: usize| world_from_mesh.transform_point3(Vec3::from(self.positions[vertex]).as_dvec3());
        for (vertex, at) in placed.positions.iter_mut().enumerate().looking() {
            *at = exact(vertex).as_vec3().into();
        }
        let error = |vertex: usize| exact(vertex).distance(Vec3::from(placed.positions[vertex]).as_dvec3());
        placed.blurred = self.blurred.max(blurred(&self.triangles, exact, error));
        for normal in placed.normals.iter_mut().looking() {
            // If the transform is singular, there is no direction, and the normal of the file is kept.
            *normal = unit(normal_from_normal * Vec3::from(*normal).as_dvec3()).unwrap_or(*normal);
        }
        let others = placed.texture_uvs.iter_mut().map(|other| &mut other.tangents);
        let frames = std::iter::once(&mut placed.tangents).chain(others);
        let with_normals = frames.flat_map(|tangents| tangents.iter_mut().zip(&placed.normals));
        for (tangent, normal) in with_normals.looking() {
            let [x, y, z, w] = *tangent;
            let turned = linear * Vec3::new(x, y, z).as_dvec3();
            let [x, y, z] = unit(turned).unwrap_or_else(|| perpendicular(*normal));
            *tangent = [x, y, z, if mirrored { -w } else { w }];
        }
        if mirrored {
            for corners in &mut placed.triangles {
                corners.swap(1, 2);
            }
        }
        placed
    }

    /// Records in `mesh` the sets that the submesh lacks, before its triangles are appended.
    fn note_missing(&self, mesh: &mut Mesh, with_uvs: bool) {
        let first = mesh.triangles.len() as u32;
        let others = mesh.texture_uvs.iter().map(|other| other.set);
        let lacked = others.filter(|set| !self.texture_uvs.iter().any(|own| own.set == *set));
        let chosen = mesh.uv_set.filter(|_| with_uvs && self.uvs.is_empty());
        let missing = |set| MissingUvs {
            set,
            triangles: first..first + self.triangles.len() as u32,
        };
        let found: Vec<MissingUvs> = lacked.chain(chosen).map(missing).collect();
        mesh.missing_uvs.extend(found);
    }

    /// Appends the triangles to `mesh`, which has all sets of all submeshes. Missing texture coordinates become zero,
    /// missing colors white.
    pub(super) fn append_to(self, mesh: &mut Mesh, with_uvs: bool, with_colors: bool) {
        let first = mesh.positions.len() as u32;
        let count = self.positions.len();
        self.note_missing(mesh, with_uvs);
        for set in &mut mesh.texture_uvs {
            let own = self.texture_uvs.iter().find(|own| own.set == set.set);
            let (uvs, tangents) = own.map_or((&[][..], &[][..]), |own| (&own.uvs, &own.tangents));
            set.uvs.extend(uvs);
            set.uvs.resize(first as usize + count, [0.0; 2]);
            // No normal map uses these tangents, so any tangent is valid.
            let tangents = if tangents.is_empty() { &self.tangents } else { tangents };
            set.tangents.extend(tangents);
        }
        mesh.positions.extend(self.positions);
        mesh.normals.extend(self.normals);
        mesh.tangents.extend(self.tangents);
        if with_uvs {
            mesh.uvs.extend(self.uvs);
            mesh.uvs.resize(first as usize + count, [0.0; 2]);
        }
        if with_colors {
            mesh.colors.extend(self.colors);
            mesh.colors.resize(first as usize + count, [1.0; 4]);
        }
        mesh.triangles
            .extend(self.triangles.iter().map(|corners| corners.map(|v| v + first)));
        mesh.triangle_material.extend(self.materials);
        mesh.triangle_part.extend(self.parts);
    }
}

pub(super) fn retain<T>(values: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    values.retain(|_| keep.next() == Some(&true));
    // Primitives that share vertices would otherwise each keep memory for all of them.
    values.shrink_to_fit();
}

fn repeat<T: Copy>(values: &mut Vec<T>, origins: &[u32]) {
    if values.is_empty() {
        return;
    }
    values.reserve(origins.len());
    for origin in origins {
        values.push(values[*origin as usize]);
    }
}
