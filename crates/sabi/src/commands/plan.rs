//! `sabi plan`: a matrix becomes a plan of bakes, and text for the engine that runs it.

mod commands_text;
mod openjd_template;
mod shell_word;
mod slurm_script;

pub(super) use self::shell_word::shell_word;

use std::fs::{self, File};
use std::io::Read as _;
use std::path::{Path, PathBuf};

use sabi_engine::{
    BakePlan, FileError, PlannedBakes, TrustedPaths, default_preset_folder, io_reason, plan_bakes, write_whole,
};

use crate::arguments::{PlanArguments, PlanFormat};
use crate::exit::{Exit, Failure};
use crate::printable::Page;
use crate::progress::ShownProgress;
use crate::terminal::Terminal;

const DEFAULT_NAME: &str = "plan.jsonl";
/// First bytes of a plan.
const START: &[u8] = b"{\"item\":0,\"key\":";

pub(crate) fn run(arguments: &PlanArguments, trusted: &TrustedPaths, terminal: &Terminal) -> Result<Exit, Failure> {
    let file = plan_file(arguments)?;
    if let Some(file) = &file {
        refuse_other_file(file)?;
    }
    let folder = file.as_deref().and_then(Path::parent).unwrap_or(Path::new("")); // Without a file, the current folder.
    let progress = ShownProgress::new(terminal);
    let preset_folder = default_preset_folder();
    let PlannedBakes { plan, warnings } =
        plan_bakes(&arguments.matrix, folder, preset_folder.as_deref(), trusted, &progress)?;
    drop(progress);
    terminal.warnings(warnings.iter().map(String::as_str));
    let text = plan.to_text()?;
    let Some(file) = file else {
        terminal.data(&text)?;
        return Ok(Exit::Done);
    };
    // Names that cannot be printed are refused before the file is written.
    let printed = printed(arguments.format, &file, &plan)?;
    write_whole(&file, text.as_bytes()).map_err(|error| unwritten(&file, &error))?;
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

/// Refuses to replace a file that is not a plan.
fn refuse_other_file(file: &Path) -> Result<(), Failure> {
    let refused = |why: &str| {
        let why = format!("cannot write the plan {}: {why}; name another file", file.display());
        Err(Failure::new(Exit::CannotWrite, why))
    };
    // Other errors are reported when the file is written.
    let Ok(found) = fs::metadata(file) else {
        return Ok(());
    };
    // Opening a pipe could block forever.
    if !found.is_file() {
        return refused("it is no ordinary file");
    }
    let mut start = Vec::new();
    let read = File::open(file).and_then(|file| file.take(START.len() as u64).read_to_end(&mut start));
    match read.is_ok() && (start.is_empty() || start == START) {
        true => Ok(()),
        false => refused("there is a file that is no plan"),
    }
}

/// Returns the text for standard output.
fn printed(format: PlanFormat, file: &Path, plan: &BakePlan) -> Result<String, Failure> {
    match format {
        PlanFormat::Jsonl => Ok([file.display()].into_iter().collect::<Page>().text().to_owned()),
        PlanFormat::Commands => commands_text::commands(file, plan),
        PlanFormat::Openjd => openjd_template::template(file, plan),
        PlanFormat::Slurm => slurm_script::script(file, plan),
    }
}

/// Returns the name of a plan's file without the folder, and the stem of the name, which is only for the names of jobs.
fn names(file: &Path) -> Result<(&str, &str), Failure> {
    let name = file.file_name().and_then(|name| name.to_str());
    let stem = file.file_stem().and_then(|stem| stem.to_str());
    name.zip(stem).ok_or_else(|| not_text(file))
}

fn not_text(file: &Path) -> Failure {
    let why = format!(
        "{} cannot be named in the text, because its name is not Unicode text; name another file",
        file.display()
    );
    Failure::new(Exit::CannotWrite, why)
}

fn unwritten(file: &Path, error: &FileError) -> Failure {
    let why = io_reason(&error.source);
    Failure::new(
        Exit::CannotWrite,
        format!("cannot write the plan {}: {why}; name another file", file.display()),
    )
}

fn items(count: usize) -> String {
    match count {
        1 => "1 item".to_owned(),
        count => format!("{count} items"),
    }
}
