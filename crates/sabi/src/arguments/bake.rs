//! Arguments of `sabi bake`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use sabi_engine::baking::{Seams, default_padding};
use sabi_export::CopyOptions;

use super::{EvaluationArguments, MapArguments, model_file};
use crate::graph_argument::GraphArgument;

/// Arguments of `sabi bake` that shape the maps, which a report has already.
const SHAPING: [&str; 35] = [
    "graph",
    "mesh",
    "size",
    "uv",
    "up",
    "scale",
    "scene",
    "smooth",
    "parts",
    "without",
    "turn_faces",
    "no_turn_faces",
    "textures",
    "overlap",
    "udim",
    "set",
    "set_file",
    "variant",
    "seed",
    "no_paint",
    "fit",
    "material",
    "adapter",
    "caster",
    "preset",
    "channel",
    "names",
    "all_maps",
    "copies_model",
    "keep_look",
    "embed",
    "padding",
    "seams",
    "no_fuse",
    "mesh_map",
];

/// Arguments of `sabi bake`.
#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    before_help = "\
Examples:
  sabi bake graph.sabi --mesh model.glb -o out
  sabi bake graph.sabi --mesh model.glb -o out --size 4096 --adapter gpu
  sabi bake graph.sabi --mesh model.glb -o out --variant heavy --set paint.color=#6b3a1e
  sabi bake graph.sabi --mesh model.glb -o out --set-file look.toml
  sabi bake graph.sabi --mesh model.obj -o out --up z --fit metres --report out/report.json
  sabi bake --from out/report.json -o again",
    after_help = "\
Prints the files it wrote, one a line. They replace earlier maps of the same names, but only once
all of them are complete; a map with the same bytes keeps its time stamp. Where all maps of this very
bake are in the folder already, nothing is done. A folder that has files but no earlier maps is
refused without --force; nothing is ever deleted."
)]
pub(crate) struct BakeArguments {
    /// Graph file (.sabi); - is standard input
    #[arg(value_name = "GRAPH", required_unless_present = "from")]
    pub(crate) graph: Option<GraphArgument>,
    #[arg(long, value_name = "FILE", help = model_file(""), required_unless_present = "from")]
    pub(crate) mesh: Option<PathBuf>,
    /// Make the maps of a report again: with all its settings, from the same files, to the same bytes
    #[arg(long, value_name = "REPORT", conflicts_with_all = SHAPING)]
    pub(crate) from: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) evaluation: EvaluationArguments,
    #[command(flatten)]
    pub(crate) maps: MapArguments,
    /// Folder for the maps; it is made if need be
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Preset of the maps to write, by name or as a .toml file; may be repeated. `sabi presets list` shows all; `materialx` and
    /// `usd` write documents that name the maps, too [default: raw]
    #[arg(long, value_name = "NAME", help_heading = "Maps")]
    pub(crate) preset: Vec<String>,
    /// Only maps of this channel, or 'masks', 'colors' or 'vectors' for all outputs of a kind; may be repeated
    #[arg(long, value_name = "NAME", help_heading = "Maps")]
    pub(crate) channel: Vec<String>,
    /// Maps of the model itself beside the others: id, material_id, world_normal, position, bent_normal, ambient_occlusion,
    /// thickness or curvature; may be repeated, or take several with commas
    #[arg(long, value_name = "NAME", value_delimiter = ',', help_heading = "Maps")]
    pub(crate) mesh_map: Vec<String>,
    /// Names of maps in place of those of the presets: text with $map, and with $material, $udim, $size, $graph, $mesh,
    /// $variant, $seed or $preset; a group in parentheses is left out where a word in it stands for nothing
    /// [default: $material_$map(.$udim)]
    #[arg(long, value_name = "PATTERN", help_heading = "Maps")]
    pub(crate) names: Option<String>,
    /// Write maps of constant channels, too, and not only their value in the report
    #[arg(long, help_heading = "Maps")]
    pub(crate) all_maps: bool,
    /// Also write a glTF copy of the model that uses the maps: as .glb or .gltf like the model, else as .glb
    #[arg(long = "model", help_heading = "Maps")]
    pub(crate) copies_model: bool,
    /// Keep unlit, glass, vertex colors and whatever else of the model's look the maps do not replace in its copy
    #[arg(long, requires = "copies_model", help_heading = "Maps")]
    pub(crate) keep_look: bool,
    /// Hold maps, pictures and buffers in the copy itself, with no files beside it
    #[arg(long, requires = "copies_model", help_heading = "Maps")]
    pub(crate) embed: bool,
    /// Padding around charts, texels, or 'infinite' [default: 16 at size 2048]
    #[arg(long, value_name = "N", value_parser = padding, help_heading = "Maps")]
    pub(crate) padding: Option<PaddingArgument>,
    /// Differences of heights and normals between the two sides of a seam: erased, by changing the texels beside it, or kept
    #[arg(long, value_enum, default_value_t = SeamsChoice::Erase, help_heading = "Maps")]
    pub(crate) seams: SeamsChoice,
    /// Bake into a folder that has files but no earlier maps
    #[arg(long, help_heading = "Maps")]
    pub(crate) force: bool,
    /// Bake even where all maps of this very bake are in the folder already
    #[arg(long, help_heading = "Maps")]
    pub(crate) again: bool,
    /// Also write the report to a file, one of a failure as well; - is standard output
    #[arg(long, value_name = "FILE", help_heading = "Report")]
    pub(crate) report: Option<PathBuf>,
    /// Print the report instead of the list of files
    #[arg(long, help_heading = "Report")]
    pub(crate) json: bool,
    /// Run every node in a pass of its own, to compare
    #[arg(long, help_heading = "Machine")]
    pub(crate) no_fuse: bool,
}

impl BakeArguments {
    /// Options of the copy of the model; none where no copy is asked for.
    pub(crate) fn copy_options(&self) -> Option<CopyOptions> {
        self.copies_model.then_some(CopyOptions {
            keeps_look: self.keep_look,
            embeds: self.embed,
        })
    }

    /// Returns whether the report is printed on standard output.
    pub(crate) fn prints_report(&self) -> bool {
        self.json || self.report.as_ref().is_some_and(|path| path.as_os_str() == "-")
    }

    /// Padding around charts, texels; none for padding without limit.
    pub(crate) fn padding_texels(&self) -> Option<u32> {
        match self.padding {
            Some(PaddingArgument::Infinite) => None,
            Some(PaddingArgument::Texels(texels)) => Some(texels),
            None => Some(default_padding(self.maps.size)),
        }
    }
}

/// Treatment of differences at seams.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SeamsChoice {
    Erase,
    Keep,
}

impl From<SeamsChoice> for Seams {
    fn from(choice: SeamsChoice) -> Seams {
        match choice {
            SeamsChoice::Erase => Seams::Erase,
            SeamsChoice::Keep => Seams::Keep,
        }
    }
}

/// Padding around charts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PaddingArgument {
    Infinite,
    Texels(u32),
}

fn padding(text: &str) -> Result<PaddingArgument, String> {
    if text == "infinite" {
        return Ok(PaddingArgument::Infinite);
    }
    match text.parse::<u32>() {
        Ok(texels) if texels <= 8192 => Ok(PaddingArgument::Texels(texels)),
        _ => Err("it takes 0 to 8192 texels, or 'infinite'".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use clap::Args;

    use super::{BakeArguments, SHAPING};

    #[test]
    fn every_argument_either_shapes_the_maps_or_may_stand_beside_a_report() {
        let beside = [
            "from", "output", "force", "again", "report", "json", "no_cache", "budget", "memory",
        ];
        let command = BakeArguments::augment_args(clap::Command::new("bake"));
        let mut known: Vec<&str> = command
            .get_arguments()
            .map(|argument| argument.get_id().as_str())
            .collect();
        let mut expected: Vec<&str> = SHAPING.into_iter().chain(beside).collect();
        known.sort_unstable();
        expected.sort_unstable();
        assert_eq!(known, expected);
    }
}
