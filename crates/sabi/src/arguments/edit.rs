//! Arguments of `sabi edit`.

use std::path::PathBuf;

use clap::Args;
use sabi_gpu::AdapterChoice;

use super::model_file;
use crate::graph_argument::GraphArgument;

/// Arguments of `sabi edit`.
#[derive(Debug, Args)]
#[command(before_help = "\
Examples:
  sabi edit
  sabi edit graph.sabi
  sabi edit graph.sabi --mesh model.glb")]
pub(crate) struct EditArguments {
    /// Graph file (.sabi); without one, an empty graph
    #[arg(value_name = "GRAPH")]
    pub(crate) graph: Option<GraphArgument>,
    #[arg(long, value_name = "FILE", help = model_file(", in place of the one that the graph names"))]
    pub(crate) mesh: Option<PathBuf>,
    /// Adapter to run on: auto, cpu, gpu, or a part of its name
    #[arg(long, value_name = "NAME", default_value = "auto")]
    pub(crate) adapter: AdapterChoice,
}
