//! Pictures of the paint of a brush.

use glam::DVec3;
use sabi_surface::atlas::{Atlas, AtlasOptions};
use sabi_surface::model::Mesh;
use sabi_surface::patch::Site;

use crate::brush::{Brush, Symmetry};
use crate::brush_limits::BrushLimits;
use crate::canvas::{Canvas, CanvasLayers, Painter};
use crate::dynamics::Jitter;
use crate::index::SurfaceIndex;
use crate::picture::{PicturePart, StampPictures, SwatchPixel};
use crate::stroke::{Area, Stroke, StrokePoint};
use crate::supplies::Supplies;
use crate::surface::PaintSurface;

/// Texels around the picture, for the border of its chart.
const MARGIN: usize = 8;
/// Largest side of a picture.
const LARGEST: usize = 2048;
/// Minimum spacing from which on a tip is shown as separate stamps.
const SEPARATE: f32 = 1.0;
/// Points of a stroke.
const POINTS: usize = 64;

/// Returns a picture of a stroke of a brush on a flat wall, row by row from the upper left pixel. The stroke is an S from left to right
/// with its highest pressure in the middle. It fills the height, whatever the radius of the brush. If the stamps of a brush are far apart,
/// a few of them are shown; a band is shown as a ribbon. Sides of the picture are limited to 1 to 2048 pixels.
pub fn swatch(brush: &Brush, pictures: &StampPictures, size: [usize; 2]) -> Vec<SwatchPixel> {
    let size = size.map(|side| side.clamp(1, LARGEST));
    let [width, height] = size.map(|side| side as f64);
    let is_band = brush.tip.is_band() && brush.picture.is_none();
    if brush.spacing >= SEPARATE && !is_band {
        // Leaves room for stamps that are displaced at random.
        let radius = 0.48 * height / (1.0 + f64::from(brush.bounded().jitter.place));
        let count = (width / (2.15 * radius)).floor().clamp(1.0, 64.0);
        let step = width / count;
        let places = (0..count as usize).map(|index| ([step * (index as f64 + 0.5), 0.5 * height], 1.0));
        return painted(brush, pictures, size, radius, Area::Way, places.collect(), true);
    }
    let area = if is_band { Area::Ribbon } else { Area::Way };
    let radius = (0.34 * height).min(0.3 * width);
    let places = (0..POINTS).map(|index| {
        let t = index as f64 / (POINTS - 1) as f64;
        let x = 1.1 * radius + t * (width - 2.2 * radius);
        // A cubic with the bends of an S, starting at the bottom.
        let bend = t * (2.0 * t - 1.0) * (1.0 - t) * 10.0;
        let pressure = 0.25 + 3.0 * t * (1.0 - t);
        ([x, 0.5 * height - 0.13 * height * bend], pressure.min(1.0))
    });
    painted(brush, pictures, size, radius, area, places.collect(), false)
}

/// Returns a picture of a single stamp of a brush on a flat wall at full strength, row by row, with the same number of
/// pixels on each side.
pub fn stamp_swatch(brush: &Brush, pictures: &StampPictures, side: usize) -> Vec<SwatchPixel> {
    let side = side.clamp(1, LARGEST);
    let middle = 0.5 * side as f64;
    let still = Brush {
        flow: 1.0,
        jitter: Jitter::default(),
        ..brush.clone()
    };
    painted(
        &still,
        pictures,
        [side; 2],
        0.97 * middle,
        Area::Way,
        vec![([middle; 2], 1.0)],
        true,
    )
}

/// Returns the pixels of a stroke through positions of a picture, given in pixels, each with a pressure.
fn painted(
    brush: &Brush,
    pictures: &StampPictures,
    size: [usize; 2],
    radius: f64,
    area: Area,
    places: Vec<([f64; 2], f64)>,
    is_separate: bool,
) -> Vec<SwatchPixel> {
    let side = (size[0].max(size[1]) + 2 * MARGIN).next_multiple_of(8);
    let mesh = wall(size, side);
    let none = || vec![SwatchPixel::default(); size[0] * size[1]];
    // A wall of this size always has an atlas.
    let Ok(atlas) = Atlas::build(&mesh, &AtlasOptions::new(side as u32)) else {
        return none();
    };
    let index = SurfaceIndex::new(&mesh);
    let surface = PaintSurface::new(&mesh, &index);
    let points: Vec<StrokePoint> = places
        .into_iter()
        .enumerate()
        .filter_map(|(number, ([x, y], pressure))| {
            let site = site_of([x, y], size);
            surface.point(site, pressure as f32, is_separate || number == 0)
        })
        .collect();
    let brush = Brush {
        radius: radius as f32,
        symmetry: Symmetry::default(),
        limits: BrushLimits::default(),
        ..brush.clone()
    };
    let layers = CanvasLayers {
        color: matches!(&brush.picture, Some(tip) if tip.part == PicturePart::Colors),
        ..CanvasLayers::default()
    };
    let stroke = Stroke {
        area,
        ..Stroke::new(brush, points)
    };
    let mut canvas = Canvas::empty(atlas.owners.len(), layers);
    Painter::new(&surface, &atlas, Supplies::of_pictures(pictures)).paint(&mut canvas, &stroke);
    let (Some(chart), Some(columns)) = (atlas.charts.first(), atlas.page_size.first()) else {
        return none();
    };
    let first = chart.texel_from_uv.map(|offset| offset + MARGIN as i32);
    let texel = |x: usize, y: usize| (first[1] as usize + y) * *columns as usize + first[0] as usize + x;
    let rows = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    let pixel = |texel: usize| {
        let texel = canvas.texel(texel);
        let color = (layers.color && texel.cover > 0.0).then(|| texel.color.map(|channel| channel / texel.cover));
        SwatchPixel {
            strength: texel.cover,
            color,
        }
    };
    rows.map(|(x, y)| pixel(texel(x, y))).collect()
}

/// Returns an upright wall that faces +z, with one model unit and one texel for each pixel and its lower left corner at the origin.
fn wall([width, height]: [usize; 2], side: usize) -> Mesh {
    let [w, h] = [width as f32, height as f32];
    let uv = |x: f32, y: f32| [x, y].map(|pixel| (pixel + MARGIN as f32) / side as f32);
    Mesh {
        positions: vec![[0.0, 0.0, 0.0], [w, 0.0, 0.0], [w, h, 0.0], [0.0, h, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 4],
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; 4],
        uvs: vec![uv(0.0, h), uv(w, h), uv(w, 0.0), uv(0.0, 0.0)],
        uv_set: Some(0),
        is_one_sheet: true,
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        triangle_part: vec![0; 2],
        triangle_material: vec![0; 2],
        ..Mesh::default()
    }
}

/// Site of a place of the picture, given in pixels from its upper left corner.
fn site_of([x, y]: [f64; 2], [width, height]: [usize; 2]) -> Site {
    let (w, h) = (width as f64, height as f64);
    let up = h - y;
    // The diagonal from the origin divides the wall into two triangles.
    Site {
        triangle: if up * w > x * h { 1 } else { 0 },
        position: DVec3::new(x, up, 0.0),
    }
}
