//! Writes the entry points of a kernel whose results are means over rays.

use std::fmt::Write;

use sabi_graph::PortType;

use super::KernelSpec;
use super::error::{LinkError, MissingPart};
use super::expressions::{Caller, Locals, mean_name, write_store};
use super::sources::Callee;
use crate::kind::{Argument, Output, Rays};

/// Writes the bindings of rays and hits, starting at `binding`, and both entry points.
pub(super) fn write(
    out: &mut String,
    spec: &KernelSpec,
    callees: &[Callee<'_>],
    binding: usize,
) -> Result<(), LinkError> {
    let Some(callee) = callees.first() else {
        return Err(LinkError::Incomplete {
            reader: "a kernel that shoots rays".to_owned(),
            missing: MissingPart::Call,
        });
    };
    let kind = callee.kind;
    let rays = kind
        .rays
        .as_ref()
        .ok_or_else(|| LinkError::UnknownFunction(kind.id.clone(), "ray".to_owned()))?;
    let hits = binding + 1;
    let _ = writeln!(
        out,
        "@group(1) @binding({binding}) var<storage, read_write> shot_rays: array<StoredRay>;\n\
         @group(1) @binding({hits}) var<storage, read> shot_hits: array<RayHit>;"
    );
    write_shoot(out, &caller(spec, *callee, 0), *callee, rays)?;
    write_main(out, spec, *callee, rays)
}

fn caller<'a>(spec: &'a KernelSpec, callee: Callee<'a>, index: usize) -> Caller<'a> {
    Caller {
        index,
        call: &spec.calls[index],
        callee,
        spec,
    }
}

/// Writes the entry point that averages over the rays of a texel and stores the results.
fn write_main(out: &mut String, spec: &KernelSpec, callee: Callee<'_>, rays: &Rays) -> Result<(), LinkError> {
    let call = &spec.calls[0];
    write_start(out, "main");
    out.push_str("    if owner == EMPTY || (owner & GHOST_BIT) != 0u { return; }\n");
    out.push_str("    let at = surface_at(texel, owner);\n");
    let masks = caller(spec, callee, 0).param_masks()?;
    callee.write_bounded_params(out, call, "at", &masks);
    let _ = writeln!(out, "    let count = {};", callee.bounded_param(call.block, rays.count));
    let averaged = AveragedFunctions::of(spec, callee)?;
    for (name, function, _) in &averaged.functions {
        let zero = if function.ty == PortType::Mask {
            "0.0"
        } else {
            "vec3f(0.0)"
        };
        let _ = writeln!(out, "    var {name} = {zero};");
    }
    out.push_str(
        "    for (var index = 0u; index < count; index++) {\n    \
         let ray = ray_of(shot_rays[place * count + index]);\n    \
         let hit = hit_of(shot_hits[place * count + index], ray);\n",
    );
    let prefix = callee.prefix();
    let mut locals_of_ray = Locals::new();
    for (name, function, call) in &averaged.functions {
        let arguments = caller(spec, callee, *call).arguments(out, &mut locals_of_ray, &function.arguments)?;
        let _ = writeln!(out, "    {name} += {prefix}{}({arguments});", function.name);
    }
    out.push_str("    }\n");
    for (name, ..) in &averaged.functions {
        let _ = writeln!(out, "    {name} /= f32(count);");
    }
    let mut locals = Locals::new();
    for (index, function) in &averaged.of_means {
        let arguments = caller(spec, callee, *index).arguments(out, &mut locals, &function.arguments)?;
        let _ = writeln!(out, "    let v{index} = {prefix}{}({arguments});", function.name);
    }
    for (index, store) in spec.stores.iter().enumerate() {
        write_store(out, index, store, spec)?;
    }
    out.push_str("}\n");
    Ok(())
}

/// Functions of a kernel that are averaged over rays, and functions that read these averages.
struct AveragedFunctions<'k> {
    /// Name of the variable, the function, and the call whose inputs the function takes.
    functions: Vec<(String, &'k Output, usize)>,
    /// Calls that read averages of passes.
    of_means: Vec<(usize, &'k Output)>,
}

impl<'k> AveragedFunctions<'k> {
    fn of(spec: &KernelSpec, callee: Callee<'k>) -> Result<AveragedFunctions<'k>, LinkError> {
        let mut averaged = AveragedFunctions {
            functions: Vec::new(),
            of_means: Vec::new(),
        };
        for (index, call) in spec.calls.iter().enumerate() {
            let output = callee.function(&call.function)?;
            if output.arguments.iter().any(Argument::is_of_ray) {
                averaged.functions.push((format!("v{index}"), output, index));
                continue;
            }
            averaged.of_means.push((index, output));
            for argument in &output.arguments {
                let Argument::Pass(pass) = argument else { continue };
                let name = mean_name(*pass);
                if averaged.functions.iter().all(|(known, ..)| *known != name) {
                    averaged
                        .functions
                        .push((name, &callee.kind.passes[*pass].function, index));
                }
            }
        }
        Ok(averaged)
    }
}

fn write_shoot(out: &mut String, caller: &Caller<'_>, callee: Callee<'_>, rays: &Rays) -> Result<(), LinkError> {
    write_start(out, "shoot");
    out.push_str("    if texel.x < 0 { return; }\n");
    let _ = writeln!(
        out,
        "    let count = {};",
        callee.bounded_param(caller.call.block, rays.count)
    );
    // Texels without a surface point have rows too: their rays have length 0.
    out.push_str(
        "    if owner == EMPTY || (owner & GHOST_BIT) != 0u {\n        \
         for (var index = 0u; index < count; index++) { shot_rays[place * count + index] = stored_ray(no_ray(), 0u); }\n        \
         return;\n    }\n    let center = surface_at(texel, owner);\n",
    );
    out.push_str("    ray_count = count;\n");
    callee.write_bounded_params(out, caller.call, "center", &caller.param_masks()?);
    out.push_str(
        "    let planes = planes_under(texel);\n    \
         for (var index = 0u; index < count; index++) {\n    \
         let at = jittered(center, planes, index);\n",
    );
    let arguments = caller.arguments(out, &mut Locals::new(), &rays.arguments)?;
    let prefix = callee.prefix();
    let _ = writeln!(
        out,
        "    var ray = {prefix}ray({arguments});\n    ray.origin = lifted(at, ray.origin, ray.direction);\n    \
         shot_rays[place * count + index] = stored_ray(ray, owner);\n    }}\n}}"
    );
    Ok(())
}

fn write_start(out: &mut String, name: &str) {
    let _ = writeln!(
        out,
        "@compute @workgroup_size(8, 8)\n\
         fn {name}(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {{\n    \
         let texel = texel_of(group, local);\n    let owner = owner_of(texel);\n    \
         let place = (group.y * dispatch.row_length + group.x) * 64u + local.y * 8u + local.x;"
    );
}
