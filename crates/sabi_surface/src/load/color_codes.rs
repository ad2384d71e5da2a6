//! Colors that are stored as codes from 0 to 255 where shares from 0 to 1 are expected.

use super::warnings::Warnings;

/// Value from which colors are interpreted as codes. Colors between 0 and 1 do not reach it by rounding errors or by somewhat
/// overbright values.
const CODES_FROM: f32 = 2.0;
/// The code of full intensity.
pub(super) const LARGEST_CODE: f32 = 255.0;

/// Returns true if colors with this largest value are codes; this is a guess, so it adds a warning. `whose` are the elements
/// with colors.
pub(super) fn are_codes(largest: f32, whose: &str, warnings: &mut Warnings) -> bool {
    let are_codes = largest >= CODES_FROM;
    if are_codes {
        warnings.add(format!(
            "The colors of {whose} reach above 1; they are taken as codes of 0 to 255."
        ));
    }
    are_codes
}
