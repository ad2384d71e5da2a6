//! Any text is a node or a list of faults that point into it.
#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use sabi_nodes::{Libraries, Library, SourceFile, read_kind};

static LIBRARIES: LazyLock<Libraries> = LazyLock::new(|| Library::builtin_files().1);

fuzz_target!(|text: &str| {
    let file = SourceFile {
        path: PathBuf::from("noise/own.wgsl"),
        id: "noise/own".to_owned(),
        text: text.to_owned(),
    };
    match read_kind(&file, &LIBRARIES) {
        Ok(kind) => assert!(!kind.outputs.is_empty(), "a node gives something"),
        Err(faults) => assert!(!faults.is_empty(), "a refusal has a reason"),
    }
});
