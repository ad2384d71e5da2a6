//! The shader files that are part of the program, and the libraries that nodes use.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::LazyLock;

/// A file of `shaders/`.
struct ShaderFile {
    /// Path below `shaders/` without the ending: `nodes/<category>/<name>`, `lib/<name>`, `source/<name>`, `surface/<name>` or
    /// `view/<name>`.
    path: String,
    text: String,
}

/// All files, sorted by folder and name.
fn shader_files() -> impl Iterator<Item = &'static ShaderFile> {
    static FILES: LazyLock<Vec<ShaderFile>> = LazyLock::new(read_shader_files);
    FILES.iter()
}

#[cfg(shaders_included)]
mod included {
    include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
}

#[cfg(shaders_included)]
fn read_shader_files() -> Vec<ShaderFile> {
    let file = |&(path, text): &(&str, &str)| ShaderFile {
        path: path.to_owned(),
        text: text.to_owned(),
    };
    included::FILES.iter().map(file).collect()
}

/// Reads the files from the source tree that the program was built from.
#[cfg(not(shaders_included))]
fn read_shader_files() -> Vec<ShaderFile> {
    let shaders = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shaders");
    let read = || {
        let files = crate::shader_list::list(&shaders)?.into_iter().map(|(path, file)| {
            let text = std::fs::read_to_string(file)?;
            Ok(ShaderFile { path, text })
        });
        files.collect::<std::io::Result<Vec<ShaderFile>>>()
    };
    // Only people who build Sabi run debug builds, and they have the source tree.
    read().unwrap_or_else(|error| {
        let shaders = shaders.display();
        panic!("A debug build reads its shaders from {shaders}: {error}. A release build includes them.")
    })
}

/// Returns the node files: path in the repository, id, text.
pub(crate) fn node_files() -> impl Iterator<Item = (PathBuf, &'static str, &'static str)> {
    shader_files().filter_map(|file| {
        let id = file.path.strip_prefix("nodes/")?;
        Some((
            PathBuf::from(format!("shaders/{}.wgsl", file.path)),
            id,
            file.text.as_str(),
        ))
    })
}

/// The library that is linked to every node automatically.
pub(crate) const CORE: &str = "core";

/// Returns the path by which messages refer to a shared file, from its name in `@use`.
pub(crate) fn shared_path(name: &str) -> PathBuf {
    PathBuf::from(if name.contains('/') {
        format!("{name}.wgsl")
    } else {
        format!("lib/{name}.wgsl")
    })
}

/// Text of a shared file by its name in `@use`.
pub(crate) fn shared_text<'a>(name: &str, libraries: &'a Libraries) -> Option<&'a str> {
    if name.contains('/') {
        shader_text(name)
    } else {
        libraries.text(name)
    }
}

/// Returns the text of a file of `source/`, `surface/` or `view/` by its name in `@use`, such as `surface/place`.
fn shader_text(name: &str) -> Option<&'static str> {
    let found = shaders().find(|file| file.path == name);
    found.map(|file| file.text.as_str())
}

/// Names of the files of `source/`, `surface/` and `view/`, sorted.
pub(crate) fn shader_names() -> impl Iterator<Item = &'static str> {
    shaders().map(|file| file.path.as_str())
}

/// Returns the files for Sabi's own kernels and for rendering.
fn shaders() -> impl Iterator<Item = &'static ShaderFile> {
    let folders = ["source/", "surface/", "view/"];
    shader_files().filter(move |file| folders.iter().any(|folder| file.path.starts_with(folder)))
}

/// Texts that nodes may use, by name (`noise` is `lib/noise.wgsl`). `core` is linked to every node automatically.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Libraries(pub BTreeMap<String, String>);

impl Libraries {
    /// Returns the built-in libraries.
    pub fn builtin() -> &'static Libraries {
        static BUILT_IN: LazyLock<Libraries> = LazyLock::new(|| {
            let texts = shader_files().filter_map(|file| {
                let name = file.path.strip_prefix("lib/")?;
                Some((name.to_owned(), file.text.clone()))
            });
            Libraries(texts.collect())
        });
        &BUILT_IN
    }

    /// The text of a library.
    pub fn text(&self, name: &str) -> Option<&str> {
        self.0.get(name).map(String::as_str)
    }

    /// Names of all libraries, sorted.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }
}
