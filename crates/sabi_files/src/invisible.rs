//! Characters that are invisible or change how the text around them is displayed.

/// Returns true for a character that is invisible or misleading: it controls a terminal, breaks a line, or reverses the
/// direction of the text around it, so that `gnp.exe` is displayed as `exe.png`.
pub fn is_invisible(letter: char) -> bool {
    // Joiners (U+200C, U+200D) and selectors of a form (U+FE00 to U+FE0F) are part of the spelling of some languages and of emoji. The
    // others are those that Unicode ignores where they are not supported (Default_Ignorable_Code_Point), and the blank of Braille.
    letter.is_control()
        || matches!(letter,
            '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}' | '\u{180b}'..='\u{180f}'
            | '\u{200b}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{2800}'
            | '\u{3164}' | '\u{feff}' | '\u{ffa0}' | '\u{fff0}'..='\u{fffb}' | '\u{1bca0}'..='\u{1bca3}'
            | '\u{1d173}'..='\u{1d17a}' | '\u{e0000}'..='\u{e0fff}')
}

#[cfg(test)]
mod tests {
    use super::is_invisible;

    #[test]
    fn letters_of_all_languages_are_visible_and_direction_marks_are_not() {
        // Classes Cc, Zl, Zp and the marks of UAX #9, and what UTS #39 takes for invisible.
        for letter in "\0\u{1b}\r\n\t\u{7f}\u{85}\u{9b}\u{202e}\u{2066}\u{200e}\u{2028}\u{feff}\u{e0041}\u{3164}\u{115f}\u{34f}\u{2800}".chars() {
            assert!(is_invisible(letter), "{letter:?}");
        }
        for letter in "aß ключ 錆 مفتاح नि\u{200d} 🏳\u{fe0f}\u{200d}🌈 \u{a0}".chars() {
            assert!(!is_invisible(letter), "{letter:?}");
        }
    }
}
