//! Packing: each shape of cells is placed at the topmost, then leftmost free position of the first page that has space for it.

use std::collections::BTreeMap;

use super::mask::{Mask, for_each_run};

/// Position of a packed shape's top left cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CellPosition {
    pub(crate) page: u32,
    pub(crate) column: u32,
    pub(crate) row: u32,
}

/// Pages of cells.
pub(crate) struct Packer {
    columns: u32,
    rows_limit: u32,
    pages: Vec<PageCells>,
    /// Where the search for a shape of this width and height starts: no shape of this size fits before it.
    starts: BTreeMap<(u32, u32), (u32, u32)>,
}

/// Cells in use, a bit each.
#[derive(Default)]
struct PageCells {
    rows: Vec<Vec<u64>>,
}

impl Packer {
    /// Creates a packer whose pages have a width that suits shapes with a total area of `area` cells, the widest of which
    /// has `widest` columns.
    pub(crate) fn new(area: u64, widest: u32, limit: u32) -> Packer {
        // About 15 % of the area is lost between shapes.
        let side = ((area as f64) * 1.15).sqrt().ceil() as u32;
        Packer::with_columns(side.max(widest).min(limit).max(1), limit)
    }

    /// Creates a packer with pages of `columns` columns and at most `limit` rows.
    pub(crate) fn with_columns(columns: u32, limit: u32) -> Packer {
        Packer {
            columns,
            rows_limit: limit,
            pages: Vec::new(),
            starts: BTreeMap::new(),
        }
    }

    /// Places a shape that fits on an empty page. Larger shapes should come first.
    pub(crate) fn place(&mut self, shape: &Mask) -> CellPosition {
        let position = self.find(shape);
        self.take(shape, position);
        position
    }

    /// Marks the cells of a shape at a position from [`Packer::find`] as used.
    pub(crate) fn take(&mut self, shape: &Mask, position: CellPosition) {
        self.pages[position.page as usize].take(shape, position.column, position.row, self.columns);
    }

    /// Finds the position of a shape that fits on an empty page.
    pub(crate) fn find(&mut self, shape: &Mask) -> CellPosition {
        let size = (shape.width, shape.height);
        // The first search for a size starts on the first page.
        let (mut page, mut row) = self.starts.get(&size).copied().unwrap_or((0, 0));
        loop {
            if page as usize == self.pages.len() {
                self.pages.push(PageCells::default());
            }
            if row + shape.height > self.rows_limit {
                (page, row) = (page + 1, 0);
                continue;
            }
            let cells = &self.pages[page as usize];
            if let Some(column) = cells.free_column(shape, row, self.columns) {
                self.starts.insert(size, (page, row));
                return CellPosition { page, column, row };
            }
            row += 1;
        }
    }

    /// Number of pages.
    pub(crate) fn pages(&self) -> u32 {
        self.pages.len() as u32
    }

    /// Columns and rows in use on the fullest page, at least one.
    pub(crate) fn extent(&self) -> (u32, u32) {
        // The default stands for no page in use.
        let rows = self.pages.iter().map(|page| page.rows.len()).max().unwrap_or(0);
        let last = |row: &Vec<u64>| {
            row.iter()
                .rposition(|&word| word != 0)
                .map_or(0, |word| (word + 1) * 64 - row[word].leading_zeros() as usize)
        };
        let columns = self
            .pages
            .iter()
            .flat_map(|page| page.rows.iter().map(last))
            .max()
            // The default stands for no row in use.
            .unwrap_or(0);
        (columns.max(1) as u32, rows.max(1) as u32)
    }
}

impl PageCells {
    /// Returns the first column of a row at which the shape covers only free cells.
    fn free_column(&self, shape: &Mask, row: u32, columns: u32) -> Option<u32> {
        let last = columns.checked_sub(shape.width)? as usize;
        let words = columns as usize / 64 + 1;
        let mut blocked = vec![0u64; words];
        for (cells, taken) in shape.rows().zip(self.rows.iter().skip(row as usize)) {
            for_each_run(cells, |from, to| block(&mut blocked, taken, from, to));
        }
        (0..words)
            .find(|&word| blocked[word] != u64::MAX)
            .map(|word| word * 64 + (!blocked[word]).trailing_zeros() as usize)
            .filter(|&column| column <= last)
            .map(|column| column as u32)
    }

    fn take(&mut self, shape: &Mask, column: u32, row: u32, columns: u32) {
        let words = columns as usize / 64 + 1;
        let bottom = (row + shape.height) as usize;
        while self.rows.len() < bottom {
            self.rows.push(vec![0; words]);
        }
        for (cells, taken) in shape.rows().zip(&mut self.rows[row as usize..]) {
            super::mask::or_shifted(taken, cells, i64::from(column));
        }
    }
}

/// Marks all columns at which one of the cells `from..to` of a shape would cover a used cell.
fn block(blocked: &mut [u64], taken: &[u64], from: usize, to: usize) {
    let mut reach = vec![0u64; blocked.len()];
    super::mask::or_shifted(&mut reach, taken, -(from as i64));
    // Doubling: after each step, a bit is the union of twice as many cells to its right.
    let (length, mut covered) = (to - from, 1);
    while covered < length {
        let step = covered.min(length - covered);
        let before = reach.clone();
        super::mask::or_shifted(&mut reach, &before, -(step as i64));
        covered += step;
    }
    blocked
        .iter_mut()
        .zip(&reach)
        .for_each(|(blocked, reach)| *blocked |= reach);
}
