//! The edges of a model's triangles in texture space.

use std::sync::Arc;

use egui::{Color32, ColorImage, Context, Painter, Pos2, Rect, Stroke, TextureHandle, TextureOptions, pos2, vec2};
use sabi_engine::live::LiveModel;
use sabi_engine::opening::linked_model::LinkedModel;
use sabi_export::SetKey;

use crate::task::Task;
use crate::theme::Theme;

/// Most lines that are drawn one by one: more are closer than pixels, and would slow down frames.
const MOST_LINES: usize = 20_000;
/// Pixels along a side of the picture that replaces them.
const SIDE: usize = 1024;

/// UV wires of the shown model, made on a thread of their own.
#[derive(Default)]
pub(super) struct Wires {
    /// Model and texture set that they are of.
    of: Option<(u64, SetKey)>,
    loading: Option<Task<EdgeDrawing>>,
    edges: Vec<[Pos2; 2]>,
    /// Picture that replaces many lines, and its rectangle in texture space.
    picture: Option<(TextureHandle, Rect)>,
}

/// Edges in texture space, with a picture of them if they are many.
#[derive(Default)]
struct EdgeDrawing {
    edges: Vec<[Pos2; 2]>,
    picture: Option<(ColorImage, Rect)>,
}

impl Wires {
    /// Draws the wires of a model's texture set over a texture, once they are made.
    pub(super) fn draw(&mut self, painter: &Painter, model: &Arc<LiveModel>, set: SetKey, square: Rect, theme: &Theme) {
        self.poll(painter.ctx(), model, set);
        let place = |at: Pos2| square.min + at.to_vec2() * square.size();
        let color = theme.accent.gamma_multiply(0.5);
        let clip = painter.clip_rect();
        let placed = self.edges.iter().map(|[start, end]| [place(*start), place(*end)]);
        let seen = placed.filter(|ends| clip.intersects(Rect::from_two_pos(ends[0], ends[1])));
        let few: Vec<[Pos2; 2]> = seen.take(MOST_LINES + 1).collect();
        match &self.picture {
            Some((texture, bounds)) if few.len() > MOST_LINES => {
                let rect = Rect::from_min_max(place(bounds.min), place(bounds.max));
                let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                painter.image(texture.id(), rect, whole, color);
            }
            _ => few.into_iter().for_each(|ends| {
                painter.line_segment(ends, Stroke::new(1.0, color));
            }),
        }
    }

    /// Starts making missing wires, and takes over finished ones.
    fn poll(&mut self, context: &Context, model: &Arc<LiveModel>, set: SetKey) {
        let wanted = (model.model_revision, set);
        if self.of != Some(wanted) && self.loading.is_none() {
            self.of = Some(wanted);
            let linked = model.linked.clone();
            self.loading = Some(Task::start(context, move || EdgeDrawing::of(edges_of(&linked, set))));
        }
        let Some(come) = self.loading.as_ref().and_then(Task::poll) else {
            return;
        };
        self.loading = None;
        // Where making them fails, the texture is shown without wires.
        let EdgeDrawing { edges, picture } = come.unwrap_or_default();
        self.edges = edges;
        self.picture = picture.map(|(image, bounds)| {
            let texture = context.load_texture("wires of a model", image, TextureOptions::LINEAR);
            (texture, bounds)
        });
    }
}

impl EdgeDrawing {
    fn of(edges: Vec<[Pos2; 2]>) -> EdgeDrawing {
        let picture = (edges.len() > MOST_LINES).then(|| picture_of(&edges));
        EdgeDrawing { edges, picture }
    }
}

/// Edges of a texture set's triangles, each once, where its texture reaches from 0 to 1.
fn edges_of(LinkedModel { model, atlas, .. }: &LinkedModel, set: SetKey) -> Vec<[Pos2; 2]> {
    let mesh = &model.mesh;
    let charts = mesh.triangles.iter().zip(&atlas.triangle_chart);
    let charts = charts.filter_map(|(triangle, chart)| Some((triangle, atlas.charts.get(*chart as usize)?)));
    let around =
        |[a, b, c]: [u32; 3], tile: [i32; 2]| [(a, b), (b, c), (c, a)].map(|(a, b)| (a.min(b), a.max(b), tile));
    let mut edges: Vec<(u32, u32, [i32; 2])> = charts
        .filter(|(_, chart)| set.is_home_of(chart))
        .flat_map(|(triangle, chart)| around(*triangle, chart.uv_tile))
        .collect();
    edges.sort_unstable();
    edges.dedup();
    let place = |vertex: u32, tile: [i32; 2]| {
        let [u, v] = *mesh.uvs.get(vertex as usize)?;
        Some(pos2(u - tile[0] as f32, v - tile[1] as f32))
    };
    let placed = edges.into_iter();
    placed
        .filter_map(|(one, other, tile)| Some([place(one, tile)?, place(other, tile)?]))
        .collect()
}

/// Picture of white lines on a transparent background, and its rectangle in texture space.
fn picture_of(edges: &[[Pos2; 2]]) -> (ColorImage, Rect) {
    let mut bounds = Rect::NOTHING;
    for end in edges.iter().flatten().filter(|end| end.is_finite()) {
        bounds.extend_with(*end);
    }
    let mut alphas = vec![0_u8; SIDE * SIDE];
    let scale = vec2(SIDE as f32, SIDE as f32) / bounds.size().max(egui::Vec2::splat(1e-6));
    let onto = |at: Pos2| ((at - bounds.min) * scale - vec2(0.5, 0.5)).to_pos2();
    for ends in edges.iter().filter(|ends| ends.iter().all(|end| end.is_finite())) {
        draw_line(&mut alphas, ends.map(onto));
    }
    let pixels = alphas.into_iter().map(Color32::from_white_alpha).collect();
    (ColorImage::new([SIDE, SIDE], pixels), bounds)
}

/// A line between two places in pixels, each of its steps shared by the two pixels beside it (after X. Wu 1991, "An efficient
/// antialiasing technique").
fn draw_line(alphas: &mut [u8], [start, end]: [Pos2; 2]) {
    let way = end - start;
    let steps = way.abs().max_elem().ceil().max(1.0) as usize;
    let is_flat = way.x.abs() >= way.y.abs();
    for step in 0..=steps {
        let at = start + way * (step as f32 / steps as f32);
        let (along, across) = if is_flat { (at.x, at.y) } else { (at.y, at.x) };
        let (along, first) = (along.round(), across.floor());
        for (across, share) in [(first, 1.0 - across + first), (first + 1.0, across - first)] {
            let (x, y) = if is_flat { (along, across) } else { (across, along) };
            let inside = 0.0..SIDE as f32;
            if inside.contains(&x) && inside.contains(&y) {
                let alpha = &mut alphas[y as usize * SIDE + x as usize];
                *alpha = (*alpha).max((share * 255.0) as u8);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Grid of this many squares along a side of the unit square.
    fn grid(side: usize) -> Vec<[Pos2; 2]> {
        let at = |column: usize, row: usize| pos2(column as f32, row as f32) / side as f32;
        let squares = (0..side).flat_map(|row| (0..side).map(move |column| (column, row)));
        squares
            .flat_map(|(column, row)| {
                [
                    [at(column, row), at(column + 1, row)],
                    [at(column, row), at(column, row + 1)],
                ]
            })
            .collect()
    }

    #[test]
    fn few_lines_are_drawn_as_lines_and_many_as_a_picture() {
        assert!(EdgeDrawing::of(grid(10)).picture.is_none());
        assert!(EdgeDrawing::of(grid(120)).picture.is_some());
    }

    #[test]
    fn the_picture_has_the_lines_where_they_are_and_nothing_between_them() {
        let (image, bounds) = picture_of(&grid(8));
        assert_eq!(bounds.min, Pos2::ZERO);
        let width = SIDE as f32 / bounds.width() / 8.0;
        let alpha_at = |column: f32, row: f32| {
            let [x, y] = [column, row].map(|at| ((at * width) as usize).min(SIDE - 1));
            image.pixels[y * SIDE + x].a()
        };
        assert!(alpha_at(0.5, 4.0) > 100, "a line along a row");
        assert!(alpha_at(3.0, 2.5) > 100, "a line along a column");
        assert_eq!(alpha_at(2.5, 4.5), 0, "the middle of a square");
    }

    #[test]
    fn lines_with_an_end_that_is_not_finite_are_left_out() {
        let wild = [pos2(f32::NAN, 0.0), pos2(f32::INFINITY, 2.0)];
        let mut edges = grid(4);
        edges.push(wild);
        assert_eq!(picture_of(&edges).0.pixels, picture_of(&grid(4)).0.pixels);
    }
}
