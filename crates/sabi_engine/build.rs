//! Includes the effect library in release builds. Debug builds read it from the project, so that a changed graph is tried without
//! compiling anything.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(library_included)");
    if variable("PROFILE")? != "release" {
        return Ok(());
    }
    println!("cargo::rustc-cfg=library_included");
    let library = Path::new(&variable("CARGO_MANIFEST_DIR")?).join("../../graphs/library");
    println!("cargo::rerun-if-changed={}", library.display());
    let mut text = String::from("/// Path and text of each file.\npub(super) const FILES: &[(&str, &str)] = &[\n");
    for category in entries(&library)? {
        let Some(name) = category.file_name().map(|name| name.to_string_lossy().into_owned()) else {
            continue;
        };
        if !category.is_dir() {
            continue;
        }
        for file in entries(&category)? {
            if file.extension().is_some_and(|ending| ending == "sabi")
                && let Some(stem) = file.file_name()
            {
                let path = format!("{name}/{}", stem.to_string_lossy());
                text += &format!("    ({path:?}, include_str!({:?})),\n", file.canonicalize()?);
            }
        }
    }
    text += "];\n";
    fs::write(Path::new(&variable("OUT_DIR")?).join("library.rs"), text)
}

fn entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path()));
    let mut entries = entries.collect::<io::Result<Vec<_>>>()?;
    entries.sort();
    Ok(entries)
}

fn variable(name: &str) -> io::Result<String> {
    env::var(name).map_err(|error| io::Error::other(format!("cargo sets {name}: {error}")))
}
