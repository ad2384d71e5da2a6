//! Node files that are written beside a graph, or for all of a user's graphs.

use std::fs;
use std::path::{Path, PathBuf};

use sabi_files::{absolute, path_from_stored, stored_path, write_whole};
use sabi_nodes::{SourceFile, read_kind};
use serde_json::{Value, json};

use crate::catalog::label_of;
use crate::error::{EngineError, ErrorKind};
use crate::opening::kinds::Kinds;

/// One thing that is wrong with the text of a node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeTextFault {
    /// Line, counted from 1; 0 when the whole text is meant.
    pub line: u32,
    /// What is wrong and what to do, as sentences.
    pub told: String,
}

/// A node file that is being written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeDraft {
    /// The folder of nodes that it goes into.
    pub folder: PathBuf,
    /// `category/name`.
    pub id: String,
    /// Its text, sound or not.
    pub text: String,
    /// What its file is known to hold; none before it is written for the first time.
    pub known: Option<String>,
}

/// The folder that a graph's new nodes go into: `nodes` beside it, or the user's own while it has no file. None where this
/// system has no place for the latter.
pub fn new_node_folder(graph: Option<&Path>) -> Option<PathBuf> {
    Kinds::folders(graph).pop()
}

/// Why a node cannot have this id, as files have it: `category/name`.
pub fn why_no_node_id(kinds: &Kinds, folder: &Path, id: &str) -> Option<String> {
    let is_word = |word: &str| {
        let is_letter = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_';
        !word.is_empty() && word.chars().all(is_letter)
    };
    let parts = id
        .split_once('/')
        .filter(|(category, name)| is_word(category) && is_word(name));
    let Some((category, _)) = parts else {
        return Some(format!(
            "'{id}' is no id of a node; write a category, a stroke and a name of small letters, digits and underscores"
        ));
    };
    if category == "lib" {
        return Some("'lib' is for libraries; choose another category".to_owned());
    }
    let of_rust = kinds.sources.contains_key(id) || kinds.sinks.contains_key(id);
    let of_file = kinds.library.kind(id).filter(|kind| kind.path != file_of(folder, id));
    let is_taken = of_rust || of_file.is_some();
    is_taken.then(|| format!("there is a node '{id}' already; choose another name"))
}

/// What is wrong with the text of a node; nothing where it is sound.
pub fn check_node(kinds: &Kinds, folder: &Path, id: &str, text: &str) -> Vec<NodeTextFault> {
    let file = SourceFile {
        path: file_of(folder, id),
        id: id.to_owned(),
        text: text.to_owned(),
    };
    let faults = read_kind(&file, kinds.library.libraries()).err().unwrap_or_default(); // A kind that can be read has none.
    let told = faults.into_iter().map(|fault| NodeTextFault {
        line: fault.line,
        told: [fault.message, fault.advice].join(" ").trim().to_owned(),
    });
    told.collect()
}

/// The text of a node's file as it is now, faults and all.
///
/// # Errors
/// It cannot be read.
pub fn read_node(folder: &Path, id: &str) -> Result<String, EngineError> {
    let file = file_of(folder, id);
    fs::read_to_string(&file).map_err(|error| {
        let why = format!("{} cannot be read: {error}; begin a new node from it", file.display());
        EngineError::new(ErrorKind::BadInput, why).caused_by(error)
    })
}

impl NodeDraft {
    /// Writes the file, whole or as it was before, in the place of what it is known to hold, and says where it is.
    ///
    /// # Errors
    /// The file holds something else that somebody wrote meanwhile, or the folder cannot be written to.
    pub fn save(&self) -> Result<PathBuf, EngineError> {
        let file = file_of(&self.folder, &self.id);
        let found = fs::read_to_string(&file).ok();
        if found.is_some() && found != self.known && found.as_ref() != Some(&self.text) {
            let why = format!(
                "{} was written by another program meanwhile; give this node another name, or close it and open the file \
                 anew",
                file.display()
            );
            return Err(EngineError::new(ErrorKind::CannotWrite, why));
        }
        match write_whole(&file, self.text.as_bytes()) {
            Ok(()) => Ok(file),
            Err(error) => {
                let why = format!("{} cannot be written: {}", file.display(), error.reason());
                Err(EngineError::new(ErrorKind::CannotWrite, why).caused_by(error))
            }
        }
    }

    pub(crate) fn to_json(&self) -> Value {
        json!({
            "folder": stored_path(&absolute(&self.folder)),
            "id": self.id,
            "text": self.text,
            "known": self.known,
        })
    }

    pub(crate) fn from_json(kept: &Value) -> Option<NodeDraft> {
        let text = |name: &str| kept[name].as_str().map(str::to_owned);
        Some(NodeDraft {
            folder: path_from_stored(&text("folder")?)?,
            id: text("id")?,
            text: text("text")?,
            known: text("known"),
        })
    }
}

/// The text of a node to begin another one from: with a title of its own, and without the names that the other one once had.
pub fn node_text_like(text: &str, id: &str) -> String {
    let name = id.rsplit('/').next().unwrap_or(id);
    let mut has_title = false;
    let mut lines: Vec<String> = Vec::new();
    for line in text.lines() {
        let header = line.strip_prefix("//!").map(str::trim);
        match header {
            Some(header) if header.starts_with("@was") => {}
            Some(header) if !has_title && !header.is_empty() => {
                has_title = true;
                lines.push(format!("//! {}", label_of(name)));
            }
            _ => lines.push(line.to_owned()),
        }
    }
    lines.push(String::new());
    lines.join("\n")
}

impl Kinds {
    /// The folder that a kind was read from, where that is one of the artist's own.
    pub fn own_folder(&self, graph: Option<&Path>, id: &str) -> Option<PathBuf> {
        let kind = self.library.kind(id)?;
        Kinds::folders(graph)
            .into_iter()
            .find(|folder| kind.path.starts_with(folder))
    }
}

fn file_of(folder: &Path, id: &str) -> PathBuf {
    folder.join(format!("{id}.wgsl"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOUND: &str = "//! Half\n//! Gives half of a mask.\n//! @was old/half\n\n/// Half of it.\n/// @input source The mask. \
                         @optional @default 1\nfn mask(source: f32) -> f32 {\n    return source * 0.5;\n}\n";

    #[test]
    fn a_node_is_checked_as_it_is_typed_and_faults_name_their_line() {
        let kinds = Kinds::builtin();
        let folder = Path::new("nodes");
        assert_eq!(check_node(&kinds, folder, "adjust/half", SOUND), []);
        let broken = SOUND.replace("0.5", "hlaf");
        let faults = check_node(&kinds, folder, "adjust/half", &broken);
        assert_eq!(faults.len(), 1, "{faults:?}");
        assert_eq!(faults[0].line, 8);
        assert!(faults[0].told.contains("hlaf"), "{}", faults[0].told);
        assert!(!check_node(&kinds, folder, "adjust/half", "").is_empty());
    }

    #[test]
    fn a_new_node_has_a_title_of_its_own_and_no_name_that_another_had() {
        let text = node_text_like(SOUND, "adjust/a_third");
        assert!(text.starts_with("//! A third\n//! Gives half of a mask.\n\n"), "{text}");
        assert!(!text.contains("@was"));
        assert!(text.ends_with("}\n"), "{text}");
    }

    #[test]
    fn every_node_can_be_the_beginning_of_another() {
        let kinds = Kinds::builtin();
        for kind in kinds.library.kinds() {
            let id = format!("{}_own", kind.id);
            let text = node_text_like(&kind.source, &id);
            assert_eq!(check_node(&kinds, Path::new("nodes"), &id, &text), [], "{}", kind.id);
        }
    }

    #[test]
    fn an_id_is_a_category_and_a_name_that_nobody_has() {
        let kinds = Kinds::builtin();
        let told = |id: &str| why_no_node_id(&kinds, Path::new("nodes"), id);
        assert_eq!(told("noise/mine"), None);
        let no_id =
            "is no id of a node; write a category, a stroke and a name of small letters, digits and underscores";
        for id in ["mine", "noise/", "/mine", "Noise/mine", "noise/../mine", "a/b/c", ""] {
            assert_eq!(told(id), Some(format!("'{id}' {no_id}")));
        }
        assert_eq!(
            told("noise/simplex").as_deref(),
            Some("there is a node 'noise/simplex' already; choose another name")
        );
        assert!(told("source/image").is_some_and(|told| told.starts_with("there is a node")));
        assert_eq!(
            told("lib/mine").as_deref(),
            Some("'lib' is for libraries; choose another category")
        );
    }

    fn draft(folder: &Path, text: &str, known: Option<&str>) -> NodeDraft {
        NodeDraft {
            folder: folder.to_owned(),
            id: "adjust/half".to_owned(),
            text: text.to_owned(),
            known: known.map(str::to_owned),
        }
    }

    #[test]
    fn a_saved_node_is_a_kind_that_can_be_changed_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let graph = folder.path().join("worn.sabi");
        let nodes = new_node_folder(Some(&graph)).expect("a folder beside");
        assert_eq!(nodes, folder.path().join("nodes"));
        let file = draft(&nodes, SOUND, None).save().expect("written");
        assert_eq!(file, nodes.join("adjust/half.wgsl"));
        let kinds = Kinds::beside(Some(&graph));
        assert!(kinds.library.kind("adjust/half").is_some(), "{:?}", kinds.faults);
        assert_eq!(kinds.own_folder(Some(&graph), "adjust/half"), Some(nodes.clone()));
        assert_eq!(kinds.own_folder(Some(&graph), "noise/simplex"), None);
        assert_eq!(why_no_node_id(&kinds, &nodes, "adjust/half"), None, "it is this one");
        let told = draft(&file, SOUND, None).save().expect_err("a file is no folder");
        assert!(told.to_string().contains("cannot be written"), "{told}");
        // A fault is in the file, and not in the last version without one.
        let broken = SOUND.replace("0.5", "hlaf");
        draft(&nodes, &broken, Some(SOUND)).save().expect("written");
        assert_eq!(read_node(&nodes, "adjust/half").ok(), Some(broken.clone()));
        let told = draft(&nodes, "mine", Some(SOUND))
            .save()
            .expect_err("somebody wrote it");
        assert!(told.to_string().contains("was written by another program"), "{told}");
        assert_eq!(read_node(&nodes, "adjust/half").ok(), Some(broken));
    }
}
