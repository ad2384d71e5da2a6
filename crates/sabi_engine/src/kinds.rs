//! All node kinds of a session: the built-in ones, the artist's own, and those that are made here.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sabi_nodes::{Fault, Library};
use sabi_plan::SourceKind;

use crate::source;

/// All node kinds.
#[derive(Clone, Debug)]
pub struct Kinds {
    /// Kinds from WGSL files.
    pub library: Library,
    /// Kinds whose results are made here, by id.
    pub sources: BTreeMap<String, SourceKind>,
    /// Kinds that only take, by id.
    pub sinks: BTreeMap<String, SourceKind>,
    /// What is wrong with node files; each leaves the others alone.
    pub faults: Vec<Fault>,
}

impl Kinds {
    /// The built-in kinds.
    pub fn builtin() -> Kinds {
        Kinds {
            library: Library::builtin(),
            sources: source::kinds(),
            sinks: source::sinks(),
            faults: Vec::new(),
        }
    }

    /// The built-in kinds, and those of a `nodes` folder beside the graph and of the user's folder.
    pub fn beside(graph: Option<&Path>) -> Kinds {
        let mut kinds = Kinds::builtin();
        let beside = graph.map(|graph| graph.parent().unwrap_or(Path::new("")).join("nodes"));
        for folder in user_folder().into_iter().chain(beside) {
            if folder.is_dir() {
                kinds.add_folder(&folder);
            }
        }
        kinds
    }

    /// Adds the nodes of a folder; faults are collected.
    pub fn add_folder(&mut self, folder: &Path) {
        let faults = self.library.load_folder(folder);
        self.faults.extend(faults);
    }
}

/// The user's own nodes: `SABI_NODES`, else `sabi/nodes` where the system keeps settings.
fn user_folder() -> Option<PathBuf> {
    let variable = |name: &str| {
        std::env::var_os(name)
            .filter(|value| !value.is_empty())
            .map(PathBuf::from)
    };
    if let Some(own) = variable("SABI_NODES") {
        return Some(own);
    }
    let system = if cfg!(windows) {
        variable("APPDATA")
    } else if cfg!(target_os = "macos") {
        variable("HOME").map(|home| home.join("Library/Application Support"))
    } else {
        variable("XDG_CONFIG_HOME").or_else(|| variable("HOME").map(|home| home.join(".config")))
    };
    system.map(|system| system.join("sabi/nodes"))
}
