//! Files to which a model refers. Each is read only once, however its path is written, and all of them within one memory limit.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sabi_files::{FolderSearch, PathBase, Refusal, TrustedPaths, Unread, is_local, read_plain};

use super::error::{ModelFault, mib};
use super::{LoadOptions, MAX_FILE_BYTES, reason, reason_beside};

/// Maximum number of recorded paths of missing files, and of recorded refusals.
const MOST_RECORDED: usize = 256;

/// Most missing files that are looked for in another case of letters.
const MOST_LISTINGS: usize = 1000;

/// Reader of the files that a model names.
pub(super) struct ReferencedFiles<'t> {
    base: PathBase,
    trusted: &'t TrustedPaths,
    /// Folder in which files are looked for that are not where the model says.
    elsewhere: Option<FolderSearch>,
    /// Files that were read, in their order, as they were found.
    pub(super) files: Vec<PathBuf>,
    /// Paths of files that do not exist.
    pub(super) absent: Vec<PathBuf>,
    /// Refusals of files that may not be opened.
    pub(super) refused: Vec<Refusal>,
    /// Content by canonical path.
    known: BTreeMap<PathBuf, Arc<[u8]>>,
    /// Bytes that all files together may have, and how many of them remain.
    memory: [u64; 2],
    /// Missing files that are still looked for in another case of letters.
    listings: usize,
    /// Bytes that were needed for the last file that did not fit, with its reason.
    too_large: Option<(u64, String)>,
}

impl<'t> ReferencedFiles<'t> {
    /// Reads the model's own file and returns it with a reader for the other files. All files together have at most `memory_bytes`.
    pub(super) fn of_model(
        path: &Path,
        trusted: &'t TrustedPaths,
        options: &LoadOptions,
    ) -> Result<(Vec<u8>, ReferencedFiles<'t>), ModelFault> {
        let memory_bytes = options.memory_bytes;
        let bytes = read_plain(path, memory_bytes.min(MAX_FILE_BYTES)).map_err(|unread| match unread {
            Unread::TooLarge(needed) if needed <= MAX_FILE_BYTES => ModelFault::memory(needed, memory_bytes),
            unread => reason(unread).map_or(ModelFault::NoFile, ModelFault::Unreadable),
        })?;
        let beside = ReferencedFiles {
            base: PathBase::of_file(path),
            trusted,
            elsewhere: options.textures.as_deref().map(FolderSearch::new),
            files: vec![path.to_owned()],
            absent: Vec::new(),
            refused: Vec::new(),
            known: BTreeMap::new(),
            memory: [memory_bytes, memory_bytes - bytes.len() as u64],
            listings: MOST_LISTINGS,
            too_large: None,
        };
        Ok((bytes, beside))
    }

    /// Bytes of all files that were read.
    pub(super) fn bytes_read(&self) -> u64 {
        let [all, left] = self.memory;
        all - left
    }

    /// Returns the bytes of a file, or the reason why it cannot be read.
    pub(super) fn read(&mut self, written: &str) -> Result<Arc<[u8]>, String> {
        self.find(written).map_err(|unread| self.unread(written, unread))
    }

    /// Replaces a fault caused by a file that did not fit by a more precise fault.
    pub(super) fn explained(&self, fault: ModelFault) -> ModelFault {
        let ModelFault::NoBuffer { uri, reason } = fault else {
            return fault;
        };
        if let Some(refusal) = self.refused.iter().find(|refusal| refusal.to_string() == reason) {
            let refusal = refusal.clone();
            return ModelFault::Refused { uri, refusal };
        }
        match &self.too_large {
            Some((needed, known)) if reason == *known => ModelFault::memory(*needed, self.memory[0]),
            _ => ModelFault::NoBuffer { uri, reason },
        }
    }

    fn find(&mut self, written: &str) -> Result<Arc<[u8]>, Unread> {
        let found = match self.trusted.find_of_model(&self.base, written) {
            // Folders are listed for each, which is slow for very many.
            Err(Unread::Missing) if self.listings > 0 => {
                self.listings -= 1;
                self.trusted.find_of_model_in_other_case(&self.base, written)
            }
            found => found,
        };
        let (file, place) = match (found, &mut self.elsewhere) {
            (Err(Unread::Missing), Some(elsewhere)) => {
                let place = elsewhere.find(self.trusted, written)?;
                (self.trusted.check_found(&place)?, place)
            }
            (found, _) => found?,
        };
        if let Some(known) = self.known.get(&file) {
            return Ok(known.clone());
        }
        let [_, left] = &mut self.memory;
        let bytes: Arc<[u8]> = read_plain(&file, MAX_FILE_BYTES.min(*left))?.into();
        *left -= bytes.len() as u64;
        self.files.push(place);
        self.known.insert(file, bytes.clone());
        Ok(bytes)
    }

    fn unread(&mut self, written: &str, unread: Unread) -> String {
        match unread {
            Unread::TooLarge(needed) if needed <= MAX_FILE_BYTES => {
                let why = self.does_not_fit(needed);
                self.too_large = Some((self.bytes_read().saturating_add(needed), why.clone()));
                return why;
            }
            Unread::Refused(ref refusal) if self.refused.len() < MOST_RECORDED => self.refused.push(refusal.clone()),
            Unread::Missing => {
                let places = self.base.places(written).into_iter();
                let places = places.filter(|(text, _)| is_local(text));
                self.absent.extend(places.map(|(_, place)| place));
                self.absent.truncate(MOST_RECORDED);
            }
            _ => {}
        }
        reason_beside(unread)
    }

    fn does_not_fit(&self, needed: u64) -> String {
        let [all, left] = self.memory;
        format!(
            "it has {} MiB, and {} of the {} MiB of memory for a model are left",
            mib(needed),
            left >> 20,
            all >> 20
        )
    }
}
