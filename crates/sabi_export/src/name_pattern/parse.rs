//! Reading of name patterns.

use super::{Segment, Token};
use crate::names::file_stem;

/// Reads a pattern with tokens that differ from file to file, and words that do not; the error is a clause that says what is wrong.
pub(super) fn segments(
    text: &str,
    tokens: &[(&str, Token)],
    words: &[(&str, Option<&str>)],
) -> Result<Vec<Segment>, String> {
    let mut reader = PatternReader {
        rest: text,
        tokens,
        words,
    };
    let segments = reader.segments(0)?;
    match reader.rest {
        "" => Ok(segments),
        _ => Err("a group is closed that was not opened; write $( and $) for plain parentheses".to_owned()),
    }
}

/// Most groups in each other.
const MOST_GROUPS: usize = 16;

struct PatternReader<'t, 'w> {
    rest: &'t str,
    tokens: &'w [(&'w str, Token)],
    words: &'w [(&'w str, Option<&'w str>)],
}

impl<'t> PatternReader<'t, '_> {
    /// Reads to the end, or to the end of the group, which is in so many others and itself; 0 outside of groups.
    fn segments(&mut self, depth: usize) -> Result<Vec<Segment>, String> {
        if depth > MOST_GROUPS {
            return Err(format!("groups are in each other more than {MOST_GROUPS} deep"));
        }
        let mut segments = Vec::new();
        loop {
            let end = self.rest.find(['$', '{', '(', ')']);
            // Without any, the rest is text.
            let (text, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
            push_text(&mut segments, text);
            self.rest = rest;
            match rest.chars().next() {
                None if depth > 0 => return Err("a group is opened and not closed; close it with )".to_owned()),
                None | Some(')') => return Ok(segments),
                Some('(') => {
                    self.rest = &rest[1..];
                    let group = self.segments(depth + 1)?;
                    if !self.rest.starts_with(')') {
                        return Err("a group is opened and not closed; close it with )".to_owned());
                    }
                    self.rest = &self.rest[1..];
                    segments.push(Segment::Optional(group));
                }
                Some('{') => {
                    let (word, after) = rest[1..]
                        .split_once('}')
                        .ok_or("a brace is opened and not closed; close it after the word")?;
                    let found = self.token(word).filter(|(_, length)| *length == word.len());
                    let (segment, _) = found.ok_or_else(|| self.unknown(word))?;
                    segments.push(segment);
                    self.rest = after;
                }
                Some(_) => self.dollar(&mut segments, &rest[1..])?,
            }
        }
    }

    /// Reads a token after its `$`, or one of the letters `$`, `(` and `)`, which stand for themselves there.
    fn dollar(&mut self, segments: &mut Vec<Segment>, after: &'t str) -> Result<(), String> {
        if let Some(letter) = after.chars().next().filter(|letter| ['$', '(', ')'].contains(letter)) {
            push_text(segments, &letter.to_string());
            self.rest = &after[1..];
            return Ok(());
        }
        let Some((segment, length)) = self.token(after) else {
            let end = after.find(|letter: char| !letter.is_ascii_alphanumeric());
            // Without any other letter, the word goes to the end.
            return Err(self.unknown(&after[..end.unwrap_or(after.len())]));
        };
        segments.push(segment);
        self.rest = &after[length..];
        Ok(())
    }

    /// The longest token at the beginning of a text, with its length: `$material_` is `$material` and a line.
    fn token(&self, text: &str) -> Option<(Segment, usize)> {
        let fixed = self.tokens.iter().map(|(word, token)| (*word, Segment::Token(*token)));
        let words = self.words.iter().map(|(word, stands_for)| {
            let text = stands_for.map(file_stem).filter(|text| !text.is_empty());
            (*word, text.map_or(Segment::Nothing, Segment::Text))
        });
        let found = fixed.chain(words).filter(|(word, _)| text.starts_with(word));
        let longest = found.max_by_key(|(word, _)| word.len())?;
        Some((longest.1, longest.0.len()))
    }

    fn unknown(&self, word: &str) -> String {
        let mut known: Vec<String> = self.tokens.iter().map(|(word, _)| format!("${word}")).collect();
        known.extend(self.words.iter().map(|(word, _)| format!("${word}")));
        format!("nobody knows ${word}; there is: {}", known.join(", "))
    }
}

fn push_text(segments: &mut Vec<Segment>, text: &str) {
    if !text.is_empty() {
        segments.push(Segment::Text(text.to_owned()));
    }
}
