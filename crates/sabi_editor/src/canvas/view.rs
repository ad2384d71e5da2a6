//! Pan and zoom of the canvas.

use egui::{Pos2, Rect, Vec2, pos2, vec2};

/// Lowest zoom by the wheel and by drags.
pub(crate) const LEAST_ZOOM: f32 = 0.1;
/// Lowest zoom that shows a whole graph, however wide it is.
const LEAST_FRAMED_ZOOM: f32 = 0.01;
/// Highest zoom.
pub(crate) const MOST_ZOOM: f32 = 3.0;
/// Margin around nodes that are zoomed to, points.
const FREE: f32 = 40.0;

/// Pan and zoom of the canvas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CanvasView {
    /// Canvas origin relative to the corner of the panel, screen points.
    pub(crate) pan: Vec2,
    /// Screen points in one canvas point.
    pub(crate) zoom: f32,
}

impl Default for CanvasView {
    fn default() -> CanvasView {
        CanvasView {
            pan: vec2(FREE, FREE),
            zoom: 1.0,
        }
    }
}

impl CanvasView {
    /// Place on the screen of a place on the canvas.
    pub(crate) fn screen(&self, panel: Rect, place: [f32; 2]) -> Pos2 {
        panel.min + self.pan + vec2(place[0], place[1]) * self.zoom
    }

    /// Place on the canvas of a place on the screen.
    pub(crate) fn place(&self, panel: Rect, at: Pos2) -> [f32; 2] {
        let place = (at - panel.min - self.pan) / self.zoom;
        [place.x, place.y]
    }

    /// Part of the canvas in the panel.
    pub(crate) fn visible_rect(&self, panel: Rect) -> Rect {
        let [low, high] = [panel.min, panel.max].map(|corner| self.place(panel, corner));
        Rect::from_min_max(pos2(low[0], low[1]), pos2(high[0], high[1]))
    }

    /// Rectangle on the screen of a rectangle on the canvas.
    pub(crate) fn screen_rect(&self, panel: Rect, rect: Rect) -> Rect {
        let corner = |at: Pos2| self.screen(panel, [at.x, at.y]);
        Rect::from_min_max(corner(rect.min), corner(rect.max))
    }

    /// Multiplies the zoom, with the place under the pointer fixed.
    pub(crate) fn zoom_at(&mut self, panel: Rect, pointer: Pos2, factor: f32) {
        if !(factor.is_finite() && factor > 0.0) {
            return;
        }
        let held = self.place(panel, pointer);
        self.zoom = (self.zoom * factor).clamp(LEAST_ZOOM.min(self.zoom), MOST_ZOOM);
        let moved = self.screen(panel, held);
        self.pan += pointer - moved;
    }

    /// Pans by the least distance that shows a rectangle of the canvas, or its upper left corner if it is larger than
    /// the panel.
    pub(crate) fn pan_to(&mut self, panel: Rect, rect: Rect) {
        let (shown, room) = (
            self.screen_rect(panel, rect),
            panel.shrink(FREE.min(panel.size().min_elem() / 4.0)),
        );
        let low = (room.min - shown.min).max(Vec2::ZERO);
        let high = (room.max - shown.max).min(Vec2::ZERO);
        // On each axis at most one of both is not zero, unless the rectangle is larger than the panel.
        self.pan += vec2(
            if low.x > 0.0 {
                low.x
            } else {
                high.x.max(room.left() - shown.left())
            },
            if low.y > 0.0 {
                low.y
            } else {
                high.y.max(room.top() - shown.top())
            },
        );
    }

    /// Zooms to a rectangle of the canvas, at a zoom of at most 1.
    pub(crate) fn frame(&mut self, panel: Rect, rect: Rect) {
        if !(rect.is_finite() && panel.is_positive()) {
            return;
        }
        let room = (panel.size() - Vec2::splat(2.0 * FREE)).max(Vec2::splat(1.0));
        let needed = rect.size().max(Vec2::splat(1.0));
        self.zoom = (room / needed).min_elem().clamp(LEAST_FRAMED_ZOOM, 1.0);
        self.pan = panel.size() / 2.0 - rect.center().to_vec2() * self.zoom;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PANEL: Rect = Rect {
        min: pos2(100.0, 50.0),
        max: pos2(900.0, 650.0),
    };

    #[test]
    fn a_graph_of_any_width_fits_and_is_zoomed_without_a_jump() {
        let mut view = CanvasView::default();
        let wide = Rect::from_min_max(pos2(-500.0, 0.0), pos2(29_500.0, 400.0));
        view.frame(PANEL, wide);
        assert!(PANEL.contains_rect(view.screen_rect(PANEL, wide)));
        let zoom = view.zoom;
        assert!(zoom < LEAST_ZOOM);
        view.zoom_at(PANEL, PANEL.center(), 1.1);
        assert!((view.zoom / zoom - 1.1).abs() < 1e-4);
        view.frame(PANEL, wide);
        view.zoom_at(PANEL, PANEL.center(), 0.5);
        assert_eq!(view.zoom, zoom, "the wheel goes no further out");
    }

    #[test]
    fn zooming_keeps_the_place_under_the_pointer() {
        let mut view = CanvasView::default();
        let pointer = pos2(333.0, 222.0);
        let held = view.place(PANEL, pointer);
        for factor in [1.3, 0.2, 9.0, f32::NAN, 0.0] {
            view.zoom_at(PANEL, pointer, factor);
            assert!((view.screen(PANEL, held) - pointer).length() < 1e-3, "{factor}");
            assert!((LEAST_ZOOM..=MOST_ZOOM).contains(&view.zoom));
        }
    }

    #[test]
    fn a_pan_shows_a_rectangle_that_was_outside_and_keeps_the_zoom() {
        for corner in [[-900.0, 20.0], [2000.0, -700.0], [100.0, 3000.0], [10.0, 10.0]] {
            let rect = Rect::from_min_size(pos2(corner[0], corner[1]), vec2(200.0, 150.0));
            let mut view = CanvasView::default();
            let before = view;
            view.pan_to(PANEL, rect);
            assert!(PANEL.contains_rect(view.screen_rect(PANEL, rect)), "{corner:?}");
            assert_eq!(view.zoom, before.zoom);
            let is_inside = PANEL.shrink(FREE).contains_rect(before.screen_rect(PANEL, rect));
            assert_eq!(view == before, is_inside, "{corner:?}: what is seen stays where it is");
        }
        let mut view = CanvasView::default();
        let large = Rect::from_min_size(pos2(-5000.0, -5000.0), vec2(4000.0, 4000.0));
        view.pan_to(PANEL, large);
        assert!(PANEL.contains(view.screen_rect(PANEL, large).min));
    }

    #[test]
    fn a_framed_rectangle_is_fully_in_view_and_centered() {
        for size in [[10.0, 10.0], [4000.0, 200.0], [100.0, 4000.0]] {
            let rect = Rect::from_min_size(pos2(-300.0, 700.0), vec2(size[0], size[1]));
            let mut view = CanvasView::default();
            view.frame(PANEL, rect);
            let shown = view.screen_rect(PANEL, rect);
            assert!(PANEL.contains_rect(shown), "{shown:?}");
            assert!((shown.center() - PANEL.center()).length() < 0.1);
            assert!(view.zoom <= 1.0);
        }
    }
}
