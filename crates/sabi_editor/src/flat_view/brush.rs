//! The brush in the 2D view: the place of the model that a texel shows.

use egui::{Pos2, Rect};
use glam::{DVec2, DVec3};
use sabi_engine::paint::{Eye, Site};
use sabi_engine::{LiveModel, SetKey};

use crate::brush::Canvas;

/// A texture set as it is shown in a square of the screen.
pub(super) struct SeenTexture {
    pub(super) square: Rect,
    pub(super) set: SetKey,
}

impl Canvas for SeenTexture {
    /// The first triangle of the set over a place; others that lie there, too, show the same texels.
    fn site(&self, model: &LiveModel, at: Pos2) -> Option<Site> {
        let share = (at - self.square.min) / self.square.size();
        let at = DVec2::new(f64::from(share.x), f64::from(share.y));
        let linked = &model.linked;
        let mesh = &linked.model.mesh;
        let mut charts = mesh.triangles.iter().zip(&linked.atlas.triangle_chart).enumerate();
        charts.find_map(|(triangle, (corners, chart))| {
            let chart = linked
                .atlas
                .charts
                .get(*chart as usize)
                .filter(|chart| self.set.is_home_of(chart))?;
            let tile = DVec2::from(chart.uv_tile.map(f64::from));
            let place = |vertex: u32| Some(DVec2::from(mesh.uvs.get(vertex as usize)?.map(f64::from)) - tile);
            let [a, b, c] = [place(corners[0])?, place(corners[1])?, place(corners[2])?];
            let weights = weights(at, [a, b, c])?;
            let triangle = triangle as u32;
            Some(Site {
                triangle,
                position: mesh.position(triangle, weights),
            })
        })
    }

    fn eye(&self, _: &LiveModel) -> Option<Eye> {
        None
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

/// Weights of the corners of a triangle at a place in it, a little beyond its edges, too; none elsewhere.
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
