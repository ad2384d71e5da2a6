//! Leap map: the leap of each texel, and whether the surface is flat around it.

use rayon::prelude::*;
use sabi_surface::atlas::{Atlas, GHOST_BIT};

use crate::tables::{GEOMETRY_ROWS, SurfaceTables, texel_area_vector};

/// Longest leap that fits into six bits.
const LONGEST_LEAP: u8 = (1 << LEAP_BITS) - 1;
/// Number of bits of a byte that hold a leap. The two bits above them tell along which diagonals the surface around the texel is flat.
pub(crate) const LEAP_BITS: u32 = 6;
/// Cosine of the angle between two triangles above which they count as one plane.
const COPLANAR_COSINE: f32 = 0.999_999;
/// Steps to the eight neighbors of a texel, in order around it. The first one is repeated at the end.
const NEIGHBORS: [[i32; 2]; 9] = [
    [-1, 0],
    [-1, -1],
    [0, -1],
    [1, -1],
    [1, 0],
    [1, 1],
    [0, 1],
    [-1, 1],
    [-1, 0],
];

/// Returns a byte for each texel, in the layout of `leaps` in `shaders/lib/atlas.wgsl`.
pub(crate) fn leaps(atlas: &Atlas, tables: &SurfaceTables) -> Vec<u8> {
    let normals: Vec<[f32; 3]> = tables
        .geometry
        .as_chunks::<GEOMETRY_ROWS>()
        .0
        .iter()
        .map(unit_normal)
        .collect();
    let [width, height] = atlas.page_size.map(|side| side as usize);
    let page = width * height;
    let byte = |index: usize| {
        let leap = atlas.leap[index].min(LONGEST_LEAP);
        let owner = atlas.owners[index];
        if owner & GHOST_BIT != 0 {
            return leap;
        }
        let [x, y] = [index % width, index % page / width];
        let is_coplanar = |[right, down]: [i32; 2]| {
            let place = x
                .checked_add_signed(right as isize)
                .zip(y.checked_add_signed(down as isize));
            place.filter(|(x, y)| *x < width && *y < height).is_some_and(|(x, y)| {
                let other = atlas.owners[index / page * page + y * width + x];
                other == owner
                    || other & GHOST_BIT == 0 && dot(normals[other as usize], normals[owner as usize]) > COPLANAR_COSINE
            })
        };
        // A quadrant is flat if its three neighbors are in the plane of the texel. The mean of points of two opposite flat
        // quadrants is the center.
        let coplanar = NEIGHBORS.map(is_coplanar);
        let is_flat = |first: usize| coplanar[first..first + 3].iter().all(|coplanar| *coplanar);
        leap | u8::from(is_flat(0) && is_flat(4)) << LEAP_BITS | u8::from(is_flat(2) && is_flat(6)) << (LEAP_BITS + 1)
    };
    (0..atlas.owners.len()).into_par_iter().map(byte).collect()
}

/// Unit normal of a triangle; reversed on mirrored charts, which is the same for all texels of a chart.
fn unit_normal(rows: &[[f32; 4]; GEOMETRY_ROWS]) -> [f32; 3] {
    let area = texel_area_vector(rows);
    let length = area.iter().map(|x| x * x).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
    area.map(|x| (x / length) as f32)
}

fn dot(one: [f32; 3], other: [f32; 3]) -> f32 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}
