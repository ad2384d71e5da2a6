//! Fills that depend on existing paint, and stamps of different colors.

use super::plates::plate;
use super::*;
use crate::{Jitter, Tip};

/// Returns the outline of a square on the front of a plate, and a bucket fill at a position of the front.
fn with_bucket(surface: &PaintSurface<'_>, at: [f64; 2]) -> [Stroke; 2] {
    let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5]];
    let sides = corners
        .windows(2)
        .flat_map(|side| way_on_plate(surface, side[0], side[1], 20));
    let line = Brush {
        radius: 0.05,
        hardness: 0.9,
        ..Brush::default()
    };
    let bucket = Stroke {
        area: Area::Similar,
        ..Stroke::new(Brush::default(), way_on_plate(surface, at, at, 1))
    };
    [Stroke::new(line, sides.collect()), bucket]
}

#[test]
fn a_bucket_fills_up_to_existing_paint_and_across_seams() {
    let mesh = plate(0.1);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 512));
    let surface = PaintSurface::new(&mesh, &index);
    let inside = painted(&surface, &atlas, &with_bucket(&surface, [0.1, 0.2]));
    let area = covered_area(&mesh, &atlas, &inside);
    // The line fades over the last tenth of its radius.
    assert!((area / (1.095 * 1.095) - 1.0).abs() < 0.02, "{area}");
    let outside = painted(&surface, &atlas, &with_bucket(&surface, [0.8, 0.2]));
    let area = covered_area(&mesh, &atlas, &outside);
    // Both sides and the four narrow sides, without the area inside of the line.
    let expected = 2.0 * 4.0 + 4.0 * 0.2 - 0.905 * 0.905;
    assert!((area / expected - 1.0).abs() < 0.02, "{area} {expected}");
    for (at, cover) in [([0.0, 0.0], 0.0), ([0.7, 0.7], 1.0)] {
        assert_eq!(outside.texel(texel_of_plate(&atlas, at)).cover, cover);
    }
}

#[test]
fn stamps_differ_in_color_within_limits_and_equally_each_time() {
    let mesh = plate(0.1);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256));
    let surface = PaintSurface::new(&mesh, &index);
    let layers = CanvasLayers {
        color: true,
        ..CanvasLayers::default()
    };
    let colors = |jitter: Jitter, tip: Tip| {
        let brush = Brush {
            radius: 0.06,
            spacing: 2.0,
            color: [0.8, 0.2, 0.1],
            tip,
            jitter,
            ..Brush::default()
        };
        let stroke = Stroke::new(brush, way_on_plate(&surface, [-0.8, 0.0], [0.8, 0.0], 30));
        let canvas = painted_with(&surface, &atlas, &[stroke], &StampPictures::new(), layers);
        let covered = canvas.texels().filter(|texel| texel.cover > 0.5);
        covered
            .map(|texel| {
                texel
                    .color
                    .map(|channel| (100.0 * channel / texel.cover).round() as i32)
            })
            .collect::<std::collections::BTreeSet<_>>()
    };
    assert_eq!(colors(Jitter::default(), Tip::Round), [[80, 20, 10]].into());
    let darker = Jitter {
        value: 0.5,
        ..Jitter::default()
    };
    for tip in [Tip::Round, Tip::Rivets] {
        let found = colors(darker, tip);
        assert!(found.len() > 6, "{}", found.len());
        // The brightest channel is within half of its own value, and its ratio to the others has not changed.
        assert!(
            found
                .iter()
                .all(|[red, green, _]| (40..=100).contains(red) && (red - 4 * green).abs() < 5),
            "{found:?}"
        );
        assert_eq!(found, colors(darker, tip));
    }
}
