//! Reads annotations in doc comments, such as `@range 0 1`.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::fault::{FAULTS_SHOWN, Fault, Text};
use crate::scan::DocLine;
use crate::words::{list, nearest};

/// A word of an annotation and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct AnnotationWord {
    pub(crate) text: String,
    pub(crate) range: Range<usize>,
}

/// An annotation with the words after it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Annotation {
    /// Name without the `@`.
    pub(crate) name: String,
    /// Place of `@name`.
    pub(crate) range: Range<usize>,
    pub(crate) words: Vec<AnnotationWord>,
}

impl Annotation {
    /// The words as text.
    pub(crate) fn joined(&self) -> String {
        let words: Vec<&str> = self.words.iter().map(|word| word.text.as_str()).collect();
        words.join(" ")
    }

    /// Returns the place of the annotation including its words.
    pub(crate) fn whole(&self) -> Range<usize> {
        match self.words.last() {
            // Only the words on the annotation's own line: a marked range ends with the line.
            Some(last) => self.range.start..last.range.end,
            None => self.range.clone(),
        }
    }
}

/// Annotations of the header.
pub(crate) const HEADER_ANNOTATIONS: &[&str] = &["alias", "use", "version", "was"];

/// Annotations of a parameter.
pub(crate) const PARAM_ANNOTATIONS: &[&str] = &[
    "range", "soft", "default", "choice", "toggle", "color", "length", "absolute", "angle", "seed", "extent", "curve",
    "label", "was",
];

/// Annotations of a function and of the inputs described in its comment.
pub(crate) const FUNCTION_ANNOTATIONS: &[&str] = &[
    "input", "shared", "pass", "with", "repeat", "texel", "points", "denoise", "surveys", "rays", "finds", "reach",
    "turn", "vector", "optional", "default", "type", "label", "starts",
];

/// Annotations whose words may continue on the next line.
const RUN_ON: [&str; 2] = ["input", "choice"];

/// A parsed doc comment.
#[derive(Clone, Debug, Default)]
pub(crate) struct DocComment {
    /// Text without annotations, line by line.
    pub(crate) lines: Vec<String>,
    pub(crate) annotations: Vec<Annotation>,
}

impl DocComment {
    /// Parses a doc comment.
    pub(crate) fn read(docs: &[DocLine]) -> DocComment {
        let mut read = DocComment::default();
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
                        read.annotations.push(Annotation {
                            name: name.to_owned(),
                            range: word.range,
                            words: Vec::new(),
                        });
                        open = true;
                    }
                    None if open => {
                        if let Some(annotation) = read.annotations.last_mut() {
                            annotation.words.push(word);
                        }
                    }
                    None => {}
                }
            }
            runs_on = open
                && read
                    .annotations
                    .last()
                    .is_some_and(|annotation| RUN_ON.contains(&annotation.name.as_str()));
            let prose = &line.text[..prose_end.unwrap_or(line.text.len())];
            if prose_end.is_none() || !prose.trim().is_empty() {
                read.lines.push(prose.trim_end().to_owned());
            }
        }
        read
    }

    /// Returns the prose as paragraphs: lines are joined, and empty lines between paragraphs are kept.
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

    /// Refuses annotations that are not in `known`, and annotations in `once` that are repeated.
    pub(crate) fn check(&self, text: Text<'_>, known: &[&str], once: &[&str], faults: &mut Vec<Fault>) {
        let mut seen = BTreeSet::new();
        for annotation in &self.annotations {
            let name = annotation.name.as_str();
            if faults.len() >= FAULTS_SHOWN {
                break;
            }
            if !known.contains(&name) {
                faults.push(unknown_annotation(text, annotation, known));
            } else if !seen.insert(name) && once.contains(&name) {
                faults.push(text.fault(
                    annotation.whole(),
                    format!("`@{name}` stands here twice."),
                    "Keep one of them.",
                ));
            }
        }
    }

    /// The first annotation of that name.
    pub(crate) fn get(&self, name: &str) -> Option<&Annotation> {
        self.annotations.iter().find(|annotation| annotation.name == name)
    }

    /// All annotations of that name.
    pub(crate) fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Annotation> {
        self.annotations
            .iter()
            .filter(move |annotation| annotation.name == name)
    }
}

/// Returns the fault of an annotation that is not allowed at its place.
pub(crate) fn unknown_annotation(text: Text<'_>, annotation: &Annotation, known: &[&str]) -> Fault {
    let everywhere = HEADER_ANNOTATIONS
        .iter()
        .chain(PARAM_ANNOTATIONS)
        .chain(FUNCTION_ANNOTATIONS)
        .copied();
    let name = annotation.name.as_str();
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
    text.fault(annotation.range.clone(), message, advice)
}

/// Splits a line into words with their places.
fn words(line: &DocLine) -> Vec<AnnotationWord> {
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
        words.push(AnnotationWord {
            text: trimmed[..length].to_owned(),
            range: at..at + length,
        });
        rest = &trimmed[length..];
        at += length;
    }
}

/// Reads a finite number.
pub(crate) fn number(word: &AnnotationWord) -> Option<f32> {
    word.text.parse::<f32>().ok().filter(|number| number.is_finite())
}
