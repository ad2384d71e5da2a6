//! STL, as text and binary: facets without anything else.
//!
//! Facets are flat, and their outside is where their corners turn counter-clockwise; the normals that the file adds are not
//! read. Corners at exactly one position are one vertex. The format has no units and no axis that points up: lengths are taken
//! as they are.

use std::collections::{BTreeSet, HashMap};

use glam::DMat4;

use super::LoadOptions;
use super::assembly::{Assembly, Instance};
use super::completion::{Completion, LACKING_NORMALS};
use super::error::{Fault, damaged};
use super::faces::Faces;
use super::gltf::Resolve;
use super::normals::Missing;
use super::polygon::Budget;
use super::size::check_size;
use super::submesh::Smoothing;
use super::text::decoded;
use super::warnings::Warnings;
use crate::model::Model;

/// Bytes before the facets of a binary file: a text and their number.
const HEADER_BYTES: usize = 84;
/// Bytes of a binary facet: a normal, three corners, two bytes of any meaning.
const FACET_BYTES: usize = 50;

/// Reads an `.stl` file.
pub(super) fn read(name: &str, bytes: &[u8], resolve: &mut Resolve, options: &LoadOptions) -> Result<Model, Fault> {
    let mut warnings = Warnings::default();
    let mut solids = if is_binary(bytes) {
        vec![read_binary(bytes, options.memory_bytes)?]
    } else {
        read_text(&decoded(bytes), &mut warnings)?
    };
    solids.retain(|solid| !solid.faces.faces.is_empty());
    let claim = solids.iter().map(|solid| solid.faces.triangles()).sum();
    check_size(claim, solids.len() as u64, options.memory_bytes)?;
    let completion = Completion {
        repaired_normals: LACKING_NORMALS,
        missing: Missing::Flat,
        smooth_degrees: options.smooth_degrees,
    };
    let mut assembly = Assembly::default();
    let mut budget = Budget::default();
    for solid in solids {
        let mut submesh = solid.faces.triangulated(&mut budget, &mut warnings);
        completion.complete(&mut submesh, &BTreeSet::new(), "the model", &mut warnings);
        assembly.instances.push(Instance {
            mesh: assembly.meshes.len(),
            name: if solid.name.is_empty() {
                super::stem(name)
            } else {
                solid.name
            },
            file_from_mesh: DMat4::IDENTITY,
            materials: Vec::new(),
        });
        assembly.meshes.push(vec![submesh]);
    }
    assembly.into_model(name, resolve, options, warnings)
}

/// Returns true if the size is that of a binary file of as many facets as it says, or if its beginning is no text. Binary
/// files may begin with the word of text files.
fn is_binary(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(FACET_BYTES * 8)];
    binary_size(bytes) == Some(bytes.len() as u64) || !starts_with_solid(bytes) || start.contains(&0)
}

/// Returns true if a file of an unknown ending looks like STL.
pub(super) fn is_likely(bytes: &[u8]) -> bool {
    binary_size(bytes) == Some(bytes.len() as u64) || starts_with_solid(bytes)
}

/// Returns true if the file begins as text files do.
fn starts_with_solid(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start();
    let word = start.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    word && start.get(5).is_none_or(u8::is_ascii_whitespace)
}

/// Size that a binary file says it has.
fn binary_size(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER_BYTES - 4..HEADER_BYTES)?;
    let count = u32::from_le_bytes(count.try_into().ok()?);
    Some(HEADER_BYTES as u64 + FACET_BYTES as u64 * u64::from(count))
}

/// Facets with one name.
#[derive(Default)]
struct Solid {
    name: String,
    faces: Faces,
    /// Corner positions by their bits.
    known: HashMap<[u32; 3], u32>,
}

impl Solid {
    fn corner(&mut self, at: [f32; 3]) {
        // + 0.0 turns −0 into 0.
        let at = at.map(|x| x + 0.0);
        let next = self.faces.positions.len() as u32;
        let position = *self.known.entry(at.map(f32::to_bits)).or_insert(next);
        if position == next {
            self.faces.positions.push(at);
        }
        self.faces.corners.push(position);
    }
}

fn read_binary(bytes: &[u8], memory_bytes: u64) -> Result<Solid, Fault> {
    let Some(size) = binary_size(bytes) else {
        return damaged("it is no STL file: it does not begin with `solid`, and is too short for a binary one");
    };
    if size > bytes.len() as u64 {
        let [claim, there] =
            [size, bytes.len() as u64].map(|size| size.saturating_sub(HEADER_BYTES as u64) / FACET_BYTES as u64);
        return damaged(format!("it promises {claim} facets and has {there}; it was cut off"));
    }
    let claim = (size - HEADER_BYTES as u64) / FACET_BYTES as u64;
    check_size(claim, 1, memory_bytes)?;
    let mut solid = Solid::default();
    for facet in bytes[HEADER_BYTES..size as usize].as_chunks::<FACET_BYTES>().0 {
        let numbers: &[[u8; 4]] = facet.as_chunks().0;
        // The first three numbers are a normal.
        let (corners, _) = numbers[3..].as_chunks::<3>();
        for corner in corners {
            solid.corner(corner.map(f32::from_le_bytes));
        }
        solid.faces.close(3, 0, Smoothing::ByAngle);
    }
    Ok(solid)
}

/// Reads the solids of a text, each `solid NAME`, then `facet … outer loop vertex x y z … endloop endfacet`.
fn read_text(text: &str, warnings: &mut Warnings) -> Result<Vec<Solid>, Fault> {
    let mut solids: Vec<Solid> = Vec::new();
    let mut first = 0;
    for (line, number) in text.lines().zip(1..) {
        let mut words = line.split_ascii_whitespace();
        // A facet may stand on one line.
        while let Some(word) = words.next() {
            if word.eq_ignore_ascii_case("solid") {
                let name: Vec<&str> = words.by_ref().collect();
                let name = name.join(" ");
                solids.push(Solid {
                    name,
                    ..Solid::default()
                });
                first = 0;
                continue;
            }
            let Some(solid) = solids.last_mut() else { continue };
            if word.eq_ignore_ascii_case("endsolid") {
                words.by_ref().for_each(drop);
            } else if word.eq_ignore_ascii_case("vertex") {
                let Some(corner) = corner(&mut words) else {
                    return damaged(format!("line {number}: `vertex` needs 3 numbers"));
                };
                solid.corner(corner);
            } else if word.eq_ignore_ascii_case("endloop") || word.eq_ignore_ascii_case("endfacet") {
                let count = solid.faces.corners.len() - first;
                if count >= 3 {
                    solid.faces.close(count, 0, Smoothing::ByAngle);
                } else if count > 0 {
                    warnings.add("Faces with fewer than 3 corners are left out.");
                    solid.faces.corners.truncate(first);
                }
                first = solid.faces.corners.len();
            }
        }
    }
    for solid in &mut solids {
        let whole = solid.faces.faces.last().map_or(0, |face| face.corners.end);
        if solid.faces.corners.len() > whole {
            warnings.add("The file ends in the middle of a facet, which is left out.");
            solid.faces.corners.truncate(whole);
        }
    }
    Ok(solids)
}

/// Three numbers; one that is no number, such as `nan` or `-1.#IND`, makes a broken corner.
fn corner<'a>(words: &mut impl Iterator<Item = &'a str>) -> Option<[f32; 3]> {
    let mut next = || {
        let word = words.next()?;
        let number = word.parse().ok();
        number.or(word.contains(".#").then_some(f32::NAN))
    };
    Some([next()?, next()?, next()?])
}
