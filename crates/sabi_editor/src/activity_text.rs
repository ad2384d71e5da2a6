//! Progress of long work in words.

use sabi_engine::phases::Activity;

/// Phase of the work with the number of its steps that are done; a single step with the time of the whole work so far.
pub(crate) fn activity_text(activity: &Activity) -> String {
    let label = activity.phase.label();
    if activity.of > 1 {
        return format!("{label}: {} of {}", activity.done, activity.of);
    }
    match activity.since.elapsed().as_secs() {
        0 => label.to_owned(),
        seconds => format!("{label}: {seconds} s"),
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use sabi_engine::phases::Phase;

    use super::*;

    #[test]
    fn progress_is_the_number_of_steps_or_the_time_of_a_single_one() {
        let activity = |phase, done, of, seconds: u64| Activity {
            phase,
            done,
            of,
            since: Instant::now() - Duration::from_millis(seconds * 1000 + 1),
        };
        assert_eq!(activity_text(&activity(Phase::Run, 12, 80, 3)), "Evaluating: 12 of 80");
        assert_eq!(
            activity_text(&activity(Phase::Atlas, 0, 1, 12)),
            "Preparing UV seams: 12 s"
        );
        assert_eq!(activity_text(&activity(Phase::Atlas, 0, 1, 0)), "Preparing UV seams");
    }
}
