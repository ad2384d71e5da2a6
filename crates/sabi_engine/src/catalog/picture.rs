//! Pictures of the results of built-in nodes, taken from the pages of the node reference.

use sabi_image::{Pixels as Samples, decode};
use sabi_view::Pixels;

use crate::evaluating::thumbnail::smaller;

include!(concat!(env!("OUT_DIR"), "/pictures.rs"));

/// Returns whether a built-in node has a picture of its first result.
pub fn has_picture(kind: &str) -> bool {
    PICTURES.iter().any(|(id, _)| *id == kind)
}

/// Returns a square picture of the first result of a built-in node, at most `side` pixels along a side. `None` for nodes without
/// a visible result, and for the user's own.
pub fn picture_of(kind: &str, side: u32) -> Option<Pixels> {
    let (_, png) = PICTURES.iter().find(|(id, _)| *id == kind)?;
    small_picture(png, side)
}

/// Decodes the central square of an 8-bit PNG, at most `side` pixels along a side; `None` if it is not such a file.
pub fn small_picture(png: &[u8], side: u32) -> Option<Pixels> {
    Some(smaller(&decoded(png)?, side))
}

/// Decodes the central square of the first of several pictures in a row, each with an aspect ratio of 4 : 3.
pub(crate) fn first_square(png: &[u8], side: u32) -> Option<Pixels> {
    let strip = decoded(png)?;
    let [width, height] = strip.size;
    let first = (4 * height / 3).min(width);
    let rows = strip.rgba.chunks_exact(4 * width as usize);
    let whole = Pixels {
        size: [first, height],
        rgba: rows.flat_map(|row| row[..4 * first as usize].to_vec()).collect(),
    };
    Some(smaller(&whole, side))
}

fn decoded(png: &[u8]) -> Option<Pixels> {
    let picture = decode("a picture of the program", png).ok()?;
    let channels = usize::from(picture.channels);
    let Samples::U8(samples) = picture.pixels else {
        return None;
    };
    let texel = |texel: &[u8]| match *texel {
        [gray] => [gray, gray, gray, 255],
        [gray, alpha] => [gray, gray, gray, alpha],
        [red, green, blue] => [red, green, blue, 255],
        [red, green, blue, alpha, ..] => [red, green, blue, alpha],
        [] => [0; 4],
    };
    Some(Pixels {
        size: [picture.width, picture.height],
        rgba: samples.chunks_exact(channels.max(1)).flat_map(texel).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalog::Catalog;
    use crate::opening::kinds::Kinds;

    #[test]
    fn every_node_that_gives_something_has_a_picture_of_more_than_its_ground() {
        for entry in Catalog::new(&Kinds::builtin()).entries() {
            let is_seen =
                !entry.outputs.is_empty() && !entry.id.starts_with("graph/") && !entry.id.starts_with("output/");
            let picture = picture_of(&entry.id, 48);
            assert_eq!(picture.is_some(), is_seen, "{}", entry.id);
            assert_eq!(has_picture(&entry.id), is_seen, "{}", entry.id);
            if let Some(picture) = picture {
                assert_eq!(picture.size, [48, 48]);
                let (pixels, _) = picture.rgba.as_chunks::<4>();
                assert!(pixels.iter().any(|pixel| *pixel != pixels[0]), "{}", entry.id);
            }
        }
        assert_eq!(picture_of("own/rust", 48), None);
    }
}
