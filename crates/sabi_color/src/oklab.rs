//! Oklab, in which equal distances look about equally different (Ottosson 2020, "A perceptual color space for image
//! processing"). Components are lightness from 0 to 1, green to red, and blue to yellow.

/// Converts a linear color with the primaries of Rec. 709.
pub fn oklab_from_linear([r, g, b]: [f32; 3]) -> [f32; 3] {
    let l = (0.412_221_47 * r + 0.536_332_55 * g + 0.051_445_995 * b).cbrt();
    let m = (0.211_903_5 * r + 0.680_699_5 * g + 0.107_396_96 * b).cbrt();
    let s = (0.088_302_46 * r + 0.281_718_85 * g + 0.629_978_7 * b).cbrt();
    [
        0.210_454_26 * l + 0.793_617_8 * m - 0.004_072_047 * s,
        1.977_998_5 * l - 2.428_592_2 * m + 0.450_593_7 * s,
        0.025_904_037 * l + 0.782_771_77 * m - 0.808_675_77 * s,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grays_have_no_hue_and_primaries_are_where_the_paper_has_them() {
        for (linear, expected) in [
            ([1.0, 1.0, 1.0], [1.0, 0.0, 0.0]),
            ([0.125, 0.125, 0.125], [0.5, 0.0, 0.0]),
            ([1.0, 0.0, 0.0], [0.628, 0.225, 0.126]),
            ([0.0, 1.0, 0.0], [0.866, -0.234, 0.179]),
            ([0.0, 0.0, 1.0], [0.452, -0.032, -0.312]),
        ] {
            let is = oklab_from_linear(linear);
            let off = (0..3)
                .map(|at| (is[at] - expected[at] as f32).abs())
                .fold(0.0, f32::max);
            assert!(off < 6e-4, "{linear:?}: {is:?} for {expected:?}");
        }
    }
}
