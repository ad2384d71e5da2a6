//! Cache of results that can be computed again, stored under a hash of everything they depend on.

use std::ffi::OsString;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::disk::Disk;
use crate::error::{FileError, Operation};
use crate::whole::{Durability, WholeFile, create_folder};

/// First bytes of every stored file.
const MAGIC: &[u8; 12] = b"sabi cache\r\n";
/// Bytes of a stored file before its result: [`MAGIC`], version, key, length and hash.
const HEADER_BYTES: usize = MAGIC.len() + 4 + 32 + 8 + 32;
/// Hash of everything that a stored result depends on.
pub type CacheKey = [u8; 32];

/// Kind of cached results, defined by the crate that stores them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CacheKind {
    /// Start of the file names, followed by a dash and the key. Kinds in the same folder have different prefixes.
    pub prefix: &'static str,
    /// Version of the stored bytes: results of other versions are not returned.
    pub version: u32,
    /// Maximum total size of the results of this kind in a folder. Above it, the least recently used ones are removed.
    pub limit_bytes: u64,
}

/// Cached results of one kind in one folder. Every file contains the version of its kind, its key, its length and a hash,
/// so that damaged or incomplete results are never returned.
#[derive(Clone, Debug)]
pub struct Cache {
    disk: Disk,
    folder: PathBuf,
    kind: CacheKind,
}

impl Cache {
    /// Creates the cache of a kind in a folder, which is created by the first [`Cache::write`].
    pub fn new(folder: impl Into<PathBuf>, kind: CacheKind) -> Cache {
        Cache {
            disk: Disk::default(),
            folder: folder.into(),
            kind,
        }
    }

    /// Returns this cache with writes going to this disk.
    pub fn on_disk(self, disk: &Disk) -> Cache {
        Cache {
            disk: disk.clone(),
            ..self
        }
    }

    /// Folder of the files.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the result stored under a key and marks it as used now. Returns `None` if it is missing, incomplete, damaged
    /// or of another version.
    pub fn read(&self, key: &CacheKey) -> Option<Vec<u8>> {
        let file = self.file(key);
        // Other users may be able to write to the folder: a pipe, or a file without end, is not a result.
        let found = fs::metadata(&file).ok().filter(fs::Metadata::is_file)?;
        let mut opened = fs::File::open(&file).ok()?;
        let mut header = [0; HEADER_BYTES];
        opened.read_exact(&mut header).ok()?;
        let rest = header.strip_prefix(MAGIC)?;
        let rest = rest.strip_prefix(&self.kind.version.to_le_bytes())?.strip_prefix(key)?;
        let (length, hash) = rest.split_first_chunk::<8>()?;
        let length = u64::from_le_bytes(*length);
        if found.len().checked_sub(HEADER_BYTES as u64) != Some(length) {
            return None;
        }
        let mut payload = Vec::new();
        // Reading one more byte reveals a file that grows while it is read.
        opened.take(length.saturating_add(1)).read_to_end(&mut payload).ok()?;
        let is_whole = payload.len() as u64 == length && blake3::hash(&payload).as_bytes() == hash;
        is_whole.then(|| {
            let used = fs::File::options().append(true).open(&file);
            // In a folder that cannot be written to, no results are removed, so the time does not matter.
            let _ = used.and_then(|file| file.set_modified(SystemTime::now()));
            payload
        })
    }

    /// Returns whether a file for a key exists. It may turn out to be damaged.
    pub fn contains(&self, key: &CacheKey) -> bool {
        self.file(key).is_file()
    }

    /// Stores a result under a key, then removes the least recently used results of its kind while they exceed the limit. A
    /// power failure may lose the result, which then has to be computed again.
    ///
    /// # Errors
    /// The folder cannot be created, written to or listed.
    pub fn write(&self, key: &CacheKey, payload: &[u8]) -> Result<(), FileError> {
        create_folder(&self.disk, &self.folder, Durability::Unsynced)?;
        let file = self.file(key);
        // If the process is killed, the temporary file has the name of a result and will be removed like one.
        let mut temporary_prefix = OsString::from(self.kind.prefix);
        temporary_prefix.push("-");
        let mut whole = WholeFile::create_named(&self.disk, &file, &temporary_prefix)?;
        whole.write(MAGIC)?;
        whole.write(&self.kind.version.to_le_bytes())?;
        whole.write(key)?;
        whole.write(&(payload.len() as u64).to_le_bytes())?;
        whole.write(blake3::hash(payload).as_bytes())?;
        whole.write(payload)?;
        whole.place(Durability::Unsynced)?;
        self.remove_oldest(&file)
    }

    fn file(&self, key: &CacheKey) -> PathBuf {
        let key = blake3::Hash::from_bytes(*key).to_hex();
        self.folder.join(format!("{}-{key}.bin", self.kind.prefix))
    }

    /// Removes the least recently used results of this kind until their total size is within the limit. `newest` is never removed.
    fn remove_oldest(&self, newest: &Path) -> Result<(), FileError> {
        let unlisted = |error| FileError::new(Operation::List, &self.folder, error);
        let mut stored = Vec::new();
        for entry in fs::read_dir(&self.folder).map_err(unlisted)? {
            let path = entry.map_err(unlisted)?.path();
            let name = path.file_name().and_then(|name| name.to_str());
            let after_prefix = name.and_then(|name| name.strip_prefix(self.kind.prefix));
            let is_of_kind = after_prefix.is_some_and(|rest| rest.starts_with('-'));
            // Another process may have removed the file after the folder was listed.
            if let (true, Ok(metadata)) = (is_of_kind, fs::metadata(&path)) {
                let modified = metadata.modified().map_err(unlisted)?;
                stored.push((modified, path, metadata.len()));
            }
        }
        stored.sort();
        let mut total: u64 = stored.iter().map(|(.., bytes)| bytes).sum();
        for (_, path, bytes) in stored {
            if total > self.kind.limit_bytes && path != newest && self.disk.remove(&path).is_ok() {
                total -= bytes;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    const KIND: CacheKind = CacheKind {
        prefix: "kind",
        version: 3,
        limit_bytes: 1 << 20,
    };
    const KEY: CacheKey = [7; 32];

    #[test]
    fn a_result_is_returned_only_for_its_key_kind_and_version() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::new(folder.path().join("below"), KIND);
        assert_eq!(cache.read(&KEY), None);
        cache.write(&KEY, b"payload").unwrap();
        assert_eq!(cache.read(&KEY).unwrap(), b"payload");
        assert_eq!(cache.read(&[8; 32]), None);
        let other = |kind| Cache::new(cache.folder(), kind).read(&KEY);
        assert_eq!(other(CacheKind { prefix: "kin", ..KIND }), None);
        assert_eq!(other(CacheKind { version: 4, ..KIND }), None);
        cache.write(&KEY, b"").unwrap();
        assert_eq!(cache.read(&KEY).unwrap(), b"");
    }

    #[test]
    fn a_damaged_result_is_not_returned() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::new(folder.path(), KIND);
        cache.write(&KEY, b"payload").unwrap();
        let file = cache.file(&KEY);
        let whole = fs::read(&file).unwrap();
        for at in 0..whole.len() {
            let mut flipped = whole.clone();
            flipped[at] ^= 4;
            for damaged in [&flipped, &whole[..at]] {
                fs::write(&file, damaged).unwrap();
                assert_eq!(cache.read(&KEY), None, "byte {at}");
            }
        }
        fs::write(&file, [whole.as_slice(), b"0"].concat()).unwrap();
        assert_eq!(cache.read(&KEY), None);
        fs::write(&file, &whole).unwrap();
        assert!(cache.read(&KEY).is_some());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_pipe_a_device_or_an_endless_file_is_not_a_result() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::new(folder.path(), KIND);
        let file = cache.file(&KEY);
        let made = std::process::Command::new("mkfifo").arg(&file).status().unwrap();
        assert!(made.success());
        assert_eq!(cache.read(&KEY), None);
        for target in ["/dev/zero", "/proc/self/maps"] {
            fs::remove_file(&file).unwrap();
            std::os::unix::fs::symlink(target, &file).unwrap();
            assert_eq!(cache.read(&KEY), None, "{target}");
        }
        fs::remove_file(&file).unwrap();
        let sparse = fs::File::create(&file).unwrap();
        sparse.set_len(1 << 40).unwrap();
        assert_eq!(cache.read(&KEY), None, "it is not even begun");
        // Writing a result replaces whatever is there.
        cache.write(&KEY, b"payload").unwrap();
        assert_eq!(cache.read(&KEY).unwrap(), b"payload");
    }

    #[test]
    fn the_oldest_results_of_a_kind_are_removed_and_other_files_stay() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name);
        let names = ["kind-a.bin", "kind-b.tmp", "kind-c.bin", "kinds-d.bin", "other.bin"];
        for (age, name) in names.iter().enumerate() {
            let out = fs::File::create(file(name)).unwrap();
            out.set_len(100).unwrap();
            let modified = SystemTime::UNIX_EPOCH + Duration::from_secs(age as u64);
            out.set_modified(modified).unwrap();
        }
        let left = || names.map(|name| file(name).is_file());
        let limited = |limit_bytes| Cache::new(folder.path(), CacheKind { limit_bytes, ..KIND });
        limited(300).remove_oldest(&file("kind-a.bin")).unwrap();
        assert_eq!(left(), [true; 5]);
        limited(200).remove_oldest(&file("kind-a.bin")).unwrap();
        assert_eq!(left(), [true, false, true, true, true]);
        limited(0).remove_oldest(&file("kind-a.bin")).unwrap();
        assert_eq!(left(), [true, false, false, true, true]);
        // The newest result stays, however large it is.
        limited(0).write(&KEY, b"payload").unwrap();
        assert!(limited(0).read(&KEY).is_some());
        assert_eq!(left(), [false, false, false, true, true]);
    }

    #[test]
    fn recently_read_results_stay() {
        let folder = tempfile::tempdir().unwrap();
        let limited = Cache::new(
            folder.path(),
            CacheKind {
                limit_bytes: 300,
                ..KIND
            },
        );
        let keys = [[1; 32], [2; 32], [3; 32]];
        for (age, key) in keys[..2].iter().enumerate() {
            limited.write(key, &[0; 20]).unwrap();
            let file = fs::File::options().append(true).open(limited.file(key)).unwrap();
            file.set_modified(SystemTime::UNIX_EPOCH + Duration::from_secs(age as u64))
                .unwrap();
        }
        assert!(limited.read(&keys[0]).is_some());
        limited.write(&keys[2], &[0; 20]).unwrap();
        let left = keys.map(|key| limited.read(&key).is_some());
        assert_eq!(left, [true, false, true], "each has 108 bytes");
    }

    #[test]
    fn a_folder_that_cannot_be_written_to_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, b"in the way").unwrap();
        let error = Cache::new(&file, KIND).write(&KEY, b"1").unwrap_err();
        assert_eq!((error.operation, error.path), (Operation::CreateFolder, file));
    }
}
