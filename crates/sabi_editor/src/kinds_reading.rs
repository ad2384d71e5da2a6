//! Reading of node files on a thread of its own, since it may take long and must not block the window.

use std::path::PathBuf;
use std::time::Duration;

use egui::Context;
use sabi_editing::{OpenDocument, trust};
use sabi_engine::Kinds;

use crate::task::Task;

/// Time that a frame waits for files which are read soon, so that a graph is seldom shown without its nodes.
const PROMPT: Duration = Duration::from_millis(100);

/// Folders to read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct WantedFolders {
    folders: Vec<PathBuf>,
    /// True if all kinds that were read before are discarded, as for another graph.
    is_first: bool,
}

struct KindsTask {
    task: Task<Kinds>,
    wanted: WantedFolders,
    /// Revision of the document's kinds when the reading began.
    revision: u64,
}

/// The reading of node files that is under way, and the folders that are read after it.
#[derive(Default)]
pub(crate) struct KindsReading {
    running: Option<KindsTask>,
    wanted: Option<WantedFolders>,
}

impl KindsReading {
    /// Reads all folders of a document that was opened with the built-in kinds.
    pub(crate) fn read_opened(&mut self, context: &Context, document: &mut OpenDocument) {
        self.wanted = None;
        let folders = trust::node_folders(document);
        if folders.iter().any(|folder| folder.is_dir()) {
            self.read_first(context, document);
        }
    }

    /// Reads all folders of a document that has another folder now.
    pub(crate) fn read_first(&mut self, context: &Context, document: &mut OpenDocument) {
        self.wanted = Some(WantedFolders {
            folders: trust::node_folders(document),
            is_first: true,
        });
        self.follow(context, document, PROMPT);
    }

    /// Reads folders again whose files have changed.
    pub(crate) fn read_again(&mut self, context: &Context, document: &mut OpenDocument, folders: &[PathBuf]) {
        let wanted = self.wanted.get_or_insert_default();
        for folder in folders {
            if !wanted.folders.contains(folder) {
                wanted.folders.push(folder.clone());
            }
        }
        self.follow(context, document, PROMPT);
    }

    /// Gives the document the kinds that were read, and begins the next reading.
    pub(crate) fn take(&mut self, context: &Context, document: &mut OpenDocument) {
        self.follow(context, document, Duration::ZERO);
    }

    fn follow(&mut self, context: &Context, document: &mut OpenDocument, patience: Duration) {
        self.end(document, Duration::ZERO);
        if self.running.is_none()
            && let Some(wanted) = self.wanted.take()
        {
            let known = document.node_kinds();
            let revision = known.revision;
            let mut kinds = match wanted.is_first {
                true => Kinds::builtin(),
                false => Kinds::clone(&known.kinds),
            };
            let folders = wanted.folders.clone();
            kinds.trust(&document.session.graph().trusted);
            let task = Task::start(context, move || {
                kinds.reread(&folders);
                kinds
            });
            self.running = Some(KindsTask { task, wanted, revision });
            self.end(document, patience);
        }
    }

    /// Ends the reading that is under way if it is done within this time.
    fn end(&mut self, document: &mut OpenDocument, patience: Duration) {
        let Some(running) = &self.running else { return };
        let Some(read) = running.task.wait(patience) else {
            return;
        };
        let is_first = running.wanted.is_first;
        // Kinds that were read for another graph are of no use.
        let is_wanted = running.revision == document.node_kinds().revision;
        self.running = None;
        match read {
            Ok(kinds) if is_wanted && is_first => document.first_kinds(kinds),
            Ok(kinds) if is_wanted => document.replace_kinds(kinds),
            Ok(_) => {}
            Err(_) => document.notify("The node files could not be read: the reader broke off."),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::time::Instant;

    use sabi_engine::Session;

    use super::*;

    const OWN: &str = "//! Own\n//! A test.\n\n/// M.\nfn mask(at: Surface) -> f32 { return 0.5; }\n";

    fn has(document: &OpenDocument, id: &str) -> bool {
        document.node_kinds().kinds.library.kind(id).is_some()
    }

    #[test]
    fn kinds_that_are_read_for_a_graph_are_not_given_to_the_next_one() {
        let folder = tempfile::tempdir().expect("a folder");
        fs::create_dir_all(folder.path().join("own")).expect("a folder");
        fs::write(folder.path().join("own/half.wgsl"), OWN).expect("a file");
        let folders = [folder.path().to_owned()];
        let (context, mut reading) = (Context::default(), KindsReading::default());
        let mut document = OpenDocument::before_kinds(Session::new(None));
        let wanted = |reading: &mut KindsReading| {
            reading.wanted = Some(WantedFolders {
                folders: folders.to_vec(),
                is_first: false,
            })
        };
        let until = |reading: &mut KindsReading, document: &mut OpenDocument| {
            let began = Instant::now();
            while reading.running.is_some() {
                assert!(began.elapsed() < Duration::from_secs(60), "it is read");
                reading.take(&context, document);
                std::thread::yield_now();
            }
        };
        wanted(&mut reading);
        reading.follow(&context, &mut document, Duration::ZERO);
        until(&mut reading, &mut document);
        assert!(has(&document, "own/half"));
        wanted(&mut reading);
        reading.follow(&context, &mut document, Duration::ZERO);
        let mut next = OpenDocument::before_kinds(Session::new(None));
        until(&mut reading, &mut next);
        assert!(!has(&next, "own/half"));
        // A folder that changes while it is read is read once more.
        fs::remove_file(folder.path().join("own/half.wgsl")).expect("a file");
        reading.read_again(&context, &mut document, &folders);
        until(&mut reading, &mut document);
        assert!(!has(&document, "own/half"));
    }
}
