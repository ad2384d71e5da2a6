//! Tables of triangles and pieces that kernels read, in working units.

use rayon::prelude::*;
use sabi_surface::atlas::Atlas;
use sabi_surface::model::Mesh;
use sabi_surface::pieces::Pieces;

/// Rows of four floats for each triangle in [`SurfaceTables::geometry`].
pub(crate) const GEOMETRY_ROWS: usize = 6;
/// Rows of four floats for each triangle in [`SurfaceTables::frames`].
pub(crate) const FRAME_ROWS: usize = 4;
/// Rows of four floats for each piece in [`SurfaceTables::pieces`].
pub(crate) const PIECE_ROWS: usize = 3;

/// Rows of four floats for each triangle; see `shaders/surface/place.wgsl`, which reads them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceTables {
    /// Six rows per triangle: origin, change of the origin per texel along u and v, and the same for the normal. The fourth
    /// column holds the reference texel (x, y), the texel's width (negative on mirrored charts), the part's number, the
    /// piece's seed, and the material's number; numbers and seed are bit patterns.
    pub geometry: Vec<[f32; 4]>,
    /// Four rows per triangle: tangent, its change per texel along u and v, then the chart's place and its number in the
    /// atlas. The fourth column holds the number of the chart in UV, the chart's page combined with the sign of the
    /// bitangent (`page_and_sign`), the size of the piece, and the piece's number; numbers are bit patterns.
    pub frames: Vec<[f32; 4]>,
    /// Three rows per piece: the axes of its box, longest side first. The fourth column holds the center of the box.
    pub pieces: Vec<[f32; 4]>,
}

impl SurfaceTables {
    /// Sign of the bitangent of a triangle.
    pub fn bitangent_sign(&self, triangle: usize) -> f32 {
        let [.., page_and_sign] = self.frames[FRAME_ROWS * triangle + 1];
        if page_and_sign.to_bits() & 1 == 0 { 1.0 } else { -1.0 }
    }

    /// Tables of a mesh and its pieces, scaled by `working_from_model`.
    pub fn new(mesh: &Mesh, pieces: &Pieces, atlas: &Atlas, working_from_model: f64, seed: u32) -> SurfaceTables {
        let rows: Vec<TriangleRows> = (0..mesh.triangles.len())
            .into_par_iter()
            .map(|triangle| {
                let piece = pieces.triangle_piece[triangle];
                let size = (f64::from(pieces.boxes[piece as usize].typical_size()) * working_from_model) as f32;
                triangle_rows(mesh, piece, size, atlas, triangle, working_from_model, seed)
            })
            .collect();
        let piece_rows = pieces.boxes.iter().flat_map(|piece| {
            let middle = piece.center.map(|x| (f64::from(x) * working_from_model) as f32);
            let axis = |at: usize| {
                let [x, y, z] = piece.axes[at];
                [x, y, z, middle[at]]
            };
            [axis(0), axis(1), axis(2)]
        });
        let mut tables = SurfaceTables {
            pieces: piece_rows.collect(),
            ..SurfaceTables::default()
        };
        tables.geometry.reserve(GEOMETRY_ROWS * rows.len());
        tables.frames.reserve(FRAME_ROWS * rows.len());
        for (geometry, frames) in rows {
            tables.geometry.extend(geometry);
            tables.frames.extend(frames);
        }
        tables
    }
}

/// Returns twice the page of a chart, plus 1 if the bitangent is reversed.
pub(crate) fn page_and_sign(page: u32, bitangent_sign: f32) -> f32 {
    f32::from_bits(2 * page + u32::from(bitangent_sign < 0.0))
}

/// Returns the area vector of a texel of a triangle, which points along the triangle's normal; reversed on mirrored charts.
pub(crate) fn texel_area_vector(rows: &[[f32; 4]; GEOMETRY_ROWS]) -> [f64; 3] {
    let [[a, b, c, _], [d, e, f, _]] = [rows[1], rows[2]].map(|row| row.map(f64::from));
    [b * f - c * e, c * d - a * f, a * e - b * d]
}

/// Rows of one triangle: geometry and frames.
type TriangleRows = ([[f32; 4]; GEOMETRY_ROWS], [[f32; 4]; FRAME_ROWS]);

/// Returns a quantity that is linear over a triangle: its value at the first corner and its change per texel along u and v.
fn affine(corners: [[f64; 3]; 3], inverse: [[f64; 2]; 2]) -> [[f64; 3]; 3] {
    let mut rows = [corners[0], [0.0; 3], [0.0; 3]];
    for axis in 0..3 {
        let first = corners[1][axis] - corners[0][axis];
        let second = corners[2][axis] - corners[0][axis];
        rows[1][axis] = first * inverse[0][0] + second * inverse[1][0];
        rows[2][axis] = first * inverse[0][1] + second * inverse[1][1];
    }
    rows
}

/// Returns the inverse of the matrix whose rows are the two edges at the first corner, in texels; zero if the triangle has no area.
fn edge_inverse(texels: [[f32; 2]; 3]) -> [[f64; 2]; 2] {
    let edge = |to: usize, axis: usize| f64::from(texels[to][axis]) - f64::from(texels[0][axis]);
    let (a, b, c, d) = (edge(1, 0), edge(1, 1), edge(2, 0), edge(2, 1));
    let determinant = a * d - b * c;
    if determinant.abs() < 1e-12 {
        return [[0.0; 2]; 2];
    }
    // The columns are the weights of the first and the second edge for a step along u and along v.
    [[d / determinant, -c / determinant], [-b / determinant, a / determinant]]
}

fn triangle_rows(
    mesh: &Mesh,
    piece: u32,
    piece_size: f32,
    atlas: &Atlas,
    triangle: usize,
    working_from_model: f64,
    seed: u32,
) -> TriangleRows {
    let corners = mesh.triangles[triangle].map(|vertex| vertex as usize);
    let texels = atlas.triangle_texels[triangle];
    let inverse = edge_inverse(texels);
    let scaled = |v: [f32; 3]| v.map(|x| f64::from(x) * working_from_model);
    let position = affine(corners.map(|corner| scaled(mesh.positions[corner])), inverse);
    let normal = affine(corners.map(|corner| mesh.normals[corner].map(f64::from)), inverse);
    let tangent = affine(
        corners.map(|corner| {
            let [x, y, z, _] = mesh.tangents[corner].map(f64::from);
            [x, y, z]
        }),
        inverse,
    );
    let length = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let width = length(position[1]).max(length(position[2]));
    let chart = &atlas.charts[atlas.triangle_chart[triangle] as usize];
    let signed_width = if chart.mirrored { -width.max(1e-30) } else { width };
    let part = mesh.triangle_part[triangle];
    let row = |v: [f64; 3], w: f32| [v[0] as f32, v[1] as f32, v[2] as f32, w];
    let geometry = [
        row(position[0], texels[0][0]),
        row(position[1], texels[0][1]),
        row(position[2], signed_width as f32),
        row(normal[0], f32::from_bits(part)),
        row(normal[1], f32::from_bits(sabi_plan::pcg(seed ^ sabi_plan::pcg(piece)))),
        row(normal[2], f32::from_bits(mesh.triangle_material[triangle])),
    ];
    let [offset_u, offset_v] = chart.texel_from_uv;
    let frames = [
        row(tangent[0], f32::from_bits(chart.uv_chart)),
        row(tangent[1], page_and_sign(chart.page, mesh.tangents[corners[0]][3])),
        row(tangent[2], piece_size),
        [
            offset_u as f32,
            offset_v as f32,
            f32::from_bits(atlas.triangle_chart[triangle]),
            f32::from_bits(piece),
        ],
    ];
    (geometry, frames)
}
