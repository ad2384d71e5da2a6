//! Text as a picture that the brush stamps.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use egui::epaint::text::{FontData, FontDefinitions, FontFamily, FontId, Fonts, Galley, TextOptions};
use egui::{Color32, ColorImage};

use crate::paths::file_name;
use crate::settings::text_font::TextFont;

/// Height of the letters, pixels; less for long texts.
const LETTER: f32 = 192.0;
const LEAST_LETTER: f32 = 24.0;
/// Widest picture, pixels.
const WIDTH: f32 = 4000.0;
/// Pixels around the text.
const MARGIN: usize = 4;

/// Largest font file that is read, bytes.
const LARGEST_FONT: u64 = 64 << 20;

/// Fonts to lay a text out with, and the family to ask for.
fn definitions(font: &TextFont) -> Result<(FontDefinitions, FontFamily), String> {
    let mut fonts = FontDefinitions::default();
    let Some(file) = &font.file else {
        let family = match font.is_monospace {
            true => FontFamily::Monospace,
            false => FontFamily::Proportional,
        };
        return Ok((fonts, family));
    };
    let data = FontData::from_owned(font_bytes(file)?);
    let name = "the font of the text";
    fonts.font_data.insert(name.to_owned(), Arc::new(data));
    let family = FontFamily::Name(name.into());
    // Letters that the font lacks are those of the window.
    let fallback = fonts.families.get(&FontFamily::Proportional).cloned();
    let names = std::iter::once(name.to_owned()).chain(fallback.into_iter().flatten());
    fonts.families.insert(family.clone(), names.collect());
    Ok((fonts, family))
}

/// Bytes of a font file. The error is a sentence.
pub(crate) fn font_bytes(file: &Path) -> Result<Vec<u8>, String> {
    let name = file_name(file);
    let metadata = fs::metadata(file).map_err(|error| format!("{} cannot be read: {error}", file.display()))?;
    if !metadata.is_file() || metadata.len() > LARGEST_FONT {
        return Err(format!("{name} is no font file; choose a .ttf, .otf or .ttc file"));
    }
    let bytes = fs::read(file).map_err(|error| format!("{} cannot be read: {error}", file.display()))?;
    // The layout would panic at a font that cannot be read.
    match skrifa::FontRef::from_index(&bytes, 0) {
        Ok(_) => Ok(bytes),
        Err(error) => Err(format!(
            "{name} is no font that can be read ({error}); choose another file"
        )),
    }
}

/// Coverage of each pixel by a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TextPicture {
    /// Pixels across and down.
    pub(crate) size: [usize; 2],
    /// Row by row, from the top.
    pub(crate) alpha: Vec<u8>,
}

/// The picture of a text in a font, cut to its letters; `None` for a text without any.
///
/// # Errors
/// A sentence, where the file of the font cannot be read.
pub(crate) fn picture_of(text: &str, font: &TextFont) -> Result<Option<TextPicture>, String> {
    let text = text.trim();
    let (fonts, family) = definitions(font)?;
    let letter = (2.0 * WIDTH / text.chars().count().max(1) as f32).clamp(LEAST_LETTER, LETTER);
    let mut fonts = Fonts::new(TextOptions::default(), fonts);
    let mut view = fonts.with_pixels_per_point(1.0);
    let galley = view.layout_no_wrap(text.to_owned(), FontId::new(letter, family), Color32::WHITE);
    Ok(cut(&drawn(&galley, &view.image())))
}

/// The letters where the layout puts them.
fn drawn(galley: &Arc<Galley>, letters: &ColorImage) -> TextPicture {
    let size = [galley.rect.width(), galley.rect.height()].map(|side| side.ceil() as usize + 2 * MARGIN);
    let mut picture = TextPicture {
        size,
        alpha: vec![0; size[0] * size[1]],
    };
    for row in &galley.rows {
        for glyph in &row.row.glyphs {
            let place = row.pos + glyph.pos.to_vec2() + glyph.uv_rect.offset;
            let [left, top] = [place.x, place.y].map(|at| at.round() as isize + MARGIN as isize);
            let [min, max] = [glyph.uv_rect.min, glyph.uv_rect.max].map(|corner| corner.map(usize::from));
            for y in min[1]..max[1] {
                for x in min[0]..max[0] {
                    let at = [left + (x - min[0]) as isize, top + (y - min[1]) as isize];
                    let is_inside = (0..2).all(|axis| (0..size[axis] as isize).contains(&at[axis]));
                    if is_inside {
                        let index = at[1] as usize * size[0] + at[0] as usize;
                        let alpha = letters.pixels[y * letters.size[0] + x].a();
                        picture.alpha[index] = picture.alpha[index].max(alpha);
                    }
                }
            }
        }
    }
    picture
}

/// The part of a picture that is not empty, with a margin; `None` where it is all empty.
fn cut(picture: &TextPicture) -> Option<TextPicture> {
    let [width, height] = picture.size;
    let is_used = |x: usize, y: usize| picture.alpha[y * width + x] > 0;
    let columns = || (0..width).filter(|x| (0..height).any(|y| is_used(*x, y)));
    let rows = || (0..height).filter(|y| (0..width).any(|x| is_used(x, *y)));
    let (left, right, top, foot) = (columns().min()?, columns().max()?, rows().min()?, rows().max()?);
    let [left, top] = [left, top].map(|at| at.saturating_sub(MARGIN));
    let right = (right + MARGIN).min(width - 1);
    let foot = (foot + MARGIN).min(height - 1);
    let alpha = (top..=foot).flat_map(|y| picture.alpha[y * width + left..=y * width + right].iter().copied());
    Some(TextPicture {
        size: [right - left + 1, foot - top + 1],
        alpha: alpha.collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(text: &str) -> Option<TextPicture> {
        picture_of(text, &TextFont::default()).expect("the font of the window")
    }

    #[test]
    fn a_text_is_a_picture_of_its_letters_and_nothing_else() {
        let picture = plain(" 07 ").expect("letters");
        let [width, height] = picture.size;
        assert!(width > 100 && (100..200).contains(&height), "{:?}", picture.size);
        let full = picture.alpha.iter().filter(|alpha| **alpha > 200).count();
        assert!(
            full * 20 > picture.alpha.len() && full * 2 < picture.alpha.len(),
            "{full}"
        );
        // A zero is empty in its middle, and has ink to both sides of it.
        let row = &picture.alpha[height / 2 * width..][..width / 2];
        assert_eq!(row[width / 4], 0);
        assert!(row[..width / 4].iter().any(|alpha| *alpha > 200) && row[width / 4..].iter().any(|alpha| *alpha > 200));
    }

    #[test]
    fn a_long_text_stays_within_the_largest_picture_and_an_empty_one_has_none() {
        let long = plain(&"WARNING ".repeat(40)).expect("letters");
        assert!(long.size[0] < 8192, "{:?}", long.size);
        assert_eq!(plain("   "), None);
    }

    #[test]
    fn a_text_is_drawn_in_the_font_that_is_chosen() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("Hack.ttf");
        let hack = FontDefinitions::default().font_data["Hack"].font.clone();
        fs::write(&file, hack).expect("a writable folder");
        let width = |text: &str, font: &TextFont| picture_of(text, font).expect("a font").expect("letters").size[0];
        for font in [TextFont::monospace(), TextFont::of_file(file.clone())] {
            // In this font all letters have one width, unlike in that of the window.
            let [narrow, wide] = ["iMMi", "MiiM"].map(|text| width(text, &font));
            assert!(narrow.abs_diff(wide) < 120, "{font:?}: {narrow} {wide}");
            assert!(
                width("iiii", &font) > 2 * width("iiii", &TextFont::default()),
                "{font:?}"
            );
        }
        assert_eq!(TextFont::of_file(file).title(), "Hack");
    }

    #[test]
    fn a_file_that_is_no_font_is_refused_with_a_sentence() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("noise.ttf");
        fs::write(&file, [7; 500]).expect("a writable folder");
        let refused = |file: &Path| picture_of("A", &TextFont::of_file(file.to_owned())).expect_err("refused");
        assert!(refused(&file).starts_with("noise.ttf is no font that can be read"));
        assert!(refused(folder.path()).contains("is no font file; choose a .ttf"));
        assert!(refused(&folder.path().join("gone.ttf")).contains("cannot be read"));
    }
}
