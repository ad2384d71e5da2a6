//! Disk cache of unwrapped layouts.

use std::path::Path;

use sabi_files::{Cache, CacheKind};

use super::{UnwrapLayout, UnwrapReport};
use crate::model::Mesh;

/// Stored layouts; the version changes whenever unwrapping or encoding does.
const KIND: CacheKind = CacheKind {
    prefix: "sheet",
    version: 2,
    limit_bytes: 1 << 30,
};

/// Returns the key of a layout: a hash of everything that can change it.
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

/// Returns the stored layout of a mesh with this number of triangles.
pub(super) fn read(folder: &Path, key: &[u8; 32], triangles: usize) -> Option<UnwrapLayout> {
    decode(&Cache::new(folder, KIND).read(key)?, triangles)
}

/// Stores a layout; returns a warning when that fails.
pub(super) fn write(folder: &Path, key: &[u8; 32], layout: &UnwrapLayout) -> Option<String> {
    let error = Cache::new(folder, KIND).write(key, &encode(layout)).err()?;
    Some(format!(
        "the unwrapped UVs could not be kept in {} ({}), so the next start takes longer; free some space there or \
         choose another cache folder",
        folder.display(),
        error.reason()
    ))
}

/// Encodes counts, shares, corners and then the warnings as lines.
fn encode(layout: &UnwrapLayout) -> Vec<u8> {
    let report = &layout.report;
    let mut bytes = Vec::with_capacity(24 * layout.corners.len() + 64);
    for count in [
        report.charts,
        report.pieces[0],
        report.pieces[1],
        layout.corners.len() as u32,
    ] {
        bytes.extend(count.to_le_bytes());
    }
    for share in [report.coverage, report.stretch, report.worst_stretch, report.gap] {
        bytes.extend(share.to_le_bytes());
    }
    for value in layout.corners.as_flattened().as_flattened() {
        bytes.extend(value.to_le_bytes());
    }
    bytes.extend(report.warnings.join("\n").into_bytes());
    bytes
}

fn decode(bytes: &[u8], triangles: usize) -> Option<UnwrapLayout> {
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
    Some(UnwrapLayout {
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
