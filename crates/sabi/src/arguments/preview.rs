//! Arguments of `sabi preview`.

use std::path::PathBuf;

use clap::Args;

use super::{EvaluationArguments, MapArguments, SubjectArguments};

/// Arguments of `sabi preview`.
#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    before_help = "\
Examples:
  sabi preview graph.sabi --mesh model.glb --node edges -o edges.png
  sabi preview graph.sabi --mesh model.glb --node cells.id -o id.png --size 512
  sabi preview graph.sabi --mesh model.glb --node rust -o rust.exr      the exact values"
)]
pub(crate) struct PreviewArguments {
    #[command(flatten)]
    pub(crate) subject: SubjectArguments,
    #[command(flatten)]
    pub(crate) evaluation: EvaluationArguments,
    #[command(flatten)]
    pub(crate) maps: MapArguments,
    /// Node to show, and which of its outputs
    #[arg(long, value_name = "ID[.PORT]")]
    pub(crate) node: String,
    /// File to write: .png for a picture, .exr for the exact values
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
}
