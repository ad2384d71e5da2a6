//! Characters that are invisible or change how the text around them is displayed.

/// Returns true for a character that is invisible or misleading: it controls a terminal, breaks a line, or reverses the
/// direction of the text around it, so that `gnp.exe` is displayed as `exe.png`.
pub fn is_invisible(letter: char) -> bool {
    // Joiners (U+200C, U+200D) are allowed: they are part of the spelling of some languages and of emoji.
    letter.is_control()
        || matches!(letter,
            '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
}

#[cfg(test)]
mod tests {
    use super::is_invisible;

    #[test]
    fn letters_of_all_languages_are_visible_and_direction_marks_are_not() {
        // Classes Cc, Zl, Zp and the marks of UAX #9, and the characters that UTS #39 lists as invisible.
        for letter in "\0\u{1b}\r\n\t\u{7f}\u{85}\u{9b}\u{202e}\u{2066}\u{200e}\u{2028}\u{feff}\u{e0041}".chars() {
            assert!(is_invisible(letter), "{letter:?}");
        }
        for letter in "aß ключ 錆 مفتاح नि\u{200d} 🏳\u{fe0f}\u{200d}🌈 \u{a0}".chars() {
            assert!(!is_invisible(letter), "{letter:?}");
        }
    }
}
