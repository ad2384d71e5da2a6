//! The area around a place with about the same amount of paint.

use sabi_surface::atlas::{Atlas, EMPTY, GHOST_BIT};

use super::Canvas;
use crate::stroke::StrokePoint;
use crate::surface::PaintSurface;

/// Returns the texels of the connected area around some points whose cover differs from theirs by at most a tolerance,
/// including ghosts that show them. Ghosts continue the area across seams.
pub(super) fn similar_texels(
    surface: &PaintSurface<'_>,
    atlas: &Atlas,
    canvas: &Canvas,
    points: &[StrokePoint],
    tolerance: f32,
) -> Vec<usize> {
    let [columns, rows] = atlas.page_size.map(|side| side as usize);
    let cover = |texel: usize| canvas.texel(texel).cover;
    let mut is_filled = vec![false; atlas.owners.len()];
    for point in points {
        let Some(start) = texel_at(surface, atlas, point) else {
            continue;
        };
        let wanted = cover(start);
        let mut open = vec![start];
        is_filled[start] = true;
        while let Some(texel) = open.pop() {
            let (x, y) = (texel % columns, texel / columns % rows);
            let beside = [
                (x > 0).then(|| texel - 1),
                (x + 1 < columns).then(|| texel + 1),
                (y > 0).then(|| texel - columns),
                (y + 1 < rows).then(|| texel + columns),
            ];
            for next in beside.into_iter().flatten().filter_map(|next| shown_by(atlas, next)) {
                if !is_filled[next] && (cover(next) - wanted).abs() <= tolerance {
                    open.push(next);
                }
                // The texels at its border are filled as well, so that no gap is left before the paint at which the area ends.
                is_filled[next] = true;
            }
        }
    }
    let shows_filled = |texel: &usize| shown_by(atlas, *texel).is_some_and(|shown| is_filled[shown]);
    (0..atlas.owners.len()).filter(shows_filled).collect()
}

/// Returns the texel whose value a texel shows: itself, or for a ghost the texel beyond a seam; `None` for an empty one.
fn shown_by(atlas: &Atlas, texel: usize) -> Option<usize> {
    let owner = *atlas.owners.get(texel)?;
    if owner == EMPTY {
        return None;
    }
    if owner & GHOST_BIT == 0 {
        return Some(texel);
    }
    let ghost = &atlas.ghosts[(owner & !GHOST_BIT) as usize];
    let page = atlas.charts[atlas.triangle_chart[ghost.target_triangle as usize] as usize].page;
    let target = texel_of(atlas, page, ghost.target_texel.map(f64::from));
    target.filter(|target| atlas.owners[*target] & GHOST_BIT == 0)
}

/// Returns the index of the texel that contains a position on a page.
fn texel_of(atlas: &Atlas, page: u32, [x, y]: [f64; 2]) -> Option<usize> {
    let [columns, rows] = atlas.page_size.map(|side| side as usize);
    let is_inside = x >= 0.0 && y >= 0.0 && x < columns as f64 && y < rows as f64;
    is_inside.then(|| (page as usize * rows + y as usize) * columns + x as usize)
}

/// Returns the texel that shows a place of the surface.
fn texel_at(surface: &PaintSurface<'_>, atlas: &Atlas, point: &StrokePoint) -> Option<usize> {
    let triangle = point.site.triangle;
    let chart = &atlas.charts[*atlas.triangle_chart.get(triangle as usize)? as usize];
    let mesh = surface.mesh();
    let weights = surface.weights(point.site);
    let shares = [1.0 - weights.x - weights.y, weights.x, weights.y];
    let corners = mesh.triangles[triangle as usize].into_iter().zip(shares);
    let uv = corners.fold([0.0; 2], |[u, v], (vertex, share)| {
        let own = mesh.uvs[vertex as usize].map(f64::from);
        [u + share * own[0], v + share * own[1]]
    });
    let place = [0, 1].map(|axis| f64::from(atlas.size) * uv[axis] + f64::from(chart.texel_from_uv[axis]));
    texel_of(atlas, chart.page, place).and_then(|texel| shown_by(atlas, texel))
}
