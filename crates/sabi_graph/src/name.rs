//! Names of knobs, variants, frames and groups.

use crate::problem::{Problem, quoted};

/// Maximum length of such a name, in characters.
const NAME_LIMIT: usize = 200;

/// Characters that are not allowed in the name of a knob: an override is written `NAME=VALUE`, and a name with a dot means `node.param`.
pub(crate) const NOT_IN_KNOBS: &str = ".=";

/// Checks a name: 1 to 200 characters, no control characters and none of `without`.
pub(crate) fn check_name(what: &'static str, name: &str, without: &'static str) -> Result<(), Problem> {
    let bad = |c: char| c.is_control() || without.contains(c);
    if name.is_empty() || name.chars().count() > NAME_LIMIT || name.contains(bad) {
        let without = match without {
            "" => "none of them a control character",
            _ => "without dots and equal signs",
        };
        return Err(Problem::BadName {
            what,
            name: quoted(name),
            without,
        });
    }
    Ok(())
}
