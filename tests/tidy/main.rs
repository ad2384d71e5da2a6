//! The house rules, held against the files: who may name whom, sizes, names and left-overs.

mod conventions;
mod dependencies;
mod literals;
mod modules;
mod rules;

use std::fs;

use literals::{flag_in, literals_of};
use rules::*;
use sabi_tidy::{assert_none, ending, files_below, is_code, root, text_of};

/// Folders in `crates/`.
fn crate_folders() -> Vec<String> {
    let manifests = files_below("crates").into_iter();
    manifests
        .filter_map(|path| Some(path.strip_prefix("crates/")?.strip_suffix("/Cargo.toml")?.to_owned()))
        .filter(|folder| !folder.contains('/'))
        .collect()
}

#[test]
fn no_crate_below_the_front_ends_names_a_flag() {
    let mut faults = Vec::new();
    for (name, ..) in MAY_NAME.iter().filter(|(name, ..)| !FRONT_ENDS.contains(name)) {
        let sources = files_below(&format!("crates/{name}/src"));
        for path in sources.into_iter().filter(|path| ending(path) == "rs") {
            for (line, text) in literals_of(&text_of(&path)) {
                if let Some(flag) = flag_in(&text) {
                    faults.push(format!(
                        "{path}:{line}: `{flag}` is a flag of the command line: say what is the case, and give a `Remedy` \
                         that each front end says in its own words."
                    ));
                }
            }
        }
    }
    assert_none(faults);
}

#[test]
fn files_are_short_enough_to_read() {
    let mut faults = Vec::new();
    for path in files_below(".").into_iter().filter(|path| is_code(path)) {
        let lines = text_of(&path).lines().count();
        let is_excused = LONGER_FILES.iter().any(|(file, _)| *file == path);
        if lines > MOST_LINES_OF_A_FILE && !is_excused {
            faults.push(format!(
                "{path} has {lines} lines: split it where it changes its subject, at most {MOST_LINES_OF_A_FILE}."
            ));
        }
    }
    assert_none(faults);
}

#[test]
fn names_say_what_is_inside() {
    let mut faults = Vec::new();
    for path in files_below(".").into_iter().filter(|path| is_code(path)) {
        let without_ending = path.rsplit_once('.').map_or(path.as_str(), |(stem, _)| stem);
        let inline = text_of(&path);
        let inline = inline
            .lines()
            .filter_map(|line| line.trim().split_once("mod ")?.1.strip_suffix(" {"));
        for name in without_ending.split('/').chain(inline) {
            if EMPTY_NAMES.contains(&name) {
                faults.push(format!(
                    "{path}: `{name}` says nothing about what is inside: name it after its subject."
                ));
            }
        }
    }
    assert_none(faults);
}

#[test]
fn nothing_is_left_behind_and_nothing_points_to_one_machine() {
    let mut faults = Vec::new();
    for path in files_below(".")
        .into_iter()
        .filter(|path| TEXT_ENDINGS.contains(&ending(path)))
    {
        for (number, line) in text_of(&path).lines().enumerate() {
            for left_over in LEFT_OVERS.iter().filter(|left_over| has_word(line, left_over)) {
                faults.push(format!(
                    "{path}:{}: `{left_over}` is a left-over: finish it or take it out.",
                    number + 1
                ));
            }
            for place in MACHINE_PATHS.iter().filter(|place| line.contains(**place)) {
                faults.push(format!(
                    "{path}:{}: `{place}` exists on one machine only: name a path from the root of the project.",
                    number + 1
                ));
            }
        }
    }
    assert_none(faults);
}

/// Returns true if a text occurs in a line and is not a part of a longer word.
fn has_word(line: &str, text: &str) -> bool {
    line.match_indices(text).any(|(at, _)| {
        let is_part = |c: char| c.is_alphanumeric() || c == '_';
        !line[..at].ends_with(is_part) && (text.ends_with('(') || !line[at + text.len()..].starts_with(is_part))
    })
}

#[test]
fn goldens_stay_small() {
    let mut faults = Vec::new();
    for path in files_below("tests")
        .into_iter()
        .filter(|path| path.starts_with("tests/golden/"))
    {
        let bytes = fs::metadata(root().join(&path)).unwrap().len();
        if bytes > MOST_BYTES_OF_A_GOLDEN {
            faults.push(format!(
                "{path} has {bytes} bytes: make the picture smaller, at most {MOST_BYTES_OF_A_GOLDEN}."
            ));
        }
    }
    assert_none(faults);
}

#[test]
fn every_exception_still_has_something_to_excuse() {
    for (path, reason) in LONGER_FILES {
        assert!(
            text_of(path).lines().count() > MOST_LINES_OF_A_FILE,
            "{path} no longer needs its exception ({reason})."
        );
    }
}
