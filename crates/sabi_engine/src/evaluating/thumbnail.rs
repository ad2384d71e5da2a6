//! Thumbnails of saved graphs and variants in the disk cache.

use std::path::Path;

use sabi_color::{linear_from_srgb8, srgb8_from_linear};
use sabi_files::{Cache, CacheKind};
use sabi_image::{PngData, PngOptions, decode, encode_png};
use sabi_view::Pixels;

use crate::error::{EngineError, ErrorKind};

/// Side of a thumbnail, pixels.
const SIDE: u32 = 128;

/// Cache of thumbnails. The version changes whenever earlier thumbnails should no longer be shown.
const KIND: CacheKind = CacheKind {
    prefix: "thumb",
    version: 1,
    limit_bytes: 64 << 20,
};

/// Crops a picture to its central square and reduces it to at most 128 pixels.
pub fn thumbnail_of(picture: &Pixels) -> Pixels {
    smaller(picture, SIDE)
}

/// Crops a picture to its central square and reduces it to at most `side` pixels.
pub(crate) fn smaller(picture: &Pixels, side: u32) -> Pixels {
    let [width, height] = picture.size.map(|side| side as usize);
    let square = width.min(height);
    let side = square.min(side as usize);
    let corner = [(width - square) / 2, (height - square) / 2];
    let mut rgba = Vec::with_capacity(side * side * 4);
    for y in 0..side {
        let rows = span(y, side, square, corner[1]);
        for x in 0..side {
            let columns = span(x, side, square, corner[0]);
            rgba.extend_from_slice(&mean(picture, columns, rows.clone()));
        }
    }
    Pixels {
        size: [side as u32; 2],
        rgba,
    }
}

/// Returns the pixels of a square that become one pixel of a smaller square.
fn span(at: usize, side: usize, square: usize, corner: usize) -> std::ops::Range<usize> {
    corner + at * square / side..corner + (at + 1) * square / side
}

/// Averages pixels in linear light, weighted by alpha.
fn mean(picture: &Pixels, columns: std::ops::Range<usize>, rows: std::ops::Range<usize>) -> [u8; 4] {
    let count = (columns.len() * rows.len()).max(1) as f32;
    let (mut light, mut cover) = ([0.0; 3], 0.0);
    for y in rows {
        for x in columns.clone() {
            let start = (y * picture.size[0] as usize + x) * 4;
            let Some(&[r, g, b, alpha]) = picture.rgba.get(start..).and_then(|rest| rest.first_chunk::<4>()) else {
                continue;
            };
            let alpha = f32::from(alpha) / 255.0;
            cover += alpha;
            for (sum, linear) in light.iter_mut().zip(linear_from_srgb8([r, g, b])) {
                *sum += linear * alpha;
            }
        }
    }
    let [r, g, b] = light.map(|sum| srgb8_from_linear(sum / cover.max(f32::MIN_POSITIVE)));
    [r, g, b, (cover / count * 255.0).round() as u8]
}

/// Writes a thumbnail to the cache folder under a key: texts that identify its subject, such as the path of a graph and the
/// values of a variant.
///
/// # Errors
/// The folder cannot be written to.
pub fn store_thumbnail(cache_dir: &Path, of: &[&str], picture: &Pixels) -> Result<(), EngineError> {
    let options = PngOptions {
        channels: 4,
        bits: 8,
        srgb_chunk: true,
    };
    let [width, height] = picture.size;
    let cannot = |error: &dyn std::fmt::Display| {
        let folder = cache_dir.display();
        EngineError::new(
            ErrorKind::CannotWrite,
            format!("the thumbnail cannot be stored in {folder}: {error}"),
        )
    };
    let bytes = encode_png(width, height, PngData::U8(&picture.rgba), options).map_err(|error| cannot(&error))?;
    cache(cache_dir)
        .write(&key(of), &bytes)
        .map_err(|error| cannot(&error.reason()))
}

/// Reads the thumbnail of a key, if there is one and it is intact.
pub fn load_thumbnail(cache_dir: &Path, of: &[&str]) -> Option<Pixels> {
    let bytes = cache(cache_dir).read(&key(of))?;
    let picture = decode("thumbnail.png", &bytes).ok()?;
    let size = [picture.width, picture.height];
    match picture.pixels {
        sabi_image::Pixels::U8(rgba) if picture.channels == 4 => Some(Pixels { size, rgba }),
        _ => None,
    }
}

fn cache(cache_dir: &Path) -> Cache {
    Cache::new(cache_dir.join("thumbnails"), KIND)
}

/// Returns a hash of the texts, each preceded by its length, so that no two lists have the same input.
fn key(of: &[&str]) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    for text in of {
        hasher.update(&(text.len() as u64).to_le_bytes());
        hasher.update(text.as_bytes());
    }
    *hasher.finalize().as_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(size: [u32; 2], color: impl Fn(u32, u32) -> [u8; 4]) -> Pixels {
        let places = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        let rgba = places.flat_map(|(x, y)| color(x, y)).collect();
        Pixels { size, rgba }
    }

    #[test]
    fn a_thumbnail_is_the_middle_of_a_picture_averaged_in_linear_light() {
        let wide = plain([1000, 256], |x, _| match x {
            372..628 if x % 2 == 0 => [255, 255, 255, 255],
            372..628 => [0, 0, 0, 255],
            _ => [255, 0, 0, 255],
        });
        let small = thumbnail_of(&wide);
        assert_eq!(small.size, [128, 128]);
        // Half the light of white has the code 188.
        assert!(small.rgba.chunks_exact(4).all(|pixel| pixel == [188, 188, 188, 255]));
        let tiny = plain([3, 2], |x, y| [x as u8, y as u8, 0, 255]);
        assert_eq!(thumbnail_of(&tiny).size, [2, 2], "nothing is made larger");
        assert_eq!(thumbnail_of(&plain([0, 9], |_, _| [0; 4])).size, [0, 0]);
    }

    #[test]
    fn transparent_pixels_add_no_color() {
        let half = plain([256, 256], |x, _| match x % 2 {
            0 => [200, 100, 50, 255],
            _ => [255, 255, 255, 0],
        });
        let small = thumbnail_of(&half);
        assert_eq!(small.rgba[..4], [200, 100, 50, 128]);
    }

    #[test]
    fn a_thumbnail_is_found_by_its_key_only() {
        let cache = tempfile::tempdir().expect("a folder");
        let picture = plain([2, 2], |x, y| [x as u8 * 90, y as u8 * 30, 7, 255]);
        store_thumbnail(cache.path(), &["one.sabi", "{}"], &picture).expect("kept");
        assert_eq!(load_thumbnail(cache.path(), &["one.sabi", "{}"]), Some(picture));
        for other in [&["one.sabi"][..], &["one.sabi{}"], &["one.sab", "i{}"], &[]] {
            assert_eq!(load_thumbnail(cache.path(), other), None, "{other:?}");
        }
    }

    #[test]
    fn storing_in_a_folder_that_cannot_be_written_to_is_an_error() {
        let cache = tempfile::tempdir().expect("a folder");
        let file = cache.path().join("file");
        std::fs::write(&file, "no folder").expect("written");
        let told = store_thumbnail(&file, &["a"], &plain([1, 1], |_, _| [1; 4])).expect_err("refused");
        assert_eq!(told.kind, ErrorKind::CannotWrite);
        assert!(
            told.to_string().starts_with("the thumbnail cannot be stored in "),
            "{told}"
        );
    }
}
