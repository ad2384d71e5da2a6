//! The lines of an OBJ file.

use std::borrow::Cow;
use std::collections::BTreeMap;

use sabi_color::linear_from_srgb;

use crate::load::error::{Fault, damaged};
use crate::load::faces::{Face, Faces, NONE};
use crate::load::submesh::Smoothing;
use crate::load::warnings::Warnings;

/// Most material libraries that are read.
pub(super) const MOST_LIBRARIES: usize = 1000;

/// Content of the file, with checked indices.
#[derive(Default)]
pub(super) struct Statements {
    pub(super) faces: Faces,
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
        // Colors belong to positions, and may end before those do.
        statements.faces.colors.corners = statements.faces.corners.clone();
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
                self.faces.uvs.values.push([u, 1.0 - v]);
            }
            "vn" => {
                let (normal, count) = numbers::<3>(rest)?;
                require(count == 3, "vn", "3 numbers")?;
                self.faces.normals.values.push(normal);
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
        let faces = &mut self.faces;
        if count == 6 {
            let linear = |x: f32| linear_from_srgb(x.clamp(0.0, 1.0));
            let [r, g, b] = [values[3], values[4], values[5]].map(linear);
            faces.colors.values.resize(faces.positions.len(), [1.0; 4]);
            faces.colors.values.push([r, g, b, 1.0]);
        }
        faces.positions.push([values[0], values[1], values[2]]);
        Ok(())
    }

    fn face(&mut self, rest: &str, state: &State, warnings: &mut Warnings) -> Result<(), String> {
        let faces = &mut self.faces;
        let first = faces.corners.len();
        for word in rest.split_ascii_whitespace() {
            let mut indices = word.split('/');
            let mut next = |count: usize| match indices.next() {
                None | Some("") => Ok(NONE),
                Some(index) => from_zero(index, count),
            };
            let position = next(faces.positions.len())?;
            if position == NONE {
                return Err(format!("the corner `{word}` names no vertex"));
            }
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

    /// Checks the indices of faces, at the end, since faces may precede the vertices that they name.
    fn check_indices(&mut self, warnings: &mut Warnings) -> Result<(), Fault> {
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
