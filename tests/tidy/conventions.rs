//! Conventions of the code, held file by file.

use sabi_tidy::{assert_none, ending, files_below, text_of};

use crate::crate_folders;
use crate::modules::Modules;
use crate::rules::*;

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
