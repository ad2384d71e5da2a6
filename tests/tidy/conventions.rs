//! Conventions of the code, held file by file.

use sabi_tidy::{assert_none, ending, files_below, text_of};

use crate::crate_folders;
use crate::matches::catch_alls;
use crate::modules::Modules;
use crate::rules::*;

/// Rust files of all crates but those of tests and benches.
fn sources_without_tests() -> impl Iterator<Item = String> {
    let is_source = |path: &String| {
        let steps: Vec<&str> = path.split('/').collect();
        ending(path) == "rs"
            && !steps
                .iter()
                .any(|step| matches!(*step, "tests" | "tests.rs" | "benches" | "examples"))
    };
    files_below("crates").into_iter().filter(is_source)
}

#[test]
fn modules_of_a_crate_form_no_circles() {
    let mut faults = Vec::new();
    for name in crate_folders() {
        let folder = format!("crates/{name}/src/");
        let sources = files_below("crates").into_iter();
        let sources: Vec<_> = sources
            .filter(|path| ending(path) == "rs")
            .filter_map(|path| Some((path.strip_prefix(&folder)?.to_owned(), text_of(&path))))
            .collect();
        let circles = Modules::read(&sources).circles().into_iter();
        faults.extend(circles.map(|circle| {
            format!(
                "{name}: {} need each other: move what both need below them, or into their parent.",
                circle.join(", ")
            )
        }));
    }
    assert_none(faults);
}

#[test]
fn every_command_and_action_is_named_where_it_is_handled() {
    let mut faults = Vec::new();
    for path in sources_without_tests() {
        for name in catch_alls(&text_of(&path), &HANDLED_BY_NAME) {
            faults.push(format!(
                "{path}: a match over `{name}` ends in a catch-all, so a new one that is not handled would compile: name \
                 each."
            ));
        }
    }
    assert_none(faults);
}

#[test]
fn a_default_in_place_of_a_missing_value_has_its_reason_beside_it() {
    let mut faults = Vec::new();
    for path in sources_without_tests() {
        let text = text_of(&path);
        let lines: Vec<&str> = text.lines().take_while(|line| line.trim() != "#[cfg(test)]").collect();
        for (number, line) in lines.iter().enumerate() {
            let is_comment = |line: &str| line.trim_start().starts_with("//");
            let before = number.checked_sub(1).map(|before| lines[before]);
            let has_reason = line.contains("// ") || before.is_some_and(is_comment);
            if line.contains(".unwrap_or_default()") && !has_reason {
                faults.push(format!(
                    "{path}:{}: say beside `unwrap_or_default` why nothing is missing here, or handle the case.",
                    number + 1
                ));
            }
        }
    }
    assert_none(faults);
}

#[test]
fn every_test_that_the_docs_name_exists() {
    let code: String = files_below(".")
        .into_iter()
        .filter(|path| ending(path) == "rs")
        .map(|path| text_of(&path))
        .collect();
    let mut faults = Vec::new();
    let docs = files_below("docs/design").into_iter();
    for path in docs.chain(["CONTRIBUTING.md".to_owned()]) {
        for name in text_of(&path).split('`').skip(1).step_by(2) {
            // Names of tests are sentences.
            let is_claim = name.matches('_').count() > 3 && !name.contains(|c: char| c != '_' && !c.is_alphanumeric());
            if is_claim && !code.contains(&format!("fn {name}(")) {
                faults.push(format!("{path} names the test `{name}`, which does not exist."));
            }
        }
    }
    assert_none(faults);
}

#[test]
fn nothing_refers_to_a_document_that_is_not_here() {
    let mut faults = Vec::new();
    for path in files_below(".")
        .into_iter()
        .filter(|path| TEXT_ENDINGS.contains(&ending(path)))
    {
        for (number, line) in text_of(&path).lines().enumerate() {
            for absent in ABSENT_DOCUMENTS.iter().filter(|absent| line.contains(**absent)) {
                faults.push(format!(
                    "{path}:{}: `{absent}` is not in the repository: say here what it says.",
                    number + 1
                ));
            }
        }
    }
    assert_none(faults);
}
