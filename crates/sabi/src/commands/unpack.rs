//! `sabi unpack`: unpacks an archive into the folder of a graph.

use std::path::PathBuf;

use sabi_batch::shell_word::shell_word;
use sabi_engine::packing::{UnpackReport, unpack_graph};

use crate::arguments::UnpackArguments;
use crate::exit::{Exit, Failure};
use crate::progress::ShownProgress;
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &UnpackArguments, terminal: &Terminal) -> Result<Exit, Failure> {
    let folder = match &arguments.output {
        Some(folder) => folder.clone(),
        None => named_folder(arguments)?,
    };
    let progress = ShownProgress::new(terminal);
    let report = unpack_graph(&arguments.archive, &folder, &progress)?;
    drop(progress);
    if arguments.json {
        terminal.json(&report)?;
    } else {
        terminal.paths([&report.graph_file])?;
    }
    advise(&report, terminal);
    Ok(Exit::Done)
}

/// Returns the name of the archive without its extension, in the current folder.
fn named_folder(arguments: &UnpackArguments) -> Result<PathBuf, Failure> {
    let archive = &arguments.archive;
    match archive.file_stem().filter(|_| archive.extension().is_some()) {
        Some(stem) => Ok(PathBuf::from(stem)),
        None => {
            let why = format!(
                "{} has no ending to leave out; name the folder with -o",
                archive.display()
            );
            Err(Failure::new(Exit::Usage, why))
        }
    }
}

fn advise(report: &UnpackReport, terminal: &Terminal) {
    let graph = quoted(&report.graph);
    let model = report.model.as_deref().map_or_else(|| "MODEL".to_owned(), quoted);
    terminal.note(format_args!(
        "Unpacked {} files into {}",
        report.files.len(),
        report.folder
    ));
    terminal.note(format_args!("  open it with  sabi edit {graph}"));
    terminal.note(format_args!("  bake it with  sabi bake {graph} --mesh {model} -o maps"));
}

/// Returns a path in the form that a command line accepts.
fn quoted(path: &str) -> String {
    // Names in an archive may have letters with a meaning in shells.
    let is_plain = |letter: char| letter.is_alphanumeric() || "_-./:\\ ,+".contains(letter);
    match path.contains(' ') && path.chars().all(is_plain) {
        true => format!("\"{path}\""),
        false => shell_word(path).into_owned(),
    }
}
