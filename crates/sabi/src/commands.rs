//! The commands, one file each.

mod bake;
mod check;
mod doctor;
mod edit;
mod info;
mod mesh;
mod nodes;
mod pack;
mod paint;
mod plan;
mod presets;
mod preview;
mod render;
mod run;
mod unpack;
mod value_text;
mod verify;

use sabi_files::TrustedPaths;

use crate::arguments::Command;
use crate::exit::{Exit, Failure};
use crate::terminal::Terminal;

/// Runs a command. Graphs and models may open the files that they name in folders below `trusted`.
pub(crate) fn run(command: Command, trusted: &TrustedPaths, terminal: &Terminal) -> Result<Exit, Failure> {
    match command {
        Command::Edit(arguments) => edit::run(&arguments, trusted),
        Command::Bake(arguments) => bake::run(&arguments, trusted, terminal),
        Command::Preview(arguments) => preview::run(&arguments, trusted, terminal),
        Command::Render(arguments) => render::run(&arguments, trusted, terminal),
        Command::Check(arguments) => check::run(&arguments, trusted, terminal),
        Command::Info(arguments) => info::run(&arguments, trusted, terminal),
        Command::Nodes(arguments) => nodes::run(&arguments, trusted, terminal),
        Command::Presets(arguments) => presets::run(&arguments, terminal),
        Command::Mesh(arguments) => mesh::run(arguments, trusted, terminal),
        Command::Paint(arguments) => paint::run(&arguments, trusted, terminal),
        Command::Plan(arguments) => plan::run(&arguments, trusted, terminal),
        Command::Run(arguments) => run::run(&arguments, trusted, terminal),
        Command::Pack(arguments) => pack::run(&arguments, trusted, terminal),
        Command::Unpack(arguments) => unpack::run(&arguments, terminal),
        Command::Verify(arguments) => verify::run(&arguments, terminal),
        Command::Doctor(arguments) => doctor::run(&arguments, terminal),
    }
}
