//! Log of internal events, started by `SABI_LOG` or `--log`.

use crate::cli_folder::{CliFolder, done, software_adapter};

#[test]
fn the_log_names_the_steps_of_a_bake_with_their_times() {
    software_adapter();
    let place = CliFolder::new();
    let arguments = [
        "bake",
        "rust.sabi",
        "--mesh",
        "cube.glb",
        "--size",
        "64",
        "--adapter",
        "cpu",
        "-o",
        "out",
    ];
    let run = place.command(&arguments).env("SABI_LOG", "debug").output().unwrap();
    let log = done(run).good().stderr;
    for step in [
        "open graph",
        "load model",
        "link atlas",
        "open device",
        "upload surface",
        "plan",
        "run",
        "read back",
        "encode",
        "write",
    ] {
        let is_closed = |line: &str| line.contains(&format!(" {step}")) && line.contains("close time.busy=");
        assert!(log.lines().any(is_closed), "{step}\n{log}");
    }
}

#[test]
fn a_filter_that_cannot_be_read_is_refused_by_the_name_it_was_given_by() {
    let place = CliFolder::new();
    let run = place.command(&["nodes"]).env("SABI_LOG", "sabi=loud").output().unwrap();
    let refused = done(run).fails(2).stderr;
    assert!(
        refused.starts_with("error: SABI_LOG takes a filter such as "),
        "{refused}"
    );
    let arguments = ["nodes", "--log", "sabi=loud"];
    let run = place.command(&arguments).env("SABI_LOG", "debug").output().unwrap();
    let refused = done(run).fails(2).stderr;
    assert!(refused.starts_with("error: --log takes a filter such as "), "{refused}");
}
