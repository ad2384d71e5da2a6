//! The brush in the 2D view: the place of the model that a texel shows.

use std::sync::{Arc, OnceLock, Weak};

use egui::{Pos2, Rect};
use glam::{DVec2, DVec3};
use sabi_engine::live::LiveModel;
use sabi_engine::opening::linked_model::LinkedModel;
use sabi_export::SetKey;
use sabi_paint::Eye;
use sabi_surface::patch::Site;

use super::triangle_grid::TriangleGrid;
use crate::brush::{PaintView, ShownStencil};

/// Grids over the triangles of the shown model: that of the texture set that was asked for last.
#[derive(Default)]
pub(super) struct TriangleGrids {
    of: Option<(Weak<LinkedModel>, SetKey)>,
    grid: Arc<OnceLock<TriangleGrid>>,
}

/// A texture set as it is shown in a square of the screen.
pub(super) struct SeenTexture {
    pub(super) square: Rect,
    pub(super) set: SetKey,
    /// Its triangles on the shown model ([`TriangleGrids::of`]); sorted when a place is first asked for.
    pub(super) triangles: Arc<OnceLock<TriangleGrid>>,
}

impl TriangleGrids {
    /// The triangles of a texture set of a model. Nothing is sorted yet.
    pub(super) fn of(&mut self, model: &LiveModel, set: SetKey) -> Arc<OnceLock<TriangleGrid>> {
        let wanted = (Arc::downgrade(&model.linked), set);
        let is_known = |(linked, of): &(Weak<LinkedModel>, SetKey)| linked.ptr_eq(&wanted.0) && *of == set;
        if !self.of.as_ref().is_some_and(is_known) {
            self.of = Some(wanted);
            self.grid = Arc::default();
        }
        Arc::clone(&self.grid)
    }
}

impl PaintView for SeenTexture {
    /// The first triangle of the set over a place; others that lie there, too, show the same texels.
    fn site(&self, model: &LiveModel, at: Pos2) -> Option<Site> {
        let share = (at - self.square.min) / self.square.size();
        let at = DVec2::new(f64::from(share.x), f64::from(share.y));
        let linked = &*model.linked;
        let triangles = self.triangles.get_or_init(|| grid_of(linked, self.set));
        triangles.first(at, |triangle| {
            let weights = weights(at, corners_in(linked, self.set, triangle)?)?;
            Some(Site {
                triangle,
                position: linked.model.mesh.position(triangle, weights),
            })
        })
    }

    fn eye(&self, _: &LiveModel) -> Option<Eye> {
        None
    }

    fn stencil_view(&self) -> Option<Rect> {
        None
    }

    fn stencil_map(&self, _: &LiveModel, _: &ShownStencil) -> Option<[[f64; 4]; 3]> {
        None
    }

    fn joins(&self, model: &LiveModel, [from, to]: [Site; 2]) -> bool {
        let atlas = &model.linked.atlas;
        let is_known = |site: Site| (site.triangle as usize) < atlas.triangle_chart.len();
        let chart = |site: Site| is_known(site).then(|| atlas.uv_chart(site.triangle as usize));
        chart(from) == chart(to)
    }

    fn place(&self, model: &LiveModel, site: Site) -> Option<Pos2> {
        let linked = &model.linked;
        let mesh = &linked.model.mesh;
        let corners = mesh.triangles.get(site.triangle as usize)?;
        let chart = linked.atlas.triangle_chart.get(site.triangle as usize)?;
        let chart = linked
            .atlas
            .charts
            .get(*chart as usize)
            .filter(|chart| self.set.is_home_of(chart))?;
        let [a, b, c] = mesh.corners(site.triangle);
        let (x, normal) = (b - a, (b - a).cross(c - a));
        let y = normal.cross(x);
        let flat = |place: DVec3| DVec2::new((place - a).dot(x), (place - a).dot(y));
        let weights = weights(flat(site.position), [flat(a), flat(b), flat(c)])?;
        let uv = corners.iter().zip(weights).map(|(vertex, weight)| {
            let [u, v] = mesh.uvs[*vertex as usize].map(f64::from);
            weight * DVec2::new(u, v)
        });
        let share = uv.sum::<DVec2>() - DVec2::from(chart.uv_tile.map(f64::from));
        let place = egui::vec2(share.x as f32, share.y as f32) * self.square.size();
        Some(self.square.min + place)
    }
}

/// The triangles of a texture set, sorted by their places in its square.
fn grid_of(linked: &LinkedModel, set: SetKey) -> TriangleGrid {
    let triangles = 0..linked.model.mesh.triangles.len() as u32;
    TriangleGrid::new(triangles.filter_map(|triangle| {
        let [a, b, c] = corners_in(linked, set, triangle)?;
        Some((triangle, [a.min(b).min(c), a.max(b).max(c)]))
    }))
}

/// Corners of a triangle in the square of a texture set; `None` for a triangle of another set.
fn corners_in(linked: &LinkedModel, set: SetKey, triangle: u32) -> Option<[DVec2; 3]> {
    let mesh = &linked.model.mesh;
    let chart = linked.atlas.triangle_chart.get(triangle as usize)?;
    let chart = linked
        .atlas
        .charts
        .get(*chart as usize)
        .filter(|chart| set.is_home_of(chart))?;
    let tile = DVec2::from(chart.uv_tile.map(f64::from));
    let place = |vertex: u32| Some(DVec2::from(mesh.uvs.get(vertex as usize)?.map(f64::from)) - tile);
    let [a, b, c] = *mesh.triangles.get(triangle as usize)?;
    Some([place(a)?, place(b)?, place(c)?])
}

/// Weights of the corners of a triangle at a place in it, a little beyond its edges, too; `None` elsewhere.
fn weights(at: DVec2, [a, b, c]: [DVec2; 3]) -> Option<[f64; 3]> {
    let area = (b - a).perp_dot(c - a);
    if area == 0.0 {
        return None;
    }
    let of_b = (at - a).perp_dot(c - a) / area;
    let of_c = (b - a).perp_dot(at - a) / area;
    let weights = [1.0 - of_b - of_c, of_b, of_c];
    weights.iter().all(|weight| *weight >= -1e-6).then_some(weights)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_those_of_the_corners_and_there_are_none_outside() {
        let corners = [DVec2::ZERO, DVec2::new(2.0, 0.0), DVec2::new(0.0, 4.0)];
        assert_eq!(weights(DVec2::new(0.5, 1.0), corners), Some([0.5, 0.25, 0.25]));
        assert_eq!(weights(DVec2::new(2.0, 4.0), corners), None);
        assert_eq!(weights(DVec2::ZERO, [DVec2::ZERO; 3]), None);
    }
}
