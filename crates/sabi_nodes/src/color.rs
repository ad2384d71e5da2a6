//! Color codes: `#rrggbb` in sRGB, as graph files and artists write them.

use sabi_color::linear_from_srgb8;

/// Returns the code of a color, as stored in graph files: `#6b3a1e`.
pub fn color_code([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Returns the sRGB components of `#rrggbb`; `None` if the text does not have that form.
pub(crate) fn color_srgb8(code: &str) -> Option<[u8; 3]> {
    let digits = code.strip_prefix('#').filter(|digits| digits.len() == 6)?;
    if !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return None;
    }
    let [_, r, g, b] = u32::from_str_radix(digits, 16).ok()?.to_be_bytes();
    Some([r, g, b])
}

/// Reads a color as users type it: `#6b3a1e` or `#fff`, with or without the `#`. Returns sRGB components.
pub fn typed_color(text: &str) -> Option<[u8; 3]> {
    let digits = text.trim();
    let digits = digits.strip_prefix('#').unwrap_or(digits); // The `#` is optional.
    match digits.len() {
        3 => color_srgb8(&format!(
            "#{}",
            digits.chars().flat_map(|digit| [digit, digit]).collect::<String>()
        )),
        _ => color_srgb8(&format!("#{digits}")),
    }
}

/// Returns linear RGB for `#rrggbb` (sRGB); `None` if the text does not have that form.
pub fn color_linear(code: &str) -> Option<[f32; 3]> {
    color_srgb8(code).map(linear_from_srgb8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_color_code_is_read_back_unchanged() {
        for code in 0..=255 {
            let srgb = [code, 255 - code, code ^ 0x55];
            assert_eq!(linear_from_srgb8(srgb).map(sabi_color::srgb8_from_linear), srgb);
            assert_eq!(color_srgb8(&color_code(srgb)), Some(srgb));
        }
    }

    #[test]
    fn colors_are_accepted_in_all_forms_that_users_type() {
        for text in ["#6b3a1e", "6B3A1E", " #6b3a1e "] {
            assert_eq!(typed_color(text), Some([0x6b, 0x3a, 0x1e]));
        }
        assert_eq!(typed_color("#18f"), Some([0x11, 0x88, 0xff]));
        for text in ["", "#", "#12345", "#1234567", "rust", "#+12345", "ééé"] {
            assert_eq!(typed_color(text), None, "{text}");
        }
    }

    #[test]
    fn only_one_form_of_color_is_accepted_in_files() {
        for text in ["6b3a1e", "#fff", " #6b3a1e", "##6b3a1"] {
            assert_eq!(color_srgb8(text), None, "{text}");
        }
    }
}
