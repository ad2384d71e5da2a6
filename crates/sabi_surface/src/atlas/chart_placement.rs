//! Placement of charts at offsets of whole texels from their place in the user's layout, so that export only copies texels.

use rayon::prelude::*;
use sabi_cancel::look;

use super::mask::Mask;
use super::pack::{CellPosition, Packer};
use super::{AtlasError, RINGS, TILE};

/// Maximum number of pages: texture array layers that every adapter supports.
const PAGES_LIMIT: u32 = 256;
/// Most texels: 2 GiB of owners.
pub(super) const TEXELS_LIMIT: u64 = 1 << 29;

/// Approximate maximum number of cells that charts cover while they are packed: the cells of eight unit squares.
const MOST_CELLS: f64 = 8.0 * 256.0 * 256.0;
/// Minimum number of cells along a chart of average area, if cells are enlarged because of [`MOST_CELLS`].
const LEAST_CHART_CELLS: f64 = 16.0;

/// Pages and the place of each chart.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ChartPlacement {
    pub(super) page_size: [u32; 2],
    pub(super) pages: u32,
    pub(super) charts: Vec<ChartPlace>,
    /// True if charts keep their positions relative to each other.
    pub(super) kept: bool,
}

/// Place of a chart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct ChartPlace {
    pub(super) page: u32,
    /// Offset that is added to texel coordinates of the user's layout to get those on the page.
    pub(super) offset: [i32; 2],
}

/// Places all charts so that no two rings of ghosts touch.
pub(super) fn place(masks: &[Mask], size: u32, page_limit: u32) -> Result<ChartPlacement, AtlasError> {
    let placement = match keep(masks, size, page_limit) {
        Some(placement) => placement,
        None => repack(masks, size, page_limit),
    };
    let [width, height] = placement.page_size.map(u64::from);
    let texels = width * height * u64::from(placement.pages);
    if placement.pages > PAGES_LIMIT {
        return Err(AtlasError::TooManyTexels {
            size,
            charts: masks.len(),
            needed: format!("{} pages", placement.pages),
            limit: format!("{PAGES_LIMIT} pages"),
        });
    }
    if texels > TEXELS_LIMIT {
        return Err(too_many_texels(size, masks.len(), texels));
    }
    Ok(placement)
}

/// Returns the error for charts that need more texels than an atlas can have.
pub(super) fn too_many_texels(size: u32, charts: usize, texels: u64) -> AtlasError {
    AtlasError::TooManyTexels {
        size,
        charts,
        needed: format!("{texels} texels"),
        limit: format!("{TEXELS_LIMIT} texels"),
    }
}

/// Keeps the user's own layout; `None` unless all charts lie inside the unit square with space for their rings.
fn keep(masks: &[Mask], size: u32, page_limit: u32) -> Option<ChartPlacement> {
    let (ring, side) = (i64::from(RINGS), i64::from(size));
    let within = |edge: i64| {
        masks.iter().all(|mask| {
            let [x, y] = mask.origin;
            let far = (x + i64::from(mask.width)).max(y + i64::from(mask.height));
            mask.is_empty() || (x.min(y) >= edge && far <= side - edge)
        })
    };
    // Charts at the border of the square need space for their rings: the whole layout moves by one tile.
    let margin = match () {
        () if within(ring) => 0,
        () if within(0) => TILE,
        () => return None,
    };
    let page = (size + 2 * margin).next_multiple_of(TILE);
    if page > page_limit {
        return None;
    }
    let mut taken = Mask::empty([0, 0], page, page);
    for mask in masks {
        look();
        let grown = mask.grown();
        let [x, y] = grown.origin.map(|value| value + i64::from(margin));
        for (row, bits) in grown.rows().enumerate() {
            if taken.merge_row(y as usize + row, bits, x) {
                return None;
            }
        }
    }
    let offset = [margin as i32; 2];
    let charts = vec![ChartPlace { page: 0, offset }; masks.len()];
    Some(ChartPlacement {
        page_size: [page, page],
        pages: 1,
        charts,
        kept: true,
    })
}

/// Returns the side of the cells that charts are packed in, texels.
fn cell_side(size: u32, masks: &[Mask], page_limit: u32) -> u32 {
    let of_charts = masks.iter().map(Mask::count).filter(|texels| *texels > 0);
    let (charts, texels) = of_charts.fold((0.0, 0.0), |(charts, sum), texels| (charts + 1.0, sum + texels as f64));
    // About 256 cells along the unit square: fine enough to waste little space, coarse enough to be fast at any size. If
    // large charts cover the square many times over, larger cells are used, so that the number of cells stays limited.
    let of_area = (texels / MOST_CELLS).sqrt();
    let of_chart = (texels / f64::max(charts, 1.0)).sqrt() / LEAST_CHART_CELLS;
    let mut cell = (size / 256)
        .max(of_area.min(of_chart) as u32)
        .clamp(1, 64)
        .next_power_of_two();
    while cell > 1 && (!page_limit.is_multiple_of(cell) || cell * 32 > page_limit) {
        cell /= 2;
    }
    cell
}

/// Packs the charts in cells, the largest first.
fn repack(masks: &[Mask], size: u32, page_limit: u32) -> ChartPlacement {
    let cell = cell_side(size, masks, page_limit);
    let grown: Vec<([i64; 2], Mask)> = masks
        .par_iter()
        .map(|mask| {
            let grown = mask.grown();
            (grown.origin, grown.cells(cell))
        })
        .collect();
    let area = grown.iter().map(|(_, shape)| shape.count()).sum();
    // The default stands for no charts.
    let widest = grown.iter().map(|(_, shape)| shape.width).max().unwrap_or(0);
    let mut packer = Packer::new(area, widest, page_limit / cell);
    let mut order: Vec<usize> = (0..masks.len()).filter(|&chart| !masks[chart].is_empty()).collect();
    order.sort_by_key(|&chart| {
        let (_, shape) = &grown[chart];
        let (width, height) = (u64::from(shape.width), u64::from(shape.height));
        (std::cmp::Reverse((width.max(height), width * height)), chart)
    });
    let mut charts = vec![ChartPlace::default(); masks.len()];
    for chart in order {
        look();
        let (origin, shape) = &grown[chart];
        let CellPosition { page, column, row } = packer.place(shape);
        let offset = [i64::from(column * cell) - origin[0], i64::from(row * cell) - origin[1]];
        charts[chart] = ChartPlace {
            page,
            offset: offset.map(|value| value as i32),
        };
    }
    let (columns, rows) = packer.extent();
    let page_size = [columns, rows].map(|cells| (cells * cell).next_multiple_of(TILE));
    ChartPlacement {
        page_size,
        pages: packer.pages().max(1),
        charts,
        kept: false,
    }
}

#[cfg(test)]
mod tests {
    use super::cell_side;
    use crate::atlas::mask::Mask;

    /// Creates square charts that are completely covered.
    fn squares(count: usize, side: u32) -> Vec<Mask> {
        let mut mask = Mask::empty([0, 0], side, side);
        for y in 0..i64::from(side) {
            mask.set(y, 0, i64::from(side));
        }
        vec![mask; count]
    }

    #[test]
    fn large_charts_that_cover_many_maps_are_packed_in_few_cells_and_small_ones_as_finely_as_ever() {
        for size in [256, 1024] {
            assert_eq!(cell_side(size, &squares(4, size), 8192), size / 256, "a few maps");
            assert_eq!(
                cell_side(size, &squares(40_000, size / 16), 8192),
                size / 256,
                "small charts"
            );
            let cell = cell_side(size, &squares(100, 1024), 8192);
            let cells = 100 * (1024 / cell).pow(2);
            assert!(cells <= 8 * 256 * 256, "100 charts of 1024² in cells of {cell} texels");
        }
        assert_eq!(cell_side(256, &[], 8192), 1);
    }
}
