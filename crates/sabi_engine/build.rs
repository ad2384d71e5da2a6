//! Includes the pictures of nodes in `docs/nodes/` and of groups in `docs/library/`, so that programs can show what each does. Release
//! builds also include the effect library. Debug builds read it from the project, so that a changed graph can be tried without compiling.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    println!("cargo::rustc-check-cfg=cfg(library_included)");
    let project = Path::new(&variable("CARGO_MANIFEST_DIR")?).join("../..");
    let out = PathBuf::from(variable("OUT_DIR")?);
    let pages = pictures(&project.join("docs/nodes"), first_result)?;
    fs::write(
        out.join("pictures.rs"),
        list("PICTURES", "Pictures of the first results of nodes: id, PNG.", &pages),
    )?;
    let mut groups = Vec::new();
    for file in entries(&project.join("docs/library"))? {
        groups.extend(first_result(&file).map(|name| (name, file)));
    }
    fs::write(
        out.join("group_pictures.rs"),
        list("GROUP_PICTURES", "Pictures of groups on models: name, PNG.", &groups),
    )?;
    if variable("PROFILE")? == "release" {
        println!("cargo::rustc-cfg=library_included");
        let graphs = pictures(&project.join("graphs/library"), graph_file)?;
        let text = list("FILES", "Path and text of each file.", &graphs);
        fs::write(out.join("library.rs"), text)?;
    }
    Ok(())
}

/// Files in the folders of a folder, as `folder/name`.
fn pictures(folder: &Path, name: fn(&Path) -> Option<String>) -> io::Result<Vec<(String, PathBuf)>> {
    let mut found = Vec::new();
    for category in entries(folder)?.iter().filter(|entry| entry.is_dir()) {
        for file in entries(category)? {
            if let (Some(name), Some(category)) = (name(&file), category.file_name()) {
                found.push((format!("{}/{name}", category.to_string_lossy()), file));
            }
        }
    }
    Ok(found)
}

/// A constant with the bytes of files by name.
fn list(constant: &str, says: &str, files: &[(String, PathBuf)]) -> String {
    let mut text = format!("/// {says}\nconst {constant}: &[(&str, &[u8])] = &[\n");
    for (name, file) in files {
        text += &format!("    ({name:?}, include_bytes!({file:?})),\n");
    }
    text + "];\n"
}

/// Lists the entries of a folder, sorted, and tells cargo to run this script again when the folder changes.
fn entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
    println!("cargo::rerun-if-changed={}", folder.display());
    let mut entries = fs::read_dir(folder.canonicalize()?)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<io::Result<Vec<_>>>()?;
    entries.sort();
    Ok(entries)
}

/// Returns the name of the node or group if a picture shows its first result: `dots` for `dots.png`, and `None` for `dots.id.png`.
fn first_result(file: &Path) -> Option<String> {
    let name = file
        .file_stem()
        .filter(|_| file.extension().is_some_and(|ending| ending == "png"))?;
    Some(name.to_string_lossy().into_owned()).filter(|name| !name.contains('.'))
}

fn graph_file(file: &Path) -> Option<String> {
    let name = file
        .file_name()
        .filter(|_| file.extension().is_some_and(|ending| ending == "sabi"))?;
    Some(name.to_string_lossy().into_owned())
}

fn variable(name: &str) -> io::Result<String> {
    env::var(name).map_err(|error| io::Error::other(format!("cargo sets {name}: {error}")))
}
