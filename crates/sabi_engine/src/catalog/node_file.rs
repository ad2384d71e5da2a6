//! Node files of the user: beside a graph, or in the folder for all graphs.

use std::io;
use std::path::{Path, PathBuf};

use sabi_files::{Disk, FileError, absolute, path_from_stored, read_plain, stored_path};
use sabi_nodes::{SourceFile, read_kind};
use serde_json::{Value, json};

use crate::error::{EngineError, ErrorKind};
use crate::opening::kinds::Kinds;
use sabi_nodes::label_of;

/// Maximum size in bytes of a file that replaces a node's file; larger than any node.
const MOST_BYTES: u64 = 1 << 20;

/// Fault of the text of a node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeTextFault {
    /// Line, counted from 1; 0 for the whole text.
    pub line: u32,
    /// Description of the fault and how to correct it, as sentences.
    pub message: String,
}

/// A node file that is being written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeDraft {
    /// Folder of node files that it is saved to.
    pub folder: PathBuf,
    /// Id, `category/name`.
    pub id: String,
    /// Text, with or without faults.
    pub text: String,
    /// Text that the file had when it was last read or written; `None` before it is written for the first time.
    pub known: Option<String>,
}

/// Returns the folder for new nodes of a graph: `nodes` beside it, or the user's own folder while the graph has no file.
/// `None` if this system has no folder for settings.
pub fn new_node_folder(graph: Option<&Path>) -> Option<PathBuf> {
    Kinds::folders(graph).pop()
}

/// Returns the reason why a node cannot have this id (`category/name`), as a sentence; `None` if it can.
pub fn node_id_fault(kinds: &Kinds, folder: &Path, id: &str) -> Option<String> {
    let is_word = |word: &str| {
        let is_letter = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_';
        !word.is_empty() && word.chars().all(is_letter)
    };
    let parts = id
        .split_once('/')
        .filter(|(category, name)| is_word(category) && is_word(name));
    let Some((category, _)) = parts else {
        return Some(format!(
            "'{id}' is not a valid node id; write a category, a slash and a name, in lower-case letters, digits and \
             underscores"
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

/// Checks the text of a node and returns its faults; empty if it is valid.
pub fn check_node(kinds: &Kinds, folder: &Path, id: &str, text: &str) -> Vec<NodeTextFault> {
    let file = SourceFile {
        path: file_of(folder, id),
        id: id.to_owned(),
        text: text.to_owned(),
    };
    let faults = read_kind(&file, kinds.library.libraries()).err().unwrap_or_default(); // A kind that can be read has none.
    let faults = faults.into_iter().map(|fault| NodeTextFault {
        line: fault.line,
        message: [fault.message, fault.advice].join(" ").trim().to_owned(),
    });
    faults.collect()
}

/// Reads the text of a node's file.
///
/// # Errors
/// The file cannot be read.
pub fn read_node(folder: &Path, id: &str) -> Result<String, EngineError> {
    let file = file_of(folder, id);
    let bytes = read_plain(&file, MOST_BYTES).map_err(io::Error::from);
    let text = bytes.and_then(|bytes| String::from_utf8(bytes).map_err(io::Error::other));
    text.map_err(|error| {
        let why = format!("{} cannot be read: {error}; create a new node from it", file.display());
        EngineError::new(ErrorKind::BadInput, why).caused_by(error)
    })
}

impl NodeDraft {
    /// Writes the file completely or not at all, and returns its path.
    ///
    /// # Errors
    /// The file was changed by another program since it was read, or the folder cannot be written to.
    pub fn save(&self, disk: &Disk) -> Result<PathBuf, EngineError> {
        let file = file_of(&self.folder, &self.id);
        let cannot = |error: FileError| {
            let why = format!("{} cannot be written: {}", file.display(), error.reason());
            EngineError::new(ErrorKind::CannotWrite, why).caused_by(error)
        };
        match read_plain(&file, MOST_BYTES) {
            Ok(found) if !self.may_replace(&found) => {
                let why = format!(
                    "{} was written by another program meanwhile; give this node another name, or close it and open \
                     the file again",
                    file.display()
                );
                return Err(EngineError::new(ErrorKind::CannotWrite, why));
            }
            Ok(_) => disk.write_whole(&file, self.text.as_bytes()).map_err(cannot)?,
            // If the file cannot be read, or another program creates it at this moment, it is not overwritten.
            Err(_) => disk.write_new(&file, self.text.as_bytes()).map_err(cannot)?,
        }
        Ok(file)
    }

    /// Returns true if a file with this content may be replaced: the content was read or written last, or is the new text.
    fn may_replace(&self, found: &[u8]) -> bool {
        let is_known = self.known.as_ref().is_some_and(|known| known.as_bytes() == found);
        is_known || found == self.text.as_bytes()
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

/// Returns the text of a node as the beginning of a new node, with the title of the new id and without the former ids of the old node.
pub fn new_node_text(text: &str, id: &str) -> String {
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
    /// Returns the folder from which a kind was read, if it is one of the user's.
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
    use std::fs;

    use sabi_files::TrustedPaths;

    use super::*;

    const SOUND: &str = "//! Half\n//! Gives half of a mask.\n//! @was old/half\n\n/// Half of it.\n/// @input source \
                         The mask. \
                         @optional @default 1\nfn mask(source: f32) -> f32 {\n    return source * 0.5;\n}\n";

    #[test]
    fn a_node_is_checked_during_typing_and_faults_have_their_line() {
        let kinds = Kinds::builtin();
        let folder = Path::new("nodes");
        assert_eq!(check_node(&kinds, folder, "adjust/half", SOUND), []);
        let broken = SOUND.replace("0.5", "hlaf");
        let faults = check_node(&kinds, folder, "adjust/half", &broken);
        assert_eq!(faults.len(), 1, "{faults:?}");
        assert_eq!(faults[0].line, 8);
        assert!(faults[0].message.contains("hlaf"), "{}", faults[0].message);
        assert!(!check_node(&kinds, folder, "adjust/half", "").is_empty());
    }

    #[test]
    fn a_new_node_has_its_own_title_and_no_former_ids() {
        let text = new_node_text(SOUND, "adjust/a_third");
        assert!(text.starts_with("//! A third\n//! Gives half of a mask.\n\n"), "{text}");
        assert!(!text.contains("@was"));
        assert!(text.ends_with("}\n"), "{text}");
    }

    #[test]
    fn every_node_can_be_the_beginning_of_another() {
        let kinds = Kinds::builtin();
        for kind in kinds.library.kinds() {
            let id = format!("{}_own", kind.id);
            let text = new_node_text(&kind.source, &id);
            assert_eq!(check_node(&kinds, Path::new("nodes"), &id, &text), [], "{}", kind.id);
        }
    }

    #[test]
    fn an_id_is_a_category_and_a_free_name() {
        let kinds = Kinds::builtin();
        let told = |id: &str| node_id_fault(&kinds, Path::new("nodes"), id);
        assert_eq!(told("noise/mine"), None);
        let no_id = "is not a valid node id; write a category, a slash and a name, in lower-case letters, digits and \
             underscores";
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

    #[test]
    fn a_node_is_the_old_text_or_the_new_one_after_a_fault_at_any_step() {
        let saved_on = |disk: &Disk| {
            let folder = tempfile::tempdir().expect("a folder");
            let nodes = folder.path().join("nodes");
            draft(&nodes, "old", None).save(&Disk::default()).expect("written");
            let is_told = draft(&nodes, SOUND, Some("old")).save(disk).is_ok();
            let text = read_node(&nodes, "adjust/half").expect("a text");
            assert!(text == SOUND || !is_told && text == "old", "{text}");
            assert!(!is_told || disk.at_risk().is_empty());
        };
        let disk = Disk::counting();
        saved_on(&disk);
        assert!(disk.steps() > 0);
        Disk::each_fault(disk.steps()).for_each(|(disk, _)| saved_on(&disk));
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
        let file = draft(&nodes, SOUND, None).save(&Disk::default()).expect("written");
        assert_eq!(file, nodes.join("adjust/half.wgsl"));
        let kinds = Kinds::beside(Some(&graph), &TrustedPaths::default());
        assert!(kinds.library.kind("adjust/half").is_some(), "{:?}", kinds.faults);
        assert_eq!(kinds.own_folder(Some(&graph), "adjust/half"), Some(nodes.clone()));
        assert_eq!(kinds.own_folder(Some(&graph), "noise/simplex"), None);
        assert_eq!(node_id_fault(&kinds, &nodes, "adjust/half"), None, "it is this one");
        let told = draft(&file, SOUND, None)
            .save(&Disk::default())
            .expect_err("a file is no folder");
        assert!(told.to_string().contains("cannot be written"), "{told}");
        // The fault is in the file. The last version without a fault is still used.
        let broken = SOUND.replace("0.5", "hlaf");
        draft(&nodes, &broken, Some(SOUND))
            .save(&Disk::default())
            .expect("written");
        assert_eq!(read_node(&nodes, "adjust/half").ok(), Some(broken.clone()));
        let told = draft(&nodes, "mine", Some(SOUND))
            .save(&Disk::default())
            .expect_err("somebody wrote it");
        assert!(told.to_string().contains("was written by another program"), "{told}");
        // Also where it is no text.
        let path = nodes.join("adjust/half.wgsl");
        fs::write(&path, b"\xff").expect("written");
        let told = draft(&nodes, "mine", None).save(&Disk::default()).expect_err("theirs");
        assert!(told.to_string().contains("was written by another program"), "{told}");
        fs::write(&path, &broken).expect("written");
        assert_eq!(read_node(&nodes, "adjust/half").ok(), Some(broken));
    }
}
