//! The model under a place of the screen, and the pen over it.

use egui::{Pos2, Vec2, vec2};
use glam::DVec3;
use sabi_engine::live::LiveModel;
use sabi_paint::{PaintSurface, Shaft, StrokePoint, SurfaceIndex, Touch, rightward};

use super::PaintView;
use super::decal::{axes_on_screen, turn_of};
use crate::pen::PenState;

/// Point of a stroke under a pen at a place of the screen. With `starts`, a new run starts there.
pub(super) fn touched_at(
    model: &LiveModel,
    canvas: &impl PaintView,
    at: Pos2,
    pen: PenState,
    starts: bool,
) -> Option<StrokePoint> {
    let point = point_at(model, canvas, at, pen.pressure, starts)?;
    let shaft = pen
        .tilt_degrees
        .and_then(|tilt| shaft_over(model, canvas, &point, tilt));
    Some(StrokePoint { shaft, ..point })
}

/// Point of a stroke under a place of the screen, with its touch. With `starts`, a new run starts there.
pub(super) fn point_at(
    model: &LiveModel,
    canvas: &impl PaintView,
    at: Pos2,
    touch: impl Into<Touch>,
    starts: bool,
) -> Option<StrokePoint> {
    let site = canvas.site(model, at)?;
    on_surface(model, |surface| surface.point(site, touch, starts))
}

/// Calls a function with the surface of a model.
pub(super) fn on_surface<T>(model: &LiveModel, call: impl FnOnce(&PaintSurface<'_>) -> T) -> T {
    let mesh = &model.linked.model.mesh;
    let index = model.linked.paint_index.get_or_init(|| SurfaceIndex::new(mesh));
    call(&PaintSurface::new(mesh, index))
}

/// Shaft of a pen over a place of the model, from its tilt on the screen to the right and downward, in degrees. The
/// tilt is transferred to the surface: a pen that is upright on the screen is along the normal, and a tilted one leans
/// along the surface in the direction that is seen.
fn shaft_over(
    model: &LiveModel,
    canvas: &impl PaintView,
    placed: &StrokePoint,
    tilt_degrees: [f32; 2],
) -> Option<Shaft> {
    let (way, angle_degrees) = lean(tilt_degrees)?;
    let turn = axes_on_screen(model, canvas, placed, None).and_then(|axes| turn_of(axes, way));
    // A surface that is seen from its edge has no such direction.
    let turn = turn.map_or(0.0, |[_, turn]| f64::from(turn));
    let normal = DVec3::from(placed.normal.map(f64::from));
    let right = rightward(normal);
    let (sine, cosine) = turn.to_radians().sin_cos();
    let toward = cosine * right + sine * normal.cross(right);
    on_surface(model, |surface| surface.shaft(placed.site, toward, angle_degrees))
}

/// Direction on the screen in which a pen leans, and its angle from upright in degrees. The two angles of a tilt are
/// those of the pen's projections onto the two upright planes.
fn lean(tilt_degrees: [f32; 2]) -> Option<(Vec2, f32)> {
    let [x, y] = tilt_degrees.map(|angle| angle.to_radians().tan());
    let way = vec2(x, y);
    let angle_degrees = way.length().atan().to_degrees();
    angle_degrees.is_finite().then_some((way, angle_degrees))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_angles_make_a_direction_and_the_angle_from_upright() {
        let (way, angle) = lean([0.0, 30.0]).expect("numbers");
        assert!((angle - 30.0).abs() < 1e-3 && way.x == 0.0 && way.y > 0.0);
        let (way, angle) = lean([45.0, -45.0]).expect("numbers");
        assert!((angle - 2.0_f32.sqrt().atan().to_degrees()).abs() < 1e-3 && (way.x + way.y).abs() < 1e-6);
        assert_eq!(lean([0.0, 0.0]).map(|(_, angle)| angle), Some(0.0));
        assert_eq!(lean([f32::NAN, 0.0]), None);
    }
}
