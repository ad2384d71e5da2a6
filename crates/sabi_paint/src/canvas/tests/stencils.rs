//! Stencils, and the limits of fills.

use std::sync::Arc;

use super::plates::plate;
use super::stamped_pictures::{COLORED, flag};
use super::*;
use crate::{BrushLimits, Eye, PicturePart, PictureTip, Stencil, Symmetry};

/// Returns a stencil in front of the middle of the front of a plate, half a unit wide to both sides, for an eye far above.
fn stencil(picture: PictureTip) -> Option<Arc<Stencil>> {
    Some(Arc::new(Stencil {
        picture,
        picture_from_model: [[2.0, 0.0, 0.0, 0.0], [0.0, 4.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]],
    }))
}

/// Returns cover and color of a canvas at a position of the front.
fn at(atlas: &Atlas, canvas: &Canvas, place: [f64; 2]) -> (f32, [f32; 3]) {
    let texel = canvas.texel(texel_of_plate(atlas, place));
    (texel.cover, texel.color)
}

#[test]
fn strokes_fills_and_ribbons_through_a_stencil_paint_only_its_picture() {
    let mesh = plate(0.1);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256));
    let surface = PaintSurface::new(&mesh, &index);
    let (tip, pictures) = flag();
    let brush = Brush {
        radius: 0.4,
        hardness: 1.0,
        color: [0.0, 1.0, 0.0],
        ..Brush::default()
    };
    for area in [
        Area::Way,
        Area::Ribbon,
        Area::All,
        Area::Inside,
        Area::Similar,
        Area::Side,
    ] {
        let points = match area {
            // An outline around the whole of the picture.
            Area::Inside => [[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]]
                .iter()
                .flat_map(|corner| way_on_plate(&surface, *corner, *corner, 1))
                .collect(),
            _ => way_on_plate(&surface, [-0.8, 0.0], [0.8, 0.0], 20),
        };
        let stroke = |part: PicturePart| Stroke {
            area,
            stencil: stencil(PictureTip { part, ..tip.clone() }),
            ..Stroke::new(brush.clone(), points.clone())
        };
        let canvas = |part| painted_with(&surface, &atlas, &[stroke(part)], &pictures, COLORED);
        let colors = canvas(PicturePart::Colors);
        assert_eq!(at(&atlas, &colors, [-0.3, 0.1]), (1.0, [1.0, 0.0, 0.0]), "{area:?}");
        assert_eq!(at(&atlas, &colors, [0.3, -0.1]), (1.0, [0.0, 0.0, 1.0]), "{area:?}");
        for beside in [[-0.6, 0.0], [0.6, 0.0], [0.0, 0.3]] {
            assert_eq!(at(&atlas, &colors, beside).0, 0.0, "{area:?}");
        }
        let masked = canvas(PicturePart::Alpha);
        assert_eq!(at(&atlas, &masked, [0.3, 0.1]), (1.0, [0.0, 1.0, 0.0]), "{area:?}");
    }
}

#[test]
fn copies_of_a_stroke_use_a_copied_stencil() {
    let mesh = plate(0.1);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256));
    let surface = PaintSurface::new(&mesh, &index);
    let (tip, pictures) = flag();
    let brush = Brush {
        radius: 0.3,
        symmetry: Symmetry {
            mirrors: [true, false, false],
            turns: 0,
        },
        ..Brush::default()
    };
    let stroke = Stroke {
        stencil: stencil(tip),
        ..Stroke::new(brush, way_on_plate(&surface, [0.3, 0.0], [0.4, 0.0], 8))
    };
    let canvas = painted_with(&surface, &atlas, &[stroke], &pictures, COLORED);
    let blue = (1.0, [0.0, 0.0, 1.0]);
    assert_eq!(at(&atlas, &canvas, [0.3, 0.1]), blue);
    assert_eq!(at(&atlas, &canvas, [-0.3, 0.1]), blue, "as in a mirror");
}

#[test]
fn a_stroke_without_the_picture_of_its_stencil_leaves_nothing() {
    let mesh = plate(0.1);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 64));
    let surface = PaintSurface::new(&mesh, &index);
    let stroke = Stroke {
        stencil: stencil(flag().0),
        ..Stroke::new(Brush::default(), way_on_plate(&surface, [0.0, 0.0], [0.4, 0.0], 8))
    };
    let canvas = painted_with(&surface, &atlas, &[stroke], &StampPictures::new(), COLORED);
    assert!(canvas.texels().all(|texel| texel.cover == 0.0));
}

#[test]
fn fills_stay_within_the_limits_of_the_brush() {
    let mesh = plate(0.1);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256));
    let surface = PaintSurface::new(&mesh, &index);
    let area = |area: Area, limits: BrushLimits| {
        let brush = Brush {
            limits,
            ..Brush::default()
        };
        let stroke = Stroke {
            area,
            eye: Some(Eye::Toward([0.0, 0.0, 1.0])),
            ..Stroke::new(brush, way_on_plate(&surface, [0.0, 0.0], [0.0, 0.0], 1))
        };
        covered_area(&mesh, &atlas, &painted(&surface, &atlas, &[stroke]))
    };
    let all = 2.0 * 4.0 + 4.0 * 0.2;
    let limits = [
        BrushLimits {
            angle_degrees: 60.0,
            ..BrushLimits::default()
        },
        BrushLimits {
            front_only: true,
            ..BrushLimits::default()
        },
        BrushLimits {
            seen_only: true,
            ..BrushLimits::default()
        },
    ];
    for filled in [Area::All, Area::Similar, Area::Gradient, Area::Part] {
        let whole = area(filled, BrushLimits::default());
        assert!((whole / all - 1.0).abs() < 0.02, "{filled:?} {whole}");
        for limits in limits {
            let front = area(filled, limits);
            assert!((front / 4.0 - 1.0).abs() < 0.02, "{filled:?} {limits:?} {front}");
        }
    }
}

#[test]
fn a_stencil_moves_with_its_stroke() {
    let mesh = plate(0.1);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256));
    let surface = PaintSurface::new(&mesh, &index);
    let (tip, pictures) = flag();
    let brush = Brush {
        radius: 0.3,
        ..Brush::default()
    };
    let points = way_on_plate(&surface, [0.2, 0.0], [0.4, 0.0], 8);
    let stroke = Stroke {
        stencil: stencil(tip),
        ..Stroke::new(brush, points.clone())
    };
    let to = way_on_plate(&surface, [0.2, 0.5], [0.2, 0.5], 1)[0];
    let (carried, lost) = crate::carried(&surface, &stroke, [&points[0], &to], 0.0);
    assert_eq!(lost, 0);
    let mut book = crate::StrokeBook::default();
    let first = book.push(crate::Version::EMPTY, &crate::Step::Add(Arc::new(stroke)));
    let moved = crate::Step::Place {
        stroke: first,
        points: carried.points,
        path: None,
        eye: None,
        stencil: carried.stencil,
    };
    let second = book.push(first, &moved);
    let list = book.list(second).expect("strokes");
    let canvas = painted_with(&surface, &atlas, &[(*list.strokes[0]).clone()], &pictures, COLORED);
    assert_eq!(at(&atlas, &canvas, [0.3, 0.5]), (1.0, [0.0, 0.0, 1.0]));
    assert_eq!(at(&atlas, &canvas, [0.3, 0.0]).0, 0.0);
}

#[test]
fn a_stroke_from_a_denser_mesh_is_moved_from_its_present_place() {
    let mesh = plate(0.1);
    let index = SurfaceIndex::new(&mesh);
    let surface = PaintSurface::new(&mesh, &index);
    let mut points = way_on_plate(&surface, [0.0, 0.0], [0.2, 0.0], 3);
    for point in &mut points {
        (point.site.triangle, point.triangle_key) = (9_000, 1);
    }
    let brush = Brush {
        radius: 0.1,
        ..Brush::default()
    };
    let stroke = Stroke::new(brush, points.clone());
    let to = way_on_plate(&surface, [0.0, 0.3], [0.0, 0.3], 1)[0];
    let (carried, lost) = crate::carried(&surface, &stroke, [&points[0], &to], 0.0);
    assert_eq!((lost, carried.points.len()), (0, 3));
    let end = carried.points[2].site.position;
    assert!(end.distance(DVec3::new(0.2, 0.3, 0.1)) < 0.11, "{end}");
}

#[test]
fn a_forged_brush_of_size_zero_has_few_points_and_stamps() {
    let mesh = plate(0.1);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 64));
    let surface = PaintSurface::new(&mesh, &index);
    let brush = Brush {
        radius: 1e-9,
        flow: 0.5,
        spacing: 0.02,
        ..Brush::default()
    };
    let stroke = Stroke::new(brush, way_on_plate(&surface, [-0.9, -0.9], [0.9, 0.9], 4));
    let way = crate::way::way_of(&surface, &stroke.points, 1e-9);
    assert!(way.len() < 500_000, "{}", way.len());
    let stamps = crate::way::spaced(&way, |_| 1e-11);
    assert!(stamps.len() < 500_000, "{}", stamps.len());
    let canvas = painted(
        &surface,
        &atlas,
        &[Stroke::new(
            Brush {
                radius: 1e-4,
                ..Brush::default()
            },
            stroke.points,
        )],
    );
    assert!(canvas.texels().all(|texel| texel.cover <= 1.0));
}
