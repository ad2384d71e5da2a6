//! `cargo xtask bless KIND`: writes the goldens of a node again; `cargo xtask bless window` the pictures of the window,
//! `cargo xtask bless manual` those of the first graph in the manual, `cargo xtask bless library` the graphs of the effect
//! library, and `cargo xtask bless schema` the JSON schemas of graph files and reports.

use xtask::project::{Project, TaskError, finish};
use xtask::vulkan::{self, Driver};

/// Writes the goldens of a kind or of all, the pictures of the window, or the graphs of the library.
pub(crate) fn run(project: &Project, kind: Option<&str>) -> Result<(), TaskError> {
    let Some(kind) = kind else {
        let advice = "Which node? Say `cargo xtask bless noise/simplex`, `cargo xtask bless all`, `cargo xtask bless window`, \
                      `cargo xtask bless manual`, `cargo xtask bless library`, or `cargo xtask bless schema`.";
        return Err(TaskError::new(2, advice.to_owned()));
    };
    if kind == "schema" {
        let tests = ["test", "--workspace", "--lib", "--bin", "sabi", "the_schema_"];
        let mut command = project.cargo(&tests)?;
        command.env("SABI_BLESS", kind);
        finish(command, "The schemas of graph files and reports")?;
        tell("docs");
        return Ok(());
    }
    vulkan::ensure(project, Driver::Software)?;
    if kind == "window" {
        let tests = ["test", "--workspace", "--lib", "app::tests::snapshots"];
        let mut command = project.cargo(&tests)?;
        command.env("UPDATE_SNAPSHOTS", "true");
        finish(command, "The pictures of the window")?;
        tell("crates/sabi_editor/tests/snapshots");
        return Ok(());
    }
    if kind == "manual" {
        let tests = ["test", "--workspace", "--lib", "app::tests::manual", "--", "--ignored"];
        finish(project.cargo(&tests)?, "The pictures of the manual")?;
        tell("docs/editor");
        return Ok(());
    }
    if kind == "library" {
        let tests = [
            "test",
            "--workspace",
            "--lib",
            "tests::effect_library::every_",
            "--",
            "--test-threads=1",
        ];
        let mut command = project.cargo(&tests)?;
        command.env("SABI_BLESS", kind);
        finish(command, "The graphs of the library")?;
        tell("graphs/library");
        return Ok(());
    }
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
    let mut command = project.cargo(&test)?;
    command.env("SABI_BLESS", kind);
    finish(command, "The goldens")?;
    tell("tests/golden");
    Ok(())
}

fn tell(folder: &str) {
    eprintln!("Written below {folder}: look at what `git diff --stat` lists before you commit it.");
}
