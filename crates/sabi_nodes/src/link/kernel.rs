//! Writes the WGSL of a kernel.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{self, Write};

use super::block::BlockLayout;
use super::expressions::{Caller, plane_name, write_store};
use super::given::SURFACE_GROUP;
use super::module::LinkedModule;
use super::sources::{Callee, callees, write_block, write_sources};
use super::uses::{ATLAS, CORE, Uses};
use super::{Binding, Call, Domain, Format, KernelSpec};
use crate::fault::Fault;
use crate::kind::{Kind, Output};
use crate::shader_files::Libraries;

/// Reconstruction of a place on the surface from the atlas.
const PLACE: &str = "surface/place";
/// Starts of rays.
const SHOOT: &str = "surface/shoot";

/// A kernel's text and what the host needs to feed it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kernel {
    /// WGSL with the entry point `main`, of workgroup size 8 × 8.
    pub module: LinkedModule,
    /// Places of parameters in the block.
    pub layout: BlockLayout,
    /// Number of texture bindings that are read, after binding 0 of group 1.
    pub reads: usize,
    /// Storage formats of the bindings that are written, after those.
    pub writes: Vec<Format>,
    /// True if the kernel shoots rays. The entry point `shoot` then writes the rays of a range of tiles to a buffer:
    /// tile by tile, within a tile texel by texel, and for each texel ray by ray. `main` reads the rays again, along
    /// with their hits from a second buffer. Both buffers are bound after the textures. Rows are as `Ray` and `RayHit`
    /// in `lib/rays.wgsl`.
    pub rays: bool,
}

/// Turns a spec into WGSL: the nodes' texts, the entry points, and the shared files that they use. `kind_of` finds a kind by
/// its id.
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
    append_shared(&mut module, &kinds, rays, libraries)?;
    Ok(Kernel {
        module,
        layout,
        reads,
        writes,
        rays,
    })
}

/// Reason why a kernel could not be linked: the nodes changed between planning and linking, or a mistake in the planner.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LinkError {
    /// A call names a kind that does not exist.
    #[error("the kernel calls the node kind '{0}', which is not loaded; reload the node folder")]
    UnknownKind(String),
    /// A kind uses a library that does not exist.
    #[error("a node uses the library '{0}', which is not loaded; add `lib/{0}.wgsl` or remove the `@use`")]
    UnknownLibrary(String),
    /// A call names a function that its kind does not have.
    #[error("the node kind '{0}' has no result '{1}'")]
    UnknownFunction(String, String),
    /// A shared file cannot be linked.
    #[error("{0}")]
    Shared(#[from] Fault),
    /// The planner left out what a call or a store needs.
    #[error("the plan lacks {missing} for {reader}; this is a defect of Sabi")]
    Incomplete {
        /// The function or the result that needs it.
        reader: String,
        /// The part that is not there.
        missing: Missing,
    },
}

/// A part of a kernel's plan that is not there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Missing {
    /// The source of an input.
    Input(String),
    /// The stored result of a pass.
    Pass(String),
    /// The table of a survey.
    Survey,
    /// A stored result, by its number among the loads.
    Load(usize),
    /// Any call.
    Call,
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Missing::Input(name) => write!(f, "a source for the input '{name}'"),
            Missing::Pass(name) => write!(f, "the result of the pass '{name}'"),
            Missing::Survey => f.write_str("the survey"),
            Missing::Load(number) => write!(f, "the stored result {number}"),
            Missing::Call => f.write_str("a call"),
        }
    }
}

/// Appends the files that every kernel needs and those that its nodes use.
fn append_shared(
    module: &mut LinkedModule,
    kinds: &[&Kind],
    rays: bool,
    libraries: &Libraries,
) -> Result<(), LinkError> {
    let mut uses = Uses::new(libraries);
    let needed = [CORE, ATLAS, PLACE].into_iter().chain(rays.then_some(SHOOT));
    let of_nodes = kinds.iter().flat_map(|kind| &kind.libraries).map(String::as_str);
    for name in needed.chain(of_nodes) {
        if !uses.add(name) {
            return Err(LinkError::UnknownLibrary(name.to_owned()));
        }
    }
    Ok(uses.append(module, &[SURFACE_GROUP])?)
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
        Domain::AllTexels => write!(out, "{at_texel}    if owner == EMPTY {{ return; }}\n{at}"),
        Domain::OwnedTexels | Domain::OwnedTexelsByRays => {
            write!(out, "{at_texel}    if (owner & GHOST_BIT) != 0u {{ return; }}\n{at}")
        }
    };
    let mut bounded = BTreeSet::new();
    for (index, (call, callee)) in spec.calls.iter().zip(callees).enumerate() {
        if bounded.insert(call.block) {
            write_bounded(out, call.block, *callee);
        }
        write_call(out, index, call, *callee, spec)?;
    }
    for (index, store) in spec.stores.iter().enumerate() {
        write_store(out, index, store, spec)?;
    }
    out.push_str("}\n");
    Ok(())
}

/// Writes the parameters of a block, those that bound loops held within their ranges.
pub(super) fn write_bounded(out: &mut String, block: usize, callee: Callee<'_>) {
    if callee.kind.params_size > 0 {
        let name = callee.bounded();
        let _ = writeln!(out, "    let bounded_{block} = {name}(block.params_{block});");
    }
}

fn write_call(
    out: &mut String,
    index: usize,
    call: &Call,
    callee: Callee<'_>,
    spec: &KernelSpec,
) -> Result<(), LinkError> {
    let function = function(callee.kind, &call.function)?;
    let caller = Caller {
        index,
        call,
        kind: callee.kind,
        spec,
    };
    let arguments = caller.arguments(out, &function.arguments)?;
    let (prefix, name) = (callee.prefix(), &call.function);
    let _ = writeln!(out, "    let v{index} = {prefix}{name}({arguments});");
    Ok(())
}

/// The output or pass of a kind that has a name.
pub(super) fn function<'a>(kind: &'a Kind, name: &str) -> Result<&'a Output, LinkError> {
    let passes = kind.passes.iter().map(|pass| &pass.function);
    let found = kind.outputs.iter().chain(passes).find(|function| function.name == name);
    found.ok_or_else(|| LinkError::UnknownFunction(kind.id.clone(), name.to_owned()))
}
