//! Files that a matrix names, also by patterns.

use std::path::PathBuf;

use glob::{MatchOptions, Pattern};
use sabi_files::PathBase;

/// A file as a matrix names it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct WrittenFile {
    /// Path from the folder of the matrix, with `/` between folders.
    pub(super) written: String,
    /// Path.
    pub(super) path: PathBuf,
}

/// Names of files in a pattern, as shells have them.
const SHELL: MatchOptions = MatchOptions {
    case_sensitive: true,
    require_literal_separator: true,
    require_literal_leading_dot: true,
};

impl WrittenFile {
    /// The file's name without folder and ending.
    pub(super) fn stem(&self) -> String {
        let stem = self.path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        // Files have names; what has none is refused when it is read.
        stem.unwrap_or_default()
    }
}

/// Finds the files of paths and patterns, each once, in the order in which they are named; those of a pattern by name.
///
/// # Errors
/// A clause: a pattern fits no file, or is none.
pub(super) fn written_files(base: &PathBase, patterns: &[String]) -> Result<Vec<WrittenFile>, String> {
    let mut files: Vec<WrittenFile> = Vec::new();
    for written in patterns {
        let path = base.resolve(written);
        let found = match written.contains(['*', '?']) && !path.exists() {
            true => matching(base, written)?,
            false => vec![WrittenFile {
                written: written.replace('\\', "/"),
                path,
            }],
        };
        for file in found {
            if !files.iter().any(|known| known.path == file.path) {
                files.push(file);
            }
        }
    }
    Ok(files)
}

fn matching(base: &PathBase, written: &str) -> Result<Vec<WrittenFile>, String> {
    let folder = base.folder();
    // A folder may have letters that mean something in a pattern.
    let escaped = Pattern::escape(&folder.to_string_lossy());
    let whole = match escaped.is_empty() || written.starts_with('/') {
        true => written.to_owned(),
        false => format!("{escaped}/{written}"),
    };
    let found = glob::glob_with(&whole, SHELL).map_err(|error| format!("'{written}' is no pattern: {}", error.msg))?;
    // What cannot be read cannot be baked.
    let found = found.filter_map(Result::ok).filter(|path| path.is_file());
    let files: Vec<WrittenFile> = found
        .map(|path| {
            let below = path.strip_prefix(folder).unwrap_or(&path);
            WrittenFile {
                written: below.to_string_lossy().replace('\\', "/"),
                path,
            }
        })
        .collect();
    match files.is_empty() {
        true => Err(format!("no file fits '{written}'")),
        false => Ok(files),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_pattern_gives_its_files_by_name_and_each_file_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let root = folder.path().join("odd [1]");
        for file in [
            "m/b2.glb",
            "m/b10.glb",
            "m/b1.glb",
            "m/.b0.glb",
            "m/deep/b3.glb",
            "m/a.txt",
        ] {
            let path = root.join(file);
            fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            fs::write(path, "").expect("written");
        }
        let base = PathBase::of_folder(&root);
        let of = |patterns: &[&str]| {
            let patterns: Vec<String> = patterns.iter().map(|text| (*text).to_owned()).collect();
            let files = written_files(&base, &patterns)?;
            Ok::<_, String>(files.into_iter().map(|file| file.written).collect::<Vec<_>>())
        };
        let names = |names: &[&str]| Ok(names.iter().map(|name| (*name).to_owned()).collect());
        assert_eq!(of(&["m/b*.glb"]), names(&["m/b1.glb", "m/b10.glb", "m/b2.glb"]));
        assert_eq!(of(&["m/b2.glb", "m/b?.glb"]), names(&["m/b2.glb", "m/b1.glb"]));
        assert_eq!(of(&["**/b3.glb"]), names(&["m/deep/b3.glb"]));
        assert_eq!(of(&["gone.glb"]), names(&["gone.glb"]), "whoever reads it says so");
        assert_eq!(of(&["m/c*.glb"]), Err("no file fits 'm/c*.glb'".to_owned()));
    }
}
