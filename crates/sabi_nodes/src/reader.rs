//! Reads a WGSL file as a [`Kind`].

use std::collections::BTreeSet;
use std::sync::Arc;

use naga::valid::Capabilities;

use crate::analysis::{self, Findings};
use crate::compile::{link_with_libraries, used_libraries};
use crate::explain;
use crate::fault::{Fault, Text};
use crate::formula::Formula;
use crate::header::{Header, read_header};
use crate::kind::{Argument, Input, Kind, Memory, Output, Param, Rays, Reads, Role, Shape};
use crate::limits;
use crate::link::parse::compile;
use crate::names::is_plain_name;
use crate::params::read_params;
use crate::ports::{Ports, read_ports};
use crate::rules;
use crate::scan::scan;
use crate::shader_files::Libraries;
use crate::source_file::{FILE_LIMIT_BYTES, SourceFile};

/// Reads a node file with the libraries that it uses, and checks all rules. The error lists all faults that were found.
pub fn read_kind(file: &SourceFile, libraries: &Libraries) -> Result<Kind, Vec<Fault>> {
    check_file(file).map_err(|fault| vec![fault])?;
    let text = Text {
        path: &file.path,
        text: &file.text,
    };
    let scan = scan(text)?;
    let mut faults = Vec::new();
    let (header, uses) = read_header(text, &scan, &mut faults);
    let used = used_libraries(text, &uses, libraries, &mut faults);
    let (Some(header), true) = (header, faults.is_empty()) else {
        return Err(faults);
    };
    let linked = link_with_libraries(text, &used, libraries);
    if let Some(fault) = limits::check(&linked) {
        return Err(vec![fault]);
    }
    let (module, types) = compile(&linked, Capabilities::default())
        .map_err(|fault| vec![explain::explain(fault, &scan, text, libraries, &used)])?;
    if !scan.is_complete {
        let message = "The declarations of this file cannot be told apart.";
        return Err(vec![Fault::of_file(
            &file.path,
            message,
            "Write each of them on lines of its own.",
        )]);
    }
    rules::check_docs(text, &scan, &module, &mut faults);
    let params = read_params(text, &scan, &module, &mut faults);
    let ports = read_ports(text, &scan, &module, &params, &mut faults);
    rules::check_module(&linked, &scan, &module, &mut faults);
    if !faults.is_empty() {
        return Err(faults);
    }
    let findings = analysis::analyze(&linked, &scan, &module, &types, &params, &ports)?;
    let params_size = crate::params::params_size(&module);
    Ok(assemble(file, header, used, params, params_size, ports, findings))
}

/// Checks that the id is valid in graph files, and that the text is not too large.
fn check_file(file: &SourceFile) -> Result<(), Fault> {
    let named = file
        .id
        .split_once('/')
        .is_some_and(|(category, name)| is_plain_name(category) && is_plain_name(name));
    if !named {
        return Err(Fault::of_file(
            &file.path,
            format!("`{}` is not a name for a node.", file.id),
            "Folder and file names are lower-case letters, digits and `_`, and start with a letter: `noise/simplex`.",
        ));
    }
    if file.text.len() > FILE_LIMIT_BYTES {
        return Err(Fault::of_file(
            &file.path,
            format!("The file is larger than {} KiB.", FILE_LIMIT_BYTES / 1024),
            "Move tables into an image, and shared functions into a library.",
        ));
    }
    Ok(())
}

fn assemble(
    file: &SourceFile,
    header: Header,
    libraries: Vec<String>,
    mut params: Vec<Param>,
    params_size: u32,
    ports: Ports,
    findings: Findings,
) -> Kind {
    let Ports {
        inputs,
        mut outputs,
        shared,
        mut passes,
        mut rays,
        surveyed,
        survey_groups,
    } = ports;
    if let Some(rays) = &mut rays {
        rays.reads = findings.params_of_rays;
    }
    for (output, channels) in outputs.iter_mut().zip(findings.output_channels) {
        output.channels = channels;
    }
    for (pass, channels) in passes.iter_mut().zip(findings.pass_channels) {
        pass.function.channels = channels;
    }
    let functions = || outputs.iter().chain(passes.iter().map(|pass| &pass.function));
    let shape = match (&rays, surveyed) {
        (Some(_), _) => Shape::Ray,
        (None, Some(_)) => Shape::Survey,
        (None, None) => shape(&inputs, functions()),
    };
    let of_surface = params_of_surface(functions(), rays.as_ref(), shape, &findings.params_of_passes);
    mark_params(&mut params, &findings.params_that_bound_loops, &of_surface);
    Kind {
        id: file.id.clone(),
        version: header.version,
        label: header.label,
        summary: header.summary,
        description: header.description,
        aliases: header.aliases,
        formerly: header.formerly,
        path: file.path.clone(),
        source: Arc::from(file.text.as_str()),
        libraries,
        shape,
        params,
        params_size,
        inputs,
        outputs,
        shared,
        passes,
        rays,
        surveyed,
        survey_groups,
        cost: findings.cost,
        work: findings.work,
    }
}

/// Marks the parameters that bound loops, and the parameters that a mask can multiply at each place.
fn mark_params(params: &mut [Param], bound_loops: &BTreeSet<usize>, of_surface: &BTreeSet<usize>) {
    for (index, param) in params.iter_mut().enumerate() {
        param.bounds_a_loop = bound_loops.contains(&index);
        param.takes_mask = is_number(param) && !of_surface.contains(&index);
    }
}

/// Returns the indices of the parameters that are read for the whole surface: by formulas, as the reach of rays, or by a survey.
fn params_of_surface<'o>(
    functions: impl Iterator<Item = &'o Output>,
    rays: Option<&Rays>,
    shape: Shape,
    params_of_passes: &BTreeSet<usize>,
) -> BTreeSet<usize> {
    let formulas = functions.flat_map(Output::formulas);
    let mut of_surface: BTreeSet<usize> = formulas.flat_map(Formula::params).collect();
    of_surface.extend(rays.and_then(|rays| rays.reach));
    of_surface.extend(rays.iter().flat_map(|rays| &rays.texel).flat_map(Formula::params));
    if shape == Shape::Survey {
        of_surface.extend(params_of_passes);
    }
    of_surface
}

/// Returns true if the parameter is a single number that is not restricted to whole numbers.
fn is_number(param: &Param) -> bool {
    param.ty.memory == Memory::F32 && matches!(param.ty.role, Role::Plain | Role::Length | Role::Angle)
}

fn shape<'o>(inputs: &[Input], mut functions: impl Iterator<Item = &'o Output>) -> Shape {
    let is_texture = |argument: &Argument| match argument {
        Argument::Input(index) => inputs[*index].reads == Reads::Field,
        Argument::Pass(_) => true,
        _ => false,
    };
    if functions.any(|function| function.arguments.iter().any(is_texture)) {
        Shape::Field
    } else {
        Shape::Point
    }
}
