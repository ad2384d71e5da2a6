//! Any bytes in the disk cache are a layout or an atlas of the mesh, or count as missing.

use std::cell::RefCell;
use std::fs;
use std::path::Path;

use sabi_files::{Cache, CacheKind};
use sabi_surface::atlas::{Atlas, AtlasOptions, cached};
use sabi_surface::model::Mesh;
use sabi_surface::unwrap::unwrap_cached;

use crate::square::square;

/// Bytes before the content of a stored file: a mark, the version, the key, the length and a hash.
const MARK_BYTES: usize = 12;
const HEAD_BYTES: usize = MARK_BYTES + 4 + 32 + 8 + 32;
const OPTIONS: AtlasOptions = AtlasOptions {
    page_limit: 64,
    udim: sabi_surface::atlas::Udim::Auto,
    memory_bytes: 1 << 30,
    size: 16,
};

/// A result that the program has stored.
struct StoredResult {
    kind: CacheKind,
    key: [u8; 32],
    content: Vec<u8>,
}

/// The folder of a cache, and what the program has stored there for a mesh.
struct CacheFolder {
    folder: tempfile::TempDir,
    mesh: Mesh,
    atlas: StoredResult,
    sheet: StoredResult,
}

thread_local! {
    static PLACE: RefCell<CacheFolder> = RefCell::new(CacheFolder::new());
}

/// The first byte says what is damaged: the atlas or the layout, and whether the others are a whole content or are added over the
/// stored one.
pub fn survives(bytes: &[u8]) {
    let Some((first, rest)) = bytes.split_first() else {
        return;
    };
    PLACE.with_borrow(|place| {
        let stored = if first % 2 == 0 { &place.atlas } else { &place.sheet };
        let content = match first & 2 {
            0 => rest.to_vec(),
            _ => changed(&stored.content, rest),
        };
        let cache = Cache::new(place.folder.path(), stored.kind);
        cache
            .write(&stored.key, &content)
            .expect("the folder can be written to");
        if first % 2 == 0 {
            let (atlas, was_stored) = place.atlas();
            assert!(was_stored || content != stored.content, "the stored atlas is found");
            assert_eq!(atlas.triangle_chart.len(), place.mesh.triangles.len());
        } else {
            let was_stored = place.unwrap();
            assert!(was_stored || content != stored.content, "the stored layout is found");
        }
    });
}

/// A content with bytes changed: places in two bytes, each with a value.
fn changed(content: &[u8], changes: &[u8]) -> Vec<u8> {
    let mut content = content.to_vec();
    let length = content.len().max(1);
    for change in changes.as_chunks::<3>().0 {
        let place = usize::from(u16::from_le_bytes([change[0], change[1]])) % length;
        if let Some(byte) = content.get_mut(place) {
            *byte ^= change[2];
        }
    }
    content
}

impl CacheFolder {
    fn new() -> CacheFolder {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut place = CacheFolder {
            mesh: square(|[x, y]| x * y),
            atlas: StoredResult::nothing("atlas"),
            sheet: StoredResult::nothing("sheet"),
            folder,
        };
        place.atlas();
        place.unwrap();
        let path = place.folder.path();
        place.atlas = StoredResult::read(path, "atlas");
        place.sheet = StoredResult::read(path, "sheet");
        place
    }

    fn atlas(&self) -> (Atlas, bool) {
        cached(Some(self.folder.path()), &self.mesh, &OPTIONS).expect("the mesh has an atlas")
    }

    fn unwrap(&self) -> bool {
        let unwrapped = unwrap_cached(Some(self.folder.path()), &self.mesh);
        let (unwrapped, was_stored) = unwrapped.expect("the mesh can be unwrapped");
        assert_eq!(unwrapped.mesh.triangles.len(), self.mesh.triangles.len());
        was_stored
    }
}

impl StoredResult {
    fn nothing(prefix: &'static str) -> StoredResult {
        StoredResult {
            kind: CacheKind {
                prefix,
                version: 0,
                limit_bytes: 1 << 20,
            },
            key: [0; 32],
            content: Vec::new(),
        }
    }

    /// Reads the only file whose name begins so.
    fn read(folder: &Path, prefix: &'static str) -> StoredResult {
        let files = fs::read_dir(folder).expect("the cache has a folder");
        let file = files.filter_map(Result::ok).find(|file| {
            let name = file.file_name();
            name.to_string_lossy().starts_with(prefix)
        });
        let bytes = fs::read(file.expect("the result was stored").path()).expect("the file can be read");
        let mut stored = StoredResult::nothing(prefix);
        let (head, content) = bytes.split_at(HEAD_BYTES);
        let (version, rest) = head[MARK_BYTES..].split_first_chunk().expect("four bytes");
        stored.kind.version = u32::from_le_bytes(*version);
        stored.key = *rest.first_chunk().expect("a key");
        stored.content = content.to_vec();
        stored
    }
}
