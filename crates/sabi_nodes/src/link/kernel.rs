//! Writes the WGSL of a kernel.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use sabi_graph::PortType;

use super::block::BlockLayout;
use super::sources::{Names, write_block, write_sources};
use super::{Binding, Call, Convert, INPUTS_A_WORD, KernelSpec, Plane, Store, Stored};
use crate::kind::{Argument, Channel, InputDefault, Kind, Output, Shape};

/// A kernel's text and what the host needs to feed it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kernel {
    /// WGSL with one entry point, `main`, of workgroup size 8 × 8.
    pub wgsl: String,
    /// Where parameters lie in the block.
    pub layout: BlockLayout,
    /// Number of texture bindings that are read, after binding 0 of group 1.
    pub reads: usize,
    /// Storage formats of the bindings that are written, after those.
    pub writes: Vec<super::Format>,
    /// Whether it shoots rays. Then the entry point `shoot` writes the rays of a range of tiles to a buffer, tile by tile, in
    /// a tile texel by texel, and for each texel one after the other; `main` reads them again with what they hit from a
    /// second buffer. The two are bound behind the textures. Rows are as `Ray` and `RayHit` in `lib/rays.wgsl`.
    pub rays: bool,
}

/// Turns a spec into WGSL.
///
/// `kind` finds a kind by id, `library` the text of a shared file; `surface` is the text that reconstructs a place on the
/// surface from the atlas. The spec must name only kinds and functions that exist.
pub fn link<'a>(
    spec: &KernelSpec,
    kind: impl Fn(&str) -> Option<&'a Kind>,
    library: impl Fn(&str) -> Option<&'a str>,
    surface: &str,
) -> Result<Kernel, LinkError> {
    let kinds: Vec<&Kind> = spec
        .calls
        .iter()
        .map(|call| kind(&call.kind).ok_or_else(|| LinkError::UnknownKind(call.kind.clone())))
        .collect::<Result<_, _>>()?;
    let mut blocks: BTreeMap<usize, &Kind> = BTreeMap::new();
    for (call, kind) in spec.calls.iter().zip(&kinds) {
        blocks.insert(call.block, kind);
    }
    let switches = spec
        .calls
        .iter()
        .any(|call| call.inputs.iter().any(|b| matches!(b, Binding::Switch(_))));
    let layout = BlockLayout::new(blocks.values().copied(), switches);
    let names = Names::of(&kinds);

    let mut out = String::new();
    write_sources(&mut out, &blocks, &names);
    write_block(&mut out, &blocks, &names, switches);
    let (reads, writes) = write_bindings(&mut out, spec);
    if spec.rays {
        super::rays::write(&mut out, spec, &kinds, &names, 1 + reads + writes.len())?;
    } else {
        write_main(&mut out, spec, &kinds, &names)?;
    }
    out.push_str(surface);
    for name in libraries(&kinds) {
        out.push('\n');
        out.push_str(library(&name).ok_or_else(|| LinkError::UnknownLibrary(name.clone()))?);
    }
    Ok(Kernel {
        wgsl: out,
        layout,
        reads,
        writes,
        rays: spec.rays,
    })
}

/// Why a kernel could not be put together: the nodes changed between planning and linking, or a mistake in the planner.
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
}

fn libraries(kinds: &[&Kind]) -> Vec<String> {
    let mut names = vec!["core".to_owned(), crate::compile::ATLAS.to_owned()];
    for name in kinds.iter().flat_map(|kind| &kind.libraries) {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    names
}

/// Name of a plane in generated code.
fn plane_name(plane: Plane) -> &'static str {
    match plane {
        Plane::Mask => "mask",
        Plane::Color => "rgb",
        Plane::Vector => "xyz",
        Plane::Material(Channel::Color) => "color",
        Plane::Material(Channel::Surface) => "surface",
        Plane::Material(Channel::Height) => "height",
        Plane::Material(Channel::Slope) => "slope",
        Plane::Material(Channel::Emission) => "emission",
    }
}

fn write_bindings(out: &mut String, spec: &KernelSpec) -> (usize, Vec<super::Format>) {
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

fn write_main(out: &mut String, spec: &KernelSpec, kinds: &[&Kind], names: &Names<'_>) -> Result<(), LinkError> {
    out.push_str(
        "@compute @workgroup_size(8, 8)\n\
         fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {\n    \
         ",
    );
    out.push_str(if spec.once {
        "if any(group != vec3u(0u)) || any(local != vec3u(0u)) { return; }\n    let texel = vec3i(0);\n"
    } else {
        "let texel = texel_of(group, local);\n    let owner = owner_of(texel);\n"
    });
    out.push_str(if spec.once {
        ""
    } else if spec.on_ghosts {
        "    if owner == EMPTY { return; }\n"
    } else {
        "    if (owner & GHOST_BIT) != 0u { return; }\n"
    });
    if !spec.once {
        out.push_str("    let at = surface_at(texel, owner);\n");
    }
    let mut bounded = BTreeSet::new();
    for (index, (call, kind)) in spec.calls.iter().zip(kinds).enumerate() {
        if bounded.insert(call.block) {
            write_bounded(out, call.block, kind, names);
        }
        write_call(out, index, call, kind, names, spec)?;
    }
    for (index, store) in spec.stores.iter().enumerate() {
        write_store(out, index, store, spec);
    }
    out.push_str("}\n");
    Ok(())
}

/// The parameters of a block, those that bound loops held within their ranges.
pub(super) fn write_bounded(out: &mut String, block: usize, kind: &Kind, names: &Names<'_>) {
    if kind.params_size > 0 {
        let name = names.bounded(kind);
        let _ = writeln!(out, "    let bounded_{block} = {name}(block.params_{block});");
    }
}

fn write_call(
    out: &mut String,
    index: usize,
    call: &Call,
    kind: &Kind,
    names: &Names<'_>,
    spec: &KernelSpec,
) -> Result<(), LinkError> {
    let function = function(kind, &call.function)
        .ok_or_else(|| LinkError::UnknownFunction(kind.id.clone(), call.function.clone()))?;
    let arguments = arguments(out, index, call, &function.arguments, kind, spec);
    let (prefix, name) = (names.prefix(kind), &call.function);
    let _ = writeln!(out, "    let v{index} = {prefix}{name}({arguments});");
    Ok(())
}

/// What a call hands over; writes the variables that it needs for that.
pub(super) fn arguments(
    out: &mut String,
    index: usize,
    call: &Call,
    arguments: &[Argument],
    kind: &Kind,
    spec: &KernelSpec,
) -> String {
    let mut written = Vec::new();
    for argument in arguments {
        written.push(match argument {
            Argument::At => "at".to_owned(),
            Argument::Params => format!("bounded_{}", call.block),
            Argument::Index => "index".to_owned(),
            Argument::Ray => "ray".to_owned(),
            Argument::Hit => "hit".to_owned(),
            Argument::Round => "Round(dispatch.round, dispatch.rounds, dispatch.texel, dispatch.finest)".to_owned(),
            Argument::Survey => {
                let load = call.survey.unwrap_or_default();
                field_texture(load, &spec.loads[load])
            }
            Argument::Pass(pass) if spec.rays => super::rays::mean_name(*pass),
            Argument::Pass(pass) => {
                let load = call.passes.get(*pass).copied().flatten().unwrap_or_default();
                let texture = field_texture(load, &spec.loads[load]);
                match (kind.shape, spec.loads[load].ty) {
                    (Shape::Survey, PortType::Mask) => format!("textureLoad({texture}, vec2i(0), 0, 0).x"),
                    (Shape::Survey, _) => format!("textureLoad({texture}, vec2i(0), 0, 0).xyz"),
                    _ => texture,
                }
            }
            Argument::Input(input) => match call.inputs[*input] {
                Binding::Switch(load) => write_switch(out, index, *input, call, kind, load, &spec.loads[load]),
                binding => input_expression(*input, binding, call, kind, spec),
            },
        });
    }
    written.join(", ")
}

pub(super) fn function<'a>(kind: &'a Kind, name: &str) -> Option<&'a Output> {
    let passes = kind.passes.iter().map(|pass| &pass.function);
    kind.outputs.iter().chain(passes).find(|function| function.name == name)
}

fn input_expression(input: usize, binding: Binding, call: &Call, kind: &Kind, spec: &KernelSpec) -> String {
    match binding {
        Binding::Default | Binding::Switch(_) => default_expression(input, call.block, kind),
        Binding::Call(from, convert) => converted(&format!("v{from}"), convert),
        Binding::Load(load, convert) => converted(&load_expression(load, &spec.loads[load]), convert),
        Binding::Field(load) => field_texture(load, &spec.loads[load]),
    }
}

fn default_expression(input: usize, block: usize, kind: &Kind) -> String {
    let input = &kind.inputs[input];
    match &input.default {
        InputDefault::Knob(_) => format!("block.knobs_{block}.{}", input.name),
        InputDefault::Expression(expression) => expression.clone(),
        // What is required is never asked for its default; it still needs a type.
        InputDefault::PlainMaterial | InputDefault::Required => match input.ty {
            PortType::Material => "plain_material()".to_owned(),
            PortType::Mask => "0.0".to_owned(),
            PortType::Color | PortType::Vector => "vec3f(0.0)".to_owned(),
        },
    }
}

fn converted(value: &str, convert: Convert) -> String {
    match convert {
        Convert::None => value.to_owned(),
        Convert::Gray => format!("vec3f({value})"),
        Convert::Luminance => format!("luminance({value})"),
    }
}

fn field_texture(load: usize, stored: &Stored) -> String {
    let plane = stored.planes().first().copied().map_or("mask", plane_name);
    format!("load_{load}_{plane}")
}

fn texel_expression(load: usize, plane: Plane) -> String {
    format!("textureLoad(load_{load}_{}, texel.xy, texel.z, 0)", plane_name(plane))
}

fn load_expression(load: usize, stored: &Stored) -> String {
    match stored.ty {
        PortType::Mask => format!("{}.x", texel_expression(load, Plane::Mask)),
        PortType::Color => format!("{}.xyz", texel_expression(load, Plane::Color)),
        PortType::Vector => format!("{}.xyz", texel_expression(load, Plane::Vector)),
        PortType::Material => {
            let has = |channel| stored.channels.contains(&channel);
            let plane = |channel| texel_expression(load, Plane::Material(channel));
            let color = if has(Channel::Color) {
                plane(Channel::Color)
            } else {
                "vec4f(0.214, 0.214, 0.214, 1.0)".into()
            };
            let surface = if has(Channel::Surface) {
                plane(Channel::Surface)
            } else {
                "vec4f(0.7, 0.0, 1.0, 0.0)".into()
            };
            let height = if has(Channel::Height) {
                plane(Channel::Height)
            } else {
                "vec4f(0.0)".into()
            };
            let slope = if has(Channel::Slope) {
                plane(Channel::Slope)
            } else {
                "vec4f(0.0)".into()
            };
            let emission = if has(Channel::Emission) {
                plane(Channel::Emission)
            } else {
                "vec4f(0.0)".into()
            };
            format!("stored_material({color}, {surface}, {height}.x, {slope}.xyz, {emission}.xyz)")
        }
    }
}

/// Writes a local variable that the block's flags fill at run time, and answers its name.
///
/// Flag word 0 has two bits an input: 0 default, 1 as it is, 2 gray to color, 3 luminance. The others have a bit a
/// channel, [`INPUTS_A_WORD`] inputs each.
fn write_switch(
    out: &mut String,
    index: usize,
    input: usize,
    call: &Call,
    kind: &Kind,
    load: usize,
    stored: &Stored,
) -> String {
    let name = format!("in_{index}_{input}");
    let default = default_expression(input, call.block, kind);
    let mode = format!("((block.flags.x >> {}u) & 3u)", 2 * input);
    let _ = writeln!(out, "    var {name} = {default};");
    let value = match stored.ty {
        PortType::Material => {
            let plane = |channel| texel_expression(load, Plane::Material(channel));
            format!(
                "switched_material(block.flags.{} >> {}u, {}, {}, {}.x, {}.xyz, {}.xyz)",
                ["y", "z", "w"][(input / INPUTS_A_WORD).min(2)],
                5 * (input % INPUTS_A_WORD),
                plane(Channel::Color),
                plane(Channel::Surface),
                plane(Channel::Height),
                plane(Channel::Slope),
                plane(Channel::Emission),
            )
        }
        PortType::Mask => format!("switched_mask({mode}, {})", texel_expression(load, Plane::Mask)),
        PortType::Color => format!("switched_color({mode}, {})", texel_expression(load, Plane::Color)),
        PortType::Vector => format!("{}.xyz", texel_expression(load, Plane::Vector)),
    };
    let _ = writeln!(out, "    if {mode} != 0u {{ {name} = {value}; }}");
    name
}

pub(super) fn write_store(out: &mut String, index: usize, store: &Store, spec: &KernelSpec) {
    let value = match store.value {
        Binding::Call(call, convert) => converted(&format!("v{call}"), convert),
        Binding::Load(load, convert) => converted(&load_expression(load, &spec.loads[load]), convert),
        Binding::Default | Binding::Field(_) | Binding::Switch(_) => "plain_material()".to_owned(),
    };
    let _ = writeln!(out, "    let s{index} = {value};");
    for plane in store.stored.planes() {
        let value = match plane {
            Plane::Mask => format!("vec4f(s{index}, 0.0, 0.0, 1.0)"),
            Plane::Color | Plane::Vector => format!("vec4f(s{index}, 1.0)"),
            Plane::Material(Channel::Color) => format!("vec4f(s{index}.base_color, s{index}.alpha)"),
            Plane::Material(Channel::Surface) => {
                format!("vec4f(s{index}.roughness, s{index}.metallic, s{index}.occlusion, 1.0)")
            }
            Plane::Material(Channel::Height) => format!("vec4f(s{index}.height, 0.0, 0.0, 1.0)"),
            Plane::Material(Channel::Slope) => format!("vec4f(s{index}.slope, 1.0)"),
            Plane::Material(Channel::Emission) => format!("vec4f(s{index}.emission, 1.0)"),
        };
        let name = plane_name(plane);
        let _ = writeln!(
            out,
            "    textureStore(store_{index}_{name}, texel.xy, texel.z, {value});"
        );
    }
}
