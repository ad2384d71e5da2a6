//! The list of the files of `shaders/`. The build script uses it to embed them, and debug builds use it to read them at run time.

use std::path::{Path, PathBuf};
use std::{fs, io};

/// Lists the WGSL files, each with its path below `shaders/` without the ending, and its full path. Sorted by folder and name.
///
/// # Errors
/// A folder cannot be read.
pub(crate) fn list(shaders: &Path) -> io::Result<Vec<(String, PathBuf)>> {
    let mut folders: Vec<String> = ["lib", "source", "surface", "view"].map(str::to_owned).to_vec();
    for category in sorted_entries(&shaders.join("nodes"))? {
        if category.is_dir()
            && let Some(name) = category.file_name()
        {
            folders.push(format!("nodes/{}", name.to_string_lossy()));
        }
    }
    let mut files = Vec::new();
    for folder in folders {
        for file in sorted_entries(&shaders.join(&folder))? {
            if file.extension().is_some_and(|ending| ending == "wgsl")
                && let Some(name) = file.file_stem().map(|name| name.to_string_lossy().into_owned())
                // Editors create hidden files beside files that are open in them.
                && !name.starts_with('.')
            {
                files.push((format!("{folder}/{name}"), file));
            }
        }
    }
    Ok(files)
}

fn sorted_entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut entries = fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<io::Result<Vec<_>>>()?;
    entries.sort();
    Ok(entries)
}
