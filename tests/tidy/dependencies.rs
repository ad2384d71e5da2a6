//! Rules about crates: the crates each may name, its outside crates, its manifest and its section in ARCHITECTURE.md.

use std::collections::BTreeSet;

use sabi_tidy::{assert_none, ending, files_below, text_of};

use crate::crate_folders;
use crate::rules::*;

fn manifest_of(path: &str) -> toml::Table {
    text_of(path)
        .parse()
        .unwrap_or_else(|error| panic!("{path} is not TOML: {error}"))
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
fn every_arrow_of_the_table_is_one_of_a_manifest() {
    let mut faults = Vec::new();
    for (name, ours, _) in MAY_NAME {
        let dependencies = dependencies_of(&manifest_of(&format!("crates/{name}/Cargo.toml")));
        for absent in ours.iter().filter(|named| !dependencies.contains(**named)) {
            faults.push(format!(
                "{name} does not depend on {absent}: take it out of its row in tests/tidy/rules.rs."
            ));
        }
    }
    assert_none(faults);
}

#[test]
fn no_crate_exports_names_of_another() {
    let mut faults = Vec::new();
    let sources = files_below("crates").into_iter().filter(|path| ending(path) == "rs");
    for path in sources {
        for (number, line) in text_of(&path).lines().enumerate() {
            if line.trim_start().starts_with("pub use sabi_") {
                faults.push(format!(
                    "{path}:{}: this hides an arrow: let the crates that use these names depend on the crate that has them.",
                    number + 1
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
                "crates/{folder} has no row in the table of tests/tidy/rules.rs: add one."
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
                "{owned} has {owners} owners in the table of tests/tidy/rules.rs: leave it one."
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
