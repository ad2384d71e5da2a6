//! Times from a cancelation to the end of reading: `cargo run --release -p sabi_surface --example cancel_times -- [MODEL] [SIZE]`.
//!
//! Without a model, a ball of a million triangles is read in each format that is text or plain bytes. Reading and the building of
//! the atlas are canceled at many moments, and the slowest answers are told.

use std::path::{Path, PathBuf};
use std::thread;
use std::time::Instant;

use sabi_cancel::{Cancel, Canceled, cancelable};
use sabi_surface::atlas::{Atlas, AtlasOptions};
use sabi_surface::load::{LoadOptions, load};
use sabi_surface::pieces::Pieces;

/// Moments of cancelation.
const MOMENTS: u32 = 24;
/// Rows of the ball.
const ROWS: u32 = 700;

type ExampleError = Box<dyn std::error::Error + Send + Sync>;

fn main() -> Result<(), ExampleError> {
    let mut arguments = std::env::args().skip(1);
    let given = arguments.next().filter(|file| file != "-").map(PathBuf::from);
    let size = arguments.next().map_or(Ok(1024), |size| size.parse())?;
    let folder = std::env::temp_dir().join(format!("sabi-cancel-times-{}", std::process::id()));
    let models = match given {
        Some(file) => vec![file],
        None => write_balls(&folder)?,
    };
    for model in models {
        measure(&model, size)?;
    }
    let _ = std::fs::remove_dir_all(folder);
    Ok(())
}

fn measure(model: &Path, size: u32) -> Result<(), ExampleError> {
    let started = Instant::now();
    read(model, size)?;
    let whole = started.elapsed();
    let mut answers = Vec::new();
    for moment in 0..MOMENTS {
        let request = Cancel::new();
        let wait = whole * moment / MOMENTS;
        let (asking, asked) = (request.clone(), request);
        let asks = thread::spawn(move || {
            thread::sleep(wait);
            asking.cancel();
            Instant::now()
        });
        let ended: Result<Result<(), ExampleError>, Canceled> = cancelable(&asked, || read(model, size));
        let end = Instant::now();
        let Ok(asked) = asks.join() else { continue };
        if ended.is_err() {
            answers.push((end.saturating_duration_since(asked), wait));
        }
    }
    answers.sort_unstable();
    eprintln!("{}: {whole:?} uncanceled", model.display());
    for (answer, at) in answers.iter().rev().take(4) {
        eprintln!("    {:>6.1} ms after {at:?}", answer.as_secs_f64() * 1e3);
    }
    Ok(())
}

fn read(model: &Path, size: u32) -> Result<(), ExampleError> {
    let model = load(model, &LoadOptions::default())?;
    if !model.mesh.uvs.is_empty() {
        Atlas::build(&model.mesh, &AtlasOptions::new(size))?;
    }
    Pieces::of(&model.mesh);
    Ok(())
}

/// Writes a ball as OBJ, PLY and STL.
fn write_balls(folder: &Path) -> Result<Vec<PathBuf>, ExampleError> {
    std::fs::create_dir_all(folder)?;
    let count = ROWS + 1;
    let at = |row: u32, column: u32| {
        let [latitude, longitude] = [row, column].map(|step| f64::from(step) / f64::from(ROWS) * std::f64::consts::PI);
        let (ring, y) = latitude.sin_cos();
        let (sin, cos) = (2.0 * longitude).sin_cos();
        [ring * cos, y, ring * sin]
    };
    let places: Vec<[f64; 3]> = (0..count * count).map(|n| at(n / count, n % count)).collect();
    let uv = |n: u32| [n % count, n / count].map(|step| f64::from(step) / f64::from(ROWS));
    let corners = (0..ROWS * ROWS).flat_map(|cell| {
        let first = cell / ROWS * count + cell % ROWS;
        [
            [first, first + 1, first + count],
            [first + 1, first + count + 1, first + count],
        ]
    });
    let triangles: Vec<[u32; 3]> = corners.collect();
    let mut obj = String::new();
    for (n, [x, y, z]) in places.iter().enumerate() {
        let [u, v] = uv(n as u32);
        obj.push_str(&format!("v {x} {y} {z}\nvt {u} {v}\n"));
    }
    for triangle in &triangles {
        let [a, b, c] = triangle.map(|corner| corner + 1);
        obj.push_str(&format!("f {a}/{a} {b}/{b} {c}/{c}\n"));
    }
    let mut ply = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nproperty \
         float s\nproperty float t\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        places.len(),
        triangles.len()
    )
    .into_bytes();
    for (n, place) in places.iter().enumerate() {
        let values = place.iter().copied().chain(uv(n as u32));
        ply.extend(values.flat_map(|value| (value as f32).to_le_bytes()));
    }
    let mut stl = vec![0; 80];
    stl.extend((triangles.len() as u32).to_le_bytes());
    for triangle in &triangles {
        ply.push(3);
        ply.extend(triangle.iter().flat_map(|corner| corner.to_le_bytes()));
        stl.extend([0; 12]);
        let values = triangle.iter().flat_map(|corner| places[*corner as usize]);
        stl.extend(values.flat_map(|value| (value as f32).to_le_bytes()));
        stl.extend([0; 2]);
    }
    let write = |name: &str, bytes: &[u8]| {
        let file = folder.join(name);
        std::fs::write(&file, bytes).map(|()| file)
    };
    Ok(vec![
        write("ball.obj", obj.as_bytes())?,
        write("ball.ply", &ply)?,
        write("ball.stl", &stl)?,
    ])
}
