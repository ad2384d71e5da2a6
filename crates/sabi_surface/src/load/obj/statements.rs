//! The lines of an OBJ file.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

use crate::load::error::{Fault, damaged};
use crate::load::submesh::Smoothing;
use crate::load::warnings::Warnings;

/// Marks an index that a corner does not have.
pub(super) const NONE: u32 = u32::MAX;

/// Most material libraries that are read.
const MOST_LIBRARIES: usize = 1000;

/// One corner of a face, as indices from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Corner {
    pub(super) position: u32,
    pub(super) uv: u32,
    pub(super) normal: u32,
}

/// A face of three or more corners.
pub(super) struct Face {
    /// Its place in [`Statements::corners`].
    pub(super) corners: Range<usize>,
    pub(super) material: u32,
    pub(super) part: u32,
    pub(super) smoothing: Smoothing,
}

/// Content of the file, with checked indices.
#[derive(Default)]
pub(super) struct Statements {
    pub(super) positions: Vec<[f32; 3]>,
    /// Linear; shorter than the positions where the last ones have none.
    pub(super) colors: Vec<[f32; 4]>,
    /// v grows downward.
    pub(super) uvs: Vec<[f32; 2]>,
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) corners: Vec<Corner>,
    pub(super) faces: Vec<Face>,
    /// Names that `usemtl` gives, and the empty one for faces before any.
    pub(super) materials: Vec<String>,
    /// Names that `o` and `g` give, and the empty one for faces before any.
    pub(super) parts: Vec<String>,
    /// Arguments of each `mtllib`.
    pub(super) libraries: Vec<String>,
}

/// State that applies to the faces that follow.
struct State {
    material: u32,
    part: u32,
    smoothing: Smoothing,
    materials: BTreeMap<String, u32>,
    parts: BTreeMap<String, u32>,
}

impl Statements {
    /// Reads the whole text.
    pub(super) fn read(text: &str, warnings: &mut Warnings) -> Result<Statements, Fault> {
        let mut statements = Statements::default();
        let mut state = State {
            material: 0,
            part: 0,
            smoothing: Smoothing::ByAngle,
            materials: BTreeMap::new(),
            parts: BTreeMap::new(),
        };
        state.material = numbered("", &mut state.materials, &mut statements.materials);
        state.part = numbered("", &mut state.parts, &mut statements.parts);
        for (line, content) in logical_lines(text) {
            let (keyword, rest) = split_word(&content);
            let read = statements.statement(keyword, rest, &mut state, warnings);
            read.map_err(|what| Fault::Damaged(format!("line {line}: {what}")))?;
        }
        statements.check_indices(warnings)?;
        Ok(statements)
    }

    fn statement(
        &mut self,
        keyword: &str,
        rest: &str,
        state: &mut State,
        warnings: &mut Warnings,
    ) -> Result<(), String> {
        match keyword {
            "v" => self.vertex(rest)?,
            "vt" => {
                let ([u, v, _], count) = numbers::<3>(rest)?;
                require(count >= 1, "vt", "at least 1 number")?;
                self.uvs.push([u, 1.0 - v]);
            }
            "vn" => {
                let (normal, count) = numbers::<3>(rest)?;
                require(count == 3, "vn", "3 numbers")?;
                self.normals.push(normal);
            }
            "f" | "fo" => self.face(rest, state, warnings)?,
            "usemtl" => state.material = numbered(rest, &mut state.materials, &mut self.materials),
            "o" | "g" => state.part = numbered(rest, &mut state.parts, &mut self.parts),
            "s" => {
                state.smoothing = match rest {
                    "off" | "0" => Smoothing::Off,
                    group => group.parse().map_or(Smoothing::ByAngle, Smoothing::Group),
                }
            }
            "mtllib" if self.libraries.iter().any(|library| library == rest) => {}
            "mtllib" if self.libraries.len() == MOST_LIBRARIES => {
                warnings.add(format!(
                    "The file names more than {MOST_LIBRARIES} material libraries; the others are left out."
                ));
            }
            "mtllib" => self.libraries.push(rest.to_string()),
            "l" | "p" => warnings.add("Points and lines are left out."),
            "curv" | "curv2" | "surf" => warnings.add("Curves and curved surfaces are left out."),
            _ => {}
        }
        Ok(())
    }

    fn vertex(&mut self, rest: &str) -> Result<(), String> {
        let (values, count) = numbers::<7>(rest)?;
        require(count >= 3, "v", "3 numbers")?;
        if count == 6 {
            let linear = |x: f32| {
                let x = x.clamp(0.0, 1.0);
                if x <= 0.04045 {
                    x / 12.92
                } else {
                    ((x + 0.055) / 1.055).powf(2.4)
                }
            };
            self.colors.resize(self.positions.len(), [1.0; 4]);
            self.colors
                .push([linear(values[3]), linear(values[4]), linear(values[5]), 1.0]);
        }
        self.positions.push([values[0], values[1], values[2]]);
        Ok(())
    }

    fn face(&mut self, rest: &str, state: &State, warnings: &mut Warnings) -> Result<(), String> {
        let first = self.corners.len();
        for word in rest.split_ascii_whitespace() {
            let mut indices = word.split('/');
            let mut next = |count: usize| match indices.next() {
                None | Some("") => Ok(NONE),
                Some(index) => from_zero(index, count),
            };
            let corner = Corner {
                position: next(self.positions.len())?,
                uv: next(self.uvs.len())?,
                normal: next(self.normals.len())?,
            };
            if corner.position == NONE {
                return Err(format!("the corner `{word}` names no vertex"));
            }
            self.corners.push(corner);
        }
        let corners = first..self.corners.len();
        if corners.len() < 3 {
            warnings.add("Faces with fewer than 3 corners are left out.");
            self.corners.truncate(first);
            return Ok(());
        }
        let State {
            material,
            part,
            smoothing,
            ..
        } = *state;
        self.faces.push(Face {
            corners,
            material,
            part,
            smoothing,
        });
        Ok(())
    }

    /// Checks the indices of faces, at the end, since faces may precede the vertices that they name.
    fn check_indices(&mut self, warnings: &mut Warnings) -> Result<(), Fault> {
        let (positions, uvs, normals) = (self.positions.len(), self.uvs.len(), self.normals.len());
        for corner in &mut self.corners {
            if corner.position as usize >= positions {
                return damaged(format!(
                    "a face names vertex {} of {positions}",
                    u64::from(corner.position) + 1
                ));
            }
            for (index, count) in [(&mut corner.uv, uvs), (&mut corner.normal, normals)] {
                if *index != NONE && *index as usize >= count {
                    *index = NONE;
                    warnings.add("Faces name texture coordinates or normals that the file does not have.");
                }
            }
        }
        Ok(())
    }
}

/// An index as files have it: from 1, or backward from the `count` so far.
fn from_zero(word: &str, count: usize) -> Result<u32, String> {
    let index: i64 = word.parse().map_err(|_| format!("`{word}` is not an index"))?;
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

/// Up to `N` numbers and how many there were; more are ignored.
fn numbers<const N: usize>(rest: &str) -> Result<([f32; N], usize), String> {
    let mut values = [0.0; N];
    let mut count = 0;
    for (value, word) in values.iter_mut().zip(rest.split_ascii_whitespace()) {
        if word.starts_with('#') {
            break;
        }
        *value = match word.parse() {
            Ok(value) => value,
            // Some programs write NaN as 1.#IND or -1.#QNAN.
            Err(_) if word.contains(".#") => f32::NAN,
            Err(_) => return Err(format!("`{word}` is not a number")),
        };
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

/// The number of a name, a new one for a new name.
fn numbered(name: &str, known: &mut BTreeMap<String, u32>, names: &mut Vec<String>) -> u32 {
    if let Some(number) = known.get(name) {
        return *number;
    }
    let number = names.len() as u32;
    names.push(name.to_string());
    known.insert(name.to_string(), number);
    number
}

/// Text in UTF-8, or in UTF-16 where it says so, or else in Latin-1, which old programs write: names stay distinct.
pub(super) fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    let wide = |from: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes[2..].as_chunks().0.iter().map(|unit| from(*unit)).collect();
        Cow::Owned(String::from_utf16_lossy(&units))
    };
    match bytes {
        [0xff, 0xfe, ..] => wide(u16::from_le_bytes),
        [0xfe, 0xff, ..] => wide(u16::from_be_bytes),
        [0xef, 0xbb, 0xbf, text @ ..] => String::from_utf8_lossy(text),
        _ => match std::str::from_utf8(bytes) {
            Ok(text) => Cow::Borrowed(text),
            Err(_) => Cow::Owned(bytes.iter().map(|byte| char::from(*byte)).collect()),
        },
    }
}

/// The first word of a line and the rest.
pub(super) fn split_word(line: &str) -> (&str, &str) {
    // A line of one word has no rest.
    let (word, rest) = line.split_once(|c: char| c.is_ascii_whitespace()).unwrap_or((line, ""));
    (word, rest.trim_ascii())
}

/// Lines with their numbers, trimmed, without empty lines and comments; lines that end in a backslash go on in the next.
pub(super) fn logical_lines(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    // Trimming takes care of line ends of two characters.
    let line_end = if text.contains('\n') { '\n' } else { '\r' };
    let mut lines = text.split(line_end).zip(1..);
    std::iter::from_fn(move || {
        loop {
            let (line, number) = lines.next()?;
            let mut line = Cow::Borrowed(line.trim_ascii());
            while line.ends_with('\\') {
                let next = lines.next().map_or("", |(next, _)| next.trim_ascii());
                let whole = line.to_mut();
                whole.pop();
                whole.push(' ');
                whole.push_str(next);
            }
            if !line.is_empty() && !line.starts_with('#') {
                return Some((number, line));
            }
        }
    })
}
