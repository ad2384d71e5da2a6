//! Numbers of text files in all forms that programs write.

use super::warnings::Warnings;

/// Warning about numbers such as `0,5`, which some programs write in the language of their user.
const COMMAS: &str = "The file writes numbers with decimal commas, such as `0,5`; they are read as decimal points.";

/// Reads a number. A decimal comma is accepted, with a warning. Words for NaN, such as `1.#IND` and `-nan(ind)`, give NaN;
/// other words give `None`.
pub(super) fn number(word: &str, warnings: &mut Warnings) -> Option<f64> {
    let word = word.strip_suffix(',').unwrap_or(word);
    if let Ok(number) = word.parse() {
        return Some(number);
    }
    if let Some((digits, exponent)) = word.split_once(['D', 'd'])
        && digits.bytes().any(|letter| letter.is_ascii_digit())
        && let Ok(number) = format!("{digits}e{exponent}").parse()
    {
        return Some(number);
    }
    let unsigned = word.trim_start_matches(['-', '+']);
    let is_nan = unsigned
        .get(..4)
        .is_some_and(|start| start.eq_ignore_ascii_case("nan("));
    if is_nan || word.contains(".#") {
        return Some(f64::NAN);
    }
    let (whole, fraction) = word.split_once(',')?;
    let number = format!("{whole}.{fraction}").parse().ok()?;
    warnings.add(COMMAS);
    Some(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_in_all_forms_that_programs_write() {
        for (word, number_of_it, has_comma) in [
            ("5412345.456864", Some(5_412_345.456_864), false),
            ("-1e-3", Some(-0.001), false),
            ("0,010000", Some(0.01), true),
            ("-,5", Some(-0.5), true),
            ("1,5e2", Some(150.0), true),
            ("1.5D+02", Some(150.0), false),
            ("-2d-1", Some(-0.2), false),
            ("d1", None, false),
            ("1.5,", Some(1.5), false),
            ("1,5,", Some(1.5), true),
            ("1,234.5", None, false),
            ("1,2,3", None, false),
            ("0.5x", None, false),
            ("", None, false),
        ] {
            let mut warnings = Warnings::default();
            assert_eq!(number(word, &mut warnings), number_of_it, "{word}");
            assert_eq!(!warnings.is_empty(), has_comma, "{word}");
        }
        for word in ["nan", "-NaN", "-nan(ind)", "1.#IND", "-1.#QNAN"] {
            assert!(
                number(word, &mut Warnings::default()).is_some_and(f64::is_nan),
                "{word}"
            );
        }
    }
}
