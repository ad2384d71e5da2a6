//! Several WGSL texts as one module, with a map from places in it to files and lines.

use std::ops::Range;
use std::path::{Path, PathBuf};

use naga::Span;

use crate::fault::Fault;
use crate::shader_files::shared_path;

/// Path under which messages refer to text that the linker wrote.
const GENERATED: &str = "generated.wgsl";

/// Libraries that may read textures and declare the bindings of a kernel.
const PRIVILEGED: [&str; 3] = ["core", "atlas", "surface"];

/// WGSL text linked from several files, with its source map.
///
/// The lines of a file stay whole and in order, so each line of the text comes from one line of one file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LinkedModule {
    wgsl: String,
    parts: Vec<FileSpan>,
}

/// Part of the text that comes from one file.
#[derive(Clone, Debug, PartialEq, Eq)]
struct FileSpan {
    /// Byte range in the whole text.
    range: Range<usize>,
    path: PathBuf,
    origin: FileOrigin,
}

/// Kind of file that a part comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
enum FileOrigin {
    /// The file of a node.
    Node,
    /// A shared file, by its name in `@use`.
    Shared(String),
    /// Text that the linker wrote.
    Generated,
}

impl LinkedModule {
    /// The text as the shader compiler reads it.
    pub fn wgsl(&self) -> &str {
        &self.wgsl
    }

    /// Names of the shared files in it, as `@use` names them.
    pub fn shared_files(&self) -> impl Iterator<Item = &str> {
        self.parts.iter().filter_map(|part| match &part.origin {
            FileOrigin::Shared(name) => Some(name.as_str()),
            FileOrigin::Node | FileOrigin::Generated => None,
        })
    }

    /// Returns the file and line (counted from 1) that a line of the text comes from; `None` after the end.
    pub fn source_of_line(&self, line: usize) -> Option<(&Path, usize)> {
        let start = match line.checked_sub(2) {
            None => 0,
            Some(breaks) => self.wgsl.match_indices('\n').nth(breaks)?.0 + 1,
        };
        let part = self.part_at(start)?;
        let before = &self.wgsl[part.range.start..start.max(part.range.start)];
        Some((&part.path, 1 + before.matches('\n').count()))
    }

    /// Appends a node's text.
    pub(crate) fn push_node(&mut self, path: &Path, text: &str) {
        self.push(path.to_path_buf(), text, FileOrigin::Node);
    }

    /// Appends a shared file.
    pub(crate) fn push_shared(&mut self, name: &str, text: &str) {
        self.push(shared_path(name), text, FileOrigin::Shared(name.to_owned()));
    }

    /// Appends text that the linker wrote.
    pub(crate) fn push_generated(&mut self, text: &str) {
        self.push(PathBuf::from(GENERATED), text, FileOrigin::Generated);
    }

    fn push(&mut self, path: PathBuf, text: &str, origin: FileOrigin) {
        let start = self.wgsl.len();
        self.wgsl.push_str(text);
        if !text.ends_with('\n') {
            self.wgsl.push('\n');
        }
        let range = start..self.wgsl.len();
        self.parts.push(FileSpan { range, path, origin });
    }

    fn part_at(&self, at: usize) -> Option<&FileSpan> {
        self.parts
            .iter()
            .rev()
            .find(|part| part.range.start <= at && at < part.range.end)
    }

    fn part(&self, span: Span) -> Option<(&FileSpan, Range<usize>)> {
        let range = span.to_range()?;
        let part = self.parts.iter().rev().find(|part| part.range.start <= range.start)?;
        Some((part, range.start - part.range.start..range.end - part.range.start))
    }

    /// Creates a fault at a place in the text. If the place is unknown, the fault concerns the first file as a whole.
    pub(crate) fn fault(&self, span: Span, message: impl Into<String>, advice: impl Into<String>) -> Fault {
        match self.part(span) {
            Some((part, range)) => Fault::at(&part.path, &self.wgsl[part.range.clone()], range, message, advice),
            None => Fault::of_file(self.first_path(), message, advice),
        }
    }

    /// Path of the file that the module was linked for.
    pub(crate) fn first_path(&self) -> &Path {
        self.parts.first().map_or(Path::new(GENERATED), |part| &part.path)
    }

    /// Returns true if the place is in a node's own text.
    pub(crate) fn is_in_node(&self, span: Span) -> bool {
        self.part(span).is_some_and(|(part, _)| part.origin == FileOrigin::Node)
    }

    /// Returns the shared file that contains the place.
    pub(crate) fn library_at(&self, span: Span) -> Option<&str> {
        match &self.part(span)?.0.origin {
            FileOrigin::Shared(name) => Some(name),
            FileOrigin::Node | FileOrigin::Generated => None,
        }
    }

    /// Returns true if the place is in a library that may access the bindings of a kernel.
    pub(crate) fn is_privileged(&self, span: Span) -> bool {
        self.library_at(span).is_some_and(|name| PRIVILEGED.contains(&name))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::LinkedModule;

    fn two_files() -> LinkedModule {
        let mut module = LinkedModule::default();
        module.push_node(Path::new("nodes/a.wgsl"), "// a\nconst A = B;");
        module.push_shared("noise", "const B = C;\n");
        module.push_generated("const D = 1;\n");
        module
    }

    #[test]
    fn each_line_of_the_text_comes_from_a_line_of_one_file() {
        let module = two_files();
        let sources: Vec<_> = (1..=4).map(|line| module.source_of_line(line)).collect();
        let expected = [
            ("nodes/a.wgsl", 1),
            ("nodes/a.wgsl", 2),
            ("lib/noise.wgsl", 1),
            ("generated.wgsl", 1),
        ];
        assert_eq!(sources, expected.map(|(path, line)| Some((Path::new(path), line))));
        assert_eq!(module.source_of_line(9), None);
    }
}
