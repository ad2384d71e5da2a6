//! The lines of an OBJ file.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::colors::ObjColors;
use super::unknown::Unknown;
use crate::load::error::{ModelFault, damaged};
use crate::load::faces::{Attribute, Face, Faces, NONE};
use crate::load::numbers::number;
use crate::load::submesh::Smoothing;
use crate::load::text::{lines, part_name};
use crate::load::warnings::Warnings;

/// Most material libraries that are read.
pub(super) const MOST_LIBRARIES: usize = 1000;

/// Content of the file, with checked indices.
#[derive(Default)]
pub(super) struct Statements {
    pub(super) faces: Faces,
    /// Names given by `usemtl`, and an empty name for faces before the first.
    pub(super) materials: Vec<String>,
    /// Names given by `o` and `g`, and an empty name for faces before the first.
    pub(super) parts: Vec<String>,
    /// Names of the objects, which `o` gives.
    pub(super) objects: Vec<String>,
    /// For each group, the place of the object that it is in.
    pub(super) object_of: BTreeMap<u32, usize>,
    /// Arguments of each `mtllib`.
    pub(super) libraries: Vec<String>,
    colors: ObjColors,
}

/// Statements of curves, surfaces, merging groups and display, which do not affect polygons.
const WITHOUT_EFFECT: [&str; 23] = [
    "vp",
    "cstype",
    "deg",
    "bmat",
    "step",
    "parm",
    "trim",
    "hole",
    "scrv",
    "sp",
    "end",
    "con",
    "mg",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "bsp",
    "bzp",
];

/// State that applies to the faces that follow.
struct ObjState {
    material: u32,
    part: u32,
    /// Number of `o` statements so far.
    object: u32,
    smoothing: Smoothing,
    materials: BTreeMap<String, u32>,
    /// Parts by object and group.
    parts: BTreeMap<(u32, String), u32>,
    unknown: Unknown,
}

impl Statements {
    /// Reads the whole text.
    pub(super) fn read(text: &str, warnings: &mut Warnings) -> Result<Statements, ModelFault> {
        let mut statements = Statements::default();
        let mut state = ObjState {
            material: 0,
            part: 0,
            object: 0,
            smoothing: Smoothing::ByAngle,
            materials: BTreeMap::new(),
            parts: BTreeMap::new(),
            unknown: Unknown::default(),
        };
        state.material = numbered(String::new(), "", &mut state.materials, &mut statements.materials);
        state.part = numbered((0, String::new()), "", &mut state.parts, &mut statements.parts);
        for (line, content) in logical_lines(text) {
            let (keyword, rest) = split_word(&content);
            let read = match statements.statement(keyword, rest, &mut state, warnings) {
                Ok(false) => {
                    // Few programs write another case, so this is tried last.
                    let lower = keyword.to_ascii_lowercase();
                    statements.statement(&lower, rest, &mut state, warnings)
                }
                read => read,
            };
            let is_known = read.map_err(|what| ModelFault::Damaged(format!("line {line}: {what}")))?;
            if !is_known && !keyword.starts_with('#') {
                state.unknown.note(keyword, line);
            }
        }
        state.unknown.warn("The file", warnings);
        statements.check_indices(warnings)?;
        let faces = &mut statements.faces;
        faces.colors = Attribute {
            values: std::mem::take(&mut statements.colors).linear(warnings),
            // Colors belong to positions. There may be fewer colors than positions.
            corners: faces.corners.clone(),
        };
        Ok(statements)
    }

    /// Reads a statement. Returns false if its keyword is unknown.
    fn statement(
        &mut self,
        keyword: &str,
        rest: &str,
        state: &mut ObjState,
        warnings: &mut Warnings,
    ) -> Result<bool, String> {
        match keyword {
            "v" => self.vertex(rest, warnings)?,
            "vt" => {
                let ([u, v, _], count) = numbers::<3>(rest, warnings)?;
                require(count >= 1, "vt", "at least 1 number")?;
                self.faces.uvs.values.push([u as f32, (1.0 - v) as f32]);
            }
            "vn" => {
                let (normal, count) = numbers::<3>(rest, warnings)?;
                require(count == 3, "vn", "3 numbers")?;
                self.faces.normals.values.push(normal.map(|x| x as f32));
            }
            "f" | "fo" => self.face(rest, state, warnings)?,
            "usemtl" => {
                let name = named(rest);
                state.material = numbered(name.to_owned(), name, &mut state.materials, &mut self.materials);
            }
            "o" => {
                state.object += 1;
                state.part = self.parts.len() as u32;
                self.parts.push(part_name(named(rest)));
                self.objects.push(part_name(named(rest)));
            }
            "g" => {
                let name = part_name(named(rest));
                let key = (state.object, name.clone());
                state.part = numbered(key, &name, &mut state.parts, &mut self.parts);
                if let Some(object) = self.objects.len().checked_sub(1) {
                    self.object_of.insert(state.part, object);
                }
            }
            "s" => {
                let (group, _) = split_word(rest);
                state.smoothing = match group {
                    "off" | "0" => Smoothing::Off,
                    group => group.parse().map_or(Smoothing::ByAngle, Smoothing::Group),
                }
            }
            "#MRGB" | "#mrgb" => self.colors.push_mrgb(rest, warnings),
            "mtllib"
                if self
                    .libraries
                    .iter()
                    .any(|library| library == named(rest).trim_matches('"')) => {}
            "mtllib" if self.libraries.len() == MOST_LIBRARIES => {
                warnings.add(format!(
                    "The file names more than {MOST_LIBRARIES} material libraries; the others are left out."
                ));
            }
            "mtllib" => self.libraries.push(named(rest).trim_matches('"').to_string()),
            "usemap" if named(rest) == "off" => {}
            "maplib" | "usemap" => warnings.add(
                "The texture maps of `maplib` and `usemap`, an old way to show pictures, are left out; those of materials are \
                 read.",
            ),
            "l" | "p" => warnings.add("Points and lines are left out."),
            "curv" | "curv2" | "surf" => warnings.add("Curves and curved surfaces are left out."),
            "call" | "csh" => warnings.add("Other files and commands that the file calls are left out."),
            _ => return Ok(WITHOUT_EFFECT.contains(&keyword)),
        }
        Ok(true)
    }

    fn vertex(&mut self, rest: &str, warnings: &mut Warnings) -> Result<(), String> {
        let (values, count) = numbers::<7>(rest, warnings)?;
        require(count >= 3, "v", "3 numbers")?;
        let [x, y, z, r, g, b, a] = values;
        let color = match count {
            6 => Some([r, g, b, 1.0]),
            7 => Some([r, g, b, a]),
            // A fourth number is a weight, for curves.
            _ => None,
        };
        if let Some(color) = color {
            self.colors
                .push(self.faces.positions.len(), color.map(|share| share as f32));
        }
        self.faces.positions.push([x, y, z]);
        Ok(())
    }

    fn face(&mut self, rest: &str, state: &ObjState, warnings: &mut Warnings) -> Result<(), String> {
        let faces = &mut self.faces;
        let first = faces.corners.len();
        let words = rest.split_ascii_whitespace();
        for word in words.take_while(|word| !word.starts_with('#')) {
            let word = word.strip_suffix(',').unwrap_or(word);
            let mut indices = word.split('/');
            let position = match indices.next() {
                None | Some("") => return Err(format!("the corner `{word}` names no vertex")),
                Some(index) => from_zero(index, faces.positions.len())?,
            };
            let mut next = |count: usize| match indices.next() {
                // Some programs write 0 for what a corner does not have.
                None | Some("" | "0") => Ok(NONE),
                Some(index) => from_zero(index, count),
            };
            faces.uvs.corners.push(next(faces.uvs.values.len())?);
            faces.normals.corners.push(next(faces.normals.values.len())?);
            faces.corners.push(position);
        }
        let corners = first..faces.corners.len();
        if corners.len() < 3 {
            warnings.add("Faces with fewer than 3 corners are left out.");
            for list in [&mut faces.corners, &mut faces.uvs.corners, &mut faces.normals.corners] {
                list.truncate(first);
            }
            return Ok(());
        }
        faces.faces.push(Face {
            corners,
            material: state.material,
            part: state.part,
            smoothing: state.smoothing,
        });
        Ok(())
    }

    /// Checks the indices of faces. This is done at the end, since faces may come before the vertices to which they refer.
    fn check_indices(&mut self, warnings: &mut Warnings) -> Result<(), ModelFault> {
        let faces = &mut self.faces;
        let positions = faces.positions.len();
        if let Some(beyond) = faces.corners.iter().find(|position| **position as usize >= positions) {
            return damaged(format!("a face names vertex {} of {positions}", u64::from(*beyond) + 1));
        }
        let [uvs, normals] = [faces.uvs.values.len(), faces.normals.values.len()];
        for (list, count) in [(&mut faces.uvs.corners, uvs), (&mut faces.normals.corners, normals)] {
            for index in list {
                if *index != NONE && *index as usize >= count {
                    *index = NONE;
                    warnings.add("Faces name texture coordinates or normals that the file does not have.");
                }
            }
        }
        Ok(())
    }
}

/// Converts an index of the file, which counts from 1, or backward from the `count` so far.
fn from_zero(word: &str, count: usize) -> Result<u32, String> {
    // Some programs write indices as numbers with a fraction of zero.
    let whole = word
        .split_once('.')
        .filter(|(_, fraction)| fraction.bytes().all(|digit| digit == b'0'))
        .map_or(word, |(whole, _)| whole);
    let index: i64 = whole.parse().map_err(|_| format!("`{word}` is not an index"))?;
    let from_zero = match index {
        0 => return Err("an index is 0, and they count from 1".into()),
        1.. => index - 1,
        _ => count as i64 + index,
    };
    match u32::try_from(from_zero) {
        Ok(index) if index != NONE => Ok(index),
        _ => Err(format!("the index {word} reaches out of the file")),
    }
}

/// Reads up to `N` numbers and returns how many there were. Further numbers are ignored.
fn numbers<const N: usize>(rest: &str, warnings: &mut Warnings) -> Result<([f64; N], usize), String> {
    let mut values = [0.0; N];
    let mut count = 0;
    for (value, word) in values.iter_mut().zip(rest.split_ascii_whitespace()) {
        if word.starts_with('#') {
            break;
        }
        *value = number(word, warnings).ok_or_else(|| format!("`{word}` is not a number"))?;
        count += 1;
    }
    Ok((values, count))
}

fn require(holds: bool, keyword: &str, what: &str) -> Result<(), String> {
    if holds {
        Ok(())
    } else {
        Err(format!("`{keyword}` needs {what}"))
    }
}

/// Returns the number of a key. A new key gets a new number and a name.
fn numbered<K: Ord>(key: K, name: &str, known: &mut BTreeMap<K, u32>, names: &mut Vec<String>) -> u32 {
    *known.entry(key).or_insert_with(|| {
        names.push(name.to_string());
        names.len() as u32 - 1
    })
}

/// The first word of a line and the rest.
pub(super) fn split_word(line: &str) -> (&str, &str) {
    // A line of one word has no rest.
    let (word, rest) = line.split_once(|c: char| c.is_ascii_whitespace()).unwrap_or((line, ""));
    (word, rest.trim_ascii())
}

/// Returns the name in the rest of a line, without a comment after it. A `#` inside a name is followed by another
/// character: `Material #25`.
pub(super) fn named(rest: &str) -> &str {
    let bytes = rest.as_bytes();
    let is_remark = |at: &usize| {
        let before = at
            .checked_sub(1)
            .is_none_or(|before| bytes[before].is_ascii_whitespace());
        before && bytes.get(at + 1).is_none_or(u8::is_ascii_whitespace)
    };
    let remark = rest.match_indices('#').map(|(at, _)| at).find(is_remark);
    rest[..remark.unwrap_or(rest.len())].trim_ascii_end()
}

/// Start of a comment that contains vertex colors.
const MRGB: &str = "#MRGB";

/// Returns lines with their numbers, trimmed, without empty lines and comments. A line that ends in a backslash continues
/// in the next one, unless it is in a comment.
pub(super) fn logical_lines(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut lines = lines(text).zip(1..);
    std::iter::from_fn(move || {
        loop {
            let (line, number) = lines.next()?;
            let line = line.trim_ascii();
            let is_colors = || {
                line.get(..MRGB.len())
                    .is_some_and(|start| start.eq_ignore_ascii_case(MRGB))
            };
            if line.is_empty() || line.starts_with('#') && !is_colors() {
                continue;
            }
            let mut whole = Cow::Borrowed(line);
            let mut last = line;
            while last.ends_with('\\') && !has_remark(last) {
                last = lines.next().map_or("", |(next, _)| next.trim_ascii());
                let whole = whole.to_mut();
                whole.pop();
                whole.push(' ');
                whole.push_str(last);
            }
            return Some((number, whole));
        }
    })
}

/// Returns true if a line contains a comment, at its start or after a space.
fn has_remark(line: &str) -> bool {
    let mut words = line.split(|c: char| c.is_ascii_whitespace());
    words.any(|word| word.starts_with('#'))
}
