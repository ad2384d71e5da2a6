//! The help, and command lines that cannot be understood.

use crate::cli_folder::CliFolder;

#[test]
fn every_help_starts_from_examples() {
    let place = CliFolder::new();
    for command in [
        "", "bake", "edit", "preview", "render", "check", "info", "nodes", "mesh", "pack", "unpack", "doctor", "plan",
        "run",
    ] {
        for flag in ["--help", "-h"] {
            let arguments: Vec<&str> = [command, flag].into_iter().filter(|word| !word.is_empty()).collect();
            let help = place.sabi(&arguments).good();
            assert!(
                help.stdout
                    .starts_with(format!("Examples:\n  sabi {command}").trim_end()),
                "{command}: {}",
                help.stdout
            );
            assert!(help.stdout.contains("Usage: sabi"), "{command}: {}", help.stdout);
            assert_eq!(help.stderr, "");
        }
    }
}

#[test]
fn the_examples_of_the_help_are_command_lines_that_are_understood() {
    let place = CliFolder::new();
    for command in [
        "bake", "edit", "preview", "render", "check", "info", "nodes", "mesh", "pack", "unpack", "doctor", "plan",
        "run",
    ] {
        let help = place.sabi(&[command, "--help"]).good().stdout;
        let examples = help.lines().skip(1).take_while(|line| line.starts_with("  sabi "));
        for example in examples {
            let words: Vec<&str> = example
                .split("     ")
                .next()
                .unwrap()
                .split_whitespace()
                .skip(1)
                .collect();
            let run = place.sabi(&words);
            assert!(!run.stderr.contains("Usage:"), "{example}: {}", run.stderr);
        }
    }
}

#[test]
fn a_command_line_that_makes_no_sense_ends_with_2() {
    let place = CliFolder::new();
    let bake = ["bake", "clouds.sabi", "--mesh", "cube.glb", "-o", "out"];
    let wrong: [&[&str]; 10] = [
        &["--size", "15"],
        &["--size", "8193"],
        &["--fit", "0"],
        &["--scale", "nan"],
        &["--padding", "-1"],
        &["--overlap", "mean"],
        &["--seams", "blur"],
        &["--up", "w"],
        &["--budget", "0"],
        &["--colour"],
    ];
    for more in wrong {
        let run = place.sabi(&[&bake, more].concat()).fails(2);
        assert_eq!(run.stdout, "");
        assert!(run.stderr.starts_with("error: "), "{}", run.stderr);
        assert!(!place.path("out").exists());
    }
    for nothing in ["bake", "check", "render"] {
        assert_eq!(place.sabi(&[nothing]).fails(2).stdout, "");
    }
}

#[test]
fn a_word_that_is_no_command_is_taken_for_a_graph() {
    let run = CliFolder::new().sabi(&["rust"]).fails(66);
    assert_eq!(run.stderr, "error: rust: there is no such file; check the path\n");
}

#[test]
#[cfg(target_os = "linux")]
fn without_a_display_the_editor_says_what_can_be_done() {
    let run = CliFolder::new().sabi(&[]).fails(4);
    assert_eq!(
        run.stderr,
        "error: there is no display to open a window on: neither WAYLAND_DISPLAY nor DISPLAY is set; use sabi bake, preview \
         and render, which need none\n"
    );
}

#[test]
fn the_version_is_data() {
    let version = CliFolder::new().sabi(&["--version"]).good();
    assert_eq!(version.stdout, format!("sabi {}\n", env!("CARGO_PKG_VERSION")));
}
