//! Colors of the parts of a model, by which other programs select parts.

use sabi_color::linear_from_srgb8;

/// Step of the hue from group to group: 2³² divided by the golden ratio, so that the hues of any number of groups differ clearly.
const GOLDEN_STEP: u32 = 2_654_435_769;

/// Returns the color of a group by its number.
pub(super) fn numbered_color(number: u32) -> [f32; 3] {
    id_color(number.wrapping_mul(GOLDEN_STEP))
}

/// Returns the color of a group. Its hue is a share of 2³² of the color circle. The color is an exact code of 8 bits.
pub(super) fn id_color(hue: u32) -> [f32; 3] {
    let around = f64::from(hue) / 4_294_967_296.0 * 6.0;
    // Three sawtooth functions, offset by a third of the circle. Neighboring hues have different depths.
    let depth = 1.0 - f64::from(hue >> 8 & 3) * 0.12;
    let code = |shift: f64| {
        let tooth = ((around + shift).rem_euclid(6.0) - 3.0).abs() - 1.0;
        ((0.15 + 0.85 * tooth.clamp(0.0, 1.0)) * depth * 255.0).round() as u8
    };
    linear_from_srgb8([0.0, 4.0, 2.0].map(code))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn the_colors_of_a_hundred_parts_are_all_different_codes() {
        let codes = |number: u32| numbered_color(number).map(sabi_color::srgb8_from_linear);
        let all: BTreeSet<[u8; 3]> = (0..100).map(codes).collect();
        assert_eq!(all.len(), 100);
        // As half floats keep them, too.
        for number in 0..100 {
            let cut = id_color(number * 7).map(|value| f32::from_bits(value.to_bits() & !0x1fff));
            let rounded = id_color(number * 7).map(|value| f32::from_bits((value.to_bits() + 0x1000) & !0x1fff));
            let exact = id_color(number * 7).map(sabi_color::srgb8_from_linear);
            assert_eq!(
                [cut, rounded].map(|kept| kept.map(sabi_color::srgb8_from_linear)),
                [exact; 2]
            );
        }
        assert_eq!(codes(0), [255, 38, 38]);
    }
}
