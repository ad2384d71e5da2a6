//! The folders that the system is asked about.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::Sender;

use notify::event::{EventKind, ModifyKind};
use notify::{RecommendedWatcher, RecursiveMode, Watcher as _};

use super::look::subfolders;
use super::{Message, Watched};

/// Folders, as the system names them, that it tells about. Whole folders and not files: careful editors put another file in
/// the place of the one that they save.
pub(super) struct Folders {
    /// None where the system has none to give; then looking has to do.
    watcher: Option<RecommendedWatcher>,
    armed: BTreeSet<PathBuf>,
}

impl Folders {
    pub(super) fn new(inbox: Sender<Message>) -> Folders {
        let heard = move |event: notify::Result<notify::Event>| {
            // An error is one of the system's lists that ran over: then everything is looked at.
            let event = event.unwrap_or_else(|_| notify::Event::new(EventKind::Any));
            let paths = match event.kind {
                EventKind::Access(_) => return,
                // Who may read a file, and what a system notes about it, is not what is in it.
                EventKind::Modify(ModifyKind::Metadata(_)) => Vec::new(),
                _ => event.paths,
            };
            // The other end is gone only when nobody wants to know any more.
            let _ = inbox.send(Message::Told(paths));
        };
        let watcher = notify::recommended_watcher(heard);
        if let Err(error) = &watcher {
            tracing::warn!("the system tells nothing of files that change, so they are looked at instead: {error}");
        }
        Folders {
            watcher: watcher.ok(),
            armed: BTreeSet::new(),
        }
    }

    /// Asks about the folders of these files, or about the nearest ones that are there.
    pub(super) fn arm(&mut self, watched: &Watched) {
        let Some(watcher) = &mut self.watcher else { return };
        let wanted = folders_of(watched);
        for folder in self.armed.difference(&wanted) {
            // One that is gone is forgotten already.
            let _ = watcher.unwatch(folder);
        }
        self.armed.retain(|folder| wanted.contains(folder));
        for folder in wanted {
            if self.armed.contains(&folder) {
                continue;
            }
            match watcher.watch(&folder, RecursiveMode::NonRecursive) {
                Ok(()) => {
                    self.armed.insert(folder);
                }
                Err(error) => tracing::debug!("{}: looked at instead of listened to: {error}", folder.display()),
            }
        }
    }

    /// Asks about nothing any more.
    pub(super) fn disarm(&mut self) {
        for folder in std::mem::take(&mut self.armed) {
            if let Some(watcher) = &mut self.watcher {
                let _ = watcher.unwatch(&folder);
            }
        }
    }
}

/// The folders in which something happens when one of these files changes, comes or goes.
fn folders_of(watched: &Watched) -> BTreeSet<PathBuf> {
    let mut folders = BTreeSet::new();
    let files = watched.graph.iter().chain(&watched.model).chain(&watched.files);
    for file in files {
        folders.extend(file.parent().and_then(nearest));
        // What a link leads to is written elsewhere.
        let target = fs::canonicalize(file).ok();
        folders.extend(target.as_deref().and_then(Path::parent).and_then(nearest));
        folders.extend(target.filter(|target| target.is_dir()));
    }
    for folder in &watched.nodes {
        folders.extend(folder.parent().and_then(nearest));
        folders.extend(nearest(folder));
        folders.extend(subfolders(folder).filter_map(|folder| fs::canonicalize(folder).ok()));
    }
    folders
}

/// A folder, or the first one above it that is there.
fn nearest(folder: &Path) -> Option<PathBuf> {
    let whole = std::path::absolute(if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    });
    let whole = whole.ok()?;
    whole.ancestors().find_map(|folder| {
        let found = fs::canonicalize(folder).ok()?;
        found.is_dir().then_some(found)
    })
}
