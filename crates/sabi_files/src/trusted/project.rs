//! The project that a folder belongs to.

use std::path::Path;

/// Entries that mark the root of a project.
const MARKS: [&str; 2] = [".git", "sabi.toml"];

/// Returns the nearest folder, from a canonical one upwards, that holds a mark of a project. The home folder and what is above it
/// are none: many keep their settings in a repository there, and it holds everything that must not leave.
pub(super) fn project_of<'f>(folder: &'f Path, home: Option<&Path>) -> Option<&'f Path> {
    let home = home.and_then(|home| home.canonicalize().ok());
    let is_project = |folder: &&Path| {
        let is_above_home = home.as_ref().is_some_and(|home| home.starts_with(folder));
        folder.parent().is_some() && !is_above_home && MARKS.iter().any(|mark| folder.join(mark).exists())
    };
    folder.ancestors().find(is_project)
}
