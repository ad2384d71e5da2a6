//! Any text is a node or a list of faults.

use std::path::PathBuf;
use std::sync::LazyLock;

use sabi_nodes::{Libraries, Library, SourceFile, read_kind};

static LIBRARIES: LazyLock<Libraries> = LazyLock::new(|| Library::builtin_files().1);

pub fn survives(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let file = SourceFile {
        path: PathBuf::from("noise/own.wgsl"),
        id: "noise/own".to_owned(),
        text: text.to_owned(),
    };
    match read_kind(&file, &LIBRARIES) {
        Ok(kind) => assert!(!kind.outputs.is_empty(), "a node gives something"),
        Err(faults) => assert!(!faults.is_empty(), "a refusal has a reason"),
    }
}
