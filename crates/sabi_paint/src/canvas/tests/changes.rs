//! Strokes that change existing paint.

use super::plates::plate;
use super::*;
use crate::CanvasTexel;

const RED: [f32; 3] = [0.8, 0.0, 0.0];
const GREEN: [f32; 3] = [0.0, 0.4, 0.0];
/// Brighter than white in one channel, and NaN in another.
const GLARE: [f32; 3] = [7.0, f32::NAN, 0.5];

/// Paints a hard disk of radius 0.3 in the middle of a plate, and then other strokes. Returns the cover at positions of the front.
fn after<const N: usize>(changes: impl Fn(&PaintSurface<'_>) -> Vec<Stroke>, places: [[f64; 2]; N]) -> [f32; N] {
    let mesh = plate(0.01);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256));
    let surface = PaintSurface::new(&mesh, &index);
    let brush = Brush {
        radius: 0.3,
        hardness: 1.0,
        ..Brush::default()
    };
    let mut strokes = vec![Stroke::new(brush, way_on_plate(&surface, [0.0, 0.0], [0.0, 0.0], 1))];
    strokes.extend(changes(&surface));
    let canvas = painted(&surface, &atlas, &strokes);
    places.map(|place| canvas.texel(texel_of_plate(&atlas, place)).cover)
}

fn stroke(surface: &PaintSurface<'_>, action: Action, from: [f64; 2], to: [f64; 2]) -> Stroke {
    let brush = Brush {
        radius: 0.25,
        hardness: 0.6,
        ..Brush::default()
    };
    Stroke {
        action,
        ..Stroke::new(brush, way_on_plate(surface, from, to, 30))
    }
}

#[test]
fn a_smear_pulls_paint_along_and_leaves_a_uniform_area_unchanged() {
    let outside = [[0.45, 0.0], [-0.45, 0.0], [0.0, 0.0]];
    let pulled = after(
        |surface| vec![stroke(surface, Action::Smear, [0.0, 0.0], [0.5, 0.0])],
        outside,
    );
    assert!(pulled[0] > 0.5, "{pulled:?}");
    assert_eq!(pulled[1], 0.0);
    assert!((pulled[2] - 1.0).abs() < 1e-3, "{pulled:?}");
    let within = after(
        |surface| {
            let mut small = stroke(surface, Action::Smear, [-0.05, 0.0], [0.05, 0.0]);
            small.brush.radius = 0.1;
            vec![small]
        },
        [[0.0, 0.0], [0.05, 0.05], [-0.1, 0.0]],
    );
    assert!(within.iter().all(|cover| (cover - 1.0).abs() < 1e-5), "{within:?}");
}

#[test]
fn a_blur_softens_a_border_only_under_the_brush_and_sharpening_hardens_it() {
    let border = [[0.26, 0.0], [0.34, 0.0], [-0.26, 0.0], [-0.34, 0.0]];
    let along = ([0.3, -0.2], [0.3, 0.2]);
    let blur = |surface: &PaintSurface<'_>| {
        let mut blur = stroke(surface, Action::Blur, along.0, along.1);
        blur.brush.flow = 0.3;
        blur
    };
    let soft = after(|surface| vec![blur(surface)], border);
    assert!(soft[0] < 0.95 && soft[1] > 0.05, "{soft:?}");
    assert_eq!(soft[2..], [1.0, 0.0], "the other side is as it was");
    let sharp = after(
        |surface| vec![blur(surface), stroke(surface, Action::Sharpen, along.0, along.1)],
        border,
    );
    assert!(
        sharp[0] - sharp[1] > soft[0] - soft[1] + 0.1,
        "{sharp:?} after {soft:?}"
    );
    assert!(sharp.iter().all(|cover| (0.0..=1.0).contains(cover)));
}

#[test]
fn a_clone_copies_the_paint_at_its_source() {
    let clone = |surface: &PaintSurface<'_>| {
        let mut clone = stroke(surface, Action::Clone, [0.6, 0.5], [0.6, 0.7]);
        clone.brush.hardness = 1.0;
        // The border of the disk: 0.3 to the left of its middle.
        clone.source = way_on_plate(surface, [-0.3, -0.1], [-0.3, -0.1], 1).pop();
        vec![clone]
    };
    let copied = after(clone, [[0.7, 0.6], [0.5, 0.6], [0.75, 0.75], [-0.3, 0.6]]);
    assert_eq!(copied.map(|cover| cover.round()), [1.0, 0.0, 1.0, 0.0], "{copied:?}");
    let without = after(
        |surface| {
            let mut without = clone(surface);
            without[0].source = None;
            without
        },
        [[0.7, 0.6], [0.6, 0.6]],
    );
    assert_eq!(without, [0.0, 0.0], "a clone without a source changes nothing");
}

/// Returns the paint in the middle of the right half of a raised plate, after a clone stroke there. If a node is connected,
/// it has these colors on the left and on the right half.
fn copied(source: Option<[f64; 2]>, halves: Option<[[f32; 3]; 2]>) -> CanvasTexel {
    let mesh = plate(0.01);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 256));
    let surface = PaintSurface::new(&mesh, &index);
    let columns = atlas.page_size[0] as usize;
    let border = texel_of_plate(&atlas, [0.0, 0.0]) % columns;
    let [left, right] = halves.unwrap_or_default(); // Not read if no node is connected.
    let input = |texel: usize| if texel % columns < border { left } else { right };
    let layers = CanvasLayers {
        color: true,
        height: true,
        direction: true,
        ..VALUE
    };
    let mut canvas = Canvas::empty(atlas.owners.len(), layers);
    let supplies = Supplies {
        pictures: &StampPictures::new(),
        input: halves.map(|_| &input as &crate::InputColors<'_>),
    };
    let mut painter = Painter::new(&surface, &atlas, supplies);
    let raised = Brush {
        height: 0.5,
        radius: 1.0,
        hardness: 1.0,
        ..Brush::default()
    };
    let at = |place: [f64; 2]| way_on_plate(&surface, place, place, 1);
    painter.paint(&mut canvas, &Stroke::new(raised, at([0.0, 0.0])));
    let mut clone = stroke(&surface, Action::Clone, [0.5, -0.1], [0.5, 0.1]);
    clone.brush.hardness = 1.0;
    clone.copy_of = CopyOf::Input;
    clone.source = source.and_then(|place| at(place).pop());
    painter.paint(&mut canvas, &clone);
    canvas.texel(texel_of_plate(&atlas, [0.5, 0.0]))
}

#[test]
fn a_clone_of_a_node_result_copies_colors_from_the_source_or_in_place() {
    for (claim, source, expected) in [
        ("without a source, what lies there", None, GREEN),
        ("with one, what lies at it", Some([-0.5, 0.0]), RED),
    ] {
        let texel = copied(source, Some([RED, GREEN]));
        let differs = texel
            .color
            .iter()
            .zip(expected)
            .any(|(one, other)| (one - other).abs() > 1e-3);
        assert!(!differs, "{claim}: {texel:?}");
        assert!(
            (texel.value - sabi_color::luminance(expected)).abs() < 1e-3,
            "{claim}: {texel:?}"
        );
        assert_eq!((texel.cover, texel.height), (1.0, 0.5), "{claim}");
    }
    for source in [None, Some([-0.5, 0.0])] {
        let texel = copied(source, Some([GLARE; 2]));
        let differs = texel
            .color
            .iter()
            .zip([1.0, 0.0, 0.5])
            .any(|(one, other)| (one - other).abs() > 1e-3);
        assert!(!differs, "what no color can be is bounded: {source:?} {texel:?}");
        assert_eq!(texel.direction, [0.0; 3], "a copy has no direction: {source:?}");
    }
    let without = copied(None, None);
    assert_eq!(
        (without.value, without.cover),
        (1.0, 1.0),
        "nothing is copied from a node that is not connected"
    );
}

#[test]
fn changes_are_continuous_where_a_stroke_crosses_a_seam() {
    // Paint on the front and the side of a thick plate, blurred over the edge at which two charts meet.
    let mesh = plate(0.4);
    let (index, atlas) = (SurfaceIndex::new(&mesh), atlas_of(&mesh, 512));
    let surface = PaintSurface::new(&mesh, &index);
    let fill = Stroke {
        area: Area::Side,
        ..Stroke::new(Brush::default(), way_on_plate(&surface, [0.0, 0.0], [0.0, 0.0], 1))
    };
    let blur = stroke(&surface, Action::Blur, [1.0, -0.4], [1.0, 0.4]);
    let canvas = painted(&surface, &atlas, &[fill, blur]);
    let on_front = canvas.texel(texel_of_plate(&atlas, [0.995, 0.0])).cover;
    // Texels of the right side, whose rows lead from the back to the front.
    let side: Vec<f32> = (0..atlas.owners.len())
        .filter(|texel| matches!(atlas.owners[*texel], 6 | 7))
        .map(|texel| canvas.texel(texel).cover)
        .collect();
    let most = side.iter().copied().fold(0.0, f32::max);
    assert!((0.2..0.8).contains(&on_front), "{on_front}");
    assert!((most - on_front).abs() < 0.1, "{most} beside {on_front}");
    assert_eq!(
        side.iter().copied().fold(1.0, f32::min),
        0.0,
        "far from the edge nothing changes"
    );
}
