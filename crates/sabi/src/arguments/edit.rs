//! `sabi edit`.

use std::path::PathBuf;

use clap::Args;
use sabi_engine::AdapterChoice;

/// What `edit` takes.
#[derive(Debug, Args)]
#[command(before_help = "\
Examples:
  sabi edit
  sabi edit graph.sabi
  sabi edit graph.sabi --mesh model.glb")]
pub(crate) struct EditArguments {
    /// The graph; an empty one if none
    #[arg(value_name = "GRAPH")]
    pub(crate) graph: Option<PathBuf>,
    /// The model, in place of the one that the graph names: .glb, .gltf or .obj
    #[arg(long, value_name = "FILE")]
    pub(crate) mesh: Option<PathBuf>,
    /// Which adapter: auto, cpu, gpu, or a part of its name
    #[arg(long, value_name = "NAME", default_value = "auto")]
    pub(crate) adapter: AdapterChoice,
}
