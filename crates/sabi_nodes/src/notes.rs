//! Reads annotations in doc comments (`@range 0 1`), and the header.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::fault::{Fault, Text};
use crate::scan::{DocLine, Scan};
use crate::words::{list, nearest};

/// A word of an annotation and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Word {
    pub(crate) text: String,
    pub(crate) range: Range<usize>,
}

/// An annotation with its words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Note {
    /// Without the `@`.
    pub(crate) name: String,
    /// Place of `@name`.
    pub(crate) range: Range<usize>,
    pub(crate) words: Vec<Word>,
}

impl Note {
    /// The words as text.
    pub(crate) fn joined(&self) -> String {
        let words: Vec<&str> = self.words.iter().map(|word| word.text.as_str()).collect();
        words.join(" ")
    }

    /// Place of the annotation with its words.
    pub(crate) fn whole(&self) -> Range<usize> {
        match self.words.last() {
            // On the annotation's own line only: a marked range ends with the line.
            Some(last) => self.range.start..last.range.end,
            None => self.range.clone(),
        }
    }
}

/// Annotations whose words may continue on the next line.
const RUN_ON: [&str; 2] = ["input", "choice"];

/// A parsed doc comment.
#[derive(Clone, Debug, Default)]
pub(crate) struct Notes {
    /// Text without annotations, line by line.
    pub(crate) lines: Vec<String>,
    pub(crate) notes: Vec<Note>,
}

impl Notes {
    /// Parses a doc comment.
    pub(crate) fn read(docs: &[DocLine]) -> Notes {
        let mut read = Notes::default();
        let mut runs_on = false;
        for line in docs {
            let mut prose_end = None;
            let mut open = runs_on && !line.text.trim().is_empty();
            if open {
                prose_end = Some(0);
            }
            for word in words(line) {
                match word.text.strip_prefix('@') {
                    Some(name) => {
                        prose_end = prose_end.or(Some(word.range.start - line.start));
                        read.notes.push(Note {
                            name: name.to_owned(),
                            range: word.range,
                            words: Vec::new(),
                        });
                        open = true;
                    }
                    None if open => {
                        if let Some(note) = read.notes.last_mut() {
                            note.words.push(word);
                        }
                    }
                    None => {}
                }
            }
            runs_on = open
                && read
                    .notes
                    .last()
                    .is_some_and(|note| RUN_ON.contains(&note.name.as_str()));
            let prose = line
                .text
                .get(..prose_end.unwrap_or(line.text.len()))
                .unwrap_or_default();
            if prose_end.is_none() || !prose.trim().is_empty() {
                read.lines.push(prose.trim_end().to_owned());
            }
        }
        read
    }

    /// The prose as paragraphs: lines joined, empty lines between paragraphs kept.
    pub(crate) fn prose(&self) -> String {
        let mut text = String::new();
        for line in &self.lines {
            let line = line.trim();
            if line.is_empty() {
                if !text.is_empty() && !text.ends_with('\n') {
                    text.push_str("\n\n");
                }
            } else {
                if !text.is_empty() && !text.ends_with('\n') {
                    text.push(' ');
                }
                text.push_str(line);
            }
        }
        text.trim_end().to_owned()
    }

    /// Refuses annotations that are not in `known`, and repeated ones that are in `once`.
    pub(crate) fn check(&self, text: Text<'_>, known: &[&str], once: &[&str], faults: &mut Vec<Fault>) {
        let mut seen = BTreeSet::new();
        for note in &self.notes {
            let name = note.name.as_str();
            if !known.contains(&name) {
                faults.push(unknown(text, note, known));
            } else if !seen.insert(name) && once.contains(&name) {
                faults.push(text.fault(
                    note.whole(),
                    format!("`@{name}` stands here twice."),
                    "Keep one of them.",
                ));
            }
        }
    }

    /// The first annotation of that name.
    pub(crate) fn get(&self, name: &str) -> Option<&Note> {
        self.notes.iter().find(|note| note.name == name)
    }

    /// All annotations of that name.
    pub(crate) fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Note> {
        self.notes.iter().filter(move |note| note.name == name)
    }
}

/// Fault of an annotation that is not known in its place.
pub(crate) fn unknown(text: Text<'_>, note: &Note, known: &[&str]) -> Fault {
    let everywhere = HEADER
        .iter()
        .chain(crate::params::ANNOTATIONS)
        .chain(crate::ports::ANNOTATIONS)
        .copied();
    let name = note.name.as_str();
    let exists = everywhere.clone().any(|other| other == name);
    let message = if exists {
        format!("`@{name}` does not belong here.")
    } else {
        format!("`@{name}` is not an annotation.")
    };
    let mut sorted: Vec<String> = known.iter().map(|name| format!("@{name}")).collect();
    sorted.sort();
    let known_here = format!("Known here: {}.", list(sorted.iter().map(String::as_str)));
    let advice = match nearest(name, known.iter().copied()) {
        Some(meant) if !exists => format!("Did you mean `@{meant}`? {known_here}"),
        _ => known_here,
    };
    text.fault(note.range.clone(), message, advice)
}

/// Words of a line with their places.
fn words(line: &DocLine) -> Vec<Word> {
    let mut words = Vec::new();
    let mut rest = line.text.as_str();
    let mut at = line.start;
    loop {
        let trimmed = rest.trim_start();
        at += rest.len() - trimmed.len();
        if trimmed.is_empty() {
            return words;
        }
        let length = trimmed.find(char::is_whitespace).unwrap_or(trimmed.len());
        words.push(Word {
            text: trimmed[..length].to_owned(),
            range: at..at + length,
        });
        rest = &trimmed[length..];
        at += length;
    }
}

/// Annotations of the header.
pub(crate) const HEADER: &[&str] = &["alias", "use", "version", "was"];

/// Content of the `//!` lines.
#[derive(Clone, Debug, Default)]
pub(crate) struct Header {
    pub(crate) label: String,
    pub(crate) summary: String,
    pub(crate) description: String,
    pub(crate) aliases: Vec<String>,
    /// Libraries named by `@use`.
    pub(crate) uses: Vec<Word>,
    pub(crate) formerly: Vec<String>,
    pub(crate) version: u32,
}

/// Reads the header, which must have a label and a summary.
pub(crate) fn read_header(text: Text<'_>, scan: &Scan, faults: &mut Vec<Fault>) -> Header {
    let notes = Notes::read(&scan.header);
    notes.check(text, HEADER, &["version"], faults);
    let mut lines = notes.lines.iter().map(|line| line.trim_end());
    let label = lines
        .find(|line| !line.is_empty())
        .unwrap_or_default()
        .trim()
        .to_owned();
    let summary = lines
        .find(|line| !line.is_empty())
        .unwrap_or_default()
        .trim()
        .to_owned();
    let description = lines.collect::<Vec<_>>().join("\n").trim().to_owned();
    if label.is_empty() || summary.is_empty() {
        let missing = if label.is_empty() { "name" } else { "summary" };
        let range = scan
            .header
            .first()
            .map_or(0..0, |line| line.start..line.start + line.text.len());
        faults.push(text.fault(
            range,
            format!("The header gives no {missing} for the node."),
            "Start the file with `//! Name` and, in the next line, `//! One sentence that says what it does.`",
        ));
    }
    for name in ["alias", "use", "was"] {
        for note in notes.all(name).filter(|note| note.words.is_empty()) {
            faults.push(text.fault(
                note.range.clone(),
                format!("`@{name}` names nothing."),
                "Write the names behind it.",
            ));
        }
    }
    let gather = |name: &'static str| {
        let words = notes.all(name).flat_map(|note| note.words.iter());
        words.map(|word| word.text.trim_end_matches(',').to_owned()).collect()
    };
    Header {
        label,
        summary,
        description,
        aliases: gather("alias"),
        uses: notes.all("use").flat_map(|note| note.words.clone()).collect(),
        formerly: gather("was"),
        version: version(text, &notes, faults),
    }
}

/// Reads `@version N`; 1 without it.
fn version(text: Text<'_>, notes: &Notes, faults: &mut Vec<Fault>) -> u32 {
    let Some(note) = notes.get("version") else {
        return 1;
    };
    match note.joined().parse::<u32>() {
        Ok(number) if number > 0 => number,
        _ => {
            faults.push(text.fault(
                note.whole(),
                "`@version` takes one whole number from 1 on.",
                "Write `@version 2` when the algorithm gives other results than before.",
            ));
            1
        }
    }
}

/// Returns the label of a name: `tile_size` becomes `Tile size`.
pub fn label_of(name: &str) -> String {
    let spaced = name.replace('_', " ");
    let mut letters = spaced.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => spaced,
    }
}

/// Returns true if a name can be a port or a parameter: `[a-z][a-z0-9_]*`.
pub(crate) fn is_plain_name(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase())
        && name
            .chars()
            .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
}

/// A finite number.
pub(crate) fn number(word: &Word) -> Option<f32> {
    word.text.parse::<f32>().ok().filter(|number| number.is_finite())
}
