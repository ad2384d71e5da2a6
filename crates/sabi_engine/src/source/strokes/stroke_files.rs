//! Files of strokes beside a graph, and those that are missing.

use std::path::{Path, PathBuf};

use sabi_paint::PictureName;

use super::{Strokes, paint_folder, picture_folder, versions_of};

/// Files of strokes beside a graph, and of the pictures of their brushes, as paths from its paint folder.
pub(crate) fn files_beside(graph: &Path) -> Vec<String> {
    let folder = paint_folder(graph);
    let strokes = names_in(&folder).filter(|name| name.ends_with(".strokes") && folder.join(name).is_file());
    let pictures = picture_folder(&folder);
    let pictures = names_in(&pictures).filter(|name| PictureName::try_from(name.clone()).is_ok());
    let mut files: Vec<String> = strokes.chain(pictures.map(|name| format!("pictures/{name}"))).collect();
    files.sort();
    files
}

fn names_in(folder: &Path) -> impl Iterator<Item = String> + use<> {
    // A missing folder has no files. Missing strokes are reported by name.
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok())
}

impl Strokes {
    /// Returns the files that the strokes of these versions need and that are missing beside a graph, each with a description.
    pub(crate) fn lacking(&self, graph: &Path, written: &str) -> Vec<(PathBuf, String)> {
        let folder = paint_folder(graph);
        let mut lacking = Vec::new();
        for version in versions_of(written) {
            let is_known = self.lock().model_of(version).is_some();
            if !is_known {
                lacking.push((folder.clone(), format!("its strokes of version {version}")));
            }
            for name in self.missing_pictures(graph, version) {
                lacking.push((picture_folder(&folder), format!("the picture {name} of a brush")));
            }
        }
        lacking.dedup();
        lacking
    }
}
