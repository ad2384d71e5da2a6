use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use tempfile::TempDir;

use super::{Changes, Message, Pending, Watched, Watcher, settle};

/// Much longer than any system takes to report an event. It is reached only after a mistake.
const PATIENCE: Duration = Duration::from_secs(60);

/// A watcher of files in its own folder.
struct Watch {
    folder: TempDir,
    watcher: Watcher,
    woken: Receiver<()>,
}

impl Watch {
    /// Creates a watcher of `graph.sabi`, `nodes`, the model `model.gltf` with `model.bin`, and the pictures `rust.png` and
    /// `far/away.png`. Only the files in `there` exist.
    fn of(there: &[&str]) -> Watch {
        let folder = tempfile::tempdir().expect("a folder");
        let (wake, woken) = channel();
        let watcher = Watcher::new(move || {
            // Sending fails once the test has ended, which does not matter.
            let _ = wake.send(());
        });
        let watch = Watch {
            watcher: watcher.expect("a watcher"),
            folder,
            woken,
        };
        for file in there {
            watch.write(file, "as it was");
        }
        watch.take(watch.all());
        watch
    }

    /// Watches these from now on.
    fn take(&self, watched: Watched) {
        self.watcher.watch(watched);
        while !self.watcher.is_watching() {
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    fn all(&self) -> Watched {
        Watched {
            graph: Some(self.path("graph.sabi")),
            nodes: vec![self.path("nodes")],
            model: vec![self.path("model.gltf"), self.path("model.bin")],
            files: vec![self.path("rust.png"), self.path("far/away.png")],
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file in one step, like careful editors: by putting another file in its place.
    fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(self.path("draft"), text).expect("a draft");
        fs::rename(self.path("draft"), path).expect("a file");
    }

    /// Returns all changes up to one that `is_meant` selects. Earlier changes must be a part of it.
    fn until(&self, is_meant: impl Fn(&Changes) -> bool) -> Changes {
        let mut all = Changes::default();
        while !is_meant(&all) {
            self.woken.recv_timeout(PATIENCE).expect("a change");
            let more = self.watcher.changes();
            all.graph |= more.graph;
            all.nodes |= more.nodes;
            all.model |= more.model;
            all.files.extend(more.files);
        }
        all
    }

    fn file(&self, name: &str) -> BTreeSet<PathBuf> {
        BTreeSet::from([self.path(name)])
    }
}

const ALL: [&str; 6] = [
    "graph.sabi",
    "nodes/own/level.wgsl",
    "model.gltf",
    "model.bin",
    "rust.png",
    "far/away.png",
];

#[test]
fn what_changed_is_told_and_nothing_else() {
    let watch = Watch::of(&ALL);
    watch.write("rust.png", "as it is");
    let told = watch.until(|told| !told.files.is_empty());
    assert_eq!(
        told,
        Changes {
            files: watch.file("rust.png"),
            ..Changes::default()
        }
    );
    watch.write("model.bin", "as it is");
    assert_eq!(
        watch.until(|told| told.model),
        Changes {
            model: true,
            ..Changes::default()
        }
    );
    watch.write("nodes/own/level.wgsl", "as it is");
    assert_eq!(
        watch.until(|told| told.nodes),
        Changes {
            nodes: true,
            ..Changes::default()
        }
    );
    watch.write("graph.sabi", "as it is");
    assert_eq!(
        watch.until(|told| told.graph),
        Changes {
            graph: true,
            ..Changes::default()
        }
    );
    assert!(watch.watcher.changes().is_empty(), "each change is told once");
}

#[test]
fn what_lies_beside_is_of_no_interest() {
    let watch = Watch::of(&ALL);
    for name in [
        "graph.sabi.bak",
        "other.png",
        "nodes/notes.txt",
        "nodes/own/level.txt",
        "nodes/own/deep/a.wgsl",
    ] {
        watch.write(name, "new");
    }
    watch.write("rust.png", "as it is");
    let told = watch.until(|told| !told.files.is_empty());
    assert_eq!(
        told,
        Changes {
            files: watch.file("rust.png"),
            ..Changes::default()
        }
    );
}

#[test]
fn a_file_that_is_written_over_has_changed() {
    let watch = Watch::of(&ALL);
    for round in 0..3 {
        fs::write(watch.path("rust.png"), format!("round {round}")).expect("the same file");
        let told = watch.until(|told| !told.files.is_empty());
        assert_eq!(told.files, watch.file("rust.png"));
    }
}

#[test]
fn what_comes_later_is_noticed_with_all_its_folders() {
    let watch = Watch::of(&[]);
    watch.write("nodes/own/level.wgsl", "the first");
    watch.until(|told| told.nodes);
    watch.write("nodes/own/level.wgsl", "the second");
    watch.until(|told| told.nodes);
    watch.write("nodes/more/level.wgsl", "another one");
    watch.until(|told| told.nodes);
    watch.write("nodes/more/level.wgsl", "as it is");
    watch.until(|told| told.nodes);
    watch.write("far/away.png", "the first");
    assert_eq!(
        watch.until(|told| !told.files.is_empty()).files,
        watch.file("far/away.png")
    );
    watch.write("graph.sabi", "the first");
    watch.until(|told| told.graph);
}

#[test]
fn what_goes_is_noticed_and_what_comes_back() {
    let watch = Watch::of(&ALL);
    fs::remove_dir_all(watch.path("nodes")).expect("the nodes are gone");
    watch.until(|told| told.nodes);
    fs::remove_dir_all(watch.path("far")).expect("the picture is gone");
    watch.until(|told| !told.files.is_empty());
    watch.write("far/away.png", "it is back");
    watch.until(|told| !told.files.is_empty());
    watch.write("nodes/own/level.wgsl", "it is back");
    watch.until(|told| told.nodes);
}

#[test]
fn files_that_are_not_watched_any_more_are_let_go() {
    let watch = Watch::of(&ALL);
    watch.take(Watched {
        files: vec![watch.path("far/away.png")],
        ..Watched::default()
    });
    watch.write("rust.png", "as it is");
    watch.write("graph.sabi", "as it is");
    watch.write("far/away.png", "as it is");
    let told = watch.until(|told| !told.files.is_empty());
    assert_eq!(
        told,
        Changes {
            files: watch.file("far/away.png"),
            ..Changes::default()
        }
    );
}

#[test]
fn a_folder_of_a_model_stands_for_what_comes_into_it() {
    let watch = Watch::of(&ALL);
    watch.take(Watched {
        model: vec![watch.path("far")],
        ..Watched::default()
    });
    watch.write("far/model.bin", "what was missing");
    watch.until(|told| told.model);
}

#[cfg(unix)]
#[test]
fn a_link_changes_with_what_it_leads_to() {
    let watch = Watch::of(&["far/away.png", "other/place.png"]);
    std::os::unix::fs::symlink(watch.path("other/place.png"), watch.path("rust.png")).expect("a link");
    assert_eq!(watch.until(|told| !told.files.is_empty()).files, watch.file("rust.png"));
    watch.write("other/place.png", "as it is, elsewhere");
    assert_eq!(watch.until(|told| !told.files.is_empty()).files, watch.file("rust.png"));
}

#[test]
fn a_folder_that_never_rests_is_not_waited_for() {
    let (sender, messages) = channel();
    let mut pending = Pending::default();
    let has_settled = std::sync::atomic::AtomicBool::new(false);
    let is_over = || has_settled.load(std::sync::atomic::Ordering::Relaxed);
    std::thread::scope(|scope| {
        let writer = scope.spawn(move || {
            for _ in (0..5000).take_while(|_| !is_over()) {
                let path = Path::new("busy").to_owned();
                sender.send(Message::Reported(vec![path])).expect("somebody listens");
                std::thread::sleep(Duration::from_millis(1));
            }
            is_over()
        });
        // With a pause that never occurs, only the limit ends the wait before the writer stops.
        settle(
            &messages,
            &mut pending,
            Duration::from_secs(3600),
            Duration::from_millis(20),
        );
        has_settled.store(true, std::sync::atomic::Ordering::Relaxed);
        assert!(writer.join().expect("the writer"), "the wait ended with the writing");
    });
}
