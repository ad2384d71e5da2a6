//! `cargo xtask demo`: from a fresh clone to a baked texture set and a picture.

use xtask::project::{Project, TaskError, finish};
use xtask::vulkan::{self, Driver};

const GRAPH: &str = "graphs/examples/army-paint.sabi";
const MODEL: &str = "assets/meshes/crate.glb";
const FOLDER: &str = "out/army-paint";
const REPORT: &str = "out/army-paint/report.json";
const PICTURE: &str = "out/army-paint.png";

const BAKE: &str = "--size 2048";
const RENDER: &str = "--texels 2048 --size 1920x1080";

/// Sets up, builds, bakes and draws; `sabi` itself prints what it wrote.
pub(crate) fn run(project: &Project) -> Result<(), TaskError> {
    vulkan::ensure(project, Driver::Any)?;
    eprintln!("Building sabi in release; the first time takes some minutes.");
    // Without the editor, most of the code is not compiled; the demo only bakes and draws.
    let build = "build --release --locked --package sabi --no-default-features";
    let build: Vec<&str> = build.split(' ').collect();
    finish(project.cargo(&build)?, "Building sabi")?;
    sabi(project, "bake", BAKE, &["-o", FOLDER, "--report", REPORT], "The bake")?;
    sabi(project, "render", RENDER, &["-o", PICTURE], "The picture")?;
    eprintln!("\nEverything about this bake: {REPORT}");
    eprintln!("The crate in the studio: {PICTURE}");
    eprintln!("To work on it in the editor: cargo run --release --package sabi -- {GRAPH}");
    Ok(())
}

/// Runs a command of `sabi` on the crate.
fn sabi(project: &Project, name: &str, options: &str, output: &[&str], what: &str) -> Result<(), TaskError> {
    let mut arguments = vec![name, GRAPH, "--mesh", MODEL];
    arguments.extend(options.split(' '));
    arguments.extend(output);
    eprintln!("\n$ sabi {}", arguments.join(" "));
    let mut command = project.command(&project.sabi("release"))?;
    command.args(arguments);
    finish(command, what)
}
