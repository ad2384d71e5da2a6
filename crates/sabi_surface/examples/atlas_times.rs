//! Measures the time to build an atlas: `cargo run --release -p sabi_surface --example atlas_times -- [MODEL] [SIZE]`.
//!
//! Without a model, a ball of 30 000 triangles in 24 charts is used.

use std::path::Path;
use std::time::Instant;

use sabi_surface::atlas::{Atlas, AtlasOptions, cached};
use sabi_surface::bvh::Bvh;
use sabi_surface::load::{LoadOptions, load};
use sabi_surface::model::Mesh;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let mesh = match arguments.next() {
        Some(file) if file != "-" => load(Path::new(&file), &LoadOptions::default())?.mesh,
        _ => ball(),
    };
    let size = arguments.next().map_or(Ok(2048), |size| size.parse())?;
    let options = AtlasOptions::new(size);
    let folder = std::env::temp_dir().join(format!("sabi-atlas-times-{}", std::process::id()));
    for _ in 0..3 {
        let start = Instant::now();
        let atlas = Atlas::build(&mesh, &options)?;
        eprintln!("cold {:?}", start.elapsed());
        let (_, _) = cached(Some(&folder), &mesh, &options)?;
        let start = Instant::now();
        let (_, warm) = cached(Some(&folder), &mesh, &options)?;
        eprintln!("from the cache ({warm}) {:?}", start.elapsed());
        let start = Instant::now();
        let level = atlas.level(&mesh, 1)?;
        eprintln!("level 1 {:?}, pages {:?}", start.elapsed(), level.atlas.page_size);
        let start = Instant::now();
        let bvh = Bvh::build(&mesh);
        eprintln!("hierarchy {:?}, {} nodes", start.elapsed(), bvh.tree().nodes.len());
        eprintln!(
            "{} triangles, {} charts, {} pages of {:?}, {} ghosts, {} tiles",
            mesh.triangles.len(),
            atlas.charts.len(),
            atlas.pages,
            atlas.page_size,
            atlas.ghosts.len(),
            atlas.tiles.len()
        );
        let leaps: u64 = atlas.leap.iter().map(|&leap| u64::from(leap)).sum();
        let owned: u64 = atlas.charts.iter().map(|chart| u64::from(chart.texels)).sum();
        eprintln!("mean leap {:.2}", leaps as f64 / owned as f64);
        let mut report = atlas.report;
        report.overlapping_charts.truncate(5);
        eprintln!("{report:#?}");
    }
    for entry in std::fs::read_dir(&folder)? {
        eprintln!("cache file of {} bytes", entry?.metadata()?.len());
    }
    std::fs::remove_dir_all(&folder)?;
    Ok(())
}

/// A bumpy ball: 4 × 6 charts, side by side.
fn ball() -> Mesh {
    let mut mesh = Mesh::default();
    let (rows, columns, cells) = (4u32, 6u32, 25u32);
    for chart in 0..rows * columns {
        let (row, column) = (chart / columns, chart % columns);
        let first = mesh.positions.len() as u32;
        for y in 0..=cells {
            for x in 0..=cells {
                let (v, u) = (row * cells + y, column * cells + x);
                let latitude = (f64::from(v) / f64::from(rows * cells) - 0.5) * 2.8;
                let longitude = f64::from(u % (columns * cells)) / f64::from(columns * cells) * std::f64::consts::TAU;
                let radius = 1.0 + 0.1 * (longitude * 7.0).sin() * (latitude * 9.0).sin();
                let ring = radius * latitude.cos();
                let position = [ring * longitude.cos(), radius * latitude.sin(), ring * longitude.sin()];
                mesh.positions.push(position.map(|value| value as f32));
                let place = |chart: u32, cell: u32, of: u32| {
                    (f64::from(chart) + 0.02 + 0.96 * f64::from(cell) / f64::from(cells)) / f64::from(of)
                };
                mesh.uvs
                    .push([place(column, x, columns), place(row, y, rows)].map(|value| value as f32));
            }
        }
        for y in 0..cells {
            for x in 0..cells {
                let at = first + y * (cells + 1) + x;
                mesh.triangles
                    .extend([[at, at + cells + 2, at + 1], [at, at + cells + 1, at + cells + 2]]);
            }
        }
    }
    mesh.triangle_material = vec![0; mesh.triangles.len()];
    mesh.triangle_part = vec![0; mesh.triangles.len()];
    mesh
}
