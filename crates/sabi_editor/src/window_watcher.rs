//! Files that the window reads again when they change.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use egui::Context;
use sabi_engine::EngineError;
use sabi_engine::session::watch::{Changes, Watched, Watcher};

/// Files that the window depends on.
#[derive(Clone, PartialEq)]
pub(crate) struct WatchedFiles {
    pub(crate) graph: Option<PathBuf>,
    /// Folders of node files.
    pub(crate) nodes: Vec<PathBuf>,
    pub(crate) model: PathBuf,
    /// Revision of the received model, and whether it is the requested one.
    pub(crate) loaded: (Option<u64>, bool),
    /// Models beside the main one.
    pub(crate) beside: Vec<PathBuf>,
    /// Images and group files that the graph names.
    pub(crate) named: Arc<BTreeSet<PathBuf>>,
    /// Folders and files of the library.
    pub(crate) library: Arc<[PathBuf]>,
    pub(crate) environment: Option<PathBuf>,
}

/// Watcher of the files that the window depends on.
pub(crate) struct WindowWatcher {
    /// `None` where the system has no thread for it, which was reported.
    watcher: Option<Watcher>,
    watched: Option<WatchedFiles>,
    /// True if the library has to be read again once its files are watched, since they may have changed before.
    rereads_library: bool,
}

impl WindowWatcher {
    /// A watcher without files, and the error where the system has none; `context` draws a frame when a file changes.
    pub(crate) fn new(context: &Context) -> (WindowWatcher, Option<EngineError>) {
        let woken = context.clone();
        let (watcher, error) = match Watcher::new(move || woken.request_repaint()) {
            Ok(watcher) => (Some(watcher), None),
            Err(error) => (None, Some(error)),
        };
        let watching = WindowWatcher {
            watcher,
            watched: None,
            rereads_library: false,
        };
        (watching, error)
    }

    /// Returns whether changes are reported from now on.
    #[cfg(test)]
    pub(crate) fn is_watching(&self) -> bool {
        self.watched.is_some() && self.watcher.as_ref().is_some_and(Watcher::is_watching)
    }

    /// Files that are watched.
    pub(crate) fn watched(&self) -> Option<&WatchedFiles> {
        self.watched.as_ref()
    }

    /// Watches these files from now on; `model_files` are those that the model is read from.
    pub(crate) fn watch(&mut self, now: WatchedFiles, model_files: impl FnOnce() -> Vec<PathBuf>) {
        if self.watched.as_ref() == Some(&now) {
            return;
        }
        let before = self.watched.as_ref();
        self.rereads_library |= before.is_some_and(|before| before.library != now.library);
        if let Some(watcher) = &self.watcher {
            watcher.watch(Watched {
                nodes: now.nodes.clone(),
                graph: now.graph.clone(),
                model: model_files(),
                files: now
                    .named
                    .iter()
                    .chain(&*now.library)
                    .chain(&now.environment)
                    .chain(&now.beside)
                    .cloned()
                    .collect(),
            });
        }
        self.watched = Some(now);
    }

    /// Returns whether the library has to be read again because its files were not watched until now. `None` while it
    /// is not known whether they are watched.
    pub(crate) fn take_library_reread(&mut self) -> Option<bool> {
        let is_watching = self.watcher.as_ref().is_some_and(Watcher::is_watching);
        match self.rereads_library {
            true if is_watching => Some(std::mem::take(&mut self.rereads_library)),
            true => None,
            false => Some(false),
        }
    }

    /// Changes since the last call; `None` where the system has no watcher.
    pub(crate) fn changes(&self) -> Option<Changes> {
        self.watcher.as_ref().map(Watcher::changes)
    }
}
