//! `sabi preview`: any node's result.

use sabi_engine::rendering::{PreviewRequest, preview, preview_graph};
use sabi_files::TrustedPaths;

use crate::arguments::PreviewArguments;
use crate::exit::{Exit, Failure};
use crate::progress::ShownProgress;
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &PreviewArguments, trusted: &TrustedPaths, terminal: &Terminal) -> Result<Exit, Failure> {
    let request = PreviewRequest {
        graph: arguments.subject.graph.path().to_owned(),
        evaluator: arguments
            .evaluation
            .options(&arguments.subject.mesh, trusted, arguments.maps.size)?,
        node: arguments.node.clone(),
        output: arguments.output.clone(),
        material: arguments.evaluation.material.clone(),
    };
    let trusted = request.evaluator.trusted_with(&request.graph);
    let piped = arguments.subject.graph.piped(&trusted)?;
    let progress = ShownProgress::new(terminal);
    let warnings = match piped {
        Some((open, kinds)) => preview_graph(&open, kinds, &request, &progress)?,
        None => preview(&request, &progress)?,
    };
    drop(progress);
    terminal.warnings(&warnings);
    terminal.paths([&arguments.output])?;
    Ok(Exit::Done)
}
