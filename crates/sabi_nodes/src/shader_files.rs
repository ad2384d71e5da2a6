//! The shader files that come with the program, and the libraries that nodes use.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::LazyLock;

mod built_in {
    include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
}

/// Node files: path in the repository, id, text.
pub(crate) const NODES: &[(&str, &str, &str)] = built_in::NODES;

/// The library that is linked to every node without being asked.
pub(crate) const CORE: &str = "core";

/// Path under which messages name a shared file, from its name in `@use`.
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

/// Text of a file of `surface/` or `view/` by its name in `@use`, such as `surface/place`.
fn shader_text(name: &str) -> Option<&'static str> {
    let found = built_in::SHADERS.iter().find(|(known, _)| *known == name);
    found.map(|(_, text)| *text)
}

/// Names of the files of `surface/` and `view/`, sorted.
pub(crate) fn shader_names() -> impl Iterator<Item = &'static str> {
    built_in::SHADERS.iter().map(|(name, _)| *name)
}

/// Texts that nodes may use, by name (`noise` is `lib/noise.wgsl`). `core` is linked to every node without being asked.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Libraries(pub BTreeMap<String, String>);

impl Libraries {
    /// Those that come with the program.
    pub fn builtin() -> &'static Libraries {
        static BUILT_IN: LazyLock<Libraries> = LazyLock::new(|| {
            let texts = built_in::LIBRARIES
                .iter()
                .map(|&(name, text)| (name.to_owned(), text.to_owned()));
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
