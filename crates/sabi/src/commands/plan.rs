//! `sabi plan`: a matrix becomes a plan of bakes, and text for the engine that runs it.

use std::path::{Path, PathBuf};

use sabi_batch::schedulers::{RunFlags, command_lines, job_template, slurm_script};
use sabi_batch::{BakePlan, PlannedBakes, plan_bakes};
use sabi_engine::baking::presets::default_preset_folder;
use sabi_files::TrustedPaths;

use crate::arguments::{PlanArguments, PlanFormat};
use crate::exit::{Exit, Failure};
use crate::printable::Page;
use crate::progress::ShownProgress;
use crate::terminal::Terminal;

const DEFAULT_NAME: &str = "plan.jsonl";
/// Flags of `sabi run`.
const RUN_FLAGS: RunFlags = RunFlags {
    items: "--items",
    adapter: "--adapter",
    openjd_progress: ["--progress", "openjd"],
};

pub(crate) fn run(arguments: &PlanArguments, trusted: &TrustedPaths, terminal: &Terminal) -> Result<Exit, Failure> {
    let file = plan_file(arguments)?;
    if let Some(file) = &file {
        BakePlan::refuse_other_file(file)?;
    }
    let folder = file.as_deref().and_then(Path::parent).unwrap_or(Path::new("")); // Without a file, the current folder.
    let progress = ShownProgress::new(terminal);
    let preset_folder = default_preset_folder();
    let PlannedBakes { plan, warnings } =
        plan_bakes(&arguments.matrix, folder, preset_folder.as_deref(), trusted, &progress)?;
    drop(progress);
    terminal.warnings(warnings.iter().map(String::as_str));
    let Some(file) = file else {
        terminal.data(&plan.to_text()?)?;
        return Ok(Exit::Done);
    };
    // Names that cannot be printed are refused before the file is written.
    let printed = printed(arguments.format, &file, &plan)?;
    plan.write(&file)?;
    terminal.data(&printed)?;
    terminal.note(format_args!(
        "Planned {} of {} in {}",
        items(plan.items.len()),
        arguments.matrix.display(),
        file.display()
    ));
    Ok(Exit::Done)
}

/// Returns the file of the plan; `None` if the plan is printed.
fn plan_file(arguments: &PlanArguments) -> Result<Option<PathBuf>, Failure> {
    match &arguments.output {
        None => Ok(Some(arguments.matrix.with_file_name(DEFAULT_NAME))),
        Some(output) if output.as_os_str() == "-" => match arguments.format {
            PlanFormat::Jsonl => Ok(None),
            PlanFormat::Commands | PlanFormat::Openjd | PlanFormat::Slurm => {
                let why = "what is printed runs a plan in a file, but -o - writes none; name a file".to_owned();
                Err(Failure::new(Exit::Usage, why))
            }
        },
        Some(output) => Ok(Some(output.clone())),
    }
}

/// Returns the text for standard output.
fn printed(format: PlanFormat, file: &Path, plan: &BakePlan) -> Result<String, Failure> {
    match format {
        PlanFormat::Jsonl => Ok([file.display()].into_iter().collect::<Page>().text().to_owned()),
        PlanFormat::Commands => Ok(command_lines(file, plan, RUN_FLAGS)?),
        PlanFormat::Openjd => Ok(job_template(file, plan, RUN_FLAGS)?),
        PlanFormat::Slurm => Ok(slurm_script(file, plan, RUN_FLAGS)?),
    }
}

fn items(count: usize) -> String {
    match count {
        1 => "1 item".to_owned(),
        count => format!("{count} items"),
    }
}
