//! Ribbons on a plate, compared with formulas.

use super::plates::plate;
use super::*;
use crate::{PicturePart, PictureTip, StampPicture, Tip};

const LEAST: f64 = 0.02;

fn ribbon(surface: &PaintSurface<'_>, tip: Tip, from: [f64; 2], to: [f64; 2]) -> Stroke {
    let brush = Brush {
        radius: 0.2,
        hardness: 1.0,
        tip,
        ..Brush::default()
    };
    Stroke {
        area: Area::Ribbon,
        ..Stroke::new(brush, way_on_plate(surface, from, to, 20))
    }
}

#[test]
fn a_straight_ribbon_covers_its_length_times_its_width_with_straight_ends() {
    let mesh = plate(0.02);
    let (atlas, index) = (atlas_of(&mesh, 512), SurfaceIndex::new(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let canvas = painted(
        &surface,
        &atlas,
        &[ribbon(&surface, Tip::Round, [-0.6, 0.1], [0.6, 0.1])],
    );
    let area = covered_area(&mesh, &atlas, &canvas);
    assert!((area / (1.2 * 0.4) - 1.0).abs() < LEAST, "{area}");
    for (place, expected) in [
        ([-0.58, 0.28], 1.0),
        ([-0.63, 0.1], 0.0),
        ([0.58, -0.08], 1.0),
        ([0.0, 0.32], 0.0),
    ] {
        assert_eq!(canvas.texel(texel_of_plate(&atlas, place)).cover, expected, "{place:?}");
    }
}

#[test]
fn a_ribbon_around_a_bend_has_no_hole_and_covers_no_place_twice() {
    let mesh = plate(0.02);
    let (atlas, index) = (atlas_of(&mesh, 512), SurfaceIndex::new(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    let mut points = way_on_plate(&surface, [-0.6, -0.5], [0.4, -0.5], 20);
    points.extend(
        way_on_plate(&surface, [0.4, -0.45], [0.4, 0.6], 20)
            .into_iter()
            .map(|point| StrokePoint { starts: false, ..point }),
    );
    let stroke = Stroke {
        points,
        ..ribbon(&surface, Tip::Round, [0.0; 2], [0.0; 2])
    };
    let canvas = painted(&surface, &atlas, &[stroke]);
    // Two bands of width 0.4 with a rounded outer corner.
    let corner = 0.04 * (1.0 - std::f64::consts::FRAC_PI_4);
    let expected = 0.4 * (1.0 + 1.1) - corner;
    let area = covered_area(&mesh, &atlas, &canvas);
    assert!((area / expected - 1.0).abs() < 0.03, "{area} {expected}");
    assert_eq!(canvas.texel(texel_of_plate(&atlas, [0.4, -0.5])).cover, 1.0);
    assert_eq!(canvas.texel(texel_of_plate(&atlas, [0.25, -0.35])).cover, 1.0);
}

#[test]
fn a_picture_is_repeated_a_whole_number_of_times_along_a_ribbon() {
    let mesh = plate(0.02);
    let (atlas, index) = (atlas_of(&mesh, 512), SurfaceIndex::new(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    // Its left half is red, its right half transparent. It is twice as long as high.
    let pixels: Vec<u8> = (0..8 * 4)
        .flat_map(|pixel| if pixel % 8 < 4 { [255, 0, 0, 255] } else { [0; 4] })
        .collect();
    let picture = StampPicture::new(&sabi_image::Picture {
        width: 8,
        height: 4,
        pixels: sabi_image::Pixels::U8(pixels),
        channels: 4,
        color_space: sabi_image::DeclaredColorSpace::Srgb,
        remarks: sabi_image::PictureRemarks::default(),
    });
    let name = crate::PictureName::of(b"band", "png").unwrap();
    let mut stroke = ribbon(&surface, Tip::Round, [-0.6, 0.0], [0.7, 0.0]);
    stroke.brush.picture = Some(PictureTip {
        picture: name.clone(),
        part: PicturePart::Alpha,
    });
    let pictures = StampPictures::from([(name, std::sync::Arc::new(picture))]);
    let canvas = painted_with(&surface, &atlas, &[stroke], &pictures, VALUE);
    // A length of 1.3 takes 1.6 pictures of 0.8, so two of 0.65.
    for (x, expected) in [(-0.45, 1.0), (-0.1, 0.0), (0.2, 1.0), (0.55, 0.0)] {
        let cover = canvas.texel(texel_of_plate(&atlas, [x, 0.05])).cover;
        assert!((cover - expected).abs() < 1e-3, "{x}: {cover}");
    }
}

#[test]
fn bands_are_continuous_from_each_stamp_to_the_next() {
    let mesh = plate(0.02);
    let (atlas, index) = (atlas_of(&mesh, 1024), SurfaceIndex::new(&mesh));
    let surface = PaintSurface::new(&mesh, &index);
    for tip in [Tip::Weld, Tip::Rope] {
        let canvas = painted(&surface, &atlas, &[ribbon(&surface, tip, [-0.6, 0.0], [0.6, 0.0])]);
        // Stamps of 0.4 meet at −0.2 and 0.2. Differences there are not larger than elsewhere.
        let step = |x: f64| {
            let at = |x: f64| f64::from(canvas.texel(texel_of_plate(&atlas, [x, 0.03])).cover);
            (at(x + 0.004) - at(x - 0.004)).abs()
        };
        let elsewhere = (-50..50)
            .map(|index| step(0.005 * f64::from(index)))
            .fold(0.0, f64::max);
        let at_joints = [-0.2, 0.2].map(step);
        assert!(
            at_joints.iter().all(|joint| *joint <= elsewhere && *joint < 0.5),
            "{at_joints:?} {elsewhere}"
        );
        assert!(canvas.texel(texel_of_plate(&atlas, [-0.2, 0.0])).cover > 0.25);
    }
}

#[test]
fn a_ribbon_that_passes_its_own_start_has_no_gap_there() {
    let mesh = plate(0.1);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 512));
    let surface = PaintSurface::new(&mesh, &index);
    // Leads around a square, and continues over its start.
    let corners = [
        [0.0, -0.5],
        [0.5, -0.5],
        [0.5, 0.5],
        [-0.5, 0.5],
        [-0.5, -0.5],
        [0.3, -0.5],
    ];
    let sides = corners.windows(2).enumerate().flat_map(|(index, side)| {
        let mut side = way_on_plate(&surface, side[0], side[1], 12);
        side[0].starts = index == 0;
        side
    });
    let brush = Brush {
        tip: Tip::Square,
        hardness: 1.0,
        radius: 0.1,
        ..Brush::default()
    };
    let stroke = Stroke {
        area: Area::Ribbon,
        ..Stroke::new(brush, sides.collect())
    };
    let canvas = painted(&surface, &atlas, &[stroke]);
    for step in 0..60 {
        let x = -0.3 + 0.01 * f64::from(step);
        let cover = canvas.texel(texel_of_plate(&atlas, [x, -0.5])).cover;
        assert!(cover > 0.9, "{cover} at {x}");
    }
}
