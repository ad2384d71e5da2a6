//! Material libraries (`.mtl`), converted to metallic-roughness as far as possible.

use std::collections::{BTreeMap, BTreeSet};

use super::material_draft::{Keyword, MaterialDraft, is_known};
use super::statements::{MOST_LIBRARIES, logical_lines, named, split_word};
use super::unknown::Unknown;
use crate::load::gltf::Resolve;
use crate::load::material_images::MaterialImages;
use crate::load::text::decoded;
use crate::load::warnings::Warnings;
use crate::model::ModelMaterial;

/// Most materials of all libraries of a file.
const MOST_MATERIALS: usize = 1 << 16;

/// Materials by name, and the pictures that they name.
#[derive(Default)]
pub(super) struct MaterialLibrary {
    materials: Vec<ModelMaterial>,
    places: BTreeMap<String, usize>,
    /// Names of libraries that were searched already.
    known: BTreeSet<String>,
    pub(super) pictures: MaterialImages,
}

impl MaterialLibrary {
    /// Returns the index of a material by its name. A comment may follow the name.
    pub(super) fn place(&self, name: &str) -> Option<usize> {
        let bare = name.split_once(" #").map_or(name, |(bare, _)| bare.trim_ascii_end());
        let place = self.places.get(name).or_else(|| self.places.get(bare));
        place.copied()
    }

    /// Returns a copy of a material.
    pub(super) fn take(&self, name: &str) -> Option<ModelMaterial> {
        self.place(name).map(|place| self.materials[place].clone())
    }

    /// Reads the libraries of an `mtllib` statement: one name that may contain spaces, or several names.
    pub(super) fn read(&mut self, names: &str, resolve: &mut Resolve, warnings: &mut Warnings) {
        if !self.is_next(names, warnings) {
            return;
        }
        let whole = resolve(names);
        // A space in a name may be escaped with a backslash.
        let escaped = names.replace("\\ ", "\0");
        let all: Vec<String> = escaped
            .split_ascii_whitespace()
            .take_while(|word| !word.starts_with('#'))
            .map(|name| name.replace('\0', " "))
            .collect();
        match whole {
            Ok(bytes) => self.parse(names, &bytes, warnings),
            Err(reason) if all.len() < 2 => {
                warnings.add(format!("The material library {names} cannot be read: {reason}."));
            }
            Err(_) => {
                for name in all {
                    if !self.is_next(&name, warnings) {
                        continue;
                    }
                    match resolve(&name) {
                        Ok(bytes) => self.parse(&name, &bytes, warnings),
                        Err(reason) => warnings.add(format!("The material library {name} cannot be read: {reason}.")),
                    }
                }
            }
        }
    }

    /// Reads the library that has the `stem` of the model's own name, for materials that are in no other: users rename models, and
    /// programs write them without the name of a library.
    pub(super) fn read_beside(&mut self, stem: &str, resolve: &mut Resolve, warnings: &mut Warnings) {
        let name = format!("{stem}.mtl");
        if self.known.contains(&name) {
            return;
        }
        if let Ok(bytes) = resolve(&name) {
            warnings.add(format!(
                "Materials are in no library that the file names and that could be read; those of {name} beside it are taken."
            ));
            self.parse(&name, &bytes, warnings);
        }
    }

    /// Returns whether a library is to be read: it was not looked for before, and there are not too many.
    fn is_next(&mut self, name: &str, warnings: &mut Warnings) -> bool {
        if self.known.contains(name) {
            return false;
        }
        if self.known.len() == MOST_LIBRARIES {
            warnings.add(format!(
                "The file names more than {MOST_LIBRARIES} material libraries; the others are left out."
            ));
            return false;
        }
        self.known.insert(name.to_owned())
    }

    /// Returns the draft of a material of a name, unless it is in vain: the first of two materials of one name stays, and there are
    /// not too many.
    fn draft(&self, name: &str, warnings: &mut Warnings) -> Option<MaterialDraft> {
        if self.places.contains_key(name) {
            return None;
        }
        if self.materials.len() >= MOST_MATERIALS {
            warnings.add(format!(
                "The material libraries have more than {MOST_MATERIALS} materials; the others are left out."
            ));
            return None;
        }
        Some(MaterialDraft::new(name))
    }

    fn parse(&mut self, file: &str, bytes: &[u8], warnings: &mut Warnings) {
        let text = decoded(bytes);
        let mut unknown = Unknown::default();
        let mut current = None;
        for (line, content) in logical_lines(&text) {
            let (keyword, rest) = split_word(&content);
            let keyword = Keyword {
                written: keyword,
                lower: keyword.to_ascii_lowercase(),
            };
            if keyword.lower == "newmtl" {
                self.finish(current.take(), warnings);
                current = self.draft(named(rest), warnings);
            } else if keyword.lower.starts_with('#') {
                // A comment of a kind that has a meaning in OBJ files.
            } else if !is_known(&keyword.lower) {
                unknown.note(keyword.written, line);
            } else if let Some(draft) = &mut current {
                draft.statement(&keyword, rest, &mut self.pictures, warnings);
            }
        }
        self.finish(current, warnings);
        unknown.warn(&format!("The material library {file}"), warnings);
    }

    /// Adds a material after all its statements were read.
    fn finish(&mut self, draft: Option<MaterialDraft>, warnings: &mut Warnings) {
        let Some(draft) = draft else { return };
        let material = draft.finished(warnings);
        self.places.insert(material.name.clone(), self.materials.len());
        self.materials.push(material);
    }
}
