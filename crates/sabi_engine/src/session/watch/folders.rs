//! Folders whose events the system reports.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::Sender;

use notify::event::{EventKind, ModifyKind};
use notify::{RecommendedWatcher, RecursiveMode, Watcher as _};

use super::snapshot::subfolders;
use super::{Message, Watched};

/// Folders whose events the system reports, by canonical path. Folders are watched instead of files, since many editors
/// replace a file when they save it.
pub(super) struct Folders {
    /// Watcher; `None` if the system has none, in which case polling finds changes.
    watcher: Option<RecommendedWatcher>,
    armed: BTreeSet<PathBuf>,
}

impl Folders {
    pub(super) fn new(inbox: Sender<Message>) -> Folders {
        let on_event = move |event: notify::Result<notify::Event>| {
            // An error means that the system's queue overflowed, so all files are checked.
            let event = event.unwrap_or_else(|_| notify::Event::new(EventKind::Any));
            let paths = match event.kind {
                EventKind::Access(_) => return,
                // Permissions and other metadata are not content.
                EventKind::Modify(ModifyKind::Metadata(_)) => Vec::new(),
                _ => event.paths,
            };
            // The channel is closed only when the watcher is dropped.
            let _ = inbox.send(Message::Reported(paths));
        };
        let watcher = notify::recommended_watcher(on_event);
        if let Err(error) = &watcher {
            tracing::warn!("the system reports no changes of files, so they are polled instead: {error}");
        }
        Folders {
            watcher: watcher.ok(),
            armed: BTreeSet::new(),
        }
    }

    /// Watches the folders of these files, or their nearest existing parent folders.
    pub(super) fn arm(&mut self, watched: &Watched) {
        let Some(watcher) = &mut self.watcher else { return };
        let wanted = folders_of(watched);
        for folder in self.armed.difference(&wanted) {
            // The system has already stopped watching a folder that no longer exists.
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
                Err(error) => tracing::debug!("{}: polled, because it cannot be watched: {error}", folder.display()),
            }
        }
    }

    /// Stops watching.
    pub(super) fn disarm(&mut self) {
        for folder in std::mem::take(&mut self.armed) {
            if let Some(watcher) = &mut self.watcher {
                let _ = watcher.unwatch(&folder);
            }
        }
    }
}

/// Lists the folders that receive an event when one of these files changes, appears or disappears.
fn folders_of(watched: &Watched) -> BTreeSet<PathBuf> {
    let mut folders = BTreeSet::new();
    let files = watched.graph.iter().chain(&watched.model).chain(&watched.files);
    for file in files {
        folders.extend(file.parent().and_then(nearest));
        // The target of a link is in another folder.
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

/// Returns a folder, or its nearest existing parent folder.
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
