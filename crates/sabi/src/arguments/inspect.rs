//! Arguments of the commands that write no file: `check`, `info`, `nodes`, `mesh`, `verify`, `doctor`.

use std::path::PathBuf;

use clap::Args;

use super::{MapArguments, ModelArguments, model_file};
use crate::graph_argument::GraphArgument;

/// Arguments of `sabi check`.
#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    before_help = "\
Examples:
  sabi check graph.sabi
  sabi check graphs/*.sabi --json",
    after_help = "Checks all files, then ends with 65 if one of them has an error, or with --strict a warning."
)]
pub(crate) struct CheckArguments {
    /// Graph files (.sabi); - is standard input
    #[arg(value_name = "GRAPH", required = true)]
    pub(crate) graphs: Vec<GraphArgument>,
    /// Let warnings count as errors
    #[arg(long)]
    pub(crate) strict: bool,
    /// Print what was found as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Arguments of `sabi info`.
#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    before_help = "\
Examples:
  sabi info graph.sabi
  sabi info graph.sabi --json",
    after_help = "Needs neither a model nor an adapter."
)]
pub(crate) struct InfoArguments {
    /// Graph file (.sabi); - is standard input
    #[arg(value_name = "GRAPH")]
    pub(crate) graph: GraphArgument,
    /// Print as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Arguments of `sabi nodes`.
#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    before_help = "\
Examples:
  sabi nodes
  sabi nodes noise/simplex
  sabi nodes --graph graph.sabi --json"
)]
pub(crate) struct NodesArguments {
    /// Describe this kind of node
    #[arg(value_name = "ID")]
    pub(crate) id: Option<String>,
    /// Also take the kinds in the folder 'nodes' beside this graph
    #[arg(long, value_name = "GRAPH")]
    pub(crate) graph: Option<PathBuf>,
    /// Print as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Arguments of `sabi mesh`.
#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    before_help = "\
Examples:
  sabi mesh model.glb
  sabi mesh model.obj --up z --size 2048 --json"
)]
pub(crate) struct MeshArguments {
    #[arg(value_name = "FILE", help = model_file(""))]
    pub(crate) mesh: PathBuf,
    #[command(flatten)]
    pub(crate) model: ModelArguments,
    #[command(flatten)]
    pub(crate) maps: MapArguments,
    /// Print as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Arguments of `sabi verify`.
#[derive(Debug, Args)]
#[command(
    before_help = "\
Examples:
  sabi verify out
  sabi verify out/* --json",
    after_help = "\
Finds files that are missing or were changed, maps whose graph, model or pictures have changed since,
files that no bake wrote, and what killed bakes left. Ends with 3 if it finds any, and with 65
or 66 if a folder cannot be checked; the others are checked all the same."
)]
pub(crate) struct VerifyArguments {
    /// Folders that maps were baked into
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,
    /// Print what was found as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Arguments of `sabi doctor`.
#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    before_help = "\
Examples:
  sabi doctor
  sabi doctor --json",
    after_help = "Ends with 4 if no adapter can be used."
)]
pub(crate) struct DoctorArguments {
    /// Print as JSON
    #[arg(long)]
    pub(crate) json: bool,
}
