//! Disk cache of unwrapped sheets.

use std::path::Path;

use sabi_files::{Cache, CacheKind};

use super::{Sheet, UnwrapReport};
use crate::model::Mesh;

/// Stored sheets; the version changes whenever unwrapping or encoding does.
const KIND: CacheKind = CacheKind {
    prefix: "sheet",
    version: 2,
    limit_bytes: 1 << 30,
};

/// Returns the key of a sheet: a hash of everything that can change it.
pub(super) fn key(mesh: &Mesh) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new_derive_key("sabi unwrapped sheet");
    hasher.update(&KIND.version.to_le_bytes());
    let mut list = |bytes: &[u8]| {
        hasher.update(&(bytes.len() as u64).to_le_bytes());
        hasher.update(bytes);
    };
    list(bytemuck::cast_slice(&mesh.positions));
    list(bytemuck::cast_slice(&mesh.normals));
    list(bytemuck::cast_slice(&mesh.triangles));
    list(bytemuck::cast_slice(&mesh.triangle_material));
    list(bytemuck::cast_slice(&mesh.triangle_part));
    *hasher.finalize().as_bytes()
}

/// Returns the stored sheet of a mesh with this number of triangles.
pub(super) fn read(folder: &Path, key: &[u8; 32], triangles: usize) -> Option<Sheet> {
    decode(&Cache::new(folder, KIND).read(key)?, triangles)
}

/// Stores a sheet; returns a warning when that fails.
pub(super) fn write(folder: &Path, key: &[u8; 32], sheet: &Sheet) -> Option<String> {
    let error = Cache::new(folder, KIND).write(key, &encode(sheet)).err()?;
    Some(format!(
        "the unwrapped UVs could not be kept in {} ({}), so the next start takes longer; free some space there or \
         choose another cache folder",
        folder.display(),
        error.reason()
    ))
}

/// Encodes counts, shares, corners and then the warnings as lines.
fn encode(sheet: &Sheet) -> Vec<u8> {
    let report = &sheet.report;
    let mut bytes = Vec::with_capacity(24 * sheet.corners.len() + 64);
    for count in [
        report.charts,
        report.pieces[0],
        report.pieces[1],
        sheet.corners.len() as u32,
    ] {
        bytes.extend(count.to_le_bytes());
    }
    for share in [report.coverage, report.stretch, report.worst_stretch, report.gap] {
        bytes.extend(share.to_le_bytes());
    }
    for value in sheet.corners.as_flattened().as_flattened() {
        bytes.extend(value.to_le_bytes());
    }
    bytes.extend(report.warnings.join("\n").into_bytes());
    bytes
}

fn decode(bytes: &[u8], triangles: usize) -> Option<Sheet> {
    let (head, rest) = bytes.split_first_chunk::<32>()?;
    let (words, _) = head.as_chunks::<4>();
    let count = |at: usize| u32::from_le_bytes(words[at]);
    let share = |at: usize| f32::from_le_bytes(words[at]);
    if count(3) as usize != triangles {
        return None;
    }
    let (values, lines) = rest.split_at_checked(24 * triangles)?;
    let values: Vec<f32> = values
        .as_chunks::<4>()
        .0
        .iter()
        .map(|bytes| f32::from_le_bytes(*bytes))
        .collect();
    let corners = values.as_chunks::<2>().0.as_chunks::<3>().0.to_vec();
    let lines = std::str::from_utf8(lines).ok()?;
    Some(Sheet {
        corners,
        report: UnwrapReport {
            charts: count(0),
            pieces: [count(1), count(2)],
            coverage: share(4),
            stretch: share(5),
            worst_stretch: share(6),
            gap: share(7),
            warnings: lines.lines().map(str::to_owned).collect(),
        },
    })
}
