//! What takes long to make, kept in a folder by what it is made of.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Tells two processes' temporary files apart, and two threads'.
static WRITES: AtomicU64 = AtomicU64::new(0);

/// A kind of kept thing.
pub struct Kind {
    /// First bytes of its files.
    pub magic: &'static [u8; 12],
    /// How their names begin, before a dash and the key.
    pub prefix: &'static str,
    /// A folder holds no more than this; the oldest files make room.
    pub limit_bytes: u64,
}

/// How names of all kinds begin: nothing else in the folder is touched.
const PREFIXES: [&str; 5] = ["atlas-", "sheet-", "rays-", "light-", "thumb-"];

impl Kind {
    fn file(&self, folder: &Path, key: &[u8; 32]) -> PathBuf {
        folder.join(format!(
            "{}-{}.bin",
            self.prefix,
            blake3::Hash::from_bytes(*key).to_hex()
        ))
    }
}

/// What was kept under a key, unless it is not there, of another key, cut short or damaged.
pub fn read(folder: &Path, kind: &Kind, key: &[u8; 32]) -> Option<Vec<u8>> {
    let mut bytes = fs::read(kind.file(folder, key)).ok()?;
    let rest = bytes.strip_prefix(kind.magic)?.strip_prefix(key)?;
    let (length, rest) = rest.split_first_chunk::<8>()?;
    let (hash, payload) = rest.split_first_chunk::<32>()?;
    let whole = u64::from_le_bytes(*length) == payload.len() as u64 && blake3::hash(payload) == *hash;
    let start = bytes.len() - payload.len();
    whole.then(|| bytes.split_off(start))
}

/// Keeps bytes under a key: magic, key, length and hash stand before them.
pub fn keep(folder: &Path, kind: &Kind, key: &[u8; 32], payload: &[u8]) -> io::Result<()> {
    let mut head = Vec::with_capacity(84);
    head.extend_from_slice(kind.magic);
    head.extend_from_slice(key);
    head.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    head.extend_from_slice(blake3::hash(payload).as_bytes());
    let file = kind.file(folder, key);
    write(folder, &file, &[&head, payload])?;
    make_room(folder, &file, kind.limit_bytes)
}

/// Writes under a temporary name first: whoever reads meanwhile sees the old file or the new one.
fn write(folder: &Path, file: &Path, parts: &[&[u8]]) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let number = WRITES.fetch_add(1, Ordering::Relaxed);
    let temporary = file.with_extension(format!("{}-{number}.part", std::process::id()));
    let written = fs::File::create(&temporary)
        .and_then(|mut out| parts.iter().try_for_each(|part| out.write_all(part)))
        .and_then(|()| fs::rename(&temporary, file));
    if written.is_err() {
        // It may never have come to be; the first error is the one to tell.
        let _ = fs::remove_file(&temporary);
    }
    written
}

/// Removes the oldest files, never `newest`, until the others and it take at most `limit_bytes`.
pub(crate) fn make_room(folder: &Path, newest: &Path, limit_bytes: u64) -> io::Result<()> {
    let mut kept = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().and_then(|name| name.to_str());
        let is_ours = name.is_some_and(|name| PREFIXES.iter().any(|prefix| name.starts_with(prefix)));
        // Another process may have removed it meanwhile.
        if let (true, Ok(metadata)) = (is_ours, fs::metadata(&path)) {
            kept.push((metadata.modified()?, path, metadata.len()));
        }
    }
    kept.sort();
    let mut total: u64 = kept.iter().map(|(.., bytes)| bytes).sum();
    for (_, path, bytes) in kept {
        if total > limit_bytes && path != newest && fs::remove_file(&path).is_ok() {
            total -= bytes;
        }
    }
    Ok(())
}
