//! The house rules, held against the files: who may name whom, sizes, names and left-overs.

#[path = "tidy/conventions.rs"]
mod conventions;
#[path = "tidy/functions.rs"]
mod functions;
#[path = "tidy/literals.rs"]
mod literals;
#[path = "tidy/matches.rs"]
mod matches;
#[path = "tidy/mirrors.rs"]
mod mirrors;
#[path = "tidy/modules.rs"]
mod modules;
#[path = "tidy/rules.rs"]
mod rules;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{fs, io};

use functions::functions_of;
use literals::{flag_in, literals_of};
use rules::*;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Every file of the project below a folder, as paths from the root, in order.
fn files_below(folder: &str) -> Vec<String> {
    let mut found = Vec::new();
    collect(folder, &mut found).unwrap_or_else(|error| panic!("{folder} cannot be listed: {error}."));
    found.sort();
    found
}

fn collect(folder: &str, found: &mut Vec<String>) -> io::Result<()> {
    for entry in fs::read_dir(root().join(folder))? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = if folder == "." {
            name
        } else {
            format!("{folder}/{name}")
        };
        if !entry.file_type()?.is_dir() {
            found.push(path);
        } else if !matches!(
            path.as_str(),
            "target" | "out" | ".git" | "fuzz/target" | "fuzz/corpus" | "fuzz/artifacts"
        ) {
            collect(&path, found)?;
        }
    }
    Ok(())
}

fn ending(path: &str) -> &str {
    Path::new(path)
        .extension()
        .and_then(|ending| ending.to_str())
        .unwrap_or_default()
}

fn is_code(path: &str) -> bool {
    matches!(ending(path), "rs" | "wgsl")
}

fn text_of(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path} cannot be read as text: {error}."))
}

fn manifest_of(path: &str) -> toml::Table {
    text_of(path)
        .parse()
        .unwrap_or_else(|error| panic!("{path} is not TOML: {error}"))
}

/// Folders in `crates/`.
fn crate_folders() -> Vec<String> {
    let manifests = files_below("crates").into_iter();
    manifests
        .filter_map(|path| Some(path.strip_prefix("crates/")?.strip_suffix("/Cargo.toml")?.to_owned()))
        .filter(|folder| !folder.contains('/'))
        .collect()
}

/// Names in every table of dependencies but those of tests, by package name.
fn dependencies_of(manifest: &toml::Table) -> BTreeSet<String> {
    let mut tables = vec![manifest];
    let targets = manifest.get("target").and_then(toml::Value::as_table);
    let targets = targets.into_iter().flat_map(|targets| targets.values());
    tables.extend(targets.filter_map(toml::Value::as_table));
    let mut names = BTreeSet::new();
    for table in tables {
        for kind in ["dependencies", "build-dependencies"] {
            for (name, what) in table.get(kind).and_then(toml::Value::as_table).into_iter().flatten() {
                let package = what.get("package").and_then(toml::Value::as_str).unwrap_or(name);
                names.insert(package.replace('-', "_"));
            }
        }
    }
    names
}

fn is_owned(name: &str) -> bool {
    owned().any(|owned| owned == name) || name.starts_with("egui")
}

/// All faults at once, so that one run shows everything there is to mend.
fn assert_none(faults: Vec<String>) {
    assert!(faults.is_empty(), "\n{}\n", faults.join("\n"));
}

#[test]
fn dependencies_point_down() {
    let mut faults = Vec::new();
    for (name, ours, outside) in MAY_NAME {
        for dependency in dependencies_of(&manifest_of(&format!("crates/{name}/Cargo.toml"))) {
            let is_ruled = dependency.starts_with("sabi") || is_owned(&dependency);
            let is_granted = ALSO.contains(&(name, dependency.as_str()));
            if is_ruled
                && !is_granted
                && !ours.contains(&dependency.as_str())
                && !outside.contains(&dependency.as_str())
            {
                faults.push(format!(
                    "{name} names {dependency}, which is not its to name (it may name {ours:?} and owns {outside:?}): \
                     ask the crate that owns it for what is needed, or change ARCHITECTURE.md and this table first."
                ));
            }
        }
    }
    assert_none(faults);
}

#[test]
fn the_table_names_every_crate_and_each_outside_crate_once() {
    let mut faults = Vec::new();
    for folder in crate_folders() {
        if !MAY_NAME.iter().any(|(name, ..)| *name == folder) {
            faults.push(format!(
                "crates/{folder} has no row in the table of tests/tidy.rs: add one."
            ));
        }
    }
    for owned in owned() {
        let owners = MAY_NAME
            .iter()
            .filter(|(_, _, outside)| outside.contains(&owned))
            .count();
        if owners > 1 {
            faults.push(format!(
                "{owned} has {owners} owners in the table of tests/tidy.rs: leave it one."
            ));
        }
    }
    assert_none(faults);
}

#[test]
fn a_crate_is_named_like_its_folder_and_follows_the_common_lints() {
    let mut faults = Vec::new();
    let crates = crate_folders()
        .into_iter()
        .map(|name| (format!("crates/{name}/Cargo.toml"), name));
    for (path, name) in crates.chain([("tests/Cargo.toml".into(), "sabi_tests".into())]) {
        let manifest = manifest_of(&path);
        let package = manifest["package"]["name"].as_str().unwrap();
        if package != name {
            faults.push(format!(
                "{path} calls its package {package}: call it {name}, like its folder."
            ));
        }
        let lints = manifest
            .get("lints")
            .and_then(|lints| lints.get("workspace"))
            .and_then(toml::Value::as_bool);
        if lints != Some(true) {
            faults.push(format!(
                "{path} goes its own way with lints: add `[lints]` with `workspace = true`."
            ));
        }
    }
    assert_none(faults);
}

#[test]
fn the_architecture_names_every_crate_and_what_it_does_not_know() {
    let text = text_of("ARCHITECTURE.md");
    let mut faults = Vec::new();
    for name in crate_folders() {
        let section = text
            .split("\n### ")
            .find(|section| section.starts_with(&format!("`{name}`")));
        if !section.is_some_and(|section| section.contains("*Does not know:*")) {
            faults.push(format!(
                "ARCHITECTURE.md says nothing of {name}: add a section \"### `{name}`\" that ends with a line \
                 \"*Does not know:* …\"."
            ));
        }
    }
    assert_none(faults);
}

#[test]
fn no_crate_below_the_front_ends_names_a_flag() {
    let mut faults = Vec::new();
    for (name, ..) in MAY_NAME.iter().filter(|(name, ..)| !FRONT_ENDS.contains(name)) {
        let sources = files_below(&format!("crates/{name}/src"));
        for path in sources.into_iter().filter(|path| ending(path) == "rs") {
            for (line, text) in literals_of(&text_of(&path)) {
                if let Some(flag) = flag_in(text) {
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
fn functions_are_short_enough_to_read() {
    let mut faults = Vec::new();
    for path in files_below(".").into_iter().filter(|path| is_code(path)) {
        for (name, line, lines) in functions_of(&text_of(&path)) {
            let is_excused = LONGER_FUNCTIONS
                .iter()
                .any(|(function, _)| *function == format!("{path}: {name}"));
            if lines > MOST_LINES_OF_A_FUNCTION && !is_excused {
                faults.push(format!(
                    "{path}:{line}: `{name}` has {lines} lines: give its steps names, at most \
                     {MOST_LINES_OF_A_FUNCTION}."
                ));
            }
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
    for (function, reason) in LONGER_FUNCTIONS {
        let (path, name) = function.split_once(": ").unwrap();
        let is_needed = functions_of(&text_of(path))
            .iter()
            .any(|(own, _, lines)| own == name && *lines > MOST_LINES_OF_A_FUNCTION);
        assert!(is_needed, "{function} no longer needs its exception ({reason}).");
    }
}
