//! Bit masks of the texels whose centers a chart covers.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::fixed_point_uvs::{UNIT, Uvs};
use super::raster::spans;
use sabi_cancel::CancelableIterator as _;

/// Texels that a chart covers in the user's layout, one bit each, in the smallest rectangle that contains them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Mask {
    /// Column and row of the first bit in the user's layout.
    pub(crate) origin: [i64; 2],
    /// Columns.
    pub(crate) width: u32,
    /// Rows.
    pub(crate) height: u32,
    /// Words in a row, with room for at least one more bit than there are columns.
    words: usize,
    bits: Vec<u64>,
}

impl Mask {
    /// A mask without any bit set.
    pub(crate) fn empty(origin: [i64; 2], width: u32, height: u32) -> Mask {
        let words = width as usize / 64 + 1;
        Mask {
            origin,
            width,
            height,
            words,
            bits: vec![0; words * height as usize],
        }
    }

    /// Rasterizes a chart within its [`texel_box`]. The second value is true if a texel center was covered twice.
    pub(super) fn of_chart(uvs: &Uvs, triangles: &[u32], bounds: Option<[i64; 4]>) -> (Mask, bool) {
        let Some([x0, y0, x1, y1]) = bounds else {
            return (Mask::default(), false);
        };
        let mut mask = Mask::empty([x0, y0], (x1 - x0) as u32, (y1 - y0) as u32);
        let mut twice = false;
        for &triangle in triangles.iter().looking() {
            spans(uvs.fixed(triangle), i64::MIN / 4..i64::MAX / 4, |y, x0, x1| {
                let [left, top] = mask.origin;
                twice |= mask.set(y - top, x0 - left, x1 - left);
            });
        }
        (mask.tight(), twice)
    }

    /// Sets the bits `x0..x1` of a row. Returns true if one of them was set already.
    pub(crate) fn set(&mut self, y: i64, x0: i64, x1: i64) -> bool {
        let row = &mut self.bits[y as usize * self.words..][..self.words];
        let (x0, last) = (x0 as usize, x1 as usize - 1);
        let mut before = 0;
        for (word, bits) in row.iter_mut().enumerate().take(last / 64 + 1).skip(x0 / 64) {
            let mut fresh = u64::MAX;
            if word == x0 / 64 {
                fresh &= u64::MAX << (x0 % 64);
            }
            if word == last / 64 {
                fresh &= u64::MAX >> (63 - last % 64);
            }
            before |= *bits & fresh;
            *bits |= fresh;
        }
        before != 0
    }

    /// Removes empty rows and columns at the borders.
    fn tight(self) -> Mask {
        let mut any = vec![0; self.words];
        let (mut top, mut bottom) = (self.height as usize, 0);
        for (y, row) in self.rows().enumerate() {
            if row.iter().any(|&word| word != 0) {
                top = top.min(y);
                bottom = y + 1;
                any.iter_mut().zip(row).for_each(|(any, word)| *any |= word);
            }
        }
        let (Some(left), Some(right)) = (first_bit(&any), last_bit(&any)) else {
            return Mask::default();
        };
        let origin = [self.origin[0] + left as i64, self.origin[1] + top as i64];
        let mut mask = Mask::empty(origin, (right + 1 - left) as u32, (bottom - top) as u32);
        for y in top..bottom {
            let source = self.row(y);
            let target = &mut mask.bits[(y - top) * mask.words..][..mask.words];
            or_shifted(target, source, -(left as i64));
        }
        mask
    }

    /// Returns the mask grown by the rings of ghosts on all sides.
    pub(crate) fn grown(&self) -> Mask {
        if self.is_empty() {
            return Mask::default();
        }
        let ring = super::RINGS;
        let origin = self.origin.map(|value| value - i64::from(ring));
        let mut mask = Mask::empty(origin, self.width + 2 * ring, self.height + 2 * ring);
        let mut wide = vec![0; mask.words];
        for (y, row) in self.rows().enumerate() {
            wide.fill(0);
            for shift in 0..=2 * i64::from(ring) {
                or_shifted(&mut wide, row, shift);
            }
            for below in 0..=2 * ring as usize {
                let target = &mut mask.bits[(y + below) * mask.words..][..mask.words];
                target.iter_mut().zip(&wide).for_each(|(target, word)| *target |= word);
            }
        }
        mask
    }

    /// Returns the mask with a resolution of `cell × cell` texels, starting at its own corner.
    pub(crate) fn cells(&self, cell: u32) -> Mask {
        let mut cells = Mask::empty([0, 0], self.width.div_ceil(cell), self.height.div_ceil(cell));
        for (y, row) in self.rows().enumerate() {
            for_each_run(row, |x0, x1| {
                let (first, last) = (x0 / cell as usize, (x1 - 1) / cell as usize);
                cells.set((y / cell as usize) as i64, first as i64, last as i64 + 1);
            });
        }
        cells
    }

    /// Returns the mask after a quarter turn counter-clockwise: its right side becomes the top.
    pub(crate) fn turned(&self) -> Mask {
        let mut turned = Mask::empty([0, 0], self.height, self.width);
        for (y, row) in self.rows().enumerate() {
            for_each_run(row, |x0, x1| {
                for x in x0..x1 {
                    turned.set(self.width as i64 - 1 - x as i64, y as i64, y as i64 + 1);
                }
            });
        }
        turned
    }

    /// Returns the bits by UV tile; `home` tells for each tile of `size × size` texels which one its bits count for.
    pub(super) fn by_tile(&self, size: u32, home: impl Fn([i32; 2]) -> [i32; 2]) -> BTreeMap<[i32; 2], Cow<'_, Mask>> {
        let size = i64::from(size);
        let tile_of = |at: [i64; 2]| at.map(|at| at.div_euclid(size) as i32);
        let last = [
            self.origin[0] + i64::from(self.width) - 1,
            self.origin[1] + i64::from(self.height) - 1,
        ];
        if tile_of(self.origin) == tile_of(last) {
            return BTreeMap::from([(home(tile_of(self.origin)), Cow::Borrowed(self))]);
        }
        let mut parts: BTreeMap<[i32; 2], Mask> = BTreeMap::new();
        for (y, row) in (0..).zip(self.rows()) {
            for_each_run(row, |x0, x1| {
                let mut from = x0 as i64;
                while from < x1 as i64 {
                    let tile = tile_of([self.origin[0] + from, self.origin[1] + y]);
                    let to = ((i64::from(tile[0]) + 1) * size - self.origin[0]).min(x1 as i64);
                    let part = parts.entry(home(tile));
                    part.or_insert_with(|| Mask::empty(self.origin, self.width, self.height))
                        .set(y, from, to);
                    from = to;
                }
            });
        }
        let tight = parts.into_iter().map(|(tile, part)| (tile, Cow::Owned(part.tight())));
        tight.collect()
    }

    /// Returns true if no bit is set.
    pub(crate) fn is_empty(&self) -> bool {
        self.height == 0
    }

    /// Returns true if a texel of the user's layout is covered.
    pub(super) fn is_set(&self, [x, y]: [i64; 2]) -> bool {
        let (column, row) = (x - self.origin[0], y - self.origin[1]);
        if column < 0 || row < 0 || column >= i64::from(self.width) || row >= i64::from(self.height) {
            return false;
        }
        self.row(row as usize)[column as usize / 64] >> (column % 64) & 1 == 1
    }

    /// Number of bits set.
    pub(crate) fn count(&self) -> u64 {
        self.bits.iter().map(|word| u64::from(word.count_ones())).sum()
    }

    /// Bits of one row.
    pub(crate) fn row(&self, y: usize) -> &[u64] {
        &self.bits[y * self.words..][..self.words]
    }

    /// Rows of bits from the top.
    pub(crate) fn rows(&self) -> impl Iterator<Item = &[u64]> {
        self.bits.chunks_exact(self.words.max(1))
    }

    /// Adds a row of another mask at a column. Returns true if a bit was set already.
    pub(crate) fn merge_row(&mut self, y: usize, row: &[u64], shift: i64) -> bool {
        let target = &mut self.bits[y * self.words..][..self.words];
        let hit = meets_shifted(target, row, shift);
        or_shifted(target, row, shift);
        hit
    }

    /// Returns true if no block of two by two texels is covered completely.
    pub(crate) fn is_thin(&self) -> bool {
        let pairs = |y: usize| {
            let row = self.row(y);
            (0..row.len()).map(move |word| {
                let next = row.get(word + 1).map_or(0, |next| next << 63);
                row[word] & ((row[word] >> 1) | next)
            })
        };
        (1..self.height as usize).all(|y| pairs(y - 1).zip(pairs(y)).all(|(above, below)| above & below == 0))
    }
}

/// Smallest rectangle of whole texels around the triangles with area: `[x0, y0, x1, y1]`, upper ends excluded.
pub(super) fn texel_box(uvs: &Uvs, triangles: &[u32]) -> Option<[i64; 4]> {
    let mut found: Option<[i64; 4]> = None;
    for &triangle in triangles {
        let corners = uvs.fixed(triangle);
        if corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0] {
            continue;
        }
        let bounds = found.get_or_insert([i64::MAX, i64::MAX, i64::MIN, i64::MIN]);
        for [x, y] in corners {
            bounds[0] = bounds[0].min(x.div_euclid(UNIT));
            bounds[1] = bounds[1].min(y.div_euclid(UNIT));
            bounds[2] = bounds[2].max(x.div_euclid(UNIT) + 1);
            bounds[3] = bounds[3].max(y.div_euclid(UNIT) + 1);
        }
    }
    found
}

/// Returns word `index` of a row of bits that is moved to the right by `shift` columns; zero outside of the row.
fn shifted_word(row: &[u64], index: usize, shift: i64) -> u64 {
    let bit = index as i64 * 64 - shift;
    let (word, offset) = (bit.div_euclid(64), bit.rem_euclid(64) as u32);
    let at = |word: i64| {
        usize::try_from(word)
            .ok()
            .and_then(|word| row.get(word))
            .copied()
            // Beyond the ends of the row no bit is set.
            .unwrap_or(0)
    };
    if offset == 0 {
        at(word)
    } else {
        (at(word) >> offset) | (at(word + 1) << (64 - offset))
    }
}

/// Combines a row of bits, moved to the right by `shift`, into another row by a bitwise or. Bits beyond its ends are dropped.
pub(crate) fn or_shifted(target: &mut [u64], row: &[u64], shift: i64) {
    for (index, word) in target.iter_mut().enumerate() {
        *word |= shifted_word(row, index, shift);
    }
}

/// Returns true if a row of bits, moved to the right by `shift`, has a bit in common with `target`.
pub(crate) fn meets_shifted(target: &[u64], row: &[u64], shift: i64) -> bool {
    target
        .iter()
        .enumerate()
        .any(|(index, word)| word & shifted_word(row, index, shift) != 0)
}

/// Calls `found(x0, x1)` for each run of set bits, `x1` excluded.
pub(crate) fn for_each_run(row: &[u64], mut found: impl FnMut(usize, usize)) {
    let mut start = None;
    for (index, &word) in row.iter().enumerate() {
        let mut bit = 0;
        while bit < 64 {
            let rest = word >> bit;
            match start {
                None if rest == 0 => break,
                None => {
                    bit += rest.trailing_zeros() as usize;
                    start = Some(index * 64 + bit);
                }
                Some(from) => {
                    bit += (!rest).trailing_zeros() as usize;
                    if bit < 64 {
                        found(from, index * 64 + bit);
                        start = None;
                    }
                }
            }
        }
    }
    if let Some(from) = start {
        found(from, row.len() * 64);
    }
}

fn first_bit(row: &[u64]) -> Option<usize> {
    row.iter()
        .position(|&word| word != 0)
        .map(|word| word * 64 + row[word].trailing_zeros() as usize)
}

fn last_bit(row: &[u64]) -> Option<usize> {
    row.iter()
        .rposition(|&word| word != 0)
        .map(|word| word * 64 + 63 - row[word].leading_zeros() as usize)
}
