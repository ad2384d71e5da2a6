//! Values at the vertices of triangles, as tables on the device. They change linearly over a triangle.

use rayon::prelude::*;
use sabi_gpu::{COORDINATE_ROWS, COORDINATE_ROWS_WITH_TANGENTS, DeviceTable, GpuError, SourceCanvas};
use sabi_surface::model::TextureUvs;

use super::texels::SourceSurface;

/// Returns the change of the weights of the second and of the third corner of a triangle per texel along u and along v; 0
/// for a triangle without area.
pub(super) fn weight_changes(surface: &SourceSurface<'_>, triangle: usize) -> [[f64; 2]; 2] {
    let uvs = &surface.model.mesh.uvs;
    let size = f64::from(surface.atlas.size);
    let [a, b, c] = surface.model.mesh.triangles[triangle].map(|vertex| uvs[vertex as usize].map(f64::from));
    let edge = |to: [f64; 2]| [0, 1].map(|axis: usize| (to[axis] - a[axis]) * size);
    let ([bx, by], [cx, cy]) = (edge(b), edge(c));
    let area = bx * cy - by * cx;
    if area == 0.0 {
        return [[0.0; 2]; 2];
    }
    [[cy / area, -cx / area], [-by / area, bx / area]]
}

/// Texture coordinates of a set on the atlas.
#[derive(Clone, Copy)]
pub(super) struct Coordinates<'a> {
    /// The set; `None` if it is that of the atlas.
    pub(super) other: Option<&'a TextureUvs>,
    /// True for a triangle with coordinates of the set.
    pub(super) covers: &'a (dyn Fn(usize) -> bool + Sync),
}

impl Coordinates<'_> {
    /// Rows of a triangle.
    pub(super) fn row_count(&self) -> u32 {
        match self.other {
            Some(other) if !other.tangents.is_empty() => COORDINATE_ROWS_WITH_TANGENTS,
            _ => COORDINATE_ROWS,
        }
    }

    /// Uploads the coordinates and tangents of all triangles, see `shaders/source/coordinates.wgsl`.
    ///
    /// # Errors
    /// The device refuses.
    pub(super) fn upload(
        &self,
        canvas: &SourceCanvas<'_>,
        surface: &SourceSurface<'_>,
    ) -> Result<DeviceTable, GpuError> {
        let count = self.row_count() as usize;
        let mut rows = vec![[0; 4]; count * surface.model.mesh.triangles.len()];
        let each = rows.par_chunks_mut(count).enumerate();
        each.for_each(|(triangle, rows)| self.fill(surface, triangle, rows));
        canvas.table("texture coordinates", &rows)
    }

    /// Rows of one triangle.
    fn fill(&self, surface: &SourceSurface<'_>, triangle: usize, rows: &mut [[u32; 4]]) {
        let put = |row: [f64; 4]| row.map(|value| (value as f32).to_bits());
        let covers = f64::from(u8::from((self.covers)(triangle)));
        let corners = surface.model.mesh.triangles[triangle].map(|vertex| vertex as usize);
        let [second, third] = weight_changes(surface, triangle);
        let Some(other) = self.other else {
            let [u, v] = surface.model.mesh.uvs[corners[0]].map(f64::from);
            let step = 1.0 / f64::from(surface.atlas.size);
            rows[0] = put([u, v, covers, 0.0]);
            rows[1] = put([step, 0.0, 0.0, step]);
            return;
        };
        let uvs = corners.map(|corner| other.uvs[corner].map(f64::from));
        let change = |axis: usize| {
            [0, 1].map(|component: usize| {
                (uvs[1][component] - uvs[0][component]) * second[axis]
                    + (uvs[2][component] - uvs[0][component]) * third[axis]
            })
        };
        let ([u_u, v_u], [u_v, v_v]) = (change(0), change(1));
        let tangents =
            (!other.tangents.is_empty()).then(|| corners.map(|corner| other.tangents[corner].map(f64::from)));
        let sign = tangents.map_or(0.0, |tangents| tangents[0][3]);
        rows[0] = put([uvs[0][0], uvs[0][1], covers, sign]);
        rows[1] = put([u_u, v_u, u_v, v_v]);
        if let (Some([a, b, c]), [_, _, start, along, across]) = (tangents, rows) {
            let change = |axis: usize| {
                let part = |at: usize| (b[at] - a[at]) * second[axis] + (c[at] - a[at]) * third[axis];
                put([part(0), part(1), part(2), 0.0])
            };
            *start = put([a[0], a[1], a[2], 0.0]);
            *along = change(0);
            *across = change(1);
        }
    }
}
