//! Files of the project, as its rules read them.

use std::path::{Path, PathBuf};
use std::{fs, io};

/// Root folder of the project.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Paths of all files below a folder of the project, relative to the root and sorted; build outputs are left out.
pub fn files_below(folder: &str) -> Vec<String> {
    let mut found = Vec::new();
    collect(folder, &mut found).unwrap_or_else(|error| panic!("{folder} cannot be listed: {error}."));
    found.sort();
    found
}

fn collect(folder: &str, found: &mut Vec<String>) -> io::Result<()> {
    for entry in fs::read_dir(root().join(folder))? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = if folder == "." {
            name
        } else {
            format!("{folder}/{name}")
        };
        if !entry.file_type()?.is_dir() {
            found.push(path);
        } else if !matches!(
            path.as_str(),
            "target" | "out" | ".git" | "fuzz/target" | "fuzz/corpus" | "fuzz/artifacts"
        ) {
            collect(&path, found)?;
        }
    }
    Ok(())
}

/// Extension of a path without its dot; empty for a path without one.
pub fn ending(path: &str) -> &str {
    Path::new(path)
        .extension()
        .and_then(|ending| ending.to_str())
        .unwrap_or("")
}

/// True for files of Rust and WGSL.
pub fn is_code(path: &str) -> bool {
    matches!(ending(path), "rs" | "wgsl")
}

/// Text of a file of the project; fails the test if it cannot be read.
pub fn text_of(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path} cannot be read as text: {error}."))
}

/// Fails the test with all faults, one on a line, if there are any.
pub fn assert_none(faults: Vec<String>) {
    assert!(faults.is_empty(), "\n{}\n", faults.join("\n"));
}
