//! Pens that lean and press.

use super::plates::plate;
use super::*;
use crate::{PenEffects, Symmetry, Tip, TipDirection, carried};

/// Returns a point on the front of a plate with a pen that leans by an angle toward a direction.
fn leaning(surface: &PaintSurface<'_>, at: [f64; 2], toward: DVec3, degrees: f32) -> StrokePoint {
    let point = way_on_plate(surface, at, at, 1)[0];
    let shaft = surface.shaft(point.site, toward, degrees);
    StrokePoint { shaft, ..point }
}

fn on_plate(test: impl FnOnce(&Mesh, &PaintSurface<'_>, &Atlas)) {
    let mesh = plate(0.1);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 512));
    test(&mesh, &PaintSurface::new(&mesh, &index), &atlas);
}

/// Returns a hard brush of radius 0.4 on which the pen has no effect.
fn plain(tip: Tip) -> Brush {
    Brush {
        tip,
        radius: 0.4,
        hardness: 1.0,
        pressure: PenEffects::NONE,
        ..Brush::default()
    }
}

/// Returns true if a square with sides of 0.8 stands on its corner, in which case it reaches 0.5 to the side.
fn is_on_its_corner(surface: &PaintSurface<'_>, atlas: &Atlas, brush: Brush, point: StrokePoint) -> bool {
    let canvas = painted(surface, atlas, &[Stroke::new(brush, vec![point])]);
    canvas.texel(texel_of_plate(atlas, [0.5, 0.0])).cover > 0.5
}

#[test]
fn the_size_follows_the_tilt_and_a_mouse_has_the_full_size() {
    on_plate(|mesh, surface, atlas| {
        let area = |amount: f32, point: StrokePoint| {
            let mut brush = plain(Tip::Round);
            brush.tilt.radius = amount;
            let canvas = painted(surface, atlas, &[Stroke::new(brush, vec![point])]);
            covered_area(mesh, atlas, &canvas) / (std::f64::consts::PI * 0.16)
        };
        let leaning = |degrees| leaning(surface, [0.0, 0.0], DVec3::X, degrees);
        for (amount, degrees, radius) in [
            (1.0, 45.0, 0.5),
            (1.0, 90.0, 1.0),
            (-1.0, 0.0, 1.0),
            (0.5, 0.0, 0.5),
            (0.0, 30.0, 1.0),
        ] {
            let found = area(amount, leaning(degrees));
            assert!((found - radius * radius).abs() < 0.02, "{amount} {degrees}: {found}");
        }
        let mouse = way_on_plate(surface, [0.0, 0.0], [0.0, 0.0], 1)[0];
        assert!((area(1.0, mouse) - 1.0).abs() < 0.02);
    });
}

#[test]
fn the_tip_follows_a_leaning_pen_and_the_stroke_under_an_upright_pen() {
    on_plate(|_, surface, atlas| {
        let brush = Brush {
            turn: TipDirection::Pen,
            ..plain(Tip::Square)
        };
        let lies = |toward, degrees| {
            is_on_its_corner(
                surface,
                atlas,
                brush.clone(),
                leaning(surface, [0.0, 0.0], toward, degrees),
            )
        };
        assert!(lies(DVec3::new(1.0, 1.0, 0.0), 30.0));
        assert!(!lies(DVec3::X, 30.0));
        assert!(!lies(DVec3::new(1.0, 1.0, 0.0), 0.5));
    });
}

#[test]
fn pressure_and_tilt_turn_the_tip() {
    on_plate(|_, surface, atlas| {
        let mut brush = plain(Tip::Square);
        brush.pressure.angle_degrees = 90.0;
        let pressed = |pressure| StrokePoint {
            pressure,
            ..leaning(surface, [0.0, 0.0], DVec3::X, 0.0)
        };
        assert!(is_on_its_corner(surface, atlas, brush.clone(), pressed(0.5)));
        assert!(!is_on_its_corner(surface, atlas, brush.clone(), pressed(0.0)));
        brush.pressure.angle_degrees = 0.0;
        brush.tilt.angle_degrees = -90.0;
        assert!(is_on_its_corner(
            surface,
            atlas,
            brush.clone(),
            leaning(surface, [0.0, 0.0], DVec3::X, 45.0)
        ));
        assert!(!is_on_its_corner(surface, atlas, brush, pressed(0.5)));
    });
}

#[test]
fn the_pen_of_a_mirrored_copy_leans_in_the_mirrored_direction() {
    on_plate(|_, surface, atlas| {
        let brush = Brush {
            radius: 0.2,
            turn: TipDirection::Pen,
            symmetry: Symmetry {
                mirrors: [true, false, false],
                turns: 0,
            },
            ..plain(Tip::Square)
        };
        let stroke = Stroke::new(
            brush,
            vec![leaning(surface, [0.5, 0.0], DVec3::new(0.9, 0.4, 0.0), 40.0)],
        );
        let canvas = painted(surface, atlas, &[stroke]);
        let cover = |x: f64, y: f64| canvas.texel(texel_of_plate(atlas, [x, y])).cover;
        let mut seen = 0;
        for row in -30..=30 {
            for column in 20..=80 {
                let (x, y) = (f64::from(column) / 100.0 + 0.002, f64::from(row) / 100.0);
                let (own, other) = (cover(x, y), cover(-x, y));
                seen += i32::from(own > 0.5);
                assert!(
                    (own > 0.1) == (other > 0.1) || (own - other).abs() < 0.9,
                    "{x} {y}: {own} {other}"
                );
            }
        }
        assert!(seen > 500, "{seen}");
        // A corner of the rotated square, which would not be there if the copy were rotated in the same direction.
        assert!(cover(0.5 + 0.1, 0.24) > 0.5 && cover(-0.6, 0.24) > 0.5 && cover(-0.4, 0.24) < 0.5);
    });
}

#[test]
fn a_line_grows_while_the_pen_is_leaned() {
    on_plate(|_, surface, atlas| {
        let mut brush = plain(Tip::Round);
        brush.tilt.radius = 1.0;
        let ends = [([-0.8, 0.0], 0.0), ([0.4, 0.0], 90.0)];
        let mut points = ends
            .map(|(at, degrees)| leaning(surface, at, DVec3::Y, degrees))
            .to_vec();
        points[1].starts = false;
        let canvas = painted(surface, atlas, &[Stroke::new(brush, points)]);
        let half_width = |x: f64| {
            let rows = (0..100).map(|row| f64::from(row) / 100.0);
            rows.filter(|y| canvas.texel(texel_of_plate(atlas, [x, *y])).cover > 0.5)
                .count() as f64
                / 100.0
        };
        let [early, middle, late] = [-0.65, -0.2, 0.35].map(half_width);
        assert!(
            early < 0.13 && (middle - 0.2).abs() < 0.06 && late > 0.35,
            "{early} {middle} {late}"
        );
    });
}

#[test]
fn a_stroke_that_is_moved_and_turned_takes_the_lean_of_the_pen_along() {
    on_plate(|_, surface, _| {
        let from = leaning(surface, [0.0, 0.0], DVec3::X, 30.0);
        let to = leaning(surface, [0.3, 0.2], DVec3::X, 0.0);
        let (stroke, lost) = carried(surface, &Stroke::new(plain(Tip::Round), vec![from]), [&from, &to], 90.0);
        let found = stroke.points[0].shaft.unwrap().direction();
        let expected = leaning(surface, [0.3, 0.2], DVec3::Y, 30.0).shaft.unwrap().direction();
        assert!(lost == 0 && found.distance(expected) < 1e-3, "{found} for {expected}");
    });
}

#[test]
fn invalid_numbers_of_a_driver_never_make_a_shaft() {
    on_plate(|_, surface, _| {
        let site = way_on_plate(surface, [0.0, 0.0], [0.0, 0.0], 1)[0].site;
        assert_eq!(surface.shaft(site, DVec3::X, f32::NAN), None);
        let upright = surface.shaft(site, DVec3::ZERO, 60.0).unwrap().direction();
        assert!(upright.distance(DVec3::Z) < 1e-3);
        for toward in [DVec3::NAN, DVec3::INFINITY] {
            let shaft = surface.shaft(site, toward, 40.0);
            assert!(shaft.is_none_or(|shaft| shaft.direction().is_finite()), "{toward}");
        }
        let flat = surface.shaft(site, DVec3::X, f32::INFINITY).unwrap().direction();
        assert!(flat.distance(DVec3::X) < 1e-3);
    });
}
