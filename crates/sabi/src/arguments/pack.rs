//! Arguments of `sabi pack` and `sabi unpack`: a graph with its files in one archive.

use std::path::PathBuf;

use clap::Args;

use super::{ReadingArguments, model_file};
use crate::graph_argument::GraphArgument;

/// Arguments of `sabi pack`.
#[derive(Debug, Args)]
#[command(
    before_help = "\
Examples:
  sabi pack graph.sabi -o graph.zip
  sabi pack graph.sabi --mesh model.glb -o graph.zip
  sabi pack graph.sabi --no-mesh -o graph.zip --force",
    after_help = "\
The archive holds all that a bake of the graph reads: strokes, pictures, group files, own node files and
the model with its textures. Files below the folder of the graph keep their places; others go into the
folder 'files', and the graph in the archive names them there. The graph on the disk is not changed.
The same files give the same archive, byte for byte."
)]
pub(crate) struct PackArguments {
    /// Graph file (.sabi)
    #[arg(value_name = "GRAPH")]
    pub(crate) graph: GraphArgument,
    /// Archive to write (.zip)
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    #[arg(long, value_name = "FILE", conflicts_with = "no_mesh", help = model_file(", in place of the one that the graph names"))]
    pub(crate) mesh: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) reading: ReadingArguments,
    /// Leave the model out
    #[arg(long)]
    pub(crate) no_mesh: bool,
    /// Pack without files that are missing, and warn about them
    #[arg(long)]
    pub(crate) allow_missing: bool,
    /// Replace the archive if it exists
    #[arg(long)]
    pub(crate) force: bool,
    /// Print what was packed as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Arguments of `sabi unpack`.
#[derive(Debug, Args)]
#[command(
    before_help = "\
Examples:
  sabi unpack graph.zip
  sabi unpack graph.zip -o folder",
    after_help = "\
Prints the path of the graph. The folder is new or empty; an archive that is damaged, or that would write
anywhere else, leaves nothing behind."
)]
pub(crate) struct UnpackArguments {
    /// Archive of 'sabi pack' (.zip)
    #[arg(value_name = "FILE")]
    pub(crate) archive: PathBuf,
    /// Folder for the files [default: the name of the archive without its ending]
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
    /// Print what was unpacked as JSON
    #[arg(long)]
    pub(crate) json: bool,
}
