//! Texture coordinates for any model: cut into charts, laid flat, packed onto one sheet without overlap.
//!
//! The way, one file a step: `pieces` (connected parts, and which of them are alike), `flatten` (charts of each different
//! piece), `sheet` (all charts at one scale on the unit square), `redraw` (the mesh with vertices split along the charts'
//! borders, and tangents for the new coordinates). `keep` finds the result of an earlier run on disk.

mod error;
mod flatten;
mod keep;
mod pieces;
mod redraw;
mod sheet;
#[cfg(test)]
mod tests;

use std::path::Path;

pub use self::error::UnwrapError;
use self::flatten::Flattened;
use crate::model::Mesh;

/// How a mesh is unwrapped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnwrapOptions {
    /// Texels along a side of the maps that the sheet is for, 16 to 16384.
    pub size: u32,
}

/// Texels that stay free between two charts at [`UnwrapOptions::size`]; half of it along the sheet's border.
pub const GAP: u32 = 4;

/// A mesh on one sheet.
///
/// `mesh` has the triangles of the mesh it was made from, in their order and with their materials and parts, and looks the
/// same: only vertices along the borders of charts are there several times. To write it into a file, write its positions,
/// normals, tangents, colors and [`Mesh::texture_uvs`] as they are, and [`Mesh::uvs`] as one more `TEXCOORD`: the one after
/// the last of `texture_uvs`, or 0 if there is none. To change a file in place instead, `source_vertex` says for each vertex
/// which vertex of the loaded mesh it was.
#[derive(Clone, Debug, PartialEq)]
pub struct Unwrapped {
    /// The mesh with its new texture coordinates.
    pub mesh: Mesh,
    /// For each vertex of `mesh` its vertex in the mesh that was unwrapped.
    pub source_vertex: Vec<u32>,
    /// What came of it.
    pub report: UnwrapReport,
}

/// How well a mesh could be unwrapped.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UnwrapReport {
    /// Charts on the sheet.
    pub charts: u32,
    /// Connected pieces, and how many of them are not just copies of another.
    pub pieces: [u32; 2],
    /// Share of the sheet that triangles cover.
    pub coverage: f32,
    /// How much longer the longest direction of a triangle got than its shortest, averaged by area: 1 is none.
    pub stretch: f32,
    /// The same at its worst, among the triangles with 99.9 % of the area.
    pub worst_stretch: f32,
    /// Texels between charts: [`GAP`], unless there are too many charts for it.
    pub gap: f32,
    /// Sentences for the artist.
    pub warnings: Vec<String>,
}

/// Unwraps a mesh: the same bytes for the same mesh and options, with any number of threads.
///
/// Texture coordinates that the mesh has stay in [`Mesh::texture_uvs`], and its normal maps with the frames they were made
/// for; [`Mesh::tangents`] are made anew.
pub fn unwrap(mesh: &Mesh, options: &UnwrapOptions) -> Result<Unwrapped, UnwrapError> {
    finish(mesh, lay_out(mesh, options)?)
}

/// As [`unwrap`], from the cache where it is there and whole, else written there. The second value says whether it came
/// from the cache; one that cannot be written is a warning in the report.
pub fn unwrap_cached(
    cache_dir: Option<&Path>,
    mesh: &Mesh,
    options: &UnwrapOptions,
) -> Result<(Unwrapped, bool), UnwrapError> {
    let Some(folder) = cache_dir else {
        return Ok((unwrap(mesh, options)?, false));
    };
    let key = keep::key(mesh, options);
    if let Some(sheet) = keep::read(folder, &key, mesh.triangles.len()) {
        return Ok((finish(mesh, sheet)?, true));
    }
    let mut sheet = lay_out(mesh, options)?;
    if let Some(warning) = keep::write(folder, &key, &sheet) {
        sheet.report.warnings.push(warning);
    }
    Ok((finish(mesh, sheet)?, false))
}

/// Where every corner of every triangle lies on the sheet.
#[derive(Clone, Debug, PartialEq)]
struct Sheet {
    corners: Vec<[[f32; 2]; 3]>,
    report: UnwrapReport,
}

fn lay_out(mesh: &Mesh, options: &UnwrapOptions) -> Result<Sheet, UnwrapError> {
    error::check(mesh, options)?;
    let pieces = pieces::pieces(mesh);
    let Flattened { charts, distinct } = flatten::flatten(mesh, &pieces);
    let mut sheet = sheet::pack(mesh, &charts, options.size);
    sheet.report.pieces = [pieces.len() as u32, distinct];
    Ok(sheet)
}

fn finish(mesh: &Mesh, sheet: Sheet) -> Result<Unwrapped, UnwrapError> {
    let (mesh, source_vertex) = redraw::redraw(mesh, &sheet.corners);
    Ok(Unwrapped {
        mesh,
        source_vertex,
        report: sheet.report,
    })
}
