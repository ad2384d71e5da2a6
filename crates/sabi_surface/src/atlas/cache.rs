//! Disk cache of atlases.

use std::path::Path;

use sabi_files::{Cache, CacheKind};

use super::codec::{decode, encode};
use super::{Atlas, AtlasError, AtlasOptions};
use crate::model::Mesh;

/// Kind of cached atlases. Its version must be changed whenever building or encoding changes.
const KIND: CacheKind = CacheKind {
    prefix: "atlas",
    version: 7,
    limit_bytes: 3 << 30,
};

/// Returns the key of the atlas of a mesh: a hash of everything that can change it.
pub fn atlas_key(mesh: &Mesh, options: &AtlasOptions) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new_derive_key("sabi linked atlas");
    for number in [
        KIND.version,
        options.size,
        options.page_limit,
        u32::from(mesh.is_one_sheet),
        options.udim as u32,
    ] {
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
    let repeating: Vec<u32> = mesh.repeating.iter().copied().collect();
    list(bytemuck::cast_slice(&repeating));
    *hasher.finalize().as_bytes()
}

/// Returns the atlas of a mesh from the cache if it is stored there and intact. Otherwise builds and stores it.
///
/// The second value is whether it came from the cache. A cache that cannot be written is a warning in the atlas'
/// report, not an error; a damaged file is replaced.
pub fn cached(cache_dir: Option<&Path>, mesh: &Mesh, options: &AtlasOptions) -> Result<(Atlas, bool), AtlasError> {
    let Some(folder) = cache_dir else {
        return Ok((Atlas::build(mesh, options)?, false));
    };
    let cache = Cache::new(folder, KIND);
    let key = atlas_key(mesh, options);
    if let Some(atlas) = cache.read(&key).and_then(|payload| decode(&payload)) {
        return Ok((atlas, true));
    }
    let mut atlas = Atlas::build(mesh, options)?;
    if let Err(error) = cache.write(&key, &encode(&atlas)) {
        atlas.report.warnings.push(format!(
            "the atlas could not be kept in {} ({}), so the next start takes a little longer; free some space \
             there or choose another cache folder",
            folder.display(),
            error.reason()
        ));
    }
    Ok((atlas, false))
}
