//! Any bytes are strokes that can be painted, or a fault.

use sabi_paint::file::read;
use sabi_paint::{Canvas, CanvasLayers, PaintSurface, Painter, StampPictures, StrokeBook, Supplies, SurfaceIndex};
use sabi_surface::atlas::{Atlas, AtlasOptions};

use crate::square::square;

/// Strokes that are painted of each version, and places of each stroke: enough to meet every kind of brush.
const STROKES: usize = 8;
const POINTS: usize = 8;

pub fn survives(bytes: &[u8]) {
    let mut book = StrokeBook::default();
    let Ok(strokes) = read(bytes, &mut book) else {
        return;
    };
    let mesh = square(|_| 0.0);
    let index = SurfaceIndex::new(&mesh);
    let surface = PaintSurface::new(&mesh, &index);
    let Ok(atlas) = Atlas::build(&mesh, &AtlasOptions::new(16)) else {
        return;
    };
    let layers = CanvasLayers {
        value: true,
        color: true,
        height: true,
        direction: true,
    };
    let pictures = StampPictures::new();
    // Strokes that copy another node find it, too.
    let gray = |_: usize| [0.5; 3];
    let supplies = Supplies {
        pictures: &pictures,
        input: Some(&gray),
    };
    let mut painter = Painter::new(&surface, &atlas, supplies);
    for version in strokes.versions {
        let Some(list) = book.list(version) else {
            continue;
        };
        let mut canvas = Canvas::empty(atlas.owners.len(), layers);
        for stroke in list.strokes.iter().take(STROKES) {
            // On this square, whatever the model was.
            let mut stroke = sabi_paint::Stroke::clone(stroke);
            stroke.points.truncate(POINTS);
            for point in &mut stroke.points {
                point.site.triangle %= 2;
                point.triangle_key = surface.triangle_key(point.site.triangle);
            }
            painter.paint(&mut canvas, &stroke);
        }
        assert!(canvas.texels().all(|texel| (0.0..=1.0).contains(&texel.cover)));
    }
}
