//! STL, as text and binary: facets without anything else.
//!
//! Facets are flat. Their outside is the side from which the corners are counter-clockwise; the normals in the file are ignored. Corners
//! at exactly the same position become one vertex. The format defines neither units nor an up axis: lengths are read unchanged.

use sabi_cancel::CancelableIterator as _;
use std::collections::{BTreeSet, HashMap};

use glam::DMat4;

use super::LoadOptions;
use super::assembly::{Assembly, MeshInstance};
use super::completion::{Completion, LACKING_NORMALS};
use super::error::{ModelFault, damaged};
use super::faces::Faces;
use super::gltf::Resolve;
use super::normals::NormalMethod;
use super::numbers::number;
use super::polygon::Budget;
use super::size::check_size;
use super::submesh::Smoothing;
use super::text::{decoded, lines, part_name};
use super::warnings::Warnings;
use crate::model::Model;

/// Bytes before the facets of a binary file: a text and their number.
const HEADER_BYTES: usize = 84;
/// Bytes of a binary facet: a normal, three corners, two bytes without a defined meaning.
const FACET_BYTES: usize = 50;

/// Word in the header of files of Magics, whose facets have colors.
const COLORED: &[u8] = b"COLOR=";
/// Bit in the last bytes of a facet by which VisCAM and SolidView say that the others are a color.
const HAS_COLOR: u16 = 1 << 15;
/// Warning about colors of any of these programs, and of lines `color` in a text.
const COLORS_LEFT_OUT: &str = "The colors of facets, which some programs add to the format, are left out.";

/// Bytes among which the first line of a text is looked for.
const START_BYTES: usize = 4096;
/// Starts of comment lines, which some programs write although the format has none.
const REMARKS: [&[u8]; 4] = [b"#", b"//", b";", b"!"];

/// Reads an `.stl` file.
pub(super) fn read(
    name: &str,
    bytes: &[u8],
    resolve: &mut Resolve,
    options: &LoadOptions,
) -> Result<Model, ModelFault> {
    let mut warnings = Warnings::default();
    let mut solids = if is_binary(bytes) {
        vec![read_binary(bytes, options.memory_bytes, &mut warnings)?]
    } else {
        read_text(&decoded(bytes), &mut warnings)?
    };
    solids.retain(|solid| !solid.faces.faces.is_empty());
    let claim = solids.iter().map(|solid| solid.faces.triangles()).sum();
    check_size(claim, solids.len() as u64, options.memory_bytes)?;
    let completion = Completion {
        repaired_normals: LACKING_NORMALS,
        missing: NormalMethod::Flat,
        smooth_degrees: options.smooth_degrees,
    };
    let mut assembly = Assembly::default();
    let mut budget = Budget::default();
    for solid in solids {
        let mut submesh = solid.faces.triangulated(&mut budget, &mut warnings);
        completion.complete(&mut submesh, &BTreeSet::new(), "the model", &mut warnings);
        assembly.instances.push(MeshInstance {
            mesh: assembly.meshes.len(),
            name: if solid.name.is_empty() {
                super::stem(name)
            } else {
                solid.name
            },
            group: None,
            file_from_mesh: DMat4::IDENTITY,
            materials: Vec::new(),
        });
        assembly.meshes.push(vec![submesh]);
    }
    assembly.into_model(name, resolve, options, warnings)
}

/// Returns true if the file has the size of a binary file with its number of facets, or if it does not start with text.
/// Binary files may start with the same word as text files.
fn is_binary(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(FACET_BYTES * 8)];
    has_binary_size(bytes) || !begins_as_text(bytes) || start.contains(&0)
}

/// Returns true if a file has the size of a binary file with its number of facets.
pub(super) fn has_binary_size(bytes: &[u8]) -> bool {
    binary_size(bytes) == Some(bytes.len() as u64)
}

/// Returns true if a file with an unknown extension looks like STL.
pub(super) fn is_likely(bytes: &[u8]) -> bool {
    has_binary_size(bytes) || begins_as_text(bytes)
}

/// Returns true if the first line that is not a comment starts like a text file.
fn begins_as_text(bytes: &[u8]) -> bool {
    let lines = bytes[..bytes.len().min(START_BYTES)].split(|byte| matches!(byte, b'\n' | b'\r'));
    let first = lines
        .map(<[u8]>::trim_ascii)
        .find(|line| !line.is_empty() && !REMARKS.iter().any(|mark| line.starts_with(mark)));
    let word = first.and_then(|line| line.split(u8::is_ascii_whitespace).next());
    // Some programs omit the line with `solid`.
    word.is_some_and(|word| {
        [&b"solid"[..], b"facet"]
            .iter()
            .any(|begin| word.eq_ignore_ascii_case(begin))
    })
}

/// Returns the size that a binary file should have according to its header.
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
    known: HashMap<[u64; 3], u32>,
}

impl Solid {
    /// Adds a corner of the open facet.
    fn corner(&mut self, at: [f64; 3]) {
        // Adding 0.0 converts −0 to 0.
        let at = at.map(|x| x + 0.0);
        let next = self.faces.positions.len() as u32;
        let position = *self.known.entry(at.map(f64::to_bits)).or_insert(next);
        if position == next {
            self.faces.positions.push(at);
        }
        self.faces.corners.push(position);
    }
}

fn read_binary(bytes: &[u8], memory_bytes: u64, warnings: &mut Warnings) -> Result<Solid, ModelFault> {
    let Some(size) = binary_size(bytes) else {
        return damaged("it is no STL file: it does not begin with `solid`, and is too short for a binary one");
    };
    let body = &bytes[HEADER_BYTES..];
    let (there, rest) = body.as_chunks::<FACET_BYTES>();
    let claim = (size - HEADER_BYTES as u64) / FACET_BYTES as u64;
    let facets = match usize::try_from(claim).ok().and_then(|claim| there.get(..claim)) {
        // A program that does not know the number when it starts to write writes 0.
        Some([]) if !there.is_empty() && rest.is_empty() => there,
        Some(facets) => facets,
        None if rest.is_empty() => there,
        None => {
            return damaged(format!(
                "it promises {claim} facets and has {}; it was cut off",
                there.len()
            ));
        }
    };
    check_size(facets.len() as u64, 1, memory_bytes)?;
    let has_color = |facet: &[u8; FACET_BYTES]| {
        facet
            .last_chunk()
            .is_some_and(|last| u16::from_le_bytes(*last) & HAS_COLOR != 0)
    };
    if bytes[..HEADER_BYTES].windows(COLORED.len()).any(|word| word == COLORED)
        || facets.iter().looking().any(has_color)
    {
        warnings.add(COLORS_LEFT_OUT);
    }
    if facets.len() as u64 != claim {
        warnings.add(format!(
            "The file says that it has {claim} facets, and has {}; these are read.",
            facets.len()
        ));
    } else if there.len() > facets.len() {
        warnings.add(format!(
            "The file goes on behind the {claim} facets that it says it has; what follows is left out."
        ));
    }
    let mut solid = Solid::default();
    solid.faces.is_single = true;
    for facet in facets.iter().looking() {
        let numbers: &[[u8; 4]] = facet.as_chunks().0;
        // The first three numbers are a normal.
        let (corners, _) = numbers[3..].as_chunks::<3>();
        for corner in corners {
            solid.corner(corner.map(f32::from_le_bytes).map(f64::from));
        }
        solid.faces.close(3, 0, Smoothing::ByAngle);
    }
    Ok(solid)
}

/// Reader of a text.
struct TextReader<'w> {
    solids: Vec<Solid>,
    /// First corner of the open facet.
    first: usize,
    warnings: &'w mut Warnings,
}

/// Reads the solids of a text, each `solid NAME` followed by `facet … outer loop vertex x y z … endloop endfacet`. The end
/// keywords may be written as two words.
fn read_text(text: &str, warnings: &mut Warnings) -> Result<Vec<Solid>, ModelFault> {
    let mut reader = TextReader {
        solids: Vec::new(),
        first: 0,
        warnings,
    };
    for (line, number) in lines(text).zip(1..) {
        if REMARKS
            .iter()
            .any(|mark| line.trim_ascii_start().as_bytes().starts_with(mark))
        {
            continue;
        }
        let read = reader.read(line);
        read.map_err(|what| ModelFault::Damaged(format!("line {number}: {what}")))?;
    }
    for solid in &mut reader.solids {
        let whole = solid.faces.faces.last().map_or(0, |face| face.corners.end);
        if solid.faces.corners.len() > whole {
            reader
                .warnings
                .add("The file ends in the middle of a facet, which is left out.");
            solid.faces.corners.truncate(whole);
        }
    }
    Ok(reader.solids)
}

impl TextReader<'_> {
    /// Reads a line, which may contain a whole facet and more.
    fn read(&mut self, line: &str) -> Result<(), String> {
        let mut words = line.split_ascii_whitespace();
        while let Some(word) = words.next() {
            let is = |other: &str| word.eq_ignore_ascii_case(other);
            if is("solid") {
                let name = solid_name(&mut words);
                self.close();
                self.first = 0;
                // One without any facet is nothing, and a file may have millions of them.
                let is_empty = |solid: &mut Solid| solid.faces.corners.is_empty();
                self.solids.pop_if(is_empty);
                self.solids.push(Solid {
                    name,
                    ..Solid::default()
                });
            } else if is("endsolid") || is("end") && next_is(&words, "solid") {
                self.close();
                words.by_ref().for_each(drop);
            } else if is("vertex") {
                let corner = corner(&mut words, self.warnings).ok_or("`vertex` needs 3 numbers")?;
                self.solid().corner(corner);
            } else if is("color") {
                self.warnings.add(COLORS_LEFT_OUT);
            } else if ["facet", "end", "endloop", "endfacet"].into_iter().any(is) {
                self.close();
            }
        }
        Ok(())
    }

    /// Returns the current solid. The line that starts the first solid may be missing.
    fn solid(&mut self) -> &mut Solid {
        if self.solids.is_empty() {
            self.solids.push(Solid::default());
        }
        let last = self.solids.len() - 1;
        &mut self.solids[last]
    }

    /// Closes the open facet, if it has corners.
    fn close(&mut self) {
        let Some(solid) = self.solids.last_mut() else { return };
        let count = solid.faces.corners.len() - self.first;
        if count >= 3 {
            solid.faces.close(count, 0, Smoothing::ByAngle);
        } else if count > 0 {
            self.warnings.add("Faces with fewer than 3 corners are left out.");
            solid.faces.corners.truncate(self.first);
        }
        self.first = solid.faces.corners.len();
    }
}

/// The three numbers of a corner.
fn corner<'a>(words: &mut impl Iterator<Item = &'a str>, warnings: &mut Warnings) -> Option<[f64; 3]> {
    let mut next = || number(words.next()?, warnings);
    Some([next()?, next()?, next()?])
}

/// The name of a solid: the rest of its line, or what stands before its first facet.
fn solid_name<'a>(words: &mut (impl Iterator<Item = &'a str> + Clone)) -> String {
    let mut name = Vec::new();
    loop {
        let mut ahead = words.clone();
        let is_facet = ahead.next().is_some_and(|word| word.eq_ignore_ascii_case("facet"));
        if is_facet && next_is(&ahead, "normal") {
            break;
        }
        let Some(word) = words.next() else { break };
        name.push(word);
    }
    part_name(&name.join(" "))
}

/// Returns true if the next word is this one.
fn next_is<'a>(words: &(impl Iterator<Item = &'a str> + Clone), word: &str) -> bool {
    words.clone().next().is_some_and(|next| next.eq_ignore_ascii_case(word))
}
