//! Lists the files of `shaders/`, so that adding a node or a shared file is adding a file.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let Some(crate_dir) = env::var_os("CARGO_MANIFEST_DIR") else {
        return Err(io::Error::other("cargo sets CARGO_MANIFEST_DIR"));
    };
    let Some(out_dir) = env::var_os("OUT_DIR") else {
        return Err(io::Error::other("cargo sets OUT_DIR"));
    };
    let shaders = Path::new(&crate_dir).join("../../shaders");
    let mut list = String::from(
        "/// Node files: path in the repository, id, text.\npub(super) const NODES: &[(&str, &str, &str)] = &[\n",
    );
    for category in entries(&shaders.join("nodes"))? {
        if !category.is_dir() {
            continue;
        }
        for file in entries(&category)? {
            if let Some(name) = stem(&file) {
                let Some(category) = category.file_name() else { continue };
                let category = category.to_string_lossy().into_owned();
                let path = format!("shaders/nodes/{category}/{name}.wgsl");
                let id = format!("{category}/{name}");
                list += &format!("    ({path:?}, {id:?}, include_str!({:?})),\n", file.canonicalize()?);
            }
        }
    }
    list += "];\n\n/// Libraries: name, text.\npub(super) const LIBRARIES: &[(&str, &str)] = &[\n";
    for file in entries(&shaders.join("lib"))? {
        if let Some(name) = stem(&file) {
            list += &format!("    ({name:?}, include_str!({:?})),\n", file.canonicalize()?);
        }
    }
    list += "];\n\n/// Files of Sabi's own kernels and pictures: name, text.\npub(super) const SHADERS: &[(&str, &str)] = &[\n";
    for folder in ["surface", "view"] {
        for file in entries(&shaders.join(folder))? {
            if let Some(name) = stem(&file) {
                let name = format!("{folder}/{name}");
                list += &format!("    ({name:?}, include_str!({:?})),\n", file.canonicalize()?);
            }
        }
    }
    list += "];\n";
    fs::write(Path::new(&out_dir).join("shaders.rs"), list)
}

/// Lists a folder's entries in sorted order. Tells cargo to run the build script again when the folder changes.
fn entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
    println!("cargo::rerun-if-changed={}", folder.display());
    let mut entries = fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<io::Result<Vec<_>>>()?;
    entries.sort();
    Ok(entries)
}

/// The name of a WGSL file without its ending.
fn stem(file: &Path) -> Option<String> {
    (file.extension()? == "wgsl").then(|| file.file_stem().map(|stem| stem.to_string_lossy().into_owned()))?
}
