//! The stencil over a view: its place there, and the drags that move, turn and size it.

use std::sync::Arc;

use egui::{Color32, Mesh, Painter, Pos2, Rect, Stroke, TextureId, Vec2, pos2, vec2};
use sabi_paint::StampPicture;

use super::decal::wrapped;
use crate::action::{Action, PaintAction};
use crate::settings::stencil::StencilChoices;

/// Distance from the middle of a handle within which it is taken, points.
const NEAR: f32 = 10.0;
/// Opacity of the picture over the model.
const OPACITY: f32 = 0.45;
/// Opacity while a stroke is drawn, which it would hide.
const FAINT: f32 = 0.12;

/// A stencil that strokes are painted through.
pub(crate) struct ShownStencil {
    pub(crate) choices: StencilChoices,
    pub(crate) picture: Arc<StampPicture>,
}

/// A stencil on the screen.
pub(crate) struct PlacedStencil {
    /// Middle of the stencil, which moves it.
    middle: Pos2,
    /// Vectors from the middle to its right side and to its upper side, in points.
    axes: [Vec2; 2],
}

/// Part of a stencil that is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum StencilPart {
    Middle,
    Side,
}

/// A stencil that is moved, or turned and sized.
pub(super) struct HeldStencil {
    choices: StencilChoices,
    view: Rect,
    part: StencilPart,
    /// Half of the picture's width, as a share of half its longer side.
    half_width: f32,
    /// Vector from the pointer to the handle, so that the handle does not jump.
    grip: Vec2,
}

impl PlacedStencil {
    /// The place of a stencil over a view.
    pub(crate) fn of(stencil: &ShownStencil, view: Rect) -> PlacedStencil {
        let unit = 0.5 * view.height();
        let choices = &stencil.choices;
        let [x, y] = choices.middle;
        let half_sides = stencil.picture.half_sides().as_vec2() * choices.size * unit;
        let (sine, cosine) = choices.angle_degrees.to_radians().sin_cos();
        PlacedStencil {
            middle: view.center() + unit * vec2(x, -y),
            axes: [half_sides.x * vec2(cosine, -sine), half_sides.y * vec2(-sine, -cosine)],
        }
    }

    /// The middle of its right side, which turns and sizes it.
    fn side(&self) -> Pos2 {
        self.middle + self.axes[0]
    }

    fn part_at(&self, at: Pos2) -> Option<(StencilPart, Vec2)> {
        let parts = [(StencilPart::Side, self.side()), (StencilPart::Middle, self.middle)];
        let near = parts.into_iter().find(|(_, handle)| handle.distance(at) <= NEAR);
        near.map(|(part, handle)| (part, handle - at))
    }

    /// Returns true if a handle is under a place of the screen.
    pub(crate) fn is_at(&self, at: Pos2) -> bool {
        self.part_at(at).is_some()
    }

    /// Draws the picture, its frame, and its handles.
    pub(crate) fn show(&self, painter: &Painter, picture: TextureId, accent: Color32, is_drawing: bool) {
        let [right, up] = self.axes;
        let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]]
            .map(|[x, y]: [f32; 2]| (self.middle + x * right + y * up, pos2(0.5 + 0.5 * x, 0.5 - 0.5 * y)));
        let mut mesh = Mesh::with_texture(picture);
        for (pos, uv) in corners {
            let color = Color32::WHITE.gamma_multiply(if is_drawing { FAINT } else { OPACITY });
            mesh.vertices.push(egui::epaint::Vertex { pos, uv, color });
        }
        mesh.indices = vec![0, 1, 2, 0, 2, 3];
        painter.add(mesh);
        let mut frame = corners.map(|(corner, _)| corner).to_vec();
        frame.push(frame[0]);
        painter.add(egui::Shape::dashed_line(&frame, Stroke::new(1.2, accent), 6.0, 4.0));
        for handle in [self.middle, self.side()] {
            painter.circle(handle, 5.0, accent, Stroke::new(1.6, Color32::WHITE));
        }
    }
}

impl HeldStencil {
    /// The stencil over a view, if one of its handles is under the pointer.
    pub(super) fn at(stencil: &ShownStencil, view: Rect, at: Pos2) -> Option<HeldStencil> {
        let (part, grip) = PlacedStencil::of(stencil, view).part_at(at)?;
        Some(HeldStencil {
            choices: stencil.choices.clone(),
            view,
            part,
            half_width: stencil.picture.half_sides().x as f32,
            grip,
        })
    }

    /// Follows the pointer; returns the action that changes the stencil.
    pub(super) fn drag(&self, pointer: Pos2) -> Action {
        let unit = 0.5 * self.view.height();
        let at = (pointer + self.grip - self.view.center()) / unit;
        let [x, y] = self.choices.middle;
        let changed = match self.part {
            StencilPart::Middle => StencilChoices {
                middle: [at.x, -at.y],
                ..self.choices.clone()
            },
            StencilPart::Side => {
                let way = vec2(at.x - x, -at.y - y);
                StencilChoices {
                    size: way.length() / self.half_width,
                    angle_degrees: wrapped(way.y.atan2(way.x).to_degrees()),
                    ..self.choices.clone()
                }
            }
        };
        Action::Paint(PaintAction::ChooseStencil(Box::new(changed.sanitized())))
    }
}

#[cfg(test)]
mod tests {
    use sabi_paint::{PictureName, PicturePart, PictureTip};

    use super::*;

    fn chosen(action: Action) -> StencilChoices {
        match action {
            Action::Paint(PaintAction::ChooseStencil(choices)) => *choices,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_stencil_follows_the_drags_of_its_handles() {
        let picture = PictureTip {
            picture: PictureName::of(b"wide", "png").expect("a name"),
            part: PicturePart::Alpha,
        };
        let wide = sabi_paint::StampPicture::of_alpha([8, 4], &[255; 32]);
        let stencil = ShownStencil {
            choices: StencilChoices::with_picture(picture),
            picture: Arc::new(wide),
        };
        let view = Rect::from_min_size(pos2(100.0, 50.0), vec2(600.0, 400.0));
        let held = HeldStencil::at(&stencil, view, view.center() + vec2(3.0, 0.0)).expect("its middle");
        let moved = chosen(held.drag(view.center() + vec2(103.0, -50.0)));
        assert_eq!((moved.middle, moved.size), ([0.5, 0.25], stencil.choices.size));
        let held = HeldStencil::at(&stencil, view, view.center() + vec2(120.0, 0.0)).expect("its side");
        let turned = chosen(held.drag(view.center() + vec2(0.0, -160.0)));
        assert!(
            (turned.size - 0.8).abs() < 1e-6 && (turned.angle_degrees - 90.0).abs() < 1e-4,
            "{turned:?}"
        );
        assert!(HeldStencil::at(&stencil, view, view.min).is_none());
    }
}
