//! Rings: the texels around charts that become ghosts, each with its anchor, the owned texel that its walk starts from.

use rayon::prelude::*;
use sabi_cancel::Cancel;

use super::mask::{for_each_run, or_shifted};
use super::{EMPTY, RINGS, TILE, TileRef};

/// Rows of one parallel task.
const BAND_ROWS: usize = 32;

/// Owned texels, a bit each.
pub(super) struct Occupancy {
    width: usize,
    height: usize,
    words: usize,
    bits: Vec<u64>,
}

/// A ghost before it is linked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct AnchoredGhost {
    /// Column, row, page.
    pub(super) texel: [u32; 3],
    /// The nearest owned texel, on the same page.
    pub(super) anchor: [u32; 2],
    /// Triangle that owns the anchor.
    pub(super) triangle: u32,
}

impl Occupancy {
    pub(super) fn new(owners: &[u32], page_size: [u32; 2]) -> Occupancy {
        let [width, height] = page_size.map(|side| side as usize);
        let words = width / 64 + 1;
        let mut bits = vec![0u64; owners.len() / width * words];
        bits.par_chunks_mut(words)
            .zip(owners.par_chunks(width))
            .for_each(|(bits, owners)| {
                for (word, owners) in bits.iter_mut().zip(owners.chunks(64)) {
                    for (bit, &owner) in owners.iter().enumerate() {
                        *word |= u64::from(owner != EMPTY) << bit;
                    }
                }
            });
        Occupancy {
            width,
            height,
            words,
            bits,
        }
    }

    fn rows(&self) -> usize {
        self.bits.len() / self.words
    }

    fn row(&self, row: usize) -> &[u64] {
        &self.bits[row * self.words..][..self.words]
    }

    /// Returns the owned texels and the texels of their rings, in one row of all pages.
    fn grown_row(&self, row: usize) -> Vec<u64> {
        let ring = RINGS as usize;
        let page_top = row / self.height * self.height;
        let first = row.saturating_sub(ring).max(page_top);
        let last = (row + ring).min(page_top + self.height - 1);
        let mut tall = vec![0; self.words];
        for near in first..=last {
            tall.iter_mut()
                .zip(self.row(near))
                .for_each(|(tall, word)| *tall |= word);
        }
        let mut grown = vec![0; self.words];
        for shift in -i64::from(RINGS)..=i64::from(RINGS) {
            or_shifted(&mut grown, &tall, shift);
        }
        grown
    }

    /// Returns all ghosts with their anchors, in the order of their texels. Triangles for which `prefer` returns true are
    /// preferred as anchors.
    pub(super) fn anchored(&self, owners: &[u32], prefer: impl Fn(u32) -> bool + Sync) -> Vec<AnchoredGhost> {
        let cancel = Cancel::current();
        let offsets = neighborhood();
        let bands: Vec<usize> = (0..self.rows()).step_by(BAND_ROWS).collect();
        let found: Vec<Vec<AnchoredGhost>> = bands
            .into_par_iter()
            .map(|top| {
                let mut found = Vec::new();
                for row in top..(top + BAND_ROWS).min(self.rows()) {
                    cancel.look();
                    let mut ring = self.grown_row(row);
                    ring.iter_mut()
                        .zip(self.row(row))
                        .for_each(|(ring, owned)| *ring &= !owned);
                    for_each_run(&ring, |x0, x1| {
                        let texels = x0..x1.min(self.width);
                        found.extend(texels.filter_map(|x| self.anchor(owners, x, row, &offsets, &prefer)));
                    });
                }
                found
            })
            .collect();
        found.concat()
    }

    /// Anchors the ghost at a texel; `None` when no owned texel is within the rings.
    fn anchor(
        &self,
        owners: &[u32],
        x: usize,
        row: usize,
        offsets: &[[i64; 2]],
        prefer: &impl Fn(u32) -> bool,
    ) -> Option<AnchoredGhost> {
        let (page, y) = (row / self.height, row % self.height);
        let mut fallback = None;
        for [dx, dy] in offsets {
            let (near_x, near_y) = (x as i64 + dx, y as i64 + dy);
            if near_x < 0 || near_y < 0 || near_x >= self.width as i64 || near_y >= self.height as i64 {
                continue;
            }
            let triangle = owners[(page * self.height + near_y as usize) * self.width + near_x as usize];
            if triangle == EMPTY {
                continue;
            }
            let anchored = AnchoredGhost {
                texel: [x as u32, y as u32, page as u32],
                anchor: [near_x as u32, near_y as u32],
                triangle,
            };
            if prefer(triangle) {
                return Some(anchored);
            }
            fallback = fallback.or(Some(anchored));
        }
        fallback
    }

    /// Tiles with at least one owned or ghost texel.
    pub(super) fn tiles(&self) -> Vec<TileRef> {
        let tile = TILE as usize;
        let tile_rows: Vec<usize> = (0..self.rows() / tile).collect();
        let found: Vec<Vec<TileRef>> = tile_rows
            .into_par_iter()
            .map(|tile_row| {
                let mut any = vec![0u64; self.words];
                for row in tile_row * tile..(tile_row + 1) * tile {
                    any.iter_mut()
                        .zip(self.grown_row(row))
                        .for_each(|(any, word)| *any |= word);
                }
                let (page, row) = (tile_row * tile / self.height, tile_row * tile % self.height / tile);
                (0..self.width / tile)
                    .filter(|column| any[column / 8] >> (column % 8 * tile) & 0xff != 0)
                    .map(|column| TileRef {
                        page: page as u32,
                        row: row as u32,
                        column: column as u32,
                    })
                    .collect()
            })
            .collect();
        found.concat()
    }
}

/// Returns the offsets to all texels within the rings, nearest first. Among equally near ones, the smallest index comes first.
fn neighborhood() -> Vec<[i64; 2]> {
    let ring = i64::from(RINGS);
    let mut offsets: Vec<[i64; 2]> = (-ring..=ring)
        .flat_map(|dy| (-ring..=ring).map(move |dx| [dx, dy]))
        .collect();
    offsets.retain(|offset| *offset != [0, 0]);
    offsets.sort_by_key(|[dx, dy]| (dx * dx + dy * dy, *dy, *dx));
    offsets
}
