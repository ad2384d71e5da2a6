//! Writes the WGSL of a kernel.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use super::block::BlockLayout;
use super::error::LinkError;
use super::expressions::{Caller, Locals, plane_name, write_store};
use super::given_declarations::{SURFACE_GROUP, on_points};
use super::module::LinkedModule;
use super::sources::{Callee, callees, write_block, write_sources};
use super::uses::{ATLAS, FileUses};
use super::{Binding, Domain, Format, KernelSpec, SURVEY_GROUPS};
use crate::kind::Kind;
use crate::shader_files::{CORE, Libraries};

/// File that reconstructs a surface point from the atlas.
const PLACE: &str = "surface/place";
/// Library that reads stored results on the surface.
const SURFACE: &str = "surface";
/// File that computes the starts of rays.
const SHOOT: &str = "surface/shoot";
/// File that denoises means over rays.
const DENOISE: &str = "surface/denoise";

/// Text of a kernel, and the layouts and bindings that the host has to provide.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kernel {
    /// WGSL with the entry point `main`, of workgroup size 8 × 8.
    pub module: LinkedModule,
    /// Offsets of parameters in the block.
    pub layout: BlockLayout,
    /// Number of texture bindings that are read. They follow binding 0 of group 1.
    pub reads: usize,
    /// Storage formats of the bindings that are written. They follow the bindings that are read.
    pub writes: Vec<Format>,
    /// True if the kernel shoots rays. The entry point `shoot` then writes the rays of a range of tiles to a buffer, sorted
    /// by tile, texel and ray. `main` reads the rays again, along with their hits from a second buffer. Both buffers are
    /// bound after the textures. Rows have the layouts of `Ray` and `RayHit` in `lib/rays.wgsl`.
    pub rays: bool,
}

/// Converts a spec to WGSL: the texts of the nodes, the entry points, and the shared files that they use. `kind_of` returns
/// a kind by its id.
pub fn link<'k>(
    spec: &KernelSpec,
    kind_of: impl Fn(&str) -> Option<&'k Kind>,
    libraries: &Libraries,
) -> Result<Kernel, LinkError> {
    let kinds = spec.calls.iter().map(|call| {
        let kind = kind_of(&call.kind);
        kind.ok_or_else(|| LinkError::UnknownKind(call.kind.clone()))
    });
    let kinds: Vec<&Kind> = kinds.collect::<Result<_, _>>()?;
    let callees = callees(&kinds);
    let blocks: BTreeMap<usize, Callee<'_>> = spec
        .calls
        .iter()
        .map(|call| call.block)
        .zip(callees.iter().copied())
        .collect();
    let switches = spec
        .calls
        .iter()
        .any(|call| call.inputs.iter().any(|input| matches!(input, Binding::Switch(_))));
    let layout = BlockLayout::new(blocks.values().map(|callee| callee.kind), switches);

    let mut module = LinkedModule::default();
    let mut out = String::new();
    write_sources(&mut module, &mut out, &blocks);
    write_block(&mut out, &blocks, switches);
    let (reads, writes) = write_bindings(&mut out, spec);
    let rays = spec.domain == Domain::OwnedTexelsByRays;
    if rays {
        super::rays::write(&mut out, spec, &callees, 1 + reads + writes.len())?;
    } else {
        write_main(&mut out, spec, &callees)?;
    }
    module.push_generated(&out);
    append_shared(&mut module, &kinds, spec, libraries)?;
    Ok(Kernel {
        module,
        layout,
        reads,
        writes,
        rays,
    })
}

/// Appends the files that every kernel needs and those that its nodes use.
fn append_shared(
    module: &mut LinkedModule,
    kinds: &[&Kind],
    spec: &KernelSpec,
    libraries: &Libraries,
) -> Result<(), LinkError> {
    let rays = spec.domain == Domain::OwnedTexelsByRays;
    let mut uses = FileUses::new(libraries);
    let reads_means = spec.calls.iter().any(|call| call.normals.is_some());
    let needed = [CORE, ATLAS, PLACE].into_iter().chain(rays.then_some(SHOOT));
    let needed = needed.chain(reads_means.then_some(DENOISE));
    let of_nodes = kinds.iter().flat_map(|kind| &kind.libraries).map(String::as_str);
    for name in needed.chain(of_nodes) {
        if !uses.add(name) {
            return Err(LinkError::UnknownLibrary(name.to_owned()));
        }
    }
    let reads_surface = uses.names.iter().any(|name| name == SURFACE);
    let mut given = vec![SURFACE_GROUP];
    given.extend(reads_surface.then_some(on_points(spec.on_points)));
    Ok(uses.append(module, &given)?)
}

fn write_bindings(out: &mut String, spec: &KernelSpec) -> (usize, Vec<Format>) {
    let mut binding = 1;
    for (index, load) in spec.loads.iter().enumerate() {
        for plane in load.planes() {
            let name = plane_name(plane);
            let _ = writeln!(
                out,
                "@group(1) @binding({binding}) var load_{index}_{name}: texture_2d_array<f32>;"
            );
            binding += 1;
        }
    }
    let reads = binding - 1;
    let mut writes = Vec::new();
    for (index, store) in spec.stores.iter().enumerate() {
        for (plane, format) in store.stored.planes().into_iter().zip(&store.formats) {
            let (name, format_name) = (plane_name(plane), format.wgsl());
            let _ = writeln!(
                out,
                "@group(1) @binding({binding}) var store_{index}_{name}: texture_storage_2d_array<{format_name}, write>;"
            );
            binding += 1;
            writes.push(*format);
        }
    }
    (reads, writes)
}

fn write_main(out: &mut String, spec: &KernelSpec, callees: &[Callee<'_>]) -> Result<(), LinkError> {
    out.push_str(
        "@compute @workgroup_size(8, 8)\n\
         fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {\n",
    );
    let at_texel = "    let texel = texel_of(group, local);\n    let owner = owner_of(texel);\n";
    let at = "    let at = surface_at(texel, owner);\n";
    let _ = match spec.domain {
        Domain::Once => writeln!(
            out,
            "    if any(group != vec3u(0u)) || any(local != vec3u(0u)) {{ return; }}\n    let texel = vec3i(0);"
        ),
        Domain::Groups => writeln!(
            out,
            "    let texel = vec3i(i32(64u * (dispatch.first_tile + group.x) + 8u * local.y + local.x), 0, 0);\n    if texel.x >= min({SURVEY_GROUPS}, i32(64u * dispatch.end_tile)) {{ return; }}"
        ),
        Domain::AllTexels => write!(out, "{at_texel}    if owner == EMPTY {{ return; }}\n{at}"),
        Domain::OwnedTexels | Domain::OwnedTexelsByRays => {
            write!(out, "{at_texel}    if (owner & GHOST_BIT) != 0u {{ return; }}\n{at}")
        }
    };
    let mut bounded = BTreeSet::new();
    let mut locals = Locals::new();
    for (index, (call, callee)) in spec.calls.iter().zip(callees).enumerate() {
        let caller = Caller {
            index,
            call,
            callee: *callee,
            spec,
        };
        if bounded.insert(call.block) {
            callee.write_bounded_params(out, call, "at", &caller.param_masks()?);
        }
        write_call(out, &mut locals, &caller)?;
    }
    if spec.domain == Domain::AllTexels {
        // What is written may be a band of the atlas.
        out.push_str("    let written = texel - vec3i(0, i32(dispatch.first_row), i32(dispatch.first_page));\n");
    }
    for (index, store) in spec.stores.iter().enumerate() {
        write_store(out, index, store, spec)?;
    }
    out.push_str("}\n");
    Ok(())
}

fn write_call(out: &mut String, locals: &mut Locals, caller: &Caller<'_>) -> Result<(), LinkError> {
    let (index, name) = (caller.index, &caller.call.function);
    let function = caller.callee.function(name)?;
    let arguments = caller.arguments(out, locals, &function.arguments)?;
    let prefix = caller.callee.prefix();
    let _ = writeln!(out, "    let v{index} = {prefix}{name}({arguments});");
    Ok(())
}
