//! `sabi render`: a lit picture of the model.

use sabi_engine::rendering::{RenderRequest, TriangleLimit, render, render_graph};
use sabi_files::TrustedPaths;

use crate::arguments::RenderArguments;
use crate::exit::{Exit, Failure};
use crate::progress::ShownProgress;
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &RenderArguments, trusted: &TrustedPaths, terminal: &Terminal) -> Result<Exit, Failure> {
    if arguments.light.len() > 4 {
        let why = format!(
            "--light stands {} times; a scene has four lights",
            arguments.light.len()
        );
        return Err(Failure::new(Exit::Usage, why));
    }
    let request = RenderRequest {
        graph: arguments.subject.graph.path().to_owned(),
        evaluator: arguments.evaluation.options(
            &arguments.subject.mesh,
            trusted,
            arguments.texels.unwrap_or(RenderArguments::FIRST_TEXELS),
        )?,
        has_given_size: arguments.texels.is_some(),
        output: arguments.output.clone(),
        size: arguments.size,
        environment: arguments.environment.clone(),
        rotate: arguments.rotate,
        camera: arguments.camera,
        environment_strength: arguments.environment_strength(),
        target: arguments.target,
        is_orthographic: arguments.orthographic,
        view: arguments.view.clone(),
        background: arguments.background(),
        transform: arguments.transform.into(),
        exposure: arguments.exposure,
        bloom: arguments.bloom,
        has_ground: !arguments.no_ground,
        lights: arguments.lights(),
        lines: arguments.lines.iter().map(|lines| (*lines).into()).collect(),
        has_relief: arguments.relief,
        displace: arguments.displace.map(|triangles| match triangles {
            Some(count) => TriangleLimit::AtMost(count as usize),
            None => TriangleLimit::Fitting,
        }),
        samples: arguments.samples,
        turntable: arguments.turntable,
        turns: arguments.turn.into(),
    };
    let trusted = request.evaluator.trusted_with(&request.graph);
    let piped = arguments.subject.graph.piped(&trusted)?;
    let progress = ShownProgress::new(terminal);
    let rendered = match piped {
        Some((open, kinds)) => render_graph(&open, kinds, &request, &progress)?,
        None => render(&request, &progress)?,
    };
    drop(progress);
    terminal.warnings(&rendered.warnings);
    terminal.paths(&rendered.files)?;
    Ok(Exit::Done)
}
