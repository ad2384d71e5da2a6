//! Colors of vertices and faces.

use sabi_color::linear_from_srgb;

use super::body::PropertyValue;
use super::header::{NumberType, PlyElement};
use crate::load::color_codes::{LARGEST_CODE, are_codes};
use crate::load::warnings::Warnings;

/// Names of the channels of a color; of each list the first that is there.
const COLOR: [&[&str]; 4] = [
    &["red", "r", "diffuse_red"],
    &["green", "g", "diffuse_green"],
    &["blue", "b", "diffuse_blue"],
    &["alpha", "a", "diffuse_alpha"],
];
/// Codes of full intensity that programs store in types with larger ones.
const SMALLER_CODES: [f32; 2] = [LARGEST_CODE, u16::MAX as f32];

/// Places of the channels of a color among the properties of an element, with their types.
pub(super) struct ColorProperties([Option<(usize, NumberType)>; 4]);

impl ColorProperties {
    pub(super) fn of(element: &PlyElement) -> ColorProperties {
        ColorProperties(COLOR.map(|names| {
            let place = names.iter().find_map(|name| element.place(name))?;
            Some((place, element.properties.get(place)?.kind))
        }))
    }

    /// The colors if they are wanted, else none.
    pub(super) fn filter(self, are_wanted: bool) -> ColorProperties {
        if are_wanted { self } else { ColorProperties([None; 4]) }
    }

    /// Returns true if there is red, green and blue.
    pub(super) fn are_there(&self) -> bool {
        self.0[..3].iter().all(Option::is_some)
    }

    /// Returns the color of a row as it is stored. Alpha is 1 without a channel of its own.
    pub(super) fn of_row(&self, row: &[PropertyValue]) -> Option<[f32; 4]> {
        let value = |channel: Option<(usize, NumberType)>| match channel.map(|(place, _)| row.get(place)) {
            Some(Some(PropertyValue::Number(number))) => *number as f32,
            // A list is no channel.
            Some(Some(PropertyValue::List(_)) | None) => 0.0,
            None => 1.0,
        };
        self.are_there().then(|| self.0.map(value))
    }

    /// Converts stored colors to linear RGBA, once all are known. `whose` are the elements that have them.
    pub(super) fn make_linear(&self, colors: &mut [[f32; 4]], whose: &str, warnings: &mut Warnings) {
        let codes = std::array::from_fn(|channel| self.code(channel, colors, whose, warnings));
        let share = |value: f32, code: Option<f32>| code.map_or(value, |code| (value / code).clamp(0.0, 1.0));
        let light = |value: f32, code: Option<f32>| match code {
            Some(_) => linear_from_srgb(share(value, code)),
            None => value,
        };
        let [red, green, blue, alpha]: [Option<f32>; 4] = codes;
        for [r, g, b, a] in colors {
            *r = light(*r, red);
            *g = light(*g, green);
            *b = light(*b, blue);
            *a = share(*a, alpha);
        }
    }

    /// Returns the code of full intensity of a channel; `None` if its values are shares. Programs store codes up to 255 in larger
    /// types, too, and in floats.
    fn code(&self, channel: usize, colors: &[[f32; 4]], whose: &str, warnings: &mut Warnings) -> Option<f32> {
        let (_, kind) = self.0[channel]?;
        let own = kind.largest_code();
        // Integers of the same type have the same code. An alpha of floats may go to 1 where colors go to 255.
        let is_alike = |other: usize| {
            self.0[other].is_some_and(|(_, of_other)| of_other == kind)
                && (own.is_some() || (other == 3) == (channel == 3))
        };
        let largest = |other: usize| colors.iter().map(move |color| color[other]).fold(0.0, f32::max);
        let largest = (0..4).filter(|other| is_alike(*other)).map(largest).fold(0.0, f32::max);
        let Some(own) = own else {
            return are_codes(largest, whose, warnings).then_some(LARGEST_CODE);
        };
        if own < LARGEST_CODE && largest > own {
            // A text that calls its bytes signed.
            return Some(LARGEST_CODE);
        }
        let mut smaller = SMALLER_CODES.into_iter().filter(|code| *code < own);
        let Some(code) = smaller.find(|code| largest <= *code) else {
            return Some(own);
        };
        if largest > 0.0 {
            warnings.add(format!(
                "No color of the {whose} is above {code}, though its type has larger numbers; they are taken as codes of 0 to {code}."
            ));
        }
        Some(code)
    }
}
