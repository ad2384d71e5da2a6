//! Placement of charts: whole texels away from their place in the user's layout, so that export is a copy.

use rayon::prelude::*;

use super::mask::Mask;
use super::pack::{CellPosition, Packer};
use super::{AtlasError, RINGS, TILE};

/// Most pages: texture array layers that every adapter supports.
const PAGES_LIMIT: u32 = 256;
/// Most texels: 2 GiB of owners.
const TEXELS_LIMIT: u64 = 1 << 29;

/// Pages and the place of each chart.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Placement {
    pub(super) page_size: [u32; 2],
    pub(super) pages: u32,
    pub(super) charts: Vec<Place>,
    /// True if charts keep their positions relative to each other.
    pub(super) kept: bool,
}

/// Place of a chart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) page: u32,
    /// Added to texel coordinates of the user's layout, gives those on the page.
    pub(super) offset: [i32; 2],
}

/// Places all charts so that no two rings of ghosts touch.
pub(super) fn place(masks: &[Mask], size: u32, page_limit: u32) -> Result<Placement, AtlasError> {
    let refuse = |needed: String, limit: String| {
        Err(AtlasError::TooManyTexels {
            size,
            charts: masks.len(),
            needed,
            limit,
        })
    };
    let placement = match keep(masks, size, page_limit) {
        Some(placement) => placement,
        None => repack(masks, size, page_limit),
    };
    let [width, height] = placement.page_size.map(u64::from);
    let texels = width * height * u64::from(placement.pages);
    if placement.pages > PAGES_LIMIT {
        return refuse(format!("{} pages", placement.pages), format!("{PAGES_LIMIT} pages"));
    }
    if texels > TEXELS_LIMIT {
        return refuse(format!("{texels} texels"), format!("{TEXELS_LIMIT} texels"));
    }
    Ok(placement)
}

/// Keeps the user's own layout; `None` unless all charts lie inside the unit square with room for their rings.
fn keep(masks: &[Mask], size: u32, page_limit: u32) -> Option<Placement> {
    let (ring, side) = (i64::from(RINGS), i64::from(size));
    let within = |edge: i64| {
        masks.iter().all(|mask| {
            let [x, y] = mask.origin;
            let far = (x + i64::from(mask.width)).max(y + i64::from(mask.height));
            mask.is_empty() || (x.min(y) >= edge && far <= side - edge)
        })
    };
    // Charts at the border of the square need room for their rings: the whole layout moves by one tile.
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
        let grown = mask.grown();
        let [x, y] = grown.origin.map(|value| value + i64::from(margin));
        for (row, bits) in grown.rows().enumerate() {
            if taken.merge_row(y as usize + row, bits, x) {
                return None;
            }
        }
    }
    let offset = [margin as i32; 2];
    let charts = vec![Place { page: 0, offset }; masks.len()];
    Some(Placement {
        page_size: [page, page],
        pages: 1,
        charts,
        kept: true,
    })
}

/// Packs the charts in cells, the largest first.
fn repack(masks: &[Mask], size: u32, page_limit: u32) -> Placement {
    // About 256 cells along the unit square: fine enough to waste little space, coarse enough to be fast at any size.
    let mut cell = (size / 256).clamp(1, 64).next_power_of_two();
    while cell > 1 && (!page_limit.is_multiple_of(cell) || cell * 32 > page_limit) {
        cell /= 2;
    }
    let grown: Vec<([i64; 2], Mask)> = masks
        .par_iter()
        .map(|mask| {
            let grown = mask.grown();
            (grown.origin, grown.cells(cell))
        })
        .collect();
    let area = grown.iter().map(|(_, shape)| shape.count()).sum();
    // No charts have no width.
    let widest = grown.iter().map(|(_, shape)| shape.width).max().unwrap_or(0);
    let mut packer = Packer::new(area, widest, page_limit / cell);
    let mut order: Vec<usize> = (0..masks.len()).filter(|&chart| !masks[chart].is_empty()).collect();
    order.sort_by_key(|&chart| {
        let (_, shape) = &grown[chart];
        let (width, height) = (u64::from(shape.width), u64::from(shape.height));
        (std::cmp::Reverse((width.max(height), width * height)), chart)
    });
    let mut charts = vec![Place::default(); masks.len()];
    for chart in order {
        let (origin, shape) = &grown[chart];
        let CellPosition { page, column, row } = packer.place(shape);
        let offset = [i64::from(column * cell) - origin[0], i64::from(row * cell) - origin[1]];
        charts[chart] = Place {
            page,
            offset: offset.map(|value| value as i32),
        };
    }
    let (columns, rows) = packer.extent();
    let page_size = [columns, rows].map(|cells| (cells * cell).next_multiple_of(TILE));
    Placement {
        page_size,
        pages: packer.pages().max(1),
        charts,
        kept: false,
    }
}
