//! Strokes that are drawn point by point.

use std::sync::Arc;

use super::plates::plate;
use super::*;
use crate::{BrushLimits, Eye, Jitter, PenEffects, Tip};

const ALL: CanvasLayers = CanvasLayers {
    value: true,
    color: true,
    height: true,
    direction: true,
};

/// Returns points of a winding way over the front of a plate, on which the pressure rises and falls.
fn winding(surface: &PaintSurface<'_>, count: usize) -> Vec<StrokePoint> {
    let place = |at: usize| {
        let share = at as f64 / count as f64;
        [-0.8 + 1.6 * share, 0.4 * (9.0 * share).sin()]
    };
    let points = (0..count).filter_map(|at| {
        let point = way_on_plate(surface, place(at), place(at), 1).pop()?;
        Some(StrokePoint {
            pressure: 0.6 + 0.4 * (0.7 * at as f32).sin(),
            starts: at == 0 || at == count / 2,
            ..point
        })
    });
    points.collect()
}

/// Returns brushes, each with a description of its strokes.
fn brushes() -> [(&'static str, Brush); 7] {
    let round = Brush {
        radius: 0.12,
        ..Brush::default()
    };
    let tip = |tip: Tip| Brush {
        radius: 0.12,
        ..Brush::default().with_tip(tip)
    };
    [
        ("a line", round.clone()),
        (
            "a line as wide as the pen presses",
            Brush {
                pressure: PenEffects {
                    radius: 1.0,
                    ..PenEffects::default()
                },
                ..round.clone()
            },
        ),
        ("chalk, whose grain stays on the model", tip(Tip::Chalk)),
        ("bristles", tip(Tip::Bristles)),
        (
            "stamps that differ in color and place",
            Brush {
                jitter: Jitter {
                    hue: 0.3,
                    place: 0.5,
                    ..Jitter::default()
                },
                color: [0.6, 0.2, 0.1],
                ..tip(Tip::Soft)
            },
        ),
        (
            "within an angle",
            Brush {
                limits: BrushLimits {
                    angle_degrees: 40.0,
                    ..BrushLimits::default()
                },
                ..round.clone()
            },
        ),
        (
            "where the artist sees the front",
            Brush {
                limits: BrushLimits {
                    front_only: true,
                    seen_only: true,
                    ..BrushLimits::default()
                },
                ..round
            },
        ),
    ]
}

#[test]
fn a_growing_stroke_has_at_each_point_the_same_bits_as_one_painted_at_once() {
    let mesh = plate(0.3);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 128));
    let surface = PaintSurface::new(&mesh, &index);
    let pictures = StampPictures::new();
    let points = winding(&surface, 24);
    for (claim, brush) in brushes() {
        let mut painter = Painter::new(&surface, &atlas, Supplies::of_pictures(&pictures));
        let mut growth = None;
        for count in 1..=points.len() {
            let stroke = Arc::new(Stroke {
                eye: Some(Eye::Place([2.0, 1.0, 1.5])),
                ..Stroke::new(brush.clone(), points[..count].to_vec())
            });
            let at_once = painted_with(&surface, &atlas, std::slice::from_ref(&*stroke), &pictures, ALL);
            let mut canvas = Canvas::empty(atlas.owners.len(), ALL);
            painter
                .lay_growing(&stroke, true, &mut growth)
                .onto(&mut canvas, &stroke);
            assert!(canvas == at_once, "{claim}, place {count}");
        }
        let settled = growth.map_or(0, |growth| growth.settled());
        assert!(settled > 20, "{claim}: only {settled} pieces are not laid again");
    }
}

#[test]
fn a_new_stroke_does_not_continue_the_state_of_the_previous_one() {
    let mesh = plate(0.01);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 64));
    let surface = PaintSurface::new(&mesh, &index);
    let pictures = StampPictures::new();
    let points = winding(&surface, 12);
    let brush = |value: f32| Brush {
        radius: 0.2,
        value,
        ..Brush::default()
    };
    let mut painter = Painter::new(&surface, &atlas, Supplies::of_pictures(&pictures));
    let mut growth = None;
    for (claim, value, places) in [
        ("the first", 1.0, &points[..8]),
        ("another brush", 0.5, &points[..]),
        ("elsewhere", 0.5, &points[4..]),
        ("fewer places", 0.5, &points[4..6]),
    ] {
        let stroke = Arc::new(Stroke::new(brush(value), places.to_vec()));
        let at_once = painted_with(&surface, &atlas, std::slice::from_ref(&*stroke), &pictures, ALL);
        let mut canvas = Canvas::empty(atlas.owners.len(), ALL);
        painter
            .lay_growing(&stroke, true, &mut growth)
            .onto(&mut canvas, &stroke);
        assert!(canvas == at_once, "{claim}");
    }
}
