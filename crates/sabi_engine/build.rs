//! Lists the pictures of nodes in `docs/nodes/`, so that whoever shows a node can show what it does.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let Some(crate_dir) = env::var_os("CARGO_MANIFEST_DIR") else {
        return Err(io::Error::other("cargo sets CARGO_MANIFEST_DIR"));
    };
    let Some(out_dir) = env::var_os("OUT_DIR") else {
        return Err(io::Error::other("cargo sets OUT_DIR"));
    };
    let pages = Path::new(&crate_dir).join("../../docs/nodes");
    let mut list =
        String::from("/// Pictures of the first results of nodes: id, PNG.\nconst PICTURES: &[(&str, &[u8])] = &[\n");
    for category in entries(&pages)?.iter().filter(|entry| entry.is_dir()) {
        for file in entries(category)? {
            if let (Some(name), Some(category)) = (first_result(&file), category.file_name()) {
                let id = format!("{}/{name}", category.to_string_lossy());
                list += &format!("    ({id:?}, include_bytes!({:?})),\n", file.canonicalize()?);
            }
        }
    }
    list += "];\n";
    fs::write(Path::new(&out_dir).join("pictures.rs"), list)
}

/// Lists the entries of a folder, sorted, and tells cargo to run this script again when the folder changes.
fn entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
    println!("cargo::rerun-if-changed={}", folder.display());
    let mut entries = fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<io::Result<Vec<_>>>()?;
    entries.sort();
    Ok(entries)
}

/// The name of the node whose first result a file shows: `dots` of `dots.png`, and none of `dots.id.png`.
fn first_result(file: &Path) -> Option<String> {
    let name = file
        .file_stem()
        .filter(|_| file.extension().is_some_and(|ending| ending == "png"))?;
    Some(name.to_string_lossy().into_owned()).filter(|name| !name.contains('.'))
}
