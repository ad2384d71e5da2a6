//! Arguments of `sabi presets`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

/// Arguments of `sabi presets`.
#[derive(Debug, Args)]
#[command(before_help = "\
Examples:
  sabi presets list
  sabi presets show unity
  sabi presets show unity --toml > studio.toml
  sabi presets check studio.toml")]
pub(crate) struct PresetsArguments {
    #[command(subcommand)]
    pub(crate) command: PresetsCommand,
}

/// Command of `sabi presets`.
#[derive(Debug, Subcommand)]
pub(crate) enum PresetsCommand {
    /// List the presets that come with Sabi and those of your settings folder
    List {
        /// Print as JSON
        #[arg(long)]
        json: bool,
    },
    /// Show the files of a preset and what they are packed of
    Show {
        /// Name of a preset, or a .toml file
        #[arg(value_name = "NAME")]
        name: String,
        /// Print its file, to begin one of your own with
        #[arg(long, conflicts_with = "json")]
        toml: bool,
        /// Print as JSON
        #[arg(long)]
        json: bool,
    },
    /// Check preset files, then end with 65 if one of them cannot be used
    Check {
        /// Preset files (.toml)
        #[arg(value_name = "FILE", required = true)]
        files: Vec<PathBuf>,
    },
}

impl PresetsCommand {
    /// Returns whether it prints JSON.
    pub(crate) fn prints_json(&self) -> bool {
        match self {
            PresetsCommand::List { json } | PresetsCommand::Show { json, .. } => *json,
            PresetsCommand::Check { .. } => false,
        }
    }
}
