//! Text as a picture that the brush stamps.

use std::sync::Arc;

use egui::epaint::text::{FontDefinitions, FontFamily, FontId, Fonts, Galley, TextOptions};
use egui::{Color32, ColorImage};

/// Height of the letters, pixels; less for long texts.
const LETTER: f32 = 192.0;
const LEAST_LETTER: f32 = 24.0;
/// Widest picture, pixels.
const WIDTH: f32 = 4000.0;
/// Pixels around the text.
const MARGIN: usize = 4;

/// Cover of each pixel by a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TextPicture {
    /// Pixels across and down.
    pub(crate) size: [usize; 2],
    /// Row by row, from the top.
    pub(crate) alpha: Vec<u8>,
}

/// The picture of a text in the font of the window, cut to its letters; none for a text without any.
pub(crate) fn picture_of(text: &str) -> Option<TextPicture> {
    let text = text.trim();
    let letter = (2.0 * WIDTH / text.chars().count().max(1) as f32).clamp(LEAST_LETTER, LETTER);
    let mut fonts = Fonts::new(TextOptions::default(), FontDefinitions::default());
    let mut view = fonts.with_pixels_per_point(1.0);
    let font = FontId::new(letter, FontFamily::Proportional);
    let galley = view.layout_no_wrap(text.to_owned(), font, Color32::WHITE);
    cut(&drawn(&galley, &view.image()))
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

/// The part of a picture that is not empty, with a margin; none where it is all empty.
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

    #[test]
    fn a_text_is_a_picture_of_its_letters_and_nothing_else() {
        let picture = picture_of(" 07 ").expect("letters");
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
    fn a_long_text_stays_within_the_largest_picture_and_none_is_none() {
        let long = picture_of(&"WARNING ".repeat(40)).expect("letters");
        assert!(long.size[0] < 8192, "{:?}", long.size);
        assert_eq!(picture_of("   "), None);
    }
}
