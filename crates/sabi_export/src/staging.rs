//! Files that come into being all together: written under temporary names, renamed at the end.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::ExportError;

/// Temporary names tried before giving up; each may be left from a run that was killed.
const MOST_LEFT_OVER: u32 = 10_000;

/// A folder that files are being written to. Until [`Staging::commit`] nothing under their names is touched; dropping it
/// removes what was begun. A process that is ended without unwinding leaves hidden `.tmp` files, never half a map.
#[derive(Debug)]
pub struct Staging {
    folder: PathBuf,
    /// Temporary and final path, in the order of staging.
    files: Vec<(PathBuf, PathBuf)>,
    /// File names in use, lower case, as some file systems compare them.
    names: BTreeSet<String>,
    /// Files that must stay as they are, by their real paths.
    inputs: BTreeSet<PathBuf>,
    /// Folders made here, outermost first; removed again if they stay empty.
    created: Vec<PathBuf>,
}

impl Staging {
    /// Makes the folder if need be and tries whether files can be written there, so that a long bake does not find out at
    /// its end.
    pub fn create(folder: &Path) -> Result<Staging, ExportError> {
        let mut created: Vec<PathBuf> = folder
            .ancestors()
            .take_while(|part| !part.as_os_str().is_empty() && !part.exists())
            .map(Path::to_owned)
            .collect();
        created.reverse();
        let mut staging = Staging {
            folder: folder.to_owned(),
            files: Vec::new(),
            names: BTreeSet::new(),
            inputs: BTreeSet::new(),
            created,
        };
        // An empty path means the current folder.
        if !folder.as_os_str().is_empty() {
            let refuse = |source| ExportError::CreateFolder {
                path: folder.to_owned(),
                source,
            };
            fs::create_dir_all(folder).map_err(refuse)?;
        }
        staging.stage("probe", b"probe")?;
        staging.discard();
        staging.names.clear();
        Ok(staging)
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Names of the files so far, in lower case.
    pub fn names(&self) -> &BTreeSet<String> {
        &self.names
    }

    /// Names files that this work reads: to write over one of them is refused.
    pub fn protect(&mut self, inputs: impl IntoIterator<Item = PathBuf>) {
        // A file that is not there cannot be written over.
        self.inputs
            .extend(inputs.into_iter().filter_map(|path| path.canonicalize().ok()));
    }

    /// Whether a file may be written under a plain name: refused for one that is read, and for what is no file.
    pub fn check(&self, file_name: &str) -> Result<(), ExportError> {
        let target = self.folder.join(file_name);
        if Path::new(file_name).file_name().is_none_or(|name| name != file_name) {
            return Err(ExportError::write(&target, io::ErrorKind::InvalidFilename.into()));
        }
        if target.canonicalize().is_ok_and(|real| self.inputs.contains(&real)) {
            return Err(ExportError::Input { path: target });
        }
        if fs::metadata(&target).is_ok_and(|found| !found.is_file() && !found.is_dir()) {
            return Err(ExportError::NotAFile { path: target });
        }
        Ok(())
    }

    /// Writes a file completely, under a temporary name for now. `file_name` is a plain name without a folder.
    pub fn stage(&mut self, file_name: &str, bytes: &[u8]) -> Result<(), ExportError> {
        self.check(file_name)?;
        let target = self.folder.join(file_name);
        if !self.names.insert(file_name.to_lowercase()) {
            return Err(ExportError::SameName {
                file_name: file_name.to_owned(),
            });
        }
        let (mut file, temporary) = self
            .create_temporary(file_name)
            .map_err(|error| ExportError::write(&target, error))?;
        self.files.push((temporary, target.clone()));
        if let Ok(replaced) = fs::metadata(&target) {
            // Who may read and write it stays as it was, where the file system knows of that.
            let _ = file.set_permissions(replaced.permissions());
        }
        // Some file systems only find out here that there is no room.
        write_through(&mut file, bytes)
            .and_then(|()| file.sync_data())
            .map_err(|error| ExportError::write(&target, error))
    }

    fn create_temporary(&self, file_name: &str) -> io::Result<(File, PathBuf)> {
        for number in 0..MOST_LEFT_OVER {
            let path = self.folder.join(format!(".{file_name}.{number}.tmp"));
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => return Ok((file, path)),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(io::ErrorKind::AlreadyExists.into())
    }

    /// Puts all files in their places, each replacing what was there at once. Returns their paths in the order of staging.
    pub fn commit(mut self) -> Result<Vec<PathBuf>, ExportError> {
        let total = self.files.len();
        let refuse = |path: &Path, source, replaced| ExportError::Replace {
            path: path.to_owned(),
            source,
            replaced,
            total,
        };
        // What can be known to fail is found before the first file is touched.
        for (_, target) in &self.files {
            if fs::symlink_metadata(target).is_ok_and(|found| found.is_dir()) {
                return Err(refuse(target, io::ErrorKind::IsADirectory.into(), 0));
            }
        }
        let files = std::mem::take(&mut self.files);
        let mut placed = Vec::with_capacity(total);
        for (index, (temporary, target)) in files.iter().enumerate() {
            if let Err(source) = fs::rename(temporary, target) {
                // The rest is removed with this value.
                self.files = files[index..].to_vec();
                return Err(refuse(target, source, index));
            }
            placed.push(target.clone());
        }
        self.created.clear();
        Ok(placed)
    }

    fn discard(&mut self) {
        for (temporary, _) in self.files.drain(..) {
            // Nothing more can be done about one that stays.
            let _ = fs::remove_file(temporary);
        }
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        self.discard();
        for folder in self.created.iter().rev() {
            // Refused when something is in it, as it should be.
            let _ = fs::remove_dir(folder);
        }
    }
}

fn write_through(file: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    file.write_all(bytes)?;
    file.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_read_is_never_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let texture = folder.path().join("bottle_normal.png");
        fs::write(&texture, b"the artist's own").unwrap();
        let mut staging = Staging::create(folder.path()).unwrap();
        staging.protect([
            folder.path().join(".").join("bottle_normal.png"),
            folder.path().join("missing.png"),
        ]);
        let error = staging.stage("bottle_normal.png", b"baked").unwrap_err();
        assert!(matches!(error, ExportError::Input { .. }), "{error}");
        assert_eq!(
            error.to_string(),
            format!(
                "{} is read by this very bake and would be replaced by its own result",
                texture.display()
            )
        );
        staging.stage("bottle_height.png", b"baked").unwrap();
        staging.commit().unwrap();
        assert_eq!(fs::read(&texture).unwrap(), b"the artist's own");
    }

    #[cfg(unix)]
    #[test]
    fn what_is_no_file_is_not_replaced_by_one() {
        let folder = tempfile::tempdir().unwrap();
        let socket = folder.path().join("map.png");
        let _listening = std::os::unix::net::UnixListener::bind(&socket).unwrap();
        let mut staging = Staging::create(folder.path()).unwrap();
        let error = staging.stage("map.png", b"baked").unwrap_err();
        assert!(error.to_string().ends_with("is no ordinary file"), "{error}");
    }

    fn listing(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn nothing_shows_under_its_name_before_everything_is_complete() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("a/b");
        let mut staging = Staging::create(&folder).unwrap();
        staging.stage("one.png", b"1").unwrap();
        staging.stage("two.png", b"2").unwrap();
        assert_eq!(listing(&folder), [".one.png.0.tmp", ".two.png.0.tmp"]);
        let placed = staging.commit().unwrap();
        assert_eq!(placed, [folder.join("one.png"), folder.join("two.png")]);
        assert_eq!(listing(&folder), ["one.png", "two.png"]);
    }

    #[test]
    fn what_is_dropped_leaves_the_old_files_and_nothing_else() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join("one.png"), b"old").unwrap();
        let mut staging = Staging::create(root.path()).unwrap();
        staging.stage("one.png", b"new").unwrap();
        drop(staging);
        assert_eq!(listing(root.path()), ["one.png"]);
        assert_eq!(fs::read(root.path().join("one.png")).unwrap(), b"old");
        let folder = root.path().join("x/y");
        drop(Staging::create(&folder).unwrap());
        assert_eq!(listing(root.path()), ["one.png"], "folders made for it are gone");
    }

    #[test]
    fn a_folder_in_the_way_of_one_file_leaves_all_old_files() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join("one.png"), b"old").unwrap();
        fs::create_dir(root.path().join("two.png")).unwrap();
        let mut staging = Staging::create(root.path()).unwrap();
        staging.stage("one.png", b"new").unwrap();
        staging.stage("two.png", b"new").unwrap();
        let error = staging.commit().unwrap_err();
        assert!(matches!(error, ExportError::Replace { .. }), "{error}");
        assert!(
            error
                .to_string()
                .contains("two.png: a folder of that name is in the way; 0 of 2 files"),
            "{error}"
        );
        assert_eq!(fs::read(root.path().join("one.png")).unwrap(), b"old");
        assert_eq!(listing(root.path()), ["one.png", "two.png"]);
    }

    #[test]
    fn a_file_where_the_folder_should_be_is_a_sentence() {
        let root = tempfile::tempdir().unwrap();
        let file = root.path().join("file");
        fs::write(&file, b"x").unwrap();
        for folder in [file.clone(), file.join("below")] {
            let error = Staging::create(&folder).unwrap_err();
            assert!(matches!(error, ExportError::CreateFolder { .. }), "{error}");
            assert!(error.to_string().starts_with("cannot create the folder "), "{error}");
        }
        assert_eq!(fs::read(&file).unwrap(), b"x");
    }

    #[test]
    fn a_full_disk_is_reported_when_writing() {
        struct Full;
        impl Write for Full {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::ErrorKind::StorageFull.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        assert_eq!(
            write_through(&mut Full, b"x").unwrap_err().kind(),
            io::ErrorKind::StorageFull
        );
    }

    #[test]
    fn a_name_is_used_once_and_stays_in_its_folder() {
        let root = tempfile::tempdir().unwrap();
        let mut staging = Staging::create(root.path()).unwrap();
        staging.stage("a.png", b"1").unwrap();
        assert!(matches!(
            staging.stage("A.PNG", b"2"),
            Err(ExportError::SameName { .. })
        ));
        for name in ["../a.png", "b/c.png", "", "..", "/a"] {
            assert!(
                matches!(staging.stage(name, b"2"), Err(ExportError::Write { .. })),
                "{name}"
            );
        }
    }

    #[test]
    fn left_over_temporary_files_are_stepped_around() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join(".a.png.0.tmp"), b"half").unwrap();
        let mut staging = Staging::create(root.path()).unwrap();
        staging.stage("a.png", b"whole").unwrap();
        staging.commit().unwrap();
        assert_eq!(fs::read(root.path().join("a.png")).unwrap(), b"whole");
    }
}
