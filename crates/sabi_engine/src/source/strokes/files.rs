//! Files of strokes: searched beside a graph, read, and appended to.

use std::path::{Path, PathBuf};

use sabi_files::Unread;
use sabi_paint::Version;
use sabi_paint::file::{FILE_LIMIT_BYTES, StoreError, read, store};

use super::{StrokeFile, StrokesState, base_of, picture_folder, stamp, stroke_file};

impl StrokesState {
    /// Returns the file of the strokes on a model: the existing one, otherwise one named after the model. If another model
    /// has a file whose name differs only by case, the name ends in a hash of the model's name, since on many disks both
    /// names would mean the same file.
    pub(super) fn file_of(&self, folder: &Path, model: &str) -> PathBuf {
        let plain = stroke_file(folder, model);
        let hash = blake3::hash(model.as_bytes()).to_hex();
        let apart = stroke_file(folder, &format!("{model} {}", &hash[..8]));
        let is_own = |path: &PathBuf| {
            let file = self.files.get(path);
            file.is_some_and(|file| file.model.as_deref() == Some(model))
        };
        if is_own(&plain) {
            return plain;
        }
        let name = |path: &Path| path.file_name().map(|name| name.to_string_lossy().to_lowercase());
        let is_taken = self.files.iter().any(|(path, file)| {
            let is_other = file.model.as_ref().is_some_and(|other| other != model);
            is_other && path.parent() == Some(folder) && name(path) == name(&plain)
        });
        if is_taken || is_own(&apart) { apart } else { plain }
    }

    /// Stores the strokes of a version, if they are known, in the file of their model.
    pub(super) fn store(&mut self, folder: &Path, version: Version) -> Result<(), String> {
        let Some(model) = self.models.get(&version).cloned() else {
            return Ok(());
        };
        self.check_folders(folder)?;
        // Pictures are stored before the strokes, so that strokes on the disk always have their pictures.
        if let Some(list) = self.book.list(version) {
            self.store_pictures(folder, &list)?;
        }
        self.read_folder(folder);
        let path = self.file_of(folder, &model);
        // A file that another program changed, moved or repaired is read again.
        let known = self.files.get(&path);
        if known.is_none_or(|known| known.fault.is_some() || known.stamp != stamp(&path)) {
            self.read_file(&path);
        }
        let StrokesState { book, files, disk, .. } = self;
        let file = files.entry(path.clone()).or_default();
        if file.stored.contains(&version) {
            return Ok(());
        }
        if let Some(fault) = &file.fault {
            return Err(format!("strokes are not stored, since {fault}; move the file away"));
        }
        let stored = store(disk, &path, &model, book, version, &mut file.stored);
        // If writing failed, the file is read again before the next write.
        file.stamp = if stored.is_ok() { stamp(&path) } else { None };
        if stored.is_ok() {
            file.model = Some(model);
        }
        stored.map_err(|error: StoreError| format!("strokes are not stored: {error}"))
    }

    /// Checks that the folders of strokes and of pictures, if they exist, do not lead where the graph may not read. Nothing
    /// is written there either.
    fn check_folders(&self, folder: &Path) -> Result<(), String> {
        let base = base_of(folder);
        for place in [folder.to_owned(), picture_folder(folder)] {
            if let Err(Unread::Refused(refusal)) = self.trusted.check_place(&base, &place) {
                return Err(format!("strokes are not stored: {refusal}"));
            }
        }
        Ok(())
    }

    /// Reads the stroke files of a folder that were not read yet.
    pub(super) fn read_folder(&mut self, folder: &Path) {
        let Ok(entries) = std::fs::read_dir(folder) else {
            return;
        };
        let files = entries.filter_map(|entry| Some(entry.ok()?.path()));
        let mut files: Vec<PathBuf> = files
            .filter(|file| file.extension().is_some_and(|ending| ending == "strokes"))
            .collect();
        files.sort();
        for file in files {
            if self.files.get(&file).is_none_or(|known| known.stamp != stamp(&file)) {
                self.read_file(&file);
            }
        }
    }

    pub(super) fn read_file(&mut self, path: &Path) {
        let shown = path.display();
        // The stamp is read before the content, so that a file that is written in the meantime counts as changed the next time.
        let mut file = StrokeFile {
            stamp: stamp(path),
            ..StrokeFile::default()
        };
        let folder = path.parent().unwrap_or(Path::new("")); // Every file of strokes is in a folder.
        match self.read_below(folder, path, FILE_LIMIT_BYTES) {
            // Writing would create the file to which the link leads.
            Err(Unread::Missing) if path.is_symlink() => {
                file.fault = Some(format!("{shown} is a link to a file that does not exist"));
            }
            Err(Unread::Missing) => {}
            Err(Unread::TooLarge(bytes)) => {
                file.fault = Some(format!(
                    "{shown} has {} MiB; at most {} are read",
                    bytes >> 20,
                    FILE_LIMIT_BYTES >> 20
                ))
            }
            Err(Unread::Folder | Unread::NotPlain) => file.fault = Some(format!("{shown} is no ordinary file")),
            Err(Unread::Refused(refusal)) => file.fault = Some(format!("{shown} is not read: {refusal}")),
            Err(Unread::Other(reason)) => file.fault = Some(format!("{shown} cannot be read: {reason}")),
            Ok(bytes) => match read(&bytes, &mut self.book) {
                Err(error) => file.fault = Some(format!("{shown} cannot be used: {error}")),
                Ok(strokes) => {
                    file.model = Some(strokes.model.clone());
                    let damaged = strokes.damaged_bytes;
                    if damaged > 0 {
                        file.fault = Some(format!(
                            "{shown} is damaged: {damaged} of {} bytes are lost",
                            bytes.len()
                        ));
                        file.whole = strokes.last;
                    }
                    for version in &strokes.versions {
                        self.models.insert(*version, strokes.model.clone());
                    }
                    file.stored = strokes.versions;
                }
            },
        }
        self.files.insert(path.to_owned(), file);
    }
}
