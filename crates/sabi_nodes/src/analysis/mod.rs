//! Analysis of a node's code in naga's module: use of parameters, loops, cost, channels.

mod bounds;
mod channels;
mod cost;
mod effort;
mod fuel;
mod interval;
mod loops;
#[cfg(test)]
mod tests;
mod usage;
pub(crate) mod walk;

use std::collections::BTreeSet;

use naga::valid::ModuleInfo;
use naga::{Function, Handle, Module};

use self::cost::Costs;
use crate::fault::Fault;
use crate::kind::{Argument, ChannelWrite, Cost, Output, Param};
use crate::link::LinkedModule;
use crate::ports::{Ports, function};
use crate::scan::{Item, Scan};

/// Results of the analysis.
#[derive(Clone, Debug, Default)]
pub(crate) struct Findings {
    /// Indices of the parameters that bound a loop.
    pub(crate) params_that_bound_loops: BTreeSet<usize>,
    /// Cost of one evaluation of all outputs and shared functions.
    pub(crate) cost: Cost,
    /// Most operations of all functions for a texel.
    pub(crate) work: u64,
    /// Channels of each output, in order of the outputs.
    pub(crate) output_channels: Vec<Vec<ChannelWrite>>,
    /// Channels of each pass, in order of the passes.
    pub(crate) pass_channels: Vec<Vec<ChannelWrite>>,
    /// Indices of the parameters that rays depend on.
    pub(crate) params_of_rays: Vec<usize>,
    /// Indices of the parameters that passes read.
    pub(crate) params_of_passes: BTreeSet<usize>,
}

/// A documented function of a node, which kernels call.
struct Root<'a> {
    /// Its declaration in the node's text.
    item: &'a Item,
    handle: Handle<Function>,
    /// Number of calls for a texel: 1, or the largest number of rays for functions that run once for a ray.
    calls: u64,
}

/// Checks use of parameters and inputs, and loops; measures cost and channels.
pub(crate) fn analyze(
    linked: &LinkedModule,
    scan: &Scan,
    module: &Module,
    types: &ModuleInfo,
    params: &[Param],
    ports: &Ports,
) -> Result<Findings, Vec<Fault>> {
    let handle = |output: &Output| function(module, &output.name).map(|(handle, _)| handle);
    let shared = ports.shared.iter();
    let shared = shared.filter_map(|shared| function(module, &shared.name).map(|(handle, _)| handle));
    let evaluated: Vec<Handle<Function>> = ports.outputs.iter().filter_map(handle).chain(shared).collect();
    let ray = ports.rays.as_ref().and_then(|_| function(module, "ray"));
    let ray = ray.map(|(handle, _)| handle);
    let roots = roots(scan, module, params, ports);
    let functions = ports
        .outputs
        .iter()
        .chain(ports.passes.iter().map(|pass| &pass.function));
    let formulas = functions.flat_map(Output::formulas);
    let counts = ports.rays.iter().map(|rays| rays.count);
    let planned = formulas.flat_map(|formula| formula.params()).chain(counts.clone());
    let planned = planned.chain(ports.survey_groups);
    let planned = planned.map(|param| param as u32).collect();
    let mut faults = usage::check(linked, scan, module, &roots, &planned);
    let (mut params_that_bound_loops, work) = loops::check(linked, module, params, &roots, &mut faults);
    if !faults.is_empty() {
        faults.sort_by_key(|fault| (fault.line, fault.column));
        return Err(faults);
    }
    // The kernel loops over the rays.
    params_that_bound_loops.extend(counts);
    let costs = Costs::new(linked, module, types);
    let all: Vec<Handle<Function>> = roots.iter().map(|root| root.handle).collect();
    costs.check(&all).map_err(|fault| vec![fault])?;
    let channels = |output: &Output| match handle(output) {
        Some(root) => channels::channels(module, params, root, &output.arguments),
        None => Vec::new(),
    };
    let passes = ports.passes.iter().filter_map(|pass| handle(&pass.function));
    Ok(Findings {
        params_that_bound_loops,
        cost: costs.of(evaluated),
        work,
        output_channels: ports.outputs.iter().map(channels).collect(),
        pass_channels: ports.passes.iter().map(|pass| channels(&pass.function)).collect(),
        params_of_passes: passes
            .flat_map(|pass| usage::params_of(module, pass, params.len()))
            .collect(),
        params_of_rays: ray.map_or_else(Vec::new, |ray| usage::params_of(module, ray, params.len())),
    })
}

/// Returns all functions that a kernel calls: outputs, shared functions, passes and the function `ray`.
fn roots<'a>(scan: &'a Scan, module: &Module, params: &[Param], ports: &Ports) -> Vec<Root<'a>> {
    let range_of_rays = ports.rays.as_ref().and_then(|rays| params.get(rays.count)?.ty.range);
    let rays = range_of_rays.map_or(1, |[_, most]| most as u64);
    let functions = ports
        .outputs
        .iter()
        .chain(ports.passes.iter().map(|pass| &pass.function));
    let is_of_ray = |output: &Output| output.arguments.iter().any(Argument::is_of_ray);
    let functions = functions.map(|output| (output.name.as_str(), if is_of_ray(output) { rays } else { 1 }));
    let ray = ports.rays.iter().map(|_| ("ray", rays));
    let shared = ports.shared.iter().map(|shared| (shared.name.as_str(), 1));
    let found = functions.chain(shared).chain(ray).filter_map(|(name, calls)| {
        let item = scan.functions().find(|item| item.name == name)?;
        let (handle, _) = function(module, name)?;
        Some(Root { item, handle, calls })
    });
    found.collect()
}
