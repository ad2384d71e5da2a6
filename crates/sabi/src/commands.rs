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

use crate::arguments::Command;
use crate::exit::{Exit, Failure};
use crate::terminal::Terminal;

/// Runs a command.
pub(crate) fn run(command: Command, terminal: &Terminal) -> Result<Exit, Failure> {
    match command {
        Command::Edit(arguments) => edit::run(&arguments),
        Command::Bake(arguments) => bake::run(&arguments, terminal),
        Command::Preview(arguments) => preview::run(&arguments, terminal),
        Command::Render(arguments) => render::run(&arguments, terminal),
        Command::Check(arguments) => check::run(&arguments, terminal),
        Command::Info(arguments) => info::run(&arguments, terminal),
        Command::Nodes(arguments) => nodes::run(&arguments, terminal),
        Command::Presets(arguments) => presets::run(&arguments, terminal),
        Command::Mesh(arguments) => mesh::run(arguments, terminal),
        Command::Paint(arguments) => paint::run(&arguments, terminal),
        Command::Plan(arguments) => plan::run(&arguments, terminal),
        Command::Run(arguments) => run::run(&arguments, terminal),
        Command::Pack(arguments) => pack::run(&arguments, terminal),
        Command::Unpack(arguments) => unpack::run(&arguments, terminal),
        Command::Verify(arguments) => verify::run(&arguments, terminal),
        Command::Doctor(arguments) => doctor::run(&arguments, terminal),
    }
}
