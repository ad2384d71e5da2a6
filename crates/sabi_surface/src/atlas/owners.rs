//! Owners: the triangle of every texel whose center a chart covers.

use rayon::prelude::*;
use sabi_cancel::{Cancel, CancelableIterator as _};

use super::EMPTY;
use super::chart_placement::ChartPlacement;
use super::charts::Partition;
use super::fixed_point_uvs::{UNIT, Uvs};
use super::raster::spans;
use crate::groups::Groups;

/// Rows that one task fills.
const BAND_ROWS: usize = 32;

/// Computes the owner of every texel, page by page and row by row, without ghosts.
///
/// If two triangles of a chart cover the same texel center, the triangle with the lower number owns the texel.
pub(super) fn texel_owners(uvs: &Uvs, partition: &Partition, placement: &ChartPlacement) -> Vec<u32> {
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
    let cancel = Cancel::current();
    let bands = bands(partition.triangle_chart.len() as u32, rows, corners);
    owners
        .par_chunks_mut(width * BAND_ROWS)
        .enumerate()
        .for_each(|(band, owners)| {
            let top = (band * BAND_ROWS) as i64;
            let bottom = top + (owners.len() / width) as i64;
            // Iterate in reverse, so that the lowest number is written last.
            for &triangle in bands.members(band).iter().rev() {
                cancel.look();
                spans(corners(triangle), top..bottom, |y, x0, x1| {
                    let start = (y - top) as usize * width;
                    owners[start + x0 as usize..start + x1 as usize].fill(triangle);
                });
            }
        });
    owners
}

/// Triangles of each band of rows, in rising order.
fn bands(triangles: u32, rows: usize, corners: impl Fn(u32) -> [[i64; 2]; 3] + Sync) -> Groups {
    let count = rows.div_ceil(BAND_ROWS);
    let reach: Vec<(u32, u32)> = (0..triangles)
        .into_par_iter()
        .map(|triangle| {
            let ys = corners(triangle).map(|corner| corner[1].div_euclid(UNIT * BAND_ROWS as i64));
            let clamp = |band: i64| band.clamp(0, count as i64 - 1) as u32;
            (clamp(ys[0].min(ys[1]).min(ys[2])), clamp(ys[0].max(ys[1]).max(ys[2])))
        })
        .collect();
    Groups::new(count, |member| {
        for (triangle, &(first, last)) in reach.iter().enumerate().looking() {
            (first..=last).for_each(|band| member(band as usize, triangle as u32));
        }
    })
}
