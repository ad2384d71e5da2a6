//! Texture coordinates for any model: cut into charts, flattened, packed onto one sheet without overlap.
//!
//! One file for each step: `components` (connected components, and similar ones among them), `flatten` (the charts of each
//! different component), `pack` (all charts at one scale on the unit square), `rebuild` (the mesh with vertices split along
//! the borders of charts, and tangents for the new coordinates). `cache` keeps results on disk.

mod area;
mod cache;
mod components;
mod error;
mod flatten;
mod pack;
mod rebuild;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;
use std::path::Path;

pub use self::error::UnwrapError;
use self::flatten::FlatCharts;
use crate::model::Mesh;

/// Free texels between two charts on maps of 1024 × 1024, and half as many along the sheet's border. On maps of other sizes
/// the gap is in proportion, since the layout is the same for all sizes.
pub const GAP: u32 = 4;

/// Texels along a side of the sheet while it is packed.
const PACKED_SIZE: u32 = 1024;
/// Largest size of the sheet in texels, used if there are too many charts for [`PACKED_SIZE`].
const FINEST_SIZE: u32 = 16_384;

/// A mesh on one sheet, or with some of its materials on new sheets.
///
/// `mesh` has the triangles of the mesh it was made from, in their order and with their materials and parts, and looks the
/// same: only vertices along the borders of charts are duplicated. To write it into a file, write its positions,
/// normals, tangents, colors and [`Mesh::texture_uvs`] as they are, and [`Mesh::uvs`] as one more `TEXCOORD`: the one after
/// the last of `texture_uvs`, or 0 if there is none. To change a file in place instead, `source_vertex` says for each vertex
/// which vertex of the loaded mesh it was.
#[derive(Clone, Debug, PartialEq)]
pub struct UnwrappedMesh {
    /// The mesh with its new texture coordinates.
    pub mesh: Mesh,
    /// For each vertex of `mesh` its vertex in the mesh that was unwrapped.
    pub source_vertex: Vec<u32>,
    /// Measurements and warnings.
    pub report: UnwrapReport,
}

/// Quality of an unwrapping.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UnwrapReport {
    /// Number of charts on the sheet.
    pub charts: u32,
    /// Number of connected components, and number of those that are not copies of another one.
    pub pieces: [u32; 2],
    /// Share of the sheet that triangles cover.
    pub coverage: f32,
    /// Stretch: ratio of the longest to the shortest direction of a triangle, averaged by area; 1 means none.
    pub stretch: f32,
    /// Worst stretch among the triangles with 99.9 % of the area.
    pub worst_stretch: f32,
    /// Texels between charts on maps of 1024 × 1024: [`GAP`], or fewer if there are too many charts.
    pub gap: f32,
    /// Sentences for the artist.
    pub warnings: Vec<String>,
}

impl UnwrapReport {
    /// Combines the reports of several sheets: counts are added, shares and stretches averaged, and for the others the worst is taken.
    fn of_sheets(sheets: Vec<UnwrapReport>) -> UnwrapReport {
        let mean = |value: fn(&UnwrapReport) -> f32| sheets.iter().map(value).sum::<f32>() / sheets.len().max(1) as f32;
        let mut whole = UnwrapReport {
            coverage: mean(|sheet| sheet.coverage),
            stretch: mean(|sheet| sheet.stretch),
            gap: sheets.iter().map(|sheet| sheet.gap).fold(GAP as f32, f32::min),
            ..UnwrapReport::default()
        };
        for sheet in sheets {
            whole.charts += sheet.charts;
            whole.pieces = [0, 1].map(|at| whole.pieces[at] + sheet.pieces[at]);
            whole.worst_stretch = whole.worst_stretch.max(sheet.worst_stretch);
            whole.warnings.extend(sheet.warnings);
        }
        whole
    }

    /// Texels between charts on maps of `size` × `size`.
    pub fn gap_at(&self, size: u32) -> f32 {
        self.gap * size as f32 / PACKED_SIZE as f32
    }
}

/// Unwraps a mesh: the same bytes for the same mesh, with any number of threads.
///
/// Texture coordinates that the mesh has stay in [`Mesh::texture_uvs`], and its normal maps with the frames they were made
/// for; [`Mesh::tangents`] are recomputed.
pub fn unwrap(mesh: &Mesh) -> Result<UnwrappedMesh, UnwrapError> {
    finish(mesh, lay_out(mesh)?)
}

/// Unwraps like [`unwrap`], but takes the result from the cache if it is stored there and intact. The second value is
/// whether it came from the cache. A cache that cannot be written is a warning in the report.
pub fn unwrap_cached(cache_dir: Option<&Path>, mesh: &Mesh) -> Result<(UnwrappedMesh, bool), UnwrapError> {
    let (layout, was_cached) = lay_out_cached(cache_dir, mesh)?;
    Ok((finish(mesh, layout)?, was_cached))
}

/// Unwraps the triangles of some materials like [`unwrap_cached`], with a separate sheet for each material. The other
/// triangles keep their texture coordinates, which the mesh must have. The report combines all sheets.
pub fn unwrap_materials(
    cache_dir: Option<&Path>,
    mesh: &Mesh,
    materials: &BTreeSet<u32>,
) -> Result<(UnwrappedMesh, bool), UnwrapError> {
    let kept = |triangle: &[u32; 3]| triangle.map(|vertex| mesh.uvs.get(vertex as usize).copied().unwrap_or([0.0; 2]));
    let mut corners: Vec<[[f32; 2]; 3]> = mesh.triangles.iter().map(kept).collect();
    let mut reports = Vec::new();
    let mut all_were_cached = true;
    for material in materials {
        let is_of_material = |triangle: &usize| mesh.triangle_material[*triangle] == *material;
        let triangles: Vec<usize> = (0..mesh.triangles.len()).filter(is_of_material).collect();
        let (layout, was_cached) = lay_out_cached(cache_dir, &part_of(mesh, &triangles))?;
        all_were_cached &= was_cached;
        for (triangle, made) in triangles.into_iter().zip(layout.corners) {
            corners[triangle] = made;
        }
        reports.push(layout.report);
    }
    let (mesh, source_vertex) = rebuild::rebuild(mesh, &corners, Some(materials));
    let unwrapped = UnwrappedMesh {
        mesh,
        source_vertex,
        report: UnwrapReport::of_sheets(reports),
    };
    Ok((unwrapped, all_were_cached))
}

/// The mesh with some of its triangles.
fn part_of(mesh: &Mesh, triangles: &[usize]) -> Mesh {
    let pick = |values: &[u32]| triangles.iter().map(|triangle| values[*triangle]).collect();
    Mesh {
        positions: mesh.positions.clone(),
        normals: mesh.normals.clone(),
        triangles: triangles.iter().map(|triangle| mesh.triangles[*triangle]).collect(),
        triangle_material: pick(&mesh.triangle_material),
        triangle_part: pick(&mesh.triangle_part),
        ..Mesh::default()
    }
}

fn lay_out_cached(cache_dir: Option<&Path>, mesh: &Mesh) -> Result<(UnwrapLayout, bool), UnwrapError> {
    let Some(folder) = cache_dir else {
        return Ok((lay_out(mesh)?, false));
    };
    let key = cache::key(mesh);
    if let Some(layout) = cache::read(folder, &key, mesh.triangles.len()) {
        return Ok((layout, true));
    }
    let mut layout = lay_out(mesh)?;
    if let Some(warning) = cache::write(folder, &key, &layout) {
        layout.report.warnings.push(warning);
    }
    Ok((layout, false))
}

/// Texture coordinates of every corner of every triangle, with the report on them.
#[derive(Clone, Debug, PartialEq)]
struct UnwrapLayout {
    corners: Vec<[[f32; 2]; 3]>,
    report: UnwrapReport,
}

fn lay_out(mesh: &Mesh) -> Result<UnwrapLayout, UnwrapError> {
    error::check(mesh)?;
    let components = components::components(mesh);
    let FlatCharts {
        charts,
        distinct,
        warnings,
    } = flatten::flatten(mesh, &components);
    let mut layout = pack::pack(mesh, &charts, [PACKED_SIZE, FINEST_SIZE])?;
    layout.report.warnings.splice(0..0, warnings);
    layout.report.pieces = [components.len() as u32, distinct];
    Ok(layout)
}

fn finish(mesh: &Mesh, layout: UnwrapLayout) -> Result<UnwrappedMesh, UnwrapError> {
    let (mesh, source_vertex) = rebuild::rebuild(mesh, &layout.corners, None);
    Ok(UnwrappedMesh {
        mesh,
        source_vertex,
        report: layout.report,
    })
}
