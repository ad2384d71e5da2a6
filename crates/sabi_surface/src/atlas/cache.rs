//! Atlases on disk, found by what they are made of.

use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use super::codec::{decode, encode};
use super::{Atlas, AtlasError, AtlasOptions};
use crate::model::Mesh;

/// Rises whenever building or the bytes change.
const FORMAT_VERSION: u32 = 1;
const MAGIC: &[u8; 12] = b"sabi atlas\r\n";

/// The cache folder holds no more than this; the oldest atlases make room.
const LIMIT_BYTES: u64 = 4 << 30;

/// Tells two processes' temporary files apart, and two threads'.
static WRITES: AtomicU64 = AtomicU64::new(0);

/// A name for the atlas of a mesh: a hash of everything that can change it.
pub fn atlas_key(mesh: &Mesh, options: &AtlasOptions) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new_derive_key("sabi linked atlas");
    for number in [FORMAT_VERSION, options.size, options.page_limit] {
        hasher.update(&number.to_le_bytes());
    }
    let mut list = |bytes: &[u8]| {
        hasher.update(&(bytes.len() as u64).to_le_bytes());
        hasher.update(bytes);
    };
    list(bytemuck::cast_slice(&mesh.positions));
    list(bytemuck::cast_slice(&mesh.uvs));
    list(bytemuck::cast_slice(&mesh.triangles));
    list(bytemuck::cast_slice(&mesh.triangle_material));
    list(bytemuck::cast_slice(&mesh.triangle_part));
    *hasher.finalize().as_bytes()
}

/// The atlas of a mesh, from the cache where it is there and whole, else built and written there.
///
/// The second value says whether it came from the cache. A cache that cannot be written is a warning in the atlas'
/// report, no error; a damaged file is replaced.
pub fn cached(cache_dir: Option<&Path>, mesh: &Mesh, options: &AtlasOptions) -> Result<(Atlas, bool), AtlasError> {
    let Some(folder) = cache_dir else {
        return Ok((Atlas::build(mesh, options)?, false));
    };
    let key = atlas_key(mesh, options);
    let name = format!("atlas-{}.bin", blake3::Hash::from_bytes(key).to_hex());
    let file = folder.join(&name);
    if let Some(atlas) = fs::read(&file).ok().and_then(|bytes| unwrap(&bytes, &key)) {
        return Ok((atlas, true));
    }
    let mut atlas = Atlas::build(mesh, options)?;
    let kept = write(folder, &file, &wrap(&atlas, &key)).and_then(|()| make_room(folder, &file, LIMIT_BYTES));
    if let Err(error) = kept {
        atlas.report.warnings.push(format!(
            "the atlas could not be kept in {} ({error}), so the next start takes a little longer; free some space \
             there or choose another cache folder",
            folder.display()
        ));
    }
    Ok((atlas, false))
}

/// Magic, key, length and hash before the bytes.
fn wrap(atlas: &Atlas, key: &[u8; 32]) -> Vec<u8> {
    let payload = encode(atlas);
    let mut bytes = Vec::with_capacity(payload.len() + 84);
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(key);
    bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    bytes.extend_from_slice(blake3::hash(&payload).as_bytes());
    bytes.extend_from_slice(&payload);
    bytes
}

/// The atlas in a file's bytes; `None` when they are of another one, cut short or damaged.
fn unwrap(bytes: &[u8], key: &[u8; 32]) -> Option<Atlas> {
    let rest = bytes.strip_prefix(MAGIC)?.strip_prefix(key)?;
    let (length, rest) = rest.split_first_chunk::<8>()?;
    let (hash, payload) = rest.split_first_chunk::<32>()?;
    let whole = u64::from_le_bytes(*length) == payload.len() as u64 && blake3::hash(payload) == *hash;
    if whole { decode(payload) } else { None }
}

/// Writes under a temporary name first: whoever reads meanwhile sees the old file or the new one.
fn write(folder: &Path, file: &Path, bytes: &[u8]) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let number = WRITES.fetch_add(1, Ordering::Relaxed);
    let temporary = file.with_extension(format!("{}-{number}.part", std::process::id()));
    let written = fs::File::create(&temporary)
        .and_then(|mut out| out.write_all(bytes))
        .and_then(|()| fs::rename(&temporary, file));
    if written.is_err() {
        // It may never have come to be; the first error is the one to tell.
        let _ = fs::remove_file(&temporary);
    }
    written
}

/// Removes the oldest atlases, never `newest`, until the others and it take at most `limit_bytes`.
pub(super) fn make_room(folder: &Path, newest: &Path, limit_bytes: u64) -> io::Result<()> {
    let mut kept = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let is_atlas = path
            .file_name()
            .and_then(|name| name.to_str())
            .is_some_and(|name| name.starts_with("atlas-"));
        // Another process may have removed it meanwhile.
        if let (true, Ok(metadata)) = (is_atlas, fs::metadata(&path)) {
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
