//! Arguments of `sabi plan` and `sabi run`: many bakes.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use sabi_batch::ItemMachine;
use sabi_engine::opening::{default_cache_dir, default_memory_bytes};
use sabi_files::TrustedPaths;

use super::evaluation::MachineArguments;

/// Arguments of `sabi plan`.
#[derive(Debug, Args)]
#[command(
    before_help = "\
Examples:
  sabi plan matrix.toml
  sabi plan matrix.toml -o build/plan.jsonl
  sabi plan matrix.toml --format commands
  sabi plan matrix.toml --format openjd
  sabi plan matrix.toml --format slurm",
    after_help = "\
A matrix is TOML that lists models, graphs, variants, seeds, sizes and presets; the plan has one line for each
combination, with all that a worker needs. Wrong names and missing files are refused before a plan is written.
Prints the path of the plan, or what --format asks for."
)]
pub(crate) struct PlanArguments {
    /// Matrix file (.toml)
    #[arg(value_name = "MATRIX")]
    pub(crate) matrix: PathBuf,
    /// Plan to write, which replaces an earlier one; paths in it start from its folder; - prints it, with paths from the current
    /// folder [default: plan.jsonl beside the matrix]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Also print how to run it: a command for each item (commands), a job template of Open Job Description (openjd), which
    /// belongs into the folder of the plan, or a script for an array of jobs (slurm)
    #[arg(long, value_enum, value_name = "jsonl|commands|openjd|slurm", hide_possible_values = true, default_value_t = PlanFormat::Jsonl)]
    pub(crate) format: PlanFormat,
}

/// Text that a plan is printed as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PlanFormat {
    Jsonl,
    Commands,
    Openjd,
    Slurm,
}

/// Arguments of `sabi run`.
#[derive(Debug, Args)]
#[command(
    before_help = "\
Examples:
  sabi run plan.jsonl
  sabi run plan.jsonl --items 0-3,7
  sabi run plan.jsonl --jobs 4 --adapter cpu
  sabi run plan.jsonl --dry-run
  sabi run plan.jsonl --json",
    after_help = "\
Items that are finished are left alone: their folder has the report of a bake with the same settings, inputs and
build of Sabi, and all its maps. Each item is baked by a process of its own. One that fails is told, and the others
go on; the exit code is 1 then. Prints the folders of all items that are finished or baked."
)]
pub(crate) struct RunArguments {
    /// Plan of 'sabi plan' (.jsonl)
    #[arg(value_name = "PLAN")]
    pub(crate) plan: PathBuf,
    /// Items to bake, counted from 0, such as 0-3,7 [default: all]
    #[arg(long, value_name = "LIST", value_parser = item_list, allow_hyphen_values = true)]
    pub(crate) items: Option<ItemList>,
    /// Bakes at a time; one alone uses all cores for most of its time, and each takes memory of its own
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=64))]
    pub(crate) jobs: u32,
    /// Bake finished items, too
    #[arg(long)]
    pub(crate) again: bool,
    /// Bake into folders that have files but no earlier maps
    #[arg(long)]
    pub(crate) force: bool,
    /// List the items and whether they are finished, and bake none
    #[arg(long)]
    pub(crate) dry_run: bool,
    /// Print a summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Memory for the model of a bake and its pictures, and for textures where the driver runs on the processor, MiB; an equal part of half of this machine's for each bake at a time if it is
    /// not given
    #[arg(long, value_name = "MIB", value_parser = clap::value_parser!(u64).range(16..=1 << 30), help_heading = "Machine")]
    memory: Option<u64>,
    /// Do all work without the disk cache
    #[arg(long, help_heading = "Machine")]
    pub(crate) no_cache: bool,
    #[command(flatten)]
    pub(crate) machine: MachineArguments,
    /// Bake a single item in this process, until standard input ends: what each item of a run is
    #[arg(long, hide = true, requires = "items")]
    pub(crate) alone: bool,
}

/// Least memory for a model, MiB.
const LEAST_MEMORY_MIB: u64 = 16;

impl RunArguments {
    /// Memory for the model of each item, MiB.
    pub(crate) fn memory_mib(&self) -> u64 {
        let share = || (default_memory_bytes() >> 20) / u64::from(self.jobs);
        self.memory.unwrap_or_else(|| share().max(LEAST_MEMORY_MIB))
    }

    /// Options of the engine for each item, whose files may open what they name below `trusted` and in the project of the plan.
    pub(crate) fn item_machine(&self, trusted: &TrustedPaths) -> ItemMachine {
        ItemMachine {
            adapter: self.machine.adapter.clone(),
            caster: self.machine.caster,
            budget_bytes: self.machine.budget_bytes(),
            cache_dir: if self.no_cache { None } else { default_cache_dir() },
            force: self.force,
            trusted: trusted.clone().with_file(&self.plan),
            memory_bytes: self.memory_mib() << 20,
        }
    }
}

/// Ranges of items, first and last.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ItemList(pub(crate) Vec<[usize; 2]>);

fn item_list(text: &str) -> Result<ItemList, String> {
    let takes = || "it takes numbers from 0 on and ranges of them, such as 0-3,7".to_owned();
    let number = |text: &str| {
        let is_plain = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
        is_plain.then(|| text.parse::<usize>().ok()).flatten()
    };
    let range = |text: &str| {
        let (first, last) = text.split_once('-').unwrap_or((text, text));
        let range = [
            number(first.trim()).ok_or_else(takes)?,
            number(last.trim()).ok_or_else(takes)?,
        ];
        match range[0] <= range[1] {
            true => Ok(range),
            false => Err(format!(
                "{} is before {} in a range; write {}-{}",
                range[1], range[0], range[1], range[0]
            )),
        }
    };
    Ok(ItemList(text.split(',').map(range).collect::<Result<_, String>>()?))
}

#[cfg(test)]
mod tests {
    use super::{ItemList, item_list};

    #[test]
    fn items_are_numbers_and_ranges() {
        assert_eq!(item_list("0-3,7"), Ok(ItemList(vec![[0, 3], [7, 7]])));
        assert_eq!(item_list("5, 2-2"), Ok(ItemList(vec![[5, 5], [2, 2]])));
        let takes = "it takes numbers from 0 on and ranges of them, such as 0-3,7";
        for text in ["", "-1", "1-", "1,,2", "a", "+1", "1-2-3", "99999999999999999999999"] {
            assert_eq!(item_list(text), Err(takes.to_owned()), "{text}");
        }
        assert_eq!(item_list("3-1"), Err("1 is before 3 in a range; write 1-3".to_owned()));
    }
}
