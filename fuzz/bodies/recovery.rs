//! Any file in the folder of recoveries is listed with what it holds, or with its fault, and nothing else is read or changed.

use std::fs;

use sabi_engine::session::recoveries;

pub fn survives(bytes: &[u8]) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("1-2-3.recovery");
    fs::write(&file, bytes).expect("a new file");
    let found = recoveries(folder.path());
    assert_eq!(found.len(), 1, "every file is listed");
    for recovery in found {
        if recovery.fault().is_some() {
            assert!(!recovery.has_graph() && recovery.drafts().is_empty());
        } else if let Some(document) = recovery.document() {
            assert!(recovery.graph_bytes().is_some());
            document.to_json();
        }
    }
    assert!(
        fs::read(&file).is_ok_and(|after| after == bytes),
        "it is kept as it was"
    );
}
