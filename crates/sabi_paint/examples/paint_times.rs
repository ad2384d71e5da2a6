//! Measures times of painting: `cargo run --release -p sabi_paint --example paint_times -- [MODEL] [SIZE] [STROKES]`.
//!
//! Draws strokes over the front of the model, each with a length of a fifth of the model, with a round brush of 5 % of its
//! size. Prints the time of a stroke on an existing canvas, of a new canvas with all strokes, of a step back, and of one
//! more point at the end of a long stroke.
//!
//! If a number of strokes is given, the strokes are like those of an artist instead: most of them with a brush of 1 % of
//! the model, round or with a tip, some of them erasing, and a few larger. Prints the times for storing, reading and
//! painting them, and the memory of the kept canvases.

#![allow(clippy::print_stdout, reason = "a program of its own")]

use std::collections::BTreeSet;
use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec3;
use sabi_paint::{
    Action, Brush, Canvases, Layers, PaintSurface, StampPictures, Step, Stroke, StrokeBook, StrokeList, StrokePoint,
    Supplies, SurfaceIndex, Tip, Version, file,
};
use sabi_surface::atlas::{Atlas, AtlasOptions};
use sabi_surface::bvh::Bvh;
use sabi_surface::load::{LoadOptions, load};
use sabi_surface::patch::Site;

/// Number of strokes that are drawn.
const STROKES: usize = 256;
/// Number of points of a stroke.
const POINTS: usize = 40;
/// Memory limit of kept canvases in bytes.
const BUDGET: usize = 512 << 20;
/// Number of strokes that are joined to a long one.
const LONG: usize = 12;
/// Number of points of a stroke of an artist.
const ARTIST_POINTS: usize = 200;
/// Memory limit of kept canvases for an artist's strokes, in bytes.
const ARTIST_BUDGET: usize = 256 << 20;
/// Number of an artist's strokes after which the memory is measured.
const COUNTED: usize = 500;
/// Layers that are painted: only those of a mask.
const LAYERS: Layers = Layers {
    value: true,
    color: false,
    height: false,
    direction: false,
};

/// A model that is painted on.
struct Scene<'a> {
    surface: &'a PaintSurface<'a>,
    bvh: &'a Bvh,
    atlas: &'a Atlas,
    low: DVec3,
    high: DVec3,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1);
    let model = arguments
        .next()
        .map_or_else(|| PathBuf::from("assets/meshes/figure.glb"), PathBuf::from);
    let mut number = || arguments.next()?.to_str()?.parse::<u32>().ok();
    let size = number().unwrap_or(1024); // The size that the editor uses.
    let strokes = number();
    let mesh = load(&model, &LoadOptions::default())?.mesh;
    let atlas = Atlas::build(&mesh, &AtlasOptions::new(size))?;
    let (index, bvh) = (SurfaceIndex::new(&mesh), Bvh::build(&mesh));
    let (low, high) = bounds(&mesh.positions);
    let scene = Scene {
        surface: &PaintSurface::new(&mesh, &index),
        bvh: &bvh,
        atlas: &atlas,
        low,
        high,
    };
    print!("{size} texels, {} triangles, ", mesh.triangles.len());
    match strokes {
        Some(strokes) => time_artist(&scene, strokes as usize),
        None => {
            time_strokes(&scene);
            Ok(())
        }
    }
}

/// Prints the times of a stroke, of a step back, and of all strokes.
fn time_strokes(scene: &Scene<'_>) {
    println!("{STROKES} strokes");
    let mut book = StrokeBook::default();
    let mut versions = vec![Version::EMPTY];
    let brush = Brush {
        radius: (0.05 * scene.side()) as f32,
        ..Brush::default()
    };
    for number in 0..STROKES {
        let stroke = Stroke::new(brush.clone(), scene.way(number, POINTS));
        versions.push(book.push(versions[number], &Step::Add(Arc::new(stroke))));
    }
    let mut canvases = Canvases::default();
    let mut paint = |version: Version, canvases: &mut Canvases| -> Duration {
        let list = book.list(version).unwrap_or_default(); // All versions are known.
        scene.paint(&list, canvases, BUDGET)
    };
    let mut times: Vec<Duration> = versions[1..]
        .iter()
        .map(|version| paint(*version, &mut canvases))
        .collect();
    times.sort();
    println!(
        "one more stroke: {:?} in the middle, {:?} at most",
        times[STROKES / 2],
        times[STROKES - 1]
    );
    println!("a step back: {:?}", paint(versions[STROKES - 1], &mut canvases));
    println!(
        "all strokes anew: {:?}",
        paint(versions[STROKES], &mut Canvases::default())
    );
    for tip in [Tip::Round, Tip::Bristles] {
        time_long_stroke(scene, tip);
    }
}

/// Prints the time for one more point at the end of a long stroke, and for the whole stroke.
fn time_long_stroke(scene: &Scene<'_>, tip: Tip) {
    let brush = Brush {
        radius: (0.05 * scene.side()) as f32,
        ..Brush::default().with_tip(tip)
    };
    let mut places: Vec<StrokePoint> = (0..LONG).flat_map(|number| scene.way(number, POINTS)).collect();
    for place in places.iter_mut().skip(1) {
        place.starts = false;
    }
    let mut canvases = Canvases::default();
    let paint = |count: usize, canvases: &mut Canvases| {
        let stroke = Arc::new(Stroke::new(brush.clone(), places[..count].to_vec()));
        scene.paint(&StrokeList { strokes: vec![stroke] }, canvases, BUDGET)
    };
    let count = places.len();
    let mut times: Vec<Duration> = (count - POINTS..=count).map(|end| paint(end, &mut canvases)).collect();
    times.sort();
    println!(
        "a place more at the end of {count}, {tip:?}: {:?} in the middle, all of them anew: {:?}",
        times[POINTS / 2],
        paint(count, &mut Canvases::default())
    );
}

/// Prints times and sizes for the strokes of an artist, on disk and on a canvas.
fn time_artist(scene: &Scene<'_>, count: usize) -> Result<(), Box<dyn Error>> {
    println!("{count} strokes of an artist");
    let strokes: Vec<Step> = (0..count)
        .map(|number| Step::Add(Arc::new(scene.artist_stroke(number))))
        .collect();
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("model.strokes");
    let started = Instant::now();
    let mut written = StrokeBook::default();
    let mut last = Version::EMPTY;
    for step in &strokes {
        last = written.push(last, step);
    }
    file::store(
        &sabi_files::Disk::default(),
        &path,
        "model",
        &written,
        last,
        &mut BTreeSet::new(),
    )?;
    println!("encoded and stored: {:?}", started.elapsed());
    let started = Instant::now();
    let mut book = StrokeBook::default();
    let bytes = std::fs::read(&path)?;
    file::read(&bytes, &mut book)?;
    let list = book.list(last).unwrap_or_default(); // It was stored above.
    println!("{} MiB read: {:?}", bytes.len() >> 20, started.elapsed());
    println!(
        "all of them on a new canvas: {:?}",
        scene.paint(&list, &mut Canvases::default(), ARTIST_BUDGET)
    );
    let mut canvases = Canvases::default();
    let mut most = 0;
    for end in (0..count).step_by(COUNTED).skip(1).chain([count]) {
        let strokes = list.strokes[..end].to_vec();
        scene.paint(&StrokeList { strokes }, &mut canvases, ARTIST_BUDGET);
        most = most.max(canvases.bytes());
    }
    println!(
        "kept canvases: {} MiB at most, {} MiB after all strokes",
        most >> 20,
        canvases.bytes() >> 20
    );
    let under = StrokeList {
        strokes: list.strokes[..count.saturating_sub(1)].to_vec(),
    };
    println!("a step back: {:?}", scene.paint(&under, &mut canvases, ARTIST_BUDGET));
    println!("and forth: {:?}", scene.paint(&list, &mut canvases, ARTIST_BUDGET));
    Ok(())
}

fn bounds(positions: &[[f32; 3]]) -> (DVec3, DVec3) {
    let all = || positions.iter().map(|at| DVec3::from(at.map(f64::from)));
    (
        all().fold(DVec3::INFINITY, DVec3::min),
        all().fold(DVec3::NEG_INFINITY, DVec3::max),
    )
}

impl Scene<'_> {
    /// Largest side of the model.
    fn side(&self) -> f64 {
        (self.high - self.low).max_element()
    }

    /// Paints a list of strokes, and returns the time that it takes.
    fn paint(&self, list: &StrokeList, canvases: &mut Canvases, budget: usize) -> Duration {
        let started = Instant::now();
        canvases.painted(
            self.surface,
            self.atlas,
            [0; 32],
            list,
            Supplies::of_pictures(&StampPictures::new()),
            LAYERS,
            budget,
        );
        started.elapsed()
    }

    /// Returns a stroke like an artist's, always the same for the same number.
    fn artist_stroke(&self, number: usize) -> Stroke {
        let radius = if number.is_multiple_of(40) { 0.05 } else { 0.01 };
        let tip = match number % 8 {
            1 => Tip::Chalk,
            3 => Tip::Bristles,
            6 => Tip::Soft,
            _ => Tip::Round,
        };
        let brush = Brush {
            radius: (radius * self.side()) as f32,
            ..Brush::default().with_tip(tip)
        };
        Stroke {
            action: if number % 10 == 9 { Action::Erase } else { Action::Paint },
            ..Stroke::new(brush, self.way(number, ARTIST_POINTS))
        }
    }

    /// Returns points that start somewhere on the front of the model and lead in some direction, always the same for the same number.
    fn way(&self, number: usize, points: usize) -> Vec<StrokePoint> {
        let (low, high, side) = (self.low, self.high, self.side());
        // Evenly distributed numbers (Weyl's sequence of the plastic number).
        let spread = |step: f64| (number as f64 * step).fract();
        let start = low + (high - low) * DVec3::new(spread(0.754_877_666), spread(0.569_840_291), 0.0);
        let angle = std::f64::consts::TAU * spread(0.618_033_988);
        let way = 0.2 * side * DVec3::new(angle.cos(), angle.sin(), 0.0);
        let mut starts = true;
        let points = (0..points).filter_map(|point| {
            let at = start + way * (point as f64 / points as f64);
            let eye = DVec3::new(at.x, at.y, high.z + side);
            let hit = self.bvh.closest(eye.as_vec3().to_array(), [0.0, 0.0, -1.0], 1e9);
            let seen: Option<StrokePoint> = hit.and_then(|hit| {
                let barycentric = hit.barycentric.map(f64::from);
                let site = Site {
                    triangle: hit.triangle,
                    position: self.surface.mesh().position(hit.triangle, barycentric),
                };
                self.surface.point(site, 1.0, starts)
            });
            starts = seen.is_none();
            seen
        });
        points.collect()
    }
}
