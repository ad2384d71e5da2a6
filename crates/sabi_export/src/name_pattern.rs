//! Names of the files of a texture set.

mod folder;
mod parse;
#[cfg(test)]
mod tests;

pub use folder::folder_name;

use crate::ExportError;
use crate::names::file_stem;

/// Pattern of file names without extensions: text with tokens such as `$material` or `{material}`, and groups in
/// parentheses that are omitted if a token in them has no value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamePattern {
    segments: Vec<Segment>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Segment {
    Text(String),
    Token(Token),
    /// A token for the whole bake that has no value.
    Nothing,
    /// Omitted if a token in it has no value.
    Optional(Vec<Segment>),
}

/// Token whose value differs from file to file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Token {
    Material,
    Map,
    Udim,
    Size,
}

/// Tokens as written; `channel` is another word for `map`.
const TOKENS: [(&str, Token); 5] = [
    ("material", Token::Material),
    ("map", Token::Map),
    ("channel", Token::Map),
    ("udim", Token::Udim),
    ("size", Token::Size),
];

/// Values of the tokens in the name of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NameParts<'a> {
    /// Stem of the set: the material.
    pub material: &'a str,
    /// Name of the map.
    pub map: &'a str,
    /// UDIM number of the set, when its material uses several tiles.
    pub udim: Option<u32>,
    /// Pixels across and down.
    pub size: [u32; 2],
}

impl Default for NamePattern {
    fn default() -> Self {
        let token = Segment::Token;
        NamePattern {
            segments: vec![
                token(Token::Material),
                Segment::Text("_".to_owned()),
                token(Token::Map),
                Segment::Optional(vec![Segment::Text(".".to_owned()), token(Token::Udim)]),
            ],
        }
    }
}

impl NamePattern {
    /// Default pattern.
    pub const DEFAULT: &str = "$material_$map(.$udim)";
    /// Tokens for the whole bake that presets may use.
    pub const WORDS: [&str; 6] = ["project", "graph", "mesh", "variant", "seed", "preset"];

    /// Parses a pattern. `words` are further tokens with their values for the whole bake, which are converted to file
    /// names. A token may have no value. A pattern without `$udim` gets `(.$udim)` at its end.
    ///
    /// # Errors
    /// It has no `$map`, an unknown token, an open group, or letters that no file name may have.
    pub fn parse(text: &str, words: &[(&str, Option<&str>)]) -> Result<NamePattern, ExportError> {
        let fault = |why: String| ExportError::Names {
            pattern: text.to_owned(),
            why,
        };
        let mut segments = parse::segments(text, &TOKENS, words).map_err(fault)?;
        if !has(&segments, Token::Map) {
            let why = "without $map all maps would be one file; write it where the map's name is to stand";
            return Err(fault(why.to_owned()));
        }
        if !has(&segments, Token::Udim) {
            let tile = vec![Segment::Text(".".to_owned()), Segment::Token(Token::Udim)];
            segments.push(Segment::Optional(tile));
        }
        let pattern = NamePattern { segments };
        let sample = pattern.name(&NameParts {
            material: "material",
            map: "base_color",
            udim: None,
            size: [1024; 2],
        });
        if file_stem(&sample) != sample {
            let why =
                "it has letters that a file name cannot have, or too many; use plain letters, digits, '_' and '-'";
            return Err(fault(why.to_owned()));
        }
        Ok(pattern)
    }

    /// The name of a file without its ending.
    pub fn name(&self, parts: &NameParts<'_>) -> String {
        let udim = parts.udim.map(|number| number.to_string());
        self.name_with(parts, udim.as_deref())
    }

    /// Returns the name with a text such as `<UDIM>` in place of the tile number.
    pub(crate) fn name_of_tiles(&self, parts: &NameParts<'_>, udim: &str) -> String {
        self.name_with(parts, Some(udim))
    }

    fn name_with(&self, parts: &NameParts<'_>, udim: Option<&str>) -> String {
        let mut name = String::new();
        for segment in &self.segments {
            // Outside of groups, a token without a value is empty.
            push(&mut name, segment, parts, udim).unwrap_or_default();
        }
        name
    }

    /// Returns true if this pattern can give a map with this name the file name `stem`, without extension, for some
    /// material, tile and size.
    pub fn may_give(&self, stem: &str, map: &str) -> bool {
        may_give(&self.segments, vec![stem], map).contains(&"")
    }
}

/// Appends a segment; `None` if a token has no value.
fn push(name: &mut String, segment: &Segment, parts: &NameParts<'_>, udim: Option<&str>) -> Option<()> {
    match segment {
        Segment::Text(text) => name.push_str(text),
        Segment::Token(Token::Material) => name.push_str(parts.material),
        Segment::Token(Token::Map) => name.push_str(parts.map),
        Segment::Token(Token::Udim) => name.push_str(udim?),
        Segment::Token(Token::Size) => match parts.size {
            [width, height] if width == height => name.push_str(&width.to_string()),
            [width, height] => name.push_str(&format!("{width}x{height}")),
        },
        Segment::Nothing => return None,
        Segment::Optional(group) => {
            let before = name.len();
            if group.iter().any(|segment| push(name, segment, parts, udim).is_none()) {
                name.truncate(before);
            }
        }
    }
    Some(())
}

fn has(segments: &[Segment], token: Token) -> bool {
    segments.iter().any(|segment| match segment {
        Segment::Token(found) => *found == token,
        Segment::Optional(group) => has(group, token),
        Segment::Text(_) | Segment::Nothing => false,
    })
}

/// Returns the possible remainders of a text after the segments were matched at its start.
fn may_give<'t>(segments: &[Segment], mut rests: Vec<&'t str>, map: &str) -> Vec<&'t str> {
    for segment in segments {
        let mut next: Vec<&str> = match segment {
            Segment::Optional(group) => {
                let taken = may_give(group, rests.clone(), map);
                rests.into_iter().chain(taken).collect()
            }
            single => rests.iter().flat_map(|rest| after(single, rest, map)).collect(),
        };
        next.sort_unstable_by_key(|rest| rest.len());
        next.dedup();
        rests = next;
    }
    rests
}

/// Returns what may be left of a text once a segment that is no group was taken off its beginning.
fn after<'t>(segment: &Segment, text: &'t str, map: &str) -> Vec<&'t str> {
    let cut = |end: usize| text.get(end..);
    match segment {
        Segment::Text(fixed) => text.strip_prefix(fixed.as_str()).into_iter().collect(),
        Segment::Token(Token::Map) => text.strip_prefix(map).into_iter().collect(),
        Segment::Token(Token::Material) => (1..=text.len()).filter_map(cut).collect(),
        Segment::Token(Token::Udim) => {
            let is_number = text.len() >= 4 && text.bytes().take(4).all(|byte| byte.is_ascii_digit());
            cut(4).filter(|_| is_number).into_iter().collect()
        }
        Segment::Token(Token::Size) => {
            let end = text.find(|letter: char| !letter.is_ascii_digit() && letter != 'x');
            // Digits to the end.
            let end = end.unwrap_or(text.len());
            cut(end).filter(|_| end > 0).into_iter().collect()
        }
        Segment::Nothing | Segment::Optional(_) => vec![text],
    }
}
