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
pub(crate) mod presets;
mod preview;
mod render;
pub(crate) mod run;
mod unpack;
mod value_text;
mod verify;

use sabi_files::TrustedPaths;

use crate::arguments::CliCommand;
use crate::exit::{Exit, Failure};
use crate::terminal::Terminal;

/// Runs a command. Graphs and models may open the files that they name in folders below `trusted`.
pub(crate) fn run(command: CliCommand, trusted: &TrustedPaths, terminal: &Terminal) -> Result<Exit, Failure> {
    match command {
        CliCommand::Edit(arguments) => edit::run(&arguments, trusted),
        CliCommand::Bake(arguments) => bake::run(&arguments, trusted, terminal),
        CliCommand::Preview(arguments) => preview::run(&arguments, trusted, terminal),
        CliCommand::Render(arguments) => render::run(&arguments, trusted, terminal),
        CliCommand::Check(arguments) => check::run(&arguments, trusted, terminal),
        CliCommand::Info(arguments) => info::run(&arguments, trusted, terminal),
        CliCommand::Nodes(arguments) => nodes::run(&arguments, trusted, terminal),
        CliCommand::Presets(arguments) => presets::run(&arguments, terminal),
        CliCommand::Mesh(arguments) => mesh::run(arguments, trusted, terminal),
        CliCommand::Paint(arguments) => paint::run(&arguments, trusted, terminal),
        CliCommand::Plan(arguments) => plan::run(&arguments, trusted, terminal),
        CliCommand::Run(arguments) => run::run(&arguments, trusted, terminal),
        CliCommand::Pack(arguments) => pack::run(&arguments, trusted, terminal),
        CliCommand::Unpack(arguments) => unpack::run(&arguments, terminal),
        CliCommand::Verify(arguments) => verify::run(&arguments, terminal),
        CliCommand::Doctor(arguments) => doctor::run(&arguments, terminal),
    }
}
