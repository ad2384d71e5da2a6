//! Packages: files of a staged set in one uncompressed archive.

use std::cell::OnceCell;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::{FileStamp, StagedError, StagedFile, StagedSet};
use crate::error::{FileError, Operation};
use crate::whole::WholeFile;
use crate::whole::part_writer::PartWriter;

/// Upper bound for the bytes of an archive's records for each file, including padding but not the file name.
const RECORD_BYTES: u64 = 512;
/// Maximum size of an archive that programs without zip64 can read.
const MOST_BYTES: u64 = u32::MAX as u64;

impl StagedSet {
    /// Stages an uncompressed archive that consists of a first file, given by its bytes, and of files of the set that are staged already.
    /// The bytes of each file start at a multiple of `alignment`. The same files give the same bytes. Returns false, and stages nothing,
    /// if the archive could have 4 GiB or more, which programs without zip64 cannot read.
    ///
    /// # Errors
    /// Those of [`StagedSet::stage`]; or a file is not staged.
    pub fn stage_package(
        &mut self,
        file_name: &str,
        first_name: &str,
        first_bytes: &[u8],
        members: &[&str],
        alignment: u16,
    ) -> Result<bool, StagedError> {
        let target = self.free_target(OsStr::new(file_name))?;
        let failed = |error| FileError::new(Operation::Write, &target, error);
        let files: Vec<File> = members
            .iter()
            .map(|member| self.staged_file(member))
            .collect::<io::Result<_>>()
            .map_err(failed)?;
        let mut total = first_bytes.len() as u64 + 2 * first_name.len() as u64 + RECORD_BYTES;
        for (name, file) in members.iter().zip(&files) {
            total += file.metadata().map_err(failed)?.len() + 2 * name.len() as u64 + RECORD_BYTES;
        }
        if total > MOST_BYTES {
            return Ok(false);
        }
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .last_modified_time(DateTime::default())
            .unix_permissions(0o644)
            .with_alignment(alignment);
        let packed = |to: PartWriter<'_>| -> Result<(), ZipError> {
            let mut archive = ZipWriter::new(BufWriter::new(to));
            archive.start_file(first_name, options)?;
            archive.write_all(first_bytes)?;
            for (name, mut file) in members.iter().zip(files) {
                archive.start_file(*name, options)?;
                io::copy(&mut file, &mut archive)?;
            }
            archive.finish()?.flush()?;
            Ok(())
        };
        let mut whole = WholeFile::create_on(&self.disk, &target)?;
        let failure = OnceCell::new();
        let done = packed(PartWriter::new(&mut whole, &failure));
        if let Some(error) = failure.into_inner() {
            return Err(error.into());
        }
        done.map_err(|error| failed(error.into()))?;
        whole.sync()?;
        let (target, file) = whole.into_parts();
        let same = FileStamp::of(&target).filter(|_| is_same(&target, file.path()));
        self.add(target, same.map_or(StagedFile::New(file), StagedFile::Unchanged));
        Ok(true)
    }

    /// Writes the bytes of a staged file to `to`.
    ///
    /// # Errors
    /// No such file is staged, or it cannot be read, or `to` cannot be written.
    pub fn copy_staged(&self, file_name: &str, to: &mut dyn Write) -> Result<(), StagedError> {
        let copied = self.staged_file(file_name).and_then(|mut file| io::copy(&mut file, to));
        copied.map_err(|error| FileError::new(Operation::Write, &self.folder.join(file_name), error))?;
        Ok(())
    }

    /// Opens a staged file for reading from its start.
    fn staged_file(&self, file_name: &str) -> io::Result<File> {
        let named = Some(OsStr::new(file_name));
        let found = self.files.iter().find(|(target, _)| target.file_name() == named);
        match found.ok_or(io::ErrorKind::NotFound)? {
            (_, StagedFile::New(file)) => file.reopen(),
            (target, StagedFile::Unchanged(_)) => File::open(target),
        }
    }
}

/// Returns true if both files can be read and have the same bytes.
fn is_same(one: &Path, other: &Path) -> bool {
    let size = |path: &Path| fs::metadata(path).ok().map(|found| found.len());
    let hash = |path: &Path| {
        let mut hasher = blake3::Hasher::new();
        io::copy(&mut File::open(path)?, &mut hasher)?;
        io::Result::Ok(hasher.finalize())
    };
    size(one).is_some()
        && size(one) == size(other)
        && matches!((hash(one), hash(other)), (Ok(one), Ok(other)) if one == other)
}
