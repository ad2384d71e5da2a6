//! Color codes: `#rrggbb` in sRGB, as graph files and artists write them.

/// Code of a color, as graph files hold it: `#6b3a1e`.
pub fn color_code([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// sRGB components of `#rrggbb`; `None` when the text is not of that form.
pub(crate) fn color_srgb8(code: &str) -> Option<[u8; 3]> {
    let digits = code.strip_prefix('#').filter(|digits| digits.len() == 6)?;
    if !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return None;
    }
    let [_, r, g, b] = u32::from_str_radix(digits, 16).ok()?.to_be_bytes();
    Some([r, g, b])
}

/// sRGB components of a color as people type it: `#6b3a1e` or `#fff`, with or without the `#`.
pub fn typed_color(text: &str) -> Option<[u8; 3]> {
    let digits = text.trim();
    let digits = digits.strip_prefix('#').unwrap_or(digits); // The sign is optional.
    match digits.len() {
        3 => color_srgb8(&format!(
            "#{}",
            digits.chars().flat_map(|digit| [digit, digit]).collect::<String>()
        )),
        _ => color_srgb8(&format!("#{digits}")),
    }
}

/// Linear RGB of `#rrggbb` (sRGB); `None` when the text is not of that form.
pub fn color_linear(code: &str) -> Option<[f32; 3]> {
    color_srgb8(code).map(linear_from_srgb8)
}

/// Linear RGB of an sRGB color (IEC 61966-2-1).
pub(crate) fn linear_from_srgb8(srgb: [u8; 3]) -> [f32; 3] {
    srgb.map(|code| {
        let encoded = f64::from(code) / 255.0;
        let linear = if encoded <= 0.04045 {
            encoded / 12.92
        } else {
            ((encoded + 0.055) / 1.055).powf(2.4)
        };
        linear as f32
    })
}

/// sRGB color nearest to linear RGB (IEC 61966-2-1).
pub(crate) fn srgb8_from_linear(linear: [f32; 3]) -> [u8; 3] {
    linear.map(|linear| {
        let linear = f64::from(linear).clamp(0.0, 1.0);
        let encoded = if linear <= 0.003_130_8 {
            linear * 12.92
        } else {
            1.055 * linear.powf(1.0 / 2.4) - 0.055
        };
        (encoded * 255.0).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_reads_back_as_itself() {
        for code in 0..=255 {
            let srgb = [code, 255 - code, code ^ 0x55];
            assert_eq!(srgb8_from_linear(linear_from_srgb8(srgb)), srgb);
            assert_eq!(color_srgb8(&color_code(srgb)), Some(srgb));
        }
    }

    #[test]
    fn a_color_is_read_as_people_type_it() {
        for text in ["#6b3a1e", "6B3A1E", " #6b3a1e "] {
            assert_eq!(typed_color(text), Some([0x6b, 0x3a, 0x1e]));
        }
        assert_eq!(typed_color("#18f"), Some([0x11, 0x88, 0xff]));
        for text in ["", "#", "#12345", "#1234567", "rust", "#+12345", "ééé"] {
            assert_eq!(typed_color(text), None, "{text}");
        }
    }

    #[test]
    fn a_file_holds_a_color_in_one_form_only() {
        for text in ["6b3a1e", "#fff", " #6b3a1e", "##6b3a1"] {
            assert_eq!(color_srgb8(text), None, "{text}");
        }
    }
}
