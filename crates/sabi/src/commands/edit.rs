//! `sabi edit`: the window.

use std::path::Path;

use sabi_files::TrustedPaths;

use crate::arguments::EditArguments;
use crate::exit::{Exit, Failure};
use crate::graph_argument::GraphArgument;
#[cfg(feature = "window")]
use crate::stopping;
use crate::usage::mistyped_command;

pub(crate) fn run(arguments: &EditArguments, trusted: &TrustedPaths) -> Result<Exit, Failure> {
    refuse_mistyped_command(arguments)?;
    let graph = arguments.graph.as_ref();
    let graph = graph.map(|graph| graph.file("the editor saves a graph to its file"));
    open(arguments, graph.transpose()?, trusted)
}

#[cfg(feature = "window")]
fn open(arguments: &EditArguments, graph: Option<&Path>, trusted: &TrustedPaths) -> Result<Exit, Failure> {
    sabi_editor::edit(&sabi_editor::EditRequest {
        graph: graph.map(Path::to_owned),
        mesh: arguments.mesh.clone(),
        adapter: arguments.adapter.clone(),
        trusted: trusted.clone(),
        at_hang: stopping::end_after_a_loss,
        at_end: stopping::end_soon,
    })?;
    Ok(Exit::Done)
}

/// Returns a sentence that says how to get the editor, which this build does not contain.
#[cfg(not(feature = "window"))]
fn open(_: &EditArguments, _: Option<&Path>, _: &TrustedPaths) -> Result<Exit, Failure> {
    let why = "this build of sabi has no editor, only the commands that `sabi --help` lists; build it with \
               `cargo build --release`, without --no-default-features";
    Err(Failure::new(Exit::Usage, why.to_owned()))
}

/// A mistyped command is read as the path of a graph.
fn refuse_mistyped_command(arguments: &EditArguments) -> Result<(), Failure> {
    let typed = arguments.graph.as_ref().map(GraphArgument::path);
    match typed.and_then(mistyped_command) {
        Some(why) => Err(Failure::new(Exit::Usage, why)),
        None => Ok(()),
    }
}
