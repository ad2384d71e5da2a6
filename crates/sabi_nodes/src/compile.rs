//! Node text and libraries in one module; what naga refuses becomes a fault with a place in a file.

use std::collections::BTreeSet;
use std::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use naga::front::wgsl::{Frontend, Options};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Module, Span};

use crate::explain::INVALID;
use crate::fault::{Fault, Text};
use crate::library::Libraries;
use crate::notes::{Notes, Word, unknown};
use crate::reader::FILE_LIMIT_BYTES;
use crate::scan;
use crate::words::list;

/// The library that is linked to every node without being asked.
const CORE: &str = "core";

/// The libraries that may read textures and declare what the kernel binds.
const PRIVILEGED: [&str; 3] = [CORE, ATLAS, "surface"];

/// The library that knows what kernels bind; linked to every kernel.
pub(crate) const ATLAS: &str = "atlas";

/// Several texts as one, the node first, so that line 12 of an error is line 12 of the file.
pub(crate) struct Linked<'a> {
    pub(crate) text: String,
    parts: Vec<Part<'a>>,
}

/// One text of [`Linked`].
struct Part<'a> {
    /// Byte offset in the whole.
    start: usize,
    path: PathBuf,
    text: &'a str,
    /// `None` for the node itself.
    library: Option<&'a str>,
}

impl<'a> Linked<'a> {
    /// The node's text, `core`, then the libraries in order.
    pub(crate) fn new(node: Text<'a>, used: &'a [String], libraries: &'a Libraries) -> Linked<'a> {
        let mut linked = Linked {
            text: String::new(),
            parts: Vec::new(),
        };
        linked.push(node.path.to_path_buf(), node.text, None);
        for name in std::iter::once(CORE).chain(used.iter().map(String::as_str)) {
            if let Some((name, text)) = libraries.0.get_key_value(name) {
                linked.push(library_path(name), text, Some(name));
            }
        }
        linked
    }

    fn push(&mut self, path: PathBuf, text: &'a str, library: Option<&'a str>) {
        self.parts.push(Part {
            start: self.text.len(),
            path,
            text,
            library,
        });
        self.text.push_str(text);
        self.text.push('\n');
    }

    fn part(&self, span: Span) -> Option<(&Part<'a>, std::ops::Range<usize>)> {
        let range = span.to_range()?;
        let part = self.parts.iter().rev().find(|part| part.start <= range.start)?;
        Some((part, range.start - part.start..range.end - part.start))
    }

    /// A fault at a place of the whole.
    pub(crate) fn fault(&self, span: Span, message: impl Into<String>, advice: impl Into<String>) -> Fault {
        match (self.part(span), self.parts.first()) {
            (Some((part, range)), _) => Fault::at(&part.path, part.text, range, message, advice),
            (None, Some(node)) => Fault::of_file(&node.path, message, advice),
            (None, None) => Fault::of_file(Path::new(""), message, advice),
        }
    }

    /// Whether the place is in the node's own text.
    pub(crate) fn is_in_node(&self, span: Span) -> bool {
        self.part(span).is_some_and(|(part, _)| part.library.is_none())
    }

    /// The library that the place is in.
    pub(crate) fn library_at(&self, span: Span) -> Option<&'a str> {
        self.part(span).and_then(|(part, _)| part.library)
    }

    /// Whether the place is in a library that may touch what a kernel binds.
    pub(crate) fn is_privileged(&self, span: Span) -> bool {
        self.library_at(span).is_some_and(|name| PRIVILEGED.contains(&name))
    }
}

/// Where messages say that a library is.
pub(crate) fn library_path(name: &str) -> PathBuf {
    PathBuf::from(format!("lib/{name}.wgsl"))
}

/// The libraries that a file names and those that they name, in the order of first use, without `core`.
pub(crate) fn used_libraries(
    text: Text<'_>,
    uses: &[Word],
    libraries: &Libraries,
    faults: &mut Vec<Fault>,
) -> Vec<String> {
    let mut found = Vec::new();
    let mut seen = BTreeSet::from([CORE.to_owned()]);
    add_used(text, uses, libraries, &mut seen, &mut found, faults);
    found
}

fn add_used(
    text: Text<'_>,
    uses: &[Word],
    libraries: &Libraries,
    seen: &mut BTreeSet<String>,
    found: &mut Vec<String>,
    faults: &mut Vec<Fault>,
) {
    for word in uses {
        let name = word.text.trim_end_matches(',');
        let Some(library) = libraries.text(name) else {
            let names = || libraries.names().filter(|name| *name != CORE);
            let advice = match crate::words::nearest(name, names()) {
                Some(meant) => format!("Did you mean `{meant}`? There are {}.", list(names())),
                None => format!("The libraries that can be used: {}.", list(names())),
            };
            let message = format!("There is no library `{name}` that can be used.");
            faults.push(text.fault(word.range.clone(), message, advice));
            continue;
        };
        if !seen.insert(name.to_owned()) {
            continue;
        }
        found.push(name.to_owned());
        let path = library_path(name);
        let text = Text {
            path: &path,
            text: library,
        };
        // Each level of this recursion is one more library in `seen`.
        add_used(text, &library_uses(text, faults), libraries, seen, found, faults);
    }
}

/// `@use` of a library's header, the only annotation it may have.
fn library_uses(text: Text<'_>, faults: &mut Vec<Fault>) -> Vec<Word> {
    let notes = Notes::read(&scan::header_lines(text));
    let (uses, others): (Vec<_>, Vec<_>) = notes.notes.into_iter().partition(|note| note.name == "use");
    faults.extend(others.iter().map(|note| unknown(text, note, &["use"])));
    uses.into_iter().flat_map(|note| note.words).collect()
}

/// Whether a library compiles with `core` and what it uses.
pub(crate) fn check_library(name: &str, libraries: &Libraries) -> Result<(), Fault> {
    let path = library_path(name);
    let text = Text {
        path: &path,
        text: libraries.text(name).unwrap_or_default(),
    };
    if text.text.len() > FILE_LIMIT_BYTES {
        let message = format!("The file is larger than {} KiB.", FILE_LIMIT_BYTES / 1024);
        return Err(Fault::of_file(&path, message, "Split it into several libraries."));
    }
    let first = |faults: Vec<Fault>| faults.into_iter().next().map_or(Ok(()), Err);
    scan::scan_depth(text).map_or(Ok(()), Err)?;
    let mut faults = Vec::new();
    let uses = library_uses(text, &mut faults);
    let mut used = used_libraries(text, &uses, libraries, &mut faults);
    first(faults)?;
    // The library itself is the first text, so that it is not linked twice.
    used.retain(|used| used != name);
    let mut linked = Linked::new(text, &used, libraries);
    if name == CORE {
        linked.text = format!("{}\n", text.text);
        linked.parts.truncate(1);
    }
    compile(&linked).map(|_| ())
}

/// Checks a generated module.
pub fn validate_wgsl(text: &str) -> Result<(), Fault> {
    let path = Path::new("generated.wgsl");
    let linked = Linked {
        text: text.to_owned(),
        parts: vec![Part {
            start: 0,
            path: path.to_path_buf(),
            text,
            library: None,
        }],
    };
    compile(&linked).map(|_| ())
}

/// Parses and validates. The fault speaks naga's words where it has no better ones.
pub(crate) fn compile(linked: &Linked<'_>) -> Result<Module, Fault> {
    // naga is made for text that programs wrote; a text that makes it panic must not end the program.
    let compiled = catch_unwind(AssertUnwindSafe(|| parse_and_validate(linked)));
    compiled.unwrap_or_else(|_| {
        let node = linked.parts.first().map_or(Path::new(""), |part| &part.path);
        Err(Fault::of_file(
            node,
            "The WGSL compiler gave up on this text.",
            "Undo the last change, and write it in another way.",
        ))
    })
}

fn parse_and_validate(linked: &Linked<'_>) -> Result<Module, Fault> {
    let mut frontend = Frontend::new_with_options(Options {
        parse_doc_comments: true,
        capabilities: Capabilities::default(),
    });
    let module = frontend.parse(&linked.text).map_err(|error| {
        // Where two places are told, the one in the node is the one that can be changed.
        let mine = error.labels().find(|(span, _)| linked.is_in_node(*span));
        let (span, label) = mine.or_else(|| error.labels().next()).unwrap_or((Span::UNDEFINED, ""));
        let label = if error.message().contains(label) { "" } else { label };
        linked.fault(span, sentence(error.message()), sentence(label))
    })?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::default());
    validator.validate(&module).map_err(|error| {
        let spans = error.spans().map(|(span, _)| *span);
        // The narrowest place is the one that is meant.
        let span = spans
            .filter(Span::is_defined)
            .min_by_key(|span| span.to_range().map(|range| range.len()));
        let mut cause: &dyn Error = error.as_inner();
        while let Some(deeper) = cause.source() {
            cause = deeper;
        }
        let message = format!("{INVALID}{}", sentence(&cause.to_string()));
        let advice = "The text is that of the WGSL compiler; numbers in brackets count its own expressions.";
        linked.fault(span.unwrap_or(Span::UNDEFINED), message, advice)
    })?;
    Ok(module)
}

/// With a capital at the start and a full stop at the end.
fn sentence(text: &str) -> String {
    let mut text = text.trim().to_owned();
    if let Some(first) = text.get_mut(0..1) {
        first.make_ascii_uppercase();
    }
    if !text.is_empty() && !text.ends_with(['.', '?', '!']) {
        text.push('.');
    }
    text
}
