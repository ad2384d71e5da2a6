//! Pictures that are put in their places together.

use std::ffi::OsString;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use sabi_export::ExportError;
use sabi_files::StagedSet;

use crate::error::EngineError;

/// Pictures of one folder, under temporary names until all are written.
pub(crate) struct PictureFiles {
    staged: StagedSet,
    /// Names of pictures that have yet to be written, the next one last.
    names: Vec<OsString>,
}

impl PictureFiles {
    /// Prepares files that are all in the folder of the first; `inputs` are files that they must not replace.
    ///
    /// # Errors
    /// A path has no file name, or the folder cannot be written to. Nothing has been drawn for it then.
    pub(crate) fn begin(paths: &[PathBuf], inputs: Vec<PathBuf>) -> Result<PictureFiles, EngineError> {
        let folder = paths.first().and_then(|path| path.parent());
        let mut staged = StagedSet::create(folder.unwrap_or(Path::new("."))).map_err(ExportError::from)?;
        staged.protect(inputs);
        let mut names = Vec::with_capacity(paths.len());
        for path in paths.iter().rev() {
            let name = path.file_name().ok_or_else(|| nameless(path))?;
            staged.check(name).map_err(ExportError::from)?;
            names.push(name.to_owned());
        }
        Ok(PictureFiles { staged, names })
    }

    /// Writes the next picture under a temporary name.
    pub(crate) fn add(&mut self, bytes: Vec<u8>) -> Result<(), EngineError> {
        if let Some(name) = self.names.pop() {
            self.staged.stage(&name, &bytes).map_err(ExportError::from)?;
        }
        Ok(())
    }

    /// Puts all pictures in their places.
    pub(crate) fn commit(self) -> Result<(), EngineError> {
        self.staged.commit().map_err(ExportError::from)?;
        Ok(())
    }
}

fn nameless(path: &Path) -> ExportError {
    ExportError::Write {
        path: path.to_owned(),
        source: ErrorKind::InvalidFilename.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn a_picture_whose_name_is_not_utf_8_is_written_to_exactly_that_file() {
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt;
        let folder = tempfile::tempdir().expect("a folder");
        let names = [b"a\xfe.png".as_slice(), b"a\xff.png"].map(OsStr::from_bytes);
        let paths = names.map(|name| folder.path().join(name));
        let mut pictures = PictureFiles::begin(&paths, Vec::new()).expect("begun");
        for name in names {
            pictures.add(name.as_bytes().to_vec()).expect("written");
        }
        pictures.commit().expect("in place");
        for (name, path) in names.iter().zip(&paths) {
            assert_eq!(std::fs::read(path).expect("a file"), name.as_bytes());
        }
        assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 2);
    }

    #[test]
    fn a_path_without_a_file_name_is_refused() {
        let Err(refused) = PictureFiles::begin(&[PathBuf::from("..")], Vec::new()) else {
            panic!("it has no name");
        };
        assert!(
            refused.to_string().contains("its name is not allowed there"),
            "{refused}"
        );
    }
}
