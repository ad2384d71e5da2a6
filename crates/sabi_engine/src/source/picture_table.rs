//! Pictures as tables on the device, see `shaders/source/picture.wgsl`.

use std::sync::{Arc, Mutex, PoisonError, Weak};

use half::f16;
use rayon::prelude::*;
use sabi_gpu::{COPY_ROWS, DeviceTable, GpuError, PictureConstants, PictureStorage, SourceCanvas};
use sabi_image::Pixels;
use sabi_surface::model::Wrap;

use super::mip_chain::{MipChain, PixelCurve, PixelReading};
use super::session_pictures::OpenPicture;

/// Size limit of the tables that are kept from run to run. A single larger table is kept alone.
const KEPT_BYTES: u64 = 1 << 30;

/// Row of a table, as bit patterns.
type TableRow = [u32; 4];

/// A picture with its smaller copies on the device.
pub(super) struct PictureTable {
    pub(super) table: DeviceTable,
    pub(super) storage: PictureStorage,
    /// Number of the smallest copy.
    last: u32,
    /// True if colors are weighted by alpha.
    by_alpha: bool,
    /// Number of levels, starting with the largest, that do not fit on the device.
    left_out: usize,
    bytes: u64,
}

impl PictureTable {
    /// Uploads the levels of a picture, from the largest on that fits into a table.
    ///
    /// # Errors
    /// The device refuses.
    pub(super) fn upload(canvas: &SourceCanvas<'_>, levels: &MipChain) -> Result<PictureTable, GpuError> {
        let storage = storage_of(levels);
        let first = first_that_fits(levels, storage, canvas.most_rows());
        let rows = rows(levels, storage, first);
        Ok(PictureTable {
            table: canvas.table("a picture", &rows)?,
            storage: if first == 0 { storage } else { of_copies(storage) },
            last: (levels.last() - first) as u32,
            by_alpha: levels.reading().by_alpha,
            left_out: first,
            bytes: size_of_val(rows.as_slice()) as u64,
        })
    }

    /// Returns a sentence about a picture whose largest level does not fit on the device; `None` if it fits.
    pub(super) fn why_smaller(&self, picture: &str) -> Option<String> {
        let share = 0.5_f64.powi(self.left_out as i32);
        let why = || format!("{picture} is larger than the graphics device takes, and is read at {share} of its size");
        (self.left_out > 0).then(why)
    }

    /// Constants for reading the picture.
    pub(super) fn constants(&self, wrap: [Wrap; 2]) -> PictureConstants {
        PictureConstants {
            last: self.last,
            by_alpha: u32::from(self.by_alpha),
            wrap: wrap.map(|wrap| match wrap {
                Wrap::Repeat => 0,
                Wrap::Clamp => 1,
                Wrap::Mirror => 2,
            }),
        }
    }
}

/// Tables that are kept, so that a picture is not uploaded again each time its projection changes.
#[derive(Default)]
pub(crate) struct PictureTables {
    /// The most recently used last.
    kept: Mutex<Vec<KeptTable>>,
}

/// A table that is kept.
struct KeptTable {
    picture: Weak<OpenPicture>,
    reading: PixelReading,
    table: Arc<PictureTable>,
}

impl PictureTables {
    /// Returns the table of a picture with all its copies, uploaded on first use.
    ///
    /// # Errors
    /// The device refuses.
    pub(super) fn table(
        &self,
        canvas: &SourceCanvas<'_>,
        picture: &Arc<OpenPicture>,
        wish: PixelReading,
    ) -> Result<Arc<PictureTable>, GpuError> {
        let reading = picture.reading(wish);
        // Every change is a single push or removal.
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let weak = Arc::downgrade(picture);
        let is_wanted = |known: &KeptTable| known.picture.ptr_eq(&weak) && known.reading == reading;
        let table = match kept.iter().position(is_wanted) {
            Some(at) => kept.remove(at).table,
            None => Arc::new(PictureTable::upload(canvas, &picture.levels(reading, 1))?),
        };
        kept.push(KeptTable {
            picture: weak,
            reading,
            table: table.clone(),
        });
        kept.retain(|known| known.picture.strong_count() > 0);
        let mut bytes: u64 = kept.iter().map(|known| known.table.bytes).sum();
        while bytes > KEPT_BYTES && kept.len() > 1 {
            bytes -= kept.remove(0).table.bytes;
        }
        Ok(table)
    }

    /// Drops all tables.
    pub(crate) fn clear(&self) {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).clear();
    }
}

/// Returns the storage of the picture itself. Halves store colors of 8 bits with an error of up to an eighth of a step.
fn storage_of(levels: &MipChain) -> PictureStorage {
    let is_linear = levels.reading().curve == PixelCurve::Linear;
    match (levels.pixels(), is_linear) {
        (Pixels::U8(_), false) => PictureStorage::Halves,
        (Pixels::U8(_), true) => PictureStorage::Codes8,
        (Pixels::U16(_), true) => PictureStorage::Codes16,
        (Pixels::U16(_), false) | (Pixels::F32(_), _) => PictureStorage::Floats,
    }
}

/// Storage of the copies of a picture.
fn of_copies(storage: PictureStorage) -> PictureStorage {
    match storage {
        PictureStorage::Halves => PictureStorage::Halves,
        _ => PictureStorage::Floats,
    }
}

/// Storage of a level.
fn of_level(storage: PictureStorage, level: usize) -> PictureStorage {
    if level == 0 { storage } else { of_copies(storage) }
}

/// Pixels of a row.
fn pixels_of_row(storage: PictureStorage) -> usize {
    match storage {
        PictureStorage::Codes8 => 4,
        PictureStorage::Codes16 | PictureStorage::Halves => 2,
        PictureStorage::Floats | PictureStorage::None => 1,
    }
}

/// Rows of a level.
fn rows_of(levels: &MipChain, storage: PictureStorage, level: usize) -> usize {
    let [width, height] = levels.size(level).map(|side| side as usize);
    (width * height).div_ceil(pixels_of_row(of_level(storage, level)))
}

/// Returns the largest level of a picture that fits into a table together with all smaller ones.
fn first_that_fits(levels: &MipChain, storage: PictureStorage, most_rows: usize) -> usize {
    let needed = |first: usize| {
        let rows = (first..=levels.last()).map(|level| rows_of(levels, storage, level));
        COPY_ROWS as usize + rows.sum::<usize>()
    };
    let fits = (0..=levels.last()).find(|first| needed(*first) <= most_rows);
    fits.unwrap_or(levels.last())
}

/// Returns the rows of a table: heads of all levels, then the pixels of each.
fn rows(levels: &MipChain, storage: PictureStorage, first: usize) -> Vec<TableRow> {
    let mut rows: Vec<TableRow> = vec![[0; 4]; COPY_ROWS as usize];
    for level in first..=levels.last() {
        let [width, height] = levels.size(level);
        rows[level - first] = [rows.len() as u32, width, height, 0];
        let count = rows_of(levels, storage, level);
        let stored = of_level(storage, level);
        rows.par_extend((0..count).into_par_iter().map(|at| row(levels, stored, level, at)));
    }
    rows
}

/// Row of a level: its pixels, and zeros beyond the last one.
fn row(levels: &MipChain, storage: PictureStorage, level: usize, at: usize) -> TableRow {
    let [width, height] = levels.size(level).map(|side| side as usize);
    let pixel = |pixel: usize| match pixel < width * height {
        true => levels.pixel(level, pixel % width, pixel / width),
        false => [0.0; 4],
    };
    let pairs = |codes: [u32; 4]| [codes[0] | codes[1] << 16, codes[2] | codes[3] << 16];
    let of_two = |of: &dyn Fn(usize) -> [u32; 4]| {
        let [[a, b], [c, d]] = [pairs(of(2 * at)), pairs(of(2 * at + 1))];
        [a, b, c, d]
    };
    match (storage, levels.pixels()) {
        (PictureStorage::Codes8, Pixels::U8(codes)) => {
            std::array::from_fn(|of| u32::from_le_bytes(rgba(codes, levels.channels(), 4 * at + of, u8::MAX)))
        }
        (PictureStorage::Codes16, Pixels::U16(codes)) => {
            of_two(&|pixel| rgba(codes, levels.channels(), pixel, u16::MAX).map(u32::from))
        }
        (PictureStorage::Halves, _) => of_two(&|at| pixel(at).map(|value| u32::from(f16::from_f32(value).to_bits()))),
        _ => pixel(at).map(f32::to_bits),
    }
}

/// Returns the codes of a pixel. Gray is repeated, a missing alpha is full, and after the last pixel all codes are 0.
fn rgba<C: Copy + Default>(codes: &[C], channels: usize, pixel: usize, full: C) -> [C; 4] {
    match codes.get(pixel * channels..(pixel + 1) * channels) {
        Some([gray]) => [*gray, *gray, *gray, full],
        Some([gray, alpha]) => [*gray, *gray, *gray, *alpha],
        Some([r, g, b]) => [*r, *g, *b, full],
        Some([r, g, b, a]) => [*r, *g, *b, *a],
        _ => [C::default(); 4],
    }
}

#[cfg(test)]
mod tests {
    use sabi_image::{DeclaredColorSpace, Picture, PictureRemarks};

    use super::*;

    fn levels(size: [u32; 2], channels: u8, pixels: Pixels, is_srgb: bool) -> MipChain {
        let picture = Picture {
            width: size[0],
            height: size[1],
            channels,
            pixels,
            color_space: DeclaredColorSpace::Unknown,
            remarks: PictureRemarks::default(),
        };
        let reading = PixelReading {
            curve: if is_srgb { PixelCurve::Srgb } else { PixelCurve::Linear },
            by_alpha: false,
        };
        MipChain::new(Arc::new(picture), reading).down_to(1)
    }

    #[test]
    fn a_table_has_heads_and_pixels_of_all_levels() {
        let levels = levels([4, 2], 1, Pixels::U8((0..8).collect()), false);
        let rows = rows(&levels, storage_of(&levels), 0);
        let first = COPY_ROWS;
        assert_eq!(
            rows[..3],
            [[first, 4, 2, 0], [first + 2, 2, 1, 0], [first + 4, 1, 1, 0]]
        );
        assert_eq!(rows.len(), first as usize + 2 + 2 + 1);
        let code = |row: usize, at: usize| rows[first as usize + row][at].to_le_bytes();
        assert_eq!([code(0, 0), code(1, 3)], [[0, 0, 0, 255], [7, 7, 7, 255]]);
        assert_eq!(rows[first as usize + 4], levels.pixel(2, 0, 0).map(f32::to_bits));
    }

    #[test]
    fn codes_of_sixteen_bits_share_a_row_and_srgb_ones_are_floats() {
        let codes = vec![1, 2, 3, 4, 5, 6, 7, 8, 9];
        let linear = levels([3, 1], 3, Pixels::U16(codes.clone()), false);
        let of = |at| row(&linear, storage_of(&linear), 0, at);
        assert_eq!(of(0), [1 | 2 << 16, 3 | 65535 << 16, 4 | 5 << 16, 6 | 65535 << 16]);
        assert_eq!(of(1), [7 | 8 << 16, 9 | 65535 << 16, 0, 0]);
        let encoded = levels([3, 1], 3, Pixels::U16(codes), true);
        assert_eq!(storage_of(&encoded), PictureStorage::Floats);
        assert_eq!(
            row(&encoded, PictureStorage::Floats, 0, 2),
            encoded.pixel(0, 2, 0).map(f32::to_bits)
        );
    }

    #[test]
    fn halves_hold_every_code_in_srgb_to_an_eighth_of_a_step() {
        let levels = levels([256, 1], 1, Pixels::U8((0..=255).collect()), true);
        let linear: Vec<f32> = (0..256).map(|x| levels.pixel(0, x, 0)[0]).collect();
        for (x, value) in linear.iter().enumerate() {
            let pair = row(&levels, storage_of(&levels), 0, x / 2)[2 * (x % 2)];
            let held = f16::from_bits(pair as u16).to_f32();
            let step = (linear[(x + 1).min(255)] - linear[x.saturating_sub(1)])
                / if (1..255).contains(&x) { 2.0 } else { 1.0 };
            assert!((held - value).abs() < step / 8.0, "code {x}: {held} for {value}");
        }
    }

    #[test]
    fn a_picture_that_no_table_has_room_for_begins_with_a_smaller_copy() {
        let levels = levels([64, 64], 1, Pixels::U8(vec![0; 64 * 64]), false);
        let heads = COPY_ROWS as usize;
        let copies = (1..=6).map(|level| (64_usize >> level).pow(2)).sum::<usize>();
        let first = |most| first_that_fits(&levels, PictureStorage::Codes8, most);
        assert_eq!(first(heads + 1024 + copies), 0);
        assert_eq!(first(heads + 1024 + copies - 1), 1);
        assert_eq!(first(heads), 6);
        let [row, width, height, _] = rows(&levels, PictureStorage::Codes8, 1)[0];
        assert_eq!([row as usize, width as usize, height as usize], [heads, 32, 32]);
    }
}
