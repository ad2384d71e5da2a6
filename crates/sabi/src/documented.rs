//! Tests that docs/report.md names exactly the keys of the JSON that only the command line writes.

#[path = "../../sabi_engine/src/report_keys/keys.rs"]
pub(crate) mod keys;

use std::path::Path;

use keys::{documented, written};
use sabi_engine::Remedy;
use sabi_engine::phases::Phase;

use crate::event::Event;
use crate::exit::{Exit, Failure};
use crate::failed_bake::FailedBake;
use crate::failure_report::FailureReport;

fn failure(bake: Option<Box<FailedBake>>) -> Failure {
    Failure {
        messages: ["one", "two"].map(str::to_owned).to_vec(),
        remedies: vec![Remedy::SmallerSize],
        bake,
        ..Failure::new(Exit::BadInput, String::new())
    }
}

#[test]
fn a_failure_has_the_documented_keys() {
    let report = FailureReport::new(&failure(None), "bake");
    assert_eq!(written(&report), documented("Failure"));
}

#[test]
fn the_report_of_a_failed_bake_has_the_documented_keys() {
    let bake = FailedBake::new(Path::new("rust.sabi"), Path::new("crate.glb"));
    let report = FailureReport::new(&failure(Some(Box::new(bake))), "bake");
    assert_eq!(written(&report), documented("Report of a failed bake"));
}

#[test]
fn events_have_the_documented_keys() {
    let mut keys = written(&Event::phase(Phase::Run, 3, 12));
    keys.extend(written(&Event::phase_of(3, Phase::Run, 3, 12)));
    let (item, status) = (3, "baked");
    keys.extend(written(&Event::Item {
        item,
        status,
        done: 1,
        of: 2,
    }));
    keys.extend(written(&Event::done(Exit::Done)));
    assert_eq!(keys, documented("Progress"));
}

#[test]
fn a_remedy_has_the_flag_of_its_command_and_a_single_sentence_is_no_list() {
    let mut failure = failure(None);
    failure.messages.truncate(1);
    let report = serde_json::to_value(FailureReport::new(&failure, "bake")).unwrap();
    let expected = serde_json::json!({ "error": {
        "kind": "bad_input", "exit": 65, "message": "one", "remedies": ["choose a smaller size with --size"],
    } });
    assert_eq!(report, expected);
}
