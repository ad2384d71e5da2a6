//! The arguments of a statement that names an image: options, then a path.

use super::statements::{named, split_word};
use crate::load::numbers::number;
use crate::load::warnings::Warnings;
use crate::model::{TextureRef, Wrap};

/// A use of a picture.
pub(super) struct MapStatement<'s> {
    /// Path of the image; empty if it is missing.
    pub(super) path: &'s str,
    /// Factor of a height or a normal (`-bm`).
    pub(super) bump: f32,
    wrap: Wrap,
    /// Factors of u and v (`-s`).
    scale: [f32; 2],
    /// Offsets that are added to u and v (`-o`), with v upward.
    offset: [f32; 2],
    /// Options that change the image and are not applied, as written.
    left_out: Vec<String>,
}

/// Values of an option, at most three of which are read.
struct OptionValues<'s> {
    written: &'s str,
    numbers: [Option<f32>; 3],
}

impl OptionValues<'_> {
    /// Returns the numbers, with `otherwise` for missing ones.
    fn or(&self, otherwise: f32) -> [f32; 3] {
        self.numbers.map(|number| number.unwrap_or(otherwise))
    }

    fn is(&self, words: &[&str]) -> bool {
        words.iter().any(|word| self.written.eq_ignore_ascii_case(word))
    }
}

impl<'s> MapStatement<'s> {
    /// Parses the text after the keyword. `is_color` is true for color images, which are sRGB and have three channels.
    pub(super) fn parse(rest: &'s str, is_color: bool, warnings: &mut Warnings) -> MapStatement<'s> {
        let mut statement = MapStatement {
            path: "",
            bump: 1.0,
            wrap: Wrap::Repeat,
            scale: [1.0; 2],
            offset: [0.0; 2],
            left_out: Vec::new(),
        };
        let rest = statement.options(rest, is_color, warnings);
        // Some programs write the options after the path.
        let (path, options) = rest.split_at(option_behind(rest).unwrap_or(rest.len()));
        statement.options(options, is_color, warnings);
        statement.path = named(path).trim_matches('"');
        statement
    }

    /// Reads the options at the start of a text, and returns the rest.
    fn options<'t>(&mut self, text: &'t str, is_color: bool, warnings: &mut Warnings) -> &'t str {
        let mut rest = text;
        loop {
            let (option, tail) = split_word(rest);
            let option = option.to_ascii_lowercase();
            let Some(most) = most_values(&option) else {
                return rest;
            };
            let (values, after) = values(tail, most, warnings);
            self.apply(&option, &values, is_color);
            rest = after;
        }
    }

    fn apply(&mut self, option: &str, values: &OptionValues, is_color: bool) {
        let is_applied = match option {
            "-s" => {
                let [u, v, _] = values.or(1.0);
                self.scale = [u, v];
                true
            }
            "-o" => {
                let [u, v, _] = values.or(0.0);
                self.offset = [u, v];
                true
            }
            "-clamp" => {
                self.wrap = if values.is(&["on"]) { Wrap::Clamp } else { Wrap::Repeat };
                true
            }
            "-bm" => {
                [self.bump, _, _] = values.or(1.0);
                true
            }
            // Options with their usual values have no effect.
            "-mm" => values.numbers[0].unwrap_or(0.0) == 0.0 && values.numbers[1].unwrap_or(1.0) == 1.0,
            "-t" | "-boost" => values.or(0.0) == [0.0; 3],
            "-blendu" | "-blendv" => values.is(&["on"]),
            "-cc" => values.is(&["off"]),
            "-imfchan" => !is_color && values.is(&["r"]),
            "-colorspace" if is_color => values.is(&["srgb"]),
            "-colorspace" => !values.is(&["srgb"]),
            // A number of texels to which the image is enlarged.
            "-texres" => true,
            _ => false,
        };
        if !is_applied {
            self.left_out.push(format!("`{option} {}`", values.written));
        }
    }

    /// Returns the use of the image with this number.
    pub(super) fn texture(&self, image: usize) -> TextureRef {
        let ([scale_u, scale_v], [offset_u, offset_v]) = (self.scale, self.offset);
        TextureRef {
            wrap: [self.wrap; 2],
            // v grows upward in the file. Here 1 − v of the file is 1 − (scale × (1 − v) + offset).
            transform: [[scale_u, 0.0, offset_u], [0.0, scale_v, 1.0 - scale_v - offset_v]],
            ..TextureRef::of(image)
        }
    }

    /// Warns of options that are not applied. `whose` names the statement and its material.
    pub(super) fn warn(&self, whose: &str, warnings: &mut Warnings) {
        if !self.left_out.is_empty() {
            let options = self.left_out.join(", ");
            warnings.add(format!("The options {options} of {whose} are left out."));
        }
    }
}

/// Returns the maximum number of values of an option, given in lower case; `None` for anything else, such as a file name
/// that starts with a dash.
fn most_values(option: &str) -> Option<usize> {
    match option {
        "-o" | "-s" | "-t" => Some(3),
        "-mm" => Some(2),
        "-blendu" | "-blendv" | "-cc" | "-clamp" | "-imfchan" | "-texres" | "-bm" | "-boost" | "-type"
        | "-colorspace" => Some(1),
        _ => None,
    }
}

/// Returns the position of the first option after a path.
fn option_behind(text: &str) -> Option<usize> {
    let mut places = text.match_indices(" -").map(|(at, _)| at + 1);
    places.find(|at| {
        let (option, values) = split_word(&text[*at..]);
        most_values(&option.to_ascii_lowercase()).is_some() && !values.is_empty()
    })
}

/// Splits off up to `most` values. There may be fewer numbers, and the first value may be a word.
fn values<'s>(tail: &'s str, most: usize, warnings: &mut Warnings) -> (OptionValues<'s>, &'s str) {
    let mut numbers = [None; 3];
    let mut rest = tail;
    for (taken, place) in numbers.iter_mut().take(most).enumerate() {
        let (word, after) = split_word(rest);
        let value = number(word, warnings).map(|value| value as f32);
        if taken > 0 && value.is_none() {
            break;
        }
        *place = value.filter(|value| value.is_finite());
        rest = after;
    }
    let written = tail[..tail.len() - rest.len()].trim_ascii_end();
    (OptionValues { written, numbers }, rest)
}
