//! Owners: the triangle of every texel whose center a chart covers.

use rayon::prelude::*;

use super::EMPTY;
use super::charts::Partition;
use super::fixed::{UNIT, Uvs};
use super::place::Placement;
use super::raster::spans;

/// Rows that one task fills.
const BAND_ROWS: usize = 32;

/// Computes the owner of every texel, page by page and row by row, without ghosts.
///
/// If two triangles of a chart cover the same texel center, the triangle with the lower number owns the texel.
pub(super) fn texel_owners(uvs: &Uvs, partition: &Partition, placement: &Placement) -> Vec<u32> {
    let [width, height] = placement.page_size.map(|side| side as usize);
    let rows = height * placement.pages as usize;
    let mut owners = vec![EMPTY; width * rows];
    let corners = |triangle: u32| {
        let place = placement.charts[partition.triangle_chart[triangle as usize] as usize];
        let [x, y] = place.offset.map(i64::from);
        let y = y + i64::from(place.page) * height as i64;
        uvs.fixed(triangle)
            .map(|corner| [corner[0] + x * UNIT, corner[1] + y * UNIT])
    };
    let bands = Bands::new(partition.triangle_chart.len() as u32, rows, corners);
    owners
        .par_chunks_mut(width * BAND_ROWS)
        .enumerate()
        .for_each(|(band, owners)| {
            let top = (band * BAND_ROWS) as i64;
            let bottom = top + (owners.len() / width) as i64;
            // Backwards, so that the lowest number is written last.
            for &triangle in bands.triangles(band).iter().rev() {
                spans(corners(triangle), (top, bottom), |y, x0, x1| {
                    let start = (y - top) as usize * width;
                    owners[start + x0 as usize..start + x1 as usize].fill(triangle);
                });
            }
        });
    owners
}

/// Triangles of each band of rows, in rising order.
struct Bands {
    starts: Vec<usize>,
    members: Vec<u32>,
}

impl Bands {
    fn new(triangles: u32, rows: usize, corners: impl Fn(u32) -> [[i64; 2]; 3] + Sync) -> Bands {
        let count = rows.div_ceil(BAND_ROWS);
        let reach: Vec<(u32, u32)> = (0..triangles)
            .into_par_iter()
            .map(|triangle| {
                let ys = corners(triangle).map(|corner| corner[1].div_euclid(UNIT * BAND_ROWS as i64));
                let clamp = |band: i64| band.clamp(0, count as i64 - 1) as u32;
                (clamp(ys[0].min(ys[1]).min(ys[2])), clamp(ys[0].max(ys[1]).max(ys[2])))
            })
            .collect();
        let mut starts = vec![0; count + 1];
        for &(first, last) in &reach {
            (first..=last).for_each(|band| starts[band as usize + 1] += 1);
        }
        for band in 0..count {
            starts[band + 1] += starts[band];
        }
        let mut next = starts.clone();
        let mut members = vec![0; starts[count]];
        for (triangle, &(first, last)) in reach.iter().enumerate() {
            for band in first..=last {
                let slot = &mut next[band as usize];
                members[*slot] = triangle as u32;
                *slot += 1;
            }
        }
        Bands { starts, members }
    }

    fn triangles(&self, band: usize) -> &[u32] {
        &self.members[self.starts[band]..self.starts[band + 1]]
    }
}
