//! Meshes: lists of polygons, and the attributes of their corners.

use sabi_cancel::CancelableIterator as _;
use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;
use sabi_color::linear_from_srgb;

use super::document::{DaeDocument, child};
use super::polygons::Polygons;
use super::sources::DaeSources;
use crate::load::error::{ModelFault, damaged};
use crate::load::faces::{Faces, NONE};
use crate::load::submesh::Smoothing;
use crate::load::warnings::Warnings;

/// A mesh of the file.
pub(super) struct Geometry<'d> {
    /// Name in warnings.
    pub(super) who: String,
    /// Values of `set` of the UV sets, ascending. The position in this list is the number of the UV set.
    pub(super) uv_sets: Vec<u32>,
    /// Symbols of the materials. Instances assign materials to them.
    pub(super) symbols: Vec<&'d str>,
    pub(super) lists: Vec<PolygonList<'d>>,
}

/// Polygons with one material.
pub(super) struct PolygonList<'d> {
    polygons: Polygons<'d>,
    /// Index in [`Geometry::symbols`]; [`NONE`] without a material.
    material: u32,
}

impl<'d> Geometry<'d> {
    /// `node` is a `geometry`.
    pub(super) fn new(
        document: &DaeDocument<'d>,
        node: Node<'d, 'd>,
        warnings: &mut Warnings,
    ) -> Result<Geometry<'d>, ModelFault> {
        // A geometry that is instantiated has at least an id.
        let name = node.attribute("name").or(node.attribute("id")).unwrap_or_default();
        let mut geometry = Geometry {
            who: format!("mesh `{name}`"),
            uv_sets: Vec::new(),
            symbols: Vec::new(),
            lists: Vec::new(),
        };
        let mesh = child(node, "mesh").or_else(|| child(node, "convex_mesh"));
        if mesh.is_none() {
            warnings.add("Curved surfaces are left out; convert them to polygons before the export.");
        }
        let mut sets = BTreeSet::new();
        let mut symbols: BTreeMap<&str, u32> = BTreeMap::new();
        for list in mesh.into_iter().flat_map(|mesh| mesh.children()) {
            let Some(polygons) = Polygons::read(document, list, &geometry.who, warnings)? else {
                continue;
            };
            sets.extend(polygons.uv_inputs().map(|input| input.set));
            if polygons.counts.is_empty() {
                continue;
            }
            let material = list.attribute("material").map(|symbol| {
                *symbols.entry(symbol).or_insert_with(|| {
                    geometry.symbols.push(symbol);
                    geometry.symbols.len() as u32 - 1
                })
            });
            geometry.lists.push(PolygonList {
                polygons,
                material: material.unwrap_or(NONE),
            });
        }
        geometry.uv_sets = sets.into_iter().collect();
        Ok(geometry)
    }

    /// Number of its triangles.
    pub(super) fn triangles(&self) -> u64 {
        self.lists.iter().map(|list| list.polygons.triangles()).sum()
    }

    /// Returns the number of the UV set with the file's number `set`.
    pub(super) fn uv_set(&self, set: u32) -> Option<u32> {
        let place = self.uv_sets.binary_search(&set).ok()?;
        Some(place as u32)
    }

    /// Reads one of its lists, with the chosen UV set and further `wanted` ones.
    pub(super) fn read(
        &self,
        list: &PolygonList<'d>,
        chosen: u32,
        wanted: &BTreeSet<u32>,
        sources: &mut DaeSources,
        warnings: &mut Warnings,
    ) -> Result<Faces, ModelFault> {
        let mut faces = Faces::default();
        let Some(positions) = list.polygons.input("POSITION") else {
            warnings.add(format!("A part of {} has no positions and is left out.", self.who));
            return Ok(faces);
        };
        let positions = sources.gathered(&list.polygons, positions, position, warnings);
        if let Some(index) = positions.beyond {
            return damaged(format!("{} names position {index}, which is not there", self.who));
        }
        faces.positions = positions.attribute.values;
        let mut rest = &positions.attribute.corners[..];
        for count in list.polygons.counts.iter().looking() {
            let (corners, after) = rest.split_at(*count as usize);
            faces.corners.extend(corners);
            faces.close(corners.len(), list.material, Smoothing::ByAngle);
            rest = after;
        }
        self.read_attributes(&mut faces, list, chosen, wanted, sources, warnings);
        Ok(faces)
    }

    fn read_attributes(
        &self,
        faces: &mut Faces,
        list: &PolygonList<'d>,
        chosen: u32,
        wanted: &BTreeSet<u32>,
        sources: &mut DaeSources,
        warnings: &mut Warnings,
    ) {
        let polygons = &list.polygons;
        let mut is_beyond = false;
        if let Some(input) = polygons.input("NORMAL") {
            let normals = sources.gathered(polygons, input, vector, warnings);
            is_beyond |= normals.beyond.is_some();
            faces.normals = normals.attribute.joined();
        }
        if let Some(input) = polygons.input("COLOR") {
            let colors = sources.gathered(polygons, input, color, warnings);
            is_beyond |= colors.beyond.is_some();
            faces.colors = colors.attribute.joined();
        }
        for input in polygons.uv_inputs() {
            let set = self.uv_set(input.set);
            let known = |set: &u32| faces.texture_uvs.iter().any(|(other, _)| other == set);
            let Some(set) = set.filter(|set| wanted.contains(set) && !known(set)) else {
                continue;
            };
            let uvs = sources.gathered(polygons, input, coordinate, warnings);
            is_beyond |= uvs.beyond.is_some();
            let uvs = uvs.attribute.joined();
            if set == chosen {
                faces.uvs = uvs;
            } else {
                faces.texture_uvs.push((set, uvs));
            }
        }
        faces.texture_uvs.sort_by_key(|(set, _)| *set);
        if is_beyond {
            warnings.add("Faces name texture coordinates, normals or colors that the file does not have.");
        }
    }
}

fn position(row: &[f64]) -> Option<[f64; 3]> {
    row.first_chunk().copied()
}

fn vector(row: &[f64]) -> Option<[f32; 3]> {
    position(row).map(single)
}

/// Returns UV coordinates. v grows upward in the file.
fn coordinate(row: &[f64]) -> Option<[f32; 2]> {
    let [u, v] = row.first_chunk()?;
    Some(single([*u, 1.0 - v]))
}

fn color(row: &[f64]) -> Option<[f32; 4]> {
    let light = single(*row.first_chunk::<3>()?);
    let [r, g, b] = light.map(|share| linear_from_srgb(share.clamp(0.0, 1.0)));
    // A color of three numbers is opaque.
    Some([r, g, b, row.get(3).map_or(1.0, |alpha| *alpha as f32)])
}

fn single<const N: usize>(numbers: [f64; N]) -> [f32; N] {
    numbers.map(|x| x as f32)
}
