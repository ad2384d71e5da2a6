//! Node kinds: built in, from the artist's folders, and written in Rust.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sabi_files::TrustedPaths;
use sabi_nodes::kind::{Input, ParamType};
use sabi_nodes::{Fault, Library};
use sabi_plan::SourceKind;
use sabi_surface::model::Model;

use crate::opening::own_folder::own_folder;
use crate::source;

/// Collection of all node kinds.
#[derive(Clone, Debug)]
pub struct Kinds {
    /// Kinds from WGSL files.
    pub library: Library,
    /// Source kinds written in Rust, by id.
    pub sources: BTreeMap<String, SourceKind>,
    /// Output kinds, by id.
    pub sinks: BTreeMap<String, SourceKind>,
    /// Faults of node files; other files are not affected.
    pub faults: Vec<Fault>,
    /// Paths from which node files are read in addition to their own folder and its project. Links must not lead elsewhere.
    trusted: TrustedPaths,
}

impl Kinds {
    /// Returns the built-in kinds.
    pub fn builtin() -> Kinds {
        Kinds {
            library: Library::builtin(),
            sources: source::kinds(),
            sinks: source::sinks(),
            faults: Vec::new(),
            trusted: TrustedPaths::default(),
        }
    }

    /// Loads the built-in kinds, and those of the user's folder and of a `nodes` folder beside the graph. Links in these folders may
    /// lead to the trusted paths.
    pub fn beside(graph: Option<&Path>, trusted: &TrustedPaths) -> Kinds {
        let mut kinds = Kinds::builtin();
        kinds.trust(trusted);
        kinds.reread(&Kinds::folders(graph));
        kinds
    }

    /// Allows links among node files to lead to these paths, from the next reading on.
    pub fn trust(&mut self, trusted: &TrustedPaths) {
        self.trusted = std::mem::take(&mut self.trusted).with(trusted);
    }

    /// Lists the node folders of a graph: the user's, and `nodes` beside it. They need not exist.
    pub fn folders(graph: Option<&Path>) -> Vec<PathBuf> {
        // A bare file name refers to the current folder.
        let beside = graph.map(|graph| graph.parent().unwrap_or(Path::new("")).join("nodes"));
        own_node_folder().into_iter().chain(beside).collect()
    }

    /// Reads folders again: uses changed files, keeps the last good version of faulty ones, and drops nodes whose files no longer exist.
    pub fn reread(&mut self, folders: &[PathBuf]) {
        for folder in folders {
            self.faults.retain(|fault| !fault.path.starts_with(folder));
            if folder.is_dir() {
                self.add_folder(folder);
            } else {
                self.library.remove_folder(folder);
            }
        }
    }

    /// Sets the values of the kinds that depend on the model.
    pub(crate) fn adapt_to(&mut self, model: &Model) {
        let own = source::kinds_for(model);
        self.sources.extend(own.map(|kind| (kind.id.clone(), kind)));
    }

    /// Returns the type of a kind's parameter or of the knob of an input; `None` for an unknown kind or name.
    pub(crate) fn param_type(&self, kind: &str, name: &str) -> Option<ParamType> {
        let own = self.sources.get(kind).or_else(|| self.sinks.get(kind));
        if let Some(own) = own {
            let param = own.params.iter().find(|known| known.name == name)?;
            return Some(param.ty.clone());
        }
        let kind = self.library.kind(kind)?;
        let of_input = || kind.input(name).and_then(Input::knob);
        kind.param(name).map(|param| param.ty.clone()).or_else(of_input)
    }

    /// Warns about faulty node files, in one sentence.
    pub fn left_out(&self) -> Option<String> {
        let mut names: Vec<String> = self
            .faults
            .iter()
            .map(|fault| fault.path.display().to_string())
            .collect();
        names.dedup();
        match names.as_slice() {
            [] => None,
            [one] => Some(format!("{one} has a fault and is left out; 'sabi check' says which")),
            [one, ..] => {
                let count = names.len();
                Some(format!(
                    "{count} node files, {one} among them, have faults and are left out; 'sabi check' says which"
                ))
            }
        }
    }

    /// Lists the faults of a kind's file.
    pub(crate) fn faults_of<'k>(&'k self, kind: &'k str) -> impl Iterator<Item = &'k Fault> {
        let is_of = move |fault: &&Fault| fault.path.with_extension("").ends_with(kind);
        self.faults.iter().filter(is_of)
    }

    /// Returns the paths from which node files of a folder may be read. The user's own folder may be a link. A folder
    /// beside a graph may come from elsewhere with the graph, so it must not lead out of the graph's folder and project.
    pub(crate) fn trusted_for(folder: &Path, trusted: &TrustedPaths) -> TrustedPaths {
        match own_node_folder().is_some_and(|own| own == folder) {
            true => trusted.clone().with_path(folder),
            false => trusted.clone().with_file(folder),
        }
    }

    /// Loads the nodes of a folder, and collects their faults.
    pub fn add_folder(&mut self, folder: &Path) {
        let faults = self
            .library
            .load_folder(folder, &Kinds::trusted_for(folder, &self.trusted));
        self.faults.extend(faults);
    }
}

/// Returns the user's own folder of node files.
fn own_node_folder() -> Option<PathBuf> {
    own_folder("SABI_NODES", "nodes")
}
