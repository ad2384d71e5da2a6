//! Strokes that are painted through a picture over the viewport.

use egui::{Modifiers, PointerButton, Pos2, Rect, vec2};
use glam::{DVec2, DVec4};
use sabi_paint::PicturePart;
use sabi_view::Lens;

use super::Window;
use super::painting::painting_on;
use crate::settings::stencil::StencilChoices;

/// A window that paints through a picture of 8 by 4 pixels.
fn stenciled() -> Window {
    let mut window = painting_on("mask");
    let strokes = window.document().session.graph().strokes.clone();
    let picture = strokes.keep_shapes([8, 4], &[255; 32]).expect("a picture");
    let tip = sabi_paint::PictureTip {
        picture,
        part: PicturePart::Alpha,
    };
    window.harness.state_mut().shell.settings.stencil = StencilChoices::with_picture(tip);
    window.settle();
    window
}

impl Window {
    fn stencil(&mut self) -> &mut StencilChoices {
        &mut self.harness.state_mut().shell.settings.stencil
    }

    fn cell(&self) -> Rect {
        self.editor().views.model.main_cell().expect("a view")
    }
}

/// Place of a stencil under a place of the view, counted from the middle of the stencil.
fn expected(choices: &StencilChoices, cell: Rect, at: Pos2) -> DVec2 {
    let unit = 0.5 * f64::from(cell.height());
    let way = at - cell.center();
    let place = DVec2::new(f64::from(way.x), -f64::from(way.y)) / unit - DVec2::from(choices.middle.map(f64::from));
    let back = DVec2::from_angle(-f64::from(choices.angle_degrees).to_radians());
    back.rotate(place) / (f64::from(choices.size) * DVec2::new(1.0, 0.5))
}

#[test]
fn a_stroke_keeps_the_stencil_as_it_lies_over_the_model() {
    for lens in [Lens::Perspective, Lens::Orthographic] {
        let mut window = stenciled();
        *window.stencil() = StencilChoices {
            middle: [0.3, -0.2],
            size: 0.8,
            angle_degrees: 40.0,
            ..window.stencil().clone()
        };
        window.harness.state_mut().views.model.navigation.camera.lens = lens;
        window.settle();
        let way = window.way();
        window.drag_along(&way, PointerButton::Primary, Modifiers::NONE);
        let list = window.list("mask").expect("a stroke");
        let stroke = list.strokes.last().expect("a stroke");
        let stencil = stroke.stencil.as_ref().expect("a stencil");
        let place = stroke.points[0].site.position.extend(1.0);
        let [x, y, depth] = stencil.picture_from_model.map(|row| DVec4::from(row).dot(place));
        let found = DVec2::new(x, y) / depth;
        let (choices, cell) = (window.stencil().clone(), window.cell());
        let wanted = expected(&choices, cell, way[0]);
        assert!(found.distance(wanted) < 1e-3, "{lens:?} {found} {wanted}");
    }
}

#[test]
fn drags_of_its_handles_move_turn_and_size_the_stencil_and_paint_nothing() {
    let mut window = stenciled();
    let cell = window.cell();
    let middle = cell.center();
    window.drag(
        middle,
        middle + vec2(40.0, -20.0),
        PointerButton::Primary,
        Modifiers::NONE,
    );
    let unit = 0.5 * cell.height();
    let moved = window.stencil().clone();
    assert!(
        (moved.middle[0] - 40.0 / unit).abs() < 1e-3 && (moved.middle[1] - 20.0 / unit).abs() < 1e-3,
        "{moved:?}"
    );
    let middle = middle + vec2(40.0, -20.0);
    let side = middle + vec2(moved.size * unit, 0.0);
    window.drag(
        side,
        middle + vec2(0.0, -0.5 * unit),
        PointerButton::Primary,
        Modifiers::NONE,
    );
    let turned = window.stencil().clone();
    assert!(
        (turned.angle_degrees - 90.0).abs() < 1.0 && (turned.size - 0.5).abs() < 0.01,
        "{turned:?}"
    );
    assert!(window.list("mask").is_none(), "nothing is painted");
}
