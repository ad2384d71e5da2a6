//! `cargo xtask bless KIND`: writes the goldens of a node again.

use crate::place::{Place, Stop, finish};
use crate::vulkan::{self, Driver};

/// Writes the goldens of a kind, or of all.
pub(crate) fn run(place: &Place, kind: Option<&str>) -> Result<(), Stop> {
    let Some(kind) = kind else {
        let advice = "Which node? Say `cargo xtask bless noise/simplex`, or `cargo xtask bless all`.";
        return Err(Stop::new(2, advice.to_owned()));
    };
    vulkan::ensure(place, Driver::Software)?;
    let test = [
        "test",
        "--package",
        "sabi_tests",
        "--test",
        "pixels",
        "--",
        "--exact",
        "golden::every_result_is_what_its_golden_shows",
    ];
    let mut command = place.cargo(&test)?;
    command.env("SABI_BLESS", kind);
    finish(command, "The goldens")?;
    eprintln!("Written below tests/golden: look at what `git diff --stat` lists before you commit it.");
    Ok(())
}
