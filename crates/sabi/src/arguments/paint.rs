//! Arguments of `sabi paint`: files of strokes.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::{ModelArguments, model_file};
use crate::graph_argument::GraphArgument;

/// Arguments of `sabi paint`.
#[derive(Debug, Args)]
pub(crate) struct PaintArguments {
    /// Command about strokes
    #[command(subcommand)]
    pub(crate) command: PaintCommand,
}

/// Command about strokes.
#[derive(Debug, Subcommand)]
pub(crate) enum PaintCommand {
    /// Describe a file of strokes
    Info(PaintInfoArguments),
    /// Drop the history of the strokes beside a graph
    Flatten(PaintFlattenArguments),
    /// Lay strokes on another model, or on an edited one
    Reproject(PaintReprojectArguments),
}

impl PaintCommand {
    /// Returns whether it prints JSON.
    pub(crate) fn prints_json(&self) -> bool {
        match self {
            PaintCommand::Info(arguments) => arguments.json,
            PaintCommand::Flatten(arguments) => arguments.json,
            PaintCommand::Reproject(arguments) => arguments.json,
        }
    }
}

/// Arguments of `sabi paint info`.
#[derive(Debug, Args)]
#[command(before_help = "\
Examples:
  sabi paint info graph.paint/model.strokes
  sabi paint info graph.paint/model.strokes --json")]
pub(crate) struct PaintInfoArguments {
    /// File of strokes (.strokes)
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// Print as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Arguments of `sabi paint flatten`.
#[derive(Debug, Args)]
#[command(before_help = "\
Examples:
  sabi paint flatten graph.sabi --dry-run
  sabi paint flatten graph.sabi")]
pub(crate) struct PaintFlattenArguments {
    /// Graph file (.sabi)
    #[arg(value_name = "GRAPH")]
    pub(crate) graph: GraphArgument,
    /// Say what would be saved, and write nothing
    #[arg(long)]
    pub(crate) dry_run: bool,
    /// Print as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Arguments of `sabi paint reproject`.
#[derive(Debug, Args)]
#[command(before_help = "\
Examples:
  sabi paint reproject graph.sabi --mesh edited.glb
  sabi paint reproject graph.sabi --mesh other.glb --from crate")]
pub(crate) struct PaintReprojectArguments {
    /// Graph file (.sabi)
    #[arg(value_name = "GRAPH")]
    pub(crate) graph: GraphArgument,
    #[arg(long, value_name = "FILE", help = model_file(", on which the strokes are laid"))]
    pub(crate) mesh: PathBuf,
    /// Model that they were painted on: the name of its file without the ending
    #[arg(long, value_name = "NAME")]
    pub(crate) from: Option<String>,
    /// Replace strokes that a node has on the other model already
    #[arg(long)]
    pub(crate) replace: bool,
    #[command(flatten)]
    pub(crate) model: ModelArguments,
    /// Print as JSON
    #[arg(long)]
    pub(crate) json: bool,
}
