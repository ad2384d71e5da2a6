//! Reads header, doc comments and names from the text, with their places. Refuses doc comments that naga would not attach
//! to the declarations below them.

mod items;
#[cfg(test)]
mod tests;
pub(crate) mod tokens;

use std::ops::Range;

use crate::fault::{FAULTS_SHOWN, Fault, Text};
use tokens::{Token, TokenKind};

/// One line of a doc comment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct DocLine {
    /// Byte offset of the comment's first character after `///` or `//!`.
    pub(crate) start: usize,
    /// The text after `///` or `//!`, with one leading space removed.
    pub(crate) text: String,
}

/// A struct member or a function argument.
#[derive(Clone, Debug)]
pub(crate) struct Member {
    pub(crate) name: String,
    pub(crate) name_range: Range<usize>,
    pub(crate) type_range: Range<usize>,
    pub(crate) docs: Vec<DocLine>,
}

/// Kind of a declaration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ItemKind {
    Struct,
    Function,
    Other,
}

/// A declaration at the top level of the file.
#[derive(Clone, Debug)]
pub(crate) struct Item {
    pub(crate) kind: ItemKind,
    /// `fn`, `struct`, `const`, …
    pub(crate) keyword: Range<usize>,
    pub(crate) name: String,
    pub(crate) name_range: Range<usize>,
    pub(crate) docs: Vec<DocLine>,
    /// Members of a struct, arguments of a function.
    pub(crate) members: Vec<Member>,
}

/// Result of scanning a text.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scan {
    /// The `//!` lines.
    pub(crate) header: Vec<DocLine>,
    /// Declarations in order, as far as the text could be scanned.
    pub(crate) items: Vec<Item>,
    /// True if the text was scanned to its end.
    pub(crate) is_complete: bool,
}

impl Scan {
    /// Returns `struct Params`, if there is one.
    pub(crate) fn params(&self) -> Option<&Item> {
        self.items
            .iter()
            .find(|item| item.kind == ItemKind::Struct && item.name == "Params")
    }

    /// All functions.
    pub(crate) fn functions(&self) -> impl Iterator<Item = &Item> {
        self.items.iter().filter(|item| item.kind == ItemKind::Function)
    }
}

/// Scans a file.
pub(crate) fn scan(text: Text<'_>) -> Result<Scan, Vec<Fault>> {
    let tokens = tokens::tokens(text.text);
    let mut faults = misplaced_comments(text, &tokens);
    if !faults.is_empty() {
        return Err(faults);
    }
    let header_end = tokens
        .iter()
        .position(|token| token.kind != TokenKind::ModuleDoc)
        .unwrap_or(tokens.len());
    let header = tokens[..header_end].iter().map(|token| doc_line(text, token)).collect();
    let (items, is_complete) = items::read_items(text, &tokens[header_end..], &mut faults);
    if faults.is_empty() {
        Ok(Scan {
            header,
            items,
            is_complete,
        })
    } else {
        Err(faults)
    }
}

/// Returns the header lines of a text that is not scanned further, such as a library.
pub(crate) fn header_lines(text: Text<'_>) -> Vec<DocLine> {
    // Only the lines that may contain the header are scanned, since libraries are linked often.
    let is_header = |line: &&str| line.trim_start().starts_with("//!") || line.trim().is_empty();
    let length = text
        .text
        .split_inclusive('\n')
        .take_while(is_header)
        .map(str::len)
        .sum();
    tokens::tokens(&text.text[..length])
        .iter()
        .take_while(|token| token.kind == TokenKind::ModuleDoc)
        .map(|token| doc_line(text, token))
        .collect()
}

fn doc_line(text: Text<'_>, token: &Token) -> DocLine {
    let start = token.range.start + 3;
    let content = &text.text[start..token.range.end];
    let (start, content) = match content.strip_prefix(' ') {
        Some(content) => (start + 1, content),
        None => (start, content),
    };
    DocLine {
        start,
        text: content.trim_end().to_owned(),
    }
}

/// Finds doc comments that naga drops, or attaches to another declaration. That is how naga reads doc comments; it
/// gives no warning (<https://github.com/gfx-rs/wgpu/pull/6364>).
fn misplaced_comments(text: Text<'_>, tokens: &[Token]) -> Vec<Fault> {
    let mut faults = Vec::new();
    let mut in_header = true;
    for (index, token) in tokens.iter().enumerate() {
        let previous = index.checked_sub(1).map(|previous| &tokens[previous]);
        let after_plain = previous.is_some_and(|previous| previous.kind == TokenKind::Plain);
        let fault = match token.kind {
            TokenKind::BlockDoc => Some((
                "A block comment documents nothing here.",
                "Write `//!` or `///` at the start of each line.",
            )),
            TokenKind::ModuleDoc
                if !in_header && previous.is_some_and(|previous| previous.kind == TokenKind::Plain) =>
            {
                Some((
                    "The header is lost, because a plain comment stands above it.",
                    "Start the file with the `//!` lines, and move the plain comment below them.",
                ))
            }
            TokenKind::ModuleDoc if !in_header => Some((
                "This `//!` line is not part of the header.",
                "`//!` lines stand together at the start of the file; above a declaration write `///`.",
            )),
            TokenKind::Doc if token.after_code => Some((
                "A doc comment behind code describes what follows, not what it stands behind.",
                "Write it on a line of its own above what it describes, or make it a plain `//` comment.",
            )),
            TokenKind::Doc if after_plain => Some((
                "This doc comment is lost, because a plain comment stands directly before it.",
                "Move the plain comment away, below the `///` lines for instance, or make it a `///` line too.",
            )),
            _ => None,
        };
        in_header &= token.kind == TokenKind::ModuleDoc;
        if faults.len() == FAULTS_SHOWN {
            break;
        }
        if let Some((message, advice)) = fault {
            // Consecutive misplaced lines are one fault, at the first line.
            let continues = previous.is_some_and(|previous| previous.kind == token.kind) && !token.after_code;
            if !continues {
                faults.push(text.fault(token.range.clone(), message, advice));
            }
        }
    }
    faults
}
