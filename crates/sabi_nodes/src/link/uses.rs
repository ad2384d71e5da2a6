//! Finds all files that a module needs, by the `@use` annotations of its files.
//!
//! A header names other files with `//! @use noise surface/place`, and declarations of the host with `//! @given
//! SURFACE_GROUP`. A name without a folder is a file of `lib/`; nodes and libraries may use only those. Files that use each
//! other are each linked once: the order of declarations does not matter in WGSL.

use std::collections::BTreeSet;

use super::given_declarations::Given;
use super::module::LinkedModule;
use crate::annotations::{AnnotationWord, DocComment, unknown_annotation};
use crate::fault::{FAULTS_SHOWN, Fault, Text};
use crate::scan;
use crate::shader_files::{CORE, Libraries, shader_names, shared_path, shared_text};
use crate::words::{list, nearest};

/// The library that declares the bindings of kernels; linked to every kernel.
pub(crate) const ATLAS: &str = "atlas";

/// A declaration that a file requires from the host.
#[derive(Clone, Debug, PartialEq, Eq)]
struct RequiredDeclaration {
    name: String,
    /// Fault that is reported if the host does not provide it.
    missing: Fault,
}

/// The files that a module needs, directly or indirectly.
pub(crate) struct FileUses<'a> {
    libraries: &'a Libraries,
    seen: BTreeSet<String>,
    /// Shared files in the order of first use, each once.
    pub(crate) names: Vec<String>,
    required: Vec<RequiredDeclaration>,
    pub(crate) faults: Vec<Fault>,
}

impl<'a> FileUses<'a> {
    pub(crate) fn new(libraries: &'a Libraries) -> FileUses<'a> {
        FileUses {
            libraries,
            seen: BTreeSet::new(),
            names: Vec::new(),
            required: Vec::new(),
            faults: Vec::new(),
        }
    }

    /// Adds a shared file with all files that it uses. Returns false if there is no file with this name.
    pub(crate) fn add(&mut self, name: &str) -> bool {
        let Some(file) = shared_text(name, self.libraries) else {
            return false;
        };
        if !self.seen.insert(name.to_owned()) {
            return true;
        }
        self.names.push(name.to_owned());
        let path = shared_path(name);
        let text = Text {
            path: &path,
            text: file,
        };
        let header = SharedHeader::read(text, &mut self.faults);
        self.required
            .extend(header.given.iter().map(|word| RequiredDeclaration {
                name: word.text.clone(),
                missing: text.fault(
                    word.range.clone(),
                    format!("Nothing gives `{}` to this file.", word.text),
                    "The program that links the file has to give it.",
                ),
            }));
        // Each level of this recursion adds a file to `seen`, so it ends.
        self.follow(text, &header.uses, name.contains('/'));
        true
    }

    /// Adds the files that a file names with `@use`. `may_use_all` is false for nodes and libraries, which may use only libraries.
    pub(crate) fn follow(&mut self, text: Text<'_>, uses: &[AnnotationWord], may_use_all: bool) {
        for word in uses {
            if self.faults.len() >= FAULTS_SHOWN {
                break;
            }
            let name = word.text.trim_end_matches(',');
            if (!may_use_all && name.contains('/')) || !self.add(name) {
                self.faults.push(self.unknown_library(text, word, name, may_use_all));
            }
        }
    }

    fn unknown_library(&self, text: Text<'_>, word: &AnnotationWord, name: &str, may_use_all: bool) -> Fault {
        let mut names: Vec<&str> = self.libraries.names().filter(|name| *name != CORE).collect();
        if may_use_all {
            for name in shader_names() {
                names.push(name);
            }
        }
        let known = || names.iter().copied();
        let advice = match nearest(name, known()) {
            Some(meant) => format!("Did you mean `{meant}`? There are {}.", list(known())),
            None => format!("The libraries that can be used: {}.", list(known())),
        };
        let message = format!("There is no library `{name}` that can be used.");
        text.fault(word.range.clone(), message, advice)
    }

    /// Appends all files, and then the given declarations. A declaration that is required but not given is a fault, and so
    /// is one that is given but not required.
    pub(crate) fn append(self, module: &mut LinkedModule, given: &[Given]) -> Result<(), Fault> {
        if let Some(fault) = self.faults.into_iter().next() {
            return Err(fault);
        }
        for name in &self.names {
            if let Some(text) = shared_text(name, self.libraries) {
                module.push_shared(name, text);
            }
        }
        let is_given = |required: &RequiredDeclaration| given.iter().any(|given| given.name == required.name);
        if let Some(required) = self.required.iter().find(|required| !is_given(required)) {
            return Err(required.missing.clone());
        }
        let is_required = |given: &&Given| self.required.iter().any(|required| required.name == given.name);
        if let Some(given) = given.iter().find(|given| !is_required(given)) {
            let message = format!(
                "`{}` is given to this module, and none of its files wants it.",
                given.name
            );
            let advice = "Add it to a header with `//! @given`, or give it no more.";
            return Err(Fault::of_file(module.first_path(), message, advice));
        }
        if !given.is_empty() {
            let texts: Vec<String> = given.iter().map(Given::to_string).collect();
            module.push_generated(&texts.concat());
        }
        Ok(())
    }
}

/// Header of a shared file.
pub(crate) struct SharedHeader {
    pub(crate) uses: Vec<AnnotationWord>,
    given: Vec<AnnotationWord>,
}

impl SharedHeader {
    /// Reads `@use` and `@given`, the only annotations that are allowed in a shared file.
    pub(crate) fn read(text: Text<'_>, faults: &mut Vec<Fault>) -> SharedHeader {
        let mut header = SharedHeader {
            uses: Vec::new(),
            given: Vec::new(),
        };
        for annotation in DocComment::read(&scan::header_lines(text)).annotations {
            match annotation.name.as_str() {
                "use" => header.uses.extend(annotation.words),
                "given" => header.given.extend(annotation.words),
                _ if faults.len() >= FAULTS_SHOWN => break,
                _ => faults.push(unknown_annotation(text, &annotation, &["given", "use"])),
            }
        }
        header
    }
}
