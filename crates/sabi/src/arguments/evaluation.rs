//! Arguments of a graph on a model, shared by the commands that evaluate.

use std::convert::Infallible;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use sabi_engine::evaluating::EvaluatorOptions;
use sabi_engine::opening::linked_model::{ModelOptions, Overlap, SavedReading};
use sabi_engine::opening::{SetFile, default_cache_dir, default_memory_bytes, read_setting};
use sabi_engine::source::without_paint;
use sabi_files::{TrustedPaths, absolute};
use sabi_gpu::{AdapterChoice, CasterChoice, DEFAULT_BUDGET_BYTES};
use sabi_graph::{Fit, Overrides};
use sabi_surface::atlas::Udim;
use sabi_surface::load::{PartChoice, Up};

use super::model_file;
use crate::exit::{Exit, Failure};
use crate::graph_argument::GraphArgument;

/// Size of maps.
#[derive(Debug, Args)]
pub(crate) struct MapArguments {
    /// Texels along a side of the maps, 16 to 8192
    #[arg(long, value_name = "N", default_value_t = 1024,
          value_parser = clap::value_parser!(u32).range(16..=8192))]
    pub(crate) size: u32,
}

/// Options for reading a model that a graph may have for its own.
#[derive(Debug, Args)]
pub(crate) struct ReadingArguments {
    /// Only these parts of the model, by their names or those of nodes above them, whatever these mean; * stands for any text and ?
    /// for one letter, so '*' for all of them. Without it, collision hulls and coarser levels of detail are left out by their names
    #[arg(long, value_name = "NAMES", value_delimiter = ',', help_heading = "Model")]
    parts: Vec<String>,
    /// Leave these parts of the model out, by their names; * and ? as for --parts
    #[arg(long, value_name = "NAMES", value_delimiter = ',', help_heading = "Model")]
    without: Vec<String>,
    /// Turn faces that are inside out: against the faces around them, or inward on a closed body
    #[arg(long, help_heading = "Model")]
    turn_faces: bool,
    /// Leave faces that are inside out as they are, even if the graph turns those of its model
    #[arg(long, conflicts_with = "turn_faces", help_heading = "Model")]
    no_turn_faces: bool,
    /// Folder in which, and below which, files are looked for by their names that the model names and that are not there, such as
    /// its pictures
    #[arg(long, value_name = "DIR", help_heading = "Model")]
    textures: Option<PathBuf>,
}

impl ReadingArguments {
    /// Paths from which the model may open what it names: these, and the folder for its textures, which the user names.
    pub(crate) fn trusted(&self, trusted: &TrustedPaths) -> TrustedPaths {
        let textures = self.textures.iter();
        textures.fold(trusted.clone(), |trusted, folder| trusted.with_path(folder))
    }

    /// Options of the engine. Where they say nothing, a graph decides that names the model.
    pub(crate) fn reading(&self) -> SavedReading {
        SavedReading {
            parts: PartChoice {
                parts: self.parts.clone(),
                without: self.without.clone(),
            },
            turn_faces: match (self.turn_faces, self.no_turn_faces) {
                (true, _) => Some(true),
                (false, true) => Some(false),
                (false, false) => None,
            },
            textures: self.textures.as_deref().map(absolute),
        }
    }
}

/// Options for reading a model.
#[derive(Debug, Args)]
pub(crate) struct ModelArguments {
    /// Axis of the file that points up; FBX and Collada files say it themselves, and are turned by this on top of that
    #[arg(long, value_enum, default_value_t = AxisArgument::Y, help_heading = "Model")]
    pub(crate) up: AxisArgument,
    /// Multiply all lengths of the file
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = above_zero, help_heading = "Model")]
    pub(crate) scale: f32,
    /// Smooth the shading between faces that turn by less than this, degrees from 0 (all flat) to 180 (all smooth), in place of the
    /// normals of the file: 30 to 60 for models that come with flat faces
    #[arg(long, value_name = "ANGLE", value_parser = smoothing_angle, help_heading = "Model")]
    pub(crate) smooth: Option<f32>,
    #[command(flatten)]
    pub(crate) reading: ReadingArguments,
    /// Scene of a glTF file, by its number from 0 on; without it the one that the file names
    #[arg(long, value_name = "N", help_heading = "Model")]
    pub(crate) scene: Option<u32>,
    /// UV set of the file: TEXCOORD_N of glTF, the N-th of a mesh in FBX and Collada, counted from 0
    #[arg(long, value_name = "N", default_value_t = 0, help_heading = "Model")]
    pub(crate) uv: u32,
    /// Result for mirrored, stacked or repeating UVs: that of the first chart (first), the mean (merge), a second UV set for the whole
    /// model (unwrap), or that of the first chart and a second UV set for materials whose UVs repeat more than eight times (auto)
    #[arg(long, value_enum, default_value_t = OverlapChoice::Auto, help_heading = "Model")]
    pub(crate) overlap: OverlapChoice,
    /// UVs in several tiles: UDIM with maps for each tile (on), a texture that repeats (off), or UDIM unless charts span tiles,
    /// most lie alike in different tiles, tiles have no UDIM number, or a texture of the model repeats (auto)
    #[arg(long, value_enum, default_value_t = UdimChoice::Auto, help_heading = "Model")]
    pub(crate) udim: UdimChoice,
    /// Memory for the files of the model, its pictures and its layout on the maps, and for textures where the driver runs on the
    /// processor, MiB; half of this machine's if it is not given. A model that takes more is refused, and pictures that do not fit are
    /// left out
    #[arg(long, value_name = "MIB", value_parser = clap::value_parser!(u64).range(16..=1 << 30), help_heading = "Model")]
    memory: Option<u64>,
    /// Neither take anything from the disk cache nor keep anything there
    #[arg(long, help_heading = "Model")]
    pub(crate) no_cache: bool,
}

impl ModelArguments {
    /// Memory for a model, bytes.
    pub(crate) fn memory_bytes(&self) -> u64 {
        self.memory.map_or_else(default_memory_bytes, |mib| mib << 20)
    }

    /// Folder of the disk cache, if it is used.
    pub(crate) fn cache_dir(&self) -> Option<PathBuf> {
        if self.no_cache { None } else { default_cache_dir() }
    }

    /// Options of the engine, with maps of `size` texels along a side. The model may open what it names below `trusted`.
    pub(crate) fn options(&self, path: PathBuf, trusted: &TrustedPaths, size: u32) -> ModelOptions {
        ModelOptions {
            trusted: self.reading.trusted(trusted).with_file(&path),
            uv: self.uv,
            up: match self.up {
                AxisArgument::X => Up::X,
                AxisArgument::Y => Up::Y,
                AxisArgument::Z => Up::Z,
            },
            scale: self.scale,
            scene: self.scene,
            smooth_degrees: self.smooth,
            reading: self.reading.reading(),
            overlap: match self.overlap {
                OverlapChoice::Auto => Overlap::Auto,
                OverlapChoice::First => Overlap::First,
                OverlapChoice::Merge => Overlap::Merge,
                OverlapChoice::Unwrap => Overlap::Unwrap,
            },
            udim: match self.udim {
                UdimChoice::Auto => Udim::Auto,
                UdimChoice::On => Udim::On,
                UdimChoice::Off => Udim::Off,
            },
            cache_dir: self.cache_dir(),
            memory_bytes: self.memory_bytes(),
            ..ModelOptions::new(&path, size)
        }
    }
}

/// Options of the machine that evaluates.
#[derive(Debug, Args)]
pub(crate) struct MachineArguments {
    /// Adapter to run on: auto, cpu, gpu, or a part of its name
    #[arg(long, value_name = "ADAPTER", default_value = "auto", value_parser = adapter, help_heading = "Machine")]
    pub(crate) adapter: AdapterChoice,
    /// Caster of rays: the graphics card (gpu), the processor (cpu), or the faster of the two (auto)
    #[arg(long, value_name = "auto|gpu|cpu", default_value = "auto", help_heading = "Machine")]
    pub(crate) caster: CasterChoice,
    /// Budget for textures, MiB; with a driver that runs on the processor --memory limits them as well
    #[arg(long, value_name = "MIB", default_value_t = DEFAULT_BUDGET_BYTES >> 20,
          value_parser = clap::value_parser!(u64).range(16..=1 << 20), help_heading = "Machine")]
    budget: u64,
}

impl MachineArguments {
    /// Budget for textures, bytes.
    pub(crate) fn budget_bytes(&self) -> u64 {
        self.budget << 20
    }
}

/// A graph and the model that it is evaluated on.
#[derive(Debug, Args)]
pub(crate) struct SubjectArguments {
    /// Graph file (.sabi); - is standard input
    #[arg(value_name = "GRAPH")]
    pub(crate) graph: GraphArgument,
    #[arg(long, value_name = "FILE", help = model_file(""))]
    pub(crate) mesh: PathBuf,
}

/// Options for evaluating a graph on a model.
#[derive(Debug, Args)]
pub(crate) struct EvaluationArguments {
    #[command(flatten)]
    pub(crate) model: ModelArguments,
    /// Set an exposed knob or node.param; may be repeated, the last one wins
    #[arg(long, value_name = "NAME=VALUE", help_heading = "Graph")]
    set: Vec<String>,
    /// Take variant, seed and values from a TOML file: variant = "heavy", seed = 7, and amount = 0.8 or node.param = 1 below
    /// `set`. What the command line says wins; may be repeated, the last one wins
    #[arg(long, value_name = "FILE", help_heading = "Graph")]
    set_file: Vec<PathBuf>,
    /// Variant of the graph to start from
    #[arg(long, value_name = "NAME", help_heading = "Graph")]
    variant: Option<String>,
    /// Seed in place of the graph's
    #[arg(long, value_name = "N", value_parser = seed, help_heading = "Graph")]
    seed: Option<u32>,
    /// Leave out what is painted by hand
    #[arg(long, help_heading = "Graph")]
    no_paint: bool,
    /// Length that counts as 1: the largest side (unit), one metre (metres), or a length in metres
    #[arg(long, value_name = "unit|metres|LENGTH", value_parser = fit, help_heading = "Model")]
    fit: Option<Fit>,
    /// Only the maps of this material of the model
    #[arg(long, value_name = "NAME", help_heading = "Model")]
    pub(crate) material: Option<String>,
    #[command(flatten)]
    machine: MachineArguments,
}

impl EvaluationArguments {
    /// Options of the engine, with maps of `size` texels along a side. The model may open what it names below `trusted`.
    pub(crate) fn options(&self, mesh: &Path, trusted: &TrustedPaths, size: u32) -> Result<EvaluatorOptions, Failure> {
        Ok(EvaluatorOptions {
            model: self.model.options(mesh.to_owned(), trusted, size),
            overrides: self.overrides()?,
            fit: self.fit,
            adapter: self.machine.adapter.clone(),
            caster: self.machine.caster,
            budget_bytes: self.machine.budget_bytes(),
        })
    }

    /// Budget for textures, bytes.
    pub(crate) fn budget_bytes(&self) -> u64 {
        self.machine.budget_bytes()
    }

    /// Files of values that the command line names.
    pub(crate) fn set_files(&self) -> impl Iterator<Item = &Path> {
        self.set_file.iter().map(PathBuf::as_path)
    }

    /// Settings on top of the graph: those of files in their order, and then those of the command line.
    fn overrides(&self) -> Result<Overrides, Failure> {
        let mut overrides = Overrides {
            left_out: self.no_paint.then(without_paint).into_iter().collect(),
            fit: self.fit,
            ..Overrides::default()
        };
        let mut failure: Option<Failure> = None;
        let mut fail = |other: Failure| match &mut failure {
            None => failure = Some(other),
            Some(first) => first.messages.extend(other.messages),
        };
        for path in &self.set_file {
            let file = match SetFile::open(path) {
                Ok(file) => file,
                Err(error) => {
                    fail(error.into());
                    continue;
                }
            };
            overrides.variant = file.variant.or(overrides.variant);
            overrides.seed = file.seed.or(overrides.seed);
            overrides.set.extend(file.set);
        }
        overrides.variant = self.variant.clone().or(overrides.variant);
        overrides.seed = self.seed.or(overrides.seed);
        for text in &self.set {
            match read_setting(text) {
                Ok(setting) => overrides.set.push(setting),
                Err(why) => fail(Failure::new(Exit::Usage, format!("--set: {why}"))),
            }
        }
        match failure {
            None => Ok(overrides),
            Some(failure) => Err(failure),
        }
    }
}

/// Axis of a model file.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum AxisArgument {
    Y,
    Z,
    X,
}

/// Result for charts that share a place on the maps.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum OverlapChoice {
    Auto,
    First,
    Merge,
    Unwrap,
}

/// Treatment of UVs in several tiles.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum UdimChoice {
    Auto,
    On,
    Off,
}

fn seed(text: &str) -> Result<u32, String> {
    let takes = || format!("it takes a whole number from 0 to {}", u32::MAX);
    text.parse().map_err(|_| takes())
}

fn above_zero(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err("it takes a number above 0".to_owned()),
    }
}

fn smoothing_angle(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(degrees) if (0.0..=180.0).contains(&degrees) => Ok(degrees),
        _ => Err("it takes an angle in degrees, from 0 (all flat) to 180 (all smooth)".to_owned()),
    }
}

fn fit(text: &str) -> Result<Fit, String> {
    match text {
        "unit" => Ok(Fit::Unit),
        "metres" | "meters" => Ok(Fit::Metres),
        "piece" => Ok(Fit::Piece),
        number => match number.parse::<f64>() {
            Ok(length) if length.is_finite() && length > 0.0 => Ok(Fit::Length(length)),
            _ => Err("it takes 'unit', 'metres', 'piece' or a length above 0".to_owned()),
        },
    }
}

fn adapter(text: &str) -> Result<AdapterChoice, Infallible> {
    text.parse()
}

#[cfg(test)]
mod tests {
    use sabi_graph::Fit;

    use super::{above_zero, fit, smoothing_angle};

    #[test]
    fn a_smoothing_angle_is_one_between_faces() {
        for (text, degrees) in [("0", 0.0), ("30", 30.0), ("62.5", 62.5), ("180", 180.0)] {
            assert_eq!(smoothing_angle(text), Ok(degrees));
        }
        for text in ["-1", "180.1", "nan", "inf", "round", ""] {
            let why = smoothing_angle(text).unwrap_err();
            assert_eq!(
                why, "it takes an angle in degrees, from 0 (all flat) to 180 (all smooth)",
                "{text}"
            );
        }
    }

    #[test]
    fn a_fit_is_a_word_or_a_length() {
        assert_eq!(fit("unit"), Ok(Fit::Unit));
        assert_eq!(fit("metres"), Ok(Fit::Metres));
        assert_eq!(fit("0.25"), Ok(Fit::Length(0.25)));
        for text in ["0", "-1", "nan", "inf", "1e999", "large", ""] {
            assert!(fit(text).is_err(), "{text}");
            assert!(above_zero(text).is_err(), "{text}");
        }
    }
}
