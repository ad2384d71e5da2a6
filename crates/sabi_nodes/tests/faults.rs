//! Every file in `tests/faults/` gives exactly the text beside it.

#![allow(clippy::unwrap_used, reason = "a test that cannot read its own files has failed")]

use std::path::{Path, PathBuf};
use std::{env, fs};

use sabi_nodes::{Libraries, Library, SourceFile, read_kind};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/faults")
}

fn wgsl_files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "wgsl"));
    files.sort();
    files
}

fn stem(file: &Path) -> String {
    file.file_stem().unwrap().to_str().unwrap().to_owned()
}

/// Returns the real `core`, and small libraries that only these tests use, so that no text changes when a library is added.
fn libraries() -> Libraries {
    let (_, built_in) = Library::builtin_files();
    let mut libraries = Libraries::default();
    libraries
        .0
        .insert("core".to_owned(), built_in.text("core").unwrap().to_owned());
    for file in wgsl_files(&folder().join("lib")) {
        libraries.0.insert(stem(&file), fs::read_to_string(&file).unwrap());
    }
    libraries
}

/// Returns the faults of a file as one text.
fn faults_of(file: &Path, libraries: &Libraries) -> String {
    let name = stem(file);
    let source = SourceFile {
        path: PathBuf::from(format!("faults/{name}.wgsl")),
        id: format!("faults/{name}"),
        text: fs::read_to_string(file).unwrap(),
    };
    match read_kind(&source, libraries) {
        Ok(_) => "no fault\n".to_owned(),
        Err(faults) => {
            let texts: Vec<String> = faults.iter().map(|fault| format!("{fault}\n")).collect();
            texts.join("\n")
        }
    }
}

#[test]
fn every_faulty_node_gives_exactly_the_expected_text() {
    let libraries = libraries();
    let bless = env::var_os("BLESS").is_some();
    let mut wrong = Vec::new();
    let files = wgsl_files(&folder());
    assert!(files.len() >= 20);
    for file in &files {
        let actual = faults_of(file, &libraries);
        let expected_path = file.with_extension("txt");
        let expected = fs::read_to_string(&expected_path).unwrap_or_default();
        if actual == "no fault\n" || (actual != expected && !bless) {
            wrong.push(format!(
                "{}.wgsl gives:\n{actual}\nand should give:\n{expected}",
                stem(file)
            ));
        } else if actual != expected {
            fs::write(&expected_path, actual).unwrap();
        }
    }
    assert!(
        wrong.is_empty(),
        "{}\nWhere the new texts are right: BLESS=1 cargo test -p sabi_nodes --test faults",
        wrong.join("\n\n")
    );
}

#[test]
fn every_expected_text_belongs_to_a_faulty_node() {
    for entry in fs::read_dir(folder()).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "txt") {
            assert!(path.with_extension("wgsl").is_file(), "{} has no node", path.display());
        }
    }
}
