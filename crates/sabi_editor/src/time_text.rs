//! Durations for people.

use std::time::Duration;

/// A duration with as many digits as are needed to compare it.
pub(crate) fn time_text(time: Duration) -> String {
    let milliseconds = time.as_secs_f64() * 1000.0;
    match milliseconds {
        ..0.95 => format!("{milliseconds:.1} ms"),
        ..999.5 => format!("{milliseconds:.0} ms"),
        _ => format!("{:.1} s", milliseconds / 1000.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_has_only_the_digits_that_are_needed_to_compare_it() {
        let told = |seconds: f64| time_text(Duration::from_secs_f64(seconds));
        let expected = [
            (0.0004, "0.4 ms"),
            (0.0123, "12 ms"),
            (0.9994, "999 ms"),
            (2.34, "2.3 s"),
        ];
        for (seconds, text) in expected {
            assert_eq!(told(seconds), text);
        }
    }
}
