//! Arguments of the command line.

mod bake;
mod batch;
mod edit;
mod evaluation;
mod inspect;
mod pack;
mod paint;
mod presets;
mod preview;
mod render;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use sabi_files::TrustedPaths;
use sabi_surface::load::MODEL_ENDINGS;

pub(crate) use bake::BakeArguments;
pub(crate) use batch::{PlanArguments, PlanFormat, RunArguments};
pub(crate) use edit::EditArguments;
pub(crate) use evaluation::{EvaluationArguments, MapArguments, ModelArguments, ReadingArguments, SubjectArguments};
pub(crate) use inspect::{
    CheckArguments, DoctorArguments, InfoArguments, MeshArguments, NodesArguments, VerifyArguments,
};
pub(crate) use pack::{PackArguments, UnpackArguments};
pub(crate) use paint::{
    PaintArguments, PaintCommand, PaintFlattenArguments, PaintInfoArguments, PaintReprojectArguments,
};
pub(crate) use presets::{PresetsArguments, PresetsCommand};
pub(crate) use preview::PreviewArguments;
pub(crate) use render::RenderArguments;

use crate::exit::{Exit, Failure};

/// Procedural, aging materials on real models: an editor for node graphs, and what bakes them into PBR texture sets.
#[derive(Debug, Parser)]
#[command(
    name = "sabi",
    version,
    args_conflicts_with_subcommands = true,
    before_help = "\
Examples:
  sabi
  sabi graph.sabi --mesh model.glb
  sabi bake graph.sabi --mesh model.glb -o out
  sabi bake graph.sabi --mesh model.glb -o out --size 2048 --variant heavy --set amount=0.8
  sabi preview graph.sabi --mesh model.glb --node edges -o edges.png
  sabi render graph.sabi --mesh model.glb -o picture.png
  sabi verify out
  sabi check graphs/*.sabi
  sabi info graph.sabi
  sabi pack graph.sabi -o graph.zip
  sabi nodes noise/simplex
  sabi presets show unity
  sabi mesh model.glb
  sabi plan matrix.toml
  sabi run plan.jsonl
  sabi doctor",
    after_help = "\
Exit codes: 0 done, 1 some items of a plan failed, 2 wrong command line, 3 not as recorded,
4 no usable adapter, 65 bad input, 66 input missing, 70 a defect of Sabi, 73 cannot write,
130 interrupted, 143 terminated"
)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    command: Option<CliCommand>,
    #[command(flatten)]
    edit: EditArguments,
    #[command(flatten)]
    pub(crate) global: Global,
}

impl Arguments {
    /// Command to run, and the options for all commands. Without a command, the editor opens.
    pub(crate) fn into_command(self) -> (CliCommand, Global) {
        // Without a command, the editor opens.
        (self.command.unwrap_or(CliCommand::Edit(self.edit)), self.global)
    }
}

/// Arguments of every command.
#[derive(Debug, Args)]
pub(crate) struct Global {
    /// Print nothing but errors, and progress if --progress asks for it
    #[arg(short, long, global = true, help_heading = "Everywhere")]
    pub(crate) quiet: bool,
    /// Progress on standard error: lines (plain), a JSON object a line (json), none, on standard output for Open Job Description (openjd), or bars on a terminal and, in work of more
    /// than a few seconds, lines elsewhere (auto)
    #[arg(
        long,
        global = true,
        value_enum,
        value_name = "auto|plain|json|openjd|none",
        hide_possible_values = true,
        help_heading = "Everywhere"
    )]
    pub(crate) progress: Option<ProgressChoice>,
    /// Show no progress, as --progress none
    #[arg(long, global = true, conflicts_with = "progress", help_heading = "Everywhere")]
    pub(crate) no_progress: bool,
    /// Trust a file or folder: graphs and models may open it although it is outside of their own folders and projects; may be
    /// repeated
    #[arg(long, global = true, value_name = "PATH", help_heading = "Everywhere")]
    pub(crate) trust: Vec<PathBuf>,
    /// Log to standard error with a filter such as 'info' or 'sabi=debug'
    #[arg(long, global = true, value_name = "FILTER", help_heading = "Everywhere")]
    pub(crate) log: Option<String>,
}

impl Global {
    /// Files and folders that the command line trusts.
    ///
    /// # Errors
    /// At least one of them does not exist.
    pub(crate) fn trusted(&self) -> Result<TrustedPaths, Failure> {
        if let Some(missing) = self.trust.iter().find(|path| !path.exists()) {
            let why = format!(
                "--trust: there is no file or folder {}; check the path",
                missing.display()
            );
            return Err(Failure::new(Exit::Usage, why));
        }
        let none = TrustedPaths::default();
        Ok(self.trust.iter().fold(none, |trusted, path| trusted.with_path(path)))
    }
}

/// Form in which progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ProgressChoice {
    Auto,
    Plain,
    Json,
    Openjd,
    None,
}

/// Command of the command line.
#[derive(Debug, Subcommand)]
pub(crate) enum CliCommand {
    /// Open the editor, as without a command
    Edit(EditArguments),
    /// Bake a graph on a model into a PBR texture set
    Bake(BakeArguments),
    /// Write the result of any node, in texture space
    Preview(PreviewArguments),
    /// Draw a lit picture of the model, or several from all around
    Render(RenderArguments),
    /// Check graphs without a model
    Check(CheckArguments),
    /// List what a graph lets be set, its outputs and its files
    Info(InfoArguments),
    /// List the kinds of nodes, or describe one
    Nodes(NodesArguments),
    /// List the presets of maps, show one, or check files of your own
    Presets(PresetsArguments),
    /// Describe a model and its atlas
    Mesh(MeshArguments),
    /// Describe files of strokes
    Paint(PaintArguments),
    /// Turn a matrix of models, graphs and settings into a plan of bakes
    Plan(PlanArguments),
    /// Bake the items of a plan that are not finished
    Run(RunArguments),
    /// Pack a graph with all its files into an archive
    Pack(PackArguments),
    /// Unpack a packed graph
    Unpack(UnpackArguments),
    /// Check folders of maps against what their bakes recorded
    Verify(VerifyArguments),
    /// Tell whether this machine can run Sabi
    Doctor(DoctorArguments),
}

impl CliCommand {
    /// Name of the command on the command line.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            CliCommand::Edit(_) => "edit",
            CliCommand::Bake(_) => "bake",
            CliCommand::Preview(_) => "preview",
            CliCommand::Render(_) => "render",
            CliCommand::Check(_) => "check",
            CliCommand::Info(_) => "info",
            CliCommand::Nodes(_) => "nodes",
            CliCommand::Presets(_) => "presets",
            CliCommand::Mesh(_) => "mesh",
            CliCommand::Paint(_) => "paint",
            CliCommand::Plan(_) => "plan",
            CliCommand::Run(_) => "run",
            CliCommand::Pack(_) => "pack",
            CliCommand::Unpack(_) => "unpack",
            CliCommand::Verify(_) => "verify",
            CliCommand::Doctor(_) => "doctor",
        }
    }
}

impl CliCommand {
    /// Returns whether it prints JSON, and so failures as JSON.
    pub(crate) fn prints_json(&self) -> bool {
        match self {
            CliCommand::Edit(_) | CliCommand::Preview(_) | CliCommand::Render(_) | CliCommand::Plan(_) => false,
            CliCommand::Bake(arguments) => arguments.prints_report(),
            CliCommand::Check(arguments) => arguments.json,
            CliCommand::Info(arguments) => arguments.json,
            CliCommand::Nodes(arguments) => arguments.json,
            CliCommand::Presets(arguments) => arguments.command.prints_json(),
            CliCommand::Mesh(arguments) => arguments.json,
            CliCommand::Paint(arguments) => arguments.command.prints_json(),
            CliCommand::Run(arguments) => arguments.json,
            CliCommand::Pack(arguments) => arguments.json,
            CliCommand::Unpack(arguments) => arguments.json,
            CliCommand::Verify(arguments) => arguments.json,
            CliCommand::Doctor(arguments) => arguments.json,
        }
    }
}

/// Names of all commands.
pub(crate) fn command_names() -> Vec<String> {
    let command = <Arguments as clap::CommandFactory>::command();
    command
        .get_subcommands()
        .map(|known| known.get_name().to_owned())
        .collect()
}

/// Help on an argument that takes a model: the endings of its file, and what follows.
fn model_file(what: &str) -> String {
    let endings: Vec<String> = MODEL_ENDINGS.iter().map(|ending| format!(".{ending}")).collect();
    format!("Model file ({}){what}", endings.join(", "))
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::Arguments;

    #[test]
    fn the_definition_of_the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }
}
